"""Triangle meshes of the unit sphere, and what one asks of any mesh."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Vertices: TypeAlias = NDArray[np.float64]
Triangles: TypeAlias = NDArray[np.int32]
Mesh: TypeAlias = tuple[Vertices, Triangles]


def uv_sphere(rings: int, segments: int) -> Mesh:
    """The unit sphere by latitude and longitude: ``rings`` bands from pole to pole, ``segments`` around.

    Returns vertices ((rings - 1) * segments + 2, 3) and triangles (2 * segments * (rings - 1), 3),
    counter-clockwise from outside. Poles and the date line share their vertices, so it is closed.
    """
    latitude = np.pi * np.arange(1, rings) / rings
    longitude = 2.0 * np.pi * np.arange(segments) / segments
    across = np.sin(latitude)[:, None]
    y = np.broadcast_to(np.cos(latitude)[:, None], (rings - 1, segments))
    body = np.stack([across * np.sin(longitude), y, across * np.cos(longitude)], axis=-1).reshape(-1, 3)
    vertices = np.concatenate([[[0.0, 1.0, 0.0]], body, [[0.0, -1.0, 0.0]]])
    index = 1 + np.arange((rings - 1) * segments).reshape(rings - 1, segments)
    east = np.roll(index, -1, axis=1)
    quads = quads_to_triangles(index[:-1], index[1:], east[1:], east[:-1])
    top = np.stack([np.zeros(segments, int), index[0], east[0]], axis=1)
    bottom = np.stack([np.full(segments, len(vertices) - 1), east[-1], index[-1]], axis=1)
    return vertices, np.concatenate([top, quads, bottom]).astype(np.int32)


def cube_sphere(cells: int) -> Mesh:
    """The unit sphere as a cube of ``cells`` squares along each edge, blown up to equal angles.

    Returns vertices (6 * cells**2 + 2, 3) and triangles (12 * cells**2, 3), closed.
    """
    step = np.arange(cells + 1)
    first, second = (grid.ravel() for grid in np.meshgrid(step, step, indexing="ij"))
    zero, full = np.zeros_like(first), np.full_like(first, cells)
    corners = [np.stack(face, axis=1) for face in (
        (full, first, second), (zero, second, first), (second, full, first),
        (first, zero, second), (first, second, full), (second, first, zero))]
    lattice, index = np.unique(np.concatenate(corners), axis=0, return_inverse=True)
    grid = index.reshape(6, cells + 1, cells + 1)
    triangles = quads_to_triangles(grid[:, :-1, :-1], grid[:, 1:, :-1], grid[:, 1:, 1:], grid[:, :-1, 1:])
    on_cube = np.tan((lattice / cells - 0.5) * (np.pi / 2.0))
    return normalized(on_cube), triangles.astype(np.int32)


def ico_sphere(levels: int) -> Mesh:
    """The unit sphere as an icosahedron whose triangles are quartered ``levels`` times.

    Returns vertices (10 * 4**levels + 2, 3) and triangles (20 * 4**levels, 3), closed.
    """
    vertices, triangles = icosahedron()
    for _ in range(levels):
        vertices, triangles = quartered(vertices, triangles)
        vertices = normalized(vertices)
    return vertices, triangles.astype(np.int32)


def icosahedron() -> Mesh:
    """The regular icosahedron with corners on the unit sphere: (12, 3) and (20, 3)."""
    golden = (1.0 + np.sqrt(5.0)) / 2.0
    corners = [(x, y, 0.0) for x in (-1.0, 1.0) for y in (-golden, golden)]
    vertices = normalized(np.array([np.roll(corner, shift) for shift in range(3) for corner in corners]))
    distance = np.linalg.norm(vertices[:, None] - vertices[None], axis=2)
    joined = (distance > 0.0) & (distance < 1.1)
    a, b, c = np.nonzero(joined[:, :, None] & joined[:, None, :] & joined[None])
    triangles = np.stack([a, b, c], axis=1)[(a < b) & (b < c)]
    inward = np.linalg.det(vertices[triangles]) < 0.0
    triangles[inward] = triangles[inward][:, ::-1]
    return vertices, triangles.astype(np.int32)


def quartered(vertices: Vertices, triangles: Triangles) -> Mesh:
    """Every triangle cut into four at the middles of its edges; shared edges share their middle."""
    ends = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2).astype(np.int64)
    ends.sort(axis=1)
    edge = ends[:, 0] * len(vertices) + ends[:, 1]
    unique, middle = np.unique(edge, return_inverse=True)
    middles = 0.5 * (vertices[unique // len(vertices)] + vertices[unique % len(vertices)])
    ab, bc, ca = (len(vertices) + middle.reshape(-1, 3)).T
    a, b, c = triangles.T
    pieces = [np.stack(piece, axis=1) for piece in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
    return np.concatenate([vertices, middles]), np.concatenate(pieces)


def quads_to_triangles(a: NDArray[np.intp], b: NDArray[np.intp], c: NDArray[np.intp], d: NDArray[np.intp]) -> Triangles:
    """Two triangles for each quadrangle a, b, c, d given counter-clockwise by vertex index."""
    halves = [np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)]
    return np.stack(halves, axis=-2).reshape(-1, 3).astype(np.int32)


def normalized(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """``vectors`` (n, 3) at length one; a zero vector stays zero."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(length > 0.0, length, 1.0)


def area_weighted_normals(vertices: Vertices, triangles: Triangles) -> Vertices:
    """Normals (n, 3) of length one: the mean of the faces around, by area, also across vertices at the same place.

    Zero for a vertex that no triangle with an area uses.
    """
    places, first = np.unique(vertices, axis=0, return_inverse=True)
    joined = first.reshape(-1)[triangles]
    a, b, c = (places[joined[:, corner]] for corner in range(3))
    faces = np.repeat(np.cross(b - a, c - a), 3, axis=0)
    total = np.stack([np.bincount(joined.ravel(), faces[:, axis], len(places)) for axis in range(3)], axis=1)
    size = np.linalg.norm(total, axis=1, keepdims=True)
    return np.asarray(np.divide(total, size, out=np.zeros_like(total), where=size > 0.0)[first.reshape(-1)])


def vertex_areas(vertices: Vertices, triangles: Triangles) -> NDArray[np.float64]:
    """The area that each vertex stands for: a third of the triangles around it; (n,)."""
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    one, other = b - a, c - a
    lengths = np.einsum("ij,ij->i", one, one) * np.einsum("ij,ij->i", other, other)
    area = 0.5 * np.sqrt(np.maximum(lengths - np.einsum("ij,ij->i", one, other) ** 2, 0.0))    # Lagrange's identity
    shares = [np.bincount(triangles[:, corner], area / 3.0, len(vertices)) for corner in range(3)]
    return np.asarray(shares[0] + shares[1] + shares[2], np.float64)


def fibonacci_sphere(count: int) -> Vertices:
    """``count`` points spread evenly over the unit sphere, each standing for an equal area; (count, 3).

    After Gonzalez, "Measurement of areas on a sphere using Fibonacci and latitude-longitude lattices", 2010.
    """
    step = np.arange(count) + 0.5
    y = 1.0 - 2.0 * step / count
    angle = step * np.pi * (3.0 - np.sqrt(5.0))
    across = np.sqrt(1.0 - y * y)
    return np.stack([across * np.sin(angle), y, across * np.cos(angle)], axis=1)
