"""The fins' skeleton: one layout for all species, weights that hold the fins to the body and let them twist."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from viewer.kit import quaternion
from viewer.kit.fish import DETAILS, PECTORAL, SPECIES, fish, fish_pieces, fish_rig, fish_skeleton
from viewer.kit.rig import RiggedMesh
from viewer.kit.skinning import dual_quaternion, linear_blend

Numbers = NDArray[np.float64]
BOTH = pytest.mark.parametrize("species", SPECIES)
JOINTS = ("body", "left pectoral", "left pectoral tip", "right pectoral", "right pectoral tip", "left pelvic",
          "right pelvic", "tail upper", "tail lower")
WITH_PELVICS = tuple(species for species in SPECIES if species != "eel")


def posed(rig: RiggedMesh, axis: tuple[float, float, float], degrees: float, *joints: str) -> Numbers:
    """The palette with some joints turned about an axis of their own."""
    rotations = rig.skeleton.rotations.copy()
    for joint in map(rig.skeleton.names.index, joints):
        turned = quaternion.from_axis_angle(axis, np.radians(degrees))
        rotations[joint] = quaternion.multiply(rotations[joint], turned)
    return rig.palette(rig.skeleton.local(rotations=rotations))


def test_all_species_have_the_same_joints() -> None:
    """So one palette serves all: same names, parents and order; the spine is none of them."""
    for species in SPECIES:
        skeleton = fish_skeleton(species)
        assert skeleton.names == JOINTS
        assert skeleton.parents.tolist() == [-1, 0, 1, 0, 3, 0, 0, 0, 0]
        assert np.allclose(skeleton.local()[0], np.eye(4)) and np.allclose(skeleton.scales, 1)
        assert np.allclose(np.linalg.norm(skeleton.rotations, axis=1), 1)
        assert np.allclose(np.linalg.det(skeleton.world()[:, :3, :3]), 1)


@pytest.mark.parametrize("detail", range(len(DETAILS)))
@BOTH
def test_weights_sum_to_one(species: str, detail: int) -> None:
    """None is negative; body, eyes and the fins of the middle follow the body alone."""
    mesh = fish(species, detail)
    assert np.abs(mesh.weights.sum(axis=1) - 1).max() < 1e-6 and mesh.weights.min() >= 0
    assert mesh.joints.min() >= 0 and mesh.joints.max() < len(JOINTS)
    for name, piece in fish_pieces(species, detail).items():
        if "left" in name and "pectoral" in name:
            assert set(np.unique(piece.joints)) == {0, 1, 2}
        rigid = not any(word in name for word in ("pectoral", "pelvic", "tail")) and species != "eel"
        assert not rigid or (piece.weights[:, 0] == 1).all(), name


@BOTH
def test_at_rest_nothing_moves(species: str) -> None:
    """The palette undoes itself."""
    rig = fish_rig(species, 2)
    assert np.allclose(rig.palette(), np.eye(4), atol=1e-12)
    assert np.allclose(linear_blend(rig.positions, rig.joints, rig.weights, rig.palette()), rig.positions, atol=1e-7)


@BOTH
def test_roots_stay_on_the_body_and_weights_rise_smoothly(species: str) -> None:
    """Whatever the joints do, the root's edge stays; and from vertex to vertex no weight jumps."""
    for name, piece in fish_pieces(species, 3).items():
        root = piece.coordinates[:, 1] == 0
        if not (piece.weights[:, 0] == 1).all():
            assert (piece.weights[root, 0] == 1).all(), name
            by_joint = np.zeros((len(piece.weights), len(JOINTS)))
            np.add.at(by_joint, (np.arange(len(by_joint))[:, None], piece.joints), piece.weights)
            edges = piece.triangles[:, [0, 1]]
            assert np.abs(by_joint[edges[:, 0]] - by_joint[edges[:, 1]]).max() < 0.55, name


