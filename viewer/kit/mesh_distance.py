"""The distance from each sample of a grid to a mesh, and on which side of it the sample is."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from viewer.kit.nearest_triangle import Nearest, NearestTriangle
from viewer.kit.pseudonormal import EdgeUses, feature_normals, welded
from viewer.kit.thin_parts import thin_parts

Points = NDArray[np.float64]

BAND = 1.7              # cells: samples nearer than this to a piece of the surface are exact
APART = 0.6             # cells: no surface runs between neighbours both further from it than this
PIECE = 1.2             # cells: how finely triangles are cut to find the nearest
TOLERANCE = 0.1         # cells: of pieces smaller than this the nearest few will do


class Sampled(NamedTuple):
    """Of each sample of a grid the ``distance`` and the ``side``, 1 or -1, both (nx, ny, nz), and the nearest place
    on the surface, ``nearest`` (n, 3)."""

    distance: Points
    side: Points
    nearest: Points


def checked_mesh(vertices: ArrayLike, triangles: ArrayLike) -> tuple[Points, NDArray[np.int64]]:
    """The mesh, its vertices welded and unused ones left out."""
    places, faces = np.asarray(vertices, np.float64), np.asarray(triangles)
    if not faces.size or not len(places):
        raise ValueError("the mesh has no triangles")
    faces = faces.reshape(-1, 3)
    if faces.min() < 0 or faces.max() >= len(places):
        raise ValueError(f"the mesh has triangles with vertices beyond its {len(places)}")
    used = np.zeros(len(places), np.bool_)
    used[faces.ravel()] = True
    if not np.isfinite(places[used]).all():
        raise ValueError("the mesh has a vertex that is not finite")
    places, faces = welded(places[used], (np.cumsum(used) - 1)[faces])
    if not len(_with_area(places, faces)):
        raise ValueError("the mesh has no area")
    return places, faces


def sampled_distances(places: Points, faces: NDArray[np.int64], origin: Points, cell: float, shape: NDArray[np.intp],
                      uses: EdgeUses | None) -> Sampled:
    """The distance of each sample, and with ``uses`` of a closed mesh's edges its side."""
    points = _lattice(origin, cell, shape)
    solid = _with_area(places, faces)
    look = NearestTriangle(places[faces[solid]], PIECE * cell, TOLERANCE * cell)
    near = _near(look.middles, origin, cell, shape)
    found = _everywhere(look, points, near, BAND * cell)
    distance = found.distance.reshape(shape)
    if uses is None:
        return Sampled(distance, np.ones(shape), found.place)
    normals = feature_normals(places, faces, uses, solid[found.triangle], found.feature)
    outward = np.einsum("ij,ij->i", points - found.place, normals) >= 0.0
    sides = np.where(outward != _is_inside_out(places, faces), 1.0, -1.0).reshape(shape)
    return Sampled(distance, _agreed(sides, distance / cell, near), found.place)


def thickened(values: Points, places: Points, faces: NDArray[np.int64], origin: Points, cell: float) -> Points:
    """Signed distances to a closed mesh, less where it is too thin for the samples: there it gets a shell.

    What is solid is then the mesh and all that is near its thin parts, so that elsewhere nothing changes.
    """
    corners = places[faces[_with_area(places, faces)]]
    parts = thin_parts(corners[:, ::-1] if _is_inside_out(places, faces) else corners, values, origin, cell)
    if not len(parts.shells):
        return values
    look = NearestTriangle(parts.corners, PIECE * cell, TOLERANCE * cell)
    near = _near(look.middles, origin, cell, np.array(values.shape))
    found = _everywhere(look, _lattice(origin, cell, np.array(values.shape)), near, BAND * cell)
    return np.minimum(values, (found.distance - parts.shells[found.triangle]).reshape(values.shape))


def _lattice(origin: Points, cell: float, shape: NDArray[np.intp]) -> Points:
    """Where the samples are, (n, 3)."""
    axes = [first + cell * np.arange(count) for first, count in zip(origin, shape, strict=True)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)


def _near(middles: Points, origin: Points, cell: float, shape: NDArray[np.intp]) -> NDArray[np.bool_]:
    """The samples (nx, ny, nz) near enough to some of the places ``middles`` to be looked up exactly."""
    from scipy.ndimage import distance_transform_edt

    empty = np.ones(shape, np.bool_)
    empty[tuple(np.rint((middles - origin) / cell).astype(np.intp).T)] = False
    return np.asarray(distance_transform_edt(empty) <= BAND + 0.5 * 3.0**0.5)


def _everywhere(look: NearestTriangle, points: Points, near: NDArray[np.bool_], band: float) -> Nearest:
    """The nearest triangle of each sample; further away, the nearest among those of a few samples that are ``near``.

    These are the nearest such sample, and those that are nearest to the sample's neighbours.
    """
    from scipy.ndimage import distance_transform_edt

    exact = look.search(points[near.ravel()], band)
    triangles = np.zeros(near.shape, np.intp)
    triangles[near] = exact.triangle
    sources = distance_transform_edt(~near, return_distances=False, return_indices=True)
    triangles = triangles[tuple(sources)]
    far = np.flatnonzero(~near.ravel())
    best, away = look.on(points, triangles.ravel()), points[far]
    for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1), (2, 1), (2, -1)):
        other = look.on(away, np.roll(triangles, step, axis).ravel()[far])
        nearer = other.distance < best.distance[far]
        for column, better in zip(best, other, strict=True):
            column[far[nearer]] = better[nearer]
    return best


def _with_area(places: Points, faces: NDArray[np.int64]) -> NDArray[np.intp]:
    """The numbers of the triangles that are more than a line."""
    a, b, c = (places[faces[:, corner]] for corner in range(3))
    one, other = b - a, c - a
    lengths = np.einsum("ij,ij->i", one, one) * np.einsum("ij,ij->i", other, other)
    return np.flatnonzero(lengths - np.einsum("ij,ij->i", one, other) ** 2 > 1e-14 * lengths)    # Lagrange's identity


def _is_inside_out(places: Points, faces: NDArray[np.int64]) -> bool:
    """Whether a closed mesh's triangles are clockwise as seen from outside: its volume is negative."""
    a, b, c = (np.moveaxis(places[faces[:, corner]] - places.mean(axis=0), 1, 0) for corner in range(3))
    return bool((a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
                 + a[2] * (b[0] * c[1] - b[1] * c[0])).sum() < 0.0)


def _agreed(sides: Points, distance: Points, near: NDArray[np.bool_]) -> Points:
    """The sides, but that samples between which there is no surface are all on that of the majority.

    ``distance`` is in cells. Those ``near`` the surface know best.
    """
    from scipy.ndimage import label

    regions, count = label(distance > APART)
    votes = np.bincount(regions.ravel(), (sides * np.where(near, 1.0, 1e-6)).ravel(), count + 1)
    return np.where(regions > 0, np.where(votes < 0.0, -1.0, 1.0)[regions], sides)
