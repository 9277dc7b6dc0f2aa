"""Draws a mesh that may change: obstacles and emitters, opaque or as glass."""

from __future__ import annotations

from typing import Any, TypeAlias

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.color_field import linear_light
from viewer.engine.gpu import Gpu
from viewer.engine.program import VertexArray

ShadedMesh: TypeAlias = tuple[NDArray[np.floating[Any]], NDArray[np.floating[Any]], NDArray[np.integer[Any]]]
SMALLEST = 4096     # bytes


class Solid:
    """Shows one mesh at a time: ``show`` it, then ``draw`` it, or ``draw_glass`` to see what is inside.

    ``roughness`` tells how matt it is.
    """

    def __init__(self, gpu: Gpu, roughness: float = 0.45) -> None:
        self.gpu, self.roughness = gpu, roughness
        self._program = gpu.program("particles/solid.vert", "particles/solid.frag")
        self._glass = gpu.program("particles/solid.vert", "particles/glass.frag")
        self._count = 0
        self._buffers: list[moderngl.Buffer] = []
        self._arrays: list[VertexArray] = []
        self._sizes = [0, 0, 0]

    def show(self, mesh: ShadedMesh | None) -> None:
        """Draw vertices (n, 3), normals (n, 3) and triangles (m, 3) from now on, or with None nothing."""
        self._count = 0
        if mesh is None or not mesh[2].size:
            return
        rows = [np.ascontiguousarray(part, kind) for part, kind in zip(mesh, ("f4", "f4", "i4"), strict=True)]
        if any(part.nbytes > size for part, size in zip(rows, self._sizes, strict=True)):
            self._make_room([part.nbytes for part in rows])
        for buffer, part in zip(self._buffers, rows, strict=True):
            buffer.write(part)
        self._count = rows[2].size

    def draw(self, color: tuple[float, float, float]) -> None:
        """Draw it lit, in an sRGB colour; for the shadow map too."""
        if self._count:
            self._program["u_color"] = tuple(map(linear_light, color))
            self._program["u_roughness"] = self.roughness
            self._arrays[0].render(vertices=self._count)

    def draw_glass(self, color: tuple[float, float, float]) -> None:
        """Draw it as thin glass, in ``Scene.draw_over``, where nothing translucent is inside it."""
        self.draw_far_glass(color)
        self._blended(color, "back")

    def draw_far_glass(self, color: tuple[float, float, float]) -> None:
        """Draw the glass behind what is inside, in ``Scene.draw_over``."""
        self._blended(color, "front")

    def draw_near_glass(self, color: tuple[float, float, float]) -> None:
        """Draw the glass before what is inside, in ``Scene.draw_sprites`` after that, blended as is set up there."""
        self._draw_glass(color, "back")

    def _blended(self, color: tuple[float, float, float], culled: str) -> None:
        context = self.gpu.context
        drawn_into = context.fbo
        context.enable(moderngl.BLEND)
        context.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
        drawn_into.depth_mask = False
        self._draw_glass(color, culled)
        drawn_into.depth_mask = True
        context.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
        context.disable(moderngl.BLEND)

    def _draw_glass(self, color: tuple[float, float, float], culled: str) -> None:
        if not self._count:
            return
        context = self.gpu.context
        self._glass["u_color"] = tuple(map(linear_light, color))
        context.enable(moderngl.CULL_FACE)
        context.cull_face = culled
        self._arrays[1].render(vertices=self._count)
        context.cull_face = "back"
        context.disable(moderngl.CULL_FACE)

    def _make_room(self, needed: list[int]) -> None:
        """Larger buffers, a quarter more than needed, and vertex arrays with them."""
        self._sizes = [max(SMALLEST, 5 * size // 4 // 4 * 4) for size in needed]
        names = ("solid's vertices", "solid's normals", "solid's triangles")
        buffers = [self.gpu.buffer(reserve=size, label=name) for size, name in zip(self._sizes, names, strict=True)]
        content = [(buffers[0], "3f", "in_position"), (buffers[1], "3f", "in_normal")]
        arrays = [self.gpu.vertex_array(program, content, buffers[2]) for program in (self._program, self._glass)]
        drawn_into = self.gpu.context.fbo
        self.gpu.discard(*self._arrays, *self._buffers)
        drawn_into.use()
        self._buffers, self._arrays = buffers, arrays
