"""Trails and strands, against closed forms and against the particles' own paths."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tests.conftest import MakeStage
from viewer.engine.clock import FRAME_SECONDS
from viewer.engine.particles.strands import Strands
from viewer.engine.particles.trails import Trails, trail_bytes
from viewer.engine.stage import Stage

SCENE = '''
from viewer import LookParameters, Scene, curve, gradient, slider
from viewer.engine.particles.strands import Strands
from viewer.engine.particles.system import ParticleParameters, ParticleSystem
from viewer.engine.particles.trails import TrailParameters, Trails, trail_bytes


class Look(LookParameters):
    color = gradient("#ffffff", "Colour")
    size_over_life = curve("1", 0.0, 4.0, "Size")
    opacity_over_life = curve("1", 0.0, 1.0, "Opacity")
    opacity = slider(1.0, 0.0, 1.0, "Opacity")
    glow = slider(1.0, 0.0, 9.0, "Glow")


class Tress(Scene):
    """Trails and strands."""

    class Params(ParticleParameters, TrailParameters, Look):
        pass

    def __init__(self, gpu, params):
        self.system = ParticleSystem(gpu, params, trail_bytes(params))
        self.trails = Trails(gpu, self.system, params)
        self.system.companions.append(self.trails)
        self.system.holds_still = params.strands
        self.strands = Strands(gpu, self.system, params) if params.strands else None
        self.system.begin()

    def update(self, dt):
        self.system.update()

    def prepare(self):
        self.system.prepare()
        if self.system.at_beginning:
            self.system.begin()
        if self.strands:
            self.strands.prepare(self.view)

    def steered_by(self):
        return self.system.steered_by(), self.trails.noting

    def snapshot(self):
        return self.system.snapshot()

    def restore(self, snapshot):
        self.system.restore(snapshot)

    def draw(self):
        if self.strands:
            self.strands.draw()

    def draw_sprites(self, scene_depth):
        if not self.strands:
            self.trails.draw()
'''
FREE = {"ground": False, "children_when": "never", "rate": 0.0, "spread": 40.0, "trail_length": 20.0, "count": 300}
MakeTress = Callable[..., Stage]


@pytest.fixture
def tress(make_stage: MakeStage) -> MakeTress:
    def make(frame: int = 0, *, seed: int = 3, picture: tuple[int, int] = (96, 64), **params: object) -> Stage:
        stage = make_stage(SCENE, name="tress", size=picture, params={**FREE, **params}, seed=seed)
        stage.seek(frame)
        return stage

    return make


def trails_of(stage: Stage) -> Trails:
    stage.pixels()          # draws them, and so finds where they end
    trails: Trails = stage.scene.trails
    return trails


def strands_of(stage: Stage) -> Strands:
    strands: Strands = stage.scene.strands
    return strands


def reach_of(trails: Trails) -> list[NDArray[np.float32]]:
    """``end`` and ``reach`` of each used slot, (used, 4)."""
    assert trails._drawing
    pool, target = trails.system.pool, trails._drawing.reach.target
    return [np.frombuffer(target.read((0, 0, pool.width, pool.rows), 4, attachment=which, alignment=1, dtype="f4"),
                          np.float32).reshape(-1, 4)[:pool.used] for which in range(2)]


def points_of(stage: Stage) -> list[NDArray[np.float32]]:
    """The points of each trail, newest first, as the picture has them: (points, 3) for each used slot."""
    trails = trails_of(stage)
    pool, ring = trails.system.pool, trails.paths.points
    notes = trails.paths.read(ring)[:-1, :pool.used, :3]
    motion, (ends, _) = pool.read("motion")["motion"], reach_of(trails)
    order = [(trails.notes - 1 - back) % ring for back in range(ring)]
    return [np.vstack([motion[slot, :3], notes[order[:int(ends[slot, 3])], slot], ends[slot, :3]])
            for slot in range(pool.used)]


def length_of(points: NDArray[np.float32]) -> float:
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def test_a_trail_in_free_flight_lies_on_the_parabola(tress: MakeTress) -> None:
    stage = tress(40, burst=50, lifetime="5..5", trail_seconds=1.0, trail_points=20)
    pool = stage.scene.system.pool
    texels = pool.read("origin", "launch")
    seconds = 40 * FRAME_SECONDS
    for slot, points in enumerate(points_of(stage)):
        start, launch = texels["origin"][slot, :3], texels["launch"][slot, :3]
        across = int(np.abs(launch[[0, 2]]).argmax()) * 2
        times = (points[:, across] - start[across]) / launch[across]
        assert times[0] == pytest.approx(seconds, abs=1e-4) and times[-1] == pytest.approx(0.0, abs=1e-4)
        assert np.all(np.diff(times) <= 1e-6)
        expected = start + times[:, None] * launch - 0.5 * 9.81 * times[:, None]**2 * [0.0, 1.0, 0.0]
        assert np.abs(points - expected).max() < 2e-4


def test_a_trail_ends_where_it_is_long_enough(tress: MakeTress) -> None:
    stage = tress(60, burst=50, lifetime="5..5", trail_length=1.3, trail_seconds=2.0, trail_points=40)
    found = points_of(stage)
    _, reach = reach_of(trails_of(stage))
    assert [length_of(points) for points in found] == pytest.approx([1.3] * 50, abs=1e-4)
    assert reach[:, 1] == pytest.approx(1.3, abs=1e-4)


def test_a_trail_ends_where_memory_does(tress: MakeTress) -> None:
    stage = tress(77, burst=20, lifetime="5..5", gravity=0.0, speed="2..2", trail_seconds=0.7, trail_points=9)
    assert [length_of(points) for points in points_of(stage)] == pytest.approx([2.0 * 0.7] * 20, rel=1e-3)


def test_a_short_life_so_far_reaches_back_to_its_birthplace(tress: MakeTress) -> None:
    stage = tress(25, rate=137.0, lifetime="5..5", emitter="sphere", trail_seconds=3.0)
    origin = stage.scene.system.pool.read("origin")["origin"][:, :3]
    ends = np.array([points[-1] for points in points_of(stage)])
    assert len(ends) == 57 and np.abs(ends - origin).max() < 1e-6


def test_who_comes_into_a_slot_has_no_part_in_the_life_before(tress: MakeTress) -> None:
    stage = tress(200, rate=300.0, count=60, lifetime="0.1..0.2", emitter="ground", emitter_size=20.0,
                  trail_seconds=2.0, trail_points=60)
    system = stage.scene.system
    assert system.tally.died > 500
    texels = system.pool.read("motion", "nature", "launch")
    age = texels["nature"][:, 0] - texels["motion"][:, 3]
    fastest = np.linalg.norm(texels["launch"][:, :3], axis=1) + 9.81 * 0.2
    living = texels["motion"][:, 3] > 0.0
    lengths = np.array([length_of(points) for points in points_of(stage)])
    assert living.sum() > 20 and np.all(lengths[living] <= fastest[living] * age[living] + 1e-4)


def test_trails_follow_a_bounce(tress: MakeTress) -> None:
    stage = tress(48, ground=True, burst=1, speed="0..0", emitter_height=1.0, restitution=0.8, lifetime="9..9",
                  trail_seconds=1.5, trail_points=64, friction=0.0)
    points, = points_of(stage)
    assert points[:, 1].min() < 0.2 and points[0, 1] > 0.3 and points[-1, 1] == pytest.approx(1.0, abs=1e-4)


def test_the_trail_of_what_rests_shrinks_away(tress: MakeTress) -> None:
    stage = tress(150, ground=True, burst=30, collision="stick", lifetime="9..9", speed="1..2", trail_seconds=0.5)
    trails = trails_of(stage)
    _, reach = reach_of(trails)
    assert np.all(reach[:, 1] < 1e-6) and np.all(reach[:, 2] == 0.0)
    empty = tress(0, burst=0)
    assert np.array_equal(stage.pixels(), empty.pixels())


def test_all_that_is_remembered_comes_back_to_the_byte(tress: MakeTress) -> None:
    stage = tress(50, rate=200.0, lifetime="0.3..0.6")
    system, trails = stage.scene.system, stage.scene.trails
    kept = system.snapshot()
    notes, picture = trails.notes, stage.pixels()
    stage.seek(83)
    assert not np.array_equal(stage.pixels(), picture)
    system.restore(kept)
    again = system.snapshot()
    assert trails.notes == notes and again.companions[0].notes == notes
    assert again.companions[0].texels.tobytes() == kept.companions[0].texels.tobytes()
    assert kept.companions[0].nbytes == 16 * system.pool.width * system.pool.rows * (len(kept.companions[0].texels))


@pytest.mark.parametrize("params", [{"blending": "additive"}, {"blending": "alpha", "emitter": "sphere"},
                                    {"collision": "stick", "ground": True}])
def test_going_back_shows_the_same_picture(tress: MakeTress, params: dict[str, Any]) -> None:
    straight = tress(45, rate=200.0, lifetime="0.3..0.6", **params).pixels()
    stage = tress(70, rate=200.0, lifetime="0.3..0.6", **params)
    stage.pixels()
    stage.seek(45)
    assert np.array_equal(stage.pixels(), straight)
    assert straight.std() > 1.0


def test_trails_that_are_turned_on_midway_begin_there(tress: MakeTress) -> None:
    stage = tress(30, burst=10, lifetime="5..5", trail_length=0.0, speed="2..2", gravity=0.0)
    assert stage.scene.trails._paths is None
    stage.set(trail_length=10.0)
    stage.seek(48)
    lengths = [length_of(points) for points in points_of(stage)]
    assert max(lengths) <= 2.0 * 18 * FRAME_SECONDS + 1e-4 and min(lengths) > 2.0 * 12 * FRAME_SECONDS


@pytest.mark.parametrize("pose", [{"distance": 0.01}, {"pitch": 89.0}, {"distance": 0.3, "target": (0.0, 0.5, 0.0)}])
def test_no_picture_breaks_where_the_eye_is_among_them(tress: MakeTress, pose: dict[str, Any]) -> None:
    stage = tress(40, rate=200.0, spread=180.0, trail_width=4.0, picture=(64, 48))
    for name, value in pose.items():
        stage.camera.stand({name: value})
    trails = trails_of(stage)
    assert trails._drawing
    for attachment in range(3):
        seen = np.frombuffer(trails._drawing._ribbons._making.read(components=4, attachment=attachment, dtype="f4"),
                             np.float32)
        assert np.isfinite(seen).all()


def strand_points(stage: Stage) -> NDArray[np.float32]:
    """The points of all strands, root first: (points, used, 4), the way from the root last."""
    stage.geometry()        # prepares
    strands = strands_of(stage)
    return strands.paths.read(strands.points)[:-1, :strands.pool.used]


STRANDS = {"strands": True, "trail_length": 0.0, "emitter": "sphere", "burst": 60, "lifetime": "0.5..0.5",
           "speed": "1..3", "drag": "0.5..1.5", "wind": 2.0}


@pytest.mark.parametrize("forces", [{}, {"ground": True, "emitter_height": 0.6, "collision": "stick", "wind": 0.0}])
def test_a_strand_is_the_path_of_its_particle(tress: MakeTress, forces: dict[str, Any]) -> None:
    strands = strand_points(tress(0, **{**STRANDS, "strand_points": 7, **forces}))
    moving = tress(0, **{**STRANDS, "strands": False, **forces})
    pool = moving.scene.system.pool
    for point in range(7):
        moving.seek(5 * point)
        alive = pool.read("motion")["motion"]
        assert np.abs(strands[point, :, :3] - alive[:60, :3]).max() < (2e-3 if forces else 2e-5)
    way = np.linalg.norm(np.diff(strands[..., :3], axis=0), axis=2).cumsum(axis=0)
    assert strands[1:, :, 3] == pytest.approx(way, abs=1e-5) and np.all(strands[0, :, 3] == 0.0)


def test_gusts_move_strands_and_still_air_costs_nothing(tress: MakeTress) -> None:
    still = tress(0, **STRANDS)
    before, grown = strand_points(still), strands_of(still).passes
    still.seek(20)
    assert np.array_equal(strand_points(still), before) and strands_of(still).passes == grown
    windy = tress(0, **STRANDS, gusts=0.8)
    before = strand_points(windy)
    windy.seek(20)
    after = strand_points(windy)
    assert np.array_equal(before[0], after[0]) and np.abs(after[-1] - before[-1]).max() > 0.01


def test_strands_follow_a_parameter(tress: MakeTress) -> None:
    stage = tress(0, **STRANDS)
    before = strand_points(stage)
    stage.set(gravity=-5.0)
    assert np.all(strand_points(stage)[-1, :, 1] > before[-1, :, 1])


def test_strands_are_the_same_each_time_and_at_each_frame(tress: MakeTress) -> None:
    one, two = (tress(12, **STRANDS, gusts=0.5, turbulence=1.0) for _ in range(2))
    picture = one.pixels()
    assert np.array_equal(picture, two.pixels()) and picture.std() > 1.0
    two.seek(30)
    two.pixels()
    two.seek(12)
    assert np.array_equal(two.pixels(), picture)
    assert not np.array_equal(tress(12, seed=4, **STRANDS, gusts=0.5, turbulence=1.0).pixels(), picture)


def test_strands_cast_a_shadow_and_hide_what_is_behind(tress: MakeTress) -> None:
    many = {**STRANDS, "emitter_height": 1.0, "burst": 300, "size": "0.05..0.05", "lifetime": "0.1..0.1"}
    empty = tress(0, **{**many, "burst": 0}).pixels()[..., :3].astype(int)
    hairy = tress(0, **many).pixels()[..., :3].astype(int)
    darker = (empty - hairy).mean(axis=2) > 4.0
    assert np.abs(hairy - empty).max() > 40 and darker.mean() > 0.01


def test_a_ribbon_is_as_wide_as_told_wherever_it_turns(tress: MakeTress) -> None:
    stage = tress(40, rate=60.0, lifetime="5..5", spread=180.0, size="0.3..0.3", trail_width=0.5, trail_taper=0.0,
                  trail_length=2.0, gravity=0.0, size_over_life="1")
    trails = trails_of(stage)
    assert trails._drawing
    middle, side = (np.frombuffer(trails._drawing._ribbons._making.read(components=4, attachment=which, dtype="f4"),
                                  np.float32).reshape(-1, 4) for which in range(2))
    whole = side[:, 2] > 0.0
    projection = stage.camera.projection(96 / 64)
    across = np.hypot(side[whole, 0] / projection[0, 0], side[whole, 1] / projection[1, 1])
    _, reach = reach_of(trails)
    assert np.median(reach[:, 2]) == pytest.approx(0.5 * 0.5 * 0.3)
    near = middle[whole, 3] > 0.075 / 0.05
    assert near.sum() > 100 and np.allclose(across[near & (across > 0.07)], 0.075, rtol=2e-3)


def test_memory_is_told_beforehand(tress: MakeTress) -> None:
    stage = tress(0, trail_length=0.0)
    assert trail_bytes(stage.params) == 0
    stage.set(trail_length=1.0)
    assert trail_bytes(stage.params) >= 16 * stage.params.trail_points
    assert trail_bytes(tress(0, **STRANDS).params) >= 16 * 12
