"""Draws particles as sprites: points where the driver can, polygons where they are stretched, turned or large."""

from __future__ import annotations

from typing import Any

import moderngl

from viewer.engine.annotations import Label
from viewer.engine.gpu import Gpu
from viewer.engine.particles import appearance, look
from viewer.engine.particles.appearance import Appearance
from viewer.engine.particles.life_table import LifeTable
from viewer.engine.particles.overdraw import Overdraw
from viewer.engine.particles.sprite_image import SpriteImage
from viewer.engine.particles.sprite_shadow import SpriteShadow, slot_constants
from viewer.engine.particles.system import ParticleSystem
from viewer.engine.program import VertexArray
from viewer.engine.scene import ColorScale
from viewer.engine.sprite_layer import OVER

SCENE_DEPTH_UNIT, PICTURE_UNIT = 4, 5
SHAPES = {"point": (moderngl.POINTS, 0), "triangle": (moderngl.TRIANGLES, 3),
          "square": (moderngl.TRIANGLE_STRIP, 4)}       # and how many corners
OF_EACH_ITS_OWN = "puff", "flake", "leaf", "ring"


class Sprites:
    """The picture of a particle system; ``prepare`` it, then ``cast_shadows`` and ``draw`` it.

    ``bytes_per_particle`` is the memory that it takes beside the system's own.
    """

    bytes_per_particle = appearance.BYTES_PER_PARTICLE

    def __init__(self, gpu: Gpu, system: ParticleSystem, params: Any) -> None:
        self.gpu, self.system, self.params = gpu, system, params
        self.table = LifeTable(gpu, params)
        self.image = SpriteImage(gpu, params)
        self.appearance = Appearance(gpu, system.pool, self.table, params)
        self.shadow = SpriteShadow(gpu, system.pool, self.table, params)
        self.prepare()
        self._order = gpu.buffer(reserve=4 * system.pool.capacity, label="sprites' order")
        self._arrays: dict[tuple[str, bool], VertexArray] = {}
        self._overdraw: Overdraw | None = None

    def prepare(self) -> None:
        """Follow the parameters; raises ParameterError where the picture's file is at fault."""
        self.image.prepare()
        self.table.prepare()

    def draw(self, scene_depth: moderngl.Texture) -> None:
        """Draw all particles into the layer of sprites; ``scene_depth`` is that of what is solid."""
        self.appearance.compute(scene_depth)
        slots = self.appearance.slots
        if len(slots):
            self._order.orphan()
            self._order.write(slots)
        if self.params.overdraw:
            self._draw_counts(scene_depth, len(slots))
            return
        self.gpu.context.enable_only(moderngl.BLEND | moderngl.DEPTH_TEST)
        self._draw_sprites(scene_depth, len(slots))

    def cast_shadows(self) -> None:
        """Draw the particles into the shadow map, where they shade anything."""
        if self.params.shadows:
            self.shadow.cast()

    def color_scale(self) -> ColorScale | None:
        """What the colours now stand for, if for a number."""
        return look.color_scale(self.params)

    def labels(self) -> tuple[Label, ...]:
        """What the colours now stand for, if for generations."""
        return look.generation_key(self.params)

    @property
    def overdraw(self) -> Overdraw:
        """What counts sprites on pixels, made when first wanted."""
        if self._overdraw is None:
            self._overdraw = Overdraw(self.gpu)
        return self._overdraw

    def _draw_counts(self, scene_depth: moderngl.Texture, number: int) -> None:
        overdraw = self.overdraw
        with overdraw.counting(scene_depth.size):
            self._draw_sprites(scene_depth, number)
        self.gpu.context.blend_func = OVER  # type: ignore[assignment]
        overdraw.show()

    def _draw_sprites(self, scene_depth: moderngl.Texture, number: int) -> None:
        if not number:
            return
        array = self._array(self.shape, self.appearance.needs_depth)
        self.appearance.bind(array.program)
        scene_depth.use(SCENE_DEPTH_UNIT)
        array.program["u_scene_depth"] = SCENE_DEPTH_UNIT
        if self.image.texture is not None:
            self.image.texture.use(PICTURE_UNIT)
            array.program["u_picture"] = PICTURE_UNIT
        corners = SHAPES[self.shape][1]
        if corners:
            array.render(vertices=corners, instances=number)
            return
        self.gpu.context.enable(moderngl.PROGRAM_POINT_SIZE)
        array.render(vertices=number)
        self.gpu.context.disable(moderngl.PROGRAM_POINT_SIZE)

    @property
    def shape(self) -> str:
        """What each sprite of the last picture was drawn as: a point, a square, or a triangle around its circle, which
        has more pixels but is half the work where sprites are small."""
        params = self.params
        if params.billboard == "camera" and not params.outlines and not self.appearance.needs_polygons:
            return "point"
        fills_square = params.outlines or params.overdraw or params.sprite == "texture"
        return "square" if fills_square or params.billboard == "camera" else "triangle"

    def _array(self, shape: str, fades: bool) -> VertexArray:
        """The vertex array for a shape, linked when first wanted."""
        if (shape, fades) not in self._arrays:
            program = self.gpu.program("particles/sprite.vert", "particles/sprite.frag", generated={
                "generated/look.glsl": lambda: look.look_constants(self.params),
                "generated/sprite.glsl": lambda: self._constants(shape, fades)})
            mode, corners = SHAPES[shape]
            content = [(self._order, "1u/i" if corners else "1u", "in_slot")]
            self._arrays[shape, fades] = self.gpu.vertex_array(program, content, mode=mode)
        return self._arrays[shape, fades]

    def _constants(self, shape: str, fades: bool) -> str:
        """The include ``generated/sprite.glsl``."""
        params = self.params
        lit = params.lighting > 0.0 and params.colouring == "look"
        shaded = (params.sprite == "ball" or (params.sprite == "puff" and lit)) and not params.overdraw
        turned = params.sprite in OF_EACH_ITS_OWN or params.billboard == "tumble" or look.turns(params)
        return slot_constants(self.system.pool) + look.constants(
            {"SHAPE": list(SHAPES).index(shape), "SHADED": shaded, "USES_TURN": shaded or turned,
             "FADES": fades and params.softness > 0.0})
