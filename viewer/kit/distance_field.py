"""How far it is from anywhere to a surface, sampled on a grid: positive outside, negative inside.

    field = mesh_distance_field(vertices, triangles, samples=64)
    field.at(points)

Near the surface each sample is exact; further away the nearest triangle is found to within a fraction of a cell.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from viewer.kit.field_function import FieldFunction
from viewer.kit.formula_fit import covering, gaps
from viewer.kit.marching import table_surface
from viewer.kit.mesh_distance import checked_mesh, sampled_distances, thickened
from viewer.kit.pseudonormal import edge_uses, welded
from viewer.kit.thin_parts import SHELL

Points = NDArray[np.float64]
Values = NDArray[np.float32]

FEWEST_SAMPLES = 8
MARGIN = 2              # cells between a mesh and the grid's border


@dataclass(frozen=True)
class DistanceField:
    """Distances ``values`` (nx, ny, nz) float32; ``values[i, j, k]`` is at ``origin`` + (i, j, k) * ``spacing``.

    ``spacing`` is one number or three. Not ``closed``: of an open mesh, which has no inside; it is a thin shell.
    Raises ValueError for what is no such grid.
    """

    values: Values
    origin: Points
    spacing: Points
    closed: bool = True

    def __post_init__(self) -> None:
        for name, kind, shape in (("values", np.float32, np.shape(self.values)), ("origin", np.float64, (3,)),
                                  ("spacing", np.float64, (3,))):
            object.__setattr__(self, name, np.broadcast_to(np.asarray(getattr(self, name), kind), shape))
        if self.values.ndim != 3 or min(self.values.shape) < 2:
            raise ValueError(f"distances of shape {self.values.shape} are not three axes of at least 2 samples")
        if not (np.isfinite(self.values).all() and np.isfinite(self.origin).all()):
            raise ValueError("a distance or the origin is not a finite number")
        if not ((self.spacing > 0.0) & (self.spacing < np.inf)).all():
            raise ValueError(f"spacing = {self.spacing} is not above 0")

    @property
    def extent(self) -> Points:
        """From the first to the last sample along each axis, (3,)."""
        return (np.array(self.values.shape) - 1) * self.spacing

    @property
    def cell(self) -> float:
        """The longest side of a cell."""
        return float(self.spacing.max())

    def at(self, points: ArrayLike) -> Points:
        """``stepping_values`` at ``points`` (n, 3): interpolated; outside the grid what is surely not too far."""
        from scipy.ndimage import map_coordinates

        places = np.asarray(points, np.float64) - self.origin
        inside = np.clip(places, 0.0, self.extent)
        at_border = map_coordinates(self.stepping_values.astype(np.float64), (inside / self.spacing).T, order=1,
                                    mode="nearest")
        away = np.linalg.norm(places - inside, axis=1)
        return np.asarray(np.where(away > 0.0, np.hypot(away, at_border), at_border))

    @cached_property
    def stepping_values(self) -> Values:
        """The values bent so that, interpolated linearly along each axis, they change by at most 1 for each metre.

        Interpolation is too steep beside edges and ridges, by up to the root of 3, and then who steps by the distance
        would pass through the surface. The surface stays, and so does the order of the values: how steep the cells
        are through which a level runs says by how much values near that level are drawn together.
        """
        low, high, steepness = _cells(self.values.astype(np.float64), self.spacing)
        width = float(np.linalg.norm(self.spacing))     # a cell then lies in one bin or in two
        first = int(np.floor(self.values.min() / width))
        bins = int(np.floor(self.values.max() / width)) - first + 1
        steepest = np.ones(bins)
        for end in (low, high):
            np.maximum.at(steepest, np.clip(np.floor(end / width).astype(int) - first, 0, bins - 1), steepness)
        levels = (first + np.arange(bins + 1)) * width
        bent = np.concatenate([[0.0], np.cumsum(width / steepest)])
        bent -= np.interp(0.0, levels, bent)
        return np.asarray(np.interp(self.values, levels, bent), np.float32)


class FormulaSurface(NamedTuple):
    """The solid where a formula is below 0: its ``field`` and its mesh, ``vertices`` (n, 3), ``triangles`` (m, 3)."""

    field: DistanceField
    vertices: Points
    triangles: NDArray[np.int32]


def mesh_distance_field(vertices: ArrayLike, triangles: ArrayLike, samples: int = 64) -> DistanceField:
    """The distances to a mesh, ``samples`` along its longest side; closed meshes may have their inside out.

    An open mesh becomes a shell, and so does a closed one where it is too thin to be seen between the samples.
    Raises ValueError for a mesh without area and for one with a vertex that is not finite.
    """
    places, faces = checked_mesh(vertices, triangles)
    low, high = places.min(axis=0), places.max(axis=0)
    cell = float((high - low).max()) / (max(samples, FEWEST_SAMPLES) - 1 - 2 * MARGIN)
    shape = np.ceil((high - low) / cell - 1e-9).astype(int) + 1 + 2 * MARGIN
    origin = 0.5 * (low + high) - 0.5 * cell * (shape - 1)
    uses = edge_uses(faces, len(places))
    found = sampled_distances(places, faces, origin, cell, shape, uses if uses.closed else None)
    values = found.distance - SHELL * cell
    if uses.closed:
        values = thickened(found.distance * found.side, places, faces, origin, cell)
    return DistanceField(values.astype(np.float32), origin, np.full(3, cell), uses.closed)


def formula_distance_field(function: FieldFunction, reach: float, samples: int = 64) -> FormulaSurface:
    """The solid where ``function`` is below 0, cut off where x, y or z is ``reach`` from 0.

    The field is below 0 wherever the function is, but for what is too small for the samples; the mesh's triangles
    are chords. Where the function has no value is outside. Raises ValueError where nothing or everything is inside.
    """
    inner = max(samples, FEWEST_SAMPLES) - 2 * MARGIN
    cell = 2.0 * reach / inner
    values = function.on_grid([inner] * 3, [0.5 * cell - reach] * 3, [cell] * 3).T
    if not np.isfinite(values).any():
        raise ValueError(f"it has no value within {reach:g} of the origin")
    inside = values < 0.0
    if inside.all() or not inside.any():
        raise ValueError(f"it is nowhere {'above' if inside.any() else 'below'} 0 within {reach:g} of the origin; "
                         "the inside is where it is below 0")
    closed = _closed_off(values)
    corners, triangles = table_surface(closed, 0.0, "cubes")
    origin = np.full(3, (0.5 - MARGIN) * cell - reach)
    vertices = origin + cell * corners
    joined, faces = welded(vertices, triangles)
    found = sampled_distances(joined, faces, origin, cell, np.array(closed.shape), None)
    signed = np.where(closed < 0.0, -found.distance, found.distance)
    signed += _missed(function, found.nearest, found.distance, reach, cell)
    field = DistanceField(signed.astype(np.float32), origin, np.full(3, cell))
    return FormulaSurface(covering(field, function, reach), vertices, triangles)


def _missed(function: FieldFunction, nearest: Points, distance: Points, reach: float, cell: float) -> Points:
    """How far the mesh's places ``nearest`` (n, 3) to the samples are from the true surface, towards the outside.

    Nothing for samples further away than a few cells, nor where the solid is cut off.
    """
    share = np.clip(3.0 - distance / cell, 0.0, 1.0)
    telling = (share.ravel() > 0.0) & (np.abs(nearest).max(axis=1) < reach - 0.6 * cell)
    missed = np.zeros(len(nearest))
    missed[telling] = gaps(function, nearest[telling], cell)
    return np.asarray(share * missed.reshape(distance.shape))


def _closed_off(values: Values) -> Values:
    """The values with a margin that is outside, such that the surface runs half a cell beyond the last sample."""
    known = np.isfinite(values)
    typical = np.abs(values[known]).mean(dtype=np.float64)
    filled = np.nan_to_num(values, nan=typical, posinf=typical, neginf=-typical)
    padded = np.abs(np.pad(filled, MARGIN, mode="edge"))
    padded[(slice(MARGIN, -MARGIN),) * 3] = filled
    return padded.astype(np.float32)


def _cells(values: Points, spacing: Points) -> tuple[Points, Points, Points]:
    """Each cell's lowest and highest value, and how steep its trilinear interpolant is at the steepest.

    The slope's square is convex along each axis, so that it is largest at a corner.
    """
    low = high = values
    slopes = []
    for axis in range(3):
        low = np.minimum(_end(low, axis, 0), _end(low, axis, 1))
        high = np.maximum(_end(high, axis, 0), _end(high, axis, 1))
        slopes.append(np.square(np.diff(values, axis=axis) / spacing[axis]))
    steepest = np.zeros(low.shape)
    for corner in range(8):
        x, y, z = (corner >> axis & 1 for axis in range(3))
        square = _end(_end(slopes[0], 1, y), 2, z) + _end(_end(slopes[1], 0, x), 2, z)
        np.maximum(steepest, square + _end(_end(slopes[2], 0, x), 1, y), out=steepest)
    return low, high, np.sqrt(steepest)


def _end(values: Points, axis: int, end: int) -> Points:
    """What stands at the lower (0) or upper (1) end of each step along an axis."""
    count = values.shape[axis]
    return values[(slice(None),) * axis + (slice(end, count - 1 + end),)]
