"""Animations of glTF files: what lies between their keys, against SciPy, and how they are put together."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline
from scipy.spatial.transform import Rotation, Slerp

from tests.kit.gltf_samples import Sample, big_model, flag
from viewer.kit.gltf import Clip, RiggedModel, read_model

TIMES = np.array([0.5, 1.0, 2.5, 3.0])
NUMBERS = np.random.default_rng(11)


def moved(folder: Path, path: str, values: NDArray[np.float64], between: str,
          times: NDArray[np.float64] = TIMES) -> RiggedModel:
    """A flag whose joint 2, node 2, is animated."""
    sample = flag()
    sample.animate(2, path, times, values, between)
    return read_model(sample.written(folder))


def posed(model: RiggedModel, time: float) -> dict[str, NDArray[np.float64]]:
    """Each property of the animated joint at a time."""
    found = model.clips[0].pose(model.mesh.skeleton, time)
    return dict(zip(("translation", "rotation", "scale"), (values[2] for values in found), strict=True))


def test_turns_go_the_shorter_way_at_even_speed(tmp_path: Path) -> None:
    """As SciPy's Slerp; also between quaternions with opposite signs."""
    turns = Rotation.random(4, rng=NUMBERS)
    values = turns.as_quat() * np.array([1, -1, 1, -1])[:, None]
    model = moved(tmp_path, "rotation", values, "LINEAR")
    expected = Slerp(TIMES, turns)
    for time in (0.5, 0.6, 0.99, 1.0, 1.7, 2.5, 2.6, 3.0):
        found = Rotation.from_quat(posed(model, time)["rotation"])
        assert (found * expected([time])[0].inv()).magnitude() < 1e-6


@pytest.mark.parametrize("path", ["translation", "scale"])
def test_places_and_sizes_go_straight(path: str, tmp_path: Path) -> None:
    """As numpy.interp."""
    values = NUMBERS.normal(size=(4, 3)).astype(np.float32)
    model = moved(tmp_path, path, values, "LINEAR")
    for time in (0.0, 0.5, 0.7, 1.0, 2.0, 2.999, 50.0):
        expected = [np.interp(time, TIMES, column) for column in values.T]
        assert np.allclose(posed(model, time)[path], expected, atol=1e-6)


@pytest.mark.parametrize("path", ["translation", "rotation", "scale"])
def test_steps_wait_for_the_next_key(path: str, tmp_path: Path) -> None:
    """And take it at its very time."""
    width = 4 if path == "rotation" else 3
    values = NUMBERS.normal(size=(4, width))
    values /= np.linalg.norm(values, axis=1, keepdims=True)
    model = moved(tmp_path, path, values, "STEP")
    for time, key in ((-1.0, 0), (0.5, 0), (0.999, 0), (1.0, 1), (2.4, 1), (2.5, 2), (3.0, 3), (9.0, 3)):
        assert np.allclose(posed(model, time)[path], values[key], atol=1e-6)


@pytest.mark.parametrize("path", ["translation", "rotation", "scale"])
def test_cubic_splines_are_those_of_hermite(path: str, tmp_path: Path) -> None:
    """As SciPy's where the tangents in and out of a key are the same; turns are normalised after it."""
    width = 4 if path == "rotation" else 3
    values, tangents = NUMBERS.normal(size=(2, 4, width)).astype(np.float32)
    model = moved(tmp_path, path, np.stack([tangents, values, tangents], axis=1).reshape(-1, width), "CUBICSPLINE")
    spline = CubicHermiteSpline(TIMES, values, tangents)
    for time in (0.0, 0.5, 0.8, 1.0, 1.9, 2.6, 3.0, 4.0):
        expected = spline(np.clip(time, 0.5, 3.0))
        expected = expected / np.linalg.norm(expected) if path == "rotation" else expected
        assert np.allclose(posed(model, time)[path], expected, atol=1e-5)


