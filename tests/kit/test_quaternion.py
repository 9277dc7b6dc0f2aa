"""Quaternions against SciPy's rotations, and what swing and twist mean."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp

from viewer.kit import quaternion

CHANCE = np.random.default_rng(4)
TURNS = Rotation.random(200, random_state=7)
OTHERS = Rotation.random(200, random_state=8)
POINTS = CHANCE.normal(size=(200, 3))


def same_turn(one: object, other: object) -> bool:
    """Whether quaternions mean the same rotations: equal up to the sign."""
    dots = np.abs(np.sum(np.asarray(one) * np.asarray(other), axis=-1))
    return bool(np.allclose(dots, 1.0, atol=1e-12))


def test_products_turn_one_after_the_other() -> None:
    """Like matrices, the right one first."""
    assert same_turn(quaternion.multiply(TURNS.as_quat(), OTHERS.as_quat()), (TURNS * OTHERS).as_quat())


def test_points_turn_as_by_the_matrix() -> None:
    """Quaternion, its matrix and SciPy agree."""
    expected = TURNS.apply(POINTS)
    assert np.allclose(quaternion.rotate(TURNS.as_quat(), POINTS), expected)
    assert np.allclose(np.einsum("nij,nj->ni", quaternion.to_matrix(TURNS.as_quat()), POINTS), expected)


@pytest.mark.parametrize("turns", [TURNS, Rotation.from_rotvec(np.pi * np.eye(3)), Rotation.from_euler("x", [0.0])])
def test_matrices_give_their_quaternions_back(turns: Rotation) -> None:
    """Half turns and no turn too, where some components are zero."""
    assert same_turn(quaternion.from_matrix(turns.as_matrix()), turns.as_quat())


def test_rotation_vectors_go_there_and_back() -> None:
    """Up to half a turn; nothing turns nothing."""
    vectors = TURNS.as_rotvec()
    assert same_turn(quaternion.from_rotation_vector(vectors), TURNS.as_quat())
    assert np.allclose(quaternion.rotation_vector(TURNS.as_quat()), vectors)
    assert np.array_equal(quaternion.rotation_vector([0.0, 0.0, 0.0, 1.0]), [0.0, 0.0, 0.0])
    assert np.array_equal(quaternion.from_axis_angle([0.0, 0.0, 0.0], 1.0), quaternion.IDENTITY)


@pytest.mark.parametrize("share", [0.0, 0.25, 0.5, 1.0])
def test_slerp_goes_the_shorter_way_at_even_speed(share: float) -> None:
    """As SciPy's, for far and for nearly equal turns."""
    near = TURNS * Rotation.from_rotvec([1e-4, 0.0, -1e-4])
    for ends in (OTHERS, near):
        expected = [Slerp([0, 1], Rotation.concatenate([a, b]))(share).as_quat()
                    for a, b in zip(TURNS, ends, strict=True)]
        assert same_turn(quaternion.slerp(TURNS.as_quat(), ends.as_quat(), share), expected)


def test_swing_and_twist_make_the_turn_again() -> None:
    """The twist keeps its axis; the swing turns about a line across it."""
    axis = np.array([0.3, -0.5, 0.8])
    swing, twist = quaternion.swing_twist(TURNS.as_quat(), axis)
    assert same_turn(quaternion.multiply(swing, twist), TURNS.as_quat())
    assert np.allclose(quaternion.rotate(twist, axis), axis)
    assert np.allclose(swing[:, :3] @ axis, 0.0, atol=1e-12)


def test_the_twist_of_a_pure_twist_is_its_angle() -> None:
    """From -180 to 180 degrees, whatever swings after it."""
    axis, angles = np.array([0.0, 2.0, 0.0]), np.radians(np.linspace(-179.0, 179.0, 41))
    twist = quaternion.from_axis_angle(np.broadcast_to(axis, (41, 3)), angles)
    swing = quaternion.from_axis_angle(np.broadcast_to([0.6, 0.0, 0.8], (41, 3)), np.full(41, 1.1))
    assert np.allclose(quaternion.twist_angle(quaternion.multiply(swing, twist), axis), angles)


def test_the_nearest_rotation_is_the_polar_decomposition_s() -> None:
    """Of a rotation after a stretch it is the rotation, also where a mirror image was stretched."""
    stretch = np.array([[1.5, 0.2, 0.0], [0.2, 0.8, 0.1], [0.0, 0.1, 2.0]])
    assert same_turn(quaternion.nearest_rotation(TURNS.as_matrix() @ stretch), TURNS.as_quat())
    mirrored = quaternion.to_matrix(quaternion.nearest_rotation(np.diag([1.0, 1.0, -1.0])))
    assert np.linalg.det(mirrored) == pytest.approx(1.0)
