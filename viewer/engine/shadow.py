"""The key light's shadow: a depth map of the scene seen from the light, blurred into two maps of moments."""

from __future__ import annotations

from collections.abc import Callable

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.frame import SHADOW_NEAR_UNIT, SHADOW_WIDE_UNIT
from viewer.engine.gpu import Gpu
from viewer.engine.matrices import Matrix
from viewer.engine.state import plain_state, whole

DEPTH_SIZE = 512
NEAR_SIZE = 256
WIDE_SIZE = 128


class ShadowMap:
    """Filled by ``cast``, read by shaders through ``lib/shadow.glsl``.

    Blurring depths and squared depths instead of comparing them at each pixel gives soft edges for
    one look-up (Donnelly and Lauritzen, "Variance shadow maps", 2006).
    """

    def __init__(self, gpu: Gpu, world_to_shadow: Matrix, ground: float | None) -> None:
        self.gpu = gpu
        self._depth = gpu.depth_texture((DEPTH_SIZE, DEPTH_SIZE), "light's depth")
        self._depth.compare_func = ""
        self._depth.repeat_x = self._depth.repeat_y = False
        self._casting = gpu.framebuffer((), self._depth, "light's depth")
        self._passes = [self._target(size) for size in (NEAR_SIZE, NEAR_SIZE, WIDE_SIZE, WIDE_SIZE)]
        self._moments = gpu.program("studio/screen.vert", "studio/moments.frag")
        self._moments["u_depth"] = 0
        self._moments["u_floor"] = floor_depth(world_to_shadow, ground)
        self._blur = gpu.program("studio/screen.vert", "studio/blur.frag")
        self._blur["u_moments"] = 0
        self._draw_moments = gpu.vertex_array(self._moments)
        self._draw_blur = gpu.vertex_array(self._blur)

    def cast(self, draw: Callable[[], None]) -> None:
        """Fill the maps with what ``draw`` draws from the light's place."""
        whole(self._casting)
        self._casting.clear(depth=1.0)
        plain_state(self.gpu.context)
        # What stands before the light's near plane casts its shadow all the same.
        self.gpu.context.depth_clamp_range = (0.0, 1.0)
        try:
            draw()
        finally:
            self.gpu.context.depth_clamp_range = None
            plain_state(self.gpu.context)
        self._blur_all()

    def bind(self) -> None:
        """Let shaders read the maps."""
        self._passes[1][1].use(SHADOW_NEAR_UNIT)
        self._passes[3][1].use(SHADOW_WIDE_UNIT)

    def _blur_all(self) -> None:
        """Depth to moments across, then down; and both again, more widely, at half the size."""
        self.gpu.context.enable_only(moderngl.NOTHING)
        self._passes[0][0].use()
        self._depth.use(0)
        self._draw_moments.render(vertices=3)
        strides = [(0.0, 1.0 / NEAR_SIZE), (2.5 / WIDE_SIZE, 0.0), (0.0, 2.5 / WIDE_SIZE)]
        for step, stride in enumerate(strides, 1):
            target = self._passes[step][0]
            target.use()
            self._passes[step - 1][1].use(0)
            self._blur["u_stride"] = stride
            self._blur["u_size"] = (float(target.width), float(target.height))
            self._draw_blur.render(vertices=3)

    def _target(self, size: int) -> tuple[moderngl.Framebuffer, moderngl.Texture]:
        texture = self.gpu.texture((size, size), 2, dtype="f4", label="shadow moments")
        texture.repeat_x = texture.repeat_y = False
        return self.gpu.framebuffer([texture], label="shadow moments"), texture


def floor_depth(world_to_shadow: Matrix, ground: float | None) -> tuple[float, float, float]:
    """Coefficients (a, b, c) such that the floor's depth in the shadow map is a u + b v + c."""
    if ground is None:
        return 0.0, 0.0, 1.0
    corners = np.array([[0.0, ground, 0.0, 1.0], [1.0, ground, 0.0, 1.0], [0.0, ground, 1.0, 1.0]])
    seen: NDArray[np.float64] = corners @ world_to_shadow
    a, b, c = np.linalg.solve(np.column_stack([seen[:, :2], np.ones(3)]), seen[:, 2])
    return float(a), float(b), float(c)
