"""Where a level set passes a grid: the cells, what is decided in each, and the crossings on the grid's edges."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from viewer.kit.interpolation import crossing_fraction
from viewer.kit.trilinear_cell import CORNERS, DOUBTFUL, EDGES
from viewer.kit.trilinear_decision import joined_faces, tunnels

Indices = NDArray[np.intp]
Values = NDArray[np.float64]



class Grid(NamedTuple):
    """The samples, in one piece of memory, and the level as precise as they are, so that a sample may be at it."""
    samples: NDArray[Any]
    level: float

    @property
    def strides(self) -> NDArray[np.int64]:
        """How many samples further neighbours along each axis are."""
        return np.array([self.samples.shape[1] * self.samples.shape[2], self.samples.shape[2], 1])

    def excess(self, places: Indices) -> Values:
        """The samples at flat ``places`` minus the level."""
        with np.errstate(over="ignore"):
            return self.samples.reshape(-1).take(places).astype(np.float64) - self.level

    def coordinates(self, places: Indices) -> Values:
        """The points (n, 3) of the samples at flat ``places``."""
        return np.stack(np.unravel_index(places, self.samples.shape), axis=1).astype(np.float64)

    def corners(self, origin: Indices) -> Values:
        """The excess (n, 8) at the corners of cells, times a power of two that lets one multiply without care."""
        corners = self.excess(origin[:, None] + CORNERS @ self.strides)
        largest = max(corners.max(initial=0.0), -corners.min(initial=0.0))
        return np.asarray(np.ldexp(corners, -np.frexp(largest)[1]))


class Cells(NamedTuple):
    """The cells that the level set passes: the place of their lowest corner in the flat grid, and their kind."""
    origin: Indices
    case: NDArray[np.uint8]
    joined: NDArray[np.int64]
    tunnel: NDArray[np.int64]


def grid_of(values: ArrayLike, level: float) -> Grid:
    """``values`` as a grid, their type kept if it has no more than a double's precision."""
    samples = np.ascontiguousarray(values)
    if samples.ndim != 3:
        raise ValueError(f"values: a grid (nx, ny, nz) is needed, not an array of shape {samples.shape}")
    if samples.dtype not in (np.float32, np.float64):
        samples = samples.astype(np.float64)
    with np.errstate(over="ignore"):
        return Grid(samples, float(samples.dtype.type(level)))


def samples_without_value(grid: Grid) -> NDArray[np.bool_] | None:
    """Which samples are not finite; None if all are."""
    with np.errstate(all="ignore"):
        if np.isfinite(grid.samples.sum()):    # faster than asking each
            return None
    without = ~np.isfinite(grid.samples)
    return without if without.any() else None


def mixed_cells(grid: Grid, without: NDArray[np.bool_] | None) -> Cells:
    """The cells with corners on both sides of the level, but for those with a sample ``without`` a value."""
    code = (grid.samples < grid.level).view(np.uint8)
    code = code[:-1] | code[1:] << np.uint8(1)
    code = code[:, :-1] | code[:, 1:] << np.uint8(2)
    code = code[..., :-1] | code[..., 1:] << np.uint8(4)
    mixed = (code != 0) & (code != 255)
    if without is not None:
        without = without[:-1] | without[1:]
        without = without[:, :-1] | without[:, 1:]
        mixed &= ~(without[..., :-1] | without[..., 1:])
    place = np.flatnonzero(mixed)
    origin = np.ravel_multi_index(np.unravel_index(place, mixed.shape), grid.samples.shape) if len(place) else place
    case = code.reshape(-1)[place]
    joined, tunnel = np.zeros((2, len(case)), np.int64)
    doubtful = np.flatnonzero(DOUBTFUL[case])
    corners = grid.corners(origin[doubtful])
    joined[doubtful], tunnel[doubtful] = joined_faces(corners, case[doubtful]), tunnels(corners)
    return Cells(origin, case, joined, tunnel)


def grid_crossings(grid: Grid, cells: Cells) -> tuple[Values, NDArray[np.int32]]:
    """The vertices on the edges of the grid, at t = A / (A - B), and which of them each cell has on its 12 edges."""
    inside = grid.samples < grid.level
    number: NDArray[np.int32] = np.empty((3, inside.size), np.int32)
    found, count = [], 0
    for axis, stride in enumerate(grid.strides):
        differs = np.zeros(inside.shape, np.bool_)
        low, high = ([slice(None)] * axis + [part] for part in (slice(None, -1), slice(1, None)))
        np.not_equal(inside[*low], inside[*high], out=differs[*low])
        place = np.flatnonzero(differs)
        vertices = grid.coordinates(place)
        vertices[:, axis] += crossing_fraction(grid.excess(place), grid.excess(place + stride))
        number[axis][place] = np.arange(count, count + len(place), dtype=np.int32)
        found.append(vertices)
        count += len(place)
    starts = np.array([start for start, _ in EDGES])
    shift = np.repeat(np.arange(3), 4) * inside.size + (CORNERS @ grid.strides)[starts]
    return np.concatenate(found), number.reshape(-1).take(cells.origin[:, None] + shift)
