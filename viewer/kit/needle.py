"""A thin pyramid, to stand on a surface along its normal: see ``shaders/lib/needle.glsl``."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def needle_corners() -> NDArray[np.float32]:
    """The corners of its four sides, three for each, from a square at 0 to a tip at 1: (12, 3)."""
    square = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (-1.0, 0.0, 0.0), (0.0, -1.0, 0.0)]
    sides = [(square[i], square[(i + 1) % 4], (0.0, 0.0, 1.0)) for i in range(4)]
    return np.array(sides, "f4").reshape(-1, 3)
