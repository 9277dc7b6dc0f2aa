"""A scene's geometry as a file: PLY, OBJ and STL for meshes, NPZ for everything."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from viewer.engine.scene import Geometry
from viewer.errors import DemoscopeError
from viewer.whole_file import whole_file

MESH_SUFFIXES = (".ply", ".obj", ".stl")
SUFFIXES = (*MESH_SUFFIXES, ".npz")


class ExportError(DemoscopeError):
    """A file kind that is unknown, or that cannot hold this scene's geometry."""


def check_suffix(path: Path) -> None:
    """Raise ExportError unless the file's name ends in a kind that can be written."""
    if path.suffix.lower() not in SUFFIXES:
        raise ExportError(f"{path} ends in none of {', '.join(SUFFIXES)}")


def export(geometry: Geometry, path: Path) -> None:
    """Write ``geometry`` to ``path``, whole or not at all; raises ExportError or OutputError."""
    check_suffix(path)
    if not geometry:
        raise ExportError(f"{path}: this scene has no geometry to export")
    kind = path.suffix.lower()
    if kind == ".npz":
        with whole_file(path) as temporary, temporary.open("wb") as stream:
            np.savez(stream, **geometry)  # type: ignore[arg-type]
        return
    if not {"vertices", "triangles"} <= set(geometry):
        raise ExportError(f"{path}: this scene has {', '.join(geometry)} and no triangles; export it as .npz")
    _write_mesh(geometry, path, kind[1:])


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
