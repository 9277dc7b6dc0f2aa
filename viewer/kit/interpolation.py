"""What straight lines between samples say: where they are zero on an edge, and what they come to on a face."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

# As near to a sample as a crossing may come, in edges: else those around a sample exactly at the level would
# meet in one point, and the segments and triangles between them would have no length and no area.
NEAREST = 1e-4


def crossing_fraction(A: ArrayLike, B: ArrayLike) -> NDArray[np.floating[Any]]:
    """How far along an edge a line from ``A`` to ``B``, the values less the level, is zero: t = A / (A - B).

    Kept ``NEAREST`` away from the ends; the middle where the values are too large to tell.
    """
    with np.errstate(all="ignore"):
        t = np.asarray(np.divide(A, np.subtract(A, B)))
    return np.asarray(np.clip(np.where(np.isnan(t), 0.5, t), NEAREST, 1.0 - NEAREST))


def saddle_value(corners: NDArray[np.floating[Any]]) -> NDArray[np.floating[Any]]:
    """The bilinear function's value where it is level, from the values (..., 4) of corners 0 to 3, x + 2y.

    (a d - b c) / (a + d - b - c), by which Nielson and Hamann 1991 decide which corners an ambiguous face joins.
    """
    largest = np.abs(corners).max(axis=-1)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        a, b, c, d = np.moveaxis(corners / largest[..., None], -1, 0)       # lest a product overflows
        return np.asarray(largest * (a * d - b * c) / (a + d - b - c))
