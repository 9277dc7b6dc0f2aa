"""Going back in time: which moments are kept, and that what is seen there is what playing from 0 shows."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

from tests import packs
from tests.conftest import MakeStage
from viewer.engine.rewind import BYTES_PER_FRAME, SHORTEST_STRIDE, Rewind
from viewer.engine.scene import Geometry, SceneError
from viewer.engine.stage import Stage

MIB = 2**20
NUMBERS = ("alive", "emitted", "died", "collisions", "children", "kinetic_energy", "potential_energy", "fastest")
# A walk of which moments can be kept; what it does is counted.
KEPT_WALK = packs.WALK.replace("    def draw(self):", '''    def steered_by(self):
        return self.params.stride

    def snapshot(self):
        self.kept = getattr(self, "kept", 0) + 1
        return np.array([self.place, self.steps]), self.random.bit_generator.state

    def restore(self, snapshot):
        (self.place, steps), self.random.bit_generator.state = snapshot
        self.steps = int(steps)

    def draw(self):''')
SIZED = '''
class Kept(tuple):
    nbytes = 100

'''
SIZED_WALK = KEPT_WALK.replace("class Walk", f"{SIZED.strip()}\n\nclass Walk").replace(
    "return np.array([self.place, self.steps]), self.random.bit_generator.state",
    "return Kept((np.array([self.place, self.steps]), self.random.bit_generator.state))")
PARTICLES: dict[str, object] = {
    "count": 3000, "rate": 400.0, "lifetime": (0.3, 0.9), "speed": (2.0, 4.0), "spread": 40.0,
    "turbulence": 1.0, "children_when": "death", "children": (1.0, 3.0), "grandchildren_when": "life",
    "grandchildren": (3.0, 9.0), "obstacle": "sphere", "obstacle_y": 0.6, "obstacle_size": 0.3}


@dataclass(frozen=True)
class Moment:
    """A snapshot of a certain size."""

    nbytes: int
    frame: int = 0


def filled(frames: int, size: Callable[[int], int], most_bytes: int = 1000, key: Hashable = "a") -> Rewind:
    """What is kept after playing so many frames, as a stage does."""
    rewind = Rewind(most_bytes)
    rewind.begin(key)
    for frame in range(frames + 1):
        if rewind.is_due(frame, key):
            rewind.keep(frame, Moment(size(frame), frame))
    return rewind


def kept(rewind: Rewind, last: int, key: Hashable = "a") -> list[int]:
    """The frames that are kept, found by asking for each."""
    return sorted({found[0] for frame in range(last + 1) if (found := rewind.before(frame, key))})


def test_nothing_is_found_where_nothing_is_kept() -> None:
    assert Rewind().before(100, None) is None
    assert Rewind().before(100, "a") is None
    assert Rewind().nbytes == 0


def test_small_moments_are_kept_every_few_frames() -> None:
    rewind = filled(200, lambda frame: 1)
    assert kept(rewind, 200) == list(range(0, 201, SHORTEST_STRIDE))
    assert rewind.nbytes == 13


def test_the_last_one_not_after_a_frame_is_found() -> None:
    rewind = filled(100, lambda frame: 1)
    for frame in range(101):
        assert rewind.before(frame, "a") == (frame // 16 * 16, Moment(1, frame // 16 * 16))


@pytest.mark.parametrize("size", [1, 7, 90, 99, 100, 101, 333, 500, 501, 999])
def test_they_thin_out_evenly_within_the_budget(size: int) -> None:
    """Always within it, always evenly spaced by a power of two, and not fewer than need be."""
    rewind = Rewind(1000)
    rewind.begin("a")
    for frame in range(4001):
        if rewind.is_due(frame, "a"):
            rewind.keep(frame, Moment(size, frame))
        assert rewind.nbytes <= 1000
    frames = kept(rewind, 4000)
    assert frames[0] == 0
    strides = {after - before for before, after in pairwise(frames)}
    assert len(strides) <= 1
    assert all(np.log2(stride / SHORTEST_STRIDE).is_integer() for stride in strides)
    assert rewind.nbytes > 250 or size > 500 or size * 251 <= 1000


def test_growing_moments_stay_within_the_budget() -> None:
    for most in (300, 1000, 5000):
        rewind = filled(4000, lambda frame: 1 + frame // 16, most)
        assert rewind.nbytes <= most
        assert kept(rewind, 4000)[0] == 0


def test_one_that_is_larger_than_the_budget_is_not_kept_but_the_beginning_is() -> None:
    rewind = filled(100, lambda frame: 5000 if frame else 10)
    assert kept(rewind, 100) == [0]
    assert rewind.nbytes == 10


def test_large_moments_are_taken_rarely() -> None:
    """Copying much costs time: 100 MiB not oftener than every 100 frames."""
    rewind = filled(2000, lambda frame: 100 * MIB, 10**12)
    distances = np.diff(kept(rewind, 2000))
    assert (distances * BYTES_PER_FRAME >= 100 * MIB).all()
    assert distances.max() <= 256


def test_another_key_finds_nothing_and_keeps_nothing() -> None:
    rewind = filled(100, lambda frame: 1)
    assert rewind.before(50, "b") is None
    assert not rewind.is_due(112, "b")


def test_to_begin_alike_keeps_what_is_kept_and_otherwise_forgets() -> None:
    rewind = filled(100, lambda frame: 1)
    rewind.begin("a")
    assert kept(rewind, 100) == [0, 16, 32, 48, 64, 80, 96]
    rewind.begin("b")
    assert rewind.before(100, "a") is None
    assert rewind.before(100, "b") is None
    assert rewind.is_due(0, "b")


def test_what_was_steered_otherwise_in_between_is_not_kept() -> None:
    """Back at the former key, moments that the other one has shaped are none of its own."""
    rewind = filled(40, lambda frame: 1)
    assert not any(rewind.is_due(frame, "b") for frame in range(41, 60))
    assert not any(rewind.is_due(frame, "a") for frame in range(60, 100))
    found = rewind.before(99, "a")
    assert found == (32, Moment(1, 32))
    assert rewind.is_due(48, "a")       # played on from there, moments are its own again


def test_to_forget_frees_everything() -> None:
    rewind = filled(100, lambda frame: 1)
    rewind.forget()
    assert rewind.nbytes == 0
    assert rewind.before(50, "a") is None


# In a stage


def same(one: Mapping[str, NDArray[np.generic]], other: Mapping[str, NDArray[np.generic]]) -> None:
    """Equal to the byte."""
    assert one.keys() == other.keys()
    for name in one:
        assert one[name].dtype == other[name].dtype and one[name].shape == other[name].shape
        assert one[name].tobytes() == other[name].tobytes(), name


def shown(stage: Stage) -> tuple[Geometry, dict[str, object], NDArray[np.uint8]]:
    measured = stage.measure()
    return stage.geometry(), {name: measured[name] for name in NUMBERS}, stage.pixels()


def agree(stage: Stage, other: Stage) -> None:
    """Arrays, numbers and pictures are the same."""
    (geometry, numbers, picture), (geometry2, numbers2, picture2) = shown(stage), shown(other)
    same(geometry, geometry2)
    assert numbers == numbers2
    np.testing.assert_array_equal(picture, picture2)


@pytest.fixture
def particles(make_stage: MakeStage) -> Callable[..., Stage]:
    def make(**values: object) -> Stage:
        return make_stage("", name="particle_fountain", params={**PARTICLES, **values}, seed=5)

    return make


@pytest.fixture
def played(particles: Callable[..., Stage]) -> Callable[..., Stage]:
    """A stage that has been played to a frame and never sought back."""

    def play(frame: int, **values: object) -> Stage:
        stage = particles(**values)
        stage.seek(frame)
        return stage

    return play


def test_back_is_where_playing_from_0_gets(particles: Callable[..., Stage], played: Callable[..., Stage]) -> None:
    stage = particles()
    for frame in (40, 31, 32, 0, 16, 35):
        stage.seek(frame)
        agree(stage, played(frame))


def test_one_step_back_and_forth_at_every_frame(particles: Callable[..., Stage]) -> None:
    stage, seen = particles(), []
    for frame in range(50):
        stage.seek(frame)
        seen.append(stage.geometry())
    for frame in range(49, 0, -1):
        stage.step(-1)
        assert stage.frame == frame - 1
        same(stage.geometry(), seen[frame - 1])


def test_back_after_a_change_midway_is_as_if_it_had_always_been_so(particles: Callable[..., Stage],
                                                                   played: Callable[..., Stage]) -> None:
    stage = particles()
    stage.seek(60)
    stage.set(gravity=-3.0, turbulence=0.0)
    stage.seek(75)
    stage.seek(40)
    agree(stage, played(40, gravity=-3.0, turbulence=0.0))


def test_a_change_that_was_taken_back_leaves_no_trace(particles: Callable[..., Stage],
                                                      played: Callable[..., Stage]) -> None:
    """The frames from before and after it are shown as the present values have them."""
    stage = particles()
    stage.seek(30)
    stage.set(gravity=-20.0)
    stage.seek(45)
    stage.set(gravity=9.81)
    stage.seek(90)
    stage.seek(85)
    agree(stage, played(85))
    stage.seek(31)
    agree(stage, played(31))
    stage.seek(90)
    agree(stage, played(90))


def test_back_to_frame_0_after_a_change_there(particles: Callable[..., Stage],
                                              played: Callable[..., Stage]) -> None:
    stage = particles(burst=200)
    stage.seek(40)
    stage.seek(0)
    stage.set(burst=77, speed=(1.0, 1.5))
    agree(stage, played(0, burst=77, speed=(1.0, 1.5)))
    stage.seek(40)
    agree(stage, played(40, burst=77, speed=(1.0, 1.5)))
    stage.seek(0)
    agree(stage, played(0, burst=77, speed=(1.0, 1.5)))


def test_back_after_the_stage_was_built_anew(particles: Callable[..., Stage], played: Callable[..., Stage]) -> None:
    stage = particles()
    stage.seek(50)
    stage.set(count=500)
    agree(stage, played(50, count=500))
    stage.seek(33)
    agree(stage, played(33, count=500))
    stage.rebuild()
    stage.reload_scene()
    stage.seek(20)
    agree(stage, played(20, count=500))


def test_back_where_the_pool_has_grown_since(particles: Callable[..., Stage], played: Callable[..., Stage]) -> None:
    """Slots that were not in use then hold nothing afterwards."""
    stage = particles(rate=100.0, burst_every=0.5, burst=1000, children_when="never", count=2500)
    stage.seek(100)
    stage.seek(10)
    agree(stage, played(10, rate=100.0, burst_every=0.5, burst=1000, children_when="never", count=2500))
    stage.seek(100)
    agree(stage, played(100, rate=100.0, burst_every=0.5, burst=1000, children_when="never", count=2500))


def test_back_with_a_warm_up(particles: Callable[..., Stage], played: Callable[..., Stage]) -> None:
    stage = particles(warm_up=0.7)
    assert stage.measure()["alive"] > 100
    stage.seek(40)
    stage.seek(0)
    agree(stage, played(0, warm_up=0.7))
    stage.seek(21)
    agree(stage, played(21, warm_up=0.7))


def test_a_warm_up_moves_time_along(played: Callable[..., Stage]) -> None:
    """Without what depends on the hour, frame 0 after half a second is frame 30."""
    still = {"turbulence": 0.0, "gusts": 0.0}
    same(played(0, warm_up=0.5, **still).geometry(), played(30, **still).geometry())
    same(played(12, warm_up=0.5, **still).geometry(), played(42, **still).geometry())


def test_the_colours_alone_do_not_steer(particles: Callable[..., Stage]) -> None:
    """Changing how it looks keeps every moment that was kept."""
    stage = particles()
    before = stage.scene.steered_by()
    stage.set(children_color="0:#ff0000, 1:#00ff00", spin=(0.0, 90.0))
    assert stage.scene.steered_by() == before
    for change in ({"gravity": 3.0}, {"rate": 10.0}, {"obstacle_x": 0.5}, {"children_inherit": 0.9},
                   {"emitter_size": 0.7}, {"lifetime": (1.0, 2.0)}):
        before = stage.scene.steered_by()
        stage.set(**change)
        assert stage.scene.steered_by() != before, change


def test_a_scene_that_keeps_nothing_is_played_again(make_stage: MakeStage) -> None:
    stage, other = make_stage(packs.WALK, seed=3), make_stage(packs.WALK, seed=3)
    stage.seek(100)
    stage.seek(37)
    other.seek(37)
    np.testing.assert_array_equal(stage.pixels(), other.pixels())


def test_a_scene_that_keeps_moments_is_not_played_again(make_stage: MakeStage) -> None:
    stage, other = make_stage(SIZED_WALK, seed=3), make_stage(packs.WALK, seed=3)
    stage.seek(100)
    scene = stage.scene
    assert scene.kept == 7      # type: ignore[attr-defined]
    for frame in (37, 99, 0, 64, 100, 12):
        stage.seek(frame)
        other.seek(frame)
        assert stage.scene is scene
        assert scene.place == other.scene.place     # type: ignore[attr-defined]
    assert scene.kept == 7      # type: ignore[attr-defined]


@pytest.mark.parametrize("frame", [0, 16])
def test_a_snapshot_that_fails_says_so_and_the_scene_goes_on(make_stage: MakeStage, frame: int) -> None:
    source = SIZED_WALK.replace("        self.kept =", f"        if self.steps == {frame}:\n"
                                '            raise ValueError("no paper left")\n        self.kept =')
    stage, other = make_stage(source, seed=3), make_stage(packs.WALK, seed=3)
    with pytest.raises(SceneError, match=r"failed in snapshot.*no paper left"):
        stage.seek(40)
    assert stage.frame == frame
    other.seek(frame)
    np.testing.assert_array_equal(stage.pixels(), other.pixels())
    if frame:
        stage.seek(40)
        with pytest.raises(SceneError, match="no paper left"):
            stage.seek(20)      # on the way from frame 0
        stage.seek(20)
        other.seek(20)
        assert stage.scene.place == other.scene.place       # type: ignore[attr-defined]


def test_a_restore_that_fails_says_so_and_leaves_a_scene_that_draws(make_stage: MakeStage) -> None:
    source = SIZED_WALK.replace("        (self.place, steps)", '        if self.params.height > 3.0:\n'
                                '            raise ValueError("torn")\n        (self.place, steps)').replace(
        "        breaks_at:", '        height: float = slider(2.0, 0.0, 5.0, "Whether it is torn")\n        breaks_at:')
    stage, other = make_stage(source, seed=3), make_stage(packs.WALK, seed=3)
    stage.seek(40)
    stage.set(height=4.0)
    with pytest.raises(SceneError, match=r"failed in restore.*torn"):
        stage.seek(20)
    assert stage.frame == 40
    other.seek(40)
    np.testing.assert_array_equal(stage.pixels(), other.pixels())
    stage.set(height=2.0)
    stage.seek(20)
    other.seek(20)
    assert stage.scene.place == other.scene.place       # type: ignore[attr-defined]


def test_a_restore_that_fails_halfway_does_not_stay(make_stage: MakeStage) -> None:
    """Rather than show what is half one moment and half another, the scene is built anew where it stood."""
    source = SIZED_WALK.replace("        self.steps = int(steps)", '        raise ValueError("torn")')
    stage, other = make_stage(source, seed=3), make_stage(packs.WALK, seed=3)
    stage.seek(40)
    with pytest.raises(SceneError, match="failed in restore"):
        stage.seek(20)
    assert stage.frame == 40
    other.seek(40)
    np.testing.assert_array_equal(stage.pixels(), other.pixels())


def test_what_steers_failing_is_told(make_stage: MakeStage) -> None:
    source = SIZED_WALK.replace("return self.params.stride\n", "return 1 / 0\n")
    with pytest.raises(SceneError, match="steered_by"):
        make_stage(source).seek(5)
