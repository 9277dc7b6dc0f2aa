"""What a scene says beside its picture: words in it, tables next to it, what a click means, what a hand can hold."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Cell: TypeAlias = "float | str"
SQUARE_ENOUGH = 1e-4     # how far a rotation may be from one: single precision after many products


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


@dataclass(frozen=True)
class Handle:
    """Something in the picture that a hand can turn or move, in the window.

    ``matrix`` (4, 4) float64, for column vectors, is where it stands in the world: a rotation and a place.
    Its rings turn it about its own axes, its arrows move it along them. ``name`` is what the history calls it,
    and what tells one handle from another.
    """

    matrix: NDArray[np.float64]
    name: str = ""
    turns: bool = True
    moves: bool = False


def checked_handle(handle: Any) -> Handle | None:
    """What a scene's ``handle`` gave, with a matrix of its own; raises TypeError or ValueError for what is wrong."""
    if handle is None:
        return None
    if not isinstance(handle, Handle):
        raise TypeError("handle gives neither a Handle nor None")
    try:
        matrix = np.array(handle.matrix, np.float64)
    except (TypeError, ValueError):
        raise TypeError(f"handle {handle.name} has a matrix that is not one of numbers") from None
    wrong = _wrong_with(matrix)
    if wrong:
        raise ValueError(f"handle {handle.name} has a matrix {wrong}; it has to be (4, 4), a rotation and a place")
    return Handle(matrix, str(handle.name), bool(handle.turns), bool(handle.moves))


def _wrong_with(matrix: NDArray[np.float64]) -> str:
    """What keeps ``matrix`` from being a rotation and a place; nothing if it is one."""
    if matrix.shape != (4, 4):
        return f"of shape {matrix.shape}"
    if not np.isfinite(matrix).all():
        return "that is not finite"
    if np.abs(matrix[3] - (0.0, 0.0, 0.0, 1.0)).max() > SQUARE_ENOUGH:
        return "whose last row is not 0, 0, 0, 1"
    turn = matrix[:3, :3]
    if np.abs(turn @ turn.T - np.eye(3)).max() > SQUARE_ENOUGH:
        return "that scales or shears"
    return "that mirrors" if np.linalg.det(turn) < 0.0 else ""
