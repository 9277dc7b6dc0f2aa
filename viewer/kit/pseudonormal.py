"""Normals of a mesh's faces, edges and vertices that tell inside from outside.

The normal of a vertex is the sum of its faces' normals, each weighted by the face's angle there; that of an
edge the sum of its two faces'. A point is outside a closed mesh where it lies on the side to which the normal
of the nearest face, edge or vertex points (Baerentzen and Aanaes, "Signed Distance Computation Using the Angle
Weighted Pseudonormal", 2005).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from viewer.kit.shapes import corner_angles, face_normals

Points = NDArray[np.float64]
Triangles = NDArray[np.integer[Any]]
WELD_STEPS = float(2**20)       # into how many places the longest side is divided for welding


class EdgeUses(NamedTuple):
    """For each side of each triangle, in the order ab, bc, ca, its edge's number (m, 3); how many edges there
    are; and whether each edge is run through as often one way as the other, so that the mesh is ``closed``."""

    edge: NDArray[np.intp]
    number: int
    closed: bool


def feature_normals(vertices: Points, triangles: Triangles, uses: EdgeUses, chosen: NDArray[np.intp],
                    feature: NDArray[np.intp]) -> Points:
    """The normal (k, 3), of any length, at a feature (k,) of each chosen triangle (k,).

    Features 0 to 2 are a triangle's corners, 3 to 5 its sides ab, bc and ca, 6 its face.
    """
    touched = np.zeros(len(vertices), np.bool_)
    touched[triangles[chosen].ravel()] = True
    around = np.flatnonzero(touched[triangles].any(axis=1))     # the others do not matter
    faces = face_normals(vertices, triangles[around])
    of_face = np.zeros((len(triangles), 3))
    of_face[around] = faces
    found = of_face[chosen]
    at_vertex, at_edge = feature < 3, (feature >= 3) & (feature < 6)
    of_vertex = vertex_normals(vertices, triangles[around], faces)
    found[at_vertex] = of_vertex[triangles[chosen[at_vertex], feature[at_vertex]]]
    of_edge = _summed(uses.edge[around], np.broadcast_to(faces[:, None], (len(faces), 3, 3)), uses.number)
    found[at_edge] = of_edge[uses.edge[chosen[at_edge], feature[at_edge] - 3]]
    return found


def vertex_normals(vertices: Points, triangles: Triangles, faces: Points) -> Points:
    """The sum over each vertex's triangles of their normals times their angles there, (n, 3)."""
    return _summed(triangles, corner_angles(vertices, triangles)[:, :, None] * faces[:, None], len(vertices))


def edge_uses(triangles: Triangles, vertex_count: int) -> EdgeUses:
    """The edges of a mesh whose vertices at the same place are one."""
    starts = triangles.astype(np.int64)
    ends = np.roll(starts, -1, axis=1)
    names = np.minimum(starts, ends) * vertex_count + np.maximum(starts, ends)
    unique, edge = np.unique(names.ravel(), return_inverse=True)
    balance = np.bincount(edge, np.where(starts < ends, 1, -1).ravel(), len(unique))
    return EdgeUses(edge.reshape(-1, 3), len(unique), not balance.any())


def welded(vertices: Points, triangles: Triangles) -> tuple[Points, NDArray[np.int64]]:
    """The mesh with vertices at the same place made one, and without triangles that have a vertex twice."""
    low = vertices.min(axis=0)
    size = max(float((vertices - low).max()), 1e-300)
    place = np.rint((vertices - low) * (WELD_STEPS / size)).astype(np.int64)
    name = (place[:, 0] << 42) | (place[:, 1] << 21) | place[:, 2]
    _, first, number = np.unique(name, return_index=True, return_inverse=True)
    joined = number[triangles].astype(np.int64)
    twice = (joined == np.roll(joined, 1, axis=1)).any(axis=1)
    return vertices[first], joined[~twice]


def _summed(index: NDArray[Any], vectors: Points, count: int) -> Points:
    """The sum of the vectors (..., 3) that have the same index (...), for each index below ``count``."""
    flat = index.ravel()
    sums = [np.bincount(flat, vectors[..., axis].ravel(), count) for axis in range(3)]
    return np.stack(sums, axis=1)
