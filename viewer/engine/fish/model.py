"""A species of fish on the GPU, at every level of detail; all fish of it are drawn with one call."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.fish import look
from viewer.engine.fish.swimming import Swimming
from viewer.engine.gpu import Gpu
from viewer.engine.program import Program, VertexArray
from viewer.engine.scene import Geometry
from viewer.engine.skin import METHODS, BonePalette, skin_attributes
from viewer.kit.fish import FishMesh, fish, fish_pieces, fish_rig
from viewer.kit.mesh import vertex_areas

BONES_UNIT = 10
SINGLE = 3          # the detail of a fish that is looked at closely
# From how many pixels of a fish's length on each detail is worth its triangles, and how many vertices all may have.
WORTH = (0, 46, 130, 420)
MOST_VERTICES = 250_000


class FishModel:
    """Draws one fish or many of a species: give ``program`` the pose of the fish, then ``draw``."""

    def __init__(self, gpu: Gpu, params: Any, species: str) -> None:
        self.gpu, self.params, self.species = gpu, params, species
        self._rig = fish_rig(species, 0)
        self._palettes = {method: BonePalette(gpu, len(self._rig.bones), method) for method in METHODS}
        self._programs: dict[bool, Program] = {}
        self._content: dict[int, tuple[list[tuple[Any, ...]], moderngl.Buffer]] = {}
        self._arrays: dict[tuple[int, bool], VertexArray] = {}

    @property
    def _palette(self) -> BonePalette:
        """The bones, for the way of blending that is now asked for."""
        return self._palettes[self.params.fin_method]

    def prepare(self, swimming: Swimming) -> None:
        """Let the fins move as the beat has them now."""
        self._palette.send(self._rig.palette(swimming.fin_pose(self._rig.skeleton)))

    def program(self, fine: bool) -> Program:
        """What draws the fish with all of its skin or, to be seen from far, with the pattern alone."""
        if fine not in self._programs:
            self._programs[fine] = self.made_program("fish", fine, {
                "generated/fish.glsl": lambda: look.species_glsl(self.species)})
        return self._programs[fine]

    def made_program(self, name: str, fine: bool = True, generated: Any = None) -> Program:
        """A program whose vertices include ``fish/moved.glsl``."""
        return self.gpu.program(f"fish/{name}.vert", f"fish/{name}.frag", generated={
            "generated/drawn.glsl": lambda: look.drawn_glsl(self.params, fine),
            "generated/skinning.glsl": lambda: self._palette.constants(), **(generated or {})})

    def draw(self, detail: int, fine: bool, instances: int) -> None:
        """Draw the first ``instances`` fish."""
        program = self.program(fine)
        for name, value in look.skin_uniforms(self.params, self.species).items():
            program[name] = value
        self._palette.bind(program, BONES_UNIT)
        # A far fish's shadow is that of its body, the first of its pieces.
        body_alone = self.gpu.casting_shadows and not fine
        vertices = 3 * body_triangles(self.species, detail) if body_alone else -1
        self._array(detail, fine).render(vertices=vertices, instances=instances)

    def draw_needles(self, needles: VertexArray, count: int) -> None:
        """Draw what ``needles`` made, on the first fish."""
        self._palette.bind(needles.program, BONES_UNIT)
        needles.render(instances=count)

    def size(self, detail: int) -> tuple[int, int]:
        """How many vertices and triangles a fish has."""
        mesh = fish(self.species, detail)
        return len(mesh.positions), len(mesh.triangles)

    def capture(self, detail: int) -> Geometry:
        """The first fish as the vertex shader moves it: a mesh, with how its vertices lie on it."""
        mesh, program = fish(self.species, detail), self.program(True)
        self._palette.bind(program, BONES_UNIT)
        captured = self._array(detail, True).capture({"v_position": 3, "v_normal": 3}, len(mesh.positions))
        return {"vertices": captured["v_position"], "triangles": mesh.triangles, "normals": captured["v_normal"],
                "parts": mesh.parts, "rest": mesh.positions}

    def needles(self, corners: NDArray[np.float32], count: int) -> VertexArray:
        """What draws ``count`` needles with ``corners`` (c, 3) on vertices of the fish, as many to each area."""
        mesh = fish(self.species, SINGLE)
        area = np.cumsum(vertex_areas(mesh.positions.astype(np.float64), mesh.triangles))
        roots = np.searchsorted(area, (np.arange(count) + 0.5) / count * area[-1])
        content = [(self.gpu.buffer(corners, label="needle"), "3f", "in_corner"),
                   *((buffer, f"{layout}/i", *names) for buffer, layout, *names in self._attributes(mesh, roots))]
        return self.gpu.vertex_array(self.made_program("needle"), content)

    def _array(self, detail: int, fine: bool) -> VertexArray:
        key = detail, fine
        if key not in self._arrays:
            content, triangles = self._buffers(detail)
            self._arrays[key] = self.gpu.vertex_array(self.program(fine), content, triangles, closed=True)
        return self._arrays[key]

    def _buffers(self, detail: int) -> tuple[list[tuple[Any, ...]], moderngl.Buffer]:
        if detail not in self._content:
            mesh = fish(self.species, detail)
            own = np.hstack([mesh.coordinates, look.lattice(self.species, detail)])
            content = [*self._attributes(mesh, np.arange(len(mesh.positions))),
                       (self.gpu.buffer(mesh.parts.astype("i4"), label="fish's parts"), "1i", "in_part"),
                       (self.gpu.buffer(own.astype("f4"), label="places on the fish"), "2f 2f", "in_coordinates",
                        "in_lattice")]
            self._content[detail] = content, self.gpu.buffer(mesh.triangles, label="fish's triangles")
        return self._content[detail]

    def _attributes(self, mesh: FishMesh, chosen: NDArray[np.intp]) -> list[tuple[Any, ...]]:
        """Where the ``chosen`` vertices are at rest, and which joints they follow."""
        places = self.gpu.buffer(np.hstack([mesh.positions, mesh.normals])[chosen].astype("f4"), label="fish at rest")
        return [(places, "3f 3f", "in_position", "in_normal"),
                *skin_attributes(self.gpu, mesh.joints[chosen], mesh.weights[chosen])]


def detail_of(params: Any, pixels: float) -> int:
    """The level of detail for the fish that ``params`` ask for, of which the nearest is ``pixels`` long."""
    worth = max(level for level, least in enumerate(WORTH) if pixels >= least)
    chosen = list(look.DETAILS).index(params.detail) - 1
    return next((level for level in range(worth if chosen < 0 else chosen, 0, -1)
                 if params.school * len(fish(params.species, level).positions) <= MOST_VERTICES), 0)


@lru_cache
def body_triangles(species: str, detail: int) -> int:
    """How many triangles the body has, which is the first of a fish's pieces."""
    return len(fish_pieces(species, detail)["body"].triangles)
