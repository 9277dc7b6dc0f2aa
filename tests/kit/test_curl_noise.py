"""The turbulent flow: the curl of its potential, without sources or sinks, and the same on the GPU."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from viewer.engine.gpu import Gpu
from viewer.engine.shaders import ShaderFolders
from viewer.kit.curl_noise import APART, SCALE, curl_noise
from viewer.kit.noise import noise

SHADERS = Path(__file__).parents[2] / "shaders"
PROBE = """#version 330 core
#include "lib/curl_noise.glsl"
in vec3 in_place;
out vec3 v_flow;
void main() {
    v_flow = curl_noise(in_place);
    gl_Position = vec4(0.0);
}
"""
Points = NDArray[np.float64]
Field = Callable[[Points], Points]


def places(number: int, reach: float = 40.0, seed: int = 5) -> Points:
    """Points spread over a cube around the origin."""
    return np.random.default_rng(seed).uniform(-reach, reach, (number, 3))


def jacobian(field: Field, points: Points, step: float) -> Points:
    """Derivatives of a vector field (n, 3, 3), the last axis by x, y and z, from four neighbours along each."""
    columns = []
    for axis in np.eye(3):
        near = field(points + step * axis) - field(points - step * axis)
        far = field(points + 2 * step * axis) - field(points - 2 * step * axis)
        columns.append((8 * near - far) / (12 * step))
    return np.stack(columns, axis=-1)


def gradient(points: Points, step: float) -> Points:
    """Of Perlin's noise, by differences."""
    return jacobian(lambda some: np.asarray(noise(*some.T), np.float64)[:, None], points, step)[:, 0]


def test_the_flow_is_the_curl_of_its_potential() -> None:
    """Which is one noise times the other's gradient; all derivatives here by differences of two steps."""
    points = places(400)

    def potential(some: Points) -> Points:
        return SCALE * np.asarray(noise(*some.T), np.float64)[:, None] * gradient(some + APART, 1.3e-3)

    slope = jacobian(potential, points, 2.1e-3)
    curl = np.stack([slope[:, 2, 1] - slope[:, 1, 2], slope[:, 0, 2] - slope[:, 2, 0],
                     slope[:, 1, 0] - slope[:, 0, 1]], axis=1)
    error = np.abs(curl_noise(points) - curl)
    assert np.median(error) < 1e-8
    assert error.max() < 30 * 2.1e-3**2        # where a difference reaches over the border of a cell


@pytest.mark.parametrize("step", [3.7e-4, 1.1e-3])
def test_nothing_flows_in_or_out(step: float) -> None:
    """The divergence vanishes, though each of its three terms is of the order of one."""
    points = places(2000)
    terms = np.diagonal(jacobian(curl_noise, points, step), axis1=1, axis2=2)
    assert np.sqrt((terms**2).mean()) > 0.5
    error = np.abs(terms.sum(axis=1))
    assert np.median(error) < 2e-8
    assert error.max() < 30 * step**2           # where a difference reaches over the border of a cell


def test_what_flows_into_a_box_flows_out_of_it() -> None:
    """The flux through the faces of boxes of many sizes, by Gauss's rule: no derivative is taken at all."""
    nodes, weights = np.polynomial.legendre.leggauss(24)
    for corner, size in zip(places(6), (0.05, 0.1, 0.2, 0.3, 0.4, 0.5), strict=True):
        across, up = (grid.ravel() for grid in np.meshgrid(nodes, nodes))
        share = np.outer(weights, weights).ravel() / 4 * size**2
        net = gross = 0.0
        for axis in range(3):
            for side in (-1.0, 1.0):
                face = 0.5 * size * np.roll(np.stack([np.full_like(across, side), across, up], axis=1), axis, axis=1)
                through = side * curl_noise(corner + face)[:, axis]
                net += float(share @ through)
                gross += float(share @ np.abs(through))
        assert abs(net) < 2e-3 * gross


def test_its_mean_square_is_one_and_its_mean_nothing() -> None:
    flow = curl_noise(places(200_000, reach=120.0))
    assert (flow**2).sum(axis=1).mean() == pytest.approx(1.0, abs=0.02)
    assert np.abs(flow.mean(axis=0)).max() < 0.01
    np.testing.assert_allclose((flow**2).mean(axis=0), 1 / 3, atol=0.03)     # and no direction is preferred


def test_eddies_are_about_one_unit_wide() -> None:
    """Half a unit away the flow still resembles itself, three units away it does not."""
    points, away = places(20_000), np.array([0.6, 0.48, 0.64])
    flow = curl_noise(points)
    alike = [float((flow * curl_noise(points + distance * away)).sum(axis=1).mean()) for distance in (0.1, 3.0)]
    assert alike[0] > 0.8
    assert abs(alike[1]) < 0.1


def test_one_point_and_none() -> None:
    np.testing.assert_array_equal(curl_noise([[0.3, 0.4, 0.5], [1.3, 2.4, 3.5]])[:1], curl_noise([[0.3, 0.4, 0.5]]))
    assert curl_noise(np.empty((0, 3))).shape == (0, 3)


def test_the_same_on_the_gpu(context: moderngl.Context, tmp_path: Path) -> None:
    """As closely as single precision tells places apart."""
    points = np.concatenate([places(3000, reach=8.0), places(300, reach=100.0)]).astype(np.float32)
    (tmp_path / "probe.vert").write_text(PROBE)
    gpu = Gpu(context, ShaderFolders([tmp_path, SHADERS]))
    try:
        gpu.framebuffer([gpu.texture((1, 1), 4)]).use()
        program = gpu.program("probe.vert")
        array = gpu.vertex_array(program, [(gpu.buffer(points), "3f", "in_place")])
        found = array.capture({"v_flow": 3}, len(points))["v_flow"]
    finally:
        gpu.release()
    wanted = curl_noise(points.astype(np.float64))
    np.testing.assert_allclose(found[:3000], wanted[:3000], atol=3e-5)
    np.testing.assert_allclose(found[3000:], wanted[3000:], atol=3e-4)
