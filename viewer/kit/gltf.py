"""Rigged models in glTF 2.0 files, ``.gltf`` and ``.glb``: a mesh, its skeleton, its materials and its animations.

    model = read_model(Path("fox.glb"))
    clip = model.clips[0]
    local = model.mesh.skeleton.local(*clip.pose(model.mesh.skeleton, 0.5))
    model.mesh.palette(local)           # what moves its vertices, half a second into the animation

Whatever the file holds comes as one mesh that is bound to one skeleton: each node is a joint, and what no skin
moves follows the node on which it hangs. The JSON is read by the standard library, since glTF libraries for
Python either build it into objects, hundreds of times slower, or know nothing of skins.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from viewer.kit.gltf_accessor import Accessors
from viewer.kit.gltf_animation import read_clips
from viewer.kit.gltf_clip import Clip
from viewer.kit.gltf_container import Container
from viewer.kit.gltf_document import Document, ModelFileError, told
from viewer.kit.gltf_material import Look, Looks
from viewer.kit.gltf_mesh import BoundMesh, bound_mesh
from viewer.kit.gltf_nodes import read_nodes
from viewer.kit.gltf_palette import Palette
from viewer.kit.gltf_primitive import Primitives
from viewer.kit.mesh_file import FARTHEST
from viewer.kit.rig import RiggedMesh
from viewer.kit.skinning import linear_blend

__all__ = ["SUFFIXES", "Clip", "ModelFileError", "Part", "RiggedModel", "read_model"]

SUFFIXES = (".gltf", ".glb")
MOST_NOTES = 12
TRIANGLES_AT_ONCE = 2**16
UNDERSTOOD = frozenset({"KHR_mesh_quantization", "KHR_texture_transform"})
LOOKS_ALONE = frozenset({"KHR_lights_punctual", *(f"KHR_materials_{name}" for name in (
    "anisotropy clearcoat dispersion emissive_strength ior iridescence sheen specular transmission unlit variants "
    "volume").split())})


@dataclass(frozen=True, eq=False)
class Part:
    """A run of ``count`` triangles with one material, from number ``first`` on.

    ``color`` is the base colour, linear red, green, blue and alpha in 0 to 1. ``texture`` (height, width, 4),
    sRGB, by which it is multiplied, has its top row first, as the mesh's texture coordinates mean it.
    """

    first: int
    count: int
    color: tuple[float, float, float, float]
    texture: NDArray[np.uint8] | None
    metallic: float
    roughness: float
    double_sided: bool


@dataclass(frozen=True, eq=False)
class RiggedModel:
    """A model from a file.

    ``unnormalised_vertices`` had weights whose sum was not 1, and have been normalised; ``influences`` is the
    most bones that any vertex follows; ``notes`` are sentences about what was changed or left out.
    """

    name: str
    mesh: RiggedMesh
    parts: tuple[Part, ...]
    clips: tuple[Clip, ...]
    unnormalised_vertices: int
    influences: int
    has_skin: bool
    notes: tuple[str, ...]


def read_model(path: Path) -> RiggedModel:
    """The model in a file, with everything that its default scene shows.

    Raises ModelFileError, in one line that names the file, the wrong value and what is allowed, for one that is
    missing, damaged or too large, refers to files that are not beside it, needs extensions that are not known
    here, has numbers that are none or lie more than 1000 km away, or shows nothing.
    """
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise ModelFileError(f"model {path} ends in {suffix or 'no suffix'}; {', '.join(SUFFIXES)} are allowed")
    if not path.is_file():
        raise ModelFileError(f"model {path} {'is not a file' if path.exists() else 'does not exist'}")
    try:
        if not path.stat().st_size:
            raise ModelFileError(f"model {path} is empty")
        return _model(Container(path))
    except OSError as error:
        raise ModelFileError(f"model {path} cannot be read: {error.strerror or error}") from error
    except MemoryError:
        raise ModelFileError(f"model {path} does not fit into memory") from None


def _model(container: Container) -> RiggedModel:
    document, accessors, looks = container.document, Accessors(container), Looks(container)
    notes = _extensions(document)
    nodes = read_nodes(document)
    primitives = Primitives(accessors, looks)
    bound = bound_mesh(document, nodes, primitives, Palette(document, accessors, nodes.joint_of))
    _check(document, bound.mesh)
    clips = read_clips(document, accessors, nodes.joint_of)
    return RiggedModel(document.path.stem, bound.mesh, _parts(bound), clips, bound.unnormalised,
                       bound.mesh.influences, bound.has_skin,
                       _few([*notes, *nodes.notes, *bound.notes, *primitives.notes, *looks.notes]))


def _extensions(document: Document) -> list[str]:
    """What is to be said of the extensions that the file needs; raises ModelFileError for those not known here."""
    needed = document.root.texts("extensionsRequired")
    for name in needed:
        if name not in UNDERSTOOD | LOOKS_ALONE:
            document.refuse(f"it needs the extension {told(name)}; {', '.join(sorted(UNDERSTOOD))} are allowed")
    return [f"{name} is left out; it would change how the model looks." for name in needed if name in LOOKS_ALONE]


def _parts(bound: BoundMesh) -> tuple[Part, ...]:
    """A part for each run of triangles that look the same."""
    runs: list[tuple[int, Look]] = []
    for count, look in bound.looks:
        if runs and runs[-1][1] is look:
            runs[-1] = runs[-1][0] + count, look
        else:
            runs.append((count, look))
    first = np.cumsum([0, *(count for count, _ in runs)])
    return tuple(Part(int(start), count, look.color, look.texture, look.metallic, look.roughness, look.double_sided)
                 for start, (count, look) in zip(first, runs, strict=False))


def _check(document: Document, mesh: RiggedMesh) -> None:
    """Raise ModelFileError unless all joints and vertices at rest are near enough, and some triangle has an area."""
    with np.errstate(over="ignore", invalid="ignore"):
        joints = mesh.skeleton.world()[:, :3, 3]
        vertices = linear_blend(mesh.positions, mesh.joints, mesh.weights, mesh.palette())
        for points, name in ((joints, "a joint"), (vertices, "a vertex")):
            farthest = float(np.abs(points).max())
            if not farthest <= FARTHEST:
                document.refuse(f"at rest it has {name} {farthest:g} m from the origin; "
                                f"at most {FARTHEST:g} m are allowed")
    for start in range(0, len(mesh.triangles), TRIANGLES_AT_ONCE):
        a, b, c = np.moveaxis(vertices[mesh.triangles[start:start + TRIANGLES_AT_ONCE]], 1, 0)
        if np.cross(b - a, c - a).any():
            return
    document.refuse("it has no area: all its triangles are lines or points")


def _few(notes: list[str]) -> tuple[str, ...]:
    different = tuple(dict.fromkeys(notes))
    more = len(different) - MOST_NOTES
    return different if more <= 0 else (*different[:MOST_NOTES], f"And {more:,} more of this kind.")
