"""Tables from which a shader draws points of a mesh: on its surface by area, along its edges by length.

    table = surface_table(vertices, triangles)
    table.places        # (n, 3, 4): the corners of each triangle, and how to choose among triangles
    table.normals       # (n, 3, 3)

A choice takes one look into the table, however long it is: ``alias_table`` says how.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from viewer.kit.mesh import Triangles, Vertices, normalized
from viewer.kit.mesh_measure import volume
from viewer.kit.shapes import face_normals, half_edges

SHARP_DEGREES = 30.0
LONGEST_TABLE = 2**24           # entries: the whole numbers that float32 holds without a gap
SCATTER = (0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9)      # odd numbers of random bits


class SamplingTable(NamedTuple):
    """What points are drawn from: ``places`` (n, k, 4) and ``normals`` (n, j, 3), both float32.

    An entry's points are in x, y, z of its k places. With two or more of them, w of the first is the chance
    that the entry keeps who chose it, and w of the second the entry that takes the others; with one, w is the
    radius of a ball around it that lies inside. The normals, of length 1, are as many as the places or one.
    """

    places: NDArray[np.float32]
    normals: NDArray[np.float32]


class Edges(NamedTuple):
    """Edges of a mesh, each once: ``ends`` (e, 2) by vertex, ``normals`` (e, 3), ``marked`` (e,).

    Marked are those where faces meet at more than 30 degrees, those of a single face, and those of more than
    two. A normal is the mean of the normals of the faces that meet there.
    """

    ends: NDArray[np.int64]
    normals: Vertices
    marked: NDArray[np.bool_]


def alias_table(weights: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """How to choose entry i with a chance of ``weights[i]`` (n,) by two random numbers and one look.

    Returns thresholds (n,) and aliases (n,): choose an entry, all alike; keep it where a random number from
    0 to 1 is below its threshold, and else take its alias. (Walker, "An Efficient Method for Generating
    Discrete Random Variables", 1977.) Entries above the mean, in order, fill up those below, in order; when
    one has given so much that it falls below the mean itself, the next fills it up. Sums of what is wanted
    and of what is there tell at once who fills whom. ``weights`` are not negative, and their sum is not zero.
    """
    share = weights * (len(weights) / weights.sum())
    light, heavy = np.nonzero(share < 1.0)[0], np.nonzero(share >= 1.0)[0]
    wanted = np.concatenate([[0.0], np.cumsum(1.0 - share[light])])
    spare = np.cumsum(share[heavy] - 1.0)
    threshold, alias = np.ones(len(share)), np.arange(len(share))
    if not len(heavy):          # all alike, but for rounding
        return threshold, alias
    giver = np.searchsorted(spare, wanted[:-1], side="left")
    threshold[light] = share[light]
    alias[light] = heavy[np.minimum(giver, len(heavy) - 1)]
    filled = np.searchsorted(wanted, spare, side="right")       # how many light ones when it falls below the mean
    short = np.nonzero((filled < len(wanted)) & (np.arange(len(heavy)) < len(heavy) - 1))[0]
    threshold[heavy[short]] = np.clip(1.0 + spare[short] - wanted[filled[short]], 0.0, 1.0)
    alias[heavy[short]] = heavy[short + 1]
    return threshold, alias


def surface_table(vertices: Vertices, triangles: Triangles, normals: Vertices | None = None) -> SamplingTable:
    """Triangles by area: three places and three normals to an entry. Those without area are left out.

    ``normals`` (n, 3) are the vertices' own; where there are none, where one is zero, or where it points
    against its triangle, the triangle's normal stands for it. Raises ValueError where nothing has an area or
    there are more than 2**24 triangles.
    """
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    solid = area > 0.0
    if not solid.all():
        triangles, area = triangles[solid], area[solid]
    faces = np.broadcast_to(face_normals(vertices, triangles)[:, None], (*triangles.shape, 3))
    if normals is not None:
        own = normals[triangles]
        facing = np.einsum("tci,tci->tc", own, faces) > 1e-3
        faces = np.where(facing[:, :, None], own, faces)
    return _table(vertices[triangles], faces, area)


def edge_table(vertices: Vertices, triangles: Triangles) -> SamplingTable:
    """Edges by length: two places and one normal to an entry.

    Of the sharp edges and those of an open border, or of all edges where there are none. Raises ValueError as
    ``surface_table`` does.
    """
    edges = mesh_edges(vertices, triangles)
    chosen = edges.marked if edges.marked.any() else np.ones(len(edges.ends), np.bool_)
    places = vertices[edges.ends[chosen]]
    return _table(places, edges.normals[chosen][:, None], np.linalg.norm(places[:, 1] - places[:, 0], axis=1))


def mesh_edges(vertices: Vertices, triangles: Triangles) -> Edges:
    """Every edge between triangles that have an area, whichever of the vertices at a place they name."""
    triangles = with_area(vertices, welded(vertices, triangles))
    normals = face_normals(vertices, triangles)
    sides, edge = half_edges(triangles, len(vertices))
    uses = np.bincount(edge)
    first = np.concatenate([[0], np.cumsum(uses)[:-1]]).astype(np.int64)
    starts, faces = sides[first], normals[sides // 3]
    sums = np.stack([np.bincount(edge, faces[:, axis]) for axis in range(3)], axis=1)
    folded = np.linalg.norm(sums, axis=1) < 1e-9        # two sides of a sheet: either will do
    last = normals[sides[first + uses - 1] // 3]
    flat = np.einsum("ij,ij->i", normals[starts // 3], last) >= np.cos(np.radians(SHARP_DEGREES))
    ends = np.stack([triangles.ravel()[starts], np.roll(triangles, -1, axis=1).ravel()[starts]], axis=1)
    mean = normalized(np.where(folded[:, None], normals[starts // 3], sums))
    return Edges(ends.astype(np.int64), mean, (uses != 2) | ~flat)


def is_closed(vertices: Vertices, triangles: Triangles) -> bool:
    """Whether every edge is passed as often one way as the other, so that the mesh parts inside from outside."""
    joined = with_area(vertices, welded(vertices, triangles)).astype(np.int64)
    start, end = joined.ravel(), np.roll(joined, -1, axis=1).ravel()
    count = len(vertices)
    there, back = np.sort(start * count + end), np.sort(end * count + start)
    return bool(np.array_equal(there, back))


def faces_inward(vertices: Vertices, triangles: Triangles) -> bool:
    """Whether a closed mesh is inside out, its triangles clockwise seen from outside."""
    return volume(vertices, triangles) < 0.0 and is_closed(vertices, triangles)


def welded(vertices: Vertices, triangles: Triangles) -> Triangles:
    """The same triangles, each naming for each corner the first vertex at exactly its place."""
    bits = np.ascontiguousarray(vertices + 0.0).view(np.uint64)         # + 0.0 makes -0.0 and 0.0 alike
    name = np.zeros(len(vertices), np.uint64)
    for axis, factor in enumerate(SCATTER):
        name = (name ^ bits[:, axis]) * np.uint64(factor)
        name ^= name >> np.uint64(29)
    _, first, which = np.unique(name, return_index=True, return_inverse=True)
    kept = first[which]
    if not np.array_equal(vertices[kept], vertices, equal_nan=True):    # two places of the same name
        _, first, which = np.unique(vertices, axis=0, return_index=True, return_inverse=True)
        kept = first[which.ravel()]
    return kept[triangles].astype(np.int32)


def with_area(vertices: Vertices, triangles: Triangles) -> Triangles:
    """Those triangles that are more than a line or a point, going by their corners' names."""
    a, b, c = triangles.T
    distinct = (a != b) & (b != c) & (c != a)
    return triangles if distinct.all() else triangles[distinct]


def _table(places: Vertices, normals: Vertices, weights: NDArray[np.float64]) -> SamplingTable:
    if not weights.sum() > 0.0:
        raise ValueError("there is nothing to draw points from: no area and no length")
    if len(weights) > LONGEST_TABLE:
        raise ValueError(f"{len(weights)} parts to draw points from are too many; {LONGEST_TABLE} are allowed")
    entries = np.zeros((*places.shape[:2], 4), np.float32)
    entries[:, :, :3] = places
    entries[:, 0, 3], entries[:, 1, 3] = alias_table(weights)
    return SamplingTable(entries, np.ascontiguousarray(normals, np.float32))
