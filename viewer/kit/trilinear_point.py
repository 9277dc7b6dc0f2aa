"""Where the vertices inside a cell go: on the trilinear surface, or near it, and never on the cell's boundary."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from viewer.kit.trilinear_cell import CORNERS
from viewer.kit.trilinear_decision import columns, quadratic

Points = NDArray[np.float64]
Values = NDArray[np.float64]

WAIST_MARGIN = 1e-3     # a waist's least distance from the cell's boundary, and its least width
HUB_MARGIN = 0.05
NEWTON_STEPS = 3


def waist_points(corners: Values, facing: NDArray[np.int64]) -> Points:
    """For each cell the corner of the box around its tunnel's waist that faces corner ``facing`` of the cell.

    A plane across an axis meets the level set in two crossing lines where the products of its opposite corners
    agree. In a cell with a tunnel that happens at two places along each axis, and the six planes bound a box of
    whose edges six lie in the surface: the hexagon of Grosso, 2016. ``corners`` (n, 8) are values minus the
    level; the result is (n, 3), in units of the cell.
    """
    points = np.empty((len(corners), 3))
    for axis in range(3):
        start, end = columns(corners, axis)
        a, b, c = quadratic(start[:, ::2], end[:, ::2], start[:, 1::2], end[:, 1::2])
        with np.errstate(divide="ignore", invalid="ignore"):
            middle = np.nan_to_num(-b / (2.0 * a), nan=0.5)
            reach = np.nan_to_num(np.sqrt(np.maximum(b * b - 4.0 * a * c, 0.0)) / np.abs(2.0 * a), nan=0.0)
        middle = np.clip(middle, 2.0 * WAIST_MARGIN, 1.0 - 2.0 * WAIST_MARGIN)
        reach = np.maximum(reach, 0.5 * WAIST_MARGIN)
        side = np.where(CORNERS[facing, axis] == 1, 1.0, -1.0)
        points[:, axis] = np.clip(middle + side * reach, WAIST_MARGIN, 1.0 - WAIST_MARGIN)
    return points


def hub_points(corners: Values, middle: Points, alone: NDArray[np.bool_]) -> Points:
    """The ``middle`` of each cell's loop, moved to the trilinear surface where the loop is ``alone`` in its cell.

    Among several loops it stays in its own loop's convex hull. The others cut off single corners of the cell, and
    a plane through the cuts parts such a corner from the hull.
    """
    points = middle.copy()
    moving = np.clip(middle[alone], HUB_MARGIN, 1.0 - HUB_MARGIN)
    value, gradient = trilinear(corners[alone], moving)
    for _ in range(NEWTON_STEPS):
        steepness = np.einsum("ij,ij->i", gradient, gradient)
        step = value / np.where(steepness > 0.0, steepness, np.inf)
        further = np.clip(moving - step[:, None] * gradient, HUB_MARGIN, 1.0 - HUB_MARGIN)
        value_there, gradient_there = trilinear(corners[alone], further)
        better = np.abs(value_there) < np.abs(value)
        moving[better], value[better], gradient[better] = further[better], value_there[better], gradient_there[better]
    points[alone] = moving
    return points


def trilinear(corners: Values, points: Points) -> tuple[Values, Points]:
    """The function linear along each axis between ``corners`` (n, 8), and its gradient, at ``points`` (n, 3)."""
    weight = np.where(CORNERS == 1, points[:, None, :], 1.0 - points[:, None, :])
    x, y, z = weight[..., 0], weight[..., 1], weight[..., 2]
    slope = np.where(CORNERS == 1, 1.0, -1.0)
    gradient = [(corners * slope[:, axis] * area).sum(axis=1) for axis, area in enumerate((y * z, z * x, x * y))]
    return (corners * x * y * z).sum(axis=1), np.stack(gradient, axis=1)
