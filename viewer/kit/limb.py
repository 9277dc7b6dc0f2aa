"""A limb: a bone that twists against its parent, the skin between them, and extra bones that share the twist."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from viewer.kit import quaternion
from viewer.kit.quaternion import Numbers
from viewer.kit.rig import RiggedMesh
from viewer.kit.skinning import palette, swing_twist

SAME_PLACE = 1e-6       # of a model's size: joints that are nearer to each other are one
WHOLE = 0.999           # of a vertex's weight that the two bones must hold for it to be theirs alone
OFF_AXIS = 0.04         # of the limb's length: what is nearer to the axis has no radius to speak of
MIXED = 1e-3            # how far from 0 and 1 a share has to be to count as blended
# How weights pass from one bone to the next, over what was an even way from 0 to 1.
FALLOFFS: dict[str, Callable[[Numbers], Numbers]] = {
    "linear": lambda share: share,
    "smooth": lambda share: share * share * (3.0 - 2.0 * share),
    "narrow": lambda share: np.clip(3.0 * share - 1.0, 0.0, 1.0),
}


@dataclass(frozen=True, eq=False)
class Limb:
    """The skin between palette entries ``upper`` and ``lower``, whose joints are ``start`` and ``end`` when bound.

    ``lower`` twists about the line between them. A vertex' ``share`` (n,) is the part of both bones' weight that
    ``lower`` has; ``held`` (n,) is what both have together; ``along`` (n,) is its place, 0 at ``start``, 1 at ``end``;
    ``radius`` (n,) its distance from the line.
    """

    mesh: RiggedMesh
    upper: int
    lower: int
    start: Numbers
    end: Numbers

    @cached_property
    def axis(self) -> Numbers:
        """The direction of the line, (3,), of length one."""
        return np.asarray((self.end - self.start) / self.length)

    @cached_property
    def length(self) -> float:
        """From joint to joint."""
        return float(np.linalg.norm(self.end - self.start))

    @cached_property
    def across(self) -> tuple[Numbers, Numbers]:
        """Two directions at right angles to the axis and to each other; the first near x, y or z."""
        helper = np.eye(3)[np.argmin(np.abs(self.axis))]
        first = helper - self.axis * (helper @ self.axis)
        first /= np.linalg.norm(first)
        return first, np.cross(self.axis, first)

    @cached_property
    def _weights(self) -> tuple[Numbers, Numbers]:
        weights = self.mesh.weights.astype(np.float64)
        upper, lower = (np.where(self.mesh.joints == bone, weights, 0.0).sum(axis=1)
                        for bone in (self.upper, self.lower))
        return upper, lower

    @cached_property
    def held(self) -> Numbers:
        """What both bones together weigh at each vertex."""
        return np.asarray(self._weights[0] + self._weights[1])

    @cached_property
    def share(self) -> Numbers:
        """The lower bone's part of that; 0 where it is nothing."""
        return np.divide(self._weights[1], self.held, out=np.zeros(len(self.held)), where=self.held > 0.0)

    @cached_property
    def along(self) -> Numbers:
        """Where each vertex lies on the line, 0 at the upper joint, 1 at the lower."""
        return np.asarray((self.mesh.positions.astype(np.float64) - self.start) @ self.axis / self.length)

    @cached_property
    def radius(self) -> Numbers:
        """How far each vertex is from the line."""
        return distances(self.mesh.positions.astype(np.float64), self.start, self.axis)

    @cached_property
    def measured(self) -> NDArray[np.intp]:
        """The vertices that belong to both bones alone, with a radius, in the order of their places."""
        theirs = (self.held > WHOLE) & (self.radius > OFF_AXIS * self.length)
        zone = self.along[theirs & (self.share > MIXED) & (self.share < 1.0 - MIXED)]
        if not len(zone):
            return np.zeros(0, np.intp)
        reach = 0.08 * (zone.max() - zone.min()) + 1e-6
        theirs &= (self.along >= zone.min() - reach) & (self.along <= zone.max() + reach)
        chosen = np.nonzero(theirs)[0]
        return np.asarray(chosen[np.argsort(self.along[chosen], kind="stable")])

    @cached_property
    def zone(self) -> tuple[float, float]:
        """Between which places the weights pass from the upper to the lower bone; 0 to 1 where they nowhere mix."""
        mixed = (self.held > WHOLE) & (self.share > MIXED) & (self.share < 1.0 - MIXED)
        return (float(self.along[mixed].min()), float(self.along[mixed].max())) if mixed.any() else (0.0, 1.0)


