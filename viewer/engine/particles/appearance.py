"""What each particle looks like from where the camera stands, computed in one pass over the slots."""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.field_samples import drawing_into
from viewer.engine.gpu import Gpu
from viewer.engine.particles.life_table import LifeTable
from viewer.engine.particles.look import colouring_range, is_sorted, look_constants
from viewer.engine.particles.pool import LASTING, MOVING, Pool
from viewer.engine.program import Program

UNSEEN = 65535
TOO_LARGE, FADES = 0x10000, 0x20000     # above the key, see particles/appearance.frag
TABLE_UNIT = len(MOVING) + len(LASTING)
OUTPUTS = {"place": (4, "f4"), "tint": (4, "f2"), "turn": (4, "f2"), "key": (1, "u4"), "axes": (4, "f4")}
KEY = list(OUTPUTS).index("key")
BYTES_PER_PARTICLE = 16 + 8 + 16 + 8 + 4 + 4 + 4


class Appearance:
    """Textures that the sprites' vertex shader reads, and the slots to draw, in their order.

    ``slots`` (n,) uint32 are those that can be seen: from back to front where that counts, else as they come.
    ``needs_polygons`` tells that one of them is larger than the driver draws points, ``needs_depth`` that one is
    large enough to fade towards what is solid pixel by pixel.
    """

    def __init__(self, gpu: Gpu, pool: Pool, table: LifeTable, params: Any) -> None:
        self.gpu, self.pool, self.table, self.params = gpu, pool, table, params
        size = pool.width, pool.height
        self.textures = {name: gpu.texture(size, components, dtype=dtype, label=f"sprites' {name}")
                         for name, (components, dtype) in OUTPUTS.items()}
        made = list(self.textures.values())
        self._upright, self._slanted = (gpu.framebuffer(some, label="appearance") for some in (made[:-1], made))
        self._slanted.viewport = (0, 0, *size)
        self._slanted.clear()
        self._program = gpu.program("studio/screen.vert", "particles/appearance.frag",
                                    generated={"generated/look.glsl": lambda: look_constants(params)})
        self._pass = gpu.vertex_array(self._program)
        self._keys = np.zeros(pool.width * pool.height, np.uint32)
        self.slots: NDArray[np.uint32] = np.empty(0, np.uint32)
        self.needs_polygons = self.needs_depth = False
        self.largest_point = float(gpu.context.info["GL_POINT_SIZE_RANGE"][1])

    def compute(self, scene_depth: moderngl.Texture) -> None:
        """Follow the particles, the parameters and the camera; ``scene_depth`` is that of what is solid."""
        pool, rows = self.pool, self.pool.rows
        self.slots = np.empty(0, np.uint32)
        self.needs_polygons = self.needs_depth = False
        if not rows:
            return
        pool.bind(self._program)
        self.table.texture.use(TABLE_UNIT)
        self._program["u_table"] = TABLE_UNIT
        scene_depth.use(TABLE_UNIT + 1)
        self._program["u_scene_depth"] = TABLE_UNIT + 1
        self._program["u_colouring_range"] = colouring_range(self.params)
        self._program["u_largest_point"] = self.largest_point
        target = self._upright if self.params.billboard == "camera" else self._slanted      # who needs axes
        with drawing_into(self.gpu, target, (pool.width, rows)):
            self._pass.render(vertices=3)
        target.read_into(self._keys, (0, 0, pool.width, rows), 1, attachment=KEY, alignment=1, dtype="u4")
        self._put_in_order(self._keys[:pool.used])

    def bind(self, program: Program, first_unit: int = 0) -> None:
        """Let ``program`` read the textures as ``u_place`` and so on."""
        for unit, name in enumerate((name for name in OUTPUTS if name != "key"), first_unit):
            self.textures[name].use(unit)
            program[f"u_{name}"] = unit

    def _put_in_order(self, keys: NDArray[np.uint32]) -> None:
        self.slots = np.flatnonzero(keys != UNSEEN).astype(np.uint32)
        seen = keys[self.slots]
        told = int(np.bitwise_or.reduce(seen)) if len(seen) else 0
        self.needs_polygons, self.needs_depth = bool(told & TOO_LARGE), bool(told & FADES)
        if is_sorted(self.params):      # sixteen bits are sorted by radix
            self.slots = self.slots[np.argsort(seen.astype(np.uint16), kind="stable")]
