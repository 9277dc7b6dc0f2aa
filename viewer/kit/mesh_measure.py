"""What can be said of a triangle mesh in numbers: its size, its pieces and its shape in the large."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Vertices = NDArray[np.floating]
Triangles = NDArray[np.integer]


class MeshNumbers(NamedTuple):
    """Numbers of a mesh; ``volume`` is NaN for one that is not closed."""

    vertices: int
    triangles: int
    euler_characteristic: int
    components: int
    area: float
    volume: float


def mesh_numbers(vertices: Vertices, triangles: Triangles) -> MeshNumbers:
    """The numbers of a mesh of ``vertices`` (n, 3), all of them in use, and ``triangles`` (m, 3)."""
    edges, uses = unique_edges(triangles, len(vertices))
    closed = bool((uses == 2).all())
    return MeshNumbers(len(vertices), len(triangles), len(vertices) - len(edges) + len(triangles),
                       components(edges, len(vertices)), area(vertices, triangles),
                       volume(vertices, triangles) if closed else float("nan"))


def unique_edges(triangles: Triangles, count: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Every edge once, its smaller vertex first (e, 2), and how many triangles have it (e,)."""
    ends = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]).astype(np.int64)
    names, uses = np.unique(ends.min(axis=1) * count + ends.max(axis=1), return_counts=True)
    return np.stack(np.divmod(names, max(1, count)), axis=1), uses


def components(edges: NDArray[np.int64], count: int) -> int:
    """How many pieces ``count`` vertices make that these edges join.

    Every vertex points to one of its piece with a smaller number; pieces that an edge joins are hooked
    together and the chains cut short until nothing changes (after Shiloach and Vishkin 1982).
    """
    root = np.arange(count)
    first, second = edges[:, 0], edges[:, 1]
    while len(first):
        first, second = root[first], root[second]
        apart = first != second
        first, second = first[apart], second[apart]
        np.minimum.at(root, np.maximum(first, second), np.minimum(first, second))
        while (shorter := root[root]).tobytes() != root.tobytes():
            root = shorter
    return int((root == np.arange(count)).sum())


def area(vertices: Vertices, triangles: Triangles) -> float:
    """The sum of the triangles' areas."""
    return float(0.5 * np.linalg.norm(_doubled_normals(vertices, triangles), axis=1).sum())


def volume(vertices: Vertices, triangles: Triangles) -> float:
    """What a closed mesh encloses, positive where its triangles are counter-clockwise seen from outside."""
    middle = vertices.mean(axis=0, dtype=np.float64) if len(vertices) else np.zeros(3)
    corners = vertices[triangles[:, 0]].astype(np.float64) - middle
    return float(np.einsum("ij,ij->", corners, _doubled_normals(vertices, triangles)) / 6.0)


def _doubled_normals(vertices: Vertices, triangles: Triangles) -> NDArray[np.float64]:
    a, b, c = (vertices[triangles[:, corner]].astype(np.float64) for corner in range(3))
    return np.cross(b - a, c - a)
