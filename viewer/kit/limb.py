"""A limb: a bone that twists against its parent, the skin between them, and extra bones that share the twist."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from viewer.kit.quaternion import Numbers
from viewer.kit.rig import RiggedMesh

SAME_PLACE = 1e-6       # of a model's size: joints that are nearer to each other are one
WHOLE = 0.999           # of a vertex's weight that the two bones must hold for it to be theirs alone
OFF_AXIS = 0.04         # of the limb's length: what is nearer to the axis has no radius to speak of
MIXED = 1e-3            # by how much the share has to differ within a triangle for it to count as blended
BESIDE = 0.08           # of the way over which weights pass: so far beyond it the limb is measured too
# How weights pass from one bone to the next, over what was an even way from 0 to 1.
FALLOFFS: dict[str, Callable[[Numbers], Numbers]] = {
    "linear": lambda share: share,
    "smooth": lambda share: share * share * (3.0 - 2.0 * share),
    "narrow": lambda share: np.clip(3.0 * share - 1.0, 0.0, 1.0),
}


@dataclass(frozen=True, eq=False)
class Limb:
    """The skin between palette entries ``upper`` and ``lower``, whose joints are ``start`` and ``end`` when bound.

    ``lower`` twists about the line between them. A vertex's ``share`` (n,) is the part of both bones' weight that
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
    def zone(self) -> tuple[float, float]:
        """Between which places the weights pass from the upper to the lower bone; 0 to 1 where they nowhere do."""
        triangles = self.mesh.triangles[(self.held > WHOLE)[self.mesh.triangles].all(axis=1)]
        passing = triangles[np.ptp(self.share[triangles], axis=1) > MIXED] if len(triangles) else triangles
        along = self.along[passing]
        return (float(along.min()), float(along.max())) if len(passing) else (0.0, 1.0)

    @cached_property
    def measured(self) -> NDArray[np.intp]:
        """The vertices there that belong to both bones alone, with a radius, in the order of their places."""
        low, high = self.zone
        reach = BESIDE * (high - low)
        theirs = (self.held > WHOLE) & (self.radius > OFF_AXIS * self.length)
        chosen = np.nonzero(theirs & (self.along >= low - reach) & (self.along <= high + reach))[0]
        return np.asarray(chosen[np.argsort(self.along[chosen], kind="stable")])


def distances(points: Numbers, origin: Numbers, axis: Numbers) -> Numbers:
    """How far ``points`` (n, 3) are from the line through ``origin`` along ``axis`` of length one: (n,)."""
    away = points - origin
    return np.asarray(np.linalg.norm(away - np.outer(away @ axis, axis), axis=1))


def size_of(matrix: Numbers) -> float:
    """How many times larger a matrix (4, 4) makes things; 1 where it makes nothing of them."""
    return float(np.cbrt(abs(np.linalg.det(matrix[:3, :3])))) or 1.0


def limb_at(mesh: RiggedMesh, bone: int) -> Limb | None:
    """The limb that the palette entry ``bone`` ends, or None where no bone is before it.

    Where both have the same joint, the limb goes from the middle of one's skin to that of the other's.
    """
    upper = int(mesh.bone_parents[bone])
    if upper < 0:
        return None
    start, end = mesh.bound_frames[[upper, bone], :3, 3]
    if np.linalg.norm(end - start) <= SAME_PLACE * np.ptp(mesh.positions, axis=0).max():
        middles = [_middle_of_skin(mesh, entry) for entry in (upper, bone)]
        way = middles[1] - middles[0]
        size = float(np.linalg.norm(way))
        if not size:
            return None
        start, end = (end + way * (way @ (middle - end)) / size**2 for middle in middles)
    return Limb(mesh, upper, bone, start, end) if np.linalg.norm(end - start) > 0.0 else None


def _middle_of_skin(mesh: RiggedMesh, bone: int) -> Numbers:
    """The mean place of the vertices that follow a bone, by weight; the origin where none does."""
    weights = np.where(mesh.joints == bone, mesh.weights.astype(np.float64), 0.0).sum(axis=1)
    return np.asarray(weights @ mesh.positions / max(float(weights.sum()), 1e-30))


def with_falloff(limb: Limb, falloff: str) -> Limb:
    """The limb with other weights: each vertex's share of the twist is bent by one of ``FALLOFFS``."""
    if falloff == "linear":
        return limb
    weights = limb.mesh.weights.astype(np.float64)
    rows = np.nonzero((limb.share > 0.0) & (limb.share < 1.0))[0]
    share = FALLOFFS[falloff](limb.share)
    near, far = slots(limb)
    weights[rows] = without_pair(limb)[rows]
    weights[rows, near[rows]] = ((1.0 - share) * limb.held)[rows]
    weights[rows, far[rows]] = (share * limb.held)[rows]
    return Limb(replace(limb.mesh, weights=weights.astype(np.float32)), limb.upper, limb.lower, limb.start, limb.end)


def most_blended_bone(mesh: RiggedMesh) -> int:
    """The palette entry that shares the most of the skin with its parent: where a twist has most to collapse.

    Each vertex counts by the smaller of both weights, and the length of the bone before it counts as well. Where
    nothing mixes it is the last bone that has a parent, or 0.
    """
    parents, joints, mixed = mesh.bone_parents, mesh.joints, np.zeros(len(mesh.bones))
    for own in range(joints.shape[1]):
        for other in range(joints.shape[1]):
            both = np.minimum(mesh.weights[:, own], mesh.weights[:, other])
            rows = (parents[joints[:, own]] == joints[:, other]) & (both > 0.0) & (own != other)
            mixed += np.bincount(joints[rows, own], both[rows], len(mixed))
    places = mesh.bound_frames[:, :3, 3]
    length = np.linalg.norm(places - places[np.maximum(parents, 0)], axis=1)
    mixed *= np.maximum(length, SAME_PLACE * np.ptp(mesh.positions, axis=0).max())
    if mixed.max(initial=0.0) > 0.0:
        return int(mixed.argmax())
    return int(np.nonzero(parents >= 0)[0][-1]) if (parents >= 0).any() else 0


def without_pair(limb: Limb) -> Numbers:
    """The weights (n, k) of all other bones, with zeros for the limb's two."""
    pair = (limb.mesh.joints == limb.upper) | (limb.mesh.joints == limb.lower)
    return np.where(pair, 0.0, limb.mesh.weights.astype(np.float64))


def slots(limb: Limb) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """In which column each vertex has the upper, and in which the lower bone."""
    held = limb.mesh.weights > 0.0
    upper, lower = (np.argmax((limb.mesh.joints == bone) & held, axis=1) for bone in (limb.upper, limb.lower))
    return upper, lower
