"""The arm, its twist, and what is measured of it, against the laws of skinning."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from viewer.kit import skinning
from viewer.kit.arm import STRAIGHT, arm, straight_area
from viewer.kit.cross_section import cut, flattened, limb_section
from viewer.kit.limb import FALLOFFS, Limb, limb_at, most_blended_bone, with_falloff
from viewer.kit.limb_measure import LimbGauge, law, thinnest_by_law
from viewer.kit.mesh import ico_sphere
from viewer.kit.rig import RiggedMesh, Skeleton, bound_at_rest
from viewer.kit.surface_sampling import welded
from viewer.kit.twist_bones import twisted_palette, with_twist_bones

THINNEST = {  # degrees: with 2, 3, 4, 5, 6 bones sharing the twist
    90: (0.707, 0.924, 0.966, 0.981, 0.988), 150: (0.259, 0.793, 0.906, 0.947, 0.966),
    180: (0.0, 0.707, 0.866, 0.924, 0.951)}


def limb(falloff: str = "linear") -> Limb:
    """The arm's, from elbow to wrist."""
    found = limb_at(arm(), 2)
    assert found
    return with_falloff(found, falloff)


def twisted(of: Limb, degrees: float, twist_bones: int = 0,
            method: str = "linear_blend") -> tuple[np.ndarray, np.ndarray]:
    """Its vertices and what moved its upper bone."""
    joints, weights = with_twist_bones(of, twist_bones)
    matrices = twisted_palette(of, of.mesh.skeleton.local(), degrees, twist_bones)
    return getattr(skinning, method)(of.mesh.positions, joints, weights, matrices), matrices[of.upper]


def test_the_arm_is_closed_and_follows_its_bones() -> None:
    """Of six closed pieces, hand and fingers of the hand's alone; nothing moves at rest."""
    mesh = arm()
    whole = trimesh.Trimesh(mesh.positions, welded(mesh.positions.astype(float), mesh.triangles), process=False)
    whole.remove_unreferenced_vertices()
    assert whole.is_watertight and whole.is_winding_consistent and whole.volume > 0.0 and whole.body_count == 6
    assert np.allclose(mesh.weights.sum(axis=1), 1.0, atol=1e-6)
    assert (mesh.weights[mesh.positions[:, 1] > STRAIGHT[1] + 1e-6, 2] == 1.0).all()
    assert np.allclose(mesh.palette(), np.eye(4))
    assert np.allclose(np.linalg.norm(mesh.normals, axis=1), 1.0, atol=1e-5)


def test_what_differs_along_the_straight_part_is_odd_about_its_middle() -> None:
    """So that its volume shrinks as a cylinder's does; the skin has that area."""
    along = np.linspace(0.0, 1.0, 11)
    assert np.allclose(straight_area(along) + straight_area(1.0 - along), 2.0 * straight_area(0.5))
    for part in (0.25, 0.5, 0.75):
        place = STRAIGHT[0] + part * (STRAIGHT[1] - STRAIGHT[0])
        section = cut(arm().positions.astype(float), arm().triangles, np.array([0.0, place, 0.0]), np.eye(3)[1])
        a, b = np.moveaxis(section.points(arm().positions.astype(float))[..., [0, 2]], 1, 0)
        area = 0.5 * abs(np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum())
        assert area == pytest.approx(np.pi * straight_area(part), rel=5e-3)


def test_the_arm_twists_at_its_wrist_by_default() -> None:
    """Where most of the skin is shared."""
    assert most_blended_bone(arm()) == 2
    assert limb_at(arm(), 0) is None


@pytest.mark.parametrize("degrees", THINNEST)
@pytest.mark.parametrize("falloff", FALLOFFS)
def test_bones_that_share_a_twist_keep_a_limb_thick(degrees: int, falloff: str) -> None:
    """The table of smallest radii, for each way in which weights blend."""
    gauge = LimbGauge(limb(falloff))
    for twist_bones, expected in enumerate(THINNEST[degrees]):
        found = gauge.numbers(*twisted(gauge.limb, degrees, twist_bones))
        assert found.min_radius_ratio == pytest.approx(expected, abs=0.002)
        assert found.thinnest == pytest.approx(expected, abs=0.005)
        assert thinnest_by_law(degrees, twist_bones) == pytest.approx(expected, abs=0.0006)


@pytest.mark.parametrize("degrees", [60.0, 120.0, 180.0])
def test_the_volume_shrinks_as_a_cylinder_s(degrees: float) -> None:
    """1 - (1 - cos) / 3 where weights blend evenly; dual quaternions keep it."""
    gauge = LimbGauge(limb())
    expected = 1.0 - (1.0 - np.cos(np.radians(degrees))) / 3.0
    assert gauge.numbers(*twisted(gauge.limb, degrees)).volume_ratio == pytest.approx(expected, abs=0.003)
    rigid = gauge.numbers(*twisted(gauge.limb, degrees, method="dual_quaternion"))
    assert rigid.min_radius_ratio == pytest.approx(1.0) and rigid.volume_ratio == pytest.approx(1.0, abs=0.002)


def test_nothing_changes_without_a_twist_or_by_moving_the_whole() -> None:
    """Ratios are of the limb's own shape, wherever it is and however large."""
    gauge = LimbGauge(limb())
    moved = np.array([[0.0, -2.0, 0.0, 5.0], [2.0, 0.0, 0.0, 1.0], [0.0, 0.0, 2.0, -3.0], [0.0, 0.0, 0.0, 1.0]])
    places = gauge.limb.mesh.positions @ moved[:3, :3].T + moved[:3, 3]
    for found in (gauge.numbers(*twisted(gauge.limb, 0.0, 3)), gauge.numbers(places, moved)):
        assert tuple(vars(found).values()) == pytest.approx((1.0, 1.0, 1.0, 1.0))


