"""How particles come into the world: made in a batch of their own, stepped to the frame's end, put into their slots."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.field_samples import drawing_into
from viewer.engine.gpu import Gpu
from viewer.engine.particles.emitter import Emitter
from viewer.engine.particles.motion import Motion
from viewer.engine.particles.pool import LASTING, LIVES, MOVING, Pool
from viewer.engine.particles.schedule import Births

BATCH_WIDTH = 256
BATCH = BATCH_WIDTH * BATCH_WIDTH
PARENT_UNIT, EMITTER_UNIT, COLLIDER_UNIT = 5, 6, 9


@dataclass(frozen=True)
class Newborn:
    """Who was born: their slots, and the status that each has at the end of the step."""

    slots: NDArray[np.uint32]
    status: NDArray[np.uint16]

    @property
    def alive(self) -> NDArray[np.bool_]:
        """Who of them lives still."""
        return (self.status & LIVES).astype(bool)


class Nursery:
    """Makes newborns with ``birth.frag``, lets ``motion`` step them, and settles them in ``pool``."""

    def __init__(self, gpu: Gpu, pool: Pool, motion: Motion, emitter: Emitter, seed: int) -> None:
        self.gpu, self.pool, self.motion, self.emitter, self.seed = gpu, pool, motion, emitter, seed
        self.born = 0       # ever
        self._batch = self._textures((*MOVING, *LASTING))
        self._stepped = self._textures(MOVING)
        size = BATCH_WIDTH, BATCH_WIDTH
        self._parents = gpu.texture(size, 1, dtype="u4", label="parents")
        status = gpu.texture(size, 1, dtype="u2", label="newborns' status")
        self._bearing = gpu.framebuffer(list(self._batch.values()), label="newborns")
        self._stepping = gpu.framebuffer([*self._stepped.values(), status], label="newborns' first step")
        for framebuffer in (self._bearing, self._stepping):
            framebuffer.clear()
        self._slots = gpu.buffer(reserve=4 * BATCH, label="newborns' slots")
        self._birth = gpu.program("studio/screen.vert", "particles/birth.frag", generated={
            "generated/emitter.glsl": emitter.constants, **motion.collider_constants})
        self._bear = gpu.vertex_array(self._birth)
        self._settler = gpu.program("particles/settle.vert", "particles/settle.frag")
        self._settle = gpu.vertex_array(self._settler, [(self._slots, "1u", "in_slot")], mode=moderngl.POINTS)
        self._status = np.zeros(BATCH, np.uint16)
        self._birth["u_seed"] = (seed * 0x9E3779B9 + (seed >> 32)) & 0xFFFFFFFF

    def from_emitter(self, births: Births, wave_reach: float) -> Iterator[Newborn]:
        """Births as the schedule has them; fewer where there is no room."""
        self._birth["u_wave_reach"] = wave_reach
        for start in range(0, births.number, BATCH):
            lived, number = births.lived - start * births.between, min(BATCH, births.number - start)
            some = self._one_batch(number, lived, births.between)
            yield some
            if len(some.slots) < number:
                break

    def from_parents(self, parents: NDArray[np.uint32]) -> Iterator[Newborn]:
        """A child for each slot in ``parents``."""
        for start in range(0, len(parents), BATCH):
            some = parents[start:start + BATCH]
            rows = -(-len(some) // BATCH_WIDTH)
            padded = np.zeros(rows * BATCH_WIDTH, np.uint32)
            padded[:len(some)] = some
            self._parents.write(padded, (0, 0, BATCH_WIDTH, rows))
            yield self._one_batch(len(some), 0.0, 0.0, from_parents=True)

    def _one_batch(self, number: int, lived: float, between: float, *, from_parents: bool = False) -> Newborn:
        slots = self.pool.take(number)
        if not len(slots):
            return Newborn(slots, np.empty(0, np.uint16))
        self._bear_them(len(slots), lived, between, from_parents)
        status = self._step_them(len(slots))
        self._settle_them(slots)
        self.pool.serial[slots] = np.arange(self.born, self.born + len(slots))
        self.born += len(slots)
        return Newborn(slots, status)

    def _bear_them(self, number: int, lived: float, between: float, from_parents: bool) -> None:
        program = self._birth
        values: dict[str, Any] = {
            "u_count": number, "u_first_lived": lived, "u_between": between, "u_from_parents": from_parents,
            "u_serial": self.born & 0xFFFFFFFF, "u_width": self.pool.width, "u_batch_width": BATCH_WIDTH,
            "u_step": self.motion.step_seconds, "u_parents": PARENT_UNIT}
        for name, value in values.items():
            program[name] = value
        self.pool.bind(program)
        self._parents.use(PARENT_UNIT)
        self.emitter.bind(program, EMITTER_UNIT)
        self.motion.colliders.bind(program, COLLIDER_UNIT)
        with drawing_into(self.gpu, self._bearing, (BATCH_WIDTH, -(-number // BATCH_WIDTH))):
            self._bear.render(vertices=3)

    def _step_them(self, number: int) -> NDArray[np.uint16]:
        rows = -(-number // BATCH_WIDTH)
        self.motion.step_newborns(self._batch, self._stepping, (BATCH_WIDTH, rows))
        self._stepping.read_into(self._status, (0, 0, BATCH_WIDTH, rows), 1, attachment=2, alignment=1, dtype="u2")
        return self._status[:number].copy()

    def _settle_them(self, slots: NDArray[np.uint32]) -> None:
        self._slots.write(slots)
        for unit, (name, texture) in enumerate({**self._batch, **self._stepped}.items()):
            texture.use(unit)
            self._settler[f"u_{name}"] = unit
        self._settler["u_batch_width"] = BATCH_WIDTH
        self._settler["u_slots"] = (self.pool.width, self.pool.height)
        with drawing_into(self.gpu, self.pool.settling, (self.pool.width, self.pool.height)):
            self._settle.render(vertices=len(slots))

    def _textures(self, names: tuple[str, ...]) -> dict[str, Any]:
        size = BATCH_WIDTH, BATCH_WIDTH
        return {name: self.gpu.texture(size, 4, dtype="f4", label=f"newborns' {name}") for name in names}
