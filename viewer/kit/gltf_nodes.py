"""The nodes of a glTF file as the joints of one skeleton."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from viewer.kit import quaternion
from viewer.kit.gltf_document import Document, Entry
from viewer.kit.rig import Skeleton

MOST_NODES = 2**14
SHEARED_BEYOND = 1e-3           # the cosine between two axes of a matrix that ought to be at right angles
AT_REST = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0), (1.0, 1.0, 1.0))

Vectors = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Nodes:
    """``skeleton``, and for each node of the file the joint that it became, ``joint_of`` (nodes,), or -1.

    ``shown`` lists the nodes of the scene, each after its parent.
    """

    skeleton: Skeleton
    joint_of: NDArray[np.int32]
    shown: list[int]
    notes: list[str]


def read_nodes(document: Document) -> Nodes:
    """The nodes of the default scene, and those that the skins of its meshes need.

    Raises ModelFileError for too many nodes, for cycles and second parents, and for a scene without nodes.
    """
    count = len(document.entries("nodes"))
    if not count:
        document.refuse("it has no nodes, so there is nothing to show")
    if count > MOST_NODES:
        document.refuse(f"it has {count:,} nodes; at most {MOST_NODES:,} are allowed")
    children = [entry.indices("children", "nodes") for entry in document.entries("nodes")]
    parents = _parents(document, children)
    order = _from_the_roots(document, children, parents)
    shown = set(_below(_scene_roots(document, parents), children))
    kept = shown | set(_above(_skin_joints(document, shown), parents))
    nodes = [node for node in order if node in kept]
    joint_of = np.full(count, -1, np.int32)
    joint_of[nodes] = np.arange(len(nodes))
    above = np.array([joint_of[parents[node]] if parents[node] >= 0 else -1 for node in nodes], np.int32)
    entries = [document.entry("nodes", node) for node in nodes]
    placed, notes = _placed(entries)
    skeleton = Skeleton(_names(nodes, entries), above, *placed)
    return Nodes(skeleton, joint_of, [node for node in nodes if node in shown], notes)


def _parents(document: Document, children: list[list[int]]) -> list[int]:
    parents = [-1] * len(children)
    for parent, below in enumerate(children):
        for child in below:
            if parents[child] >= 0:
                document.refuse(f"nodes[{child}] is a child of nodes[{parents[child]}] and of nodes[{parent}]; "
                                "one parent is allowed")
            parents[child] = parent
    return parents


def _from_the_roots(document: Document, children: list[list[int]], parents: list[int]) -> list[int]:
    """All nodes, each after its parent; since each has one parent at most, what is not reached goes in a circle."""
    order = _below([node for node, parent in enumerate(parents) if parent < 0], children)
    if len(order) < len(children):
        circling = min(set(range(len(children))) - set(order))
        document.refuse(f"nodes[{circling}] is below itself; the nodes must form trees")
    return order


def _below(roots: Iterable[int], children: list[list[int]]) -> list[int]:
    """The roots and all their descendants, depth first."""
    found, waiting = [], list(roots)[::-1]
    while waiting:
        node = waiting.pop()
        found.append(node)
        waiting += children[node][::-1]
    return found


def _above(nodes: Iterable[int], parents: list[int]) -> set[int]:
    """The nodes and all their ancestors."""
    found: set[int] = set()
    for start in nodes:
        node = start
        while node >= 0 and node not in found:
            found.add(node)
            node = parents[node]
    return found


def _scene_roots(document: Document, parents: list[int]) -> list[int]:
    """Where the default scene begins, which is the first if none is named; all roots in a file without scenes."""
    number = document.root.index("scene", "scenes")
    if not document.entries("scenes"):
        return [node for node, parent in enumerate(parents) if parent < 0]
    scene = document.entry("scenes", number or 0)
    roots = list(dict.fromkeys(scene.indices("nodes", "nodes")))
    if not roots:
        document.refuse(f"{scene.place} has no nodes, so there is nothing to show")
    for node in roots:
        if parents[node] >= 0:
            document.refuse(f"{scene.place} begins with nodes[{node}], a child of nodes[{parents[node]}]; "
                            "nodes without a parent are needed")
    return roots


def _skin_joints(document: Document, shown: Iterable[int]) -> set[int]:
    """The nodes that skins of shown nodes bind to, which may lie outside the scene."""
    skins = {document.entry("nodes", node).index("skin", "skins") for node in shown}
    return {joint for skin in skins if skin is not None
            for joint in document.entry("skins", skin).indices("joints", "nodes")}


def _names(nodes: list[int], entries: list[Entry]) -> tuple[str, ...]:
    """A name for each node that no other has."""
    names: dict[str, int] = {}              # and how often it was wanted
    for node, entry in zip(nodes, entries, strict=True):
        name = wanted = entry.label() or f"node {node}"
        while name in names:
            names[wanted] += 1
            name = f"{wanted} ({names[wanted]})"
        names[name] = 1
    return tuple(names)


def _placed(entries: list[Entry]) -> tuple[tuple[Vectors, Vectors, Vectors], list[str]]:
    """Where each node stands in its parent's frame: translations, rotations and scales, and what to say about them."""
    translations, rotations, scales = (np.tile(value, (len(entries), 1)) for value in AT_REST)
    given, matrices = [], []
    for joint, entry in enumerate(entries):
        matrix = entry.numbers("matrix", 16)
        if matrix is not None:
            _check_affine(entry, matrix)
            given.append(joint)
            matrices.append(matrix.reshape(4, 4).T)
        for name, values in (("translation", translations), ("rotation", rotations), ("scale", scales)):
            numbers = entry.numbers(name, values.shape[1])
            if numbers is not None:
                values[joint] = numbers
        if not rotations[joint].any():
            entry.refuse("rotation", "a quaternion of length one is needed")
    notes = []
    if given:
        stacked = np.array(matrices)
        translations[given], (rotations[given], scales[given], sheared) = stacked[:, :3, 3], _turn_and_scale(stacked)
        notes = [f"{entries[given[which]].place} has a matrix that shears; it is shown without the shear."
                 for which in np.nonzero(sheared)[0][:1]]
    return (translations, quaternion.normalised(rotations), scales), notes


