"""How a limb stands apart from its twist: an animation's moment, what hands have turned, and a bend."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from viewer.kit import quaternion
from viewer.kit.bone_pose import turning
from viewer.kit.limb import Limb
from viewer.kit.quaternion import Numbers, swing_twist, twist_angle
from viewer.kit.rig import RiggedMesh, composed


def bent_bone(limb: Limb) -> int:
    """The palette entry that a bend turns: the upper bone, as an elbow does, or where that is a root the lower."""
    return limb.upper if limb.mesh.bone_parents[limb.upper] >= 0 else limb.lower


def posed(mesh: RiggedMesh, moment: Numbers, turned: Mapping[int, Numbers]) -> Numbers:
    """``moment`` (j, 4, 4) with bones ``turned`` by rotation vectors in degrees, within their own frames."""
    local = np.array(moment)
    for bone, vector in turned.items():
        local[mesh.bones[bone]] = local[mesh.bones[bone]] @ turning(vector)
    return local


def bent(limb: Limb, local: Numbers, degrees: float) -> Numbers:
    """``local`` (j, 4, 4) bent by ``degrees``, across the limb."""
    bone = bent_bone(limb)
    bending = _about(limb, bone, limb.across[0], np.radians(degrees))
    local = np.array(local)
    local[limb.mesh.bones[bone]] = local[limb.mesh.bones[bone]] @ composed(np.zeros(3), bending, np.ones(3))
    return local


def turned_by_hand(mesh: RiggedMesh, limb: Limb | None, bone: int, moment: Numbers, local: Numbers, wanted: Numbers,
                   bend: float, twist: float) -> tuple[Numbers, float]:
    """What a hand that turned ``bone`` to the world rotation ``wanted`` (3, 3) has meant: its turn, and the twist.

    ``local`` (j, 4, 4) is the pose without twist, ``moment`` what it was before any hand. The turn is a rotation
    vector in degrees; for the limb's lower bone, what goes about the axis is the twist, of the turns nearest to
    ``twist`` in degrees, and the rest is the bone's turn.
    """
    joint = int(mesh.bones[bone])
    parent = int(mesh.skeleton.parents[joint])
    above = mesh.skeleton.world(local)[parent] if parent >= 0 else np.eye(4)
    before = quaternion.nearest_rotation((above @ moment[joint])[:3, :3])
    total, angle = quaternion.multiply(quaternion.conjugate(before), quaternion.from_matrix(wanted)), twist
    if limb and bone == limb.lower:
        axis = mesh.inverse_bind[bone][:3, :3] @ limb.axis
        angle = float(np.degrees(twist_angle(total, axis)))
        angle += 360.0 * round((twist - angle) / 360.0)
        total, _ = swing_twist(total, axis)
    if limb and bone == bent_bone(limb):
        bending = _about(limb, bone, limb.across[0], np.radians(bend))
        total = quaternion.multiply(total, quaternion.conjugate(bending))
    return np.degrees(quaternion.rotation_vector(total)), angle


def upright(matrix: Numbers) -> Numbers:
    """A matrix (4, 4) with its place, and of its turning, scaling and shearing the rotation nearest to it."""
    plain = np.eye(4)
    plain[:3, :3] = quaternion.to_matrix(quaternion.nearest_rotation(matrix[:3, :3]))
    plain[:3, 3] = matrix[:3, 3]
    return plain


def _about(limb: Limb, bone: int, direction: Numbers, radians: float) -> Numbers:
    """A turn within a bone's frame, about a direction that is given as the mesh was bound."""
    return quaternion.from_axis_angle(limb.mesh.inverse_bind[bone][:3, :3] @ direction, radians)
