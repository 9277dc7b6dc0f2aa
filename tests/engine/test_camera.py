"""The orbit camera: what its matrices mean, and that it goes where the hand goes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from viewer.engine.camera import Orbit, OrbitCamera

POSES = [Orbit(), Orbit(0, 0, 2), Orbit(200, -60, 9, (1, 2, 3), 50), Orbit(-75, 89, 0.5, (0, -1, 0))]
ASPECTS = [16 / 9, 1.0, 0.5]


def clip(camera: OrbitCamera, aspect: float, point: object) -> NDArray[np.float64]:
    """Where ``point`` lands: x and y from -1 to 1 across the picture, z the depth, w the distance ahead."""
    seen = np.append(np.asarray(point, float), 1.0) @ camera.view() @ camera.projection(aspect)
    return np.append(seen[:3] / seen[3], seen[3])


@pytest.mark.parametrize("pose", POSES)
def test_the_eye_stands_where_the_angles_say(pose: Orbit) -> None:
    """Yaw turns about the vertical from +z towards +x, pitch raises."""
    camera = OrbitCamera(pose)
    away = camera.eye - np.array(pose.target)
    assert np.linalg.norm(away) == pytest.approx(pose.distance)
    assert away[1] == pytest.approx(pose.distance * math.sin(math.radians(pose.pitch)))
    assert math.degrees(math.atan2(away[0], away[2])) % 360 == pytest.approx(pose.yaw % 360)


@pytest.mark.parametrize("pose", POSES)
def test_the_view_is_a_rigid_motion(pose: Orbit) -> None:
    """Eye to the origin, target straight ahead, up stays up, nothing mirrored."""
    camera = OrbitCamera(pose)
    view = camera.view()
    assert np.allclose(view[:3, :3] @ view[:3, :3].T, np.eye(3))
    assert np.linalg.det(view[:3, :3]) == pytest.approx(1.0)
    assert np.allclose(np.append(camera.eye, 1) @ view, [0, 0, 0, 1], atol=1e-12)
    assert np.allclose(np.append(pose.target, 1) @ view, [0, 0, -pose.distance, 1])
    above = np.array([0.0, 1.0, 0.0, 0.0]) @ view
    assert above[0] == pytest.approx(0.0, abs=1e-12)
    assert above[1] > 0


@pytest.mark.parametrize("aspect", ASPECTS)
@pytest.mark.parametrize("pose", POSES)
def test_the_projection_shows_the_field_of_view(pose: Orbit, aspect: float) -> None:
    """The narrower of width and height spans the field of view; near is -1, far is 1."""
    camera = OrbitCamera(pose)
    projection = camera.projection(aspect)
    slope = math.tan(math.radians(pose.field_of_view) / 2)
    edge = np.array([slope * max(1.0, aspect), slope * max(1.0, 1 / aspect), -1.0, 1.0]) @ projection
    assert edge[:2] / edge[3] == pytest.approx([1.0, 1.0])
    for depth, expected in ((pose.distance / 50, -1.0), (pose.distance * 50, 1.0)):
        end = np.array([0.0, 0.0, -depth, 1.0]) @ projection
        assert (end[2] / end[3], end[3]) == pytest.approx((expected, depth))


@pytest.mark.parametrize("aspect", ASPECTS)
def test_the_target_stays_in_the_middle(aspect: float) -> None:
    """Whatever the hand does, the orbit's centre is the picture's, at the orbit's distance."""
    camera = OrbitCamera(Orbit())
    for step in range(30):
        camera.drag(0.1 * step, 0.07 * (step % 7 - 3))
        camera.pan(0.01 * step, -0.02)
        camera.zoom(0.3 * (step % 5 - 2))
        seen = clip(camera, aspect, camera.target)
        assert seen[:2] == pytest.approx([0.0, 0.0], abs=1e-9)
        assert seen[3] == pytest.approx(camera.distance)


@pytest.mark.parametrize("aspect", ASPECTS)
def test_panning_keeps_the_point_under_the_cursor(aspect: float) -> None:
    """A point at the target's depth moves as far as the hand, in heights of the picture."""
    camera = OrbitCamera(Orbit(30, 20, 5, (1, 1, 0)))
    held = camera.target
    camera.pan(0.2, 0.1, aspect)
    right, up = clip(camera, aspect, held)[:2]
    assert (right * aspect / 2, -up / 2) == pytest.approx((0.2, 0.1))


def test_dragging_turns_what_is_in_front_with_the_hand() -> None:
    """To the right and down with the pointer, as if the hand held it; half a turn for a picture's height."""
    camera = OrbitCamera(Orbit(0, 0, 4))
    camera.drag(0.01, 0.0)
    assert clip(camera, 1.0, (0, 0, 1))[0] > 0
    camera.reset()
    camera.drag(0.0, 0.01)
    assert clip(camera, 1.0, (0, 0, 1))[1] < 0
    camera.reset()
    camera.drag(1.0, 0.0)
    assert camera.yaw == pytest.approx(180.0)


def test_the_camera_never_goes_over_the_top() -> None:
    """At the pole left and right would swap."""
    camera = OrbitCamera(Orbit())
    for down in (9.0, -18.0):
        camera.drag(0.0, down)
        assert abs(camera.pitch) == 89.0
        assert np.isfinite(camera.view()).all()


def test_zoom_is_smooth_and_bounded() -> None:
    """Fractions of a notch add up; no scroll leads through the target or to infinity."""
    camera, other = OrbitCamera(Orbit()), OrbitCamera(Orbit())
    camera.zoom(3)
    for _ in range(30):
        other.zoom(0.1)
    assert camera.distance == pytest.approx(other.distance)
    assert camera.distance < Orbit().distance
    camera.zoom(1000)
    assert camera.distance == pytest.approx(Orbit().distance / 20)
    camera.zoom(-1000)
    assert camera.distance == pytest.approx(Orbit().distance * 20)


def test_reset_brings_the_starting_pose_back() -> None:
    """All of it: angles, distance, target and field of view."""
    start = Orbit(10, 20, 3, (1, 2, 3), 40)
    camera = OrbitCamera(start)
    camera.pose(Orbit(50, 60, 7, (0, 0, 0), 20))
    camera.pan(1, 1)
    camera.reset()
    assert (camera.yaw, camera.pitch, camera.distance, tuple(camera.target), camera.field_of_view) == (
        10, 20, 3, (1, 2, 3), 40)


def test_a_place_may_be_told_in_numpy_s_numbers() -> None:
    pose = Orbit().moved({"yaw": np.float32(30.0), "distance": np.int64(3), "target": np.zeros(3)})
    camera = OrbitCamera(pose)
    assert (camera.yaw, camera.distance, list(camera.target)) == (30.0, 3.0, [0.0, 0.0, 0.0])
