"""Ribbons that face the camera, along paths: a pass finds where their edges are seen, then they are drawn."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import moderngl
import numpy as np

from viewer.engine.gpu import Gpu
from viewer.engine.particles.paths import Blocks, drawing_at
from viewer.engine.particles.pool import Pool
from viewer.engine.program import Program

MOST_POINTS = 2**19         # that are made and drawn at a time: what bounds the memory they take
SEEN = ("middle", "side", "light")


class Ribbons:
    """A ribbon through ``points`` points for each slot of ``pool``.

    ``making`` is a fragment shader that finds one point of one ribbon, which includes ``particles/ribbon.glsl``;
    ``shading`` the one that it is drawn with. So the vertex shader, which software GL runs on a single core, has
    nothing to do but to fetch.
    """

    def __init__(self, gpu: Gpu, pool: Pool, points: int, making: str, shading: str,
                 generated: Mapping[str, Callable[[], str]]) -> None:
        self.gpu, self.pool, self.points = gpu, pool, points
        self.band_rows: int = max(1, min(pool.height, MOST_POINTS // (points * pool.width)))
        self.blocks = Blocks(gpu, (pool.width, self.band_rows), points)
        self._seen = {name: gpu.texture(self.blocks.whole, 4, dtype="f2" if name == "light" else "f4",
                                        label=f"ribbons' {name}") for name in SEEN}
        self._making = gpu.framebuffer(list(self._seen.values()), label="ribbons")
        self._making.clear()
        constants = {"generated/ribbon.glsl": lambda: self.blocks.constants("RIBBON")}
        self._make = gpu.program("studio/screen.vert", making, generated={**generated, **constants})
        self._made = gpu.vertex_array(self._make)
        self._draw = gpu.program("particles/ribbon.vert", shading, generated={**generated, **constants})
        slots = self.band_rows * pool.width
        self._drawn = gpu.vertex_array(self._draw, index=gpu.buffer(quads(slots, points), label="ribbons' quads"))

    def draw(self, bind: Callable[[Program], None], flags: int = moderngl.DEPTH_TEST) -> None:
        """Draw all ribbons; ``bind`` gives the making program what it reads, ``flags`` is the state to draw in."""
        for first in range(0, self.pool.rows, self.band_rows):
            rows = min(self.band_rows, self.pool.rows - first)
            bind(self._make)
            self._make["u_first_row"] = first
            for line in range(self.blocks.rows):
                with drawing_at(self.gpu, self._making, (0, line * self.band_rows), (self.blocks.whole[0], rows)):
                    self._made.render(vertices=3)
            self.gpu.context.enable_only(flags)
            for unit, (name, texture) in enumerate(self._seen.items()):
                texture.use(unit)
                self._draw[f"u_{name}"] = unit
            slots = min(self.pool.used - first * self.pool.width, rows * self.pool.width)
            self._drawn.render(vertices=6 * (self.points - 1) * slots)


def quads(slots: int, points: int) -> np.ndarray[tuple[int], np.dtype[np.uint32]]:
    """The corners of all quads, two triangles each: vertex 2 p and 2 p + 1 of a slot are the sides of its point p."""
    corners = np.array([0, 1, 2, 2, 1, 3], np.uint32)
    ribbon = (2 * np.arange(points - 1, dtype=np.uint32)[:, None] + corners).ravel()
    return np.asarray((2 * points * np.arange(slots, dtype=np.uint32)[:, None] + ribbon).ravel())
