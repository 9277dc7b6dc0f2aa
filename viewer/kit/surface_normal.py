"""Normals of a surface given as a map of the unit sphere, by differences in double precision.

This is the yardstick for what a shader computes in single precision: it shares nothing with the
derivatives of a formula, only the formula's values.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Points: TypeAlias = NDArray[np.float64]
STEP = 1e-5


def sphere_tangents(points: Points) -> tuple[Points, Points]:
    """Two unit vectors along the sphere at each of ``points`` (n, 3), with first x second = point."""
    helper = np.where(np.abs(points[:, 1:2]) < 0.9, [[0.0, 1.0, 0.0]], [[1.0, 0.0, 0.0]])
    first = np.cross(helper, points)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    return first, np.cross(points, first)


def normal_candidates(surface: Callable[[Points], Points], points: Points) -> Points:
    """The normals that ``surface`` may be said to have at the images of ``points``: (5, n, 3), length 1.

    The first is by central differences; the others by differences to either side of each of two
    directions. On a smooth surface all five agree; on a crease there is no single normal, and the
    others are those of the sides that meet there.
    """
    first, second = sphere_tangents(points)
    here = surface(points)
    ahead = [(surface(points + STEP * way) - here) / STEP for way in (first, second)]
    behind = [(here - surface(points - STEP * way)) / STEP for way in (first, second)]
    pairs = [(0.5 * (ahead[0] + behind[0]), 0.5 * (ahead[1] + behind[1]))]
    pairs += [(one, other) for one in (ahead[0], behind[0]) for other in (ahead[1], behind[1])]
    normals = np.stack([np.cross(one, other) for one, other in pairs])
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(normals / np.linalg.norm(normals, axis=2, keepdims=True))


def angles_to_nearest(normals: NDArray[np.float32], candidates: Points) -> NDArray[np.float64]:
    """Degrees from each of ``normals`` (n, 3) to the nearest of its ``candidates`` (5, n, 3); (n,).

    By the arc tangent, which unlike the arc cosine keeps its precision at small angles.
    """
    across = np.linalg.norm(np.cross(candidates, normals.astype(np.float64)), axis=2)
    along = np.einsum("cij,ij->ci", candidates, normals.astype(np.float64))
    angles = np.degrees(np.arctan2(across, along))
    return np.asarray(np.min(np.where(np.isnan(angles), np.inf, angles), axis=0))
