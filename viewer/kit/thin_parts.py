"""Where a closed mesh is thinner than the samples of a grid can tell, and how much there has to be added."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from viewer.kit.nearest_triangle import NearestTriangle, cut_to_pieces

Points = NDArray[np.float64]
Triangles = NDArray[np.int64]

PIECE = 0.6             # cells: how finely the surface is cut to look for a second one behind it
DEPTHS = (0.2, 0.45, 0.75)      # cells behind the surface at which to look; twice the last is thin
ROOM = 0.7              # cells: where the last of these is so far inside, no closer look is needed
OPPOSED = -0.7          # cosine between the normals of two sides: below, they are one thin part, no mere edge
SHELL = 0.75            # cells: half the thickness of what has none; with half a cell it vanishes between samples
HALF_THICKNESS = 1.0    # cells: that of a thin part with its shell


class ThinParts(NamedTuple):
    """The pieces (k, 3, 3) of a surface that are too thin, and each one's shell (k,) in metres."""

    corners: Points
    shells: Points


def thin_parts(corners: Points, values: Points, origin: Points, cell: float) -> ThinParts:
    """Where of the triangles ``corners`` (m, 3, 3), of a closed mesh and counter-clockwise, the other side is near.

    ``values`` are the signed distances (nx, ny, nz) on the grid from ``origin``.
    """
    from scipy.ndimage import map_coordinates

    pieces, owners = cut_to_pieces(corners, PIECE * cell)
    normals = _normals(corners)[owners]
    chosen = _spread(pieces.mean(axis=1), normals, cell)
    behind = pieces[chosen].mean(axis=1) - DEPTHS[-1] * cell * normals[chosen]
    room = map_coordinates(values, ((behind - origin) / cell).T, order=1, mode="nearest")
    chosen = chosen[room > -ROOM * cell]
    if not len(chosen):
        return ThinParts(pieces[chosen], np.empty(0))
    thickness = _thickness(corners, pieces[chosen].mean(axis=1), normals[chosen], cell)
    thin = thickness < 2.0 * DEPTHS[-1] * cell
    shells = np.minimum(SHELL, HALF_THICKNESS - 0.5 * thickness[thin] / cell) * cell
    return ThinParts(pieces[chosen[thin]], shells)


def _thickness(corners: Points, middles: Points, normals: Points, cell: float) -> Points:
    """How thick the solid is behind places on its surface, (n,); infinite where it is not thin.

    Behind each the nearest place is looked up at some depths; where the surface there faces the other way, it is
    the other side. At an edge of a thick solid it does not.
    """
    look = NearestTriangle(corners, 2.0 * PIECE * cell, 0.1 * cell)
    thickness = np.full(len(middles), np.inf)
    for depth in DEPTHS:
        found = look.search(middles - depth * cell * normals, 2.0 * cell)
        facing = np.einsum("ij,ij->i", _normals(corners[found.triangle]), normals)
        through = np.linalg.norm(middles - found.place, axis=1)
        np.minimum(thickness, np.where(facing < OPPOSED, through, np.inf), out=thickness)
    return thickness


def _normals(corners: Points) -> Points:
    """Of length one, (m, 3)."""
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return np.asarray(across / np.linalg.norm(across, axis=1, keepdims=True))


def _spread(middles: Points, normals: Points, cell: float) -> NDArray[np.intp]:
    """One of the pieces that face the same way in each cube with sides of a third of a cell.

    More of a mesh that is much finer than the cells would say the same again.
    """
    place = np.floor((middles - middles.min(axis=0)) / (cell / 3.0)).astype(np.int64)
    facing = (normals > 0.0) @ np.array([1, 2, 4])
    name = ((place[:, 0] << 40) | (place[:, 1] << 20) | place[:, 2]) * 8 + facing
    return np.asarray(np.unique(name, return_index=True)[1])
