"""Obstacles that are thin, far away, in the way, or moved: nobody passes, nobody is held up, nobody is caught."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pytest

from tests.scenes.particle_stage import played, stage_of_particles

UPWARD: dict[str, Any] = {"rate": 4000.0, "gravity": 0.0, "spread": 10.0, "lifetime": (2.0, 2.0)}
PLATE: dict[str, Any] = {"obstacle": "box", "obstacle_size": 20.0, "obstacle_thickness": 0.01, "obstacle_y": 1.0}


@pytest.fixture
def sheet(tmp_path: Path) -> Path:
    """A square of six metres, open: without an inside."""
    path = tmp_path / "sheet.obj"
    path.write_text("v -3 0 -3\nv 3 0 -3\nv 3 0 3\nv -3 0 3\nf 1 3 2\nf 1 4 3\n", "utf-8")
    return path


@pytest.mark.parametrize("speed", [20.0, 100.0, 200.0])
def test_nobody_passes_a_sheet_that_was_there_from_the_start(context: moderngl.Context, sheet: Path,
                                                             speed: float) -> None:
    """A fresh stage: how thin the mesh is has to be known before the first step."""
    values = {**UPWARD, "speed": speed, "obstacle": "mesh", "obstacle_file": str(sheet), "obstacle_y": 1.0}
    with stage_of_particles(**values) as stage:
        high = played(stage, 30)["position"][:, 1]
    assert len(high) > 1500 and high.max() < 1.1


@pytest.mark.parametrize(("speed", "restitution"), [(100.0, 0.9), (200.0, 0.9), (200.0, 1.0)])
def test_nobody_passes_on_the_way_off_the_ground(context: moderngl.Context, speed: float, restitution: float) -> None:
    """Between the ground and a thin plate there and back many times in each step."""
    values = {**UPWARD, **PLATE, "ground": True, "speed": speed, "restitution": restitution}
    with stage_of_particles(**values) as stage:
        high = played(stage, 30)["position"][:, 1]
    assert len(high) > 1500 and high.max() < 1.0 and high.min() > 0.0


@pytest.mark.parametrize("speed", [50.0, 200.0])
@pytest.mark.parametrize(("height", "plate"), [(0.005, 15.0), (0.53, 0.5)])
def test_nobody_is_held_up_along_a_surface(context: moderngl.Context, speed: float, height: float,
                                           plate: float) -> None:
    """Flight just above the ground, and just above a thin plate, goes as far as the speed says."""
    values = {**PLATE, "obstacle_y": plate, "ground": True, "emitter_height": height, "emitter_tilt": 90.0,
              "speed": speed, "gravity": 0.0, "burst": 1}
    with stage_of_particles(**values) as stage:
        for frame in (1, 5):
            assert played(stage, frame)["position"][0, 0] == pytest.approx(speed * frame / 60.0, rel=1e-5)


def test_a_change_that_moves_nothing_changes_nothing(context: moderngl.Context, sheet: Path) -> None:
    values = {**UPWARD, "speed": 40.0, "obstacle": "mesh", "obstacle_file": str(sheet), "obstacle_y": 1.0}
    with stage_of_particles(**values) as stage:
        before = played(stage, 20)["position"]
        stage.set(opacity=0.5)
        stage.seek(0)
        assert np.array_equal(played(stage, 20)["position"], before)


@pytest.mark.parametrize(("before", "after"), [
    ({"obstacle_size": 0.3}, {"obstacle_size": 1.2}), ({"obstacle_x": 2.0}, {"obstacle_x": 0.1}),
    ({"obstacle_size": 0.7}, {"obstacle_size": 1.5, "hollow": True}), ({}, {"ground_height": 0.6})])
def test_who_is_overrun_gets_out_or_dies(context: moderngl.Context, before: dict[str, Any],
                                         after: dict[str, Any]) -> None:
    """A ball that grows or moves into a cloud, between it and the ground: nobody hangs inside, none are lost."""
    values = {"rate": 3000.0, "speed": (0.0, 4.0), "spread": 180.0, "emitter_height": 2.5, "ground": True,
              "lifetime": (3.0, 3.0), "obstacle": "sphere", "obstacle_y": 0.8, "gravity": 9.81, **before}
    with stage_of_particles(**values) as stage:
        stage.seek(60)
        stage.set(**after)
        for frame in (61, 75):
            now = played(stage, frame)
            p, place = stage.params, now["position"].astype(float)
            ball = np.linalg.norm(place - [p.obstacle_x, p.obstacle_y, 0.0], axis=1) - p.obstacle_size
            assert (-ball if p.hollow else ball).min() > -1e-5
            assert (place[:, 1] - p.ground_height).min() > -1e-5
        told = stage.measure()
        assert told["emitted"] + told["children"] == told["alive"] + told["died"]


def test_a_pool_that_is_large_enough_serves_all(context: moderngl.Context) -> None:
    """Who dies in a step makes room in the same step."""
    with stage_of_particles(count=1000, rate=1000.0, lifetime=0.98, gravity=0.0) as stage:
        stage.seek(200)
        assert stage.measure()["emitted"] == 3333
        assert not stage.remarks()


def test_a_nozzle_inside_an_obstacle_is_told(context: moderngl.Context) -> None:
    with stage_of_particles(rate=500.0, obstacle="box", obstacle_y=0.2, obstacle_size=2.0, obstacle_thickness=0.2,
                            ground=True) as stage:
        stage.seek(20)
        assert stage.measure()["alive"] == 0
        assert "All are born inside the obstacle or the ground" in stage.remarks()[0]
