"""The solid of a formula as closely as its samples allow: never smaller than where the formula is below 0."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from viewer.kit.field_function import FieldFunction, gradient

if TYPE_CHECKING:
    from viewer.kit.distance_field import DistanceField

Points = NDArray[np.float64]

FEWEST_PARTS, MOST_PARTS = 4, 10     # places along each side of a cell at which it is compared with the formula
PLACES = 1_000_000      # as many as that takes no time; where there are few cells each gets more
ROUNDS = 6              # of lowering; nothing is left to lower after three or so
NEAR = 0.5              # cells: no further outside the field is the formula below 0
CLOSE = 0.15            # cells: further inside nothing can be missing
NEWTON_STEPS = 3
MORE = 1.1              # times as much is taken off as is found missing, for what lies between the places
LEFT_OVER = 2e-4        # cells: so little may be missing
FARTHEST_GAP = 0.5      # cells: where the formula says it is further away, it is no slope but a jump


def gaps(function: FieldFunction, places: Points, cell: float, farthest: float = FARTHEST_GAP) -> Points:
    """How far ``places`` (n, 3) close to a formula's surface are outside of it, to first order.

    0 where it would be more than ``farthest`` cells, or is not known.
    """
    value, slope = _value_and_slope(function, places)
    with np.errstate(all="ignore"):
        gap = value / np.linalg.norm(slope, axis=1)
        return np.where(np.abs(gap) < farthest * cell, gap, 0.0)


def covering(field: DistanceField, function: FieldFunction, reach: float) -> DistanceField:
    """The field, lowered where it is above 0 though ``function`` is below within ``reach`` of the origin.

    Between samples linear interpolation cuts off what is round or sharp; here the samples around give way.
    """
    places = _below(field, function, reach)
    for _ in range(ROUNDS):
        missing = field.at(places)
        wrong = missing > LEFT_OVER * field.cell
        if not wrong.any():
            break
        lowered = field.values - _around(field, places[wrong], MORE * missing[wrong])
        field = replace(field, values=lowered.astype(np.float32))
        places = places[missing > -CLOSE * field.cell]
    return field


def _below(field: DistanceField, function: FieldFunction, reach: float) -> Points:
    """Places (n, 3) near the field's surface at which the function is below 0 or very nearly 0."""
    from scipy.ndimage import maximum_filter, minimum_filter

    high, low = maximum_filter(field.values, 2, origin=-1), minimum_filter(field.values, 2, origin=-1)
    cells = np.argwhere(((high > 0.0) & (low < NEAR * field.cell))[:-1, :-1, :-1])
    parts = int(np.clip(np.cbrt(PLACES / max(len(cells), 1)), FEWEST_PARTS, MOST_PARTS))
    step = (np.arange(parts) + 0.5) / parts
    within = np.stack(np.meshgrid(step, step, step, indexing="ij"), axis=-1).reshape(-1, 3)
    places = np.clip(field.origin + (cells[:, None] + within).reshape(-1, 3) * field.spacing, -reach, reach)
    distance = field.at(places)
    places = places[(distance > -CLOSE * field.cell) & (distance < NEAR * field.cell)]
    sure = places[function.at(places.astype(np.float32)) < 0.0]
    return np.concatenate([sure, _on_surface(function, places, reach, field.cell)])


def _on_surface(function: FieldFunction, places: Points, reach: float, cell: float) -> Points:
    """The places moved to where the function is 0 (Newton's method), without those that do not get there."""
    moved = places
    for _ in range(NEWTON_STEPS):
        value, slope = _value_and_slope(function, moved)
        with np.errstate(all="ignore"):
            step = slope * (value / np.square(slope).sum(axis=1))[:, None]
            short = np.square(step).sum(axis=1) < cell**2       # not so where it is no number
        places, moved = places[short], np.clip(moved[short] - step[short], -reach, reach)
    return moved[np.abs(gaps(function, moved, cell, np.inf)) < LEFT_OVER * cell]


def _value_and_slope(function: FieldFunction, places: Points) -> tuple[Points, Points]:
    """The function (n,) and its gradient (n, 3), of which either may be no number."""
    single = places.astype(np.float32)
    x, y, z = np.ascontiguousarray(single.T)
    numbers = dict(function.numbers)
    slopes = [np.broadcast_to(part.evaluate(x=x, y=y, z=z, **numbers), x.shape)
              for part in gradient(function.formula)]
    return function.at(single).astype(np.float64), np.stack(slopes, axis=1).astype(np.float64)


def _around(field: DistanceField, places: Points, missing: Points) -> Points:
    """How much to lower each sample (nx, ny, nz) so that ``missing`` (n,) is taken off at ``places`` (n, 3).

    All corners of a cell are lowered alike, and those beyond them smoothly less, so that normals hardly turn.
    """
    from scipy.ndimage import maximum_filter, uniform_filter

    last = np.array(field.values.shape) - 2
    cells = np.clip(np.floor((places - field.origin) / field.spacing).astype(np.intp), 0, last)
    needed = np.zeros(field.values.shape)
    for corner in np.ndindex(2, 2, 2):
        np.maximum.at(needed, tuple((cells + corner).T), missing)
    return np.asarray(uniform_filter(maximum_filter(needed, 3), 3))     # the mean of what is nowhere less
