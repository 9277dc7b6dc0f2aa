"""What a scene says beside its picture: words in it, tables next to it, and what a click on it means."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Cell: TypeAlias = "float | str"


@dataclass(frozen=True)
class Label:
    """Text in the picture, upright and of constant size, always in front.

    ``anchor`` is a place in the world (x, y, z), or in the picture (across, up), each -1 to 1. ``align``
    says which point of the text stands there: (0, 0) its lower left, (0.5, 0.5) its middle, (1, 1) its
    upper right corner. ``size`` is in standard letter heights; ``color`` and ``plate`` are ``#rrggbb`` or
    ``#rrggbbaa``, and an empty ``plate`` means none. Lines are parted by ``\\n``.
    """

    text: str
    anchor: tuple[float, float, float] | tuple[float, float]
    size: float = 1.0
    color: str = "#16181c"
    align: tuple[float, float] = (0.5, 0.5)
    plate: str = ""
    bold: bool = False


@dataclass(frozen=True)
class Table:
    """Rows of numbers and words under ``columns``, shown beside the picture and given as JSON."""

    columns: tuple[str, ...]
    rows: Sequence[Sequence[Cell]]

    def __post_init__(self) -> None:
        wrong = [row for row in self.rows if len(row) != len(self.columns)]
        if wrong:
            raise ValueError(f"a table of {len(self.columns)} columns has a row of {len(wrong[0])}")

    def records(self) -> list[dict[str, Cell]]:
        """Each row by its columns' names."""
        return [dict(zip(self.columns, row, strict=True)) for row in self.rows]


@dataclass(frozen=True)
class Click:
    """A click on the picture: ``place`` in it, (across, up), each -1 to 1, and the ray that leaves the eye there.

    ``origin`` and ``direction`` (3,) float64, the direction of length one, are in the world; ``aspect`` is
    the picture's width over its height, ``height`` its height in pixels.
    """

    place: tuple[float, float]
    origin: NDArray[np.float64]
    direction: NDArray[np.float64]
    aspect: float
    height: int
