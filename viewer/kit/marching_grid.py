"""Which edges of a grid a surface crosses, and the triangles between them: all cells at once.

Only the signs of the samples matter here. They are handled as bits, 64 samples to a word, until only the
crossed edges and the cells around them are left.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache, lru_cache
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from viewer.kit.bits import Words, moved_down, packed, places_of_ones
from viewer.kit.marching_cases import case_table

Index: TypeAlias = NDArray[np.intp]
Bytes: TypeAlias = NDArray[np.uint8]

CELL = 7                    # all three axes: the direction from a cell's lowest corner to its highest
MOST_SAMPLES = 1 << 29      # eight times a sample's number, and its direction, take 32 bits
SLAB_SAMPLES = 1 << 19      # a slab's table of vertex numbers stays in the processor's cache


@dataclass(frozen=True)
class Grid:
    """The shape of an array of samples, and which axis of space each of its axes is.

    ``axes`` (2, 1, 0) means an array indexed [z, y, x]. A sample's number is its place in the flat array;
    a cell goes by the number of its lowest corner. Directions are bits: 1 along x, 2 along y, 4 along z.
    """

    shape: tuple[int, int, int]
    axes: tuple[int, int, int] = (0, 1, 2)

    @property
    def layer(self) -> int:
        """How many samples a layer of the array's first axis has."""
        return self.shape[1] * self.shape[2]

    def offset(self, direction: int) -> int:
        """How far a step in ``direction`` goes in the flat array."""
        steps = (self.layer, self.shape[2], 1)
        return sum(step for axis, step in zip(self.axes, steps, strict=True) if direction >> axis & 1)

    def coordinates(self, samples: NDArray[np.integer]) -> NDArray[np.uint32]:
        """The (x, y, z) of samples given by number, (n, 3)."""
        found = np.empty((len(samples), 3), np.uint32)
        layers, within = np.divmod(samples.astype(np.uint32), np.uint32(self.layer))
        rows, columns = np.divmod(within, np.uint32(self.shape[2]))
        for axis, numbers in zip(self.axes, (layers, rows, columns), strict=True):
            found[:, axis] = numbers
        return found


@dataclass(frozen=True)
class Topology:
    """A surface, up to where exactly it crosses each edge.

    ``crossings`` (v,) uint32 names each vertex's edge: 8 times the number of the sample where it starts,
    plus its direction. ``triangles`` (m, 3) int32 are numbers of vertices. ``cells`` (c,) are the cells
    that the surface runs through, ascending, ``cases`` (c,) their cases, and ``owners`` (m,) gives the
    place in ``cells`` of each triangle's cell.
    """

    crossings: NDArray[np.uint32]
    triangles: NDArray[np.int32]
    cells: Index
    cases: Bytes
    owners: NDArray[np.int32]


def topology(inside: Bytes, axes: tuple[int, int, int] = (0, 1, 2), method: str = "cubes",
             left_out: Words | None = None) -> Topology:
    """The surface between samples that are 1 (inside) and samples that are 0.

    ``inside`` is a contiguous array of three axes, each at least 2 long. ``left_out`` has a bit set for each
    cell that shall yield nothing; vertices that only such cells have are found all the same.
    """
    grid, table = Grid(inside.shape, axes), packed_table(method)
    signs = packed(inside)
    edges = [crossed_edges(signs, grid, direction) for direction in table.directions]
    mixed = mixed_cells(signs, grid)
    cells = places_of_ones(mixed if left_out is None else mixed & ~left_out)
    cases = cell_cases(inside, grid, cells)
    numbers = np.empty(len(edges) * _largest_slab(grid), np.int32)
    slabs = [_Slab(grid, table, edges, cells, cases, *layers) for layers in _layers(grid)]
    triangles, owners = zip(*(slab.triangles(numbers) for slab in slabs), strict=True)
    return Topology(_crossing_names(edges, table), np.concatenate(triangles), cells, cases, np.concatenate(owners))


def get_ready(grid: Grid, method: str) -> None:
    """Work out what ``topology`` needs once for each method and shape of grid."""
    for direction in (*packed_table(method).directions, CELL):
        has_neighbour(grid, direction)


def crossed_edges(signs: Words, grid: Grid, direction: int) -> Index:
    """The samples whose edge in ``direction`` joins different signs, ascending."""
    return places_of_ones((signs ^ moved_down(signs, grid.offset(direction))) & has_neighbour(grid, direction))


def crossing_count(inside: Bytes, grid: Grid, method: str) -> int:
    """How many edges a surface crosses, and so how many vertices it has."""
    signs = packed(inside)
    found = [(signs ^ moved_down(signs, grid.offset(direction))) & has_neighbour(grid, direction)
             for direction in packed_table(method).directions]
    return sum(int(np.bitwise_count(crossed).sum()) for crossed in found)


def mixed_cells(signs: Words, grid: Grid) -> Words:
    """Which cells have corners of both signs."""
    some = every = signs
    for direction in (1, 2, 4):
        some = some | moved_down(some, grid.offset(direction))
        every = every & moved_down(every, grid.offset(direction))
    return some & ~every & has_neighbour(grid, CELL)


def cells_touching(samples: Words, grid: Grid) -> Words:
    """Which cells have one of these samples for a corner."""
    touched = samples
    for direction in (1, 2, 4):
        touched = touched | moved_down(touched, grid.offset(direction))
    return touched & has_neighbour(grid, CELL)


