"""Skeletons, and meshes that are bound to them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from viewer.kit import quaternion, skinning

Matrices = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Skeleton:
    """Joints in a tree, each after its parent, and how they stand at rest, each within its parent's frame.

    ``parents`` (j,) int32 is -1 for a root; ``translations`` (j, 3), ``rotations`` (j, 4) as (x, y, z, w) and
    ``scales`` (j, 3). Raises ValueError where a parent does not come before its child.
    """

    names: tuple[str, ...]
    parents: NDArray[np.int32]
    translations: NDArray[np.float64]
    rotations: NDArray[np.float64]
    scales: NDArray[np.float64]

    def __post_init__(self) -> None:
        if not (len(self.names) == len(self.parents) == len(self.translations) == len(self.rotations)
                == len(self.scales)):
            raise ValueError("a skeleton's arrays differ in length")
        if (self.parents >= np.arange(len(self.parents))).any() or (self.parents < -1).any():
            raise ValueError("a skeleton's joint comes before its parent")

    @cached_property
    def _levels(self) -> list[NDArray[np.intp]]:
        """The joints by depth, so that all of one depth are placed at once."""
        depth = np.zeros(len(self.parents), int)
        for joint, parent in enumerate(self.parents):
            depth[joint] = depth[parent] + 1 if parent >= 0 else 0
        return [np.nonzero(depth == level)[0] for level in range(int(depth.max(initial=-1)) + 1)]

    def local(self, translations: ArrayLike | None = None, rotations: ArrayLike | None = None,
              scales: ArrayLike | None = None) -> Matrices:
        """Each joint in its parent's frame, (j, 4, 4) for columns; what is left out is as at rest."""
        return composed(self.translations if translations is None else translations,
                        self.rotations if rotations is None else rotations,
                        self.scales if scales is None else scales)

    def world(self, local: Matrices | None = None) -> Matrices:
        """Each joint in the skeleton's own space, (j, 4, 4), from ``local`` (j, 4, 4) or at rest."""
        placed = np.array(self.local() if local is None else local, np.float64)
        for joints in self._levels[1:]:
            placed[joints] = placed[self.parents[joints]] @ placed[joints]
        return placed


@dataclass(frozen=True, eq=False)
class RiggedMesh:
    """A mesh whose vertices follow bones.

    ``positions`` and ``normals`` (n, 3), ``texcoords`` (n, 2), ``weights`` (n, k) float32, each row with the sum 1;
    ``joints`` (n, k) int32 say which entries of the palette they weigh; ``triangles`` (m, 3) int32. Entry b of the
    palette follows joint ``bones[b]`` of the skeleton, and ``inverse_bind[b]`` (4, 4) takes the mesh into its frame.
    """

    positions: NDArray[np.float32]
    normals: NDArray[np.float32]
    texcoords: NDArray[np.float32]
    joints: NDArray[np.int32]
    weights: NDArray[np.float32]
    triangles: NDArray[np.int32]
    skeleton: Skeleton
    bones: NDArray[np.int32]
    inverse_bind: Matrices

    def palette(self, local: Matrices | None = None) -> Matrices:
        """What takes each bone's vertices from where they were bound to where they are: (b, 4, 4)."""
        return skinning.palette(self.skeleton.world(local)[self.bones], self.inverse_bind)

    @cached_property
    def bound_frames(self) -> Matrices:
        """Where the bones' frames were when the mesh was bound, (b, 4, 4); of those with no way back, the nearest."""
        singular = np.linalg.det(self.inverse_bind) == 0.0
        frames = np.empty_like(self.inverse_bind)
        frames[~singular] = np.linalg.inv(self.inverse_bind[~singular])
        frames[singular] = np.linalg.pinv(self.inverse_bind[singular])
        return frames

    @cached_property
    def bone_parents(self) -> NDArray[np.int64]:
        """For each entry of the palette that of the nearest joint above its own, -1 where there is none: (b,)."""
        entry_of = {int(joint): entry for entry, joint in reversed(list(enumerate(self.bones)))}
        entry_above = np.full(len(self.skeleton.parents), -1)
        for joint, parent in enumerate(self.skeleton.parents.tolist()):
            if parent >= 0:
                entry_above[joint] = entry_of.get(parent, entry_above[parent])
        return np.asarray(entry_above[self.bones], np.int64)

    @property
    def influences(self) -> int:
        """The most bones that any vertex follows."""
        return int((self.weights > 0.0).sum(axis=1).max(initial=0))


def composed(translations: ArrayLike, rotations: ArrayLike, scales: ArrayLike) -> Matrices:
    """Matrices (..., 4, 4) for columns that scale (..., 3), then turn (..., 4), then move (..., 3)."""
    translations, scales = np.asarray(translations, np.float64), np.asarray(scales, np.float64)
    matrices = np.zeros((*translations.shape[:-1], 4, 4))
    matrices[..., :3, :3] = quaternion.to_matrix(quaternion.normalised(rotations)) * scales[..., None, :]
    matrices[..., :3, 3] = translations
    matrices[..., 3, 3] = 1.0
    return matrices


def bound_at_rest(skeleton: Skeleton, bones: ArrayLike) -> Matrices:
    """The inverse bind matrices (b, 4, 4) of a mesh that was modelled around the skeleton at rest."""
    return np.asarray(np.linalg.inv(skeleton.world()[np.asarray(bones)]))
