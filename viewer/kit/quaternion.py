"""Unit quaternions (x, y, z, w) as glTF writes them: rotations that blend well. Arrays of shape (..., 4), float64."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Numbers: TypeAlias = NDArray[np.float64]
IDENTITY: Numbers = np.array([0.0, 0.0, 0.0, 1.0])
NEARLY_EQUAL = 0.9995       # the cosine beyond which slerp divides by too little


def from_axis_angle(axis: ArrayLike, radians: ArrayLike) -> Numbers:
    """The turn by ``radians`` (...) about ``axis`` (..., 3), which need not have length one; zero axes turn nothing."""
    axis, half = np.asarray(axis, np.float64), 0.5 * np.asarray(radians, np.float64)[..., None]
    length = np.linalg.norm(axis, axis=-1, keepdims=True)
    way = np.divide(axis, length, out=np.zeros_like(axis), where=length > 0.0)
    real = np.where(length > 0.0, np.cos(half), 1.0)
    imaginary = np.sin(half) * way
    return np.concatenate([imaginary, np.broadcast_to(real, (*imaginary.shape[:-1], 1))], axis=-1)


def from_rotation_vector(vector: ArrayLike) -> Numbers:
    """The turn about a vector (..., 3) by its length, in radians."""
    vector = np.asarray(vector, np.float64)
    return from_axis_angle(vector, np.linalg.norm(vector, axis=-1))


def rotation_vector(rotation: ArrayLike) -> Numbers:
    """The axis of a turn (..., 4) times its angle, at most half a turn, in radians: (..., 3)."""
    rotation = normalised(rotation)
    rotation = np.where(rotation[..., 3:] < 0.0, -rotation, rotation)
    sine = np.linalg.norm(rotation[..., :3], axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(sine, rotation[..., 3:])
    return np.asarray(rotation[..., :3] * np.divide(angle, sine, out=np.full_like(sine, 2.0), where=sine > 1e-12))


def multiply(first: ArrayLike, second: ArrayLike) -> Numbers:
    """Hamilton's product: the turn ``second`` and after it ``first``, as with matrices."""
    ax, ay, az, aw = np.moveaxis(np.asarray(first, np.float64), -1, 0)
    bx, by, bz, bw = np.moveaxis(np.asarray(second, np.float64), -1, 0)
    return np.stack([aw * bx + ax * bw + ay * bz - az * by,
                     aw * by - ax * bz + ay * bw + az * bx,
                     aw * bz + ax * by - ay * bx + az * bw,
                     aw * bw - ax * bx - ay * by - az * bz], axis=-1)


def conjugate(rotation: ArrayLike) -> Numbers:
    """The turn backwards."""
    return np.asarray(np.asarray(rotation, np.float64) * np.array([-1.0, -1.0, -1.0, 1.0]))


def normalised(rotation: ArrayLike) -> Numbers:
    """At length one; what has no length turns nothing."""
    rotation = np.asarray(rotation, np.float64)
    length = np.linalg.norm(rotation, axis=-1, keepdims=True)
    return np.where(length > 1e-30, rotation / np.maximum(length, 1e-30), IDENTITY)


def rotate(rotation: ArrayLike, vectors: ArrayLike) -> Numbers:
    """``vectors`` (..., 3) turned: v + 2 q x (q x v + w v), with q the imaginary part."""
    rotation, vectors = np.asarray(rotation, np.float64), np.asarray(vectors, np.float64)
    imaginary = rotation[..., :3]
    return np.asarray(vectors + 2.0 * np.cross(imaginary, np.cross(imaginary, vectors) + rotation[..., 3:] * vectors))


