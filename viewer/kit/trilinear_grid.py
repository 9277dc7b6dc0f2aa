"""Where a level set passes a grid: the cells, what is decided in each, and the crossings on the grid's edges."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from viewer.kit.trilinear_cell import CORNERS, DOUBTFUL, EDGES
from viewer.kit.trilinear_decision import joined_faces, tunnels

Indices = NDArray[np.intp]
Field = NDArray[np.float64]

CLEARANCE = 1e-4    # a crossing's least distance from the ends of its edge, so that no triangle shrinks to nothing


class Cells(NamedTuple):
    """The cells that the level set passes: the place of their lowest corner in the flat grid, and their kind."""
    origin: Indices
    case: NDArray[np.uint8]
    joined: NDArray[np.int64]
    tunnel: NDArray[np.int64]


def mixed_cells(field: Field, finite: NDArray[np.bool_] | None) -> Cells:
    """The cells with corners on both sides of the level, those with a sample that is not finite left out."""
    inside = (field < 0.0).view(np.uint8)
    code = inside[:-1] | inside[1:] << 1
    code = code[:, :-1] | code[:, 1:] << 2
    code = code[..., :-1] | code[..., 1:] << 4
    mixed = (code != 0) & (code != 255)
    if finite is not None:
        finite = finite[:-1] & finite[1:]
        finite = finite[:, :-1] & finite[:, 1:]
        mixed &= finite[..., :-1] & finite[..., 1:]
    place = np.flatnonzero(mixed)
    origin = np.ravel_multi_index(np.unravel_index(place, mixed.shape), field.shape) if len(place) else place
    case = code.reshape(-1)[place].astype(np.uint8, copy=False)
    joined, tunnel = np.zeros((2, len(case)), np.int64)
    doubtful = np.flatnonzero(DOUBTFUL[case])
    corners = corner_values(field, origin[doubtful])
    joined[doubtful], tunnel[doubtful] = joined_faces(corners, case[doubtful]), tunnels(corners)
    return Cells(origin, case, joined, tunnel)


def corner_values(field: Field, origin: Indices) -> Field:
    """The values (n, 8) at the corners of cells."""
    return field.reshape(-1)[origin[:, None] + CORNERS @ strides(field)]


def strides(field: Field) -> NDArray[np.int64]:
    """How far apart in the flat grid neighbours along each axis are."""
    return np.array([field.shape[1] * field.shape[2], field.shape[2], 1])


def grid_crossings(field: Field, cells: Cells) -> tuple[Field, NDArray[np.int32]]:
    """The vertices on the edges of the grid, at t = A / (A - B), and which of them each cell has on its 12 edges."""
    flat, inside = field.reshape(-1), field < 0.0
    number: NDArray[np.int32] = np.empty((3, flat.size), np.int32)
    found, count = [], 0
    for axis, stride in enumerate(strides(field)):
        differs = np.zeros(field.shape, np.bool_)
        low, high = ([slice(None)] * axis + [part] for part in (slice(None, -1), slice(1, None)))
        np.not_equal(inside[*low], inside[*high], out=differs[*low])
        place = np.flatnonzero(differs)
        A, B = flat[place], flat[place + stride]
        vertices = np.stack(np.unravel_index(place, field.shape), axis=1).astype(np.float64)
        vertices[:, axis] += np.clip(A / (A - B), CLEARANCE, 1.0 - CLEARANCE)
        number[axis, place] = np.arange(count, count + len(place))
        found.append(vertices)
        count += len(place)
    starts = np.array([start for start, _ in EDGES])
    shift = np.repeat(np.arange(3), 4) * flat.size + (CORNERS @ strides(field))[starts]
    return np.concatenate(found), number.reshape(-1)[cells.origin[:, None] + shift]
