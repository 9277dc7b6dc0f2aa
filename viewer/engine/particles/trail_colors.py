"""Colour, opacity and size over a life, in a small texture for shaders."""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np

from viewer.engine.gpu import Gpu
from viewer.engine.particles.cascade import FAMILIES
from viewer.engine.program import Program

SAMPLES = 64
GRADIENTS = ("color", *(f"{family}_color" for family in FAMILIES))


class TrailColors:
    """Follows the gradients and curves among ``params``; read through ``particles/trail_colors.glsl``."""

    def __init__(self, gpu: Gpu, params: Any) -> None:
        self.params = params
        self.texture = gpu.texture((SAMPLES, len(GRADIENTS) + 1), 4, dtype="f4", label="colours over life")
        self.texture.filter = moderngl.LINEAR, moderngl.LINEAR
        self.texture.repeat_x = self.texture.repeat_y = False
        self._shows: tuple[object, ...] = ()

    def bind(self, program: Program, unit: int) -> None:
        """Let ``program`` read the table as it now is."""
        names = (*GRADIENTS, "opacity_over_life", "size_over_life")
        values = tuple(self.params.get(name) for name in names)
        if values != self._shows:
            rows = np.ones((len(GRADIENTS) + 1, SAMPLES, 4), np.float32)
            for row, gradient in enumerate(values[:len(GRADIENTS)]):
                rows[row, :, :3] = gradient.table(SAMPLES)
            rows[:-1, :, 3] = values[-2].table(SAMPLES)
            rows[-1] = values[-1].table(SAMPLES)[:, None]
            self.texture.write(rows)
            self._shows = values
        self.texture.use(unit)
        program["u_life"] = unit