@BOTH
def test_joints_point_along_their_fins(species: str) -> None:
    """Local x from the root to the tip; the fin is longest that way and flat across its local z."""
    rig = fish_rig(species, 3)
    world = rig.skeleton.world()
    pieces = fish_pieces(species, 3)
    for name in ("left pectoral", "right pectoral", "left pelvic", "right pelvic"):
        if name not in pieces:
            continue
        frame = np.linalg.inv(world[JOINTS.index(name)])
        local = pieces[name].positions @ frame[:3, :3].T + frame[:3, 3]
        length, breadth, depth = np.ptp(local, axis=0)
        assert length > breadth > depth, name
        tip = local[pieces[name].coordinates[:, 1] == 1]
        assert tip[:, 0].min() > 0 and np.abs(tip[:, 2]).max() < 0.15 * length, name
    tail = pieces.get("tail 0", pieces.get("dorsal 0"))
    assert tail is not None
    for name, up in (("tail upper", 1), ("tail lower", -1)):
        joint = JOINTS.index(name)
        own = tail.positions[((tail.joints == joint) & (tail.weights > 0.5)).any(axis=1)]
        ahead = own - world[joint, :3, 3]
        assert (ahead @ world[joint, :3, 0]).mean() > 0 and np.sign(world[joint, 1, 3]) == up
        assert world[joint, 0, 0] < -0.5


@BOTH
def test_mirrored_poses_are_mirror_images(species: str) -> None:
    """Opposite turns about x and y and the same about z on the two sides."""
    rig = fish_rig(species, 2)
    for axis, sign in (((1, 0, 0), -1), ((0, 1, 0), -1), ((0, 0, 1), 1)):
        left = posed(rig, axis, 40, "left pectoral", "left pelvic")
        right = posed(rig, axis, sign * 40, "right pectoral", "right pelvic")
        mirror = np.diag([1.0, 1.0, -1.0, 1.0])
        for one, other in (("left pectoral", "right pectoral"), ("left pelvic", "right pelvic")):
            if species == "eel" and "pelvic" in one:
                continue
            assert np.allclose(mirror @ left[JOINTS.index(one)] @ mirror, right[JOINTS.index(other)], atol=1e-9)


@BOTH
def test_a_twisted_pectoral_has_the_waist_of_linear_blending(species: str) -> None:
    """Twisting its tip by a, what follows it by w comes nearer to the axis: sqrt(1 - 4 w (1 - w) sin(a / 2)^2)."""
    rig, degrees = fish_rig(species, 3), 150.0
    chosen = rig.joints[:, 1] == JOINTS.index("left pectoral")
    beyond = chosen & (rig.weights[:, 0] == 0)
    joint = JOINTS.index("left pectoral")
    frame = np.linalg.inv(rig.skeleton.world()[joint])
    palette = posed(rig, (1, 0, 0), degrees, "left pectoral tip")
    w = rig.weights[beyond, 2].astype(float)
    radius = []
    for method in (lambda *all_of_it: np.asarray(rig.positions, float), linear_blend, dual_quaternion):
        moved = method(rig.positions, rig.joints, rig.weights, palette)[beyond] @ frame[:3, :3].T + frame[:3, 3]
        radius.append(np.hypot(moved[:, 1], moved[:, 2]))
    law = np.sqrt(1 - 4 * w * (1 - w) * np.sin(np.radians(degrees) / 2) ** 2)
    assert np.abs(radius[1] - law * radius[0]).max() < 1e-6
    assert np.abs(radius[2] - radius[0]).max() < 1e-6
    assert (w == 1).any() and np.unique(w.round(6)).size >= 9       # rings enough to see the waist
    assert np.allclose(w, fish(species).coordinates[beyond, 1])     # linear from root to tip
    assert (fish(species).parts[beyond] == PECTORAL).all()


@pytest.mark.parametrize("species", WITH_PELVICS)
def test_the_tail_fans_out_without_leaving_the_stalk(species: str) -> None:
    """Turned apart about their own z, the lobes spread; what is before the hinge stays."""
    rig = fish_rig(species, 2)
    up, down = (posed(rig, (0, 0, 1), sign * 10, joint) for sign, joint in ((1, "tail upper"), (-1, "tail lower")))
    spread = linear_blend(rig.positions, rig.joints, rig.weights, up)
    lowered = linear_blend(rig.positions, rig.joints, rig.weights, down)
    tail = rig.positions[:, 0] < SPECIES[species].stalk_end
    assert spread[tail, 1].max() > rig.positions[tail, 1].max() + 0.01
    assert lowered[tail, 1].min() < rig.positions[tail, 1].min() - 0.01
    still = rig.positions[:, 0] > SPECIES[species].stalk_end + 0.06
    assert np.allclose(spread[still], rig.positions[still], atol=1e-6)
    assert np.abs(spread - rig.positions).max() > 0.015
