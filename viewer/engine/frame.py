"""The uniform block that every shader may read: camera, time, light and studio (``lib/frame.glsl``).

``FRAME`` lays the block out by the std140 rules; its names and order are those of the GLSL.
"""

from __future__ import annotations

from collections.abc import Mapping

import moderngl
import numpy as np
from numpy.typing import ArrayLike

from viewer.engine.labels import label

FRAME_BINDING = 0
SHADOW_NEAR_UNIT = 15
SHADOW_WIDE_UNIT = 14

FRAME = np.dtype([
    ("view", "f4", (4, 4)),
    ("projection", "f4", (4, 4)),
    ("view_projection", "f4", (4, 4)),
    ("clip_to_world", "f4", (4, 4)),
    ("world_to_shadow", "f4", (4, 4)),
    ("eye", "f4", 3), ("time", "f4"),
    ("resolution", "f4", 2), ("number", "f4"), ("has_ground", "f4"),
    ("key_direction", "f4", 3), ("ground_height", "f4"),
    ("center", "f4", 3), ("radius", "f4"),
    ("backdrop_low", "f4", 4),
    ("backdrop_high", "f4", 4),
])


class FrameBlock:
    """The block's buffer on the GPU; bind it, then write what a pass needs."""

    def __init__(self, context: moderngl.Context) -> None:
        self._values = np.zeros((), FRAME)
        self._buffer = context.buffer(reserve=FRAME.itemsize)
        label(self._buffer, "Frame")

    def write(self, values: Mapping[str, ArrayLike]) -> None:
        """Set the fields named in ``values`` and send the whole block."""
        for name, value in values.items():
            self._values[name] = value
        self._buffer.write(self._values.tobytes())

    def bind(self) -> None:
        """Make it the block that shaders read."""
        self._buffer.bind_to_uniform_block(FRAME_BINDING)

    def release(self) -> None:
        """Free the buffer."""
        self._buffer.release()
