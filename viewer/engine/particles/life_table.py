"""What changes over a life, as a small texture: size and opacity, and the colours of each generation."""

from __future__ import annotations

from typing import Any

import numpy as np

from viewer.engine.gpu import Gpu
from viewer.engine.particles.look import GRADIENTS

STEPS = 256


class LifeTable:
    """``texture`` holds, from birth at its left to death at its right, a row of (size factor, opacity, 0, 0) and
    one of linear colours for each generation, the first being the emitter's."""

    def __init__(self, gpu: Gpu, params: Any) -> None:
        self.params = params
        self.texture = gpu.texture((STEPS, 1 + len(GRADIENTS)), 4, dtype="f4", label="over a life")
        self._revision = -1
        self._shows: tuple[object, ...] = ()

    def prepare(self) -> None:
        """Follow the parameters."""
        params = self.params
        if params.revision == self._revision:
            return
        self._revision = params.revision
        curves = params.size_over_life, params.opacity_over_life
        gradients = [params.get(name) for name in GRADIENTS]
        shows = (*curves, *gradients)
        if shows == self._shows:
            return
        rows = np.zeros((1 + len(gradients), STEPS, 4), np.float32)
        for column, curve in enumerate(curves):
            rows[0, :, column] = curve.table(STEPS)
        for row, colors in zip(rows[1:], gradients, strict=True):
            row[:, :3] = colors.table(STEPS)
        self.texture.write(rows)
        self._shows = shows
