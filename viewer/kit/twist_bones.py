"""Twist bones: more bones between a limb's two, which share its twist."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from viewer.kit import quaternion
from viewer.kit.limb import Limb, slots, without_pair
from viewer.kit.quaternion import Numbers, swing_twist
from viewer.kit.skinning import palette


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
    near, far = slots(limb)
    rows = np.nonzero((limb.held > 0.0) & (limb.share > 0.0) & (limb.share < 1.0))[0]
    weights[rows] = without_pair(limb)[rows]
    for column, bone, part in ((near, chain[step], 1.0 - later), (far, chain[step + 1], later)):
        joints[rows, column[rows]] = bone[rows]
        weights[rows, column[rows]] = (part * limb.held)[rows]
    return joints, weights.astype(np.float32)


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
    bend = np.linalg.pinv(straight[limb.upper]) @ straight[limb.lower]
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
    joint = limb.mesh.bound_frames[limb.lower, :3, 3]
    places = joint + share * (bend[:3, :3] @ joint + bend[:3, 3] - joint)
    matrices = np.tile(np.eye(4), (len(parts), 1, 1))
    matrices[:, :3, :3] = linear
    matrices[:, :3, 3] = places - linear @ joint
    return matrices