def to_matrix(rotation: ArrayLike) -> Numbers:
    """The matrices (..., 3, 3), for columns, of turns (..., 4) of length one."""
    x, y, z, w = np.moveaxis(np.asarray(rotation, np.float64), -1, 0)
    rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def from_matrix(matrix: ArrayLike) -> Numbers:
    """The turns (..., 4) of rotation matrices (..., 3, 3): each from its largest component (Shepperd 1978)."""
    m = np.asarray(matrix, np.float64)
    x, y, z = m[..., 0, 0], m[..., 1, 1], m[..., 2, 2]
    squares = np.stack([1 + x - y - z, 1 - x + y - z, 1 - x - y + z, 1 + x + y + z], axis=-1)   # of 2 x, 2 y, 2 z, 2 w
    a, b, c = (m[..., 2, 1] - m[..., 1, 2], m[..., 0, 2] - m[..., 2, 0], m[..., 1, 0] - m[..., 0, 1])
    d, e, f = (m[..., 1, 0] + m[..., 0, 1], m[..., 0, 2] + m[..., 2, 0], m[..., 2, 1] + m[..., 1, 2])
    s = squares
    rows = [np.stack(row, axis=-1) for row in (
        (s[..., 0], d, e, a), (d, s[..., 1], f, b), (e, f, s[..., 2], c), (a, b, c, s[..., 3]))]
    largest = np.argmax(squares, axis=-1)[..., None, None]
    chosen = np.take_along_axis(np.stack(rows, axis=-2), largest, axis=-2)[..., 0, :]
    return normalised(chosen)


def nearest_rotation(linear: ArrayLike) -> Numbers:
    """The turns (..., 4) nearest to matrices (..., 3, 3) that may stretch; a mirror image counts as turned back."""
    left, _, right = np.linalg.svd(np.asarray(linear, np.float64))
    left[..., 2] *= np.sign(np.linalg.det(left @ right))[..., None]
    return from_matrix(left @ right)


def slerp(start: ArrayLike, end: ArrayLike, share: ArrayLike) -> Numbers:
    """From ``start`` (..., 4) a ``share`` (...) of the shorter way to ``end``, at even speed (Shoemake 1985)."""
    start, end = np.asarray(start, np.float64), np.asarray(end, np.float64)
    share = np.asarray(share, np.float64)[..., None]
    cosine = np.sum(start * end, axis=-1, keepdims=True)
    end, cosine = np.where(cosine < 0.0, -end, end), np.abs(cosine)
    near = cosine > NEARLY_EQUAL
    angle = np.arccos(np.where(near, 0.0, np.minimum(cosine, 1.0)))
    first = np.where(near, 1.0 - share, np.sin((1.0 - share) * angle) / np.sin(angle))
    second = np.where(near, share, np.sin(share * angle) / np.sin(angle))
    return normalised(first * start + second * end)


def swing_twist(rotation: ArrayLike, axis: ArrayLike) -> tuple[Numbers, Numbers]:
    """A turn (..., 4) as ``swing`` after ``twist``: the twist about ``axis`` (..., 3), the swing across it.

    Projecting the imaginary part onto the axis gives the twist (Dobrowolski 2015, "Swing-twist decomposition in
    Clifford algebra"). Where the swing is half a turn the twist is not determined; it is taken to be none.
    """
    rotation, line = normalised(rotation), np.asarray(axis, np.float64)
    line = line / np.linalg.norm(line, axis=-1, keepdims=True)
    along = np.sum(rotation[..., :3] * line, axis=-1, keepdims=True)
    twist = normalised(np.concatenate([along * line, rotation[..., 3:]], axis=-1))
    return multiply(rotation, conjugate(twist)), twist


def twist_angle(rotation: ArrayLike, axis: ArrayLike) -> Numbers:
    """By how much a turn (..., 4) twists about ``axis`` (3,), in radians, from -pi to pi."""
    _, twist = swing_twist(rotation, axis)
    along = np.sum(twist[..., :3] * (np.asarray(axis, np.float64) / np.linalg.norm(axis)), axis=-1)
    angle = 2.0 * np.arctan2(along, twist[..., 3])
    return np.asarray(np.remainder(angle + np.pi, 2.0 * np.pi) - np.pi)