def distances(points: Numbers, origin: Numbers, axis: Numbers) -> Numbers:
    """How far ``points`` (n, 3) are from the line through ``origin`` along ``axis`` of length one: (n,)."""
    away = points - origin
    return np.asarray(np.linalg.norm(away - np.outer(away @ axis, axis), axis=1))


def limb_at(mesh: RiggedMesh, bone: int) -> Limb | None:
    """The limb that the palette entry ``bone`` ends, or None where no bone is before it.

    Where both have the same joint, the limb goes from the middle of one's skin to that of the other's.
    """
    upper = int(parent_bones(mesh)[bone])
    if upper < 0:
        return None
    start, end = (bound_joint(mesh, entry) for entry in (upper, bone))
    if np.linalg.norm(end - start) <= SAME_PLACE * np.ptp(mesh.positions, axis=0).max():
        middles = [_middle_of_skin(mesh, entry) for entry in (upper, bone)]
        way = middles[1] - middles[0]
        size = float(np.linalg.norm(way))
        if not size:
            return None
        start, end = (end + way * (way @ (middle - end)) / size**2 for middle in middles)
    return Limb(mesh, upper, bone, start, end) if np.linalg.norm(end - start) > 0.0 else None


def bound_joint(mesh: RiggedMesh, bone: int) -> Numbers:
    """Where the joint of a palette entry was when the mesh was bound, (3,)."""
    return np.asarray(np.linalg.inv(mesh.inverse_bind[bone])[:3, 3])


def _middle_of_skin(mesh: RiggedMesh, bone: int) -> Numbers:
    """The mean place of the vertices that follow a bone, by weight; the origin where none does."""
    weights = np.where(mesh.joints == bone, mesh.weights.astype(np.float64), 0.0).sum(axis=1)
    return np.asarray(weights @ mesh.positions / max(float(weights.sum()), 1e-30))


def with_falloff(limb: Limb, falloff: str) -> Limb:
    """The limb with other weights: each vertex' share of the twist is bent by one of ``FALLOFFS``."""
    if falloff == "linear":
        return limb
    weights = limb.mesh.weights.astype(np.float64)
    rows = np.nonzero((limb.share > 0.0) & (limb.share < 1.0))[0]
    share = FALLOFFS[falloff](limb.share)
    near, far = _slots(limb)
    weights[rows, near[rows]] = ((1.0 - share) * limb.held)[rows]
    weights[rows, far[rows]] = (share * limb.held)[rows]
    return Limb(replace(limb.mesh, weights=weights.astype(np.float32)), limb.upper, limb.lower, limb.start, limb.end)


@lru_cache(maxsize=4)
def parent_bones(mesh: RiggedMesh) -> NDArray[np.int64]:
    """For each entry of the palette that of the nearest joint above its own, -1 where there is none: (b,)."""
    entry_of = {int(joint): entry for entry, joint in reversed(list(enumerate(mesh.bones)))}
    parents = mesh.skeleton.parents
    found = np.full(len(mesh.bones), -1)
    for entry, joint in enumerate(mesh.bones):
        above = int(parents[joint])
        while above >= 0 and above not in entry_of:
            above = int(parents[above])
        found[entry] = entry_of.get(above, -1)
    return found


@lru_cache(maxsize=4)
def most_blended_bone(mesh: RiggedMesh) -> int:
    """The palette entry that shares the most of the skin with its parent: where a twist has most to collapse.

    Its own joint counts as well as whatever mixes; where nothing mixes, the last bone that has a parent, or 0.
    """
    parents, mixed = parent_bones(mesh), np.zeros(len(mesh.bones))
    for entry in np.nonzero(parents >= 0)[0]:
        limb = limb_at(mesh, int(entry))
        if limb:
            weight = limb.held * limb.share
            mixed[entry] = np.minimum(weight, limb.held - weight).sum() * limb.length
    if mixed.max(initial=0.0) > 0.0:
        return int(mixed.argmax())
    return int(np.nonzero(parents >= 0)[0][-1]) if (parents >= 0).any() else 0


