"""How many sprites cover each pixel, counted by drawing them all and shown as a heat map."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.gpu import Gpu
from viewer.engine.state import whole


class Overdraw:
    """Counts what is drawn within ``counting``, then ``show`` draws the map over the picture."""

    def __init__(self, gpu: Gpu) -> None:
        self.gpu = gpu
        self._made: list[Any] = []
        self._counts: moderngl.Texture | None = None
        self._program = gpu.program("studio/screen.vert", "particles/overdraw.frag")
        self._program["u_counts"] = 0
        self._map = gpu.vertex_array(self._program)

    @contextmanager
    def counting(self, size: tuple[int, int]) -> Iterator[None]:
        """Each pixel that is drawn within adds the shader's number to the count there."""
        context = self.gpu.context
        before = context.fbo
        target = self._target(size)
        whole(target)
        target.clear()
        context.enable_only(moderngl.BLEND)
        context.blend_func = moderngl.ONE, moderngl.ONE
        try:
            yield
        finally:
            before.use()

    def show(self) -> None:
        """Draw the map."""
        assert self._counts
        self.gpu.context.enable_only(moderngl.BLEND)
        self._counts.use(0)
        self._map.render(vertices=3)

    def counts(self) -> NDArray[np.int64]:
        """The number on each pixel of the last picture, (height, width), lowest row first."""
        assert self._counts
        width, height = self._counts.size
        return np.frombuffer(self._counts.read(), np.float32).reshape(height, width).astype(np.int64)

    def _target(self, size: tuple[int, int]) -> moderngl.Framebuffer:
        if self._counts is None or self._counts.size != size:
            before = self.gpu.context.fbo
            if self._made:
                self.gpu.discard(*self._made)
                before.use()
            self._counts = self.gpu.texture(size, 1, dtype="f4", label="sprites on a pixel")
            self._made = [self.gpu.framebuffer([self._counts], label="overdraw"), self._counts]
        target: moderngl.Framebuffer = self._made[0]
        return target
