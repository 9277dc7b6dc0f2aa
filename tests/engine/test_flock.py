"""The school on the GPU: the same as in NumPy, within its tank, steady for long, and the same when played again."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import wraps
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from viewer.engine.fish.flock import FISH_IN_ROW, Flock, packed
from viewer.engine.fish.school import SchoolParameters
from viewer.engine.fish.swimming import SwimParameters
from viewer.engine.gpu import Gpu
from viewer.engine.shaders import ShaderFolders
from viewer.kit.swim_school import (
    BANK,
    BEND,
    CELL,
    PHASE,
    PLACE,
    SIZE,
    VELOCITY,
    WILL,
    polarisation,
    school_step,
)

SHADERS = Path(__file__).parents[2] / "shaders"
DT = 1.0 / 60.0
PROBE = """#version 330 core
#include "fish/pose.glsl"

in float in_fish;
in vec3 in_point;

out vec3 v_place;
out vec3 v_ahead;
out vec3 v_up;
out vec4 v_rest;

void main() {
    FishPose pose = fish_pose(int(in_fish));
    v_place = place_of(pose, in_point);
    v_ahead = pose.turn[0];
    v_up = pose.turn[1];
    v_rest = vec4(pose.size, pose.phase, pose.bend, determinant(pose.turn));
    gl_Position = vec4(v_place, 1.0);
}
"""
MakeFlock = Callable[..., Flock]
MAKERS = ("buffer", "texture", "framebuffer", "program", "vertex_array", "simple_vertex_array")


class Parameters(SwimParameters, SchoolParameters):
    """All that a school asks for."""


@pytest.fixture
def make_flock(context: moderngl.Context, tmp_path: Path) -> Iterator[MakeFlock]:
    """Makes schools, ``make_flock(school=100, ...)``; frees them after the test."""
    (tmp_path / "probe.vert").write_text(PROBE)
    arenas: list[Gpu] = []

    def make(seed: int = 0, **values: object) -> Flock:
        arenas.append(Gpu(context, ShaderFolders([tmp_path, SHADERS])))
        arenas[-1].framebuffer([arenas[-1].texture((1, 1), 4)]).use()
        params = Parameters(values, seed=seed)
        arenas[-1].share(params)
        return Flock(arenas[-1], params)

    yield make
    for arena in arenas:
        arena.release()


def play(flock: Flock, seconds: float) -> NDArray[np.float32]:
    """The state after so many seconds."""
    for _ in range(round(seconds / DT)):
        flock.step(DT)
    return flock.state.copy()


def crowded(flock: Flock, seed: int = 1) -> None:
    """Let everybody swim anyhow in a box, and be in the middle of some turn."""
    random, state = np.random.default_rng(seed), flock.state.copy()
    state[:, PLACE] = random.uniform(-0.5, 0.5, (len(state), 3)) * flock.half_axes
    velocity = random.normal(size=(len(state), 3)) * [1.0, 0.3, 1.0]
    velocity *= (random.uniform(*flock.params.speed, len(state)) / np.linalg.norm(velocity, axis=1))[:, None]
    state[:, VELOCITY] = velocity
    state[:, BEND], state[:, BANK] = random.uniform(-0.5, 0.5, (2, len(state)))
    flock.state = state


def nearest(state: NDArray[np.float32]) -> NDArray[np.float64]:
    """How far each one's nearest neighbour is, (n,)."""
    return np.asarray(cKDTree(state[:, PLACE]).query(state[:, PLACE], k=2)[0][:, 1], np.float64)


@pytest.mark.parametrize("values", [
    {}, {"perception": 3.0, "personal_space": 0.3}, {"separation": 0.0, "cohesion": 4.0},
    {"alignment": 4.0, "wander": 3.0, "turn": 60.0}, {"speed": (0.5, 4.0), "agility": 15.0, "steepest_climb": 60.0},
    {"fish_size": (0.3, 2.0), "tail_beat_hz": 5.0, "bank": 60.0}, {"school_room": 1.0, "perception": 0.5}])