def with_twist_bones(limb: Limb, count: int) -> tuple[NDArray[np.int32], NDArray[np.float32]]:
    """Joints and weights (n, k) that follow ``count`` more bones between the two, evenly spaced by share.

    Extra bone i, from 1, is entry b + i - 1 of the palette. What the two bones held of a vertex goes to the nearest
    two of the chain: to each by how near it is, so that the weights' sums stay.
    """
    mesh = limb.mesh
    joints, weights = mesh.joints.copy(), mesh.weights.astype(np.float64)
    if not count:
        return joints, weights.astype(np.float32)
    chain = np.array([limb.upper, *(len(mesh.bones) + np.arange(count)), limb.lower], np.int32)
    place = limb.share * (count + 1)
    step = np.minimum(place.astype(int), count)
    later = place - step
    near, far = _slots(limb)
    rows = np.nonzero((limb.held > 0.0) & (limb.share > 0.0) & (limb.share < 1.0))[0]
    weights[rows] = np.where((joints[rows] == limb.upper) | (joints[rows] == limb.lower), 0.0, weights[rows])
    for column, bone, part in ((near, chain[step], 1.0 - later), (far, chain[step + 1], later)):
        joints[rows, column[rows]] = bone[rows]
        weights[rows, column[rows]] = (part * limb.held)[rows]
    return joints, weights.astype(np.float32)


def _slots(limb: Limb) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """In which column each vertex has the upper, and in which the lower bone."""
    held = limb.mesh.weights > 0.0
    upper, lower = (np.argmax((limb.mesh.joints == bone) & held, axis=1) for bone in (limb.upper, limb.lower))
    return upper, lower


def twisted_palette(limb: Limb, local: Numbers, degrees: float, count: int = 0) -> Numbers:
    """The palette (b + count, 4, 4) of the pose ``local`` (j, 4, 4) with the lower bone twisted further by ``degrees``.

    Whatever hangs on the lower bone twists along. Extra bone i has i / (count + 1) of the twist, and as much of what
    the pose swings and twists at the joint.
    """
    mesh, turn = limb.mesh, np.radians(degrees)
    straight = mesh.palette(local)
    joint = mesh.bones[limb.lower]
    own_axis = mesh.inverse_bind[limb.lower][:3, :3] @ limb.axis
    twisting = np.eye(4)
    twisting[:3, :3] = quaternion.to_matrix(quaternion.from_axis_angle(own_axis, turn))
    twisted = np.array(local)
    twisted[joint] = twisted[joint] @ twisting
    moved = palette(mesh.skeleton.world(twisted)[mesh.bones], mesh.inverse_bind)
    if not count:
        return moved
    bend = np.linalg.inv(straight[limb.upper]) @ straight[limb.lower]
    parts = np.arange(1, count + 1) / (count + 1)
    return np.concatenate([moved, straight[limb.upper] @ _partly(limb, bend, parts, turn)])


def _partly(limb: Limb, bend: Numbers, parts: Numbers, turn: float) -> Numbers:
    """``parts`` (c,) of the motion ``bend`` (4, 4) at the lower joint, after as large a part of the ``turn``."""
    rotation = quaternion.nearest_rotation(bend[:3, :3])
    stretch = quaternion.to_matrix(quaternion.conjugate(rotation)) @ bend[:3, :3]
    swing, twist = swing_twist(rotation, limb.axis)
    share = parts[:, None]
    turned = quaternion.multiply(quaternion.slerp(quaternion.IDENTITY, np.broadcast_to(swing, (len(parts), 4)), parts),
                                 quaternion.slerp(quaternion.IDENTITY, np.broadcast_to(twist, (len(parts), 4)), parts))
    twisted = quaternion.from_axis_angle(np.broadcast_to(limb.axis, (len(parts), 3)), parts * turn)
    linear = quaternion.to_matrix(turned) @ (np.eye(3) + share[:, :, None] * (stretch - np.eye(3)))
    linear = linear @ quaternion.to_matrix(twisted)
    joint = bound_joint(limb.mesh, limb.lower)
    places = joint + share * (bend[:3, :3] @ joint + bend[:3, 3] - joint)
    matrices = np.tile(np.eye(4), (len(parts), 1, 1))
    matrices[:, :3, :3] = linear
    matrices[:, :3, 3] = places - linear @ joint
    return matrices
