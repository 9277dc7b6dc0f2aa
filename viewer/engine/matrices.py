"""The few matrices the engine needs, as float64 arrays in GL memory order (row vectors: v @ M)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray
from pyrr import matrix44

Matrix: TypeAlias = NDArray[np.float64]
UP = (0.0, 1.0, 0.0)


def look_at(eye: Sequence[float] | Matrix, target: Sequence[float] | Matrix) -> Matrix:
    """World to the camera at ``eye`` that looks at ``target``, y up."""
    return np.asarray(matrix44.create_look_at(np.asarray(eye, float), np.asarray(target, float), np.asarray(UP)), float)


def perspective(field_of_view: float, aspect: float, near: float, far: float) -> Matrix:
    """Perspective projection, ``field_of_view`` vertical and in degrees."""
    return np.asarray(matrix44.create_perspective_projection(field_of_view, aspect, near, far), float)


def orthographic(half_width: float, near: float, far: float) -> Matrix:
    """Parallel projection of a square ``2 * half_width`` across."""
    ends = (-half_width, half_width)
    return np.asarray(matrix44.create_orthogonal_projection(*ends, *ends, near, far), float)
