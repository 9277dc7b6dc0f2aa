"""Skinning: each vertex follows several bones at once, by weights.

Linear blend skinning (Magnenat-Thalmann, Laperriere and Thalmann 1988) averages where the bones would take the
vertex. Dual quaternion skinning (Kavan, Collins, Zara and O'Sullivan 2008) averages the bones' motions and
normalises the average, so that it is a rigid motion again. All arrays are one row a vertex:
positions (n, 3), joints (n, k) integers into ``matrices`` (b, 4, 4), which act on columns, weights (n, k).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from viewer.kit import quaternion
from viewer.kit.quaternion import Numbers, swing_twist, twist_angle

__all__ = ["dual_quaternion", "dual_quaternion_normals", "linear_blend", "linear_blend_normals", "normalise_weights",
           "palette", "rigid_parts", "swing_twist", "twist_angle"]

Joints: TypeAlias = NDArray[np.integer[Any]]
Blend: TypeAlias = Callable[[Numbers, Joints, Numbers, Numbers], Numbers]
CHUNK = 65536                # vertices at once, so that what is gathered for them stays in the cache
NORMALISED_WITHIN = 1e-3     # what the sum of a vertex's weights may be off by: 8-bit weights round to 1/255 each
RIGID_WITHIN = 1e-5          # how far from a rotation a matrix may be and count as rigid


def normalise_weights(weights: ArrayLike) -> tuple[NDArray[np.float32], int]:
    """``weights`` (n, k) with each row's sum 1, and how many rows were off by more than a thousandth.

    Negative weights and those that are no numbers count as 0; a row of zeros follows its first joint alone.
    """
    weights = np.asarray(weights, np.float64)
    cleaned = np.where(np.isfinite(weights), np.maximum(weights, 0.0), 0.0)
    total = cleaned.sum(axis=1, keepdims=True)
    wrong = (np.abs(total[:, 0] - 1.0) > NORMALISED_WITHIN) | (cleaned != weights).any(axis=1)
    empty = total[:, 0] <= 0.0
    scaled = cleaned / np.where(total > 0.0, total, 1.0)
    scaled[empty, :1] = 1.0
    return scaled.astype(np.float32), int(wrong.sum())


def palette(bones: ArrayLike, inverse_bind: ArrayLike) -> Numbers:
    """What takes vertices from where they were bound to where bones (b, 4, 4) in the world take them: (b, 4, 4).

    ``inverse_bind`` (b, 4, 4) takes the mesh, as it was bound, into each bone's own frame.
    """
    return np.asarray(np.asarray(bones, np.float64) @ np.asarray(inverse_bind, np.float64))


def linear_blend(positions: ArrayLike, joints: ArrayLike, weights: ArrayLike, matrices: ArrayLike) -> Numbers:
    """Where the vertices go: (n, 3). Each bone's matrix is weighted, and the sum of them moves the vertex."""
    return _in_chunks(_move_linearly, positions, joints, weights, matrices)


def linear_blend_normals(normals: ArrayLike, joints: ArrayLike, weights: ArrayLike, matrices: ArrayLike) -> Numbers:
    """Their normals (n, 3), of length one, by the cofactors of the blended matrix.

    That is the normal of a surface whose weights do not change from place to place; where they do, it is off by
    what the change adds (Merry, Marais and Gain 2006), which film and games leave out too.
    """
    return _in_chunks(_turn_linearly, normals, joints, weights, matrices)


def dual_quaternion(positions: ArrayLike, joints: ArrayLike, weights: ArrayLike, matrices: ArrayLike) -> Numbers:
    """Where the vertices go: (n, 3), by blended rigid motions, after the bones' stretching, blended linearly.

    A motion and its negative mean the same; each is taken with the sign nearer to that of the vertex's heaviest bone.
    """
    matrices = np.asarray(matrices, np.float64)
    real, dual, stretch = rigid_parts(matrices)
    stretched = positions if stretch is None else linear_blend(positions, joints, weights, stretch)
    return _in_chunks(_move_rigidly, stretched, joints, weights, np.concatenate([real, dual], axis=1))


def dual_quaternion_normals(normals: ArrayLike, joints: ArrayLike, weights: ArrayLike, matrices: ArrayLike) -> Numbers:
    """Their normals (n, 3), of length one: stretched as planes are, then turned by the blended motion."""
    real, dual, stretch = rigid_parts(np.asarray(matrices, np.float64))
    stretched = normals if stretch is None else linear_blend_normals(normals, joints, weights, stretch)
    return _in_chunks(_turn_rigidly, stretched, joints, weights, np.concatenate([real, dual], axis=1))


