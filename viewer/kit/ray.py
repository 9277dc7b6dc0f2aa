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
    enters[(enters > leaves) | (leaves < 0.0)] = np.inf
    nearest = int(np.argmin(enters))
    if not np.isfinite(enters[nearest]):
        return None
    x, y, z = cells[nearest].astype(int).tolist()
    return x, y, z
