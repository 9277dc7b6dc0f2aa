"""Lines in space that keep their width on the screen: paths, arrows."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import ArrayLike, NDArray

from viewer.engine.gpu import Gpu

STROKE = np.dtype([("start", "f4", 3), ("end", "f4", 3), ("color", "f4", 4), ("width", "f4")])
MOST_STROKES = 8192
HEAD = 0.28         # of an arrow's length
HEAD_WIDTH = 0.42   # of its head's length

Strokes = NDArray[np.void]


def path(places: ArrayLike, color: ArrayLike, width: float) -> Strokes:
    """The strokes that join ``places`` (n, 3); ``color`` is linear rgb and opacity, ``width`` in pixels."""
    corners = np.asarray(places, np.float32).reshape(-1, 3)
    strokes = np.zeros(max(0, len(corners) - 1), STROKE)
    strokes["start"], strokes["end"], strokes["color"], strokes["width"] = corners[:-1], corners[1:], color, width
    return strokes


def arrow(start: NDArray[np.float64], way: NDArray[np.float64], eye: NDArray[np.float64], color: ArrayLike,
          width: float) -> Strokes:
    """An arrow from ``start`` along ``way``, its head turned to ``eye``; (3,) each, in metres."""
    tip = start + way
    across = np.cross(way, eye - tip)
    size = np.linalg.norm(across)
    side = HEAD * HEAD_WIDTH * np.linalg.norm(way) * across / size if size > 1e-12 else np.zeros(3)
    neck = tip - HEAD * way
    return np.concatenate([path([start, tip], color, width), path([neck + side, tip, neck - side], color, width)])


class StrokeBrush:
    """Draws strokes into the layer of ``draw_sprites``: premultiplied, tested against the depth of what is solid."""

    def __init__(self, gpu: Gpu) -> None:
        self._buffer = gpu.buffer(reserve=MOST_STROKES * STROKE.itemsize, label="strokes")
        program = gpu.program("particles/stroke.vert", "particles/stroke.frag")
        layout = "3f 3f 4f 1f/i", "in_start", "in_end", "in_color", "in_width"
        self._array = gpu.vertex_array(program, [(self._buffer, *layout)], mode=moderngl.TRIANGLE_STRIP)

    def draw(self, strokes: Strokes) -> None:
        """Draw ``strokes``, the first ``MOST_STROKES`` of them."""
        drawn = strokes[:MOST_STROKES]
        if len(drawn):
            self._buffer.write(drawn.tobytes())
            self._array.render(vertices=4, instances=len(drawn))
