"""What every surface through a grid must satisfy, worked out without the code that made it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.floating]
Triangles = NDArray[np.int32]
METHODS = ("cubes", "tetrahedra")


def open_edges(vertices: Floats, triangles: Triangles) -> NDArray[np.int64]:
    """The edges (e, 2) of only one triangle, in its direction; checks everything that must always hold.

    That is: finite vertices, each of them used, triangles of some area, and no edge that two triangles have in
    the same direction; hence none with more than two triangles, and neighbours that agree on their outside.
    """
    assert vertices.dtype == np.float32 and vertices.shape == (len(vertices), 3)
    assert triangles.dtype == np.int32 and triangles.shape == (len(triangles), 3)
    assert np.isfinite(vertices).all()
    uses = np.bincount(triangles.ravel(), minlength=len(vertices))
    assert len(uses) == len(vertices) and uses.all()
    assert (areas(vertices, triangles) > 0.0).all()
    ends = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2).astype(np.int64)
    names, returns = np.sort(ends @ [len(vertices), 1]), ends @ [1, len(vertices)]
    assert (np.diff(names) > 0).all()
    places = np.minimum(np.searchsorted(names, returns), max(0, len(names) - 1))
    return ends[names[places] != returns]


def inner_open_edges(vertices: Floats, triangles: Triangles, shape: tuple[int, ...]) -> NDArray[np.int64]:
    """The open edges that do not lie in an outer face of a grid of this shape and spacing 1."""
    edges = open_edges(vertices, triangles)
    ends = vertices[edges]
    outer = (ends == 0.0).all(axis=1) | (ends == np.array(shape) - 1.0).all(axis=1)
    return edges[~outer.any(axis=1)]


def corners_of(vertices: Floats, triangles: Triangles) -> NDArray[np.float64]:
    """The corners of the triangles, (m, 3, 3)."""
    return vertices.astype(np.float64)[triangles]


def areas(vertices: Floats, triangles: Triangles) -> NDArray[np.float64]:
    """The area of each triangle."""
    a, b, c = corners_of(vertices, triangles).transpose(1, 0, 2)
    return np.asarray(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1))


def soup(vertices: Floats, triangles: Triangles) -> Floats:
    """The triangles' corners (m, 9) in an order that numbering does not change; the sense of rotation is kept."""
    corners = vertices[triangles]
    lowest = np.lexsort(corners.transpose(2, 0, 1)[::-1], axis=-1)[:, :1]
    turned = np.take_along_axis(corners, (lowest + np.arange(3))[:, :, None] % 3, axis=1).reshape(-1, 9)
    return np.asarray(turned[np.lexsort(turned.T[::-1])])


def euler_characteristic(vertices: Floats, triangles: Triangles) -> int:
    """Vertices less edges plus triangles, of which there must be some."""
    ends = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1).astype(np.int64)
    edges = 1 + np.count_nonzero(np.diff(np.sort(ends @ [len(vertices), 1])))
    return len(vertices) - edges + len(triangles)


def winding_numbers(vertices: Floats, triangles: Triangles, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """How often a surface goes around each of ``points``: the solid angles of its triangles, over 4 pi.

    The solid angle of a triangle is van Oosterom and Strackee's, 1983.
    """
    a, b, c = (corners_of(vertices, triangles)[None] - points[:, None, None, :]).transpose(2, 0, 1, 3)
    la, lb, lc = (np.linalg.norm(side, axis=2) for side in (a, b, c))
    above = np.einsum("pti,pti->pt", a, np.cross(b, c))
    below = (la * lb * lc + np.einsum("pti,pti->pt", a, b) * lc + np.einsum("pti,pti->pt", b, c) * la
             + np.einsum("pti,pti->pt", c, a) * lb)
    return np.asarray(2.0 * np.arctan2(above, below).sum(axis=1) / (4.0 * np.pi))


def sample_places(shape: tuple[int, ...]) -> NDArray[np.float64]:
    """Where the samples of a grid with spacing 1 are, in the order of the flat array, (n, 3)."""
    return np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), axis=-1).reshape(-1, 3).astype(np.float64)


def crossed_edge_count(inside: NDArray[np.bool_]) -> int:
    """How many edges of the grid join samples of which one is inside."""
    return sum(int(np.diff(inside, axis=axis).sum()) for axis in range(3))


def triangle_soup(vertices: NDArray[np.float64], triangles: Triangles) -> tuple[NDArray[np.float64], Triangles]:
    """The same triangles, each with three vertices of its own."""
    return vertices[triangles.ravel()], np.arange(triangles.size, dtype=np.int32).reshape(-1, 3)
