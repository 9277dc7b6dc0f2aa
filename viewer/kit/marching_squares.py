"""Marching squares: the curve on which a sampled function of x and y passes through a level.

    segments = marching_squares(values, level=0.0, spacing=(0.1, 0.1))        # (n, 2, 2): from, to; x, y

Sample ``values[i, j]`` sits at (x, y) = (i, j) times ``spacing``. Four neighbouring samples are the corners
of a cell. Corner ``c`` stands at x = bit 0, y = bit 1 of ``c``:

    2 ----- 3
    |       |
    0 ----- 1

A corner is inside where its value is below the level; one that equals the level is outside. The number of a
cell's case has bit ``c`` set where corner ``c`` is inside: sixteen cases. An edge is named by the corner that
it starts at and the direction, 1 for x and 2 for y, as in marching cubes.

*The cases.* Walk once around the cell, counter-clockwise. On some edges the walk leaves the inside, on others
it enters the inside again. The curve joins each edge where the walk leaves to one where it enters, and so it
has the inside on its left. In all but two cases there is at most one of each, and nothing to decide. In
cases 6 and 9 opposite corners are alike and there are two of each. These two are ambiguous:

    separate    joins each to the edge where it last entered, and so cuts off the inside corners from each other
    connect     joins each to the edge where it enters next: the inside corners are joined through the middle
    decider     asks the bilinear function through the four values. Its level lines are two branches of a
                hyperbola, and its value at the saddle between them tells which pair of corners they part
                (Nielson and Hamann 1991). A saddle that is inside connects.

*The crossing* of an edge with values A and B, less the level, lies at t = A / (A - B) of its length: where the
straight line through both values is zero. It is kept ``NEAREST`` away from the corners, so that no segment
has length zero. A cell that touches a sample which is infinite or no number yields nothing.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from viewer.kit.interpolation import crossing_fraction, saddle_value

Floats: TypeAlias = NDArray[np.float64]
Flags: TypeAlias = NDArray[np.bool_]

# The walk around a cell, and the same edges by the corner where each starts and its direction.
WALK = ((0, 1), (1, 3), (3, 2), (2, 0))
EDGES = ((0, 1), (1, 2), (2, 1), (0, 2))
EDGE_NAMES = ("bottom", "right", "top", "left")
AMBIGUOUS = (6, 9)
SADDLES = ("connect", "separate", "decider")
NOT_A_VALUE = 16            # the case of a cell of which a corner has no finite value


def segments_of(case: int, answer: str) -> list[tuple[int, int]]:
    """The segments of a case, each from one edge to another by their places in ``EDGES``."""
    inside = [bool(case >> corner & 1) for corner in range(4)]
    leaves = [edge for edge, (a, b) in enumerate(WALK) if inside[a] and not inside[b]]
    enters = [edge for edge, (a, b) in enumerate(WALK) if not inside[a] and inside[b]]
    step = 1 if answer == "connect" else -1         # look ahead for the next entry, or back for the last one
    return [(leave, min(enters, key=lambda enter: (enter - leave) * step % 4)) for leave in leaves]


@cache
def case_table() -> NDArray[np.int8]:
    """Every case's segments: (2, 16, 2, 2), for ``connect`` and ``separate``; -1 where there is none."""
    table = np.full((2, 16, 2, 2), -1, np.int8)
    for answer, name in enumerate(SADDLES[:2]):
        for case in range(16):
            for place, segment in enumerate(segments_of(case, name)):
                table[answer, case, place] = segment
    return table


@dataclass(frozen=True)
class Tracing:
    """Segments, and where each comes from.

    ``segments`` (n, 2, 2) float32 holds from and to, x and y, with the inside on the left; ``cells`` (n, 2)
    the cell (i, j) of each, row by row from the bottom; ``edges`` (n, 2) a number for the grid's edge where
    it begins and where it ends, the same in the cells on both sides.
    """

    segments: NDArray[np.float32]
    cells: NDArray[np.intp]
    edges: NDArray[np.intp]

    @property
    def length(self) -> float:
        """The length of all segments together."""
        along = np.diff(self.segments.astype(np.float64), axis=1)
        return float(np.hypot(along[..., 0], along[..., 1]).sum())


def marching_squares(values: ArrayLike, level: float = 0.0, spacing: tuple[float, float] = (1.0, 1.0),
                     saddle: str = "decider") -> NDArray[np.float32]:
    """The segments (n, 2, 2) float32 on which ``values`` pass through ``level``, from and to, x and y.

    Directed so that the inside, where values are smaller, is on the left. ``saddle`` is ``connect``,
    ``separate`` or ``decider``. Raises ValueError for another word and for what is no grid of 2 x 2 or more.
    """
    return trace(values, level, spacing, saddle).segments


