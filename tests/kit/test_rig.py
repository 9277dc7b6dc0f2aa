"""Skeletons: joints within joints."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from viewer.kit.rig import RiggedMesh, Skeleton, bound_at_rest

PARENTS = np.array([-1, 0, 1, 1, 0, 4, -1], np.int32)


def skeleton() -> Skeleton:
    """Seven joints in two trees, turned and scaled by chance."""
    chance = np.random.default_rng(2)
    return Skeleton(tuple("abcdefg"), PARENTS, chance.normal(size=(7, 3)), Rotation.random(7, random_state=1).as_quat(),
                    np.exp(0.2 * chance.normal(size=(7, 3))))


def test_a_joint_stands_in_its_parent_s_frame() -> None:
    """Each by hand: translation after rotation after scaling, down from the root."""
    rig = skeleton()
    for joint in range(7):
        expected = np.eye(4)
        above = joint
        while above >= 0:
            local = np.eye(4)
            local[:3, :3] = Rotation.from_quat(rig.rotations[above]).as_matrix() @ np.diag(rig.scales[above])
            local[:3, 3] = rig.translations[above]
            expected, above = local @ expected, int(PARENTS[above])
        assert np.allclose(rig.world()[joint], expected)


def test_what_hangs_below_moves_along() -> None:
    """A root that moves takes its tree with it, and no other."""
    rig = skeleton()
    moved = rig.translations.copy()
    moved[0] += [1.0, 2.0, 3.0]
    shift = (rig.world(rig.local(translations=moved)) - rig.world())[:, :3, 3]
    assert np.allclose(shift[:6], [1.0, 2.0, 3.0]) and np.allclose(shift[6], 0.0)


def test_binding_at_rest_moves_nothing() -> None:
    """Each bone's matrix undoes its own place."""
    rig = skeleton()
    assert np.allclose(rig.world()[[2, 5]] @ bound_at_rest(rig, [2, 5]), np.eye(4))


@pytest.mark.parametrize("parents", [[0, 0], [1, -1], [-2, 0]])
def test_a_child_before_its_parent_is_refused(parents: list[int]) -> None:
    """Also a joint that is its own parent."""
    with pytest.raises(ValueError, match="comes before its parent"):
        Skeleton(("a", "b"), np.array(parents, np.int32), np.zeros((2, 3)), np.tile([0.0, 0, 0, 1], (2, 1)),
                 np.ones((2, 3)))


def test_a_bone_s_parent_is_the_nearest_that_has_one() -> None:
    """Joints without a place in the palette are passed over; bones that were bound flat still have a frame."""
    rig = skeleton()
    bones = np.array([5, 3, 0], np.int32)
    inverse = bound_at_rest(rig, bones)
    inverse[1, :3, :3] = np.diag([1.0, 1.0, 0.0])
    zeros = np.zeros((1, 3), np.float32)
    mesh = RiggedMesh(zeros, zeros, zeros[:, :2], np.zeros((1, 4), np.int32), np.array([[1, 0, 0, 0]], np.float32),
                      np.zeros((1, 3), np.int32), rig, bones, inverse)
    assert mesh.bone_parents.tolist() == [2, 2, -1]
    assert np.allclose(mesh.bound_frames[[0, 2]], rig.world()[bones[[0, 2]]])
    assert np.isfinite(mesh.bound_frames).all()
