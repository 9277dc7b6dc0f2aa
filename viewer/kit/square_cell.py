"""One cell of marching squares, worked out step by step as on a blackboard."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from viewer.kit.interpolation import crossing_fraction, saddle_value
from viewer.kit.marching_squares import AMBIGUOUS, EDGE_NAMES, WALK, segments_of

CORNERS = ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0))


@dataclass(frozen=True)
class Crossing:
    """An edge of the cell with values A and B, less the level, at its ends, and where the curve crosses it.

    ``place`` is within the cell, 0 to 1 across and up.
    """

    edge: int
    A: float
    B: float
    t: float
    place: tuple[float, float]

    @property
    def name(self) -> str:
        """Which edge of the cell it is."""
        return EDGE_NAMES[self.edge]


@dataclass(frozen=True)
class SquareCell:
    """A cell by the ``values`` of its corners 0 to 3; NaN and infinite ones are welcome."""

    values: tuple[float, float, float, float]
    level: float = 0.0

    @property
    def has_values(self) -> bool:
        """Whether every corner has a finite value."""
        return bool(np.isfinite(self.values).all())

    @property
    def case(self) -> int:
        """The number whose bit c says that corner c is inside."""
        return sum((value < self.level) << corner for corner, value in enumerate(self.values))

    def sign(self, corner: int) -> str:
        """``-`` for an inside corner, ``+`` for an outside one, ``?`` where there is no value."""
        if not np.isfinite(self.values[corner]):
            return "?"
        return "-" if self.case >> corner & 1 else "+"

    @property
    def ambiguous(self) -> bool:
        """Whether there are two ways to join its crossings."""
        return self.has_values and self.case in AMBIGUOUS

    @property
    def saddle_value(self) -> float:
        """The bilinear function's value at its saddle, less the level."""
        return float(saddle_value(np.asarray(self.values) - self.level))

    @property
    def crossings(self) -> list[Crossing]:
        """The crossed edges: bottom, right, top, left."""
        return [self._crossing(edge) for edge in range(4)
                if self.has_values and len({self.case >> corner & 1 for corner in WALK[edge]}) == 2]

    def answer(self, saddle: str) -> str:
        """``connect`` or ``separate``, as ``saddle`` has it."""
        if saddle != "decider":
            return saddle
        return "separate" if self.ambiguous and self.saddle_value >= 0.0 else "connect"

    def segments(self, answer: str) -> NDArray[np.float32]:
        """The segments that ``answer`` joins its crossings to, within the cell: (n, 2, 2)."""
        places = {crossing.edge: crossing.place for crossing in self.crossings}
        pairs = segments_of(self.case, answer) if self.has_values else []
        return np.array([[places[begin], places[end]] for begin, end in pairs], np.float32).reshape(-1, 2, 2)

    def corner_rows(self, i: int, j: int, resolution: int) -> list[tuple[float, float, float, float, str]]:
        """Corner, x, y, value and sign of each corner, as cell (i, j) of a grid on the unit square."""
        return [(corner, (i + x) / resolution, (j + y) / resolution, self.values[corner], self.sign(corner))
                for corner, (x, y) in enumerate(CORNERS)]

    def crossing_rows(self, i: int, j: int, resolution: int) -> list[tuple[str, float, float, float, float, float]]:
        """Edge, A, B, t, x and y of each crossing, as cell (i, j) of a grid on the unit square."""
        return [(one.name, one.A, one.B, one.t, (i + one.place[0]) / resolution, (j + one.place[1]) / resolution)
                for one in self.crossings]

    def _crossing(self, edge: int) -> Crossing:
        start, end = sorted(WALK[edge])
        A, B = self.values[start] - self.level, self.values[end] - self.level
        t = float(crossing_fraction(A, B))
        (x0, y0), (x1, y1) = CORNERS[start], CORNERS[end]
        return Crossing(edge, A, B, t, (x0 + t * (x1 - x0), y0 + t * (y1 - y0)))
