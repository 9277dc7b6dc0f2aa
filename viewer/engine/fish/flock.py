"""A school of fish that swims on the GPU: one fragment each a step, neighbours found through a grid of cells."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from viewer.engine.field_samples import drawing_into
from viewer.engine.gpu import Gpu
from viewer.engine.program import Program
from viewer.engine.scene import Geometry
from viewer.kit import swim_school
from viewer.kit.swim_cells import MOST_CELLS, cell_grid
from viewer.kit.swim_school import BANK, BEND, CELL, COLUMNS, PHASE, PLACE, SIZE, VELOCITY, WILL, SchoolRules

FISH_IN_ROW = 256
CELLS_IN_ROW = 512
TEXEL = np.complex128       # 16 bytes that NumPy moves as one, which is six times as fast as four by four
MOST_IN_RUN = 96            # fish in a row of cells of which each is looked at; of more, every second or third
SHAPE = np.array([1.6, 0.65, 1.1])      # of the tank: along x, y and z
SMALLEST_TANK = 3.0         # metres, before that shape is applied: room to turn around
STARTING_PART = 0.7         # of the tank that is filled at first
CONSTANTS = ("KEEPING_AWAY", "LIKENESS", "SEEKING", "KEEPING_PACE", "LEVELLING", "FORESIGHT", "WALL_BEGINS",
             "WALL_TURNING", "INWARD", "MOST_BEND", "FULL_BANK_RATE")


@dataclass(frozen=True)
class FlockSnapshot:
    """All that the future of a school follows from."""

    state: NDArray[np.float32]
    seconds: float

    @property
    def nbytes(self) -> int:
        """How much memory it takes."""
        return self.state.nbytes


class Flock:
    """``params.school`` fish in an ellipsoid of water around the origin.

    ``state`` (n, 12) float32 is as in ``viewer.kit.swim_school``, fish i staying in row i; ``bind`` gives it to
    programs that include ``fish/pose.glsl``. ``seconds`` is how long they have been swimming. A school of one does not
    move: it is the hero's.
    """

    def __init__(self, gpu: Gpu, params: Any) -> None:
        self.gpu, self.params = gpu, params
        self.count: int = params.school
        rows = 4 * -(-self.count // (4 * FISH_IN_ROW))
        self._padded = np.zeros((rows * FISH_IN_ROW, COLUMNS), np.float32)
        self._sorted = np.zeros_like(self._padded)
        self._texels = texels_of(self.count)
        self._near = np.zeros((MOST_CELLS, 2), np.uint16)
        self._as_seen = np.zeros((rows * FISH_IN_ROW, 4), np.uint32)
        self._read = np.zeros((rows * FISH_IN_ROW, 4), np.float32)
        size = 3 * FISH_IN_ROW, rows
        self._drawn = gpu.texture(size, 4, dtype="f4", label="school")
        self._given = gpu.texture(size, 4, dtype="f4", label="school by cells")
        self._seen = gpu.texture((FISH_IN_ROW, rows), 4, dtype="u4", label="school as others see it")
        self._runs = gpu.texture((CELLS_IN_ROW, MOST_CELLS // CELLS_IN_ROW), 2, dtype="u2", label="cells of a school")
        stepped = [gpu.texture((FISH_IN_ROW, rows), 4, dtype="f4", label=f"school's {noun}")
                   for noun in ("places", "motions", "postures")]
        self._target = gpu.framebuffer(stepped, label="school's step")
        self._program = gpu.program("studio/screen.vert", "fish/flock.frag", generated={
            "generated/flock.glsl": flock_constants})
        self._everywhere = gpu.vertex_array(self._program)
        self.seconds = 0.0
        self.state = starting_state(self.count, self.rules, params.fish_size, params.seed)

    @property
    def state(self) -> NDArray[np.float32]:
        """Where everybody is, (n, 12); setting it puts them elsewhere."""
        return self._padded[:self.count]

    @state.setter
    def state(self, state: NDArray[Any]) -> None:
        self._padded[:self.count] = state
        self._drawn.write(self._padded)

    @property
    def rules(self) -> SchoolRules:
        """What the school goes by, as the parameters now are."""
        p = self.params
        return SchoolRules(
            half_axes=self.half_axes, separation=p.separation, alignment=p.alignment, cohesion=p.cohesion,
            perception=p.perception, personal_space=p.personal_space * p.perception, wander=p.wander,
            slowest=p.speed[0], fastest=p.speed[1], agility=p.agility, steepest=math.radians(p.steepest_climb),
            most_bank=math.radians(p.bank), turn=math.radians(p.turn), tail_beat_hz=p.tail_beat_hz)

    @property
    def half_axes(self) -> tuple[float, float, float]:
        """Of the ellipsoid that nobody leaves, in metres."""
        water = self.count * self.params.school_room
        radius = max(SMALLEST_TANK, (0.75 * water / (math.pi * float(SHAPE.prod()))) ** (1.0 / 3.0))
        x, y, z = (radius * SHAPE).tolist()
        return x, y, z

    def step(self, dt: float) -> None:
        """Go on by ``dt`` seconds."""
        if self.count == 1:
            return
        rules = self.rules
        order = self._sort(rules)
        self._tell(rules, dt)
        with drawing_into(self.gpu, self._target, self._target.size):
            self._everywhere.render(vertices=3)
        for part in range(3):
            self._target.read_into(self._read, components=4, attachment=part, dtype="f4", alignment=1)
            self._padded.view(TEXEL)[order, part] = self._read.view(TEXEL)[self._texels, 0]
        self._drawn.write(self._padded)
        self.seconds += dt

    def _sort(self, rules: SchoolRules) -> NDArray[np.int64]:
        """Send everybody in the order of the cells they are in, and who is near each cell; returns that order."""
        grid = cell_grid(rules.half_axes, rules.perception)
        order, cells = grid.sort(self.state[:, PLACE])
        own = self._sorted[:self.count]
        np.take(self.state, order, axis=0, out=own, mode="clip")    # without a copy first, as "raise" makes one
        own[:, CELL] = cells
        self._given.write(self._sorted)
        seen = self._as_seen[:self.count]
        seen[:, :2] = packed(own[:, PLACE] / np.array(rules.half_axes, np.float32))
        seen[:, 2:] = packed(own[:, VELOCITY] / np.float32(rules.fastest))
        self._seen.write(self._as_seen)
        rows = -(-grid.count // CELLS_IN_ROW)
        self._near[:grid.count] = grid.runs(cells)
        self._runs.write(self._near[:rows * CELLS_IN_ROW], (0, 0, CELLS_IN_ROW, rows))
        self._program["u_grid_size"] = grid.size[:2]
        return order

    def _tell(self, rules: SchoolRules, dt: float) -> None:
        program = self._program
        for unit, (name, texture) in enumerate((("fish", self._given), ("seen", self._seen), ("runs", self._runs))):
            texture.use(unit)
            program[f"u_{name}"] = unit
        program["u_count"], program["u_seconds"], program["u_step"] = self.count, self.seconds, dt
        program["u_per_perception_squared"] = rules.perception**-2
        program["u_per_personal_space"] = 1.0 / rules.personal_space
        program["u_steepest"] = math.tan(rules.steepest)
        program["u_bending"] = 1.0 - math.exp(-swim_school.BENDING * dt)
        program["u_banking"] = 1.0 - math.exp(-swim_school.BANKING * dt)
        for each in fields(rules):
            program[f"u_school_{each.name}"] = getattr(rules, each.name)

    def bind(self, program: Program, unit: int, species: int = 0, of: int = 1) -> int:
        """Let a program's instances be the fish of one ``species`` ``of`` several, in a texture unit.

        Fish i is of species i modulo ``of``. Returns how many there are: how many instances to draw.
        """
        self._drawn.use(unit)
        program["u_school_state"] = unit
        program["u_fish_first"], program["u_fish_stride"] = species, of
        return len(range(species, self.count, of))

    def snapshot(self) -> FlockSnapshot:
        """All that the future follows from, to be put back by ``restore``."""
        return FlockSnapshot(self.state.copy(), self.seconds)

    def restore(self, snapshot: FlockSnapshot) -> None:
        """Go back to a moment."""
        self.state, self.seconds = snapshot.state, snapshot.seconds

    def arrays(self) -> Geometry:
        """Everybody: position and velocity (n, 3), and (n,) the size, the beat's phase, the bend and the bank."""
        state = self.state
        columns = {"size": SIZE, "phase": PHASE, "bend": BEND, "bank": BANK}
        return {"position": state[:, PLACE].copy(), "velocity": state[:, VELOCITY].copy(),
                **{name: state[:, column].copy() for name, column in columns.items()}}


