"""The set: backdrop, floor, and the key light with its shadow map."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import ArrayLike

from viewer.engine.color_field import Color, linear_light
from viewer.engine.gpu import Gpu
from viewer.engine.matrices import Matrix, look_at, orthographic
from viewer.engine.scene import Studio
from viewer.engine.shadow import ShadowMap

KEY_DIRECTION = np.array([-0.45, 0.80, 0.40]) / np.linalg.norm([-0.45, 0.80, 0.40])
CLIP_TO_TEXTURE = np.array([[0.5, 0, 0, 0], [0, 0.5, 0, 0], [0, 0, 0.5, 0], [0.5, 0.5, 0.5, 1]])


class StudioSet:
    """Draws what stands around a scene, and the scene's shadow."""

    def __init__(self, gpu: Gpu, plan: Studio) -> None:
        self.gpu = gpu
        self.plan = plan
        self.shadow = ShadowMap(gpu, self._world_to_shadow(), plan.ground)
        backdrop = gpu.program("studio/screen.vert", "studio/backdrop.frag")
        ground = gpu.program("studio/ground.vert", "studio/ground.frag")
        self._backdrop = gpu.vertex_array(backdrop)
        self._ground = gpu.vertex_array(ground, mode=moderngl.TRIANGLE_FAN, closed=True)
        self.frame_values = self._frame_values()
        self.light_values = self._light_values()

    def draw(self) -> None:
        """Fill what the scene left empty: the floor, then the backdrop behind everything; or leave it to the scene."""
        if not self.plan.furnished:
            return
        context = self.gpu.context
        context.depth_func = "<="
        if self.plan.ground is not None:
            self._ground.render(vertices=4)
        self._backdrop.render(vertices=3)
        context.depth_func = "<"

    def _frame_values(self) -> dict[str, ArrayLike]:
        """The studio's part of the frame block."""
        low, high = ((*map(linear_light, Color(name, "").default), 1.0) for name in self.plan.backdrop)
        height = self.plan.ground
        return {
            "world_to_shadow": self._world_to_shadow(),
            "key_direction": KEY_DIRECTION, "center": self.plan.center, "radius": self.plan.radius,
            "ground_height": height or 0.0, "has_ground": float(height is not None),
            "backdrop_low": low, "backdrop_high": high,
        }

    def _light_values(self) -> dict[str, ArrayLike]:
        """The frame block's camera, put where the key light is, for drawing the shadow map."""
        view, projection = self._light_view(), self._light_projection()
        both = view @ projection
        eye = np.asarray(self.plan.center) + 2.0 * self.plan.radius * KEY_DIRECTION
        return {"view": view, "projection": projection, "view_projection": both,
                "clip_to_world": np.linalg.inv(both), "eye": eye}

    def _light_view(self) -> Matrix:
        center = np.asarray(self.plan.center, float)
        return look_at(center + 2.0 * self.plan.radius * KEY_DIRECTION, center)

    def _light_projection(self) -> Matrix:
        return orthographic(self.plan.radius, self.plan.radius, 3.0 * self.plan.radius)

    def _world_to_shadow(self) -> Matrix:
        return np.asarray(self._light_view() @ self._light_projection() @ CLIP_TO_TEXTURE)
