"""The shadow of particles: each a disc in the shadow map that stops light by chance, as often as it is opaque."""

from __future__ import annotations

from typing import Any

import moderngl

from viewer.engine.gpu import Gpu
from viewer.engine.particles.life_table import LifeTable
from viewer.engine.particles.look import constants, look_constants
from viewer.engine.particles.pool import Pool
from viewer.engine.shadow import DEPTH_SIZE

MOST_DISCS = 65_536     # beyond, each stands for several: the map has few more pixels than that
READ = "motion", "velocity", "nature"


class SpriteShadow:
    """Draws ``pool`` into the shadow map, with the opacity of a life ``table``."""

    def __init__(self, gpu: Gpu, pool: Pool, table: LifeTable, params: Any) -> None:
        self.gpu, self.pool, self.table, self.params = gpu, pool, table, params
        self._program = gpu.program("particles/sprite_shadow.vert", "particles/sprite_shadow.frag",
                                    generated={"generated/look.glsl": lambda: look_constants(params),
                                               "generated/sprite_shadow.glsl": lambda: slot_constants(pool)})
        self._discs = gpu.vertex_array(self._program, mode=moderngl.POINTS)

    def cast(self) -> None:
        """Draw the discs, as the key light sees them."""
        if not self.pool.used:
            return
        stands_for = -(-self.pool.used // MOST_DISCS)
        self.pool.bind(self._program, READ)
        self.table.texture.use(len(READ))
        self._program["u_table"] = len(READ)
        self._program["u_each_stands_for"] = stands_for
        self._program["u_map_size"] = float(DEPTH_SIZE)
        self.gpu.context.enable(moderngl.PROGRAM_POINT_SIZE)
        self._discs.render(vertices=-(-self.pool.used // stands_for))
        self.gpu.context.disable(moderngl.PROGRAM_POINT_SIZE)


def slot_constants(pool: Pool) -> str:
    """How a slot's number becomes its place in the textures."""
    return constants({"WIDTH_MASK": pool.width - 1, "WIDTH_BITS": pool.width.bit_length() - 1})
