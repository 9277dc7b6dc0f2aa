"""A function over the unit square, sampled on a grid and traced by marching squares, jumps recognised."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from viewer.kit.formula import Formula
from viewer.kit.level_curve import Function, distances, jumping
from viewer.kit.marching_squares import AMBIGUOUS, NOT_A_VALUE, Tracing, cell_cases, curve_count, trace
from viewer.kit.square_cell import SquareCell

Flags: TypeAlias = NDArray[np.bool_]

RUNGS = (4, 8, 16, 32, 64, 128, 256)    # resolutions at which the error is plotted
PLACES = np.linspace(0.0, 1.0, 5)       # along a segment, where its distance to the true curve is taken


@dataclass(frozen=True)
class FormulaAt:
    """A formula in x and y at one moment, with its numbers; two that are equal have the same values."""

    formula: Formula
    time: float
    numbers: tuple[tuple[str, float], ...]

    def __call__(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """The values (n,) at ``points`` (n, 2), in double precision."""
        values = self.formula.evaluate(x=points[:, 0], y=points[:, 1], t=self.time, **dict(self.numbers))
        return np.asarray(values, np.float64)


@dataclass(frozen=True)
class SampledSquare:
    """What marching squares sees and finds of a function with ``resolution`` cells along each axis.

    Sample ``values[i, j]`` sits at (i, j) / ``resolution``. Cells are given by flags or cases (n, n): ``jumps``
    where the function jumps through the level, ``barren`` where there is no curve for that or for want of a value.
    """

    function: Function
    resolution: int
    level: float
    values: NDArray[np.float64]
    cases: NDArray[np.uint8]
    jumps: Flags
    barren: Flags
    tracing: Tracing

    @property
    def without_value(self) -> Flags:
        """Cells that touch a sample which is infinite or no number."""
        return np.asarray(self.cases == NOT_A_VALUE)

    @property
    def crossed(self) -> Flags:
        """Cells of which corners differ in sign."""
        return np.asarray((self.cases % 15 != 0) & ~self.without_value)

    @property
    def ambiguous(self) -> Flags:
        """Cells with opposite corners alike and neighbours not."""
        return np.isin(self.cases, AMBIGUOUS)

    def cell(self, i: int, j: int) -> SquareCell:
        """The cell (i, j) by itself."""
        a, b, c, d = self.values[i:i + 2, j:j + 2].T.ravel().tolist()
        return SquareCell((a, b, c, d), self.level)

    @cached_property
    def curves(self) -> int:
        """How many connected curves there are."""
        return curve_count(self.tracing.edges)

    @cached_property
    def max_distance(self) -> float:
        """How far, at most, the segments are from the true curve; NaN without any, and where there is none near."""
        ends = self.tracing.segments.astype(np.float64)
        if not len(ends):
            return float("nan")
        points = (ends[:, None, 0] * (1.0 - PLACES[:, None]) + ends[:, None, 1] * PLACES[:, None]).reshape(-1, 2)
        found = distances(self.function, points, 2.0 / self.resolution, self.level)
        return float(np.nanmax(found)) if not np.isnan(found).all() else float("nan")

    def numbers(self) -> dict[str, float]:
        """What can be counted and measured of the curve, and of the cells it came from."""
        return {
            "segments": len(self.tracing.segments), "curves": self.curves, "length": self.tracing.length,
            "max_distance": self.max_distance, "crossed_cells": int(self.crossed.sum()),
            "ambiguous_cells": int(self.ambiguous.sum()), "jumps": int(self.jumps.sum()),
        }


@lru_cache(maxsize=2)
def sample(function: Function, resolution: int, level: float = 0.0, saddle: str = "decider",
           jumps: str = "cut") -> SampledSquare:
    """``function`` sampled on a grid of ``resolution`` x ``resolution`` cells and traced through ``level``.

    ``jumps`` ``cut`` leaves cells out where the function jumps through the level; ``keep`` does not ask.
    """
    step = np.arange(resolution + 1) / resolution
    places = np.stack(np.meshgrid(step, step, indexing="ij"), axis=-1)
    values = function(places.reshape(-1, 2)).reshape(places.shape[:2])
    cases = cell_cases(values, level)
    jumping_there = jumping_cells(function, values, level)
    barren = (jumping_there & (jumps == "cut")) | (cases == NOT_A_VALUE)
    tracing = trace(values, level, (1.0 / resolution,) * 2, saddle, left_out=barren)
    return SampledSquare(function, resolution, level, values, cases, jumping_there, barren, tracing)


def jumping_cells(function: Function, values: NDArray[np.float64], level: float) -> Flags:
    """The cells with an edge along which the function jumps through the level."""
    cells = len(values) - 1
    jumps = np.zeros((cells, cells), np.bool_)
    inside, known = values < level, np.isfinite(values)
    for axis, along in enumerate(np.eye(2, dtype=int)):
        here, there = np.arange(cells), np.arange(1, cells + 1)
        start = np.argwhere(np.diff(inside, axis=axis) & known.take(here, axis) & known.take(there, axis))
        i, j = start[jumping(function, start / cells, (start + along) / cells, level)].T
        for beside in (0, 1):                       # the cells on both sides of the edge
            x, y = i - beside * along[1], j - beside * along[0]
            within = (x >= 0) & (y >= 0) & (x < cells) & (y < cells)
            jumps[x[within], y[within]] = True
    return jumps


@lru_cache(maxsize=2)
def errors_by_resolution(function: Function, level: float, saddle: str, jumps: str) -> NDArray[np.float64]:
    """The largest distance to the true curve at each of ``RUNGS``."""
    return np.array([sample.__wrapped__(function, rung, level, saddle, jumps).max_distance for rung in RUNGS])
