"""Labels checked and put into plain values, which can be compared from one frame to the next."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, NamedTuple

from viewer.engine.annotations import Label

LONGEST_TEXT = 4000


class Inscription(NamedTuple):
    """What a label comes to. The anchor's last number is 1 for a place in the world, 0 for one in the picture."""

    text: str
    anchor: tuple[float, float, float, float]
    size: float
    color: tuple[int, int, int, int]
    align: tuple[float, float]
    plate: tuple[int, int, int, int] | None
    bold: bool


def checked_labels(labels: Any) -> tuple[Inscription, ...]:
    """What a scene's ``labels`` gave, less what cannot be seen; raises TypeError or ValueError for what is wrong."""
    return tuple(made for label in (labels or ()) if (made := _inscription(label)))


def _inscription(label: Any) -> Inscription | None:
    """One label in plain values; None where it has no letters or no place."""
    if not isinstance(label, Label):
        raise TypeError(f"{_shortened(label)} is not a Label")
    text = label.text
    if not isinstance(text, str):
        raise TypeError(f"label text = {_shortened(text)} is not text")
    anchor, size, align = _numbers(label)
    color, plate = _channels(label.color), _channels(label.plate) if label.plate else None
    if not size or not math.isfinite(sum(anchor)) or not text or text.isspace():
        return None
    if len(text) > LONGEST_TEXT:
        text = text[:LONGEST_TEXT - 1] + "…"
    return Inscription(text, anchor, size, color, align, plate, bool(label.bold))


def _numbers(label: Label) -> tuple[tuple[float, float, float, float], float, tuple[float, float]]:
    """The label's anchor as an inscription has it, its size and its align; raises ValueError."""
    try:
        across, up, *deep = map(float, label.anchor)
        size = float(label.size)
        right, top = map(float, label.align)
        if len(deep) < 2 and 0.0 <= size < math.inf and math.isfinite(right + top):
            return (across, up, deep[0], 1.0) if deep else (across, up, 0.0, 0.0), size, (right, top)
    except (TypeError, ValueError):
        pass
    raise ValueError(f"label {_shortened(label.text)} has anchor = {_shortened(label.anchor)}, "
                     f"size = {_shortened(label.size)}, align = {_shortened(label.align)}; "
                     "these have to be two or three numbers, one that is not negative, and two")


@lru_cache(maxsize=1024)
def _channels(color: str) -> tuple[int, int, int, int]:
    """Red, green, blue and alpha, each 0 to 255, of ``#rrggbb`` or ``#rrggbbaa``; raises ValueError."""
    try:
        if not color.startswith("#") or len(color) not in (7, 9):
            raise ValueError
        red, green, blue, *alpha = bytes.fromhex(color[1:])
    except (AttributeError, ValueError):
        raise ValueError(f"label color or plate = {_shortened(color)} is not a colour such as "
                         "#ff8800 or #ff8800c0") from None
    return red, green, blue, alpha[0] if alpha else 255


def _shortened(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 40 else text[:37] + "..."