def test_a_step_is_that_of_everybody_with_everybody(make_flock: MakeFlock, values: dict[str, object]) -> None:
    """Random schools and the grid of cells, against NumPy in double precision and no grid."""
    flock = make_flock(school=300, **values)
    for seed in range(3):
        crowded(flock, seed)
        wanted = school_step(flock.state, flock.rules, flock.seconds, DT)
        flock.step(DT)
        found = flock.state.astype(np.float64)
        found[:, PHASE] = wanted[:, PHASE] + np.angle(np.exp(1j * (found[:, PHASE] - wanted[:, PHASE])))
        found[:, CELL] = wanted[:, CELL]
        np.testing.assert_allclose(found, wanted, atol=1e-4)


@pytest.mark.parametrize("count", [2, 127, 128, 513, 1500])
def test_every_fish_is_itself_however_many_there_are(make_flock: MakeFlock, count: int) -> None:
    """Size and will stay with it, and nobody moves farther than it can, wherever it stands in the grid's order."""
    flock = make_flock(school=count)
    before = flock.state.copy()
    after = play(flock, 5 * DT)
    assert after.shape == (count, 12)
    np.testing.assert_array_equal(after[:, [SIZE, WILL]], before[:, [SIZE, WILL]])
    moved = np.linalg.norm(after[:, PLACE] - before[:, PLACE], axis=1)
    assert moved.min() > 0.0 and moved.max() <= 5 * DT * flock.rules.fastest * 1.001


def test_a_school_comes_to_swim_one_way(make_flock: MakeFlock) -> None:
    """From random headings, in some seconds, in open water."""
    flock = make_flock(school=120, school_room=200.0, perception=2.5, personal_space=0.5)
    state = flock.state.copy()
    state[:, PLACE] *= 0.2
    flock.state = state
    assert polarisation(state[:, VELOCITY]) < 0.2
    assert polarisation(play(flock, 10.0)[:, VELOCITY]) > 0.8


def test_without_alignment_it_does_not(make_flock: MakeFlock) -> None:
    """The rule is what makes it so."""
    flock = make_flock(school=120, school_room=200.0, alignment=0.0, cohesion=0.0, separation=0.0)
    assert polarisation(play(flock, 5.0)[:, VELOCITY]) < 0.4


@pytest.mark.parametrize("values", [
    {}, {"school_room": 1.0, "speed": (1.0, 6.0)}, {"cohesion": 4.0, "separation": 0.0, "perception": 5.0}])
def test_everybody_stays_in_the_tank(make_flock: MakeFlock, values: dict[str, object]) -> None:
    """All start at the wall, heading outwards: never beyond it, too fast or slow, too steep, or nowhere at all."""
    flock = make_flock(school=120, **values)
    state, half_axes = flock.state.copy(), np.array(flock.half_axes)
    outward = state[:, PLACE] / half_axes
    outward *= 0.97 / np.linalg.norm(outward, axis=1, keepdims=True)
    state[:, PLACE] = outward * half_axes
    level = outward / half_axes * [1.0, 0.0, 1.0]
    state[:, VELOCITY] = flock.rules.fastest * level / np.linalg.norm(level, axis=1, keepdims=True)
    flock.state = state
    for steps in (*[1] * 20, *[20] * 14):
        state = play(flock, steps * DT)
        assert np.isfinite(state).all()
        assert np.linalg.norm(state[:, PLACE] / flock.half_axes, axis=1).max() <= 1.00001
        speed = np.linalg.norm(state[:, VELOCITY], axis=1)
        assert speed.min() >= flock.rules.slowest * 0.9999 and speed.max() <= flock.rules.fastest * 1.0001
        climb = np.arctan2(np.abs(state[:, 5]), np.hypot(state[:, 4], state[:, 6]))
        assert climb.max() <= flock.rules.steepest * 1.0001


def test_fish_keep_their_distance_and_stay_together(make_flock: MakeFlock) -> None:
    """The nearest neighbour is half a length away or more on the average, and hardly anybody is all alone."""
    flock = make_flock(school=400)
    play(flock, 12.0)
    distances = [nearest(play(flock, 0.5)) for _ in range(6)]
    assert np.mean(distances) > 0.5
    assert np.quantile(distances, 0.95) < flock.rules.perception


