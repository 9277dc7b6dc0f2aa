"""Draws ball-and-rod models, in the world or on cards in the picture that turn with the camera."""

from __future__ import annotations

import math
from itertools import pairwise

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.gpu import Gpu
from viewer.kit.models import Model

SIDES = 6
Card = tuple[float, float, float, float]


class Insets:
    """Shows one model at a time; ``card`` (left, bottom, right, top, each -1 to 1) lays a card behind it."""

    def __init__(self, gpu: Gpu) -> None:
        self.gpu = gpu
        self.card: Card | None = None
        self._counts = [0, 0, 0]
        self._buffers = [gpu.buffer(reserve=4096, label=name) for name in ("rods", "balls", "faces")]
        rods, balls, faces = self._buffers
        rod = gpu.program("insets/rod.vert", "insets/solid.frag")
        ball = gpu.program("insets/ball.vert", "insets/ball.frag")
        face = gpu.program("insets/face.vert", "insets/solid.frag")
        self._plate = gpu.program("insets/plate.vert", "insets/plate.frag")
        frame = ("in_frame", "in_color")
        self._rods = gpu.vertex_array(rod, [
            (gpu.buffer(rod_sides()), "3f", "in_side"),
            (rods, "3f 3f 1f 3f 3f/i", "in_start", "in_end", "in_radius", *frame)])
        corners = np.array([[-1, -1], [1, -1], [-1, 1], [1, 1]], "f4")
        self._balls = gpu.vertex_array(ball, [
            (gpu.buffer(corners), "2f", "in_corner"),
            (balls, "3f 1f 3f 3f/i", "in_center", "in_radius", *frame)], mode=moderngl.TRIANGLE_STRIP)
        self._faces = gpu.vertex_array(face, [(faces, "3f 3f 3f 3f", "in_place", "in_normal", *frame)])
        self._plates = gpu.vertex_array(self._plate, mode=moderngl.TRIANGLE_STRIP)

    def show(self, model: Model) -> None:
        """Draw ``model`` from now on."""
        for index, (buffer, rows) in enumerate(zip(self._buffers, model.arrays(), strict=True)):
            self._counts[index] = len(rows)
            if rows.nbytes > buffer.size:
                buffer.orphan(2 * rows.nbytes)
            if rows.nbytes:
                buffer.write(np.ascontiguousarray(rows))

    def draw(self, *, through: bool = False) -> None:
        """Draw the card and the model: in ``Scene.draw_over``, where nothing comes to lie over them.

        With ``through`` the model shows through what stands before it; its rods lie under its balls.
        """
        if self.card:
            self._draw_card(self.card)
        rods, balls, faces = self._counts
        if through:
            self.gpu.context.depth_func = "1"
        if faces:
            self._faces.render(vertices=faces)
        if rods:
            self._rods.render(instances=rods)
        if balls:
            self._balls.render(instances=balls)
        if through:
            self.gpu.context.depth_func = "<"

    def _draw_card(self, card: Card) -> None:
        context = self.gpu.context
        self._plate["u_plate"] = card
        context.enable(moderngl.BLEND)
        context.depth_func = "1"
        self._plates.render(vertices=4)
        context.depth_func = "<"
        context.disable(moderngl.BLEND)


def rod_sides() -> NDArray[np.float32]:
    """A rod of length one without ends, as triangles: (n, 3), the last number being along it."""
    around = [(math.cos(2 * math.pi * i / SIDES), math.sin(2 * math.pi * i / SIDES)) for i in range(SIDES + 1)]
    rows = []
    for (ax, ay), (bx, by) in pairwise(around):
        rows += [(ax, ay, 0), (bx, by, 0), (bx, by, 1), (ax, ay, 0), (bx, by, 1), (ax, ay, 1)]
    return np.array(rows, "f4")