def ambiguous_face_count(signs: Words, grid: Grid, left_out: Words | None = None) -> int:
    """How many faces of cells have two opposite corners inside and two outside.

    ``left_out`` has a bit set for each sample whose faces do not count.
    """
    total = 0
    for first, second in ((1, 2), (2, 4), (4, 1)):
        across = moved_down(signs, grid.offset(first)), moved_down(signs, grid.offset(second))
        opposite = moved_down(signs, grid.offset(first | second))
        found = ~(signs ^ opposite) & ~(across[0] ^ across[1]) & (signs ^ across[0])
        found &= has_neighbour(grid, first | second)
        if left_out is not None:
            for step in (0, first, second, first | second):
                found &= ~moved_down(left_out, grid.offset(step))
        total += int(np.bitwise_count(found).sum())
    return total


def in_order(found: Topology) -> Topology:
    """The same surface with its triangles sorted by cell."""
    order = np.argsort(found.owners, kind="stable")
    return replace(found, triangles=found.triangles[order], owners=found.owners[order])


def cell_cases(inside: Bytes, grid: Grid, cells: Index) -> Bytes:
    """The case of each of ``cells``: bit c is set where corner c is inside."""
    flat, cases = inside.reshape(-1), np.zeros(len(cells), np.uint8)
    for corner in range(8):
        cases |= flat.take(cells + grid.offset(corner)) << corner
    return cases


@lru_cache(maxsize=16)
def has_neighbour(grid: Grid, direction: int) -> Words:
    """Which samples have a neighbour in ``direction``."""
    flags = np.ones(grid.shape, np.bool_)
    for place, axis in enumerate(grid.axes):
        if direction >> axis & 1:
            flags[(slice(None),) * place + (-1,)] = False
    return packed(flags)


@dataclass(frozen=True)
class PackedTable:
    """A case table as arrays, for looking many cases up at once.

    ``rows[n]`` (256, 3 n) holds for a case of n triangles the number of each corner's edge; ``corners``
    and ``directions_of`` describe the edges, ``directions`` lists the directions there are.
    """

    counts: Bytes
    rows: tuple[Index, ...]
    edges: tuple[tuple[int, int], ...]
    directions: tuple[int, ...]


@cache
def packed_table(method: str) -> PackedTable:
    """The table of ``cubes`` or ``tetrahedra`` as arrays; raises KeyError for any other name."""
    table = case_table(method)
    number = {edge: index for index, edge in enumerate(table.edges)}
    counts = np.array([len(triangles) for triangles in table.cases], np.uint8)
    rows = tuple(np.zeros((256, 3 * count), np.intp) for count in range(int(counts.max()) + 1))
    for case, triangles in enumerate(table.cases):
        rows[len(triangles)][case] = [number[edge] for triangle in triangles for edge in triangle]
    return PackedTable(counts, rows, table.edges, table.directions)


def _crossing_names(edges: list[Index], table: PackedTable) -> NDArray[np.uint32]:
    names = np.empty(sum(map(len, edges)), np.uint32)
    start = 0
    for direction, samples in zip(table.directions, edges, strict=True):
        part = names[start:start + len(samples)]
        np.left_shift(samples, 3, out=part, casting="unsafe")
        part |= np.uint32(direction)
        start += len(samples)
    return names


class _Slab:
    """The cells of a few layers of the array's first axis, from layer ``first`` up to ``last``."""

    def __init__(self, grid: Grid, table: PackedTable, edges: list[Index], cells: Index, cases: Bytes,
                 first: int, last: int) -> None:
        self.grid, self.table, self.edges = grid, table, edges
        self.lowest, self.size = first * grid.layer, (last - first + 1) * grid.layer
        self.begin, end = (int(place) for place in np.searchsorted(cells, (self.lowest, last * grid.layer)))
        self.cells, self.cases = cells[self.begin:end], cases[self.begin:end]

    def triangles(self, numbers: NDArray[np.int32]) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        """The triangles of these cells (m, 3) and their owners (m,): first all cells that have one, then two ...

        ``numbers`` lends memory, which need not be cleared.
        """
        self._number_vertices(numbers)
        to_edge = self._ways_to_edges()
        counts = self.table.counts[self.cases]
        parts, owners = [np.empty(0, np.int32)], [np.empty(0, np.int32)]
        for count, rows in enumerate(self.table.rows[1:], 1):
            chosen = np.flatnonzero(counts == count)
            if len(chosen):
                edges = to_edge[rows].take(self.cases[chosen], axis=0)
                edges += self.cells[chosen, None]
                parts.append(numbers.take(edges.ravel()))
                owners.append(np.repeat((chosen + self.begin).astype(np.int32), count))
        return np.concatenate(parts).reshape(-1, 3), np.concatenate(owners)

    def _number_vertices(self, numbers: NDArray[np.int32]) -> None:
        """Put, for each direction and each sample of the slab, the number of the vertex there, if there is one."""
        before = 0
        for index, samples in enumerate(self.edges):
            begin, end = np.searchsorted(samples, (self.lowest, self.lowest + self.size))
            places = samples[begin:end] + (index * self.size - self.lowest)
            numbers[places] = np.arange(before + begin, before + end, dtype=np.int32)
            before += len(samples)

    def _ways_to_edges(self) -> Index:
        """For each edge of the table, how far from a cell's number its vertex number is found."""
        block = {direction: index * self.size for index, direction in enumerate(self.table.directions)}
        return np.array([block[direction] + self.grid.offset(corner) - self.lowest
                         for corner, direction in self.table.edges])


def _layers(grid: Grid) -> Iterator[tuple[int, int]]:
    """Ranges of cell layers, each with about ``SLAB_SAMPLES`` samples."""
    step = max(1, SLAB_SAMPLES // grid.layer)
    for first in range(0, grid.shape[0] - 1, step):
        yield first, min(first + step, grid.shape[0] - 1)


def _largest_slab(grid: Grid) -> int:
    """How many samples the first slab has, its last layer of corners included."""
    _, last = next(_layers(grid))
    return (last + 1) * grid.layer
