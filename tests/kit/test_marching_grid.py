"""Cells, edges and faces of a grid, found by bits, against loops over every cell."""

from __future__ import annotations

from collections import Counter
from itertools import product

import numpy as np
import pytest
from numpy.typing import NDArray

from tests.kit.surface_checks import METHODS
from viewer.kit.bits import packed, places_of_ones
from viewer.kit.marching_cases import ambiguous_faces, case_table
from viewer.kit.marching_grid import (
    Grid,
    ambiguous_face_count,
    cell_cases,
    cells_touching,
    crossed_edges,
    get_ready,
    has_neighbour,
    in_order,
    mixed_cells,
    packed_table,
    topology,
)

Axes = tuple[int, int, int]
GRIDS: list[tuple[tuple[int, int, int], Axes]] = [
    ((2, 2, 2), (0, 1, 2)), ((3, 2, 2), (0, 1, 2)), ((2, 4, 3), (2, 1, 0)), ((5, 4, 3), (1, 2, 0)),
    ((4, 7, 9), (0, 1, 2)), ((4, 7, 9), (2, 1, 0))]

pytestmark = pytest.mark.parametrize(("shape", "axes"), GRIDS)


class Sampled:
    """A grid of random signs, and what can be said of it by looking at one cell after the other."""

    def __init__(self, shape: tuple[int, int, int], axes: Axes) -> None:
        self.inside = np.random.default_rng(sum(shape)).integers(0, 2, shape, np.uint8)
        self.grid = Grid(shape, axes)
        self.by_xyz = self.inside.transpose([axes.index(axis) for axis in range(3)])
        self.sizes = self.by_xyz.shape
        self.cells = list(product(*(range(size - 1) for size in self.sizes)))

    def number(self, place: tuple[int, ...]) -> int:
        """Where the sample at x, y, z is in the flat array."""
        return int(np.ravel_multi_index([place[axis] for axis in self.grid.axes], self.grid.shape))

    def corners(self, cell: tuple[int, ...]) -> list[tuple[int, ...]]:
        """The corners of a cell, 0 to 7."""
        return [(cell[0] + (c & 1), cell[1] + (c >> 1 & 1), cell[2] + (c >> 2 & 1)) for c in range(8)]

    def case(self, cell: tuple[int, ...]) -> int:
        """The case of a cell."""
        return sum(int(self.by_xyz[corner]) << c for c, corner in enumerate(self.corners(cell)))

    def cases(self) -> dict[int, int]:
        """By number, the cells with corners of both signs."""
        return {self.number(cell): self.case(cell) for cell in self.cells if self.case(cell) not in (0, 255)}


def flagged(size: int, count: int) -> NDArray[np.bool_]:
    """A few flags set among many."""
    flags = np.zeros(size, np.bool_)
    flags[np.random.default_rng(count).integers(0, size, count)] = True
    return flags


def test_samples_have_numbers_and_coordinates(shape: tuple[int, int, int], axes: Axes) -> None:
    """Each way back again; a step along an axis is an offset."""
    sampled = Sampled(shape, axes)
    places = list(product(*map(range, sampled.sizes)))
    numbers = np.array([sampled.number(place) for place in places])
    assert sampled.grid.coordinates(numbers).tolist() == [list(place) for place in places]
    for direction, corner in enumerate(sampled.corners((0, 0, 0))):
        assert sampled.grid.offset(direction) == sampled.number(corner)
        neighbours = {sampled.number(place) for place in places
                      if all(p + c < size for p, c, size in zip(place, corner, sampled.sizes, strict=True))}
        assert set(places_of_ones(has_neighbour(sampled.grid, direction))) == neighbours


def test_cells_of_both_signs_and_their_cases(shape: tuple[int, int, int], axes: Axes) -> None:
    """Those of the cells one by one, ascending."""
    sampled = Sampled(shape, axes)
    cells = places_of_ones(mixed_cells(packed(sampled.inside), sampled.grid))
    assert cells.tolist() == sorted(sampled.cases())
    assert cell_cases(sampled.inside, sampled.grid, cells).tolist() == [sampled.cases()[cell] for cell in cells]


def test_edges_between_signs(shape: tuple[int, int, int], axes: Axes) -> None:
    """In all seven directions."""
    sampled = Sampled(shape, axes)
    for direction in range(1, 8):
        step = sampled.corners((0, 0, 0))[direction]
        expected = []
        for place in product(*map(range, sampled.sizes)):
            end = tuple(p + s for p, s in zip(place, step, strict=True))
            if all(e < size for e, size in zip(end, sampled.sizes, strict=True)):
                if sampled.by_xyz[place] != sampled.by_xyz[end]:
                    expected.append(sampled.number(place))
        assert crossed_edges(packed(sampled.inside), sampled.grid, direction).tolist() == sorted(expected)


