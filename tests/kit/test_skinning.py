"""Skinning against libigl, the package dual-quaternions, and closed forms."""

from __future__ import annotations

import igl
import numpy as np
import pytest
from dual_quaternions import DualQuaternion
from scipy.spatial.transform import Rotation

from viewer.kit import skinning
from viewer.kit.rig import composed

BONES, VERTICES = 12, 300


def random_rig(seed: int, influences: int = 4, *, scaled: bool = False) -> tuple[np.ndarray, ...]:
    """Positions (n, 3), joints (n, k), weights (n, k) and matrices (b, 4, 4)."""
    chance = np.random.default_rng(seed)
    joints = np.argsort(chance.random((VERTICES, BONES)), axis=1)[:, :influences]
    weights = chance.random((VERTICES, influences))
    weights /= weights.sum(axis=1, keepdims=True)
    scales = np.exp(0.4 * chance.normal(size=(BONES, 3))) if scaled else np.ones((BONES, 3))
    turns = Rotation.random(BONES, random_state=seed).as_quat()
    return chance.normal(size=(VERTICES, 3)), joints, weights, composed(chance.normal(size=(BONES, 3)), turns, scales)


def dense(joints: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """The weights of all bones, (n, b)."""
    full = np.zeros((len(joints), BONES))
    np.add.at(full, (np.arange(len(joints))[:, None], joints), weights)
    return full


@pytest.mark.parametrize("influences", [1, 2, 4, 8])
def test_linear_blending_is_libigl_s(influences: int) -> None:
    """On random rigs, also with bones that scale."""
    positions, joints, weights, matrices = random_rig(influences, influences, scaled=True)
    stacked = np.concatenate([matrix[:3].T for matrix in matrices])
    expected = igl.lbs_matrix(positions, dense(joints, weights)) @ stacked
    assert np.allclose(skinning.linear_blend(positions, joints, weights, matrices), expected, atol=1e-12)


def peer_dual_quaternion(motions: list[DualQuaternion], joints: np.ndarray, weights: np.ndarray) -> DualQuaternion:
    """The normalised sum of a vertex's motions, with the signs of its heaviest."""
    arrays = np.array([motions[joint].dq_array() for joint in joints])       # real w x y z, dual w x y z
    heaviest = arrays[weights.argmax()]
    signs = np.where(arrays[:, :4] @ heaviest[:4] < 0.0, -1.0, 1.0)
    total = DualQuaternion.from_dq_array(((signs * weights)[:, None] * arrays).sum(axis=0))
    return total.normalized()


@pytest.mark.parametrize("seed", [1, 2])
def test_dual_quaternions_are_the_package_s(seed: int) -> None:
    """On random rigs of rigid bones."""
    positions, joints, weights, matrices = random_rig(seed)
    motions = [DualQuaternion.from_homogeneous_matrix(matrix) for matrix in matrices]
    found = skinning.dual_quaternion(positions, joints, weights, matrices)
    for vertex in range(0, VERTICES, 7):
        blended = peer_dual_quaternion(motions, joints[vertex], weights[vertex])
        assert np.allclose(found[vertex], blended.transform_point(positions[vertex]), atol=1e-9)


def test_bones_that_scale_scale_under_dual_quaternions_too() -> None:
    """A vertex with one bone goes exactly where its matrix takes it; mirror images too."""
    positions, joints, _, matrices = random_rig(5, 1, scaled=True)
    matrices[0] = matrices[0] @ np.diag([1.0, 1.0, -1.0, 1.0])
    expected = skinning.linear_blend(positions, joints, np.ones((VERTICES, 1)), matrices)
    assert np.allclose(skinning.dual_quaternion(positions, joints, np.ones((VERTICES, 1)), matrices), expected)


@pytest.mark.parametrize("degrees", [-170.0, 30.0, 90.0, 150.0, 180.0])
def test_a_twist_collapses_by_its_law(degrees: float) -> None:
    """sqrt(w^2 + (1-w)^2 + 2 w (1-w) cos) of the radius is left by linear blending, all of it by dual quaternions."""
    share = np.linspace(0.0, 1.0, 21)
    positions = np.stack([np.cos(7.0 * share), share, np.sin(7.0 * share)], axis=1)
    joints, weights = np.tile([0, 1], (21, 1)), np.stack([1.0 - share, share], axis=1)
    matrices = np.tile(np.eye(4), (2, 1, 1))
    matrices[1, :3, :3] = Rotation.from_euler("y", degrees, degrees=True).as_matrix()
    radius = np.linalg.norm(skinning.linear_blend(positions, joints, weights, matrices)[:, [0, 2]], axis=1)
    cosine = np.cos(np.radians(degrees))
    assert np.allclose(radius, np.sqrt(share**2 + (1 - share) ** 2 + 2 * share * (1 - share) * cosine))
    rigid = skinning.dual_quaternion(positions, joints, weights, matrices)
    assert np.allclose(np.linalg.norm(rigid[:, [0, 2]], axis=1), 1.0)
    assert np.allclose(rigid[:, 1], share)


@pytest.mark.parametrize("blend", ["linear_blend", "dual_quaternion"])
def test_normals_stay_at_right_angles_to_the_surface(blend: str) -> None:
    """Where neighbours have the same weights: each normal against the moved tangents, also of bones that scale."""
    positions, joints, weights, matrices = random_rig(9, scaled=True)
    first, second, normals = np.moveaxis(Rotation.random(VERTICES, random_state=3).as_matrix(), 2, 0)
    move = getattr(skinning, blend)
    moved = [move(positions + 1e-6 * along, joints, weights, matrices) - move(
        positions - 1e-6 * along, joints, weights, matrices) for along in (first, second)]
    found = getattr(skinning, f"{blend}_normals")(normals, joints, weights, matrices)
    expected = np.cross(moved[0], moved[1])
    expected /= np.linalg.norm(expected, axis=1, keepdims=True)
    assert np.allclose(np.linalg.norm(found, axis=1), 1.0)
    sign = np.sign(np.sum(found * expected, axis=1, keepdims=True))     # a blend may turn a surface inside out
    assert np.abs(found - sign * expected).max() < 1e-5
    assert (sign > 0.0).mean() > 0.5


def test_weights_are_normalised_and_counted() -> None:
    """Those that are off by rounding are not counted; none at all means the first joint."""
    weights = [[0.5, 0.5], [0.1, 0.08], [0.0, 0.0], [2.0, -1.0], [np.nan, 1.0], [0.5, 0.5004]]
    found, off = skinning.normalise_weights(weights)
    assert off == 4
    assert found.dtype == np.float32 and np.allclose(found.sum(axis=1), 1.0)
    assert np.allclose(found[1], [0.1 / 0.18, 0.08 / 0.18])
    assert found[2].tolist() == [1.0, 0.0] and found[3].tolist() == [1.0, 0.0] and found[4].tolist() == [0.0, 1.0]


def test_a_palette_takes_what_was_bound_to_where_bones_are() -> None:
    """At the pose of binding nothing moves."""
    _, _, _, matrices = random_rig(3, scaled=True)
    assert np.allclose(skinning.palette(matrices, np.linalg.inv(matrices)), np.eye(4))


def test_many_vertices_come_out_as_few() -> None:
    """The work goes in chunks; none is missed at their seams."""
    positions, joints, weights, matrices = random_rig(2)
    repeats = skinning.CHUNK // VERTICES + 2
    many = [np.tile(array, (repeats, 1)) for array in (positions, joints, weights)]
    found = skinning.linear_blend(*many, matrices).reshape(repeats, VERTICES, 3)
    assert np.array_equal(found, np.broadcast_to(found[0], found.shape))
