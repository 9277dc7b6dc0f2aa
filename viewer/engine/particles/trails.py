"""Trails: the way that each particle has come, drawn as a ribbon that faces the camera."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.clock import FRAME_SECONDS
from viewer.engine.declarations import integer, slider, toggle
from viewer.engine.gpu import Gpu
from viewer.engine.params import Parameters
from viewer.engine.particles.life_table import LifeTable
from viewer.engine.particles.look import colouring_range, constants, is_sorted, look_constants
from viewer.engine.particles.paths import Paths, drawing_at
from viewer.engine.particles.ribbons import Ribbons
from viewer.engine.particles.system import ParticleSystem
from viewer.engine.program import Program

GROUP = "Trails"
LATE = 0.3 * FRAME_SECONDS
PATHS_UNIT, REACH_UNIT, TABLE_UNIT = 5, 7, 10


class TrailParameters(Parameters):
    """What an artist sets of trails, and of strands, which are trails of whole lives."""

    strands: bool = toggle(False, "Draw each particle's whole life at once, as hair, fur and grass are drawn",
                           rebuild=True, group=GROUP)
    trail_length: float = slider(0.0, 0.0, 20.0, "Length along the path; 0: moving particles have none, and strands "
                                 "their whole path", unit="m", group=GROUP, handy=(0.0, 3.0))
    trail_width: float = slider(1.0, 0.0, 4.0, "Width at its head or root, in diameters of the particle", group=GROUP)
    trail_taper: float = slider(0.8, 0.0, 1.0, "How much of the width is lost towards the other end", group=GROUP)
    trail_opacity: float = slider(0.8, 0.0, 1.0, "Opacity at the head", group=GROUP, when="!strands")
    trail_seconds: float = slider(0.8, 0.05, 10.0, "How far back trails remember", unit="s", rebuild=True, group=GROUP,
                                  logarithmic=True, when="!strands")
    trail_points: int = integer(26, 4, 64, "Points that a trail is drawn through", rebuild=True, group=GROUP,
                                when="!strands")
    strand_points: int = integer(12, 4, 48, "Points that a strand is drawn through", rebuild=True, group=GROUP,
                                 when="strands")
    shine: float = slider(1.0, 0.0, 4.0, "How strong the two highlights of hair are", group=GROUP, when="strands")
    shine_sharpness: float = slider(0.6, 0.0, 1.0, "How narrow the highlights are", group=GROUP, when="strands")
    root_shade: float = slider(0.6, 0.0, 1.0, "How much darker strands are at the root, among all the others",
                               group=GROUP, when="strands")
    tint_variation: float = slider(0.35, 0.0, 1.0, "How much one strand differs in colour from the next", group=GROUP,
                                   when="strands")


@dataclass(frozen=True)
class TrailSnapshot:
    """All that trails remember: points and the latest of them, and how often one was noted."""

    texels: NDArray[np.float32]
    notes: int

    @property
    def nbytes(self) -> int:
        """How much memory it takes."""
        return self.texels.nbytes


class Trails:
    """Notes where each particle is every ``stride`` steps, in a ring, and draws ribbons through the notes.

    It is a companion of ``system``. While ``trail_length`` is 0 nothing is noted, and the ring is not even made:
    whether it is ``noting`` belongs to what steers a simulation.
    """

    def __init__(self, gpu: Gpu, system: ParticleSystem, params: Any) -> None:
        self.gpu, self.system, self.params = gpu, system, params
        self.stride: int = max(1, math.ceil(params.trail_seconds / FRAME_SECONDS / (params.trail_points - 2)))
        self.notes = 0
        self._paths: Paths | None = None
        self._drawing: TrailDrawing | None = None

    @property
    def noting(self) -> bool:
        """Whether there are trails."""
        return bool(self.params.trail_length > 0.0)

    @property
    def paths(self) -> Paths:
        """The ring of notes, made when first wanted."""
        if self._paths is None:
            self._paths = Paths(self.gpu, self.system.pool, self.params.trail_points - 1)
        return self._paths

    def begin(self) -> None:
        """Nothing has happened yet."""
        self.notes = 0

    def follow(self) -> None:
        """The system has made a step."""
        if not self.noting:
            self.notes = 0
        elif self.system.steps % self.stride == 0:
            textures = self.system.pool.textures
            since = self.stride * FRAME_SECONDS + LATE if self.notes else math.inf
            if self.system.pool.rows:
                self.paths.note(self.notes % self.paths.points, {
                    name: textures[name] for name in ("motion", "nature", "origin")}, min(since, 1e30))
            self.notes += 1

    def snapshot(self) -> TrailSnapshot:
        """All that is remembered."""
        points = min(self.notes, self.params.trail_points - 1)
        texels = self.paths.read(points) if points else np.empty((0, 0, 4), np.float32)
        return TrailSnapshot(texels, self.notes)

    def restore(self, snapshot: TrailSnapshot) -> None:
        """Remember again what was remembered then."""
        self.notes = snapshot.notes
        if snapshot.texels.size:
            self.paths.write(snapshot.texels)

    def draw(self) -> None:
        """Draw the trails into the layer of sprites."""
        if self.noting and self.system.pool.rows:
            if self._drawing is None:
                self._drawing = TrailDrawing(self.gpu, self)
            self._drawing.draw()

    def describe_to(self, program: Program) -> None:
        """Tell ``program`` which notes there are, and from when."""
        points = self.params.trail_points - 1
        program["u_notes"] = min(self.notes, points)
        program["u_newest"] = (self.notes - 1) % points
        program["u_newest_age"] = self.system.steps % self.stride * FRAME_SECONDS
        program["u_gap"] = self.stride * FRAME_SECONDS
        program["u_late"] = LATE


class TrailDrawing:
    """Finds how far each trail reaches, and draws it."""

    def __init__(self, gpu: Gpu, trails: Trails) -> None:
        self.gpu, self.trails, self.pool = gpu, trails, trails.system.pool
        constants = {"generated/paths.glsl": trails.paths.constants, "generated/trail.glsl": self._constants}
        self.reach = Reach(gpu, trails.paths, "particles/trail_reach.frag", trails.params)
        self._ribbons = Ribbons(gpu, self.pool, trails.params.trail_points + 1, "particles/trail_ribbon.frag",
                                "particles/trail.frag", constants)

    def draw(self) -> None:
        """Draw over what is there, behind what is solid."""
        self.find_reach()
        self._ribbons.draw(self._bind, moderngl.DEPTH_TEST | moderngl.BLEND)

    def find_reach(self) -> None:
        """Find where trails end; see ``Reach``."""
        self.trails.describe_to(self.reach.program)
        self.reach.find()

    def _bind(self, program: Program) -> None:
        self.trails.describe_to(program)
        self.pool.bind(program, ("motion",))
        self.trails.paths.bind(program, PATHS_UNIT)
        self.reach.bind(program, REACH_UNIT)

    def _constants(self) -> str:
        return constants({"HIDES": is_sorted(self.trails.params)})


class Reach:
    """Where each path's ribbon ends, how long and wide it is, and its colour: ``end``, ``reach`` and ``tint``."""

    NAMES = ("end", "reach", "tint")

    def __init__(self, gpu: Gpu, paths: Paths, finding: str, params: Any) -> None:
        self.gpu, self.paths, self.pool = gpu, paths, paths.pool
        size = self.pool.width, self.pool.height
        self._textures = {name: gpu.texture(size, 4, dtype="f4", label=f"ribbons' {name}") for name in self.NAMES}
        self.target = gpu.framebuffer(list(self._textures.values()), label="ribbons' reach")
        self.target.clear()
        self.table = LifeTable(gpu, params)
        self.program = gpu.program("studio/screen.vert", finding, generated={
            "generated/paths.glsl": paths.constants, "generated/look.glsl": lambda: look_constants(params)})
        self.params = params
        self._found = gpu.vertex_array(self.program)

    def find(self) -> None:
        """Follow the particles and the parameters."""
        self.pool.bind(self.program)
        self.paths.bind(self.program, PATHS_UNIT)
        self.table.prepare()
        self.bind_table(self.program)
        self.program["u_colouring_range"] = colouring_range(self.params)
        with drawing_at(self.gpu, self.target, (0, 0), (self.pool.width, self.pool.rows)):
            self._found.render(vertices=3)

    def bind(self, program: Program, first_unit: int) -> None:
        """Let ``program`` read what was found."""
        for unit, (name, texture) in enumerate(self._textures.items(), first_unit):
            texture.use(unit)
            program[f"u_{name}"] = unit

    def bind_table(self, program: Program) -> None:
        """Let ``program`` read ``particles/life_color.glsl``'s table of what changes over a life."""
        self.table.texture.use(TABLE_UNIT)
        program["u_table"] = TABLE_UNIT


def trail_bytes(params: Any) -> int:
    """What trails or strands take for each particle, in bytes: what a system is told that comes beside it."""
    if params.strands:
        return Paths.bytes_per_particle(params.strand_points) + 3 * 16 + 5 * 16
    return Paths.bytes_per_particle(params.trail_points - 1) + 3 * 16 if params.trail_length > 0.0 else 0
