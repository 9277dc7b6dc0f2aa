"""Triangles for the pieces of a level set in one cell: discs, and a tunnel's tube. No two of them cross.

A template names the twelve possible crossings by their edges 0 to 11, and further vertices inside the cell from
12 on. It depends on signs and decisions alone, so there is one for all the cells that agree in those.

No diagonal lies in a face of the cell: the neighbour might use it too, and four triangles would share it.
"""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from viewer.kit.trilinear_cell import (
    COLUMNS,
    EDGE_BETWEEN,
    EDGES,
    FACES,
    FACES_OF_EDGE,
    Loop,
    boundary_loops,
    face_segments,
    is_outside,
)

Triangle: TypeAlias = tuple[int, int, int]
Outline: TypeAlias = list[int]      # edges crossed, and CROSSINGS + n for corner n of the cell

CROSSINGS = len(EDGES)


class Patch(NamedTuple):
    """The template of one kind of cell."""
    triangles: NDArray[np.int64]    # (m, 3)
    points: NDArray[np.int64]       # what each vertex inside is: the bits of a loop's edges for its middle,
                                    # or -1 - n for the vertex of a tunnel's waist that faces corner n


@cache
def patch(case: int, joined: int, tunnel: int) -> Patch:
    """The triangles of a cell with these signs, joined faces and tunnel (see ``trilinear_decision``)."""
    loops = boundary_loops(case, joined)
    rims = tunnel_rims(case, loops, tunnel)
    triangles, waist = _tube(case, joined, rims) if rims else ([], [])
    points = [-1 - corner for corner in waist]
    for loop in loops:
        if loop not in rims:
            fan = _fan(loop)
            if not fan:
                hub = CROSSINGS + len(points)
                fan = [(hub, a, b) for a, b in zip(loop, loop[1:] + loop[:1], strict=True)]
                points.append(sum(1 << edge for edge in loop))
            triangles += fan
    return Patch(np.array(triangles, np.int64).reshape(-1, 3), np.array(points, np.int64))


def _fan(loop: Loop) -> list[Triangle]:
    """Triangles from one crossing to all the others, or none if every such fan has a diagonal in a face.

    Seen from a crossing, no two points of the cell's boundary outside its own two faces are in line; so a fan
    that leaves those faces alone cannot cross itself. For the same reason a fan from within the cell, a hub,
    never does.
    """
    for turn in range(len(loop)):
        first, *rest = loop[turn:] + loop[:turn]
        if not any(FACES_OF_EDGE[first] & FACES_OF_EDGE[other] for other in rest[1:-1]):
            return [(first, a, b) for a, b in pairwise(rest)]
    return []


def tunnel_rims(case: int, loops: tuple[Loop, ...], tunnel: int) -> tuple[Loop, ...]:
    """The two loops that a tunnel joins: those of the sheets around two opposite columns; () without a tunnel."""
    if not tunnel:
        return ()
    pattern, inside = divmod(tunnel - 1, 2)
    first = (pattern + inside) % 2
    rims = tuple(_sheet(case, loops, pattern, column) for column in (first, first + 2))
    # Rounding may find a tunnel between a sheet and itself where a saddle as good as touches the level.
    return rims if rims[0] != rims[1] else ()


def _sheet(case: int, loops: tuple[Loop, ...], pattern: int, column: int) -> Loop:
    """The loop that a plane meets between ``column`` and the next while the signs alternate by ``pattern``.

    If they do so at an end of the two columns already, the loop crosses the edge there; otherwise both columns
    change their signs, in the same direction, and one curve joins their crossings.
    """
    after = (column + 1) % 4
    edge = column
    for shift in (0, 1):
        ends = COLUMNS[0][column] + shift, COLUMNS[0][after] + shift
        if [is_outside(case, end) for end in ends] == [(k - pattern) % 2 == 0 for k in (column, after)]:
            edge = EDGE_BETWEEN[ends]
    return next(loop for loop in loops if edge in loop)


def _tube(case: int, joined: int, rims: tuple[Loop, ...]) -> tuple[list[Triangle], list[int]]:
    """The tube between two rims, and the cell's corners faced by the vertices of its waist.

    The waist is drawn on a box within the cell (after Grosso, "Construction of topologically correct and
    manifold isosurfaces", 2016). Planes from the edges of the cell to those of the box cut the space between
    into six frusta, one at each face. The band of the cell's boundary between the rims has a part in each
    face: the tube has a piece with the same outline in each frustum, but at the corners of the box instead of
    those of the face. The pieces meet on the frusta's walls only, and there as the parts of the band do.
    """
    outlines = [outline for face in range(6) for outline in _outlines(case, face, bool(joined >> face & 1), rims)]
    band = _band(outlines, rims)
    waist = sorted({item for outline in band for item in outline if item >= CROSSINGS})
    number = {corner: CROSSINGS + k for k, corner in enumerate(waist)}
    triangles = [triangle for outline in band for triangle in _piece([number.get(item, item) for item in outline])]
    # Seen from outside the cell the band is counter-clockwise, and lies beyond the tube: right if it is outside.
    if not is_outside(case, waist[0] - CROSSINGS):
        triangles = [(a, c, b) for a, b, c in triangles]
    return triangles, [corner - CROSSINGS for corner in waist]


def _outlines(case: int, face: int, joined: bool, rims: tuple[Loop, ...]) -> list[Outline]:
    """The parts into which the rims cut a face, each counter-clockwise seen from outside the cell."""
    corners = FACES[face]
    ahead = [EDGE_BETWEEN[corners[k], corners[(k + 1) % 4]] for k in range(4)]
    curves = [curve for curve in face_segments(case, face, joined).items() if any(curve[0] in rim for rim in rims)]
    across = {a: b for curve in curves for a, b in (curve, curve[::-1])}
    unseen, outlines = set(range(4)), []
    while unseen:
        outline, k = [], min(unseen)
        while k in unseen:
            unseen.remove(k)
            outline.append(CROSSINGS + corners[k])
            if ahead[k] in across:
                outline += [ahead[k], across[ahead[k]]]
                k = ahead.index(across[ahead[k]])
            k = (k + 1) % 4
        outlines.append(outline)
    return outlines


def _band(outlines: list[Outline], rims: tuple[Loop, ...]) -> list[Outline]:
    """Those of the outlines that make up the part of the boundary between two rims: the one at both of them."""
    parts: list[list[Outline]] = []
    for outline in outlines:
        corners = {item for item in outline if item >= CROSSINGS}
        touching = [part for part in parts if any(corners & set(other) for other in part)]
        parts = [part for part in parts if part not in touching]
        parts.append([outline, *(other for part in touching for other in part)])
    return next(part for part in parts if all(any(rim[0] in outline for outline in part) for rim in rims))


def _piece(polygon: list[int]) -> list[Triangle]:
    """A fan over ``polygon`` from a vertex of the waist, whose diagonals therefore leave the face; the middle one."""
    turns = [polygon[k:] + polygon[:k] for k in range(len(polygon)) if polygon[k] >= CROSSINGS]
    first, *rest = max(turns, key=lambda turn: min(turn[1], turn[-1]) >= CROSSINGS)
    return [(first, a, b) for a, b in pairwise(rest)]
