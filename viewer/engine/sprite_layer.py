"""The layer for what is translucent and many: one sample a pixel, blended in linear light over the picture.

A hundred thousand particles cost twice as much with four samples a pixel, and have no edges that would show it.
"""

from __future__ import annotations

import moderngl

from viewer.engine.gpu import Gpu
from viewer.engine.state import whole

OVER = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA, moderngl.ZERO, moderngl.ONE_MINUS_SRC_ALPHA


class SpriteLayer:
    """Light that sprites add, and how much of the picture behind them shows through.

    ``texture`` holds that, as rgb and a, in half floats. ``scene_depth``, one float, is the depth of the picture's
    first samples, 0 to 1, for shaders to read; the layer's own depth buffer holds the same.
    """

    BYTES = 16      # a pixel: light, scene_depth and the depth buffer

    def __init__(self, gpu: Gpu, size: tuple[int, int], depth: moderngl.Texture) -> None:
        """A layer over a picture of ``size`` whose depth texture, of one or more samples, is ``depth``."""
        self.gpu = gpu
        self._depth = depth
        self.texture = gpu.texture(size, 4, dtype="f2", label="sprites")
        self.scene_depth = gpu.texture(size, 1, dtype="f4", label="scene depth")
        self.scene_depth.filter = moderngl.NEAREST, moderngl.NEAREST
        self.scene_depth.repeat_x = self.scene_depth.repeat_y = False
        if not depth.samples:
            depth.compare_func = ""     # to be read as a number
            depth.filter = moderngl.NEAREST, moderngl.NEAREST
        buffer = gpu.depth_renderbuffer(size, label="depth behind sprites")
        self._resolved = gpu.framebuffer([self.scene_depth], buffer, "depth behind sprites")
        self._drawn = gpu.framebuffer([self.texture], buffer, "sprites")
        program = gpu.program("studio/screen.vert", f"studio/scene_depth{'_samples' if depth.samples else ''}.frag")
        program["u_depth"] = 0
        self._resolve = gpu.vertex_array(program)

    def begin(self) -> None:
        """Take over the picture's depth, clear the layer and make it the target that is drawn into."""
        context = self.gpu.context
        whole(self._resolved)
        context.enable_only(moderngl.DEPTH_TEST)    # no depth is written without it
        context.depth_func = "1"
        self._depth.use(0)
        self._resolve.render(vertices=3)
        whole(self._drawn)
        self._drawn.depth_mask = False
        self._drawn.clear(0.0, 0.0, 0.0, 1.0)

    def blend(self) -> None:
        """From now on what is drawn adds its rgb, and hides as much of what lies behind it as its alpha says."""
        context = self.gpu.context
        context.enable(moderngl.BLEND)
        context.blend_func = OVER  # type: ignore[assignment]
        context.depth_func = "<="