def trace(values: ArrayLike, level: float = 0.0, spacing: tuple[float, float] = (1.0, 1.0),
          saddle: str = "decider", left_out: Flags | None = None) -> Tracing:
    """Like ``marching_squares``, with the cell and the edges of each segment.

    ``left_out`` (nx - 1, ny - 1) marks cells that shall yield nothing.
    """
    samples = checked(values)
    if saddle not in SADDLES:
        raise ValueError(f"saddle = {saddle} is not one of {', '.join(SADDLES)}")
    cases = cell_cases(samples, level)
    crossed = cases % 15 != 0
    crossed &= cases != NOT_A_VALUE
    if left_out is not None:
        crossed &= ~left_out
    j, i = np.divmod(np.flatnonzero(crossed.T), len(cases))
    case = cases[i, j]
    answer = answers(samples, level, saddle, i, j, case)
    found = case_table()[answer, case].reshape(-1, 2)
    there = found[:, 0] >= 0
    cells = np.repeat(np.stack([i, j], axis=1), 2, axis=0)[there]
    points, edges = crossings(samples, level, spacing, cells, found[there])
    return Tracing(points.astype(np.float32), cells, edges)


def checked(values: ArrayLike) -> Floats:
    """``values`` as a grid of float64; raises ValueError."""
    samples = np.asarray(values)
    if samples.dtype.kind not in "fiub" or samples.ndim != 2 or min(samples.shape) < 2:
        raise ValueError(f"{samples.dtype} values of shape {samples.shape} are no grid of 2 x 2 real numbers or more")
    return samples.astype(np.float64, copy=False)


def cell_cases(values: Floats, level: float = 0.0) -> NDArray[np.uint8]:
    """The case of every cell, 0 to 15, or ``NOT_A_VALUE``; (nx - 1, ny - 1)."""
    inside = (values < level).view(np.uint8)
    pairs = inside[:-1] + 2 * inside[1:]
    cases: NDArray[np.uint8] = pairs[:, :-1] + 4 * pairs[:, 1:]
    unknown = ~np.isfinite(values)
    if unknown.any():
        beside = unknown[:-1] | unknown[1:]
        cases[beside[:, :-1] | beside[:, 1:]] = NOT_A_VALUE
    return cases


def answers(values: Floats, level: float, saddle: str, i: NDArray[np.intp], j: NDArray[np.intp],
            case: NDArray[np.uint8]) -> NDArray[np.intp]:
    """For each cell (i, j) 0 where it connects, 1 where it separates."""
    if saddle != "decider":
        return np.full(len(case), SADDLES.index(saddle))
    answer = np.zeros(len(case), np.intp)
    open_question = np.flatnonzero(np.isin(case, AMBIGUOUS))
    i, j = i[open_question], j[open_question]
    corners = [values[i + (c & 1), j + (c >> 1)] - level for c in range(4)]
    answer[open_question] = saddle_value(np.stack(corners, axis=-1)) >= 0.0
    return answer


def crossings(values: Floats, level: float, spacing: tuple[float, float], cells: NDArray[np.intp],
              edges: NDArray[np.int8]) -> tuple[Floats, NDArray[np.intp]]:
    """The points (n, 2, 2) on ``edges`` (n, 2) of ``cells`` (n, 2), and a number for each edge of the grid."""
    corner, direction = np.array(EDGES).T[:, edges]
    i, j = cells[:, :1] + (corner & 1), cells[:, 1:] + (corner >> 1)
    along_x, along_y = direction & 1, direction >> 1
    t = crossing_fraction(values[i, j] - level, values[i + along_x, j + along_y] - level)
    points = np.stack([(i + t * along_x) * spacing[0], (j + t * along_y) * spacing[1]], axis=-1)
    return points, 2 * (i * values.shape[1] + j) + along_y


def joined(edges: NDArray[np.intp]) -> tuple[NDArray[np.intp], Flags]:
    """Which curve each segment belongs to, (n,) numbers that one curve shares, and whether that curve is closed.

    Each segment looks for the one that begins where it ends; then, again and again, for the one that it finds
    after twice as many steps, and notes the lowest number that it comes by. An open curve is named by its
    last segment, a closed one by its lowest.
    """
    count = len(edges)
    order = np.argsort(edges[:, 0])
    place = np.searchsorted(edges[order, 0], edges[:, 1])
    candidate = order[np.minimum(place, count - 1)] if count else order
    here = np.arange(count)
    ahead = np.where(edges[candidate, 0] == edges[:, 1], candidate, here)
    last = ahead == here
    lowest = here
    for _ in range(count.bit_length()):
        lowest = np.minimum(lowest, lowest[ahead])
        ahead = ahead[ahead]
    closed = ~last[ahead]
    return np.where(closed, lowest, ahead), closed


def curve_count(edges: NDArray[np.intp]) -> int:
    """How many connected curves, open or closed, the segments with these ``edges`` form."""
    return len(np.unique(joined(edges)[0]))