@pytest.mark.parametrize("twist_bones", [0, 1, 3, 8])
def test_the_curve_along_the_limb_is_the_law(twist_bones: int) -> None:
    """At every ring, for a twist beyond half a turn."""
    of = limb()
    gauge = LimbGauge(of)
    posed, upper = twisted(of, 210.0, twist_bones)
    ratios = gauge.radius_ratios(posed[of.measured], upper, of.measured)
    places, measured, expected = gauge.along(ratios, law(of.share[of.measured], 210.0, twist_bones))
    assert len(places) > 120 and (np.diff(places) > 0.0).all()
    assert np.allclose(measured, expected, atol=1e-5)
    if not twist_bones:
        w = of.share[of.measured]
        formula = np.sqrt(w * w + (1 - w) ** 2 + 2 * w * (1 - w) * np.cos(np.radians(210.0)))
        assert np.allclose(ratios, formula, atol=1e-5)


@pytest.mark.parametrize("count", [1, 2, 5, 8])
def test_extra_bones_change_nothing_at_rest(count: int) -> None:
    """Weights keep their sums, no vertex follows more bones than before, and all stands still."""
    of = limb("smooth")
    joints, weights = with_twist_bones(of, count)
    assert np.allclose(weights.sum(axis=1), 1.0, atol=1e-6)
    assert ((weights > 0.0).sum(axis=1) <= (of.mesh.weights > 0.0).sum(axis=1)).all()
    assert joints.max() == 2 + count
    assert np.allclose(twisted_palette(of, of.mesh.skeleton.local(), 0.0, count), np.eye(4), atol=1e-12)


def test_extra_bones_share_a_bend_as_well() -> None:
    """Half of it for one in the middle; where the joint is, it stays."""
    of = limb()
    local = of.mesh.skeleton.local()
    turn = np.radians(80.0)
    local[2, :3, :3] = [[1, 0, 0], [0, np.cos(turn), -np.sin(turn)], [0, np.sin(turn), np.cos(turn)]]
    extra = twisted_palette(of, local, 0.0, 1)[3]
    assert np.degrees(np.arccos(0.5 * (np.trace(extra[:3, :3]) - 1.0))) == pytest.approx(40.0)
    assert np.allclose(extra[:3, :3] @ of.end + extra[:3, 3], of.end)


def test_a_full_turn_collapses_bones_that_share_it() -> None:
    """Extra bones have their part of the angle, not of the place where it ends."""
    of = limb()
    found = LimbGauge(of).numbers(*twisted(of, 360.0, 1))
    assert found.min_radius_ratio == pytest.approx(0.0, abs=1e-6)
    assert LimbGauge(of).numbers(*twisted(of, 360.0, 0)).min_radius_ratio == pytest.approx(1.0)


def test_a_plane_cuts_a_ball_in_a_circle() -> None:
    """Closed, of the right radius; beside the ball nothing is cut."""
    vertices, triangles = ico_sphere(4)
    section = cut(vertices, triangles, np.array([0.0, 0.0, 0.6]), np.array([0.0, 0.0, 1.0]))
    points = section.points(vertices)
    assert np.allclose(points[..., 2], 0.6) and np.allclose(np.linalg.norm(points[..., :2], axis=-1), 0.8, atol=3e-3)
    ends = np.sort(section.ends.reshape(-1, 2), axis=1)
    assert (np.unique(ends, axis=0, return_counts=True)[1] == 2).all()
    assert len(cut(vertices, triangles, np.array([0.0, 0.0, 1.1]), np.array([0.0, 0.0, 1.0])).ends) == 0


@pytest.mark.parametrize(("degrees", "kept"), [(0.0, 1.0), (90.0, 0.7071), (180.0, 0.0)])
def test_a_cross_section_shrinks_and_turns_by_half_the_twist(degrees: float, kept: float) -> None:
    """In the middle, seen along the axis."""
    of = limb()
    section = limb_section(of, 0.5)
    posed, upper = twisted(of, degrees)
    before = flattened(of, section.points(of.mesh.positions.astype(float)), 0.5)
    after = flattened(of, section.points(posed), 0.5, upper)
    half = np.radians(degrees / 2.0)
    turn = np.array([[np.cos(half), -np.sin(half)], [np.sin(half), np.cos(half)]])
    assert np.allclose(after, kept * before @ turn.T, atol=1e-4)


def test_the_bone_that_blends_most_is_found_among_many() -> None:
    """As by going through all pairs of a bone and its parent, on a chain of bones bound by chance."""
    chance = np.random.default_rng(6)
    count, vertices = 30, 400
    places = chance.normal(size=(count, 3))
    rig = Skeleton(tuple(map(str, range(count))), np.array([-1, *chance.integers(0, np.arange(1, count))], np.int32),
                   places, np.tile([0.0, 0.0, 0.0, 1.0], (count, 1)), np.ones((count, 3)))
    joints = np.argsort(chance.random((vertices, count)), axis=1)[:, :4].astype(np.int32)
    weights = skinning.normalise_weights(chance.random((vertices, 4)))[0]
    bones = np.arange(count, dtype=np.int32)
    ends = chance.normal(size=(vertices, 3)).astype(np.float32)
    mesh = RiggedMesh(ends, ends, ends[:, :2], joints, weights, np.zeros((1, 3), np.int32), rig, bones,
                      bound_at_rest(rig, bones))
    mixed = []
    for bone in range(count):
        found = limb_at(mesh, bone)
        own = np.minimum(found.held * found.share, found.held * (1.0 - found.share)) if found else np.zeros(1)
        mixed.append(own.sum() * found.length if found else 0.0)
    assert most_blended_bone(mesh) == int(np.argmax(mixed))
