"""Rays through a grid: what a click on a picture hits."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]


def first_cell(cells: Vector, origin: Vector, direction: Vector) -> tuple[int, int, int] | None:
    """The first of ``cells`` (n, 3), unit boxes by their lowest corners, that a ray from ``origin`` enters.

    The slabs of Kay and Kajiya 1986: a ray is inside a box while it is between each pair of its planes.
    """
    if not len(cells):
        return None
    with np.errstate(divide="ignore", invalid="ignore"):
        near, far = (cells - origin) / direction, (cells + 1.0 - origin) / direction
    enters = np.nanmax(np.minimum(near, far), axis=1)
    leaves = np.nanmin(np.maximum(near, far), axis=1)
    enters[(enters > leaves) | (leaves <= 0.0)] = np.inf
    nearest = int(np.argmin(enters))
    if not np.isfinite(enters[nearest]):
        return None
    x, y, z = cells[nearest].astype(int).tolist()
    return x, y, z


def near_ray(places: Vector, origin: Vector, direction: Vector, distance: float) -> NDArray[np.bool_]:
    """Which of ``places`` (n, 3) are at most ``distance`` away from the line of a ray."""
    away = np.cross(places - origin, direction / np.linalg.norm(direction))
    near: NDArray[np.bool_] = np.einsum("ij,ij->i", away, away) <= distance ** 2
    return near


def meetings(corners: Vector, origin: Vector, direction: Vector) -> Vector:
    """How many times ``direction`` a ray goes until it meets each triangle (m, 3, 3), from either side; else NaN.

    Möller and Trumbore 1997: u and v say where in the triangle's plane, along two of its sides.
    """
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    aside = np.cross(direction, second)
    start = origin - corners[:, 0]
    across = np.cross(start, first)
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = 1.0 / np.einsum("ij,ij->i", first, aside)
        u, v = np.einsum("ij,ij->i", start, aside) * scale, across @ direction * scale
        times = np.einsum("ij,ij->i", second, across) * scale
        return np.asarray(np.where((u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (times >= 0.0), times, np.nan))
