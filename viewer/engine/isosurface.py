"""A surface through a sampled field, made fast enough to play with: signs on the GPU, topology here.

The GPU evaluates the field and says which samples are inside. From those signs alone the crossed edges
and the triangles between them follow, in NumPy. Back on the GPU a fragment for each crossed edge finds
where exactly the surface crosses and how it lies there; the mesh stays in textures from which it is drawn.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from viewer.engine.field_samples import INSIDE, NO_VALUE, FieldSamples
from viewer.engine.gpu import Gpu, GpuError
from viewer.engine.vertex_textures import VertexTextures, Wanted
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

BYTES_PER_VERTEX = 80   # place, normal, edge and its share of the triangles, here and on the GPU
CELL_DIAGONAL = 3.0 ** 0.5
NO_CELLS = Topology(np.empty(0, np.uint32), np.empty((0, 3), np.int32), np.empty(0, np.intp),
                    np.empty(0, np.uint8), np.empty(0, np.int32))


class Isosurface:
    """A mesh on the GPU: draw ``count`` indices of ``indices``; a vertex shader finds vertex ``gl_VertexID``
    in the textures of ``vertices``.

    ``found`` is the topology, ``jumps`` the number of edges where the field jumps past the level, ``closed``
    whether nobody outside the grid can see the surface's inner side: it has no rim, and the grid's border is outside.
    """

    def __init__(self, gpu: Gpu, samples: FieldSamples, include: Callable[[], str]) -> None:
        self.gpu, self.samples = gpu, samples
        self.vertices = VertexTextures(gpu, samples, include)
        self.found = NO_CELLS
        self.count = self.jumps = 0
        self.left_out: bits.Words | None = None
        self.closed = False
        self.extract_ms = 0.0
        self.indices = gpu.buffer(reserve=4 * 3 * 1024, label="triangles")

    @property
    def vertex_count(self) -> int:
        """How many vertices there are, those of torn cells included."""
        return self.vertices.count

    @property
    def generation(self) -> int:
        """Grows whenever a shader that the surface comes from is replaced by an edited one."""
        return self.vertices.generation

    def extract(self, wanted: Wanted) -> None:
        """Make the surface of the samples, as they now are."""
        if not wanted.function:
            self.vertices.warm_up("crossing", wanted)
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
            self.vertices.warm_up("crossing", wanted)
            self.vertices.warm_up("place", wanted)
        get_ready(self.samples.lattice.grid, "cubes")
        started = time.perf_counter()
        self._find_cells(replace(wanted, method="cubes"))
        vertices, triangles = make()
        if wanted.in_order or self.jumps:
            self.found, triangles = self._sorted_by_cell(vertices, triangles)
        if wanted.function:
            places = self.samples.lattice.in_space(vertices.astype(np.float32))
            self.vertices.send(places, wanted.function.normals(places))
        else:
            rows = np.ones((len(vertices), 4), np.float32)
            rows[:, :3] = vertices
            self.vertices.run("place", rows, 4, "f4", wanted)
        self._send_triangles(triangles)
        self.closed = self.left_out is None and not self.samples.meets_border
        self.gpu.context.finish()
        self.extract_ms = 1e3 * (time.perf_counter() - started)

    def mesh(self) -> tuple[NDArray[np.float32], NDArray[np.int32], NDArray[np.float32]]:
        """Vertices (n, 3), triangles (m, 3) and normals (n, 3), read back; vertices that no triangle has left out."""
        places, normals = (self.vertices.read(attachment)[:, :3] for attachment in (0, 1))
        triangles = np.frombuffer(self.indices.read(4 * self.count) if self.count else b"", np.int32).reshape(-1, 3)
        used = np.zeros(self.vertex_count, np.bool_)
        used[triangles.reshape(-1)] = True
        if used.all():
            return places.copy(), triangles.copy(), normals.copy()
        kept = np.flatnonzero(used)
        return places[kept], renumbered(triangles, kept), normals[kept]

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
        self.vertices.places.use(places)
        self.vertices.normals.use(normals)

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
        most = self.vertices.most
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
        if not len(self.found.cells):
            return self.found, np.empty((0, 3), np.int32)
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
        self.vertices.run("crossing", self.found.crossings, 1, "u4", wanted)
        return self.vertices.flagged() if wanted.cut_jumps else np.zeros(self.vertex_count, np.bool_)

    def _place_in_numpy(self, function: FieldFunction, wanted: Wanted) -> NDArray[np.bool_]:
        """The same as the pass ``crossing`` does."""
        lattice = self.samples.lattice
        starts, steps, A, B, t = (part.astype(np.float32) for part in crossed_edges(
            self.found, self.samples.host_values, wanted.level, lattice.grid))
        places = lattice.in_space(starts + t[:, None] * steps)
        self.vertices.send(places, function.normals(places))
        jumping = np.zeros(len(places), np.bool_)
        if wanted.cut_jumps and len(doubtful := function.doubtful(places, A, B, wanted.level)):
            ends = lattice.in_space(starts[doubtful]), lattice.in_space((starts + steps)[doubtful])
            jumping[doubtful] = function.jumps(ends[0], ends[1], A[doubtful], B[doubtful], wanted.level)
        return jumping

    def _send_triangles(self, triangles: NDArray[np.int32]) -> None:
        self.count = triangles.size
        if triangles.nbytes > self.indices.size:
            self.indices.orphan(int(1.25 * triangles.nbytes) // 4 * 4)
        if self.count:
            self.indices.write(triangles)

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