def test_cubic_splines_leave_a_key_by_its_last_tangent(tmp_path: Path) -> None:
    """And come in by the first: here they rise by 1 per second behind each key, and arrive level."""
    level, rise = [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]
    model = moved(tmp_path, "translation", np.array([level, level, rise] * 4), "CUBICSPLINE")
    behind, before = (posed(model, time)["translation"][0] for time in (1.0 + 1e-4, 2.5 - 1e-4))
    assert behind == pytest.approx(1e-4, rel=1e-3) and before == pytest.approx(0.0, abs=1e-7)


def test_one_key_stands_for_all_times(tmp_path: Path) -> None:
    """A clip of a single pose."""
    model = moved(tmp_path, "translation", np.array([[1.0, 2.0, 3.0]]), "LINEAR", TIMES[:1])
    assert model.clips[0].seconds == 0.5
    assert all(posed(model, time)["translation"].tolist() == [1, 2, 3] for time in (0.0, 0.5, 7.0))


def test_what_no_channel_moves_is_at_rest(tmp_path: Path) -> None:
    """And the skeleton is not changed."""
    model = moved(tmp_path, "translation", np.ones((4, 3)), "LINEAR")
    skeleton = model.mesh.skeleton
    before = skeleton.translations.copy()
    translations, rotations, scales = model.clips[0].pose(skeleton, 1.0)
    assert np.array_equal(translations[:2], before[:2]) and np.array_equal(skeleton.translations, before)
    assert np.array_equal(rotations, skeleton.rotations) and np.array_equal(scales, skeleton.scales)


def test_turns_may_be_whole_numbers(tmp_path: Path) -> None:
    """Shares of 32767, as the format allows."""
    sample = flag()
    turn = Rotation.from_rotvec([0.2, 0.5, 0.1]).as_quat()
    sampler = {"input": sample.accessor([0.0]),
               "output": sample.accessor(np.rint([turn * 32767]), "int16", normalized=True)}
    sample.add("animations", samplers=[sampler], channels=[{"sampler": 0, "target": {"node": 1, "path": "rotation"}}])
    model = read_model(sample.written(tmp_path))
    assert model.clips[0].name == "animation 0"
    assert np.allclose(model.clips[0].pose(model.mesh.skeleton, 0.0)[1][1], turn, atol=1e-4)


def clips_of(sample: Sample, folder: Path) -> tuple[Clip, ...]:
    return read_model(sample.written(folder)).clips


def test_channels_that_move_no_joint_are_left_out(tmp_path: Path) -> None:
    """Weights of morph targets, nodes that are not shown, channels without a node; a clip of nothing else too."""
    sample = flag()
    sample.add("nodes", name="elsewhere")
    sample.json["scenes"] = [{"nodes": [0, 1]}]
    for target in ({"node": 0, "path": "weights"}, {"path": "scale"}, {"node": 3, "path": "scale"}):
        sample.add("animations", samplers=[{"input": 0, "output": 0}], channels=[{"sampler": 0, "target": target}])
    assert clips_of(sample, tmp_path) == ()


def test_a_big_model_is_read_and_posed_whole(tmp_path: Path) -> None:
    """192 channels at once; each bone has turned by what its own channel says."""
    model = read_model(big_model(tmp_path / "big.glb", 1200))
    clip, = model.clips
    assert (clip.name, len(model.mesh.bones), model.influences) == ("wave", 64, 4)
    key = 7
    time, phase = 2.0 * key / 29, 2.0 * np.pi * key / 29
    _, rotations, scales = clip.pose(model.mesh.skeleton, time)
    angles = 0.1 * np.sin(phase + np.arange(64))
    assert np.allclose(2.0 * np.arctan2(rotations[1:, 2], rotations[1:, 3]), angles, atol=1e-5)
    assert np.allclose(scales[1:, 0], 1.0 + 0.5 * angles, atol=1e-5)
