"""The slots that particles live in: textures on the GPU, and here who lives where."""

from __future__ import annotations

import math
from dataclasses import dataclass

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.fields import ParameterError
from viewer.engine.gpu import Gpu
from viewer.engine.program import Program

LASTING = ("nature", "origin", "launch")        # written when a particle is born
MOVING = ("motion", "velocity")                 # written in each step, from one texture into another
BYTES_PER_PARTICLE = 16 * (len(LASTING) + 2 * len(MOVING)) + 2 + 2 + 1 + 8 + 4
LIVES, DIED, STRUCK, CHILDREN_SHIFT = 1, 2, 4, 3    # of a status, see particles/step.frag


@dataclass(frozen=True)
class PoolSnapshot:
    """All that lives at a moment: texels by texture, and who they are."""

    used: int
    texels: dict[str, NDArray[np.float32]]
    alive: NDArray[np.bool_]
    serial: NDArray[np.int64]
    begun: NDArray[np.int32]

    @property
    def nbytes(self) -> int:
        """How much memory it takes."""
        arrays = (*self.texels.values(), self.alive, self.serial, self.begun)
        return sum(array.nbytes for array in arrays)


class Pool:
    """``capacity`` slots, ``width`` in a row of the textures, the lowest free ones taken first.

    ``used`` slots have been taken at one time or another; only their rows are computed. ``alive`` (capacity,)
    bool, ``serial`` (capacity,) int64, the number that stays with a particle, and ``begun`` (capacity,) int32, the
    step that it was born in, tell who lives where.
    """

    def __init__(self, gpu: Gpu, capacity: int, bytes_beside: int = 0) -> None:
        check_memory(capacity, bytes_beside)
        self.gpu, self.capacity = gpu, capacity
        self.width: int = 2 ** math.ceil(math.log2(max(16.0, math.sqrt(capacity))))
        self.height: int = -(-capacity // self.width)
        self.used = 0
        self.alive = np.zeros(capacity, bool)
        self.serial = np.zeros(capacity, np.int64)
        self.begun = np.zeros(capacity, np.int32)
        self._status = np.zeros(self.width * self.height, np.uint16)
        self._build()
        self.clear()

    def _build(self) -> None:
        size = self.width, self.height
        self.lasting = {name: self.gpu.texture(size, 4, dtype="f4", label=f"particles' {name}") for name in LASTING}
        self._sides = [{name: self.gpu.texture(size, 4, dtype="f4", label=f"particles' {name}") for name in MOVING}
                       for _ in range(2)]
        status = self.gpu.texture(size, 1, dtype="u2", label="particles' status")
        self._stepping = [self.gpu.framebuffer([*side.values(), status], label="step") for side in self._sides]
        self._settling = [self.gpu.framebuffer([*side.values(), *self.lasting.values()], label="settle")
                          for side in self._sides]

    @property
    def textures(self) -> dict[str, moderngl.Texture]:
        """The textures by name, as they now are."""
        return {**self._sides[0], **self.lasting}

    @property
    def rows(self) -> int:
        """How many rows of the textures are in use."""
        return -(-self.used // self.width)

    @property
    def alive_count(self) -> int:
        """How many particles live."""
        return int(np.count_nonzero(self.alive[:self.used]))

    @property
    def settling(self) -> moderngl.Framebuffer:
        """The framebuffer that newborns are drawn into, slot by slot."""
        return self._settling[0]

    @property
    def stepping(self) -> moderngl.Framebuffer:
        """The framebuffer that a step is drawn into; ``turn`` makes it the present state."""
        return self._stepping[1]

    def bind(self, program: Program, names: tuple[str, ...] = (*MOVING, *LASTING), first_unit: int = 0) -> None:
        """Let ``program`` read the textures ``names`` as ``u_motion`` and so on."""
        textures = self.textures
        for unit, name in enumerate(names, first_unit):
            textures[name].use(unit)
            program[f"u_{name}"] = unit

    def turn(self) -> NDArray[np.uint16]:
        """Make what was stepped the present; returns the status of each used slot."""
        self._sides.reverse()
        self._stepping.reverse()
        self._settling.reverse()
        taken = self.rows * self.width
        if taken:
            self._stepping[0].read_into(self._status, (0, 0, self.width, self.rows), 1, attachment=2, alignment=1,
                                        dtype="u2")
        return self._status[:self.used]

    def take(self, number: int) -> NDArray[np.uint32]:
        """The lowest free slots, at most ``number``, as theirs who are born now."""
        free = np.flatnonzero(~self.alive[:self.used])[:number] if self.used else np.empty(0, np.intp)
        fresh = np.arange(self.used, min(self.capacity, self.used + number - len(free)))
        self.used += len(fresh)
        slots = np.concatenate([free, fresh]).astype(np.uint32)
        self.alive[slots] = True
        return slots

    def clear(self) -> None:
        """Nobody lives any more."""
        self.used = 0
        self.alive[:] = False
        for framebuffer in (*self._stepping, *self._settling):
            framebuffer.viewport = (0, 0, self.width, self.height)
            framebuffer.clear()

    def read(self, *names: str) -> dict[str, NDArray[np.float32]]:
        """The texels of the used slots, (used, 4) each."""
        return {name: self._rows_of(name)[:self.used] for name in names}

    def at(self, slot: int) -> dict[str, NDArray[np.float32]]:
        """The texels of one slot, (4,) each, by texture."""
        texels = {name: np.empty(4, np.float32) for name in (*MOVING, *LASTING)}
        place = slot % self.width, slot // self.width
        for attachment, texel in enumerate(texels.values()):
            self._settling[0].read_into(texel, (*place, 1, 1), 4, attachment=attachment, alignment=1, dtype="f4")
        return texels

    def snapshot(self) -> PoolSnapshot:
        """All that lives, to be put back by ``restore``."""
        texels = {name: self._rows_of(name) for name in (*MOVING, *LASTING)}
        taken = slice(self.used)
        return PoolSnapshot(self.used, texels, self.alive[taken].copy(), self.serial[taken].copy(),
                            self.begun[taken].copy())

    def restore(self, snapshot: PoolSnapshot) -> None:
        """Put everything back to what it was."""
        self.clear()
        self.used = snapshot.used
        self.alive[:self.used], self.serial[:self.used] = snapshot.alive, snapshot.serial
        self.begun[:self.used] = snapshot.begun
        for name, texels in snapshot.texels.items():
            if len(texels):
                self.textures[name].write(texels, (0, 0, self.width, self.rows))

    def _rows_of(self, name: str) -> NDArray[np.float32]:
        texels = np.empty((self.rows * self.width, 4), np.float32)
        if len(texels):
            attachment = (*MOVING, *LASTING).index(name)
            self._settling[0].read_into(texels, (0, 0, self.width, self.rows), 4, attachment=attachment, alignment=1,
                                        dtype="f4")
        return texels


def check_memory(capacity: int, bytes_beside: int = 0) -> None:
    """Raise ParameterError where ``capacity`` particles do not fit into what memory is free."""
    import psutil

    needed = capacity * (BYTES_PER_PARTICLE + bytes_beside)
    free = psutil.virtual_memory().available
    if needed > 0.8 * free:
        raise ParameterError(f"count = {capacity} needs about {needed / 2**30:.1f} GiB of memory and "
                             f"{free / 2**30:.1f} GiB are free; about {int(0.8 * free / needed * capacity)} would fit")

