"""The case tables of marching cubes and marching tetrahedra, worked out from the geometry.

A cell has eight corners. Corner ``c`` stands at x = bit 0, y = bit 1, z = bit 2 of ``c``, so that corner
5 = 101 (binary) is at (1, 0, 1). Each corner is inside (its value is below the level) or outside: 256
cases, and the case's number has bit ``c`` set where corner ``c`` is inside.

An edge is named by the corner it starts at and the direction it goes in, a number whose bits are the
axes it moves along: edge (1, 4) leaves corner 1 along z and ends at corner 1 | 4 = 5. Cubes have the
twelve edges along one axis; the six tetrahedra also have the diagonals of faces (directions 3, 5, 6) and
the cube's own diagonal (7).

*Cubes* (Lorensen and Cline 1987). Each face of the cell is a square with four corners: where the
surface crosses the face it leaves a line, from the edge where a walk around the face comes to inside
corners to the edge where it leaves them again. A face with two opposite inside corners is ambiguous:
here the walk comes to each of them alone, so each is cut off by a line of its own. That depends on the
signs of the face alone, hence the cell on its other side draws the same lines and nothing gapes
(Montani, Scateni and Scopigno 1994). The lines of all six faces join into closed loops, and each loop
is filled with triangles.

*Tetrahedra* (Doi and Koide 1991). The cell is cut into the six tetrahedra that share its diagonal from
corner 0 to corner 7. In each, the surface cuts off one corner with a triangle or two from two with a
quadrangle; nothing is ambiguous.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import combinations
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Edge: TypeAlias = tuple[int, int]               # the corner it starts at, the bits of the axes it moves along
Triangle: TypeAlias = tuple[Edge, Edge, Edge]

CORNERS = np.array([[c & 1, c >> 1 & 1, c >> 2 & 1] for c in range(8)])
# The corners of each face, counter-clockwise as seen from outside the cell: x = 0, x = 1, y = 0 ...
FACES = ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6))
# From corner 0 to corner 7 by way of every order of the axes. The lecture's list says 0, 1, 2, 7 in place of
# 0, 1, 3, 7; but then two tetrahedra would overlap and part of the cell would be missed.
TETRAHEDRA = ((0, 1, 3, 7), (0, 1, 5, 7), (0, 2, 3, 7), (0, 2, 6, 7), (0, 4, 5, 7), (0, 4, 6, 7))


@dataclass(frozen=True)
class CaseTable:
    """For each of the 256 cases its triangles, whose corners are the middles of crossed edges.

    Triangles are counter-clockwise as seen from where values are larger. ``edges`` lists every edge that
    is used; ``directions`` their directions, ascending.
    """

    cases: tuple[tuple[Triangle, ...], ...]
    edges: tuple[Edge, ...]
    directions: tuple[int, ...]

    @property
    def counts(self) -> NDArray[np.intp]:
        """The number of triangles of each case, (256,)."""
        return np.array([len(triangles) for triangles in self.cases])


@cache
def case_table(method: str) -> CaseTable:
    """The table of ``cubes`` or ``tetrahedra``; raises KeyError for any other name."""
    make = {"cubes": cube_case, "tetrahedra": tetrahedra_case}[method]
    cases = tuple(tuple(make(case)) for case in range(256))
    edges = tuple(sorted({edge for case in cases for triangle in case for edge in triangle}))
    return CaseTable(cases, edges, tuple(sorted({direction for _, direction in edges})))


def is_inside(case: int, corner: int) -> bool:
    """Whether ``corner`` is inside in ``case``."""
    return bool(case >> corner & 1)


def edge_between(first: int, second: int) -> Edge:
    """The edge between two corners of which one has all the bits of the other."""
    return min(first, second), first ^ second


def middle(edge: Edge) -> tuple[float, float, float]:
    """The middle of an edge in the unit cell."""
    x, y, z = ((edge[0] >> axis & 1) + 0.5 * (edge[1] >> axis & 1) for axis in range(3))
    return x, y, z


def ambiguous_faces(case: int) -> list[int]:
    """The faces, numbered as in ``FACES``, of which two opposite corners are inside and two outside."""
    return [face for face, corners in enumerate(FACES)
            if [is_inside(case, corner) for corner in corners] in ([True, False] * 2, [False, True] * 2)]


# Marching cubes

def cube_case(case: int) -> Iterator[Triangle]:
    """The triangles of one case of marching cubes."""
    for loop in loops(face_lines(case)):
        yield from filled(loop)


def face_lines(case: int) -> dict[Edge, Edge]:
    """Where the surface runs on the cell's faces: from one crossed edge to the next."""
    lines = {}
    for corners in FACES:
        around = [(corners[i - 1], corners[i]) for i in range(4)]
        enters = [edge for edge in around if not is_inside(case, edge[0]) and is_inside(case, edge[1])]
        leaves = [edge for edge in around if is_inside(case, edge[0]) and not is_inside(case, edge[1])]
        for enter in enters:
            leave = min(leaves, key=lambda edge: (around.index(edge) - around.index(enter)) % 4)
            lines[edge_between(*enter)] = edge_between(*leave)
    return lines


