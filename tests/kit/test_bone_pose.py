"""Poses as text, and what a hand on the rings means."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from viewer.kit import limb_pose
from viewer.kit.arm import NAMES, arm
from viewer.kit.bone_pose import PoseError, bone_named, read_pose, written_pose
from viewer.kit.limb import limb_at
from viewer.kit.twist_bones import twisted_palette


def test_a_pose_is_read_as_it_was_written() -> None:
    """Names with blanks, several bones; hardly turned ones are left out; awkward names become numbers."""
    pose = {0: np.array([1.0, -2.5, 0.0]), 2: np.array([0.0, 0.0, 35.0]), 1: np.array([0.001, 0.0, 0.0])}
    text = written_pose(pose, NAMES)
    assert text == "upper arm: 1.00 -2.50 0.00; hand: 0.00 0.00 35.00"
    read = read_pose(text, NAMES)
    assert set(read) == {0, 2} and np.array_equal(read[2], pose[2])
    assert written_pose({1: np.ones(3)}, ("a", "b:c")) == "1: 1.00 1.00 1.00"
    assert read_pose("  ", NAMES) == {}


@pytest.mark.parametrize("text", ["hand", "hand: 1 2", "hand: 1 2 x", "hand: 1 2 nan", ": 1 2 3", "hand: 1 2 3 4"])
def test_a_pose_that_cannot_be_read_says_what_it_should_look_like(text: str) -> None:
    """In one line with the wrong part."""
    with pytest.raises(PoseError, match="is not written like hand: 0 0 35"):
        read_pose(text, NAMES)


def test_bones_go_by_name_or_number() -> None:
    """Small letters or large; a wrong one is told which there are, and the nearest."""
    assert [bone_named(name, NAMES) for name in ("hand", " Hand ", "2", "upper arm")] == [2, 2, 2, 0]
    with pytest.raises(PoseError, match=r"^bone = hant is none of .* upper arm, .*; did you mean hand\?$"):
        bone_named("hant", NAMES)
    with pytest.raises(PoseError, match="and 12 more"):
        bone_named("20", [f"joint {number}" for number in range(20)])


@pytest.mark.parametrize("bone", [0, 1, 2])
@pytest.mark.parametrize("twist", [0.0, 100.0, -250.0])
def test_a_bone_goes_where_the_hand_turns_it(bone: int, twist: float) -> None:
    """Posed as the hand's drag was understood, the bone has the rotation that was wanted; bends and twists stay."""
    mesh = arm()
    limb = limb_at(mesh, 2)
    assert limb
    moment, bend = mesh.skeleton.local(), 30.0
    before = limb_pose.bent(limb, limb_pose.posed(mesh, moment, {1: np.array([10.0, 20.0, -15.0])}), bend)
    wanted = Rotation.from_rotvec([0.4, 0.9, -0.3]).as_matrix()
    turned, twisted = limb_pose.turned_by_hand(mesh, limb, bone, moment, before, wanted, bend, twist)
    poses = {1: np.array([10.0, 20.0, -15.0]), bone: turned}
    after = limb_pose.bent(limb, limb_pose.posed(mesh, moment, poses), bend)
    world = twisted_palette(limb, after, twisted)[bone] @ np.linalg.inv(mesh.inverse_bind[bone])
    assert np.allclose(world[:3, :3], wanted, atol=1e-9)
    assert abs(twisted - twist) <= 180.0
    assert bone == 2 or twisted == twist
    if bone == 2:
        assert abs(np.radians(turned) @ limb.axis) < 1e-9       # what goes about the axis is the twist alone


def test_a_bend_turns_the_elbow() -> None:
    """Towards the palm's side, by its angle; the upper arm stays."""
    mesh = arm()
    limb = limb_at(mesh, 2)
    assert limb
    world = mesh.skeleton.world(limb_pose.bent(limb, mesh.skeleton.local(), 90.0))
    assert np.allclose(world[0], np.eye(4))
    assert np.allclose(world[2, :3, 3] - world[1, :3, 3], [0.0, 0.0, limb.length])


def test_upright_keeps_place_and_turn_of_what_is_stretched() -> None:
    """A handle stands in a rotation."""
    turn = Rotation.from_rotvec([0.1, 0.2, 0.3]).as_matrix()
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn * 2.5, [1.0, 2.0, 3.0]
    found = limb_pose.upright(matrix)
    assert np.allclose(found[:3, :3], turn) and np.array_equal(found[:3, 3], [1.0, 2.0, 3.0])
