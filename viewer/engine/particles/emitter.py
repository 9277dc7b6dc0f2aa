"""Where particles are born: the shape that they come from, how it stands, and what a shader draws points from."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import TypeAlias

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.declarations import choice, color, file, slider, toggle
from viewer.engine.fields import ParameterError
from viewer.engine.file_stamp import file_stamp
from viewer.engine.gpu import Gpu
from viewer.engine.params import Parameters
from viewer.engine.program import Program
from viewer.kit import mesh, shapes
from viewer.kit.fish import SPECIES, fish_mesh
from viewer.kit.interior_points import volume_table
from viewer.kit.mesh_file import SUFFIXES, FileMesh, MeshFileError, read_mesh
from viewer.kit.surface_sampling import SamplingTable, edge_table, faces_inward, is_closed, surface_table, welded

TABLE_WIDTH = 4096              # texels in a row of a table
GROUP = "Emitter"
SHAPES = {
    "point": "A single point, its normal along the axis",
    "disc": "A flat disc that faces along the axis",
    "sphere": "A sphere",
    "torus": "A ring around the axis, as thick as the thickness",
    "box": "A box, as high to either side as the thickness",
    "cone": "A cone that stands on its base, as high as the thickness",
    "ground": "A level square that faces up, whatever the tilt",
    "mesh": "The triangles in a file",
    "fish": "A fish of one metre",
}
SOURCES = {
    "surface": "All over the surface, as many on each square metre",
    "edge": "Along rims, creases and borders, as many on each metre",
    "volume": "All through the inside, as many in each cubic metre; flat shapes have only their surface",
}
Stamp: TypeAlias = tuple[str, int, int] | None
Surface: TypeAlias = tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.int32]]


class EmitterParameters(Parameters):
    """What an artist sets of the shape that particles come from."""

    emitter: str = choice("point", SHAPES, "The shape that particles come from", group=GROUP)
    emitter_species: str = choice("koi", {name: f"{species.title}-like" for name, species in SPECIES.items()},
                                  "Which fish", group=GROUP, when="emitter=fish")
    emit_from: str = choice("surface", SOURCES, "Which part of the shape they come from", group=GROUP,
                            when="emitter!=point")
    emitter_size: float = slider(
        0.5, 0.001, 50.0, "Radius of the disc, the sphere, the torus' ring and the cone's base; half the width of the "
        "box and the ground", unit="m", logarithmic=True, group=GROUP, when="emitter!=point|mesh|fish")
    emitter_thickness: float = slider(
        0.15, 0.001, 50.0, "Radius of the torus' tube, at most that of its ring; half the height of the box; height "
        "of the cone", unit="m", logarithmic=True, group=GROUP, when="emitter=torus|box|cone")
    emitter_file: Path | None = file(None, "A mesh to emit from, in metres: name it, then choose emitter = mesh",
                                     suffixes=SUFFIXES, rebuild=False, group=GROUP)
    emitter_scale: float = slider(1.0, 0.001, 1000.0, "How many times larger than it is the mesh or the fish stands",
                                  logarithmic=True, handy=(0.01, 100.0), group=GROUP, when="emitter=mesh|fish")
    emitter_height: float = slider(0.0, -20.0, 20.0, "How high the shape's origin lies", unit="m", group=GROUP)
    emitter_tilt: float = slider(0.0, -180.0, 180.0, "How far the axis leans from up towards +x", unit="degrees",
                                 group=GROUP, when="emitter!=ground")
    emitter_heading: float = slider(0.0, -180.0, 180.0, "How far the shape is turned around y, counter-clockwise seen "
                                    "from above", unit="degrees", group=GROUP, when="emitter!=ground")
    show_emitter: bool = toggle(False, "Draw the surface of the shape", group=GROUP, when="emitter!=point")
    emitter_color: tuple[float, float, float] = color("#8c99a8", "Colour of that surface", group=GROUP,
                                                      when="show_emitter")


class Emitter:
    """The shape as shaders draw from it: constants for what it is, and for a mesh a table of its parts.

    A program that includes ``particles/emitter.glsl`` is made with
    ``generated={"generated/emitter.glsl": emitter.constants}`` and given to ``bind`` before it runs.
    """

    UNITS = 2

    def __init__(self, gpu: Gpu, params: EmitterParameters) -> None:
        self.gpu, self.params = gpu, params
        self._followed: tuple[int, Stamp] | None = None
        self._made: tuple[str, str, str, Stamp] | None = None
        self._read: tuple[Stamp, FileMesh] | None = None
        self._entries = 0
        self._textures: list[moderngl.Texture] = []
        self._shaded: tuple[tuple[object, ...], shapes.ShadedMesh] | None = None

    def prepare(self) -> None:
        """Follow the parameters; returns at once where nothing of the mesh changed.

        Raises ParameterError or MeshFileError for a mesh that particles cannot come from; what stood before
        then still stands.
        """
        stamp = self.stamp
        if self._followed == (self.params.revision, stamp):
            return
        shape, source = self.params.emitter, self.params.emit_from
        wanted = (shape, self.params.emitter_species, source, stamp)
        if shape in ("mesh", "fish") and wanted != self._made:
            self._send(_table_of(self._mesh(), source, self._name))
            self._made = wanted
        self._followed = self.params.revision, stamp

    @property
    def stamp(self) -> Stamp:
        """Which version of which file particles come from; None where they come from none."""
        path = self.params.emitter_file
        return file_stamp(path) if self.params.emitter == "mesh" and path is not None else None

    def constants(self) -> str:
        """GLSL that says which shape it is and which part of it particles come from."""
        shapes_of, sources = list(SHAPES), list(SOURCES)
        numbers = {f"SHAPE_{name.upper()}": number for number, name in enumerate(shapes_of)}
        numbers |= {f"FROM_{name.upper()}": number for number, name in enumerate(sources)}
        numbers["EMITTER_SHAPE"] = shapes_of.index(self.params.emitter)
        numbers["EMIT_FROM"] = sources.index(self.params.emit_from)
        lines = [f"const int {name} = {number};\n" for name, number in numbers.items()]
        return "".join(lines) + f"const uint EMITTER_TABLE_WIDTH = {TABLE_WIDTH}u;\n"

    def bind(self, program: Program, first_unit: int) -> None:
        """Give a program the table, in ``UNITS`` texture units from ``first_unit`` on."""
        program["u_emitter_places"] = first_unit
        program["u_emitter_normals"] = first_unit + 1
        program["u_emitter_entries"] = self._entries
        for unit, texture in enumerate(self._textures, first_unit):
            texture.use(unit)

    def surface(self) -> Surface | None:
        """The shape in the world: vertices (v, 3), normals (v, 3), triangles (t, 3); None for a point.

        Raises as ``prepare`` does.
        """
        if self.params.emitter == "point":
            return None
        vertices, normals, triangles = self._local_surface()
        scale = self.params.emitter_scale if self.params.emitter in ("mesh", "fish") else 1.0
        turn = np.eye(3) if self.params.emitter == "ground" else turning(self.params.emitter_tilt,
                                                                         self.params.emitter_heading)
        places = scale * vertices @ turn.T + np.array([0.0, self.params.emitter_height, 0.0])
        return places.astype(np.float32), (normals @ turn.T).astype(np.float32), triangles

    @property
    def _name(self) -> str:
        return f"mesh {self.params.emitter_file}" if self.params.emitter == "mesh" else "the fish"

    def _mesh(self) -> FileMesh:
        """The mesh that particles come from; a file is read once, and again where it has changed."""
        if self.params.emitter == "fish":
            return _fish(self.params.emitter_species)
        path, stamp = self.params.emitter_file, self.stamp
        if path is None:
            raise ParameterError(f"emitter = mesh needs a file: set emitter_file to one that ends in "
                                 f"{', '.join(SUFFIXES)}")
        if self._read is None or self._read[0] != stamp:
            self._read = stamp, _outside_out(read_mesh(path))
        return self._read[1]

    def _send(self, table: SamplingTable) -> None:
        """Put a table into textures, in place of the one before."""
        images = [_rows(array) for array in table]
        for image in images:
            self.gpu.check_size((image.shape[1], image.shape[0]), f"{self._name} as an emitter, in a texture")
        if self._textures:
            self.gpu.discard(*self._textures)
            self._textures = []
        for image, label in zip(images, ("emitter places", "emitter normals"), strict=True):
            size = (image.shape[1], image.shape[0])
            self._textures.append(self.gpu.texture(size, image.shape[2], image, dtype="f4", label=label))
        self._entries = len(table.places)

    def _local_surface(self) -> shapes.ShadedMesh:
        """The shape around its own origin, made anew only when it is another."""
        params = self.params
        key = (params.emitter, params.emitter_species, params.emitter_size, params.emitter_thickness, self.stamp)
        if self._shaded is None or self._shaded[0] != key:
            self._shaded = key, self._shade()
        return self._shaded[1]

    def _shade(self) -> shapes.ShadedMesh:
        size, thickness = self.params.emitter_size, self.params.emitter_thickness
        if self.params.emitter in ("mesh", "fish"):
            found = self._mesh()
            if found.normals is not None:
                return found.vertices, found.normals, found.triangles
            return shapes.creased(found.vertices, welded(found.vertices, found.triangles))
        if self.params.emitter == "sphere":
            directions, triangles = mesh.ico_sphere(5)
            return size * directions, directions, triangles
        made = {"disc": lambda: shapes.disc(size), "torus": lambda: shapes.torus(size, min(size, thickness)),
                "box": lambda: shapes.box((size, thickness, size)), "cone": lambda: shapes.cone(size, thickness),
                "ground": lambda: shapes.square(size)}
        return shapes.creased(*made[self.params.emitter]())


def turning(tilt: float, heading: float) -> NDArray[np.float64]:
    """The matrix (3, 3) for columns that leans y towards +x by ``tilt`` and turns around y by ``heading`` degrees."""
    lean, turn = np.radians(tilt), np.radians(heading)
    leaning = np.array([[np.cos(lean), np.sin(lean), 0.0], [-np.sin(lean), np.cos(lean), 0.0], [0.0, 0.0, 1.0]])
    around = np.array([[np.cos(turn), 0.0, np.sin(turn)], [0.0, 1.0, 0.0], [-np.sin(turn), 0.0, np.cos(turn)]])
    return np.asarray(around @ leaning)


@lru_cache(maxsize=len(SPECIES))
def _fish(species: str) -> FileMesh:
    """A fish, with normals that are smooth except at the edges of its fins."""
    vertices, normals, triangles = shapes.creased(*fish_mesh(species), degrees=50.0)
    return FileMesh(vertices, triangles, normals)


def _outside_out(found: FileMesh) -> FileMesh:
    """A closed mesh whose faces look inwards, turned; its own normals with them, where they looked inwards too."""
    vertices, triangles, normals = found
    if not faces_inward(vertices, triangles):
        return found
    if normals is not None:
        faces = shapes.face_normals(vertices, triangles)
        agreed = np.einsum("tci,ti->", normals[triangles], faces) > 0.0
        normals = -normals if agreed else normals
    return FileMesh(vertices, triangles[:, ::-1], normals)


def _table_of(found: FileMesh, source: str, name: str) -> SamplingTable:
    """What points are drawn from; raises MeshFileError where there is nothing."""
    vertices, triangles, normals = found
    try:
        if source == "surface":
            return surface_table(vertices, triangles, normals)
        if source == "edge":
            return edge_table(vertices, triangles)
        if not is_closed(vertices, triangles):
            raise ValueError("it is not closed, so that it has no inside; emit_from takes surface or edge of it")
        return volume_table(vertices, triangles)
    except ValueError as error:
        raise MeshFileError(f"{name} cannot be emitted from: {error}") from error


def _rows(array: NDArray[np.float32]) -> NDArray[np.float32]:
    """An array (n, k, c) as an image (rows, TABLE_WIDTH, c), filled up with zeros."""
    flat = array.reshape(-1, array.shape[2])
    image = np.zeros((-(-len(flat) // TABLE_WIDTH) * TABLE_WIDTH, array.shape[2]), np.float32)
    image[:len(flat)] = flat
    return image.reshape(-1, TABLE_WIDTH, array.shape[2])
