"""The points that particles' paths lead through, in one texture: a block of all slots for each point."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.gpu import Gpu
from viewer.engine.particles.pool import Pool
from viewer.engine.program import Program

BEFORE_UNIT, PLACES_UNIT = 4, 0
EVER, NEVER = -1.0, 1e30        # how long ago the point before was noted, where it is always the path's own or never


class Blocks:
    """How ``number`` blocks of ``size`` texels lie in a texture: side by side, in rows of ``columns``."""

    def __init__(self, gpu: Gpu, size: tuple[int, int], number: int) -> None:
        self.size, self.number = size, number
        self.columns = 1
        while self.columns < number and (-(-number // self.columns) * size[1] > self.columns * size[0]
                                         and 2 * self.columns * size[0] <= gpu.largest_texture):
            self.columns *= 2
        self.rows = -(-number // self.columns)
        self.whole = self.columns * size[0], self.rows * size[1]

    def corner(self, block: int) -> tuple[int, int]:
        """The first texel of a block."""
        return block % self.columns * self.size[0], block // self.columns * self.size[1]

    def constants(self, name: str) -> str:
        """The same for shaders: ``NAME_SIZE``, ``NAME_COLUMNS`` and how many there are, ``NAME_POINTS``."""
        return (f"const ivec2 {name}_SIZE = ivec2({self.size[0]}, {self.size[1]});\n"
                f"const int {name}_COLUMNS = {self.columns}, {name}_POINTS = {self.number};\n")


class Paths:
    """``points`` places for each slot of ``pool``, with the way from the path's start, in metres, as their w.

    ``latest`` holds the one that was last noted. Shaders read them through ``particles/paths.glsl``.
    """

    def __init__(self, gpu: Gpu, pool: Pool, points: int) -> None:
        self.gpu, self.pool, self.points = gpu, pool, points
        self.blocks = Blocks(gpu, (pool.width, pool.height), points)
        self.texture = self._texture(self.blocks.whole, "paths")
        self._latest = [self._texture(self.blocks.size, "latest points of paths") for _ in range(2)]
        self._noting = [gpu.framebuffer([texture], label="noting points") for texture in self._latest]
        self._keeping = gpu.framebuffer([self.texture], label="paths")
        for framebuffer in (*self._noting, self._keeping):
            framebuffer.clear()
        self._note = gpu.program("studio/screen.vert", "particles/path_note.frag")
        self._keep = gpu.program("studio/screen.vert", "particles/path_keep.frag")
        self._noted, self._kept = gpu.vertex_array(self._note), gpu.vertex_array(self._keep)

    @staticmethod
    def bytes_per_particle(points: int) -> int:
        """How much memory a particle takes."""
        return 16 * (points + 2)

    def constants(self) -> str:
        """The include ``generated/paths.glsl``."""
        return self.blocks.constants("PATH")

    def bind(self, program: Program, unit: int) -> None:
        """Let ``program`` read the paths, and with them their latest points."""
        self.texture.use(unit)
        self._latest[0].use(unit + 1)
        program["u_paths"], program["u_latest"] = unit, unit + 1

    def note(self, point: int, textures: Mapping[str, moderngl.Texture], since: float) -> None:
        """Note where everyone is as their ``point``; the point before, noted ``since`` seconds ago, is the path's own
        only if the particle is older than that."""
        textures = {**textures, "before": self._latest[0]}
        for unit, (name, texture) in enumerate(textures.items()):
            texture.use(unit)
            self._note[f"u_{name}"] = unit
        self._note["u_since"] = since
        with drawing_at(self.gpu, self._noting[1], (0, 0), (self.pool.width, self.pool.rows)):
            self._noted.render(vertices=3)
        self._latest.reverse()
        self._noting.reverse()
        self._latest[0].use(PLACES_UNIT)
        self._keep["u_places"] = PLACES_UNIT
        self._keep["u_corner"] = corner = self.blocks.corner(point)
        with drawing_at(self.gpu, self._keeping, corner, (self.pool.width, self.pool.rows)):
            self._kept.render(vertices=3)

    def read(self, points: int) -> NDArray[np.float32]:
        """The first so many points of all rows in use, and then the latest: (points + 1, rows * width, 4)."""
        texels = np.empty((points + 1, self.pool.rows * self.pool.width, 4), np.float32)
        for block in range(points if texels.size else 0):
            self._keeping.read_into(texels[block].data, self._part(block), 4, alignment=1, dtype="f4")
        if texels.size:
            self._noting[0].read_into(texels[points].data, self._part(0), 4, alignment=1, dtype="f4")
        return texels

    def write(self, texels: NDArray[np.float32]) -> None:
        """Put back what was ``read``."""
        for block in range(len(texels) - 1 if texels.size else 0):
            self.texture.write(texels[block], self._part(block))
        if texels.size:
            self._latest[0].write(texels[-1], self._part(0))

    def _part(self, block: int) -> tuple[int, int, int, int]:
        return (*self.blocks.corner(block), self.pool.width, self.pool.rows)

    def _texture(self, size: tuple[int, int], label: str) -> moderngl.Texture:
        return self.gpu.texture(size, 4, dtype="f4", label=label)


@contextmanager
def drawing_at(gpu: Gpu, target: moderngl.Framebuffer, corner: tuple[int, int],
               size: tuple[int, int]) -> Iterator[None]:
    """Draw a block of texels, in colour whatever is under way, and go back to the framebuffer before."""
    before, casting = gpu.context.fbo, gpu.casting_shadows
    target.viewport = (*corner, *size)
    target.use()
    gpu.context.enable_only(moderngl.NOTHING)
    gpu.casting_shadows = False
    try:
        yield
    finally:
        gpu.casting_shadows = casting
        if before:
            before.use()
