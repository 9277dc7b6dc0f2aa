"""The picture a stage draws: linear half floats, many samples; then one, tone-mapped, in sRGB."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.gpu import Gpu, GpuError
from viewer.engine.program import VertexArray

MOST_SAMPLES = 16


class Picture:
    """Render targets of one size. ``texture`` is the finished picture, 8-bit sRGB, bottom row first."""

    def __init__(self, gpu: Gpu, size: tuple[int, int], samples: int) -> None:
        gpu.check_size(size, "a picture")
        if not 0 <= samples <= MOST_SAMPLES:
            raise GpuError(f"samples = {samples} is outside 0 to {MOST_SAMPLES}")
        self.size = size
        self.gpu = gpu
        self.samples = min(samples, gpu.context.max_samples) if samples > 1 else 0
        self._linear = gpu.texture(size, 4, dtype="f2", label="linear picture")
        self._resolved = gpu.framebuffer([self._linear], gpu.depth_renderbuffer(size, label="depth"), "resolved")
        self._sampled = self._multisampled() if self.samples else self._resolved
        self.texture = gpu.texture(size, 4, label="finished picture")
        self._finished = gpu.framebuffer([self.texture], label="finished")
        program = gpu.program("studio/screen.vert", "studio/finish.frag")
        program["u_linear"] = 0
        self._finish: VertexArray = gpu.vertex_array(program)

    def _multisampled(self) -> moderngl.Framebuffer:
        """The multisampled target, or the plain one where the driver refuses, as some virtual machines do."""
        try:
            color = self.gpu.renderbuffer(self.size, 4, samples=self.samples, dtype="f2", label="samples")
            depth = self.gpu.depth_renderbuffer(self.size, samples=self.samples, label="depth samples")
            return self.gpu.framebuffer([color], depth, "multisampled")
        except moderngl.Error:
            self.samples = 0
            return self._resolved

    def begin(self) -> None:
        """Make the linear target the one that is drawn into, and clear it."""
        self._sampled.use()
        self._sampled.clear(0.0, 0.0, 0.0, 1.0, depth=1.0)

    def finish(self) -> None:
        """Resolve the samples, map the tones and encode to sRGB, once."""
        context = self.gpu.context
        if self._sampled is not self._resolved:
            context.copy_framebuffer(self._resolved, self._sampled)
        self._finished.use()
        context.disable(moderngl.DEPTH_TEST | moderngl.BLEND | moderngl.CULL_FACE)
        self._linear.use(0)
        self._finish.render(vertices=3)

    def use(self) -> None:
        """Bind the finished picture, so that panels can be drawn over it."""
        self._finished.use()

    def pixels(self) -> NDArray[np.uint8]:
        """The finished picture, (height, width, 4), top row first."""
        width, height = self.size
        rows = np.frombuffer(self._finished.read(components=4), np.uint8).reshape(height, width, 4)
        return np.ascontiguousarray(rows[::-1])
