"""The board that shows marching squares: the unit square on its front, or the sheet of the sixteen cases.

The square's place (x, y) stands in the world at (2x - 1, 2y - 1, 0). The sheet has four by four tiles, case 0
at the upper left, and in each a cell.
"""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from viewer.kit.marching_squares import segments_of
from viewer.kit.sampled_square import Flags, SampledSquare

Place: TypeAlias = tuple[float, float]

REACH = 1.13                    # from the board's middle to its rim
THICKNESS = 0.09
FRONT = slice(24, 30)           # the front's corners in ``box``
CROSSED, IS_AMBIGUOUS, NO_CURVE, FADED = 16, 32, 64, 128    # bits of a cell; the lowest four hold its case
TILE_CORNER, TILE_SIDE = (0.24, 0.34), 0.52                 # of the cell in a tile, in tiles

REFINE_SECONDS = 1.5            # between one grid and the next, twice as fine
REFINE_STEPS = 6
REST = 2                        # so many times longer the finest grid stays


def box() -> NDArray[np.float32]:
    """The board's sides: (36, 6), positions and normals."""
    rows = []
    for axis in range(3):
        for sign in (1.0, -1.0):
            normal = sign * np.eye(3)[axis]
            first, second = np.eye(3)[(axis + 1) % 3], sign * np.eye(3)[(axis + 2) % 3]
            around = ((-1, -1), (1, -1), (1, 1), (-1, -1), (1, 1), (-1, 1))
            rows += [np.concatenate([normal + a * first + b * second, normal]) for a, b in around]
    sides = np.array(rows)
    sides[:, :3] *= REACH, REACH, 0.5 * THICKNESS
    sides[:, 2] -= 0.5 * THICKNESS
    return sides.astype(np.float32)


def place_seen(origin: NDArray[np.float64], direction: NDArray[np.float64]) -> Place | None:
    """Where on the square a ray from ``origin`` meets its front; None if it misses the square."""
    if direction[2] >= 0.0:
        return None
    x, y, _ = 0.5 + 0.5 * (origin - origin[2] / direction[2] * direction)
    return (float(x), float(y)) if 0.0 <= x < 1.0 and 0.0 <= y < 1.0 else None


# The sheet of cases

def tile_corner(case: int) -> Place:
    """The lower left corner of a case's tile, in the square."""
    return 0.25 * (case % 4), 0.25 * (3 - case // 4)


def case_at(place: Place) -> int:
    """The case whose tile is at a place of the square."""
    return min(3, int(4.0 * place[0])) + 4 * (3 - min(3, int(4.0 * place[1])))


def sheet_segments(answer: str) -> NDArray[np.float32]:
    """The segments of all cases, crossing every edge in its middle, where the sheet has them: (16, 2, 2)."""
    middles = np.array([(0.5, 0.0), (1.0, 0.5), (0.5, 1.0), (0.0, 0.5)])         # bottom, right, top, left
    spots = np.array(TILE_CORNER) + TILE_SIDE * middles
    made = [tile_corner(case) + 0.25 * spots[list(segment)]
            for case in range(16) for segment in segments_of(case, answer)]
    return np.array(made, np.float32).reshape(-1, 2, 2)


# What the board's shader reads

def tones(values: NDArray[np.float64], level: float, colouring: str) -> NDArray[np.float32]:
    """For each sample its place in the colours, and -1 inside, 1 outside, 0 without a value: (ny, nx, 2)."""
    known = np.isfinite(values)
    off = np.where(known, values, level) - level
    if colouring == "viridis":
        low, high = value_range(values)
        tone = np.clip((off + level - low) / (high - low), 0.0, 1.0)
    else:
        below, above = (_median(np.abs(off[known & side])) for side in (values < level, values >= level))
        tone = off / (np.abs(off) + np.where(off < 0.0, below, above))      # half of each side's samples below 0.5
    sign = np.where(known, np.where(values < level, -1.0, 1.0), 0.0)
    return np.ascontiguousarray(np.stack([tone, sign], axis=-1).transpose(1, 0, 2), np.float32)


def _median(sizes: NDArray[np.float64]) -> float:
    """The median; 1 where there is none above 0."""
    return (float(np.median(sizes)) if sizes.size else 0.0) or 1.0


def value_range(values: NDArray[np.float64]) -> Place:
    """The values between which viridis is spread: all but the extreme ones, which a pole may have."""
    known = values[np.isfinite(values)]
    low, high = np.quantile(known, (0.02, 0.98)) if known.size else (0.0, 1.0)
    return float(low), float(high) if high > low else float(low) + max(1.0, abs(float(low)))


def taking_part(cases: NDArray[np.uint8], case: str, done: int) -> Flags:
    """The cells of ``case`` among the first ``done``, row by row from the bottom."""
    number = np.arange(cases.size).reshape(cases.T.shape).T
    there = number < done
    return there if case == "all" else there & (cases == int(case))


def cell_bits(square: SampledSquare, faded: Flags) -> NDArray[np.uint8]:
    """What the shader knows of each cell, (ny, nx)."""
    bits = (square.cases & 15) | CROSSED * (square.crossed & ~square.barren) | IS_AMBIGUOUS * square.ambiguous
    return np.ascontiguousarray((bits | NO_CURVE * square.barren | FADED * faded).T, np.uint8)


# What time does

def refined(resolution: int, seconds: float, finest: int) -> int:
    """The resolution at a moment of the animated refinement: doubled again and again, then from the start."""
    doublings = min(REFINE_STEPS, int(math.log2(finest / resolution)))
    return int(resolution) << min(doublings, int(seconds / REFINE_SECONDS) % (doublings + REST + 1))


def walked(resolution: int, seconds: float, cells_per_second: float) -> int:
    """How many cells a walk is through with; it stands in the next one."""
    return min(resolution * resolution, int(seconds * cells_per_second + 1e-9))
