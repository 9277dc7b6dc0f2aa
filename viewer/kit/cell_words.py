"""What there is to say of a cell under the microscope: headline, lines for the picture, rows for tables."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from viewer.kit.card import written
from viewer.kit.marching_cell import Cell, edge_name

Row = tuple["float | str", ...]
CORNER_COLUMNS = ("corner", "sign", "value")
CROSSING_COLUMNS = ("edge", "A", "B", "t")
FACE_COLUMNS = ("face", "saddle", "trilinear", "here")


def signed(value: float, digits: int = 3) -> str:
    """A number with its sign, as one writes it: ``+0.25``, ``\u22121.2``."""
    return written(value, digits, "+")


def corner_rows(cell: Cell) -> list[Row]:
    """Each corner's number, with its bits x y z, its sign and its value less the level."""
    return [(f"{corner} ({''.join(str(corner >> axis & 1) for axis in range(3))})",
             "no value" if not np.isfinite(value) else "inside" if value < 0.0 else "outside", float(value))
            for corner, value in enumerate(cell.values)]


def crossing_rows(cell: Cell) -> list[Row]:
    """Each crossed edge's corners, the values A and B at its ends and t = A / (A - B)."""
    return [(edge_name(crossing.edge), crossing.A, crossing.B, crossing.t) for crossing in cell.crossings]


def face_rows(cell: Cell) -> list[Row]:
    """Each ambiguous face, the bilinear value at its saddle, what that makes of the inside, and what is made here."""
    said = [(face, "joined" if face.joins_inside else "parted") for face in cell.ambiguous]
    return [(face.name, face.saddle, word, word if cell.decided is not None else "parted") for face, word in said]


def headline(cell: Cell, name: str) -> str:
    """The cell's name, its case in decimal and binary, and how many triangles it yields."""
    if not cell.has_values:
        return f"{name}\na corner without a value: the cell yields nothing"
    if cell.torn:
        return f"{name}\nthe function jumps here: the cell yields nothing"
    count = len(cell.yielded)
    return f"{name}\ncase {cell.case} = {cell.binary} in binary: {count} triangle{'' if count == 1 else 's'}"


def face_lines(cell: Cell) -> Iterator[str]:
    """One line for each ambiguous face: what is made of it, or what would be if the saddle were asked."""
    for face in cell.ambiguous:
        asked = cell.decided is not None or not face.joins_inside
        word = "would join" if not asked else "joined" if face.joins_inside else "parted"
        yield f"{face.name}: saddle {signed(face.saddle, 2)}, {word}"
