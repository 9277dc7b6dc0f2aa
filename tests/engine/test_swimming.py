"""The hero's swimming on the GPU: the same as in NumPy, a beat that never jumps, and fins that paddle."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from pathlib import Path

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from viewer.engine.fish.fins import FinParameters
from viewer.engine.fish.school import SchoolParameters
from viewer.engine.fish.swimming import FULL_TURN, Swimming, SwimParameters
from viewer.engine.gpu import Gpu
from viewer.engine.shaders import ShaderFolders
from viewer.kit import fish as fish_kit
from viewer.kit.rig import Skeleton
from viewer.kit.swim import Swim

SHADERS = Path(__file__).parents[2] / "shaders"
PROBE = """#version 330 core
#include "fish/swim.glsl"
#include "fish/pose.glsl"

uniform float u_probe_turn;

in vec3 in_position;
in vec3 in_normal;

out vec3 v_position;
out vec3 v_normal;
out vec3 v_placed;
out vec4 v_pose;

void main() {
    v_position = in_position;
    v_normal = in_normal;
    swim(v_position, v_normal, u_phase, u_probe_turn);
    FishPose pose = fish_pose(0);
    v_placed = place_of(pose, in_position);
    v_pose = vec4(pose.size, pose.phase, pose.bend, determinant(pose.turn));
    gl_Position = vec4(v_position, 1.0);
}
"""
STEP = 1.0 / 60.0
SPECIES = sorted(fish_kit.SPECIES)
STILL: Mapping[str, object] = {
    "fin_stroke": 0.0, "fin_feather": 0.0, "fin_spread": 0.0, "fin_steer": 0.0, "tail_fan": 0.0, "tail_lag": 0.0}


class Parameters(SwimParameters, FinParameters, SchoolParameters):
    """All that a fish's scene has."""


@pytest.fixture
def gpu(context: moderngl.Context, tmp_path: Path) -> Iterator[Gpu]:
    (tmp_path / "probe.vert").write_text(PROBE)
    gpu = Gpu(context, ShaderFolders([tmp_path, SHADERS]))
    gpu.framebuffer([gpu.texture((1, 1), 4)]).use()
    yield gpu
    gpu.release()


