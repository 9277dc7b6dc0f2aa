"""A field's values at the points of a grid, made and kept on the GPU; only their signs come back."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.gpu import Gpu, GpuError
from viewer.engine.program import Program, VertexArray
from viewer.kit.field_function import FieldFunction
from viewer.kit.marching_grid import Grid

Triple = tuple[float, float, float]
Sides = NDArray[np.uint8]

OUTSIDE, INSIDE, NO_VALUE = 0, 1, 2
MOST_SAMPLES = 2**27            # their numbers, and three bits more, have to fit in 32 bits
BLOCK = 64                      # software GL compiles once more for what covers a whole block of this size
FEW_SAMPLES = 2**22             # for which no machine need be asked whether it has the memory
BYTES_PER_SAMPLE = 16           # value and side on the GPU, value, side and bits here, and room to work


@dataclass(frozen=True)
class Lattice:
    """Points in space: ``samples`` of them along x, y and z, the first at ``corner``, ``step`` apart."""

    samples: tuple[int, int, int]
    corner: Triple
    step: Triple

    @property
    def count(self) -> int:
        """How many points there are."""
        nx, ny, nz = self.samples
        return nx * ny * nz

    def in_space(self, places: NDArray[np.float32]) -> NDArray[np.float32]:
        """Places given in samples (n, 3), in the field's own space, as lib/grid.glsl has it."""
        return np.asarray(self.corner, np.float32) + places * np.asarray(self.step, np.float32)

    @property
    def grid(self) -> Grid:
        """How their values lie in an array: indexed [z, y, x]."""
        nx, ny, nz = self.samples
        return Grid((nz, ny, nx), (2, 1, 0))


