"""A scene's geometry as a file: PLY for meshes and particles, OBJ and STL for meshes, NPZ for everything."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from viewer.engine.scene import Geometry
from viewer.errors import DemoscopeError
from viewer.whole_file import whole_file

MESH_SUFFIXES = (".ply", ".obj", ".stl")
SUFFIXES = (*MESH_SUFFIXES, ".npz")
LARGEST_IN_DOUBLE = 2**53
# The types of PLY (Turk 1994) by NumPy's codes; what PLY has no type for goes into the next one that holds it.
PLY_TYPES = {"b1": ("uchar", "u1"), "i1": ("char", "i1"), "u1": ("uchar", "u1"), "i2": ("short", "<i2"),
             "u2": ("ushort", "<u2"), "i4": ("int", "<i4"), "u4": ("uint", "<u4"), "i8": ("double", "<f8"),
             "u8": ("double", "<f8"), "f2": ("float", "<f4"), "f4": ("float", "<f4"), "f8": ("double", "<f8")}


class ExportError(DemoscopeError):
    """A file kind that is unknown, or that cannot hold this scene's geometry."""


def check_suffix(path: Path) -> None:
    """Raise ExportError unless the file's name ends in a kind that can be written."""
    if path.suffix.lower() not in SUFFIXES:
        raise ExportError(f"{path} ends in none of {', '.join(SUFFIXES)}")


def export(geometry: Geometry, path: Path) -> None:
    """Write ``geometry`` to ``path``, whole or not at all; raises ExportError or OutputError.

    With ``vertices`` and ``triangles`` it is a mesh. With ``position`` (n, 3) and no triangles it is particles,
    which PLY holds as vertices: ``x y z``, from ``velocity`` (n, 3) ``vx vy vz``, and every other (n,) array
    under its own name and in its own type. PLY has no 64-bit integers: they become ``double``, which is exact
    up to 2^53, and larger ones are refused. NPZ holds every array as it is.
    """
    check_suffix(path)
    if not geometry:
        raise ExportError(f"{path}: this scene has no geometry to export")
    kind = path.suffix.lower()
    if kind == ".npz":
        with whole_file(path) as temporary, temporary.open("wb") as stream:
            np.savez(stream, **geometry)  # type: ignore[arg-type]
    elif {"vertices", "triangles"} <= set(geometry):
        _write_mesh(geometry, path, kind[1:])
    elif "triangles" in geometry or geometry.get("position", np.empty(0)).shape[1:] != (3,):
        raise ExportError(f"{path}: this scene has {', '.join(geometry)} and no triangles; export it as .npz")
    elif kind != ".ply":
        raise ExportError(f"{path}: {kind} holds no particles; export them as .ply or .npz")
    else:
        _write_particles(geometry, path)


def _write_particles(geometry: Geometry, path: Path) -> None:
    """A binary PLY of vertices alone, with a property for each number of a particle."""
    columns = _columns(geometry, path)
    types = {name: PLY_TYPES[column.dtype.str[1:]] for name, column in columns.items()}
    rows = np.empty(len(geometry["position"]), [(name, code) for name, (_, code) in types.items()])
    for name, column in columns.items():
        rows[name] = column
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(rows)}",
              *(f"property {word} {name}" for name, (word, _) in types.items()), "end_header", ""]
    with whole_file(path) as temporary:
        temporary.write_bytes("\n".join(header).encode("ascii") + rows.tobytes())


def _columns(geometry: Geometry, path: Path) -> dict[str, NDArray[Any]]:
    """Each property's name and values, (n,), position and velocity first; raises ExportError for what PLY lacks."""
    count = len(geometry["position"])
    columns: dict[str, NDArray[Any]] = {}
    for name, array in sorted(geometry.items(), key=lambda item: (item[0] != "position", item[0] != "velocity")):
        split = {"position": ("x", "y", "z"), "velocity": ("vx", "vy", "vz")}.get(name)
        if array.shape != ((count, 3) if split else (count,)):
            raise ExportError(f"{path}: {name} is an array of {_extent(array)}, not of {count} numbers"
                              f"{' by 3' if split else ''}, one row for each particle; export it as .npz")
        if array.dtype.str[1:] not in PLY_TYPES or not name.isidentifier() or not name.isascii():
            raise ExportError(f"{path}: PLY has no property {name} of type {array.dtype}; export it as .npz")
        if array.dtype.str[1:] in ("i8", "u8") and _beyond_double(array):
            raise ExportError(f"{path}: {name} has numbers beyond 2^53, which PLY cannot hold; export it as .npz")
        named = dict(zip(split, array.T, strict=True)) if split else {name: array}
        if named.keys() & columns.keys():
            raise ExportError(f"{path}: two properties would be named {name}; export it as .npz")
        columns |= named
    return columns


def _extent(array: NDArray[Any]) -> str:
    return " by ".join(map(str, array.shape)) or "one number"


def _beyond_double(array: NDArray[Any]) -> bool:
    """Whether doubles could not hold each of these integers."""
    return bool(array.size) and max(int(array.max()), -int(array.min())) > LARGEST_IN_DOUBLE


def _write_mesh(geometry: Geometry, path: Path, kind: str) -> None:
    import trimesh

    vertices, triangles = geometry["vertices"], geometry["triangles"]
    if not triangles.size:
        raise ExportError(f"{path}: this scene has no triangles now; there is nothing to export")
    if vertices.shape[1:] != (3,) or triangles.shape[1:] != (3,):
        raise ExportError(f"{path}: this scene's vertices and triangles are not rows of three")
    if triangles.min() < 0 or triangles.max() >= len(vertices):
        raise ExportError(f"{path}: this scene's triangles name vertices that it has not")
    mesh = trimesh.Trimesh(vertices, triangles, process=False,
                           vertex_normals=geometry.get("normals"))
    options = {"ply": {"vertex_normal": "normals" in geometry}, "obj": {"include_normals": "normals" in geometry},
               "stl": {}}[kind]
    with whole_file(path) as temporary:
        mesh.export(temporary, file_type=kind, **options)
