"""The picture a stage draws: linear half floats, many samples; then one, tone-mapped, in sRGB."""

from __future__ import annotations

from operator import index
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.gpu import Gpu, GpuError
from viewer.engine.program import VertexArray
from viewer.engine.state import whole

MOST_SAMPLES = 16
MOST_BYTES = 4 * 2**30


def most_samples(context: moderngl.Context) -> int:
    """How many samples a pixel can have in a texture that is drawn into together with a depth buffer."""
    return min(context.max_samples, int(context.info.get("GL_MAX_COLOR_TEXTURE_SAMPLES", context.max_samples)))


def checked_size(size: Any) -> tuple[int, int]:
    """``size`` as two whole numbers; raises GpuError."""
    try:
        width, height = (index(extent) for extent in size)
    except (TypeError, ValueError):
        raise GpuError(f"size = {size} is not a width and a height in pixels such as (640, 360)") from None
    return width, height


class Picture:
    """Render targets of one size. ``texture`` is the finished picture, 8-bit sRGB, bottom row first."""

    def __init__(self, gpu: Gpu, size: tuple[int, int], samples: int) -> None:
        gpu.check_size(size, "a picture")
        if not isinstance(samples, (int, np.integer)) or not 0 <= samples <= MOST_SAMPLES:
            raise GpuError(f"samples = {samples} is outside 0 to {MOST_SAMPLES}")
        needed = size[0] * size[1] * (12 * max(1, samples) + 4)
        if needed > MOST_BYTES:
            raise GpuError(f"a picture of {size[0]}x{size[1]} with {samples} samples needs {needed / 2**30:.1f} GiB; "
                           f"at most {MOST_BYTES / 2**30:.0f} GiB is allowed")
        self.size = size
        self.gpu = gpu
        self.samples = min(samples, most_samples(gpu.context)) if samples > 1 else 0
        self._linear = self._target()
        self.texture = gpu.texture(size, 4, label="finished picture")
        self._finished = gpu.framebuffer([self.texture], label="finished")
        finish = "studio/finish_samples.frag" if self.samples else "studio/finish.frag"
        program = gpu.program("studio/screen.vert", finish)
        program["u_linear"] = 0
        if self.samples:
            program["u_samples"] = self.samples
        self._finish: VertexArray = gpu.vertex_array(program)

    def _target(self) -> moderngl.Texture:
        """The linear target, without samples where the driver refuses them, as some virtual machines do."""
        try:
            linear = self.gpu.texture(self.size, 4, samples=self.samples, dtype="f2", label="linear picture")
            depth = self.gpu.depth_renderbuffer(self.size, samples=self.samples, label="depth")
            self._drawn = self.gpu.framebuffer([linear], depth, "linear picture")
            return linear
        except moderngl.Error:
            if not self.samples:
                raise
            self.samples = 0
            return self._target()

    def begin(self) -> None:
        """Make the linear target the one that is drawn into, and clear it."""
        self.go_on()
        self._drawn.clear(0.0, 0.0, 0.0, 1.0, depth=1.0)

    def go_on(self) -> None:
        """Make the whole linear target the one that is drawn into, whatever a scene bound or cut out meanwhile."""
        whole(self._drawn)

    def finish(self) -> None:
        """Map the tones of each sample, average the samples and encode to sRGB, once."""
        self._finished.use()
        self.gpu.context.enable_only(moderngl.NOTHING)
        self._linear.use(0)
        self._finish.render(vertices=3)

    def use(self) -> None:
        """Bind the finished picture, so that panels can be drawn over it."""
        self._finished.use()

    def pixels(self) -> NDArray[np.uint8]:
        """The finished picture, (height, width, 4), top row first."""
        width, height = self.size
        rows = np.frombuffer(self._finished.read(components=4), np.uint8).reshape(height, width, 4)
        return rows[::-1].copy()
