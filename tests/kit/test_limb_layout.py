"""Limbs beside each other: seen alike, inside the picture, above their captions."""

from __future__ import annotations

import numpy as np
import pytest

from viewer.engine.camera import Orbit, OrbitCamera
from viewer.kit.limb_layout import LimbLayout, View

CORNERS = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])


def layout(aspect: float, size: tuple[float, float, float], count: int = 3, top: float = -0.635) -> LimbLayout:
    """Of a box of that size, seen as the camera starts."""
    return LimbLayout(View(14.0, 6.6, 24.0, aspect), count, np.zeros(3), np.array(size), top)


def in_picture(of: LimbLayout, aspect: float, yaw: float = 14.0) -> np.ndarray:
    """Where the corners of each limb's box appear, (count, 8, 2), each -1 to 1."""
    camera = OrbitCamera(Orbit(yaw=yaw, pitch=9, distance=6.6, field_of_view=24))
    matrix = camera.view() @ camera.projection(aspect, (0.0, of.raised))
    places = of.in_studio(CORNERS * of.high)
    seen = [np.c_[stand.placed(places), np.ones(8)] @ matrix for stand in of.stands(camera.eye, camera.view()[:3, 0])]
    return np.array([each[:, :2] / each[:, 3:] for each in seen])


@pytest.mark.parametrize("yaw", [14.0, 100.0, -75.0])
def test_all_limbs_are_seen_from_the_same_side(yaw: float) -> None:
    """Each looks like the one in the middle, moved aside, but for the little that a lens leans."""
    seen = in_picture(layout(16 / 9, (0.4, 2.1, 0.4)), 16 / 9, yaw)
    shapes = seen - seen.mean(axis=1, keepdims=True)
    assert np.abs(shapes[[0, 2]] - shapes[1]).max() < 0.03
    assert np.ptp(shapes[1], axis=0).min() > 0.1


@pytest.mark.parametrize("aspect", [0.7, 1.0, 16 / 9, 3.0])
@pytest.mark.parametrize("size", [(0.4, 2.1, 0.4), (25.0, 78.0, 155.0), (1e-3, 1e-4, 1e-3)])
@pytest.mark.parametrize("count", [1, 3])
def test_limbs_fit_between_their_captions_and_the_edge(aspect: float, size: tuple[float, float, float],
                                                       count: int) -> None:
    """Whatever their size; on the floor. What comes near to the eye may stand a little lower."""
    of = layout(aspect, size, count)
    seen = in_picture(of, aspect)
    assert seen[..., 1].max() < 1.1 and seen[..., 1].min() > of.top - 0.2
    assert np.abs(seen[..., 0]).max() < 1.15
    assert of.in_studio(np.zeros((1, 3)))[0, 1] == pytest.approx(-1.06)