def _check_affine(entry: Entry, matrix: NDArray[np.float64]) -> None:
    if (np.abs(matrix[3::4] - (0.0, 0.0, 0.0, 1.0)) > 1e-4).any():
        entry.document.refuse(f"{entry.named('matrix')} has the last row {matrix[3::4].tolist()}; 0, 0, 0, 1 is needed")


def _turn_and_scale(matrices: NDArray[np.float64]) -> tuple[Vectors, Vectors, NDArray[np.bool_]]:
    """Rotations (n, 4) and scales (n, 3) of matrices (n, 4, 4) that turn after they scale; where they shear as well.

    A mirror image is a negative scale along x. An axis without length is put at right angles to the others.
    """
    axes = np.swapaxes(matrices[:, :3, :3], 1, 2)                       # one in each row
    scales = np.linalg.norm(axes, axis=2)
    units = np.divide(axes, scales[:, :, None], out=np.zeros_like(axes), where=scales[:, :, None] > 0.0)
    cosines = np.abs(units @ np.swapaxes(units, 1, 2))[:, (0, 1, 2), (1, 2, 0)]
    left, _, right = np.linalg.svd(units)                               # the nearest axes at right angles
    turns = left @ right
    flat = (scales <= 0.0).any(axis=1)
    mirrored = np.linalg.det(turns) < 0.0
    turns[mirrored & ~flat, 0] *= -1.0
    scales[mirrored & ~flat, 0] *= -1.0
    turns[mirrored & flat] = _completed(turns[mirrored & flat], scales[mirrored & flat])
    return quaternion.from_matrix(np.swapaxes(turns, 1, 2)), scales, (cosines > SHEARED_BEYOND).any(axis=1)


def _completed(turns: Vectors, scales: Vectors) -> Vectors:
    """Left-handed axes (n, 3, 3), made right-handed by turning the first one around that has no length."""
    turns[np.arange(len(turns)), np.argmax(scales <= 0.0, axis=1)] *= -1.0
    return turns
