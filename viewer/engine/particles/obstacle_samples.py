"""Obstacles that no short formula gives the distance to: sampled on a grid, from a file's mesh or a typed function."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from viewer.engine.fields import ParameterError
from viewer.engine.file_stamp import file_stamp
from viewer.engine.particles.solid import ShadedMesh
from viewer.errors import DemoscopeError
from viewer.kit.field_function import FieldFunction
from viewer.kit.mesh import normalized

if TYPE_CHECKING:       # what these modules import takes longer than a window may wait
    from viewer.kit.distance_field import DistanceField

MOST_CREASED = 300_000     # triangles; finding creases among more takes longer than one may wait
SUFFIXES = (".obj", ".ply", ".glb", ".gltf", ".stl")


class Sampled(NamedTuple):
    """An obstacle as a distance field, and as a mesh to draw, both in its own units."""

    field: DistanceField
    mesh: ShadedMesh


def sampled_mesh(path: Path, samples: int) -> Sampled:
    """The obstacle in a file; raises ParameterError for a mesh that cannot be one."""
    from viewer.kit.distance_field import mesh_distance_field
    from viewer.kit.mesh_file import read_mesh
    from viewer.kit.pseudonormal import vertex_normals, welded
    from viewer.kit.shapes import creased, face_normals

    try:
        found = read_mesh(path)
        field = mesh_distance_field(found.vertices, found.triangles, samples)
    except (DemoscopeError, ValueError) as error:
        reason = str(error).removeprefix(f"mesh {path} ")       # which names the file once more
        raise ParameterError(f"obstacle_file = {path.name}: {reason}") from error
    if found.normals is not None and found.normals.any(axis=1).all():
        return Sampled(field, (found.vertices, found.normals, found.triangles))
    places, faces = welded(found.vertices, found.triangles)
    if len(faces) <= MOST_CREASED:
        return Sampled(field, creased(places, faces))
    return Sampled(field, (places, normalized(vertex_normals(places, faces, face_normals(places, faces))), faces))


def sampled_formula(function: FieldFunction, reach: float, samples: int) -> Sampled:
    """The solid where ``function`` is below 0; raises ParameterError where there is none."""
    from viewer.kit.distance_field import formula_distance_field
    from viewer.kit.shapes import creased

    try:
        found = formula_distance_field(function, reach, samples)
    except ValueError as error:
        raise ParameterError(f"obstacle_formula = {function.formula}: {error}") from error
    normals = function.normals(found.vertices.astype(np.float32)).astype(np.float64)
    cut_off = np.abs(found.vertices).max() > 0.999 * reach
    if cut_off or not normals.any(axis=1).all():
        return Sampled(found.field, creased(found.vertices, found.triangles, 45.0))
    return Sampled(found.field, (found.vertices, normals, found.triangles))


def obstacle_stamp(path: Path | None) -> tuple[object, ...]:
    """What tells one mesh file, or version of it, from another; raises ParameterError where none is named."""
    if path is None:
        raise ParameterError(f"obstacle = mesh needs a mesh: set obstacle_file to a file that ends in "
                             f"{', '.join(SUFFIXES)}")
    return file_stamp(path)