def random_points(count: int) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Points around a fish, beyond its ends too, and unit normals, (count, 3) each."""
    random = np.random.default_rng(7)
    points, normals = random.uniform([-0.6, -0.2, -0.06], [0.6, 0.2, 0.06], (count, 3)), random.normal(size=(count, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return points.astype(np.float32), normals.astype(np.float32)


def test_the_gpu_bends_the_fish_as_numpy_does(gpu: Gpu) -> None:
    """Positions to 1e-5 of the body and normals to a hundredth of a degree, all over what the parameters allow."""
    points, normals = random_points(1000)
    array = gpu.vertex_array(gpu.program("probe.vert"), [(gpu.buffer(points), "3f", "in_position"),
                                                         (gpu.buffer(normals), "3f", "in_normal")])
    random, params = np.random.default_rng(3), Parameters({"yaw": True, "roll": True, "side_to_side": True})
    swimming = Swimming(params)
    for _ in range(30):
        params.update({name: random.uniform(*ends) for name, ends in {
            "wavelength": (0.6, 3.0), "amplitude": (0.0, 0.25), "stiffness": (0.0, 1.0), "twist_angle": (0.0, 60.0),
            "roll_angle": (0.0, 60.0), "yaw_angle": (0.0, 45.0), "sway": (0.0, 0.25)}.items()})
        swimming.phase, turn = random.uniform(0.0, 100.0), random.uniform(-2.0, 2.0)
        swimming.tell(array.program)
        array.program["u_probe_turn"] = turn
        captured = array.capture({"v_position": 3, "v_normal": 3}, len(points))
        moved, turned = swimming.swim.deform(points, normals, swimming.phase, turn)
        np.testing.assert_allclose(captured["v_position"], moved, atol=1e-5)
        np.testing.assert_allclose(captured["v_normal"], turned, atol=1.7e-4)


@pytest.mark.parametrize("part", ["wave", "side_to_side", "yaw", "roll", "twist"])
def test_each_part_can_be_switched_on_alone(part: str) -> None:
    """And each moves the fish in a way of its own; without any it is straight."""
    still = dict.fromkeys(("wave", "side_to_side", "yaw", "roll", "twist"), False)
    assert Swimming(Parameters(still)).swim == Swim(amplitude=0.0, stiffness=Parameters().stiffness)
    swim = Swimming(Parameters({**still, part: True})).swim
    names = {"wave": "amplitude", "side_to_side": "sway"}
    moving = {name for name in ("amplitude", "sway", "yaw", "roll", "twist") if getattr(swim, name)}
    assert moving == {names.get(part, part)}


def test_another_frequency_changes_the_pace_and_never_jumps() -> None:
    """However it changes from frame to frame, no point moves farther than the fastest beat takes it in one."""
    random, params = np.random.default_rng(2), Parameters()
    swimming, before = Swimming(params), None
    tail = np.array([[-0.5, 0.0, 0.0]])
    farthest, beats = 0.0, 0.0
    for _ in range(400):
        params.set("tail_beat_hz", random.choice([0.0, 0.5, 3.0, 6.0]))
        swimming.advance(STEP)
        beats += params.tail_beat_hz * STEP
        now = swimming.swim.deform(tail, tail, swimming.phase)[0]
        farthest = max(farthest, float(np.linalg.norm(now - before))) if before is not None else 0.0
        before = now
    assert swimming.phase == pytest.approx(FULL_TURN * beats, rel=1e-12)
    assert 0.01 < farthest <= FULL_TURN * 6.0 * STEP * swimming.swim.reach * 1.01


def test_the_beat_is_exact_after_hours(gpu: Gpu) -> None:
    """Ten seconds on from five hours' worth of beats, the shader gets the phase that an exact sum has."""
    params = Parameters({"tail_beat_hz": 1.5})
    swimming, program = Swimming(params), gpu.program("probe.vert")
    start = swimming.phase = FULL_TURN * 1.5 * 5 * 3600.0
    for _ in range(600):
        swimming.advance(STEP)
    exact = math.fsum([start, *[FULL_TURN * 1.5 * STEP] * 600])
    swimming.tell(program)
    told = program._own_uniforms["u_phase"]
    assert 0.0 <= told < FULL_TURN
    assert math.remainder(told - exact, FULL_TURN) == pytest.approx(0.0, abs=1e-6)


TILTED = """#version 330 core
float pattern_start() { return 0.0; }
#include "particles/random.glsl"
#include "fish/scales.glsl"

in vec3 in_normal;
in vec3 in_ahead;

out vec3 v_normal;

void main() {
    v_normal = tilted(in_normal, in_ahead, vec2(0.3, -0.2));
    gl_Position = vec4(0.0);
}
"""


def test_scales_tilt_the_normal_wherever_it_points(gpu: Gpu, tmp_path: Path) -> None:
    """By their slopes; at the tip of the nose and of the tail, where it is the heading, not at all."""
    (tmp_path / "tilted.vert").write_text(TILTED)
    normals, ahead = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0]], "f4"), np.tile(np.float32([1, 0, 0]), (3, 1))
    array = gpu.vertex_array(gpu.program("tilted.vert"), [
        (gpu.buffer(normals), "3f", "in_normal"), (gpu.buffer(ahead), "3f", "in_ahead")])
    steep = np.array([0.3, 1.0, 0.2 * -1.0])
    wanted = [[1, 0, 0], [-1, 0, 0], steep / np.linalg.norm(steep)]
    np.testing.assert_allclose(array.capture({"v_normal": 3}, 3)["v_normal"], wanted, atol=1e-6)


