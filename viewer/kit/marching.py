"""Marching cubes and marching tetrahedra: a surface through a grid of samples.

    vertices, triangles = marching_cubes(values, level=0.5, spacing=(1.0, 1.0, 2.5))

Inside is where a value is below the level; a sample exactly at the level is outside. Where an edge of
the grid joins inside and outside, the values A and B at its ends, less the level, put a vertex at
t = A / (A - B) of the way: where a straight line from A to B is zero.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from viewer.kit import bits
from viewer.kit.interpolation import crossing_fraction
from viewer.kit.marching_grid import MOST_SAMPLES, Grid, Topology, cells_touching, topology

METHODS = ("cubes", "tetrahedra")
TOPOLOGIES = ("table", "trilinear")

Mesh = tuple[NDArray[np.float32], NDArray[np.int32]]


def marching_cubes(values: ArrayLike, level: float = 0.0, spacing: Sequence[float] = (1, 1, 1),
                   method: str = "cubes", topology: str = "table") -> Mesh:
    """The surface where ``values`` (nx, ny, nz) are ``level``: vertices (n, 3) float32, triangles (m, 3) int32.

    ``values[i, j, k]`` sits at (i, j, k) times ``spacing``. Triangles are counter-clockwise as seen from
    the side where values are larger; vertices are shared. ``method`` is ``cubes`` (Lorensen and Cline
    1987, with the consistent faces of Montani et al. 1994) or ``tetrahedra`` (Doi and Koide 1991).
    ``topology`` is ``table`` or, for cubes, ``trilinear``: the surface of the trilinear interpolant
    itself, its ambiguous faces and cells decided. Cells that touch a sample which is NaN or infinite
    yield nothing. Raises ValueError for values that are no such array of real numbers, and for a name,
    level or spacing that is not as described.
    """
    samples = checked_samples(values)
    _check(level, spacing, method, topology)
    if topology == "trilinear":
        from viewer.kit.trilinear import trilinear_surface

        vertices, triangles = trilinear_surface(samples, level)
    else:
        vertices, triangles = table_surface(samples, level, method)
    return (vertices * np.asarray(spacing, np.float64)).astype(np.float32), triangles


def table_surface(samples: NDArray[Any], level: float, method: str) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """The surface in units of cells: vertices (n, 3) float64, triangles (m, 3) int32."""
    samples, grid = in_memory_order(samples)
    level = rounded_level(samples, level)
    found = topology(is_inside(samples, level).view(np.uint8), grid.axes, method, cells_without_value(samples, grid))
    vertices = crossing_places(found, samples, level, grid)
    used = vertices_in_use(found)
    if used is None:
        return vertices, found.triangles
    return vertices[used], renumbered(found.triangles, used)


def checked_samples(values: ArrayLike) -> NDArray[Any]:
    """``values`` as an array of real numbers with three axes, each at least 2 long; raises ValueError.

    So it does for more than ``MOST_SAMPLES``.
    """
    samples = np.asarray(values)
    if samples.dtype.kind not in "biuf":
        raise ValueError(f"values of type {samples.dtype} are not real numbers")
    if samples.ndim != 3 or min(samples.shape) < 2:
        raise ValueError(f"values of shape {samples.shape} are not three axes of at least 2 samples")
    if samples.size > MOST_SAMPLES:
        raise ValueError(f"values of shape {samples.shape} are {samples.size} samples, more than {MOST_SAMPLES}")
    if samples.dtype.kind == "b":
        return samples.view(np.uint8)
    if samples.dtype.kind == "f" and samples.dtype.itemsize not in (4, 8):
        return samples.astype(np.float32 if samples.dtype.itemsize < 4 else np.float64)
    return samples.astype(samples.dtype.newbyteorder("="), copy=False)


def in_memory_order(samples: NDArray[Any]) -> tuple[NDArray[Any], Grid]:
    """The samples as a contiguous array, turned over rather than copied where that will do, and its grid."""
    turned = not samples.flags.c_contiguous and samples.flags.f_contiguous
    samples = samples.T if turned else np.ascontiguousarray(samples)
    return samples, Grid(samples.shape, (2, 1, 0) if turned else (0, 1, 2))


def rounded_level(samples: NDArray[Any], level: float) -> float:
    """The level as precise as the samples, whatever kind of number it is; infinite where it is beyond them all."""
    if samples.dtype.kind != "f":
        return level
    with np.errstate(over="ignore"):
        return float(samples.dtype.type(level))


def is_inside(samples: NDArray[Any], level: float) -> NDArray[np.bool_]:
    """Which samples are below the level; NaN never is."""
    # A whole number is below 2.5 where it is below 3, and whole numbers compare faster.
    inside: NDArray[np.bool_] = samples < (level if samples.dtype.kind == "f" else math.ceil(level))
    return inside


def cells_without_value(samples: NDArray[Any], grid: Grid) -> bits.Words | None:
    """The cells that touch a sample which is NaN or infinite; None where there is none."""
    if samples.dtype.kind != "f":
        return None
    with np.errstate(all="ignore"):
        if np.isfinite(samples.sum()):      # cheaper than asking each
            return None
    without = ~np.isfinite(samples)
    return cells_touching(bits.packed(without), grid) if without.any() else None


def crossing_places(found: Topology, samples: NDArray[Any], level: float, grid: Grid) -> NDArray[np.float64]:
    """Where the surface crosses each edge, in units of cells, (v, 3)."""
    edges = crossed_edges(found, samples, level, grid)
    return np.asarray(edges.starts + edges.t[:, None] * edges.steps)


class CrossedEdges(NamedTuple):
    """Edges that a surface crosses, in units of cells: where they start (v, 3), the step to their end (v, 3),
    the values ``A`` and ``B`` at their ends, less the level, and how far along ``t`` they are crossed, all (v,)."""

    starts: NDArray[np.float64]
    steps: NDArray[np.float64]
    A: NDArray[np.float64]
    B: NDArray[np.float64]
    t: NDArray[np.floating[Any]]


def crossed_edges(found: Topology, samples: NDArray[Any], level: float, grid: Grid) -> CrossedEdges:
    """The edges that the surface crosses, with what is known of them."""
    starts = found.crossings >> np.uint32(3)
    directions = (found.crossings & np.uint32(7)).astype(np.intp)
    ends = starts + np.array([grid.offset(direction) for direction in range(8)], np.uint32)[directions]
    flat = samples.reshape(-1)
    with np.errstate(all="ignore"):
        A, B = (flat.take(ends_of).astype(np.float64) - level for ends_of in (starts, ends))
    steps = (np.arange(8)[:, None] >> np.arange(3) & 1).astype(np.float64)
    return CrossedEdges(grid.coordinates(starts).astype(np.float64), steps[directions], A, B, crossing_fraction(A, B))


def vertices_in_use(found: Topology) -> NDArray[np.intp] | None:
    """The numbers of the vertices that some triangle has; None where all are."""
    used = np.zeros(len(found.crossings), np.bool_)
    used[found.triangles.reshape(-1)] = True
    return None if used.all() else np.flatnonzero(used)


def renumbered(triangles: NDArray[np.int32], used: NDArray[np.intp]) -> NDArray[np.int32]:
    """The triangles once only the vertices ``used`` are left."""
    numbers = np.zeros(int(used[-1]) + 1 if len(used) else 0, np.int32)
    numbers[used] = np.arange(len(used), dtype=np.int32)
    return numbers[triangles]


def _check(level: float, spacing: Sequence[float], method: str, topology: str) -> None:
    if not math.isfinite(level):
        raise ValueError(f"level = {level} is not a finite number")
    if np.shape(spacing) != (3,) or not all(0.0 < step < math.inf for step in spacing):
        raise ValueError(f"spacing = {spacing} is not three numbers above 0")
    for name, value, allowed in (("method", method, METHODS), ("topology", topology, TOPOLOGIES)):
        if value not in allowed:
            raise ValueError(f"{name} = {value} is not one of {', '.join(allowed)}")
    if (method, topology) == ("tetrahedra", "trilinear"):
        raise ValueError("topology = trilinear is for method = cubes; tetrahedra leave nothing to decide")
