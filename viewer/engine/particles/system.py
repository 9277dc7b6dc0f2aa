"""A particle system: what a scene steps, draws, measures and exports."""

from __future__ import annotations

import time
from collections.abc import Hashable, Iterator
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from viewer.engine.clock import FRAME_SECONDS
from viewer.engine.file_stamp import file_stamp
from viewer.engine.gpu import Gpu
from viewer.engine.particles.births import Newborn, Nursery
from viewer.engine.particles.cascade import FAMILIES, CascadeParameters, has_children
from viewer.engine.particles.colliders import ColliderParameters, Colliders
from viewer.engine.particles.emitter import Emitter
from viewer.engine.particles.forces import ForceParameters, Forces
from viewer.engine.particles.motion import Motion
from viewer.engine.particles.pool import CHILDREN_SHIFT, DIED, LASTING, LIVES, MOVING, STRUCK, Pool, PoolSnapshot
from viewer.engine.particles.qualities import EmissionParameters, QualityParameters
from viewer.engine.particles.schedule import Births, Schedule, ScheduleState
from viewer.engine.particles.tally import Tally
from viewer.engine.rewind import Snapshot
from viewer.engine.scene import Curve, Geometry


class ParticleParameters(EmissionParameters, QualityParameters, ForceParameters, ColliderParameters,
                         CascadeParameters):
    """All that decides how particles move."""


SHOWING = ("show_emitter", "emitter_color", "obstacle_color", "spin", "hue", "brightness",
           *(f"{family}_color" for family in FAMILIES))     # these change the picture alone
STEERING = tuple(name for name in ParticleParameters.declared if name not in SHOWING)


class Companion(Protocol):
    """What remembers something of the particles from step to step, as trails do, and goes back in time with them."""

    def begin(self) -> None:
        """Nothing has happened yet."""

    def follow(self) -> None:
        """The system has made a step."""

    def snapshot(self) -> Snapshot:
        """All that is remembered."""

    def restore(self, snapshot: Any) -> None:
        """Remember again what was remembered then."""


@dataclass(frozen=True)
class SystemSnapshot:
    """All that the future of a system follows from."""

    pool: PoolSnapshot
    schedule: ScheduleState
    tally: Tally
    born: int
    steps: int
    fastest: float
    companions: tuple[Snapshot, ...]

    @property
    def nbytes(self) -> int:
        """How much memory it takes, about."""
        return self.pool.nbytes + 32 * len(self.tally.live) + sum(one.nbytes for one in self.companions)