def test_going_back_to_a_moment() -> None:
    """The same beats follow, of the tail and of the fins."""
    swimming = Swimming(Parameters())
    swimming.advance(0.7)
    kept = swimming.snapshot()
    assert kept.nbytes == 16
    swimming.advance(0.4)
    later = swimming.phase, swimming.fin_phase
    swimming.restore(kept)
    swimming.advance(0.4)
    assert (swimming.phase, swimming.fin_phase) == later


def test_what_has_no_effect_is_said() -> None:
    """An amplitude beyond what a wave allows, and a wave that nothing makes."""
    assert not Swimming(Parameters()).remarks()
    wide = Swimming(Parameters({"amplitude": 0.25, "wavelength": 0.6}))
    assert "0.250" in wide.remarks()[0] and f"{wide.swim.reach:.3f}" in wide.remarks()[0]
    calm = Swimming(Parameters({"wave": False, "twist": False, "yaw": True}))
    assert "wavelength and stiffness" in calm.remarks()[0]


def test_every_parameter_does_something() -> None:
    """Changing one that is active changes how the hero swims or holds its fins."""
    everything = {"wave": True, "side_to_side": True, "yaw": True, "roll": True, "twist": True, "turn": 20.0}
    changed: dict[str, object] = {
        "tail_beat_hz": 3.0, "fin_beat_hz": 3.0, "turn": -30.0, "amplitude": 0.05, "wavelength": 1.4, "stiffness": 0.2,
        "sway": 0.02, "yaw_angle": 3.0, "roll_angle": 3.0, "twist_angle": 30.0, "fin_stroke": 40.0,
        "fin_feather": 40.0, "fin_rhythm": "in_turn", "fin_spread": 20.0, "fin_steer": 0.2, "tail_fan": 20.0,
        "tail_lag": 40.0, "fin_twist": 90.0, **dict.fromkeys(("wave", "side_to_side", "yaw", "roll", "twist"), False)}
    declared = {**SwimParameters.declared, **FinParameters.declared}
    assert changed.keys() == declared.keys() - {"fin_method"}       # which is the palette's

    def shown(values: Mapping[str, object]) -> list[float]:
        swimming = Swimming(Parameters(values))
        swimming.advance(0.23)
        points = random_points(20)
        moved = np.concatenate(swimming.swim.deform(*points, swimming.phase, math.radians(swimming.params.turn)))
        return [*moved.ravel(), *swimming.fin_pose(fish_kit.fish_skeleton("koi")).ravel()]

    before = shown(everything)
    for name, value in changed.items():
        assert not np.allclose(shown({**everything, name: value}), before, atol=1e-4), name


def test_the_hero_lies_at_the_origin(gpu: Gpu) -> None:
    """With the phase and the turn of the parameters."""
    points, normals = random_points(10)
    params = Parameters({"turn": 40.0})
    gpu.share(params)
    array = gpu.vertex_array(gpu.program("probe.vert"), [(gpu.buffer(points), "3f", "in_position"),
                                                         (gpu.buffer(normals), "3f", "in_normal")])
    swimming = Swimming(params)
    swimming.advance(0.3)
    swimming.tell(array.program)
    captured = array.capture({"v_placed": 3, "v_pose": 4}, len(points))
    np.testing.assert_array_equal(captured["v_placed"], points)
    wanted = [1.0, swimming.phase, math.radians(40.0), 1.0]
    np.testing.assert_allclose(captured["v_pose"], np.tile(wanted, (10, 1)), rtol=1e-6)


# Fins


def moved_tips(species: str, phase: float = 0.0, turn: float = 0.0, **values: object) -> dict[str, NDArray[np.float64]]:
    """How a point on each joint's x axis moves from rest, by joint, (3,)."""
    skeleton, params = fish_kit.fish_skeleton(species), Parameters({**STILL, "turn": turn, **values})
    swimming = Swimming(params)
    swimming.fin_phase = swimming.phase = phase
    tip = np.array([0.1, 0.0, 0.0, 1.0])
    moved = skeleton.world(swimming.fin_pose(skeleton)) @ tip - skeleton.world() @ tip
    return dict(zip(skeleton.names, moved[:, :3], strict=True))


