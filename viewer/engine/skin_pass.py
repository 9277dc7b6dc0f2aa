"""Skinning in a pass of its own: vertices in textures, moved by a fragment each, for all who draw them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.field_samples import drawing_into
from viewer.engine.gpu import Gpu
from viewer.engine.program import Program
from viewer.engine.skin import BonePalette

WIDTH = 1024            # vertices in a row of the textures
FIRST_UNIT = 2          # of textures, after the bones and whatever a scene binds
Rows = NDArray[np.float32]


class SkinPass:
    """``run`` moves the vertices of a mesh as ``palette`` has them; vertex n is texel (n % 1024, n / 1024).

    ``bound`` are its places and normals as textures, which many passes may share, ``joints`` and ``weights`` (n, 4)
    or (n, 8).
    """

    def __init__(self, gpu: Gpu, bound: Sequence[moderngl.Texture], joints: NDArray[Any], weights: Rows,
                 palette: BonePalette) -> None:
        self.gpu, self.palette, self.count = gpu, palette, len(joints)
        self._size = bound[0].size
        self._bound = list(bound)
        self._groups = [texture_of(gpu, rows, kind) for rows, kind in grouped(joints, weights)]
        self._made = [gpu.texture(self._size, 4, dtype="f4", label=name) for name in ("posed places", "posed normals")]
        self._target = gpu.framebuffer(self._made, label="posed vertices")
        program = gpu.program("studio/screen.vert", "skin/pass.frag", generated=palette.generated)
        names = ("u_bound_places", "u_bound_normals", "u_joints", "u_weights", "u_more_joints", "u_more_weights")
        for unit, name in enumerate(names, FIRST_UNIT):
            program[name] = unit
        self._everywhere = gpu.vertex_array(program)

    def follow(self, joints: NDArray[Any], weights: Rows) -> None:
        """Let the vertices follow other bones."""
        for texture, (rows, kind) in zip(self._groups, grouped(joints, weights), strict=True):
            texture.write(padded(rows, kind))

    def run(self, bones_unit: int) -> None:
        """Move all vertices; the palette goes through a texture unit."""
        program = self._everywhere.program
        self.palette.bind(program, bones_unit)
        for unit, texture in enumerate([*self._bound, *self._groups], FIRST_UNIT):
            texture.use(unit)
        with drawing_into(self.gpu, self._target, self._size):
            self._everywhere.render(vertices=3)

    def bind(self, program: Program) -> None:
        """Give ``u_posed_places`` and ``u_posed_normals`` to a program."""
        for unit, (name, texture) in enumerate(zip(("u_posed_places", "u_posed_normals"), self._made, strict=True),
                                               FIRST_UNIT):
            program[name] = unit
            texture.use(unit)

    def read(self) -> tuple[Rows, Rows]:
        """Places and normals (n, 3), as the last run made them."""
        places, normals = (np.frombuffer(texture.read(), np.float32).reshape(-1, 4)[:self.count, :3].copy()
                           for texture in self._made)
        return places, normals


def texture_of(gpu: Gpu, rows: NDArray[Any], kind: str = "f4") -> moderngl.Texture:
    """Rows (n, 3) or (n, 4) as texels, for passes; raises GpuError for more than a texture holds."""
    made = gpu.texture((WIDTH, -(-len(rows) // WIDTH)), 4, padded(rows, kind), dtype=kind, label="bound vertices")
    made.filter = moderngl.NEAREST, moderngl.NEAREST
    return made


def padded(rows: NDArray[Any], kind: str) -> NDArray[Any]:
    """Rows of up to four numbers as the texels of a whole texture."""
    texels = np.zeros((-(-len(rows) // WIDTH) * WIDTH, 4), kind)
    texels[:len(rows), :rows.shape[1]] = rows
    return texels


def grouped(joints: NDArray[Any], weights: Rows) -> list[tuple[NDArray[Any], str]]:
    """Joints and weights by fours, each with the type of its texture."""
    return [pair for first in range(0, joints.shape[1], 4)
            for pair in ((joints[:, first:first + 4], "u2"), (weights[:, first:first + 4], "f4"))]
