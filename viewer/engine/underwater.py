"""The set under water: a bed of sand, the water behind all, and light that waves gather and motes scatter."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import moderngl
import numpy as np

from viewer.engine.declarations import choice, slider, toggle
from viewer.engine.gpu import Gpu
from viewer.engine.params import Parameters
from viewer.engine.program import Program
from viewer.kit.mesh import Triangles, quads_to_triangles

GROUP = "Water"
WATERS: Mapping[str, tuple[str, str]] = {      # below and above, as Studio.backdrop takes them
    "lagoon": ("#1d7483", "#a9e0da"), "ocean": ("#1b5b8f", "#9ccfe8"), "pond": ("#35685a", "#cfe2b4")}
LIGHT_UNIT, SOFT_LIGHT_UNIT = 8, 9
BEND = 0.034            # how far aside a ray lands for each unit of the waves' slope, in tiles: to sharp lines
SOFT_BEND = 0.4 * BEND  # and well before they are
MARGIN = 9.0 / 64.0     # of the net of light around its tile: as far as a ray is bent at most
MOTES = 140


class WaterParameters(Parameters):
    """What kind of water it is, and what light falls through it."""

    water: str = choice("lagoon", {
        "lagoon": "Clear and green-blue, over white sand", "ocean": "Deep and blue", "pond": "A garden pond, green"},
        "What the fish swims in", group=GROUP)
    seabed: bool = toggle(True, "A bed of sand, with shadows and light on it", group=GROUP)
    caustics: float = slider(1.0, 0.0, 2.0, "How strongly the waves above gather the light", group=GROUP)
    motes: bool = toggle(True, "Dust that drifts in the water", group=GROUP)


class LightNet:
    """What the waves make of the sun's light on a tile of floor: a texture that repeats without a seam.

    A net of rays, ``squares`` by ``squares`` of it to a tile and a margin, is bent by the waves and drawn where it
    lands, each mesh as bright as it has become small: Evan Wallace, "Rendering Realtime Caustics in WebGL", 2016.
    """

    def __init__(self, gpu: Gpu, pixels: int, squares: int, bend: float) -> None:
        self.gpu = gpu
        (self._sharp, self._landing), (self.texture, self._softened) = (self._target(pixels) for _ in range(2))
        self._program = gpu.program("underwater/light_net.vert", "underwater/light_net.frag")
        knots = 1 + round(squares * (1.0 + 2.0 * MARGIN))
        self._program["u_knots"], self._program["u_margin"] = knots, MARGIN
        self._program["u_bend"], self._program["u_pixel"] = bend, 1.0 / pixels
        self._net = gpu.vertex_array(self._program, [], gpu.buffer(net_triangles(knots), label="net of light"))
        self._disc = gpu.vertex_array(gpu.program("studio/screen.vert", "underwater/sun_disc.frag"))
        self._shows: tuple[float, int, int] | None = None

    def draw(self, time: float) -> None:
        """Let the light fall as it does at ``time``, in seconds, unless it does so already."""
        shows = time, self._program.generation, self._disc.program.generation
        if shows == self._shows:
            return
        context = self.gpu.context
        drawn_into = context.fbo
        self._program["u_time"] = time
        context.enable_only(moderngl.NOTHING)
        self._landing.use()
        self._landing.clear()
        with adding_light(context):
            self._net.render()
        self._softened.use()
        self._sharp.use(LIGHT_UNIT)
        self._disc.program["u_light"] = LIGHT_UNIT
        self._disc.render(vertices=3)
        drawn_into.use()
        self._shows = shows

    def _target(self, pixels: int) -> tuple[moderngl.Texture, moderngl.Framebuffer]:
        texture = self.gpu.texture((pixels, pixels), 1, dtype="f2", label="caustics")
        texture.filter = moderngl.LINEAR, moderngl.LINEAR
        return texture, self.gpu.framebuffer([texture], label="caustics")


class Underwater:
    """Draws the set, and lets programs that include ``lib/underwater.glsl`` share its light."""

    def __init__(self, gpu: Gpu, params: Any) -> None:
        self.gpu, self.params = gpu, params
        self._light = LightNet(gpu, 256, 64, BEND)
        self._soft_light = LightNet(gpu, 64, 32, SOFT_BEND)
        self._seabed = gpu.vertex_array(gpu.program("underwater/seabed.vert", "underwater/seabed.frag"),
                                        mode=moderngl.TRIANGLE_FAN, closed=True)
        self._water = gpu.vertex_array(gpu.program("underwater/water.vert", "underwater/water.frag"))
        self._motes = gpu.vertex_array(gpu.program("underwater/mote.vert", "underwater/mote.frag"),
                                       mode=moderngl.TRIANGLE_STRIP)

    def prepare(self, time: float) -> None:
        """Let the waves go on to ``time``, in seconds."""
        self._light.draw(time)
        self._soft_light.draw(time)

    def light_up(self, program: Program) -> None:
        """Give a program the gathered light, for the drawing that follows."""
        program["u_light_net"], program["u_soft_light_net"] = LIGHT_UNIT, SOFT_LIGHT_UNIT
        self._light.texture.use(LIGHT_UNIT)
        self._soft_light.texture.use(SOFT_LIGHT_UNIT)

    def draw(self) -> None:
        """Draw sand and water, before what is translucent in them; they cast no shadow."""
        if self.gpu.casting_shadows:
            return
        self.light_up(self._seabed.program)
        self.light_up(self._water.program)
        if self.params.seabed:
            self._seabed.render(vertices=4)
        self._water.render(vertices=3)

    def draw_motes(self) -> None:
        """Draw the dust, in ``Scene.draw_over``; it only adds light."""
        if not self.params.motes:
            return
        drawn_into = self.gpu.context.fbo
        drawn_into.depth_mask = False
        self.light_up(self._motes.program)
        with adding_light(self.gpu.context):
            self._motes.render(vertices=4, instances=MOTES)
        drawn_into.depth_mask = True


@contextmanager
def adding_light(context: moderngl.Context) -> Iterator[None]:
    """Let what is drawn meanwhile be added to what is there."""
    context.enable(moderngl.BLEND)
    context.blend_func = moderngl.ONE, moderngl.ONE
    try:
        yield
    finally:
        context.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
        context.disable(moderngl.BLEND)


def net_triangles(knots: int) -> Triangles:
    """Two triangles for each square of a net of ``knots`` by ``knots``, as (m, 3) indices of its knots, row by row."""
    knot = np.arange(knots * knots).reshape(knots, knots)
    return quads_to_triangles(knot[:-1, :-1], knot[:-1, 1:], knot[1:, 1:], knot[1:, :-1])
