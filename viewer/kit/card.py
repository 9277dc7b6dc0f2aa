"""What cards in the picture have in common: where they lie, when they go below, and how text and numbers stand there.

Places are in the picture, (across, up), each -1 to 1; sizes in standard letter heights.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

Place: TypeAlias = tuple[float, float]
Rectangle: TypeAlias = tuple[float, float, float, float]     # left, bottom, right, top

NARROW = 1.15                   # pictures whose width is less than this times their height have the card below
INK, QUIET, WARNING = "#16181c", "#4a4e57", "#8a2f68"


@dataclass(frozen=True)
class Line:
    """A line of text, or a word of one, at a place in the picture or, of three numbers, in the world."""

    text: str
    place: Place | tuple[float, float, float]
    size: float = 0.72
    align: Place = (0.0, 0.5)
    color: str = INK
    bold: bool = False
    plate: str = ""


def covers(rectangle: Rectangle, place: Place) -> bool:
    """Whether a place in the picture lies on a card."""
    left, bottom, right, top = rectangle
    return left <= place[0] <= right and bottom <= place[1] <= top


def written(number: float, digits: int = 3, sign: str = "") -> str:
    """A number as on a blackboard, with a true minus; ``sign`` ``+`` shows a plus too."""
    if 0.0 < abs(number) < 1e-3 or abs(number) >= 1e4:
        digits = min(digits, 2)         # long enough as it is
    return f"{number:{sign}.{digits}g}".replace("e-0", "e-").replace("e+0", "e").replace("-", "\u2212")
