"""Triangle meshes of simple shapes, and their normals where smooth faces meet in sharp edges.

Every shape is a pair of vertices (n, 3) and triangles (m, 3), counter-clockwise from outside, its axis along y.
The solids are closed and share their vertices; ``creased`` parts these for shading.
"""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from viewer.kit.mesh import Mesh, Triangles, Vertices, normalized, quads_to_triangles

ShadedMesh: TypeAlias = tuple[Vertices, Vertices, Triangles]
Indices: TypeAlias = NDArray[np.integer[Any]]       # triangles of any integers


def disc(radius: float, segments: int = 96) -> Mesh:
    """A flat disc around the origin that faces up: (segments + 1, 3) and (segments, 3)."""
    rim = np.arange(segments)
    fan = np.stack([rim, np.roll(rim, -1), np.full(segments, segments)], axis=1)
    return np.concatenate([_circle(radius, 0.0, segments), [[0.0, 0.0, 0.0]]]), fan.astype(np.int32)


def square(half_width: float) -> Mesh:
    """A flat square around the origin that faces up: (4, 3) and (2, 3)."""
    corners = half_width * np.array([[-1.0, 0.0, -1.0], [-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0]])
    return corners, np.array([[0, 1, 2], [0, 2, 3]], np.int32)


def torus(ring_radius: float, tube_radius: float, segments: int = 96, sides: int = 48) -> Mesh:
    """A torus around the y axis: (segments * sides, 3) and (2 * segments * sides, 3).

    ``ring_radius`` is that of the circle in the middle of the tube; ``segments`` go around the axis,
    ``sides`` around the tube.
    """
    turn = 2.0 * np.pi * np.arange(sides) / sides
    rings = [_circle(ring_radius + tube_radius * np.cos(angle), tube_radius * np.sin(angle), segments)
             for angle in turn]
    index = np.arange(sides * segments).reshape(sides, segments)
    return np.concatenate(rings), _bands(np.concatenate([index, index[:1]]))


def box(half_extents: ArrayLike) -> Mesh:
    """A box around the origin that reaches ``half_extents`` (3,) along each axis: (8, 3) and (12, 3)."""
    signs = np.array([[corner & 1, corner >> 1 & 1, corner >> 2 & 1] for corner in range(8)]) * 2.0 - 1.0
    quads = np.array([[1, 3, 7, 5], [0, 4, 6, 2], [2, 6, 7, 3], [0, 1, 5, 4], [4, 5, 7, 6], [0, 2, 3, 1]])
    return signs * np.asarray(half_extents, np.float64), quads_to_triangles(*quads.T)


def cone(radius: float, height: float, segments: int = 96, rings: int = 12) -> Mesh:
    """A cone that stands on the disc around the origin, its apex at (0, height, 0).

    Returns (rings * segments + 2, 3) and (2 * rings * segments, 3). The ``rings`` crowd towards the apex,
    where a normal turns all the way around within one triangle.
    """
    up = 1.0 - np.linspace(1.0, 0.0, rings, endpoint=False) ** 2
    circles = [_circle(radius * (1.0 - part), height * part, segments) for part in up]
    poles = np.array([[0.0, 0.0, 0.0], [0.0, height, 0.0]])
    index = np.arange(rings * segments).reshape(rings, segments)
    base, apex = (np.full(segments, rings * segments + pole) for pole in range(2))
    bottom = np.stack([base, np.roll(index[0], -1), index[0]], axis=1)
    top = np.stack([apex, index[-1], np.roll(index[-1], -1)], axis=1)
    return np.concatenate([*circles, poles]), np.concatenate([bottom, _bands(index), top]).astype(np.int32)


