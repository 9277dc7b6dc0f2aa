"""Marching cubes that draws the level set of the trilinear function in each cell as it is: every tunnel, no crack.

Between eight samples, a function linear along each axis. Its level set crosses an edge of the grid where the
signs at the ends differ (Lorensen and Cline, "Marching cubes", 1987). Signs do not say all: a face whose signs
alternate may join either pair of corners (Nielson and Hamann, "The asymptotic decider", 1991), and inside a cell
two sheets may be joined by a tunnel or not (Chernyaev, "Marching cubes 33", 1995). Tables that list these cases
have kept having errors (Custodio, Etiene, Pesco and Silva, 2013); here the loops on each cell's boundary are
followed, two decisions are made by formula, and the triangles follow from those.

- ``trilinear_cell``: the cell, and the loops on its boundary
- ``trilinear_decision``: which corners a face joins, and whether there is a tunnel
- ``trilinear_grid``: the cells that the level set passes, and its crossings with the grid's edges
- ``trilinear_patch``: the triangles, once for each kind of cell
- ``trilinear_point``: the places of vertices inside cells
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from viewer.kit.trilinear_cell import CROSSED
from viewer.kit.trilinear_grid import (
    Cells,
    Grid,
    Indices,
    grid_crossings,
    grid_of,
    mixed_cells,
    samples_without_value,
)
from viewer.kit.trilinear_patch import CROSSINGS, patch
from viewer.kit.trilinear_point import hub_points, waist_points

Vertices = NDArray[np.float64]
Triangles = NDArray[np.int32]


class _Patches(NamedTuple):
    """The templates that a grid needs, end to end, and the run of each cell in them: its first place and length."""
    triangles: NDArray[np.int64]
    triangle_runs: tuple[Indices, Indices]
    points: NDArray[np.int64]
    point_runs: tuple[Indices, Indices]


def trilinear_surface(values: ArrayLike, level: float) -> tuple[Vertices, Triangles]:
    """The surface where the trilinear interpolant of ``values`` (nx, ny, nz) is ``level``.

    Returns vertices (n, 3) in units of the grid, ``values[i, j, k]`` being at (i, j, k), and triangles (m, 3),
    counter-clockwise seen from larger values. A value at the level counts as larger; so does float32 0.1 at the
    level 0.1, which is rounded as the values are. Cells with a sample that is not finite are left out.
    """
    grid = grid_of(values, level)
    without = samples_without_value(grid)
    cells = mixed_cells(grid, without)
    if not len(cells.origin):
        return np.empty((0, 3)), np.empty((0, 3), np.int32)
    crossings, on_edges = grid_crossings(grid, cells)
    patches = _patches(cells)
    vertices = np.concatenate([crossings, _points(grid, cells, patches, crossings, on_edges)])
    triangles = _triangles(patches, on_edges, len(crossings))
    return (vertices, triangles) if without is None else _used(vertices, triangles)


def _patches(cells: Cells) -> _Patches:
    """The template of each cell; there are far fewer kinds than cells."""
    kinds, kind = _distinct(cells.case + (cells.joined << 8) + (cells.tunnel << 14))
    chosen = [patch(int(one & 255), int(one >> 8 & 63), int(one >> 14)) for one in kinds]
    triangles = [one.triangles for one in chosen]
    points = [one.points for one in chosen]
    return _Patches(
        np.concatenate([np.empty((0, 3), np.int64), *triangles]), _runs_of(triangles, kind),
        np.concatenate([np.empty(0, np.int64), *points]), _runs_of(points, kind))


def _distinct(keys: NDArray[np.int64]) -> tuple[NDArray[np.int64], Indices]:
    """The distinct among small numbers, and for each of the numbers its place among those."""
    present = np.bincount(keys) > 0
    return np.flatnonzero(present), (np.cumsum(present) - 1)[keys]


def _runs_of(parts: list[NDArray[np.int64]], part: Indices) -> tuple[Indices, Indices]:
    """Where each wanted ``part`` starts if the parts stand end to end, and its length."""
    length = np.array([len(one) for one in parts], np.intp)
    return (np.cumsum(length) - length)[part], length[part]


def _run_places(runs: tuple[Indices, Indices]) -> tuple[Indices, Indices]:
    """All places in the runs, in turn, and for each the number of its run."""
    first, length = runs
    before = np.cumsum(length) - length
    return np.repeat(first - before, length) + np.arange(length.sum()), np.repeat(np.arange(len(length)), length)


def _points(grid: Grid, cells: Cells, patches: _Patches, crossings: Vertices,
            on_edges: NDArray[np.int32]) -> Vertices:
    """The vertices inside cells, cell by cell."""
    place, owner = _run_places(patches.point_runs)
    what = patches.points[place]
    corners, base = grid.corners(cells.origin[owner]), grid.coordinates(cells.origin[owner])
    waist, hub = np.flatnonzero(what < 0), np.flatnonzero(what > 0)
    base[waist] += waist_points(corners[waist], -1 - what[waist])
    chosen = (what[hub, None] >> np.arange(CROSSINGS) & 1).astype(np.bool_)
    around = crossings[np.where(chosen, on_edges[owner[hub]], 0)] - base[hub, None]
    middle = np.einsum("ij,ijk->ik", chosen, around) / chosen.sum(axis=1, keepdims=True)
    alone = (chosen == CROSSED[cells.case[owner[hub]]]).all(axis=1)
    base[hub] += hub_points(corners[hub], middle, alone)
    return base


def _triangles(patches: _Patches, on_edges: NDArray[np.int32], first_point: int) -> Triangles:
    """The triangles of all cells, their templates' vertices replaced by the grid's."""
    place, owner = _run_places(patches.triangle_runs)
    vertex = patches.triangles[place]
    point_count = patches.point_runs[1]
    most = int(point_count.max(initial=0))
    before = first_point + np.cumsum(point_count) - point_count
    number = np.concatenate([on_edges, (before[:, None] + np.arange(most)).astype(np.int32)], axis=1)
    return number[owner[:, None], vertex]


def _used(vertices: Vertices, triangles: Triangles) -> tuple[Vertices, Triangles]:
    """The mesh without the vertices that no triangle uses."""
    used = np.zeros(len(vertices), np.bool_)
    used[triangles] = True
    return vertices[used], (np.cumsum(used) - 1).astype(np.int32)[triangles]
