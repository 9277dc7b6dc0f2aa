"""The picture a stage draws: linear half floats, many samples; then one, tone-mapped, in sRGB."""

from __future__ import annotations

from operator import index
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.gpu import Gpu, GpuError
from viewer.engine.program import Program, VertexArray
from viewer.engine.sprite_layer import SpriteLayer
from viewer.engine.state import whole

MOST_SAMPLES = 16
MOST_BYTES = 4 * 2**30


def most_samples(context: moderngl.Context, *, sprites: bool = False) -> int:
    """How many samples a pixel can have in a texture drawn into with a depth buffer, or for sprites a depth texture."""
    limits = ["GL_MAX_COLOR_TEXTURE_SAMPLES", *(["GL_MAX_DEPTH_TEXTURE_SAMPLES"] if sprites else [])]
    return min(context.max_samples, *(int(context.info.get(limit, context.max_samples)) for limit in limits))


def checked_size(size: Any) -> tuple[int, int]:
    """``size`` as two whole numbers; raises GpuError."""
    try:
        width, height = (index(extent) for extent in size)
    except (TypeError, ValueError):
        raise GpuError(f"size = {size} is not a width and a height in pixels such as (640, 360)") from None
    return width, height


def _check_memory(size: tuple[int, int], samples: int, sprites: bool) -> None:
    needed = size[0] * size[1] * (12 * max(1, samples) + 4 + (SpriteLayer.BYTES if sprites else 0))
    if needed > MOST_BYTES:
        raise GpuError(f"a picture of {size[0]}x{size[1]} with {samples} samples needs {needed / 2**30:.1f} GiB; "
                       f"at most {MOST_BYTES / 2**30:.0f} GiB is allowed")


class Picture:
    """Render targets of one size. ``texture`` is the finished picture, 8-bit sRGB, bottom row first.

    ``sprites`` is the layer for what is translucent and many, None where nobody asked for one.
    """

    def __init__(self, gpu: Gpu, size: tuple[int, int], samples: int, *, sprites: bool = False) -> None:
        gpu.check_size(size, "a picture")
        if not isinstance(samples, (int, np.integer)) or not 0 <= samples <= MOST_SAMPLES:
            raise GpuError(f"samples = {samples} is outside 0 to {MOST_SAMPLES}")
        _check_memory(size, samples, sprites)
        self.size = size
        self.gpu = gpu
        self.samples = min(samples, most_samples(gpu.context, sprites=sprites)) if samples > 1 else 0
        self.sprites: SpriteLayer | None = None
        self._linear = self._target(sprites)
        self.texture = gpu.texture(size, 4, label="finished picture")
        self._finished = gpu.framebuffer([self.texture], label="finished")
        self._finish: VertexArray = gpu.vertex_array(self._finishing())

    def _target(self, sprites: bool) -> moderngl.Texture:
        """The linear target, without samples where the driver refuses them, as some virtual machines do."""
        try:
            linear = self.gpu.texture(self.size, 4, samples=self.samples, dtype="f2", label="linear picture")
            if sprites:     # their shaders read the depth
                depth = self.gpu.depth_texture(self.size, "depth", samples=self.samples)
                self._drawn = self.gpu.framebuffer([linear], depth, "linear picture")
                self.sprites = SpriteLayer(self.gpu, self.size, depth)
            else:
                buffer = self.gpu.depth_renderbuffer(self.size, samples=self.samples, label="depth")
                self._drawn = self.gpu.framebuffer([linear], buffer, "linear picture")
            return linear
        except moderngl.Error:
            if not self.samples:
                raise
            self.samples = 0
            return self._target(sprites)

    def _finishing(self) -> Program:
        """The program that maps tones, over the sprites if there is a layer of them."""
        kind = ("_sprites" if self.sprites else "") + ("_samples" if self.samples else "")
        program = self.gpu.program("studio/screen.vert", f"studio/finish{kind}.frag")
        program["u_linear"] = 0
        if self.sprites:
            program["u_sprites"] = 1
        if self.samples:
            program["u_samples"] = self.samples
        return program

    def begin(self) -> None:
        """Make the linear target the one that is drawn into, and clear it."""
        self.go_on()
        self._drawn.clear(0.0, 0.0, 0.0, 1.0, depth=1.0)

    def go_on(self) -> None:
        """Make the whole linear target the one that is drawn into, whatever a scene bound or cut out meanwhile."""
        whole(self._drawn)

    def finish(self) -> None:
        """Map the tones of each sample, sprites before it, average the samples and encode to sRGB, once."""
        self._finished.use()
        self.gpu.context.enable_only(moderngl.NOTHING)
        self._linear.use(0)
        if self.sprites:
            self.sprites.texture.use(1)
        self._finish.render(vertices=3)

    def use(self) -> None:
        """Bind the finished picture, so that panels can be drawn over it."""
        self._finished.use()

    def pixels(self) -> NDArray[np.uint8]:
        """The finished picture, (height, width, 4), top row first."""
        width, height = self.size
        rows = np.frombuffer(self._finished.read(components=4), np.uint8).reshape(height, width, 4)
        return rows[::-1].copy()
