"""Flat drawings in the picture: lines of constant width on plates, in front of everything."""

from __future__ import annotations

from collections.abc import Sequence

import moderngl
import numpy as np
from numpy.typing import ArrayLike, NDArray

from viewer.engine.gpu import Gpu
from viewer.kit.card import Rectangle
from viewer.kit.models import Rgb

COLUMNS = 8             # from, to, width, colour


def strokes(segments: ArrayLike, width: float, color: Rgb) -> NDArray[np.float32]:
    """Lines (s, 2, 2) in the picture, each -1 to 1; ``width`` in thousandths of its height, ``color`` sRGB, 0 to 1."""
    flat = np.asarray(segments, np.float32).reshape(-1, 4)
    return np.hstack([flat, np.broadcast_to(np.array([width, *color], np.float32), (len(flat), 4))])


class Sketch:
    """Shows plates (left, bottom, right, top, each -1 to 1), and on them lines in the order in which they are given."""

    def __init__(self, gpu: Gpu) -> None:
        self.gpu = gpu
        self.plates: Sequence[Rectangle] = ()
        self._count = 0
        self._rows = gpu.buffer(reserve=4096, label="sketched lines")
        self._plate = gpu.program("insets/plate.vert", "insets/plate.frag")
        self._paper = gpu.vertex_array(self._plate, mode=moderngl.TRIANGLE_STRIP)
        line = gpu.program("insets/line.vert", "insets/line.frag")
        self._lines = gpu.vertex_array(line, [
            (self._rows, "2f 2f 1f 3f/i", "in_from", "in_to", "in_width", "in_color")], mode=moderngl.TRIANGLE_STRIP)

    def show(self, plates: Sequence[Rectangle], lines: Sequence[NDArray[np.float32]]) -> None:
        """Draw these from now on; ``lines`` are ``strokes``."""
        rows = np.concatenate(lines) if lines else np.empty((0, COLUMNS), np.float32)
        self.plates, self._count = plates, len(rows)
        if rows.nbytes > self._rows.size:
            self._rows.orphan(2 * rows.nbytes)
        if rows.nbytes:
            self._rows.write(np.ascontiguousarray(rows))

    def draw(self) -> None:
        """Draw them: in ``Scene.draw_over``."""
        context = self.gpu.context
        context.enable(moderngl.BLEND)
        context.depth_func = "1"
        for plate in self.plates:
            self._plate["u_plate"] = plate
            self._paper.render(vertices=4)
        if self._count:
            self._lines.render(vertices=4, instances=self._count)
        context.depth_func = "<"
        context.disable(moderngl.BLEND)
