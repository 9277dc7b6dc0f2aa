"""All meshes of a glTF file as one that is bound to one skeleton."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from viewer.kit.gltf_document import Document, Entry
from viewer.kit.gltf_material import Look
from viewer.kit.gltf_nodes import Nodes
from viewer.kit.gltf_palette import Palette
from viewer.kit.gltf_primitive import MOST_TRIANGLES, MOST_VERTICES, Primitive, Primitives
from viewer.kit.rig import RiggedMesh

MOST_PARTS = 2**12


class Instance(NamedTuple):
    """A primitive that hangs on a node, or that a skin moves."""

    node: int
    skin: int | None
    entry: Entry


class Piece(NamedTuple):
    """An instance, read: a primitive and which bones (n, k) of the palette its vertices follow by what weights."""

    primitive: Primitive
    bones: NDArray[np.int32]
    weights: NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class BoundMesh:
    """The mesh, how each run of its triangles looks, and what was found about the weights of its vertices."""

    mesh: RiggedMesh
    looks: list[tuple[int, Look]]           # and the number of triangles
    unnormalised: int
    has_skin: bool
    notes: list[str]


def bound_mesh(document: Document, nodes: Nodes, primitives: Primitives, palette: Palette) -> BoundMesh:
    """Everything in the scene as one mesh. Raises ModelFileError if that is too much, or nothing at all."""
    instances, notes = _instances(document, nodes, primitives)
    pieces: list[Piece] = []
    unnormalised, has_skin = 0, False
    for instance in instances:
        primitive = primitives.read(instance.entry)
        if instance.skin is not None and primitive.influences is not None:
            pieces.append(_skinned(instance, instance.skin, primitive, palette))
            unnormalised, has_skin = unnormalised + primitive.influences.unnormalised, True
        else:
            pieces.append(_rigid(instance, primitive, palette))
            notes += _why_rigid(instance, primitive)
    if not has_skin:
        notes.append("It has no skin, so its parts are rigid.")
    return BoundMesh(_joined(pieces, nodes, palette),
                     [(len(piece.primitive.triangles), piece.primitive.look) for piece in pieces],
                     unnormalised, has_skin, notes)


def _instances(document: Document, nodes: Nodes, primitives: Primitives) -> tuple[list[Instance], list[str]]:
    """The primitives of triangles on the nodes of the scene, counted before any of them is read."""
    found: list[Instance] = []
    others: list[str] = []
    vertices = triangles = 0
    for number, (node, skin, entry) in enumerate(_hanging(document, nodes.shown)):
        size = primitives.size(entry)
        vertices, triangles = vertices + size[0], triangles + size[1]
        for count, most, what in ((vertices, MOST_VERTICES, "vertices"), (triangles, MOST_TRIANGLES, "triangles"),
                                  (number + 1, MOST_PARTS, "parts")):
            if count > most:
                document.refuse(f"it has {count:,} {what} or more; at most {most:,} are allowed")
        if size[1]:
            found.append(Instance(node, skin, entry))
        else:
            others.append(entry.place)
    if not found:
        document.refuse("its scene holds only points or lines; triangles are needed" if others else
                        "its scene holds no mesh, so there is nothing to show")
    return found, [f"{others[0]} has no triangles; it is left out."] if others else []


def _hanging(document: Document, nodes: Sequence[int]) -> Iterator[tuple[int, int | None, Entry]]:
    for node in nodes:
        entry = document.entry("nodes", node)
        mesh, skin = entry.index("mesh", "meshes"), entry.index("skin", "skins")
        if mesh is not None:
            for primitive in document.entry("meshes", mesh).children("primitives"):
                yield node, skin, primitive


def _skinned(instance: Instance, skin: int, primitive: Primitive, palette: Palette) -> Piece:
    """Joints count within the skin; the node on which a skinned mesh hangs does not move it."""
    influences = primitive.influences
    assert influences is not None
    start, count = palette.skin(skin)
    outside = (influences.weights > 0.0) & (influences.joints >= count)
    if outside.any():
        vertex = int(np.nonzero(outside.any(axis=1))[0][0])
        joint = int(influences.joints[outside][0])
        instance.entry.document.refuse(f"{instance.entry.place} has joint {joint:,} at vertex {vertex:,}; "
                                       f"skins[{skin}] has {count:,} joints, so 0 to {count - 1:,} are allowed")
    return Piece(primitive, np.where(influences.weights > 0.0, influences.joints, 0) + np.int32(start),
                 influences.weights)


def _rigid(instance: Instance, primitive: Primitive, palette: Palette) -> Piece:
    count = len(primitive.positions)
    return Piece(primitive, np.full((count, 1), palette.node(instance.node), np.int32), np.ones((count, 1), np.float32))


def _why_rigid(instance: Instance, primitive: Primitive) -> list[str]:
    if instance.skin is not None:
        return [f"{instance.entry.place} has no joints, so it does not follow its skin."]
    if primitive.influences is not None:
        return [f"{instance.entry.place} has joints but no skin, so it is rigid."]
    return []


def _joined(pieces: list[Piece], nodes: Nodes, palette: Palette) -> RiggedMesh:
    """The pieces' vertices one after another; where the pose at rest mirrors them, turned inside out to match."""
    counts = [len(piece.primitive.positions) for piece in pieces]
    first = np.cumsum([0, *counts[:-1]])
    width = max(4, *(piece.weights.shape[1] for piece in pieces))
    bones, inverse_bind = palette.arrays()
    joints = np.concatenate([_widened(piece.bones, width) for piece in pieces])
    weights = np.concatenate([_widened(piece.weights, width) for piece in pieces])
    triangles = np.concatenate([piece.primitive.triangles + np.int32(start)
                                for piece, start in zip(pieces, first, strict=True)])
    normals = np.concatenate([piece.primitive.normals for piece in pieces])
    with np.errstate(over="ignore", invalid="ignore"):          # looked for when the model is checked
        mirrors = np.linalg.det((nodes.skeleton.world()[bones] @ inverse_bind)[:, :3, :3]) < 0.0
    if mirrors.any():
        mirrored = mirrors[np.take_along_axis(joints, weights.argmax(axis=1)[:, None], axis=1)[:, 0]]
        inside_out = mirrored[triangles[:, 0]]
        triangles[inside_out] = triangles[inside_out][:, ::-1]
        normals[mirrored] *= -1.0
    return RiggedMesh(np.concatenate([piece.primitive.positions for piece in pieces]), normals,
                      np.concatenate([piece.primitive.texcoords for piece in pieces]),
                      joints, weights, triangles, nodes.skeleton, bones, inverse_bind)


def _widened(values: NDArray[np.generic], width: int) -> NDArray[np.generic]:
    """Rows filled up with zeros."""
    return np.pad(values, ((0, 0), (0, width - values.shape[1])))