def creased(vertices: Vertices, triangles: Indices, degrees: float = 30.0) -> ShadedMesh:
    """Vertices parted along edges where faces meet at more than ``degrees``, each with the normal of its side.

    Returns vertices (k, 3), normals (k, 3) of length 1 and triangles (m, 3). A normal is the mean over the
    faces that meet smoothly at the vertex, weighted by their angles there (Thürmer and Wüthrich, "Computing
    Vertex Normals from Polygonal Facets", 1998).
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    normals = face_normals(vertices, triangles)
    one, other = _smooth_pairs(normals, triangles, np.cos(np.radians(degrees)), len(vertices))
    links = coo_array((np.ones(len(one), np.int8), (one, other)), shape=(triangles.size, triangles.size))
    count, part = connected_components(links, directed=False)
    weighted = np.repeat(normals, 3, axis=0) * corner_angles(vertices, triangles).reshape(-1, 1)
    sums = np.stack([np.bincount(part, weighted[:, axis], count) for axis in range(3)], axis=1).astype(np.float64)
    origin = np.zeros(count, np.int64)
    origin[part] = triangles.ravel()
    return vertices[origin], normalized(sums), part.reshape(-1, 3).astype(np.int32)


def face_normals(vertices: Vertices, triangles: Indices) -> Vertices:
    """The unit normal of each triangle (m, 3); zero for one without area."""
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    return normalized(np.cross(b - a, c - a))


def corner_angles(vertices: Vertices, triangles: Indices) -> NDArray[np.float64]:
    """The angle at each corner of each triangle, in radians: (m, 3)."""
    corners = vertices[triangles]
    onward, back = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    across = np.linalg.norm(np.cross(onward, back), axis=2)
    return np.asarray(np.arctan2(across, np.einsum("tci,tci->tc", onward, back)))


def half_edges(triangles: Indices, count: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The sides of all triangles, sorted so that those between the same two vertices stand together.

    Side s goes from corner s of ``triangles.ravel()`` to the next of its triangle. Returns the sorted sides
    (3m,) and the number of the edge that each then belongs to (3m,); there are ``count`` vertices.
    """
    start, end = triangles.astype(np.int64).ravel(), np.roll(triangles, -1, axis=1).astype(np.int64).ravel()
    name = np.minimum(start, end) * count + np.maximum(start, end)
    order = np.argsort(name, kind="stable")
    ordered = name[order]
    return order, np.cumsum(np.concatenate([[False], ordered[1:] != ordered[:-1]])[:len(order)])


def _smooth_pairs(normals: Vertices, triangles: Indices, cosine: float,
                  count: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Pairs of corners that are one vertex in shading: those at either end of an edge between two smooth faces."""
    sides, edge = half_edges(triangles, count)
    uses = np.bincount(edge)
    first = np.concatenate([[0], np.cumsum(uses)[:-1]])[uses == 2]
    one, other = sides[first], sides[first + 1]
    smooth = np.einsum("ij,ij->i", normals[one // 3], normals[other // 3]) >= cosine
    corner = triangles.ravel()
    ahead = corner[one] != corner[other]        # as it is between faces that agree on their outside
    one, other, ahead = one[smooth], other[smooth], ahead[smooth]
    one_end, other_end = one // 3 * 3 + (one + 1) % 3, other // 3 * 3 + (other + 1) % 3
    return (np.concatenate([one, one_end]),
            np.concatenate([np.where(ahead, other_end, other), np.where(ahead, other, other_end)]))


def _circle(radius: float, y: float, segments: int) -> Vertices:
    """Points on a circle around the y axis, counter-clockwise seen from above: (segments, 3)."""
    angle = 2.0 * np.pi * np.arange(segments) / segments
    return np.stack([radius * np.sin(angle), np.full(segments, y), radius * np.cos(angle)], axis=1)


def _bands(index: NDArray[np.int64]) -> Triangles:
    """The triangles between each ring of vertices and the next one above it; ``index`` is (rings, segments)."""
    east = np.roll(index, -1, axis=1)
    return quads_to_triangles(index[:-1], east[:-1], east[1:], index[1:])
