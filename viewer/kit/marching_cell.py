"""One cell under the microscope: everything that marching cubes or tetrahedra work out about it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain

import numpy as np
from numpy.typing import ArrayLike, NDArray

from viewer.kit.interpolation import crossing_fraction, saddle_value
from viewer.kit.marching_cases import (
    CORNERS,
    FACES,
    TETRAHEDRA,
    Edge,
    Triangle,
    ambiguous_faces,
    case_table,
    tetrahedron_triangles,
)

AXES = "xyz"


@dataclass(frozen=True)
class Crossing:
    """Where the surface crosses an edge: the values less the level at its ends, and t = A / (A - B)."""

    edge: Edge
    A: float
    B: float
    t: float
    place: NDArray[np.float64]

    @property
    def ends(self) -> tuple[int, int]:
        """The corners that the edge joins."""
        return self.edge[0], self.edge[0] | self.edge[1]


@dataclass(frozen=True)
class AmbiguousFace:
    """A face with two opposite corners inside; ``saddle`` is the bilinear value between them, less the level.

    Where the saddle is inside, it joins the two inside corners (Nielson and Hamann 1991, the asymptotic decider).
    """

    face: int
    saddle: float

    @property
    def name(self) -> str:
        """Such as ``x = 0``."""
        return f"{AXES[self.face // 2]} = {self.face % 2}"

    @property
    def joins_inside(self) -> bool:
        """Whether the trilinear surface joins the inside corners across this face."""
        return self.saddle < 0.0


@dataclass(frozen=True)
class Cell:
    """The eight ``values`` (8,) less the level, the ``case``, and what follows; places are in the unit cell.

    ``triangles`` (m, 3) are places in ``crossings``; ``tetrahedron`` (m,) tells which of the six a triangle
    lies in, 0 throughout for cubes. ``torn`` tells that the function jumps inside the cell, which then
    yields nothing; ``decided`` (m, 3, 3) are the triangles of the trilinear surface, where that is asked for.
    """

    values: NDArray[np.float64]
    case: int
    crossings: tuple[Crossing, ...]
    triangles: NDArray[np.intp]
    tetrahedron: NDArray[np.intp]
    ambiguous: tuple[AmbiguousFace, ...]
    torn: bool = False
    decided: NDArray[np.float64] | None = None

    @property
    def yielded(self) -> NDArray[np.float64]:
        """The triangles that the cell yields, by their corners' places, (m, 3, 3)."""
        if self.torn:
            return np.empty((0, 3, 3))
        return self.places[self.triangles] if self.decided is None else self.decided

    @property
    def has_values(self) -> bool:
        """Whether every corner has one."""
        return bool(np.isfinite(self.values).all())

    @property
    def binary(self) -> str:
        """The case in binary, corner 7 first."""
        return f"{self.case:08b}"

    @property
    def places(self) -> NDArray[np.float64]:
        """Where the crossings are, (n, 3)."""
        return np.array([crossing.place for crossing in self.crossings]).reshape(-1, 3)


def examine(values: ArrayLike, method: str = "cubes") -> Cell:
    """The cell whose corners have these ``values`` (8,), less the level, corner c at the bits of c."""
    at_corners = np.asarray(values, np.float64)
    if not np.isfinite(at_corners).all():
        nothing = np.empty(0, np.intp)
        return Cell(at_corners, 0, (), nothing.reshape(0, 3), nothing, ())
    case = int(sum(1 << corner for corner in range(8) if at_corners[corner] < 0.0))
    triangles, tetrahedra = _triangles(case, method)
    edges = sorted({edge for triangle in triangles for edge in triangle})
    faces = ambiguous_faces(case) if method == "cubes" else []
    return Cell(at_corners, case, tuple(_crossing(edge, at_corners) for edge in edges),
                np.array([[edges.index(edge) for edge in triangle] for triangle in triangles], np.intp).reshape(-1, 3),
                np.array(tetrahedra, np.intp),
                tuple(AmbiguousFace(face, face_saddle(at_corners[list(FACES[face])])) for face in faces))


def face_saddle(around: Sequence[float] | NDArray[np.float64]) -> float:
    """The value at the saddle of the bilinear function with these values around a face, opposite signs in turn.

    The values are those at the corners, one after the other.
    """
    a, b, c, d = around
    return float(saddle_value(np.array([a, b, d, c], np.float64)))


def edge_name(edge: Edge) -> str:
    """Such as ``1-5``: the corners it joins."""
    return f"{edge[0]}-{edge[0] | edge[1]}"


def _triangles(case: int, method: str) -> tuple[Sequence[Triangle], list[int]]:
    if method == "cubes":
        triangles = case_table(method).cases[case]
        return triangles, [0] * len(triangles)
    parts = [tetrahedron_triangles(case, tetrahedron) for tetrahedron in TETRAHEDRA]
    return list(chain.from_iterable(parts)), [index for index, part in enumerate(parts) for _ in part]


def _crossing(edge: Edge, values: NDArray[np.float64]) -> Crossing:
    start, end = edge[0], edge[0] | edge[1]
    A, B = float(values[start]), float(values[end])
    t = float(crossing_fraction(A, B))
    place = CORNERS[start] + t * (CORNERS[end] - CORNERS[start])
    return Crossing(edge, A, B, t, place)
