"""The vertices of a surface, kept in textures on the GPU and made there, one fragment for each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.field_samples import BLOCK, FieldSamples, Warmth, drawing_into
from viewer.engine.gpu import Gpu
from viewer.engine.program import Program, VertexArray
from viewer.kit.field_function import FieldFunction

WIDTH = 1024            # vertices in a row of the textures
GROWTH = 1.25           # how much larger than needed textures are made, so that not each change needs new ones
VALUES_UNIT, LIST_UNIT = 0, 1


@dataclass(frozen=True)
class Wanted:
    """What surface to make: at which level, by which method, and what to find out on the way."""

    level: float
    method: str = "cubes"
    cut_jumps: bool = False
    curvature: bool = False
    in_order: bool = False      # the triangles cell after cell
    function: FieldFunction | None = None       # the field in NumPy, where that is to be used


class VertexTextures:
    """``count`` vertices: vertex n at texel (n % 1024, n / 1024) of ``places`` and ``normals``.

    ``places`` are in the field's own space; the fourth component of ``normals`` is the mean curvature.
    ``include`` gives GLSL for ``field`` and ``field_gradient``, from which a pass finds how a surface lies.
    """

    def __init__(self, gpu: Gpu, samples: FieldSamples, include: Callable[[], str]) -> None:
        self.gpu, self.samples = gpu, samples
        self.count = 0
        self._include = include
        self._passes: dict[tuple[str, bool, bool], VertexArray] = {}
        self._warm = Warmth(gpu)
        self._given: moderngl.Texture | None = None
        self._made: list[Any] = []
        self._rows = 0
        self._make_room(1)

    @property
    def most(self) -> int:
        """How many vertices this GPU's textures hold."""
        return int(WIDTH * self.gpu.largest_texture / GROWTH) - WIDTH

    @property
    def generation(self) -> int:
        """Grows whenever a shader that vertices come from is replaced by an edited one."""
        return sum(each.program.generation for each in self._passes.values())

    def flagged(self) -> NDArray[np.bool_]:
        """Which vertices the last pass marked: edges that the field jumps over."""
        if not self.count:
            return np.zeros(0, np.bool_)
        size = (WIDTH, -(-self.count // WIDTH))
        flags = np.frombuffer(self._target.read((0, 0, *size), 1, attachment=2, alignment=1), np.uint8)
        return np.asarray(flags[:self.count] != 0)

    def send(self, places: NDArray[np.float32], normals: NDArray[np.float32]) -> None:
        """Put vertices into the textures from which they are drawn."""
        lines = -(-len(places) // WIDTH)
        self._make_room(lines)
        self.count = len(places)
        for texture, rows in ((self.places, places), (self.normals, normals)):
            padded = np.zeros((lines * WIDTH, 4), np.float32)
            padded[:len(rows), :3] = rows
            if lines:
                texture.write(padded, (0, 0, WIDTH, lines))

    def run(self, name: str, rows: NDArray[Any], components: int, dtype: str, wanted: Wanted) -> None:
        """Let the pass ``name`` make a vertex of each of ``rows`` (n, ``components``), sent as ``dtype``."""
        lines = -(-len(rows) // WIDTH)
        self._make_room(lines)
        self.count = len(rows)
        if not lines:
            return
        given = self._given_to(name)
        padded = np.zeros((lines * WIDTH, components), dtype)
        padded[:len(rows)] = rows.reshape(-1, components)
        given.write(padded, (0, 0, WIDTH, lines))
        everywhere = self._pass(name, wanted)
        self._tell(everywhere.program, wanted)
        self.samples.values.use(VALUES_UNIT)
        given.use(LIST_UNIT)
        with drawing_into(self.gpu, self._target, (WIDTH, lines)):
            everywhere.render(vertices=3)

    def warm_up(self, name: str, wanted: Wanted) -> None:
        """Have a pass ready as the driver runs it, before anything is timed."""
        self.samples.values.use(VALUES_UNIT)        # drivers compile for the kinds of textures in use
        self._given_to(name).use(LIST_UNIT)
        everywhere = self._pass(name, wanted)
        self._tell(everywhere.program, wanted)
        self._warm.up(self._target, everywhere)

    def _tell(self, program: Program, wanted: Wanted) -> None:
        """Give a pass what it needs to know of the samples and the surface."""
        self.samples.describe_to(program)
        program["u_surface_level"] = wanted.level

    def _given_to(self, name: str) -> moderngl.Texture:
        """The texture of what a pass makes vertices from: crossings, or places made elsewhere."""
        if name == "crossing":
            return self._edges
        if self._given is None:
            nowhere = np.zeros((self._rows, WIDTH, 4), "f4")
            self._given = self.gpu.texture((WIDTH, self._rows), 4, nowhere, dtype="f4", label="given places")
            self._made.append(self._given)
        return self._given

    def _pass(self, name: str, wanted: Wanted) -> VertexArray:
        """A pass over all vertices, linked when first wanted: software GL would run what is only switched off."""
        key = name, wanted.cut_jumps, wanted.curvature
        if key not in self._passes:
            asked = (f"const bool FIND_JUMPS = {str(wanted.cut_jumps).lower()};\n"
                     f"const bool BENDS = {str(wanted.curvature).lower()};\n")
            program = self.gpu.program("studio/screen.vert", f"isosurface/{name}.frag", generated={
                "generated/field.glsl": self._include, "generated/asked.glsl": lambda: asked})
            program["u_values"] = program["u_volume"] = VALUES_UNIT
            program["u_crossings"] = program["u_places"] = LIST_UNIT
            self._passes[key] = self.gpu.vertex_array(program)
        return self._passes[key]

    def _make_room(self, lines: int) -> None:
        """Textures of at least ``lines`` rows."""
        if lines <= self._rows:
            return
        size = (WIDTH, max(BLOCK, int(GROWTH * lines) + 1))
        self.gpu.check_size(size, f"a surface of {lines * WIDTH} vertices, in a texture")
        self.gpu.discard(*self._made)
        self._rows = size[1]
        # Zeros, so that a pass that is warmed up before there are crossings finds real samples.
        self._edges = self.gpu.texture(size, 1, np.zeros(size[0] * size[1], "u4"), dtype="u4", label="crossings")
        self._given = None
        self.places = self.gpu.texture(size, 4, dtype="f4", label="places")
        self.normals = self.gpu.texture(size, 4, dtype="f4", label="normals")
        jump = self.gpu.texture(size, 1, label="jumps")
        self._target = self.gpu.framebuffer([self.places, self.normals, jump], label="vertices")
        self._made = [self._target, jump, self.normals, self.places, self._edges]

    def read(self, attachment: int) -> NDArray[np.float32]:
        """The texels of all vertices, (count, 4): places are attachment 0, normals 1."""
        lines = -(-self.count // WIDTH)
        if not lines:
            return np.empty((0, 4), np.float32)
        texels = self._target.read((0, 0, WIDTH, lines), 4, attachment=attachment, dtype="f4")
        return np.frombuffer(texels, np.float32).reshape(-1, 4)[:self.count]
