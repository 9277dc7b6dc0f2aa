"""Triangle meshes in files: OBJ, PLY, STL, and glTF with all the parts of its scene in place.

    mesh = read_mesh(Path("teapot.obj"))
    mesh.vertices, mesh.triangles       # metres, counter-clockwise from outside
    mesh.normals                        # those in the file, or None
"""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from viewer.errors import DemoscopeError
from viewer.kit.mesh import Triangles, Vertices, normalized

if TYPE_CHECKING:
    import trimesh

SUFFIXES = (".obj", ".ply", ".glb", ".gltf", ".stl")
FARTHEST = 1e6                  # metres from the origin: beyond, float32 is too coarse for any picture


class MeshFileError(DemoscopeError):
    """A mesh that is missing, damaged, not made of triangles, or of which nothing can be drawn."""


class FileMesh(NamedTuple):
    """Vertices (n, 3) float64, triangles (m, 3) int32, and normals (n, 3) of length 1 or zero, or None.

    There are normals only where the file has them for all of its parts.
    """

    vertices: Vertices
    triangles: Triangles
    normals: Vertices | None


def read_mesh(path: Path) -> FileMesh:
    """All triangles in a file as one mesh, each part of its scene where the scene has it.

    Polygons are cut into triangles; points and lines beside them are left out. A skinned model comes in the
    pose in which it was bound. Raises MeshFileError, in one line that names the file, for one that is missing,
    damaged or of another kind, for points or lines alone, for coordinates that are no numbers or more than
    1000 km away, and for a mesh without area.
    """
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise MeshFileError(f"mesh {path} ends in {suffix or 'no suffix'}; {', '.join(SUFFIXES)} are allowed")
    if not path.is_file():
        raise MeshFileError(f"mesh {path} {'is not a file' if path.exists() else 'does not exist'}")
    if not path.stat().st_size:
        raise MeshFileError(f"mesh {path} is empty")
    with _explained(path):
        parts = list(_parts(path))
    if not parts:
        raise MeshFileError(f"mesh {path} holds no triangles")
    mesh = _joined(parts)
    _check(path, mesh)
    return mesh


@contextmanager
def _explained(path: Path) -> Iterator[None]:
    """Whatever the library raises over a damaged file, as one line; what it logs about it, nowhere."""
    library = logging.getLogger("trimesh")
    level = library.level
    library.setLevel(logging.CRITICAL)
    try:
        yield
    except MeshFileError:
        raise
    except Exception as error:      # the formats' readers raise whatever their parsing runs into
        if isinstance(error, OSError) and error.strerror:
            beside = f"{error.filename}: " if error.filename and Path(error.filename) != path else ""
            raise MeshFileError(f"mesh {path} cannot be read: {beside}{error.strerror}") from error
        raise MeshFileError(f"mesh {path} cannot be read: it is cut short, damaged or no mesh") from error
    finally:
        library.setLevel(level)


def _parts(path: Path) -> Iterator[FileMesh]:
    """The meshes of a file's scene, in the world."""
    import trimesh

    scene = trimesh.load_scene(str(path), process=False, skip_materials=True)
    found: list[bool] = []
    for node in scene.graph.nodes_geometry:
        transform, name = scene.graph[node]
        part = scene.geometry[name]
        found.append(isinstance(part, trimesh.Trimesh))
        if isinstance(part, trimesh.Trimesh) and len(part.faces):
            yield _placed(path, part, np.asarray(transform, np.float64))
    if found and not any(found):
        raise MeshFileError(f"mesh {path} holds only points or lines; triangles are needed")


def _placed(path: Path, part: trimesh.Trimesh, transform: Vertices) -> FileMesh:
    """One mesh moved by its node; a mirror image is turned inside out again."""
    vertices, triangles = np.asarray(part.vertices, np.float64), np.asarray(part.faces, np.int64)
    if triangles.min() < 0 or triangles.max() >= len(vertices):
        wrong = triangles.max() if triangles.max() >= len(vertices) else triangles.min()
        raise MeshFileError(f"mesh {path} has a triangle with vertex {wrong}; there are {len(vertices)}")
    turn = transform[:3, :3]
    normals = _normals_of(part)
    if not np.array_equal(transform, np.eye(4)):
        with np.errstate(invalid="ignore", over="ignore"):      # looked for by _check
            vertices = vertices @ turn.T + transform[:3, 3]
            if normals is not None:
                normals = normals @ _cofactors(turn).T
    if np.linalg.det(turn) < 0.0:
        triangles = triangles[:, ::-1]
        normals = None if normals is None else -normals
    return FileMesh(vertices, triangles.astype(np.int32), normals)


def _normals_of(part: trimesh.Trimesh) -> Vertices | None:
    """The normals that came with a mesh; those that the library would make up are not asked for."""
    if "vertex_normals" not in part._cache:
        return None
    normals = np.asarray(part._cache["vertex_normals"], np.float64)
    return normals if normals.shape == part.vertices.shape else None


def _cofactors(turn: Vertices) -> Vertices:
    """The matrix by which normals turn when places turn by ``turn`` (3, 3), whatever it squeezes."""
    x, y, z = turn.T
    return np.stack([np.cross(y, z), np.cross(z, x), np.cross(x, y)], axis=1)


def _joined(parts: list[FileMesh]) -> FileMesh:
    first = np.cumsum([0] + [len(part.vertices) for part in parts[:-1]])
    normals = [part.normals for part in parts if part.normals is not None]
    known = np.concatenate(normals) if len(normals) == len(parts) else None
    if known is not None:
        known = normalized(np.where(np.isfinite(known).all(axis=1, keepdims=True), known, 0.0))
    return FileMesh(np.concatenate([part.vertices for part in parts]),
                    np.concatenate([part.triangles + np.int32(start)
                                    for start, part in zip(first, parts, strict=True)]).astype(np.int32), known)


def _check(path: Path, mesh: FileMesh) -> None:
    """Raise MeshFileError unless every vertex in use is a place, and some triangle has an area."""
    used = np.zeros(len(mesh.vertices), np.bool_)
    used[mesh.triangles.ravel()] = True
    wrong = np.nonzero(used & ~np.isfinite(mesh.vertices).all(axis=1))[0]
    if len(wrong):
        place = ", ".join(f"{number:g}" for number in mesh.vertices[wrong[0]])
        raise MeshFileError(f"mesh {path} has vertex {wrong[0]} at ({place}); finite numbers are needed")
    farthest = float(np.abs(mesh.vertices[used]).max())
    if farthest > FARTHEST:
        raise MeshFileError(f"mesh {path} reaches {farthest:g} m from the origin; at most {FARTHEST:g} m are allowed")
    a, b, c = (mesh.vertices[mesh.triangles[:, corner]] for corner in range(3))
    if not np.cross(b - a, c - a).any():
        raise MeshFileError(f"mesh {path} has no area: all its triangles are lines or points")
