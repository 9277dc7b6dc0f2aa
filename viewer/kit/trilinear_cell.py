"""The unit cell: its corners, edges and faces, and the loops in which a level set meets its boundary.

Corner ``n`` lies at ``(n & 1, n >> 1 & 1, n >> 2 & 1)``. A case is a number of 8 bits, bit ``n`` set where
corner ``n`` is inside (its value below the level), after Lorensen and Cline, "Marching cubes", 1987.
"""

from __future__ import annotations

from functools import cache
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Loop: TypeAlias = tuple[int, ...]       # edges in the order in which the level set's boundary crosses them
Segments: TypeAlias = dict[int, int]    # within one face: from the edge where a curve starts to where it ends

CORNERS = np.array([(n & 1, n >> 1 & 1, n >> 2 & 1) for n in range(8)], np.int64)


def _square(axis: int) -> tuple[int, int, int, int]:
    """The corners of the cell's lower face across ``axis``, counter-clockwise seen from the upper one."""
    first, second = 1 << (axis + 1) % 3, 1 << (axis + 2) % 3
    return 0, first, first + second, second


# The four edges along an axis start at the corners of COLUMNS[axis]: neighbours in this order share a face.
COLUMNS = tuple(_square(axis) for axis in range(3))
# Edge 4 * axis + k runs from corner COLUMNS[axis][k] upwards.
EDGES = tuple((corner, corner + (1 << axis)) for axis in range(3) for corner in COLUMNS[axis])
EDGE_BETWEEN = {pair: edge for edge, ends in enumerate(EDGES) for pair in (ends, ends[::-1])}
# Face 2 * axis is the lower one, 2 * axis + 1 the upper one; counter-clockwise seen from outside the cell.
FACES = tuple(face for axis in range(3)
              for face in (COLUMNS[axis][::-1], tuple(corner + (1 << axis) for corner in COLUMNS[axis])))
FACES_OF_EDGE = tuple(frozenset(f for f, face in enumerate(FACES) if set(ends) <= set(face)) for ends in EDGES)


def is_outside(case: int, corner: int) -> bool:
    """Whether the value at ``corner`` is at or above the level."""
    return not case >> corner & 1


def is_ambiguous(case: int, face: int) -> bool:
    """Whether the signs alternate around ``face``, so that either pair of opposite corners may be joined."""
    a, b, c, d = (is_outside(case, corner) for corner in FACES[face])
    return a == c and b == d and a != b


def _pieces(case: int) -> int:
    """Into how many pieces the crossed edges cut the graph of the cell's corners and edges."""
    label = list(range(8))
    for a, b in EDGES:
        if is_outside(case, a) == is_outside(case, b):
            label = [label[a] if known == label[b] else known for known in label]
    return len(set(label))


CROSSED = np.array([[is_outside(case, a) != is_outside(case, b) for a, b in EDGES] for case in range(256)])
AMBIGUOUS = np.array([[is_ambiguous(case, face) for face in range(6)] for case in range(256)])
# Two pieces leave no doubt: one loop and one disc. With more, faces or the interior have to decide.
DOUBTFUL: NDArray[np.bool_] = np.array([_pieces(case) for case in range(256)]) > 2


def face_segments(case: int, face: int, joined: bool) -> Segments:
    """The curves of the level set in ``face``, from edge to edge, with the outside on their left.

    Left as seen from outside the cell: then the surface's triangles run counter-clockwise seen from larger
    values. Walking around the face counter-clockwise, each curve starts where the sign turns from outside to
    inside. ``joined`` says whether an ambiguous face joins its two outside corners: then every curve cuts off
    an inside corner and ends at the next crossing, otherwise it cuts off an outside corner and ends at the last.
    """
    corners = FACES[face]
    ahead = [(k, EDGE_BETWEEN[corners[k], corners[(k + 1) % 4]]) for k in range(4)]
    crossings = [(is_outside(case, corners[k]), edge) for k, edge in ahead
                 if is_outside(case, corners[k]) != is_outside(case, corners[(k + 1) % 4])]
    step = 1 if joined else -1
    return {edge: crossings[(k + step) % len(crossings)][1] for k, (start, edge) in enumerate(crossings) if start}


@cache
def boundary_loops(case: int, joined_faces: int) -> tuple[Loop, ...]:
    """The closed loops of the level set on the cell's boundary, given bit by bit which faces are joined."""
    following: Segments = {}
    for face in range(6):
        following.update(face_segments(case, face, bool(joined_faces >> face & 1)))
    loops: list[Loop] = []
    while following:
        edge, after = following.popitem()
        loop = [edge]
        while after != edge:
            loop.append(after)
            after = following.pop(after)
        loops.append(tuple(loop))
    return tuple(loops)