def room_for_samples() -> int:
    """How many samples this machine has the memory for just now, at most ``MOST_SAMPLES``."""
    import psutil

    return int(min(MOST_SAMPLES, psutil.virtual_memory().available // BYTES_PER_SAMPLE))


class FieldSamples:
    """The values of a field at the points of a lattice, in the texture ``values``.

    ``include`` gives GLSL for ``float field(vec3 place)``; None for a field that is filled in from an
    array. ``sides`` (nz, ny, nx) says of each sample whether it is inside, outside or has no value.
    """

    def __init__(self, gpu: Gpu, include: Callable[[], str] | None) -> None:
        self.gpu = gpu
        self.lattice = Lattice((2, 2, 2), (0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
        self.sides: Sides = np.zeros((2, 2, 2), np.uint8)
        self.evaluate_ms = 0.0
        self._rows = 0
        self._filled: NDArray[np.float32] | None = None
        self._made: list[Any] = []
        self._texels: NDArray[np.uint8] = np.empty(0, np.uint8)
        self._include = include
        self._everywhere: VertexArray | None = None
        self._warm = Warmth(gpu)
        self._make_room(self.lattice)

    def evaluate(self, lattice: Lattice, level: float) -> None:
        """Compute the field at every point of ``lattice``; raises GpuError where that is too much."""
        self._make_room(lattice)
        everywhere = self._pass()
        self.describe_to(everywhere.program)
        everywhere.program["u_surface_level"] = level
        self._warm.up(self._target, everywhere)
        self._filled = None
        started = time.perf_counter()
        with drawing_into(self.gpu, self._target, self._target.size):
            everywhere.render(vertices=3)
        self._target.read_into(self._texels, components=1, attachment=1, alignment=1)    # waits for the GPU
        self.sides = self._texels[:lattice.count].reshape(lattice.grid.shape)
        self.evaluate_ms = 1e3 * (time.perf_counter() - started)

    def compute(self, function: FieldFunction, lattice: Lattice, level: float) -> None:
        """Compute ``function`` at every point of ``lattice`` in NumPy, and send the values to the GPU."""
        started = time.perf_counter()
        self._check(lattice)
        self.fill(function.on_grid(lattice.samples, lattice.corner, lattice.step), lattice, level)
        self.gpu.context.finish()
        self.evaluate_ms = 1e3 * (time.perf_counter() - started)

    def fill(self, values: NDArray[np.float32], lattice: Lattice, level: float) -> None:
        """Take over values (nz, ny, nx) float32 where they changed, and find their sides of the level."""
        started = time.perf_counter()
        if lattice != self.lattice or self._filled is not values:
            self._make_room(lattice)
            texels = np.zeros(self._target.width * self._target.height, np.float32)
            texels[:values.size] = values.reshape(-1)
            self.values.write(texels)
            self._filled = values
        self.sides = (values < np.float32(level)).view(np.uint8)
        unknown = ~np.isfinite(values)
        if unknown.any():
            self.sides[unknown] = NO_VALUE
        self.evaluate_ms = 1e3 * (time.perf_counter() - started)

    @property
    def generation(self) -> int:
        """Grows whenever the field's shader is replaced by an edited one."""
        return self._everywhere.program.generation if self._everywhere else 0

    @property
    def without_value(self) -> int:
        """How many samples are NaN or infinite."""
        return int((self.sides == NO_VALUE).sum()) if self.sides.max() >= NO_VALUE else 0

    @property
    def meets_border(self) -> bool:
        """Whether any sample on the border of the grid is inside or has no value."""
        faces = (np.take(self.sides, (0, -1), axis) for axis in range(3))
        return any(bool(face.any()) for face in faces)

    def describe_to(self, program: Program) -> None:
        """Tell ``program`` where the samples are, in space and in the texture: see lib/grid.glsl."""
        program["u_grid_samples"] = self.lattice.samples
        program["u_grid_rows"] = self._rows
        program["u_grid_corner"] = self.lattice.corner
        program["u_grid_step"] = self.lattice.step

    @property
    def host_values(self) -> NDArray[np.float32]:
        """The values that the field was filled with, (nz, ny, nx); read back where it was not."""
        return self.read_all() if self._filled is None else self._filled

    def read(self, samples: NDArray[np.integer[Any]]) -> NDArray[np.float32]:
        """The values of some samples, given by number."""
        found = np.empty(len(samples), np.float32)
        for place, number in enumerate(samples):
            down, across = divmod(int(number), self._target.width)
            found[place] = np.frombuffer(self._target.read((across, down, 1, 1), 1, dtype="f4"), np.float32)[0]
        return found

    def read_all(self) -> NDArray[np.float32]:
        """All values, (nz, ny, nx)."""
        texels = np.frombuffer(self._target.read(components=1, dtype="f4"), np.float32)
        return texels[:self.lattice.count].reshape(self.lattice.grid.shape)

    def _pass(self) -> VertexArray:
        """The pass over all samples, linked when first wanted."""
        if self._everywhere is None:
            assert self._include
            program = self.gpu.program("studio/screen.vert", "isosurface/evaluate.frag",
                                       generated={"generated/field.glsl": self._include})
            self._everywhere = self.gpu.vertex_array(program)
        return self._everywhere

    def _make_room(self, lattice: Lattice) -> None:
        """Textures for ``lattice``: as many rows of samples beside each other as make them about square."""
        if self._rows and lattice.samples == self.lattice.samples:
            self.lattice = lattice
            return
        columns, lines = lattice.samples[0], lattice.samples[1] * lattice.samples[2]
        rows = max(1, round((lines / columns) ** 0.5))
        size = (rows * columns, -(-lines // rows))
        self._check(lattice)
        self.gpu.check_size(size, "a grid of {} x {} x {} samples, in a texture".format(*lattice.samples))
        self.gpu.discard(*self._made)
        self._made = []
        self.values = self.gpu.texture(size, 1, dtype="f4", label="field values")
        side = self.gpu.texture(size, 1, label="field sides")
        self._target = self.gpu.framebuffer([self.values, side], label="field")
        self._made = [self._target, side, self.values]
        self._texels = np.empty(size[0] * size[1], np.uint8)
        self._rows, self.lattice, self._filled = rows, lattice, None

    def _check(self, lattice: Lattice) -> None:
        nx, ny, nz = lattice.samples
        if lattice.count > FEW_SAMPLES and lattice.count > (most := room_for_samples()):
            raise GpuError(f"{nx} x {ny} x {nz} samples need {lattice.count * BYTES_PER_SAMPLE / 2**30:.2f} GiB; "
                           f"{most * BYTES_PER_SAMPLE / 2**30:.2f} GiB are to be had")


class Warmth:
    """Drivers finish compiling a program when it first draws; a block drawn beforehand keeps that out of timings."""

    def __init__(self, gpu: Gpu) -> None:
        self.gpu = gpu
        self._known: dict[Program, int] = {}

    def up(self, target: moderngl.Framebuffer, pass_over: VertexArray) -> None:
        """Draw a block of ``target`` if the program has changed since it was last warm."""
        program = pass_over.program
        if self._known.get(program) != program.generation:
            with drawing_into(self.gpu, target, (min(BLOCK, target.width), min(BLOCK, target.height))):
                pass_over.render(vertices=3)
            self.gpu.context.finish()
            self._known[program] = program.generation


@contextmanager
def drawing_into(gpu: Gpu, target: moderngl.Framebuffer, size: tuple[int, int]) -> Iterator[None]:
    """Draw a list of texels into the lower left part of a framebuffer, and go back to the one before."""
    before = gpu.context.fbo
    target.viewport = (0, 0, *size)
    target.use()
    gpu.context.enable_only(moderngl.NOTHING)
    try:
        yield
    finally:
        if before:
            before.use()
