"""The true curve on which a function of x and y passes through a level, asked of the function itself.

This is the yardstick for what is made from samples: it takes the function's values wherever it likes, in
double precision, and nothing else. A ``Function`` takes points (n, 2) and gives values (n,).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from viewer.kit.jumps import HALVINGS, stay_apart

Points: TypeAlias = NDArray[np.float64]
Values: TypeAlias = NDArray[np.float64]
Function: TypeAlias = Callable[[Points], Values]

STEPS = 12              # of the search for the nearest point, which as a rule needs three or four
STEP = 1e-7             # between values of which a slope is taken
CLOSE = 1e-10           # a search that moves no farther has come to rest
RAYS = 16               # in which the curve is looked for where a crease misleads
MOST_SOUGHT = 400
PROBES = 12             # along a ray, to find a change of sign


def jumping(function: Function, start: Points, end: Points, level: float = 0.0) -> NDArray[np.bool_]:
    """Whether the function jumps through the level, rather than passing it, between ``start`` and ``end`` (n, 2).

    See ``jumps.stay_apart``.
    """
    return stay_apart(function, start, end, function(start) - level, function(end) - level, level)


def distances(function: Function, points: Points, reach: float, level: float = 0.0) -> Values:
    """How far each of ``points`` (n, 2) is from the curve; NaN where there is none within ``reach``.

    Newton's steps along the slope lead onto the curve, steps along the curve to the point of it that is nearest.
    Where a crease spoils that, the curve is looked for along straight lines all around; if that happens more than
    ``MOST_SOUGHT`` times, only for some of the points, and the others are NaN too.
    """
    nearest = points.copy()
    settled = np.zeros(len(points), np.bool_)
    moving = np.arange(len(points))
    for _ in range(STEPS):
        step = _step(function, nearest[moving], points[moving], level)
        size = np.hypot(step[:, 0], step[:, 1])
        with np.errstate(invalid="ignore", divide="ignore"):
            nearest[moving] += step * np.minimum(1.0, reach / size)[:, None]
        settled[moving[size < CLOSE]] = True
        moving = moving[size >= CLOSE]
        if not len(moving):
            break
    gone = nearest - points
    distance = np.hypot(gone[:, 0], gone[:, 1])
    lost = np.flatnonzero(~(settled & (distance <= reach)))
    distance[lost] = np.nan
    lost = lost[::1 + len(lost) // MOST_SOUGHT]
    distance[lost] = _around(function, points[lost], reach, level)
    return distance


def _step(function: Function, here: Points, start: Points, level: float) -> Points:
    """The step from ``here`` onto the curve and along it towards the point nearest to ``start``."""
    value, slope = _value_and_slope(function, here, level)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        square = (slope * slope).sum(axis=1, keepdims=True)
        back = start - here
        along = back - (back * slope).sum(axis=1, keepdims=True) / square * slope
        return np.asarray(along - value[:, None] / square * slope)


def _value_and_slope(function: Function, here: Points, level: float) -> tuple[Values, Points]:
    value = function(here)
    with np.errstate(invalid="ignore", over="ignore"):
        slopes = [(function(here + STEP * np.eye(2)[axis]) - value) / STEP for axis in range(2)]
    return value - level, np.stack(slopes, axis=1)


def _around(function: Function, points: Points, reach: float, level: float) -> Values:
    """The distance to the nearest passage through the level in any of ``RAYS`` directions; NaN without one."""
    if not len(points):
        return np.empty(0)
    turns = 2.0 * np.pi * np.arange(RAYS) / RAYS
    ways = np.tile(np.stack([np.cos(turns), np.sin(turns)], axis=1), (len(points), 1))
    starts = np.repeat(points, RAYS, axis=0)
    inside = function(starts) < level
    far = reach * np.arange(1, PROBES + 1) / PROBES
    rays = starts[:, None] + far[:, None] * ways[:, None]
    beyond = (function(rays.reshape(-1, 2)).reshape(-1, PROBES) < level) != inside[:, None]
    found = np.flatnonzero(beyond.any(axis=1))
    starts, ways, inside = starts[found], ways[found], inside[found]
    high = far[beyond[found].argmax(axis=1)]
    low = high - reach / PROBES
    passing = ~jumping(function, starts + low[:, None] * ways, starts + high[:, None] * ways, level)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        past = (function(starts + middle[:, None] * ways) < level) != inside
        low, high = np.where(past, low, middle), np.where(past, middle, high)
    reached = np.full(len(points) * RAYS, np.inf)
    reached[found[passing]] = high[passing]
    nearest = reached.reshape(len(points), RAYS).min(axis=1)
    return np.where(np.isfinite(nearest), nearest, np.nan)