def test_fish_swim_level_smoothly_and_lean_into_turns(make_flock: MakeFlock) -> None:
    """Level in the mean, turning by a few degrees a frame at most, the bank following the turn."""
    flock = make_flock(school=300)
    play(flock, 8.0)
    states = np.stack([play(flock, DT) for _ in range(120)])
    velocity = states[:, :, VELOCITY]
    heading = velocity / np.linalg.norm(velocity, axis=2, keepdims=True)
    turned = np.degrees(np.arccos(np.clip((heading[1:] * heading[:-1]).sum(axis=2), -1.0, 1.0)))
    assert abs(velocity[:, :, 1].mean()) < 0.05
    assert np.quantile(turned, 0.99) < 3.0
    assert np.quantile(np.abs(np.diff(states[:, :, [BEND, BANK]], axis=0)), 0.999) < 0.1
    yaw = np.unwrap(np.arctan2(-velocity[:, :, 2], velocity[:, :, 0]), axis=0)
    assert np.corrcoef(yaw[-1] - yaw[0], states[:, :, BANK].mean(axis=0))[0, 1] > 0.8
    assert np.corrcoef(yaw[-1] - yaw[0], states[:, :, BEND].mean(axis=0))[0, 1] > 0.8


def test_the_same_seed_gives_the_same_school(make_flock: MakeFlock) -> None:
    """To the last bit, and another one another."""
    first, again, other = (play(make_flock(seed, school=700), 1.0) for seed in (4, 4, 5))
    np.testing.assert_array_equal(first, again)
    assert np.abs(first - other)[:, PLACE].max() > 1.0


def test_going_back_in_time_gives_the_same_again(make_flock: MakeFlock) -> None:
    """To the last bit, and the time of day with it."""
    flock = make_flock(school=300, wander=2.0)
    play(flock, 0.5)
    kept = flock.snapshot()
    assert kept.nbytes >= 300 * 12 * 4
    later, seconds = play(flock, 0.5), flock.seconds
    flock.restore(kept)
    assert flock.seconds == pytest.approx(0.5)
    np.testing.assert_array_equal(play(flock, 0.5), later)
    assert flock.seconds == seconds


def test_a_change_of_a_parameter_acts_at_once(make_flock: MakeFlock) -> None:
    """Without a jump, on the next step."""
    flock = make_flock(school=200)
    play(flock, 1.0)
    kept = flock.snapshot()
    plain = play(flock, DT)
    for name, value in {"separation": 4.0, "alignment": 0.0, "cohesion": 4.0, "perception": 3.0, "personal_space": 0.2,
                        "wander": 4.0, "speed": (2.0, 3.0), "agility": 0.2, "turn": 90.0, "tail_beat_hz": 5.0,
                        "bank": 60.0}.items():
        before = flock.params.get(name)
        flock.restore(kept)
        flock.params.set(name, value)
        changed = play(flock, DT)
        flock.params.set(name, before)
        assert not np.array_equal(changed, plain), name
        assert np.abs(changed - plain)[:, PLACE].max() < 0.05, name


def test_a_step_makes_nothing_on_the_gpu(make_flock: MakeFlock, monkeypatch: pytest.MonkeyPatch) -> None:
    """All objects are there from the beginning."""
    flock = make_flock(school=300)
    play(flock, 2 * DT)
    made: list[str] = []

    def counting(kind: str, maker: Any) -> Any:
        @wraps(maker)
        def make(*arguments: Any, **named: Any) -> Any:
            made.append(kind)
            return maker(*arguments, **named)
        return make

    for kind in MAKERS:
        monkeypatch.setattr(moderngl.Context, kind, counting(kind, getattr(moderngl.Context, kind)))
    play(flock, 10 * DT)
    assert not made


def test_a_school_in_one_spot_still_steps_and_comes_apart(make_flock: MakeFlock) -> None:
    """Where they cannot all be looked at, some stand for all."""
    flock = make_flock(school=3000)
    state = flock.state.copy()
    state[:, PLACE] *= 0.02
    flock.state = state
    before = nearest(state).mean()
    after = play(flock, 1.0)
    assert np.isfinite(after).all()
    assert nearest(after).mean() > 1.5 * before