@pytest.mark.parametrize("count", [0, 1, 3])
def test_cells_that_touch_samples(shape: tuple[int, int, int], axes: Axes, count: int) -> None:
    """Up to eight for each sample."""
    sampled = Sampled(shape, axes)
    flags = flagged(sampled.inside.size, count)
    expected = [sampled.number(cell) for cell in sampled.cells
                if any(flags[sampled.number(corner)] for corner in sampled.corners(cell))]
    assert places_of_ones(cells_touching(packed(flags), sampled.grid)).tolist() == sorted(expected)


@pytest.mark.parametrize("count", [None, 0, 1, 4])
def test_ambiguous_faces_are_counted_once(shape: tuple[int, int, int], axes: Axes, count: int | None) -> None:
    """Those between two cells too; none with a sample that does not count."""
    sampled = Sampled(shape, axes)
    left_out = flagged(sampled.inside.size, count or 0)
    expected = 0
    for first, second in ((0, 1), (1, 2), (2, 0)):
        steps = [np.eye(3, dtype=int)[axis] for axis in (first, second)]
        for place in product(*map(range, sampled.sizes)):
            around = [tuple(np.array(place) + a * steps[0] + b * steps[1]) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
            if all((np.array(corner) < sampled.sizes).all() for corner in around):
                a, b, c, d = (sampled.by_xyz[corner] for corner in around)
                counts = not any(left_out[sampled.number(corner)] for corner in around)
                expected += bool(a == c and b == d and a != b and counts)
    words = None if count is None else packed(left_out)
    assert ambiguous_face_count(packed(sampled.inside), sampled.grid, words) == expected
    if shape == (2, 2, 2) and not count:
        assert expected == len(ambiguous_faces(sampled.case((0, 0, 0))))


@pytest.mark.parametrize("method", METHODS)
def test_triangles_belong_to_cells(shape: tuple[int, int, int], axes: Axes, method: str) -> None:
    """As many to each as its case has, on its own edges; sorted by cell they are still the same triangles."""
    sampled = Sampled(shape, axes)
    get_ready(sampled.grid, method)
    found = topology(sampled.inside, axes, method)
    assert dict(zip(found.cells.tolist(), found.cases.tolist(), strict=True)) == sampled.cases()
    table = case_table(method)
    assert len(found.triangles) == len(found.owners)
    assert np.array_equal(np.bincount(found.owners, minlength=len(found.cells)), table.counts[found.cases])
    ends = 8 * found.cells[:, None] + np.array([8 * sampled.grid.offset(c) + d for c, d in table.edges])
    on_edges = (found.crossings[found.triangles][:, :, None] == ends[found.owners][:, None, :])
    assert (on_edges.sum(axis=2) == 1).all()
    ordered = in_order(found)
    assert (np.diff(ordered.owners) >= 0).all()
    pairs, ordered_pairs = (Counter(zip(t.owners.tolist(), map(tuple, t.triangles.tolist()), strict=True))
                            for t in (found, ordered))
    assert pairs == ordered_pairs
    assert ordered.crossings is found.crossings and ordered.cells is found.cells


@pytest.mark.parametrize("method", METHODS)
def test_cells_left_out_yield_nothing(shape: tuple[int, int, int], axes: Axes, method: str) -> None:
    """The others keep their triangles."""
    sampled = Sampled(shape, axes)
    whole, left_out = topology(sampled.inside, axes, method), flagged(sampled.inside.size, 4)
    part = topology(sampled.inside, axes, method, packed(left_out))
    assert part.cells.tolist() == [cell for cell in whole.cells if not left_out[cell]]
    kept = ~left_out[whole.cells[whole.owners]]
    assert Counter(map(tuple, part.triangles.tolist())) == Counter(map(tuple, whole.triangles[kept].tolist()))
    assert np.array_equal(part.crossings, whole.crossings)


@pytest.mark.parametrize("method", METHODS)
def test_the_packed_table_has_every_triangle(shape: tuple[int, int, int], axes: Axes, method: str) -> None:
    """Row by row as the table has it."""
    table, arrays = case_table(method), packed_table(method)
    for case, triangles in enumerate(table.cases):
        row = arrays.rows[arrays.counts[case]][case]
        assert [arrays.edges[edge] for edge in row] == [edge for triangle in triangles for edge in triangle]