def loops(lines: dict[Edge, Edge]) -> Iterator[list[Edge]]:
    """The closed loops into which the lines of all faces join."""
    left = dict(lines)
    while left:
        start, edge = left.popitem()
        loop = [start]
        while edge != start:
            loop.append(edge)
            edge = left.pop(edge)
        yield loop


def filled(loop: Sequence[Edge]) -> list[Triangle]:
    """Triangles that fill a loop, bent as little as may be, without a side that lies in a face of the cell.

    The cell behind that face might draw the same side, and four triangles would meet there.
    """
    return min(triangulations(tuple(loop)), key=lambda triangles: (
        _sides_in_faces(loop, triangles), round(sum(_area(*triangle) for triangle in triangles), 9)))


def triangulations(polygon: tuple[Edge, ...]) -> Iterator[list[Triangle]]:
    """Every way to cut a polygon into triangles along its diagonals."""
    if len(polygon) < 3:
        yield []
        return
    first, last = polygon[0], polygon[-1]
    for i in range(1, len(polygon) - 1):
        for before in triangulations(polygon[:i + 1]):
            for after in triangulations(polygon[i:]):
                yield [*before, (first, polygon[i], last), *after]


def _sides_in_faces(loop: Sequence[Edge], triangles: Sequence[Triangle]) -> int:
    """How many diagonals of the loop join two points of one face."""
    around = {frozenset(pair) for pair in zip(loop, [*loop[1:], loop[0]], strict=True)}
    sides = {frozenset(pair) for triangle in triangles for pair in combinations(triangle, 2)}
    return sum(_share_a_face(*side) for side in sides - around)


@cache
def _share_a_face(first: Edge, second: Edge) -> bool:
    corners = {first[0], first[0] | first[1], second[0], second[0] | second[1]}
    return any(corners <= set(face) for face in FACES)


@cache
def _area(*triangle: Edge) -> float:
    """The area of a triangle between the middles of its edges."""
    return 0.5 * math.hypot(*_normal(*triangle))


def _normal(*triangle: Edge) -> tuple[float, float, float]:
    """A normal towards the side from which the triangle is counter-clockwise, twice its area long."""
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = map(middle, triangle)
    ux, uy, uz, vx, vy, vz = bx - ax, by - ay, bz - az, cx - ax, cy - ay, cz - az
    return uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx


# Marching tetrahedra

def tetrahedra_case(case: int) -> Iterator[Triangle]:
    """The triangles of one case of marching tetrahedra, the six tetrahedra one after the other."""
    for tetrahedron in TETRAHEDRA:
        yield from tetrahedron_triangles(case, tetrahedron)


def tetrahedron_triangles(case: int, tetrahedron: Sequence[int]) -> list[Triangle]:
    """The part of the surface inside one tetrahedron: nothing, a triangle or two."""
    inside = [corner for corner in tetrahedron if is_inside(case, corner)]
    outside = [corner for corner in tetrahedron if not is_inside(case, corner)]
    if len(inside) == 2:
        (a, b), (c, d) = inside, outside
        around = [edge_between(a, c), edge_between(a, d), edge_between(b, d), edge_between(b, c)]
        cut = [(around[0], around[1], around[2]), (around[0], around[2], around[3])]
    else:
        crossed = [edge_between(a, b) for a in inside for b in outside]
        cut = [(crossed[0], crossed[1], crossed[2])] if crossed else []
    return [_facing(triangle, inside, outside) for triangle in cut]


def _facing(triangle: Triangle, inside: Sequence[int], outside: Sequence[int]) -> Triangle:
    """The triangle with its corners counter-clockwise as seen from the outside corners."""
    outwards = [sum(corner >> axis & 1 for corner in outside) / len(outside)
                - sum(corner >> axis & 1 for corner in inside) / len(inside) for axis in range(3)]
    faces_out = sum(n * o for n, o in zip(_normal(*triangle), outwards, strict=True)) > 0.0
    return triangle if faces_out else (triangle[0], triangle[2], triangle[1])