def rigid_parts(matrices: Numbers) -> tuple[Numbers, Numbers, Numbers | None]:
    """Unit dual quaternions (b, 4) and (b, 4) of the motions in ``matrices`` (b, 4, 4), and what they stretch before.

    The stretch (b, 4, 4) comes from the polar decomposition, motion times stretch; None where nothing stretches.
    A mirror image mirrors before it moves.
    """
    real = quaternion.nearest_rotation(matrices[:, :3, :3])
    moved = np.concatenate([matrices[:, :3, 3], np.zeros((len(matrices), 1))], axis=1)
    dual = 0.5 * quaternion.multiply(moved, real)
    linear = quaternion.to_matrix(quaternion.conjugate(real)) @ matrices[:, :3, :3]
    if np.abs(linear - np.eye(3)).max(initial=0.0) <= RIGID_WITHIN:
        return real, dual, None
    stretch = np.broadcast_to(np.eye(4), matrices.shape).copy()
    stretch[:, :3, :3] = linear
    return real, dual, stretch


def _in_chunks(blend: Blend, vectors: ArrayLike, joints: ArrayLike, weights: ArrayLike, bones: ArrayLike) -> Numbers:
    """``blend`` some thousands of vertices at a time."""
    vectors, weights = np.asarray(vectors, np.float64), np.asarray(weights, np.float64)
    joints, bones = np.asarray(joints), np.asarray(bones, np.float64)
    result = np.empty(vectors.shape)
    for start in range(0, len(vectors), CHUNK):
        part = slice(start, start + CHUNK)
        result[part] = blend(vectors[part], joints[part], weights[part], bones)
    return result


def _blended(joints: Joints, weights: Numbers, bones: Numbers) -> Numbers:
    """The weighted sum of the bones' top three rows, (n, 3, 4)."""
    rows = bones[:, :3].reshape(len(bones), 12)
    return np.asarray(np.einsum("nk,nkr->nr", weights, rows[joints]).reshape(-1, 3, 4))


def _move_linearly(positions: Numbers, joints: Joints, weights: Numbers, bones: Numbers) -> Numbers:
    blended = _blended(joints, weights, bones)
    return np.asarray(np.einsum("nij,nj->ni", blended[:, :, :3], positions) + blended[:, :, 3])


def _turn_linearly(normals: Numbers, joints: Joints, weights: Numbers, bones: Numbers) -> Numbers:
    x, y, z = np.moveaxis(_blended(joints, weights, bones)[:, :, :3], 2, 0)
    cofactors = np.stack([np.cross(y, z), np.cross(z, x), np.cross(x, y)], axis=2)
    return _unit(np.einsum("nij,nj->ni", cofactors, normals), normals)


def _blended_motion(joints: Joints, weights: Numbers, bones: Numbers) -> tuple[Numbers, Numbers]:
    """The normalised sum of dual quaternions, each of the sign that is nearer to the heaviest bone's."""
    motions = bones[joints]
    heaviest = np.take_along_axis(motions, weights.argmax(axis=1)[:, None, None], axis=1)
    agreeing = np.where(np.sum(motions[..., :4] * heaviest[..., :4], axis=2) < 0.0, -weights, weights)
    total = np.einsum("nk,nkr->nr", agreeing, motions)
    length = np.maximum(np.linalg.norm(total[:, :4], axis=1, keepdims=True), 1e-30)
    return total[:, :4] / length, total[:, 4:] / length


def _move_rigidly(positions: Numbers, joints: Joints, weights: Numbers, bones: Numbers) -> Numbers:
    real, dual = _blended_motion(joints, weights, bones)
    moved = 2.0 * quaternion.multiply(dual, quaternion.conjugate(real))[:, :3]
    return np.asarray(quaternion.rotate(real, positions) + moved)


def _turn_rigidly(normals: Numbers, joints: Joints, weights: Numbers, bones: Numbers) -> Numbers:
    return _unit(quaternion.rotate(_blended_motion(joints, weights, bones)[0], normals), normals)


def _unit(vectors: Numbers, instead: Numbers) -> Numbers:
    """At length one; where there is no direction, where a limb has collapsed onto its axis, what stands ``instead``."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.asarray(np.divide(vectors, length, out=instead.copy(), where=length > 0.0))
