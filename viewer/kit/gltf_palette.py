"""What the vertices of a glTF file follow: the joints of its skins, and the nodes on which rigid meshes hang."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from viewer.kit.gltf_accessor import FLOAT, Accessors
from viewer.kit.gltf_document import Document, Entry
from viewer.kit.gltf_nodes import MOST_NODES

MOST_BONES = MOST_NODES
AFFINE_WITHIN = 1e-3            # of the last row of a matrix to 0, 0, 0, 1


class Palette:
    """Bones as they are asked for: each joint of a skin with its inverse bind matrix, and each node by itself."""

    def __init__(self, document: Document, accessors: Accessors, joint_of: NDArray[np.int32]) -> None:
        self._document = document
        self._accessors = accessors
        self._joint_of = joint_of
        self._bones: list[NDArray[np.int32]] = []
        self._inverse_bind: list[NDArray[np.float64]] = []
        self._skins: dict[int, tuple[int, int]] = {}
        self._nodes: dict[int, int] = {}
        self._count = 0

    def skin(self, number: int) -> tuple[int, int]:
        """Where the joints of a skin begin in the palette, and how many they are."""
        if number not in self._skins:
            entry = self._document.entry("skins", number)
            joints = entry.indices("joints", "nodes")
            if not joints:
                entry.document.refuse(f"{entry.place} has no joints; at least one is needed")
            bones = self._joint_of[joints]
            self._skins[number] = self._add(bones, self._inverse_bind_of(entry, len(joints))), len(joints)
        return self._skins[number]

    def node(self, number: int) -> int:
        """The bone that moves what hangs on a node."""
        if number not in self._nodes:
            self._nodes[number] = self._add(self._joint_of[[number]], np.eye(4)[None])
        return self._nodes[number]

    def arrays(self) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
        """The joint that each bone follows, (b,), and the inverse bind matrices, (b, 4, 4)."""
        return np.concatenate(self._bones), np.concatenate(self._inverse_bind)

    def _add(self, bones: NDArray[np.int32], inverse_bind: NDArray[np.float64]) -> int:
        start = self._count
        self._count += len(bones)
        if self._count > MOST_BONES:
            self._document.refuse(f"its skins and meshes have {self._count:,} bones; "
                                  f"at most {MOST_BONES:,} are allowed")
        self._bones.append(bones)
        self._inverse_bind.append(inverse_bind)
        return start

    def _inverse_bind_of(self, skin: Entry, count: int) -> NDArray[np.float64]:
        number = skin.index("inverseBindMatrices", "accessors")
        if number is None:
            return np.tile(np.eye(4), (count, 1, 1))
        if self._accessors.count(number) < count:
            skin.document.refuse(f"{skin.place} has {count:,} joints and {self._accessors.count(number):,} inverse "
                                 "bind matrices; one for each is needed")
        columns = self._accessors.floats(number, "MAT4", MOST_BONES, FLOAT)[:count].astype(np.float64)
        matrices = np.swapaxes(columns.reshape(count, 4, 4), 1, 2)
        wrong = np.nonzero(np.abs(matrices[:, 3] - (0.0, 0.0, 0.0, 1.0)).max(axis=1) > AFFINE_WITHIN)[0]
        if len(wrong):
            skin.document.refuse(f"{skin.place} has the inverse bind matrix {wrong[0]} with the last row "
                                 f"{matrices[wrong[0], 3].tolist()}; 0, 0, 0, 1 is needed")
        matrices[:, 3] = (0.0, 0.0, 0.0, 1.0)
        return matrices
