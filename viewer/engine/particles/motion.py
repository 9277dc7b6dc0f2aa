"""One step of all particles, or of those just born."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import moderngl

from viewer.engine.field_samples import drawing_into
from viewer.engine.gpu import Gpu
from viewer.engine.particles.cascade import FAMILIES, cascade_constants, has_children, moments
from viewer.engine.particles.colliders import Colliders
from viewer.engine.particles.forces import Forces
from viewer.engine.particles.pool import MOVING, Pool
from viewer.engine.program import Program, VertexArray

COLLIDER_UNIT = 5
MOST_PROBES = 1024


class Motion:
    """Draws ``step.frag`` over the slots in use; forces and colliders say what it has to reckon with."""

    def __init__(self, gpu: Gpu, forces: Forces, colliders: Colliders, step_seconds: float) -> None:
        self.gpu, self.forces, self.colliders, self.step_seconds = gpu, forces, colliders, step_seconds
        self.params = forces.params
        self.fastest = self.greatest_speed()    # that anyone may have who now lives
        self.collider_constants: Mapping[str, Callable[[], str]] = {"generated/collider.glsl": colliders.constants}
        self._all = self._program(newborn=False)
        self._newborn = self._program(newborn=True)
        self._step_all: VertexArray = gpu.vertex_array(self._all)
        self._step_newborn: VertexArray = gpu.vertex_array(self._newborn)
        self._freeing: VertexArray | None = None
        self.seconds = 0.0      # scene time at the end of the step

    def step(self, pool: Pool) -> None:
        """Make the next state of every used slot in ``pool``, which then has to ``turn``."""
        if not pool.rows:
            return
        self._set(self._all)
        pool.bind(self._all)
        self._render(self._step_all, pool.stepping, (pool.width, pool.rows))

    def step_newborns(self, batch: Mapping[str, moderngl.Texture], target: moderngl.Framebuffer,
                      size: tuple[int, int]) -> None:
        """The same for a ``batch`` of textures by name, each for as much of the step as it has lived."""
        self._set(self._newborn)
        for unit, (name, texture) in enumerate(batch.items()):
            texture.use(unit)
            self._newborn[f"u_{name}"] = unit
        self._render(self._step_newborn, target, size)

    def free(self, pool: Pool) -> None:
        """Push everyone out of colliders that have moved, into the next state; then ``pool`` has to ``turn``."""
        if self._freeing is None:
            program = self.gpu.program("studio/screen.vert", "particles/free.frag", generated=self.collider_constants)
            self._freeing = self.gpu.vertex_array(program)
        pool.bind(self._freeing.program, MOVING)
        self._render(self._freeing, pool.stepping, (pool.width, pool.rows))

    def _render(self, array: VertexArray, target: moderngl.Framebuffer, size: tuple[int, int]) -> None:
        self.colliders.bind(array.program, COLLIDER_UNIT)
        with drawing_into(self.gpu, target, size):
            array.render(vertices=3)

    def greatest_speed(self) -> float:
        """Nobody who is born with the present parameters is ever faster, in m/s."""
        p: Any = self.params
        born = ["", *(f"{family}_" for family, when in zip(FAMILIES, moments(p), strict=True) if when != "never")]
        launch = sum(p.get(f"{family}speed")[1] for family in born)
        life = sum(p.get(f"{family}lifetime")[1] for family in born)
        acceleration = self.forces.greatest_acceleration()
        slowest = p.drag[0] / p.mass[1]     # how fast, at least, the air takes speed away
        return float(launch + acceleration * (min(life, 1.0 / slowest) if slowest else life))

    def _set(self, program: Program) -> None:
        self.fastest = max(self.fastest, self.greatest_speed())
        self.forces.apply(program, self.seconds - 0.5 * self.step_seconds)
        program["u_step"] = self.step_seconds
        program["u_thinnest"] = self.colliders.thinnest
        program["u_common_mass"] = self.params.get("mass")[0]
        program["u_common_drag"] = self.params.get("drag")[0]

    def _program(self, *, newborn: bool) -> Program:
        return self.gpu.program("studio/screen.vert", "particles/step.frag", generated={
            "generated/forces.glsl": self.forces.constants, **self.collider_constants,
            "generated/cascade.glsl": lambda: cascade_constants(self.params),  # type: ignore[arg-type]
            "generated/step.glsl": lambda: self._constants(newborn)})

    def _constants(self, newborn: bool) -> str:
        """The include ``generated/step.glsl``."""
        varied = any(low != high for low, high in (self.params.get("mass"), self.params.get("drag")))
        flags = {"NEWBORN": newborn, "VARIED": varied, "CASCADES": has_children(self.params),  # type: ignore[arg-type]
                 "MAY_PASS_THROUGH": self.probes > 0}
        lines = [f"const bool {name} = {str(value).lower()};" for name, value in flags.items()]
        return "\n".join([*lines, f"const int MOST_PROBES = {self.probes};", ""])

    @property
    def probes(self) -> int:
        """How often a path has to be looked at, lest one who is so fast jumps over the thinnest collider in a step.

        A power of 2, lest shaders are made anew all the time; 0 where nobody is so fast.
        """
        way = max(self.fastest, self.greatest_speed()) * self.step_seconds
        thinnest = self.colliders.thinnest
        return 0 if way <= thinnest else min(MOST_PROBES, 2 ** math.ceil(math.log2(2.0 * way / thinnest + 2.0)))