class ParticleSystem:
    """Particles that live on the GPU. They do not feel each other: what each does follows from its birth alone.

    ``companions`` follow each step. Where ``holds_still`` nobody moves or ages, as for hair, whose roots they are.
    """

    def __init__(self, gpu: Gpu, params: Any, bytes_beside: int = 0) -> None:
        self.gpu, self.params = gpu, params
        self.pool = Pool(gpu, params.count, bytes_beside)
        self.emitter = Emitter(gpu, params)
        self.colliders = Colliders(gpu, params)
        self.emitter.prepare()
        self.colliders.prepare()        # how thin they are decides how the step shader looks at them
        self.forces = Forces(params)
        self.motion = Motion(gpu, self.forces, self.colliders, FRAME_SECONDS)
        self.schedule, self.tally, self.steps = Schedule(params), Tally(), 0
        self.nursery = Nursery(gpu, self.pool, self.motion, self.emitter, params.seed)
        self.companions: list[Companion] = []
        self.holds_still = False
        self.step_ms = 0.0
        self._key: tuple[int, tuple[object, ...]] = -1, ()
        self._warm_steps: int = round(params.warm_up / FRAME_SECONDS)
        self._begun_with: Hashable = None
        self._standing = self._colliders_stand()

    @property
    def seconds(self) -> float:
        """Scene time at the end of the last step."""
        return (self.steps - self._warm_steps) * FRAME_SECONDS

    def prepare(self) -> None:
        """Follow the parameters; raises a DemoscopeError where a file or a formula is at fault."""
        self.emitter.prepare()
        probes = self.motion.probes
        self.colliders.prepare()
        if self.motion.probes != probes:
            self.gpu.refresh()

    def steered_by(self) -> Hashable:
        """The values of all parameters that decide how particles move, and which files they name."""
        if self.params.revision != self._key[0]:
            values = tuple(str(self.params.field(name).stored(self.params.get(name))) for name in STEERING)
            numbers = self.params.numbers(self.params.obstacle_formula)
            self._key = self.params.revision, (*values, *numbers.items())
        obstacle = self.params.obstacle_file if self.params.obstacle == "mesh" else None
        return self._key[1], self.emitter.stamp, file_stamp(obstacle) if obstacle else None

    def begin(self) -> None:
        """Stand at the beginning, as the parameters now are: the first burst, and what warming up brings.

        A scene calls it once its companions are there, and again whenever it stands ``at_beginning``; it does
        nothing where the parameters that count have not changed since.
        """
        key = self.steered_by()
        if key == self._begun_with:
            return
        self.pool.clear()
        self.schedule, self.tally, self.steps, self.nursery.born = Schedule(self.params), Tally(), 0, 0
        self.motion.seconds = self.seconds
        self._reckon_with(self.motion.greatest_speed())
        for companion in self.companions:
            companion.begin()
        self._enter(self._emitted(self.schedule.first()))
        for _ in range(self._warm_steps):
            self.update()
        self.tally.live = [self.pool.alive_count]
        self._begun_with = key

    @property
    def at_beginning(self) -> bool:
        """Whether nothing has moved since frame 0."""
        return self.steps == self._warm_steps

    def update(self) -> None:
        """Go on by one frame."""
        started = time.perf_counter()
        self.prepare()
        self.steps += 1
        self.motion.seconds = self.seconds
        status = self._stepped()
        before, lives = len(status), (status & LIVES).astype(bool)
        self.tally.died += int(np.count_nonzero(status & DIED))
        self.tally.collisions += int(np.count_nonzero(status & STRUCK))
        children = list(self._children(self._broods(None, status)))
        self.pool.alive[:before] = lives        # only now are the slots of the dead free, whose children are born
        self._enter(children)
        self._enter(self._emitted(self._due()))
        self.tally.live.append(self.pool.alive_count)
        for companion in self.companions:
            companion.follow()
        self.step_ms = 1e3 * (time.perf_counter() - started)

    def snapshot(self) -> SystemSnapshot:
        """All that the future follows from, to be put back by ``restore``."""
        companions = tuple(companion.snapshot() for companion in self.companions)
        return SystemSnapshot(self.pool.snapshot(), self.schedule.state(), self.tally.copy(), self.nursery.born,
                              self.steps, self.motion.fastest, companions)

    def restore(self, snapshot: SystemSnapshot) -> None:
        """Go back to a moment."""
        self.pool.restore(snapshot.pool)
        self._reckon_with(snapshot.fastest)
        self.schedule.restore(snapshot.schedule)
        self.tally, self.nursery.born, self.steps = snapshot.tally.copy(), snapshot.born, snapshot.steps
        for companion, kept in zip(self.companions, snapshot.companions, strict=True):
            companion.restore(kept)

    def arrays(self) -> Geometry:
        """The living, in the order of their slots: position and velocity (n, 3), the rest (n,)."""
        alive = np.flatnonzero(self.pool.alive[:self.pool.used])
        texels = {name: rows[alive] for name, rows in self.pool.read(*MOVING, *LASTING).items()}
        nature = texels["nature"]
        # Counted in steps: what a long life has left to live, in single precision, would be off by ever more.
        steps = np.zeros(len(alive)) if self.holds_still else self.steps - self.pool.begun[alive]
        age = (steps * FRAME_SECONDS + texels["origin"][:, 3]).astype(np.float32)
        return {
            "position": texels["motion"][:, :3].copy(), "velocity": texels["velocity"][:, :3].copy(),
            "age": np.minimum(age, nature[:, 0]), "life": nature[:, 0].copy(), "size": nature[:, 1].copy(),
            "mass": nature[:, 2].copy(), "generation": texels["launch"][:, 3].astype(np.int32),
            "seed": self.pool.serial[alive]}

    def energies(self, arrays: Geometry) -> tuple[float, float, float]:
        """Kinetic and potential energy in joules, and the greatest speed in m/s, of ``arrays``."""
        velocity, mass = arrays["velocity"].astype(np.float64), arrays["mass"].astype(np.float64)
        squared = (velocity**2).sum(axis=1)
        potential = self.forces.potential_energy(arrays["position"].astype(np.float64), mass)
        return float(0.5 * mass @ squared), float(potential.sum()), float(np.sqrt(squared.max(initial=0.0)))

    def live_count(self) -> Curve:
        """How many particles were alive at each frame so far."""
        seconds = FRAME_SECONDS * np.arange(len(self.tally.live))
        return Curve("time", seconds, {"alive": self.tally.live}, x_label="time (s)", y_label="particles alive")

    def _reckon_with(self, fastest: float) -> None:
        """Nobody who now lives is faster: what may pass through a collider in a step is looked at more closely."""
        if fastest != self.motion.fastest:
            self.motion.fastest = fastest
            self.gpu.refresh()

    def _stepped(self) -> NDArray[np.uint16]:
        """The status of each slot after everyone has moved on."""
        if self.holds_still:
            return self.pool.alive[:self.pool.used].astype(np.uint16) * LIVES
        if self._standing != self._colliders_stand() and self.pool.used:
            self.motion.free(self.pool)
            self.pool.turn()
        self._standing = self._colliders_stand()
        self.motion.step(self.pool)
        return self.pool.turn() if self.pool.used else np.empty(0, np.uint16)

    def _colliders_stand(self) -> Hashable:
        """Everything about where there are colliders."""
        p = self.params
        return self.colliders.generation, p.ground, p.ground_height, p.ground_tilt, p.hollow

    def _due(self) -> list[Births]:
        births = self.schedule.due(FRAME_SECONDS)
        return [Births(due.number, 0.0) for due in births] if self.holds_still else births

    def _emitted(self, births: list[Births]) -> list[Newborn]:
        """Those from the emitter, and their children."""
        newborn: list[Newborn] = []
        for due in births:
            emitted = 0
            for some in self.nursery.from_emitter(due, self._wave_reach()):
                emitted += len(some.slots)
                newborn.append(some)
                newborn.extend(self._children(self._broods(some.slots, some.status)))
            self.tally.emitted += emitted
            self.tally.refused += due.number - emitted
        return newborn

    def _enter(self, newborn: list[Newborn]) -> None:
        """Write down who was born in a step, and whether they live still."""
        for some in newborn:
            self.pool.alive[some.slots] = some.alive
            self.pool.begun[some.slots] = self.steps
            self.tally.died += len(some.slots) - int(np.count_nonzero(some.alive))
            self.tally.stillborn += len(some.slots) - int(np.count_nonzero(some.status))
            self.tally.collisions += int(np.count_nonzero(some.status & STRUCK))

    def _children(self, parents: NDArray[np.uint32]) -> Iterator[Newborn]:
        """A child for each slot in ``parents``, and what comes from those before the step is over."""
        borne = 0
        for some in self.nursery.from_parents(parents):
            borne += len(some.slots)
            yield some
            yield from self._children(self._broods(some.slots, some.status))
        self.tally.children += borne
        self.tally.refused += len(parents) - borne

    def _wave_reach(self) -> float:
        """How far the emitting wave has come, in metres; -1 where there is none."""
        return float(self.params.wave_speed * self.schedule.seconds) if self.params.rides_wave else -1.0

    def _broods(self, slots: NDArray[np.uint32] | None, status: NDArray[np.uint16]) -> NDArray[np.uint32]:
        """The slot of a parent for each child that is due, by ``status``."""
        if not has_children(self.params):
            return np.empty(0, np.uint32)
        brooding = np.flatnonzero(status >> CHILDREN_SHIFT)
        who = brooding if slots is None else slots[brooding]
        until = np.cumsum(status[brooding] >> CHILDREN_SHIFT, dtype=np.int64)
        room = self.pool.capacity - int(np.count_nonzero(self.pool.alive))
        self.tally.refused += max(0, int(until[-1]) - room) if len(until) else 0
        return np.repeat(who, np.diff(np.minimum(until, room), prepend=0)).astype(np.uint32)
