"""Pictures of cells as ball-and-rod models: the one under the microscope, and all cases on one sheet."""

from __future__ import annotations

from collections.abc import Collection
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from viewer.kit.marching_cases import CORNERS, FACES, TETRAHEDRA, case_table, middle
from viewer.kit.marching_cell import Cell
from viewer.kit.models import Frame, Model, Rgb, rgb

# Okabe and Ito (2008), on a light card.
INSIDE, OUTSIDE, NO_VALUE = "#d55e00", "#0072b2", "#cc79a7"
CROSSING, OTHER_WAY = "#16181c", "#cc79a7"
EDGE, DIAGONAL, FAINT = "#8b929c", "#b9bec6", "#c9ccd0"
TETRAHEDRON_COLORS = ("#e69f00", "#56b4e9", "#009e73", "#f0e442", "#0072b2", "#d55e00")
ABSENT = "#d3d4d2"


def microscope_model(cell: Cell, frame: Frame, surface: Rgb, tetrahedra: bool,
                     triangles: NDArray[np.float64] | None = None) -> Model:
    """One cell: its corners by sign, the crossings, the triangles, and both answers on ambiguous faces.

    ``triangles`` (m, 3, 3) take the place of the cell's own.
    """
    model = Model()
    model.box([0, 0, 0], [1, 1, 1], 0.012, rgb(EDGE), frame)
    if tetrahedra:
        _add_diagonals(model, frame)
    colors = np.array([side_color(value) for value in cell.values])
    for color, radius in ((NO_VALUE, 0.05), (INSIDE, 0.062), (OUTSIDE, 0.05)):
        model.balls(CORNERS[colors == color], radius, rgb(color), frame)
    model.balls(cell.places, 0.032, rgb(CROSSING), frame)
    if triangles is None:
        triangles = cell.yielded
    for index in range(6 if tetrahedra and not cell.torn else 1):
        part = triangles[cell.tetrahedron == index] if tetrahedra and not cell.torn else triangles
        model.faces(part, rgb(TETRAHEDRON_COLORS[index]) if tetrahedra else surface, frame)
    model.rods(triangles, np.roll(triangles, -1, axis=1), 0.007, (0.05, 0.06, 0.08), frame)
    for face in cell.ambiguous:
        _add_answers(model, cell, face.face, face.joins_inside, frame)
    return model


def side_color(value: float) -> str:
    """The colour of a corner with this value, less the level."""
    if not np.isfinite(value):
        return NO_VALUE
    return INSIDE if value < 0.0 else OUTSIDE


def _add_diagonals(model: Model, frame: Frame) -> None:
    """The edges of the six tetrahedra that the cube has not."""
    pairs = {(a, b) for corners in TETRAHEDRA for a in corners for b in corners
             if a < b and bin(a ^ b).count("1") > 1}
    starts, ends = zip(*sorted(pairs), strict=True)
    model.rods(CORNERS[list(starts)], CORNERS[list(ends)], 0.006, rgb(DIAGONAL), frame)


def _add_answers(model: Model, cell: Cell, face: int, joins: bool, frame: Frame) -> None:
    """On an ambiguous face the lines that part its inside corners, and those that join them; the right ones thicker."""
    places = {frozenset(crossing.ends): crossing.place for crossing in cell.crossings}
    corners = FACES[face]
    for inside, color in ((True, CROSSING), (False, OTHER_WAY)):
        around = [place for place, corner in enumerate(corners) if (cell.values[corner] < 0.0) == inside]
        starts = [places[frozenset((corners[place - 1], corners[place]))] for place in around]
        ends = [places[frozenset((corners[place], corners[(place + 1) % 4]))] for place in around]
        model.rods(starts, ends, 0.014 if inside != joins else 0.006, rgb(color), frame)


def sheet_frames(aspect: float, left: float, right: float, bottom: float, top: float) -> dict[int, Frame]:
    """A place for each of the 256 cases in a rectangle of the picture: as large as rows and columns allow."""
    width, height = (right - left) * aspect, top - bottom
    columns = max((8, 16, 20, 22, 26, 32, 43), key=lambda count: min(width / count, height / -(-256 // count)))
    rows = -(-256 // columns)
    pitch_x, pitch_y = (right - left) / columns, height / rows
    size = 0.51 * min(width / columns, height / rows)
    return {case: (left + (case % columns + 0.5) * pitch_x, top - (case // columns + 0.56) * pitch_y, size)
            for case in range(256)}


def sheet_model(frames: dict[int, Frame], method: str, present: Collection[int], surface: Rgb) -> Model:
    """All cases, those that are ``present`` in colour."""
    model = Model()
    for wanted, edges, skin in ((True, rgb(EDGE), surface), (False, rgb(FAINT), rgb(ABSENT))):
        for case, frame in frames.items():
            if (case in present) == wanted:
                _add_case(model, case, method, frame, edges, skin)
    return model


def _add_case(model: Model, case: int, method: str, frame: Frame, edges: Rgb, skin: Rgb) -> None:
    model.box([0, 0, 0], [1, 1, 1], 0.022, edges, frame)
    inside = [corner for corner in range(8) if case >> corner & 1]
    if inside:
        model.balls(CORNERS[inside], 0.085, rgb(INSIDE), frame)
    triangles = case_triangles(method, case)
    if len(triangles):
        model.faces(triangles, skin, frame)


@lru_cache(maxsize=512)
def case_triangles(method: str, case: int) -> NDArray[np.float64]:
    """The triangles of a case between the middles of edges, (m, 3, 3)."""
    return np.array([[middle(edge) for edge in triangle] for triangle in case_table(method).cases[case]]
                    ).reshape(-1, 3, 3)


def rotations() -> list[tuple[int, ...]]:
    """The 24 ways to turn a cell, each as the corners that corners 0 to 7 go to."""
    found = {tuple(range(8))}
    waiting = [tuple(range(8))]
    while waiting:
        way = waiting.pop()
        for further in (tuple(map(_turned_about_x, way)), tuple(map(_turned_about_z, way))):
            if further not in found:
                found.add(further)
                waiting.append(further)
    return sorted(found)


def _turned_about_x(corner: int) -> int:
    x, y, z = corner & 1, corner >> 1 & 1, corner >> 2 & 1
    return x | (1 - z) << 1 | y << 2


def _turned_about_z(corner: int) -> int:
    x, y, z = corner & 1, corner >> 1 & 1, corner >> 2 & 1
    return (1 - y) | x << 1 | z << 2


@lru_cache(maxsize=1)
def case_classes() -> tuple[int, ...]:
    """For each of the 256 cases which of the 15 it is the same as, once turned or with the signs exchanged.

    Numbered as they first come up; 0 is the empty case.
    """
    ways = rotations()
    smallest = [min(_turned(case ^ flip, way) for way in ways for flip in (0, 255)) for case in range(256)]
    order = {first: index for index, first in enumerate(dict.fromkeys(smallest))}
    return tuple(order[first] for first in smallest)


def _turned(case: int, way: tuple[int, ...]) -> int:
    return sum(1 << way[corner] for corner in range(8) if case >> corner & 1)
