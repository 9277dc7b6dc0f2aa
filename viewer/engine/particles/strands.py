"""Strands: hair, fur and grass, each the path of a particle's whole life (Reeves 1983, Reeves and Blau 1985)."""

from __future__ import annotations

from collections.abc import Hashable
from typing import Any

import numpy as np

from viewer.engine.gpu import Gpu
from viewer.engine.matrices import Matrix
from viewer.engine.particles.paths import EVER, NEVER, Paths, drawing_at
from viewer.engine.particles.pool import MOVING
from viewer.engine.particles.ribbons import Ribbons
from viewer.engine.particles.system import ParticleSystem
from viewer.engine.particles.trails import PATHS_UNIT, REACH_UNIT, Reach
from viewer.engine.program import Program
from viewer.engine.shadow import DEPTH_SIZE

SHADOW_POINTS, FEWEST_POINTS = 6, 5     # are enough for a shadow, and for a strand that is short in the picture
SHORTEST = 10.0                         # pixels: how long a piece of a strand between two points at least is
SLOPE_TO_HEIGHT = 1.6                   # the picture's height, for a slope of 1, about


class Strands:
    """Lets the particles of ``system``, which hold still, live through their lives as if all at this moment.

    A scene that shows them sets ``system.holds_still``, calls ``prepare`` before each picture and ``draw`` in its own.
    Points that would lie closer in the picture than an eye tells apart are left out of the drawing.
    """

    def __init__(self, gpu: Gpu, system: ParticleSystem, params: Any) -> None:
        self.gpu, self.system, self.params, self.pool = gpu, system, params, system.pool
        self.points: int = params.strand_points
        self.paths = Paths(gpu, self.pool, self.points)
        self.reach = Reach(gpu, self.paths, "particles/strand_reach.frag", params)
        self._root = gpu.program("studio/screen.vert", "particles/strand_root.frag")
        self._rooted = gpu.vertex_array(self._root)
        self._build_sides()
        self._shadow_apart = max(1, (self.points - 1) // (SHADOW_POINTS - 1))
        self._ribbons: dict[tuple[int, bool], Ribbons] = {}
        self._slope = np.inf    # how long a strand is, over its distance from the camera
        self._grown: Hashable = None
        self._reached: Hashable = None
        self.passes = 0         # how often strands grew anew

    def prepare(self, view: Matrix) -> None:
        """Let all strands grow, unless nothing has changed; ``view`` takes the world to the camera."""
        if not self.pool.rows:
            return
        forces, system = self.system.forces, self.system
        system.motion.seconds = system.seconds
        swirls = self.params.turbulence > 0.0 and self.params.turbulence_pace > 0.0
        moved = bool(swirls or (forces.has_drag and self.params.wind and self.params.gusts))
        key = (system.steered_by(), system.nursery.born, system.pool.alive_count, self.gpu.generation,
               system.seconds if moved else None)
        if key != self._grown:
            self._grow()
            self._grown = key
        if (key, self.params.revision) != self._reached:
            self.reach.find()
            self._reached = key, self.params.revision
        away = float(np.linalg.norm(np.array([0.0, self.params.emitter_height, 0.0, 1.0]) @ view[:, :3]))
        self._slope = self._common_length() / max(away, 1e-6)

    def draw(self) -> None:
        """Draw all strands, or their shadow."""
        if self.pool.rows:
            casting = self.gpu.casting_shadows
            self._ribbons_for(self._shadow_apart if casting else self._apart(), casting).draw(self._bind)

    def _grow(self) -> None:
        self.passes += 1
        pool, size = self.pool, (self.pool.width, self.pool.rows)
        self._root["u_part"] = 1.0 / (self.points - 1)
        pool.bind(self._root)
        with drawing_at(self.gpu, self._rooting, (0, 0), size):
            self._rooted.render(vertices=3)
        lasting = {name: pool.textures[name] for name in ("nature", "launch")} | {"origin": self._origin}
        for point in range(self.points):
            now, then = point % 2, (point + 1) % 2
            self.paths.note(point, {"motion": self._sides[now]["motion"], **lasting}, EVER if point else NEVER)
            if point + 1 < self.points:
                self.system.motion.step_newborns({**self._sides[now], **lasting}, self._steps[then], size)

    def _bind(self, program: Program) -> None:
        self.pool.bind(program, ("launch",))
        self.paths.bind(program, PATHS_UNIT)
        self.reach.bind(program, REACH_UNIT)
        self.reach.bind_table(program)

    def _build_sides(self) -> None:
        """Two states to step between, as a pool has them."""
        gpu, size = self.gpu, (self.pool.width, self.pool.height)
        self._sides = [{name: gpu.texture(size, 4, dtype="f4", label=f"strands' {name}") for name in MOVING}
                       for _ in range(2)]
        self._origin = gpu.texture(size, 4, dtype="f4", label="strands' origin")
        status = gpu.texture(size, 1, dtype="u2", label="strands' status")
        self._rooting = gpu.framebuffer([*self._sides[0].values(), self._origin], label="strands' roots")
        self._steps = [gpu.framebuffer([*side.values(), status], label="strands' step") for side in self._sides]

    def _common_length(self) -> float:
        """About how long strands are, in metres."""
        way = float(np.mean(self.params.speed) * np.mean(self.params.lifetime))
        return min(way, self.params.trail_length) if self.params.trail_length else way

    def _apart(self) -> int:
        """Every how many points one is drawn."""
        pixels = SLOPE_TO_HEIGHT * self.gpu.context.fbo.height * self._slope
        wanted = int(min(SHORTEST * (self.points - 1) / max(pixels, 1e-6), self.points))
        return max(1, min(wanted, (self.points - 1) // (FEWEST_POINTS - 1)))

    def _ribbons_for(self, apart: int, casting: bool) -> Ribbons:
        if (apart, casting) not in self._ribbons:
            self._ribbons[apart, casting] = self._made_ribbons(apart, casting)
        return self._ribbons[apart, casting]

    def _made_ribbons(self, apart: int, casting: bool) -> Ribbons:
        constants = (f"const bool CASTING = {str(casting).lower()};\nconst int POINTS_APART = {apart};\n"
                     f"const float SHADOW_PIXELS = {DEPTH_SIZE:.1f}, THINNEST = {1.5 if casting else 0.9};\n")
        points = -(-(self.points - 1) // apart) + 1
        return Ribbons(self.gpu, self.pool, points, "particles/strand_ribbon.frag", "particles/strand.frag", {
            "generated/paths.glsl": self.paths.constants, "generated/strand.glsl": lambda: constants})
