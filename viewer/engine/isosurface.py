"""A surface through a sampled field, made fast enough to play with: signs on the GPU, topology here.

The GPU evaluates the field and says which samples are inside. From those signs alone the crossed edges
and the triangles between them follow, in NumPy. Back on the GPU a fragment for each crossed edge finds
where exactly the surface crosses and how it lies there; the mesh stays in textures from which it is drawn.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.field_samples import BLOCK, INSIDE, NO_VALUE, FieldSamples, Warmth, drawing_into
from viewer.engine.gpu import Gpu, GpuError
from viewer.engine.program import Program, VertexArray
from viewer.kit import bits
from viewer.kit.field_function import FieldFunction
from viewer.kit.marching import crossed_edges, renumbered
from viewer.kit.marching_grid import (
    Grid,
    Topology,
    ambiguous_face_count,
    cells_touching,
    crossing_count,
    get_ready,
    has_neighbour,
    in_order,
    packed_table,
    topology,
)
from viewer.kit.ray import first_cell, meetings, near_ray

WIDTH = 1024            # vertices in a row of the textures
GROWTH = 1.25           # how much larger than needed textures are made, so that not each change needs new ones
BYTES_PER_VERTEX = 80   # place, normal, edge and its share of the triangles, here and on the GPU
VALUES_UNIT, LIST_UNIT = 0, 1
CELL_DIAGONAL = 3.0 ** 0.5
NO_CELLS = Topology(np.empty(0, np.uint32), np.empty((0, 3), np.int32), np.empty(0, np.intp),
                    np.empty(0, np.uint8), np.empty(0, np.int32))


@dataclass(frozen=True)
class Wanted:
    """What surface to make: at which level, by which method, and what to find out on the way."""

    level: float
    method: str = "cubes"
    cut_jumps: bool = False
    curvature: bool = False
    in_order: bool = False      # the triangles cell after cell
    function: FieldFunction | None = None       # the field in NumPy, where that is to be used


class Isosurface:
    """A mesh on the GPU. Draw ``count`` indices of ``indices``; a vertex shader finds vertex ``gl_VertexID``
    at texel (gl_VertexID % 1024, gl_VertexID / 1024) of ``places`` and ``normals``.

    ``places`` are in the field's own space; the fourth component of ``normals`` is the mean curvature.
    ``found`` is the topology, ``jumps`` the number of edges where the field jumps past the level, ``closed``
    whether nobody outside the grid can see the surface's inner side: it has no rim, and the grid's border is outside.
    """

    def __init__(self, gpu: Gpu, samples: FieldSamples, include: Callable[[], str]) -> None:
        self.gpu, self.samples = gpu, samples
        self._include = include
        self.found = NO_CELLS
        self.vertex_count = self.count = self.jumps = 0
        self.left_out: bits.Words | None = None
        self.closed = False
        self.extract_ms = 0.0
        self.indices = gpu.buffer(reserve=4 * 3 * 1024, label="triangles")
        self._passes: dict[tuple[str, bool, bool], VertexArray] = {}
        self._warm = Warmth(gpu)
        self._given: moderngl.Texture | None = None
        self._made: list[Any] = []
        self._rows = 0
        self._make_room(1)

    def extract(self, wanted: Wanted) -> None:
        """Make the surface of the samples, as they now are."""
        if not wanted.function:
            self._warm_up("crossing", wanted)
        get_ready(self.samples.lattice.grid, wanted.method)
        started = time.perf_counter()
        self._find_cells(wanted)
        if wanted.in_order:
            self.found = in_order(self.found)
        self._send_triangles(self.found.triangles)
        self.closed = self.left_out is None and not self.samples.meets_border
        self.gpu.context.finish()
        self.extract_ms = 1e3 * (time.perf_counter() - started)

    def take(self, make: Callable[[], tuple[NDArray[np.float64], NDArray[np.int32]]], wanted: Wanted) -> None:
        """Take over a surface made elsewhere: vertices (n, 3) in samples, triangles (m, 3)."""
        if not wanted.function:
            self._warm_up("place", wanted)
        get_ready(self.samples.lattice.grid, "cubes")
        started = time.perf_counter()
        self._find_cells(replace(wanted, method="cubes"))
        vertices, triangles = make()
        if wanted.in_order or self.jumps:
            self.found, triangles = self._sorted_by_cell(vertices, triangles)
        if wanted.function:
            places = self.samples.lattice.in_space(vertices.astype(np.float32))
            self._send_vertices(places, wanted.function.normals(places))
        else:
            rows = np.ones((len(vertices), 4), np.float32)
            rows[:, :3] = vertices
            self._run("place", rows, 4, "f4", wanted)
        self._send_triangles(triangles)
        self.closed = self.left_out is None and not self.samples.meets_border
        self.gpu.context.finish()
        self.extract_ms = 1e3 * (time.perf_counter() - started)

    def mesh(self) -> tuple[NDArray[np.float32], NDArray[np.int32], NDArray[np.float32]]:
        """Vertices (n, 3), triangles (m, 3) and normals (n, 3), read back; vertices that no triangle has left out."""
        places, normals = (self._read(attachment)[:, :3] for attachment in (0, 1))
        triangles = np.frombuffer(self.indices.read(4 * self.count) if self.count else b"", np.int32).reshape(-1, 3)
        used = np.zeros(self.vertex_count, np.bool_)
        used[triangles.reshape(-1)] = True
        if used.all():
            return places.copy(), triangles.copy(), normals.copy()
        kept = np.flatnonzero(used)
        return places[kept], renumbered(triangles, kept), normals[kept]

    @property
    def generation(self) -> int:
        """Grows whenever a shader that the surface comes from is replaced by an edited one."""
        return sum(each.program.generation for each in self._passes.values())

    def cases(self) -> NDArray[np.uint8]:
        """The case of each cell that the surface runs through."""
        return self.found.cases

    def cell_under(self, origin: NDArray[np.float64], direction: NDArray[np.float64],
                   part: tuple[float, float] = (0.0, np.inf)) -> tuple[int, int, int] | None:
        """The cell of the triangle that a ray, given in samples, meets first.

        ``part`` tells from where to where along the ray to look, in lengths of ``direction``.
        """
        vertices, triangles, _ = self.mesh()
        lattice = self.samples.lattice
        places = (vertices - np.array(lattice.corner)) / np.array(lattice.step)
        near = near_ray(places, origin, direction, CELL_DIAGONAL)
        corners = places[triangles[near[triangles[:, 0]]]]
        met = meetings(corners, origin, direction)
        cells = np.floor(corners[(met >= part[0]) & (met <= part[1])].mean(axis=1))
        return first_cell(cells, origin, direction)

    def ambiguous_faces(self) -> int:
        """How many faces of the grid have two opposite corners inside and two outside."""
        sides, grid = self.samples.sides, self.samples.lattice.grid
        unknown = bits.packed(sides == NO_VALUE) if self.left_out is not None else None
        return ambiguous_face_count(bits.packed(sides == INSIDE), grid, unknown)

    def gaps(self) -> NDArray[np.intp]:
        """The cells left out that a surface might have run through: not those without any value."""
        if self.left_out is None:
            return np.empty(0, np.intp)
        grid = self.samples.lattice.grid
        return bits.places_of_ones(self.left_out & cells_touching(bits.packed(self.samples.sides != NO_VALUE), grid))

    def bind(self, places: int, normals: int) -> None:
        """Let shaders read the vertices through these texture units."""
        self.places.use(places)
        self.normals.use(normals)

    def _find_cells(self, wanted: Wanted) -> None:
        """Find the crossed edges and the cells around them, place the vertices, and leave out what jumps tear."""
        inside, self.left_out = _inside_and_left_out(self.samples)
        grid = self.samples.lattice.grid
        self._check_crossings(inside, wanted.method)
        self.found = topology(inside, grid.axes, wanted.method, self.left_out)
        flags = self._place_crossings(wanted)
        self.jumps = int(flags.sum())
        if self.jumps:
            torn = torn_cells(self.found.crossings[flags], grid)
            self.left_out = torn if self.left_out is None else self.left_out | torn
            self.found = topology(inside, grid.axes, wanted.method, self.left_out)

    def _check_crossings(self, inside: NDArray[np.uint8], method: str) -> None:
        """Raise GpuError, before any work is done, for more vertices than a texture holds."""
        most = int(WIDTH * self.gpu.largest_texture / GROWTH) - WIDTH
        if inside.size * len(packed_table(method).directions) <= most:
            return
        count = crossing_count(inside, self.samples.lattice.grid, method)
        if count > most:
            needed = count * BYTES_PER_VERTEX / 2**30
            raise GpuError(f"the surface has {count:,} vertices, which need {needed:.1f} GiB; at most {most:,} fit; "
                           "a lower resolution has fewer")

    def _sorted_by_cell(self, vertices: NDArray[np.float64],
                        triangles: NDArray[np.int32]) -> tuple[Topology, NDArray[np.int32]]:
        """The topology with the owners of these triangles, and the triangles in that order, without torn cells."""
        cells = np.floor(vertices[triangles].mean(axis=1)).astype(np.intp)
        grid = self.samples.lattice.grid
        numbers = cells @ np.array([grid.offset(1 << axis) for axis in range(3)])
        owners = np.searchsorted(self.found.cells, numbers).astype(np.int32)
        kept = self.found.cells[np.minimum(owners, len(self.found.cells) - 1)] == numbers   # and not torn
        order = np.flatnonzero(kept)[np.argsort(owners[kept], kind="stable")]
        return replace(self.found, triangles=triangles[order], owners=owners[order]), triangles[order]

    def _place_crossings(self, wanted: Wanted) -> NDArray[np.bool_]:
        """Find where each crossed edge is crossed; returns which of them the field jumps over."""
        if wanted.function:
            return self._place_in_numpy(wanted.function, wanted)
        self._run("crossing", self.found.crossings, 1, "u4", wanted)
        if not wanted.cut_jumps or not self.vertex_count:
            return np.zeros(self.vertex_count, np.bool_)
        size = (WIDTH, -(-self.vertex_count // WIDTH))
        flags = np.frombuffer(self._target.read((0, 0, *size), 1, attachment=2, alignment=1), np.uint8)
        jumping: NDArray[np.bool_] = flags[:self.vertex_count] != 0
        return jumping

    def _place_in_numpy(self, function: FieldFunction, wanted: Wanted) -> NDArray[np.bool_]:
        """The same as the pass ``crossing`` does."""
        lattice = self.samples.lattice
        starts, steps, A, B, t = (part.astype(np.float32) for part in crossed_edges(
            self.found, self.samples.host_values, wanted.level, lattice.grid))
        places = lattice.in_space(starts + t[:, None] * steps)
        self._send_vertices(places, function.normals(places))
        jumping = np.zeros(len(places), np.bool_)
        if wanted.cut_jumps and len(doubtful := function.doubtful(places, A, B, wanted.level)):
            ends = lattice.in_space(starts[doubtful]), lattice.in_space((starts + steps)[doubtful])
            jumping[doubtful] = function.jumps(ends[0], ends[1], A[doubtful], B[doubtful], wanted.level)
        return jumping

    def _send_vertices(self, places: NDArray[np.float32], normals: NDArray[np.float32]) -> None:
        """Put vertices into the textures from which they are drawn."""
        lines = -(-len(places) // WIDTH)
        self._make_room(lines)
        self.vertex_count = len(places)
        for texture, rows in ((self.places, places), (self.normals, normals)):
            padded = np.zeros((lines * WIDTH, 4), np.float32)
            padded[:len(rows), :3] = rows
            if lines:
                texture.write(padded, (0, 0, WIDTH, lines))

    def _run(self, name: str, rows: NDArray[Any], components: int, dtype: str, wanted: Wanted) -> None:
        """Let the pass ``name`` make a vertex of each row."""
        lines = -(-len(rows) // WIDTH)
        self._make_room(lines)
        self.vertex_count = len(rows)
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

    def _warm_up(self, name: str, wanted: Wanted) -> None:
        """Have ready what is made once and then kept: the table, and the pass as the driver runs it."""
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

    def _send_triangles(self, triangles: NDArray[np.int32]) -> None:
        self.count = triangles.size
        if triangles.nbytes > self.indices.size:
            self.indices.orphan(int(1.25 * triangles.nbytes) // 4 * 4)
        if self.count:
            self.indices.write(triangles)

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

    def _read(self, attachment: int) -> NDArray[np.float32]:
        lines = -(-self.vertex_count // WIDTH)
        if not lines:
            return np.empty((0, 4), np.float32)
        texels = self._target.read((0, 0, WIDTH, lines), 4, attachment=attachment, dtype="f4")
        return np.frombuffer(texels, np.float32).reshape(-1, 4)[:self.vertex_count]


def torn_cells(crossings: NDArray[np.uint32], grid: Grid) -> bits.Words:
    """The cells around edges given by their names, for cubes as for tetrahedra."""
    torn = np.zeros(int(np.prod(grid.shape)), np.bool_)
    samples, directions = crossings >> np.uint32(3), crossings & np.uint32(7)
    for direction in np.unique(directions):
        starts = samples[directions == direction].astype(np.intp)
        for back in range(8):
            if not back & int(direction):       # along the other axes the edge has neighbours on both sides
                before = starts - grid.offset(back)
                torn[before[before >= 0]] = True
    return bits.packed(torn) & has_neighbour(grid, 7)


def _inside_and_left_out(samples: FieldSamples) -> tuple[NDArray[np.uint8], bits.Words | None]:
    """The samples that are inside as 1, and the cells that touch one without a value."""
    sides = samples.sides
    if sides.max() < NO_VALUE:
        return sides, None
    inside = (sides == INSIDE).view(np.uint8)
    return inside, cells_touching(bits.packed(sides == NO_VALUE), samples.lattice.grid)
