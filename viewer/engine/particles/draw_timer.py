"""How long it takes to draw particles, measured apart from the picture, which may not depend on it."""

from __future__ import annotations

import time
from collections.abc import Callable, Hashable

import moderngl
import numpy as np

from viewer.engine.field_samples import drawing_into
from viewer.engine.gpu import Gpu


class DrawTimer:
    """Draws into a layer of its own, as large as the picture, and waits until that is done."""

    def __init__(self, gpu: Gpu) -> None:
        self.gpu = gpu
        self._layer: moderngl.Framebuffer | None = None
        self._warm: Hashable = None
        self._made: list[moderngl.Texture | moderngl.Framebuffer] = []

    def milliseconds(self, size: tuple[int, int], draw: Callable[[moderngl.Texture], None], key: Hashable) -> float:
        """The time that ``draw`` takes in a picture of ``size`` pixels in which nothing solid is in the way.

        With another ``key`` it is drawn once before, so that no shader is compiled while the clock runs.
        """
        layer, context = self._layer_of(size), self.gpu.context
        with drawing_into(self.gpu, layer, size):
            layer.clear()
            try:
                if key != self._warm:
                    self._seconds(draw)
                    self._warm = key
                return 1e3 * self._seconds(draw)
            finally:
                context.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
                context.enable_only(moderngl.NOTHING)

    def _seconds(self, draw: Callable[[moderngl.Texture], None]) -> float:
        context = self.gpu.context
        context.enable(moderngl.BLEND)
        context.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
        context.finish()
        started = time.perf_counter()
        draw(self._depth)
        context.finish()
        return time.perf_counter() - started

    def _layer_of(self, size: tuple[int, int]) -> moderngl.Framebuffer:
        if self._layer is None or self._layer.size != size:
            self.gpu.discard(*self._made)
            color = self.gpu.texture(size, 4, dtype="f2", label="timed sprites")
            far = np.ones(size[::-1], np.float32)
            self._depth = self.gpu.texture(size, 1, far, dtype="f4", label="timed sprites' depth")
            self._layer = self.gpu.framebuffer([color], label="timed sprites")
            self._made = [self._layer, color, self._depth]
        return self._layer