def flock_constants() -> str:
    """The include ``generated/flock.glsl``: the numbers that the rules in NumPy have too."""
    numbers = {name: getattr(swim_school, name) for name in CONSTANTS}
    lines = [f"const float {name} = {value!r};\n" for name, value in numbers.items()]
    counts = {"FISH_IN_ROW": FISH_IN_ROW, "FISH_ROW_BITS": FISH_IN_ROW.bit_length() - 1,
              "CELLS_IN_ROW": CELLS_IN_ROW, "CELLS_ROW_BITS": CELLS_IN_ROW.bit_length() - 1,
              "MOST_IN_RUN": MOST_IN_RUN}
    return "".join([*lines, *(f"const int {name} = {value};\n" for name, value in counts.items())])


def starting_state(count: int, rules: SchoolRules, sizes: tuple[float, float], seed: int) -> NDArray[np.float32]:
    """``count`` fish in the inner part of the tank, swimming level and each its own way: (count, 12)."""
    random = np.random.default_rng(seed)
    direction = random.normal(size=(count, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    reach = STARTING_PART * np.cbrt(random.random((count, 1)))
    heading = random.uniform(0.0, 2.0 * np.pi, count)
    state = np.zeros((count, COLUMNS), np.float32)
    state[:, PLACE] = reach * direction * np.array(rules.half_axes)
    state[:, VELOCITY] = rules.cruising * np.stack([np.cos(heading), np.zeros(count), np.sin(heading)], axis=1)
    state[:, PHASE] = random.uniform(0.0, 2.0 * np.pi, count)
    state[:, SIZE] = random.uniform(*sizes, count)
    state[:, WILL] = random.uniform(0.0, 2.0 * np.pi, count)
    return state


def texels_of(count: int) -> NDArray[np.intp]:
    """Which texel of a step's target each of ``count`` fish in order comes from, see ``fish_of`` in fish/flock.frag."""
    square, within = np.divmod(np.arange(count), 16)
    row, column = np.divmod(square, FISH_IN_ROW // 4)
    return np.asarray((4 * row + within // 4) * FISH_IN_ROW + 4 * column + within % 4, np.intp)


def packed(numbers: NDArray[np.floating[Any]]) -> NDArray[np.uint32]:
    """Numbers from -1 to 1, (n, 3), as two of 32 bits, (n, 2), for ``unpacked`` in fish/flock_neighbours.glsl."""
    steps = (np.minimum(np.maximum(numbers, -1.0), 1.0) + 1.0) * (2**20 - 1)
    x, y, z = np.rint(steps).astype(np.uint32).T
    return np.stack([x | y << 21, y >> 11 | z << 10], axis=1)