def test_the_hero_alone_has_no_school(make_flock: MakeFlock) -> None:
    """A school of one stands still."""
    flock = make_flock(school=1)
    before = flock.state.copy()
    np.testing.assert_array_equal(play(flock, 0.2), before)


@pytest.mark.parametrize(("species", "of"), [(0, 1), (0, 4), (3, 4), (2, 3)])
def test_shaders_find_each_fish_of_a_species(make_flock: MakeFlock, species: int, of: int) -> None:
    """Its place, its heading, level but for the bank, its size, phase and bend, in the texture of many rows."""
    count = 5 * FISH_IN_ROW + 3
    flock = make_flock(school=count)
    state = play(flock, 0.3)[species::of]
    program = flock.gpu.program("probe.vert")
    assert flock.bind(program, 0, species, of) == len(state) == len(range(species, count, of))
    points = np.random.default_rng(1).uniform(-0.5, 0.5, (len(state), 3)).astype("f4")
    array = flock.gpu.vertex_array(program, [
        (flock.gpu.buffer(np.arange(len(state), dtype="f4")), "1f", "in_fish"),
        (flock.gpu.buffer(points), "3f", "in_point")])
    found = array.capture({"v_place": 3, "v_ahead": 3, "v_up": 3, "v_rest": 4}, len(state))
    velocity = state[:, VELOCITY].astype(np.float64)
    ahead = velocity / np.linalg.norm(velocity, axis=1, keepdims=True)
    right = np.cross(ahead, [0.0, 1.0, 0.0])
    right /= np.linalg.norm(right, axis=1, keepdims=True)
    up = np.cos(state[:, BANK, None]) * np.cross(right, ahead) - np.sin(state[:, BANK, None]) * right
    turn = np.stack([ahead, up, np.cross(ahead, up)], axis=2)
    np.testing.assert_allclose(found["v_ahead"], ahead, atol=1e-6)
    np.testing.assert_allclose(found["v_up"], up, atol=1e-6)
    assert (found["v_up"][:, 1] > 0.4).all()
    placed = state[:, PLACE] + state[:, SIZE, None] * np.einsum("nij,nj->ni", turn, points)
    np.testing.assert_allclose(found["v_place"], placed, atol=1e-5)
    wanted = np.stack([state[:, SIZE], state[:, PHASE], state[:, BEND], np.ones(len(state))], axis=1)
    np.testing.assert_allclose(found["v_rest"], wanted, atol=1e-5)


def test_what_is_exported_is_what_swims(make_flock: MakeFlock) -> None:
    """By name, each array of its own."""
    flock = make_flock(school=50)
    state = play(flock, 0.2)
    arrays = flock.arrays()
    np.testing.assert_array_equal(arrays["position"], state[:, PLACE])
    np.testing.assert_array_equal(arrays["velocity"], state[:, VELOCITY])
    assert {name: array.shape for name, array in arrays.items()} == {
        "position": (50, 3), "velocity": (50, 3), **dict.fromkeys(("size", "phase", "bend", "bank"), (50,))}
    assert 0.8 <= arrays["size"].min() < arrays["size"].max() <= 1.1


def test_numbers_are_packed_to_a_millionth() -> None:
    """Each of three by itself, the ends of their range too; what is beyond counts as the end."""
    numbers = np.random.default_rng(2).uniform(-1.0, 1.0, (500, 3)).astype("f4")
    numbers[:3] = [[1.0, 1.0, 1.0], [-1.0, -1.0, -1.0], [1.0, -1.0, 1.0]]
    first, second = packed(numbers).T
    parts = np.stack([first, first >> 21 | second << 11, second >> 10], axis=1) & 0x1fffff
    np.testing.assert_allclose(parts / 1048575.0 - 1.0, numbers, atol=6e-7)
    np.testing.assert_array_equal(packed(np.float32([[2.0, -3.0, 1.1]])), packed(numbers[2:3]))