@pytest.mark.parametrize("species", SPECIES)
def test_fins_that_do_nothing_are_at_rest(species: str) -> None:
    """And so are joints of another skeleton, whatever fins do."""
    assert all(not np.abs(moved).max() > 1e-12 for moved in moved_tips(species).values())
    other = Skeleton(("spine",), np.array([-1], np.int32), np.zeros((1, 3)), np.array([[0.0, 0.0, 0.0, 1.0]]),
                     np.ones((1, 3)))
    np.testing.assert_allclose(Swimming(Parameters()).fin_pose(other), np.eye(4)[None], atol=1e-12)


@pytest.mark.parametrize("species", SPECIES)
@pytest.mark.parametrize("values", [{"fin_spread": 20.0}, {"fin_stroke": 30.0}, {"fin_feather": 30.0},
                                    {"fin_twist": 50.0, "fin_spread": 9.0}])
def test_left_and_right_fins_are_mirror_images(species: str, values: dict[str, object]) -> None:
    """When they keep time together and nobody turns; the body's own joint never moves."""
    moved = moved_tips(species, 1.0, **values)
    for name in ("pectoral", "pectoral tip", "pelvic"):
        np.testing.assert_allclose(moved[f"left {name}"] * [1, 1, -1], moved[f"right {name}"], atol=1e-9)
    assert not moved["body"].any()


@pytest.mark.parametrize("species", SPECIES)
def test_fins_spread_away_from_the_body(species: str) -> None:
    """To the right on the right side."""
    moved = moved_tips(species, fin_spread=20.0)
    assert all(moved[f"right {name}"][2] > 0.002 for name in ("pectoral", "pelvic"))


def test_fins_that_paddle_in_turn_are_half_a_beat_apart() -> None:
    """The right one is where the left one is half a beat later."""
    now = moved_tips("koi", 0.7, fin_stroke=30.0, fin_rhythm="in_turn")
    later = moved_tips("koi", 0.7 + math.pi, fin_stroke=30.0, fin_rhythm="in_turn")
    np.testing.assert_allclose(now["right pectoral"], later["left pectoral"] * [1, 1, -1], atol=1e-9)
    assert np.linalg.norm(now["right pectoral"] - now["left pectoral"] * [1, 1, -1]) > 0.01


@pytest.mark.parametrize("turn", [50.0, -50.0])
def test_the_inner_fin_spreads_in_a_turn(turn: float) -> None:
    """The left one in a turn to the left; the outer one only banks."""
    moved = moved_tips("clownfish", turn=turn, fin_steer=1.0)
    inner, outer = ("left", "right") if turn > 0.0 else ("right", "left")
    assert np.linalg.norm(moved[f"{inner} pectoral"]) > 0.02
    assert np.linalg.norm(moved[f"{outer} pectoral"]) < 0.01


@pytest.mark.parametrize("phase", np.linspace(0.0, 6.0, 7))
def test_the_tail_lags_behind_its_stalk(phase: float) -> None:
    """Both lobes are swung against the way that the stalk is going."""
    swim = Swimming(Parameters()).swim
    speed = swim.midline(1.0, phase + 1e-4)[1] - swim.midline(1.0, phase - 1e-4)[1]
    moved = moved_tips("koi", phase, tail_lag=20.0)
    for lobe in ("tail upper", "tail lower"):
        assert moved[lobe][2] * speed < 0.0


def test_a_twist_turns_the_tips_alone_about_their_length() -> None:
    """By the angle that is asked for, so that the skin between root and tip collapses."""
    skeleton = fish_kit.fish_skeleton("koi")
    local = Swimming(Parameters({**STILL, "fin_twist": 180.0})).fin_pose(skeleton)
    relative = np.linalg.inv(skeleton.local()) @ local
    for name, turn in zip(skeleton.names, relative, strict=True):
        wanted = np.diag([1.0, -1.0, -1.0, 1.0]) if name.endswith("tip") else np.eye(4)
        np.testing.assert_allclose(turn, wanted, atol=1e-12)
