"""The laboratory as a whole: what it shows, tells, exports and measures, and its presets."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import moderngl
import numpy as np
import pytest

import viewer
from viewer.cli import main
from viewer.engine.catalog import Catalog
from viewer.engine.presets import presets_for
from viewer.engine.stage import Stage

ENTRY = Catalog().find("particle_fountain")
PRESETS = {preset.name: preset for preset in presets_for(ENTRY)}
EXPECTED = ("fountain water leaves fog clouds snow dust stars flame fireworks sparks hair fur grass genesis").split()
FEW = {"rate": 400, "count": 4000, "children": "1..2"}


@pytest.fixture
def stage(context: moderngl.Context) -> Iterator[Stage]:
    """A small fountain."""
    with viewer.headless("particle_fountain", size=(160, 90), samples=0, params=FEW) as made:
        yield made


def ink(stage: Stage, **values: object) -> float:
    """How much the picture differs from the one without any particles."""
    stage.set(**values)
    drawn = stage.pixels()[..., :3].astype(int)
    stage.set(opacity=0.0, trail_opacity=0.0)
    empty = stage.pixels()[..., :3].astype(int)
    stage.reset_params("opacity")
    stage.reset_params("trail_opacity")
    return float(np.abs(drawn - empty).mean())


@pytest.mark.parametrize("name", EXPECTED)
def test_there_is_a_preset_for_each_thing_that_particles_make(name: str) -> None:
    preset = PRESETS[name]
    sentences = preset.description.strip().removesuffix(".").split(". ")
    assert len(sentences) == 2, "two sentences"
    assert preset.title


@pytest.mark.parametrize("name", sorted(PRESETS))
def test_a_preset_moves_and_has_room(context: moderngl.Context, name: str) -> None:
    """Every preset fits into its count, shows something, and goes on showing something else."""
    with viewer.headless("particle_fountain", size=(128, 72), samples=0, preset=name) as stage:
        stage.seek(45)
        first = stage.pixels()
        stage.seek(60)
        assert stage.measure()["alive"] > 0
        assert np.abs(stage.pixels().astype(int) - first).max() > 8
        assert not [remark for remark in stage.remarks() if "No room" in remark]
        geometry = stage.geometry()
        assert all(np.isfinite(values).all() for values in geometry.values())


def test_measurements_have_their_names_and_the_curve_its_past(stage: Stage) -> None:
    stage.seek(50)
    told = stage.measure()
    assert {"alive", "emitted", "died", "collisions", "children", "kinetic_energy", "potential_energy", "fastest",
            "step_ms", "draw_ms"} <= set(told)
    live = told["live"].lists()
    assert len(live["alive"]) == 51
    assert live["time"][-1] == pytest.approx(50 / 60)
    assert live["alive"][-1] == told["alive"]
    assert 0.0 < told["draw_ms"] < 10_000.0 and 0.0 < told["step_ms"] < 10_000.0
    geometry = stage.geometry()
    mass, velocity = geometry["mass"].astype(float), geometry["velocity"].astype(float)
    assert told["kinetic_energy"] == pytest.approx(0.5 * (mass * (velocity**2).sum(axis=1)).sum())
    assert told["potential_energy"] == pytest.approx(9.81 * (mass * geometry["position"][:, 1]).sum(), rel=1e-5)
    assert told["fastest"] == pytest.approx(np.linalg.norm(velocity, axis=1).max())


def test_measuring_changes_no_picture(stage: Stage) -> None:
    stage.seek(40)
    before = stage.pixels()
    stage.measure()
    assert np.array_equal(stage.pixels(), before)


def test_a_click_chooses_the_particle_under_it(stage: Stage) -> None:
    """Each particle's own place in the picture, found here by projection, leads back to it."""
    stage.seek(60)
    stage.pixels()
    geometry = stage.geometry()
    width, height = stage.size
    both = stage.camera.view() @ stage.camera.projection(width / height, stage.middle)
    for index in range(0, len(geometry["seed"]), 40):
        clip = np.append(geometry["position"][index].astype(float), 1.0) @ both
        across, up = clip[:2] / clip[3]
        chosen = stage.clicked((across + 1.0) / 2.0 * width, (1.0 - up) / 2.0 * height)
        number = int(str(chosen["inspect"]))
        found = geometry["position"][geometry["seed"] == number][0].astype(float)
        near = np.append(found, 1.0) @ both
        assert np.abs(near[:2] / near[3] - (across, up)).max() < 0.01
    assert stage.clicked(1.0, 1.0) == {"inspect": ""}


@pytest.mark.parametrize("values", [{}, {"turbulence": 3.0, "drag": "0.1..0.4", "wind": 3.0, "gusts": 0.6},
                                    {"attractor": "point", "vortex": 4.0, "obstacle": "sphere"}])
def test_a_life_lived_again_passes_where_the_particle_is(stage: Stage, values: dict[str, object]) -> None:
    """The way shown is that of the simulation: alone it goes where it goes among all, at every frame."""
    stage.set(children_when="never", **values)
    stage.seek(12)
    seed = int(stage.geometry()["seed"][3])
    stage.set(inspect=str(seed))
    stage.pixels()
    inspector = stage.scene.inspector
    _, life = inspector._life
    for frame in range(13, 70, 7):
        stage.seek(frame)
        now = stage.geometry()
        place = now["position"][now["seed"] == seed][0]
        step = np.abs(life.ages - now["age"][now["seed"] == seed][0]).argmin()
        assert np.abs(life.places[step] - place).max() < 2e-4
    assert life.ages[0] == 0.0
    assert life.ages[-1] == pytest.approx(now["life"][now["seed"] == seed][0], abs=1e-6)


def test_who_is_not_there_is_told(stage: Stage) -> None:
    stage.seek(30)
    stage.set(inspect="999999999")
    assert stage.remarks() == ["Particle 999999999 is not born yet"]
    stage.set(inspect="0")
    assert stage.remarks() == []
    stage.seek(240)
    assert stage.remarks() == ["Particle 0 has died"]
    with pytest.raises(viewer.ParameterError, match="inspect = fish is not written like 1234"):
        stage.set(inspect="fish")


def test_forces_on_the_inspected_particle_add_up_to_its_acceleration(stage: Stage) -> None:
    """Newton's second law, the acceleration from two frames of the simulation."""
    stage.set(children_when="never", turbulence=2.0, turbulence_size=3.0, drag="0.3..0.3", wind=2.0, mass="0.5..0.5",
              attractor="line", vortex=3.0, attractor_core=1.0, ground=False)
    stage.seek(30)
    before = stage.geometry()
    seed = int(before["seed"][5])
    stage.set(inspect=str(seed))
    stage.pixels()
    told = stage.measure()["inspected"]
    rows = dict(told.rows)
    assert told.columns == ("quantity", "value")
    force = sum(np.array([float(part) for part in str(value).split(",")])
                for name, value in rows.items() if str(name).endswith("(N)"))
    stage.seek(31)
    after = stage.geometry()
    change = after["velocity"][after["seed"] == seed][0] - before["velocity"][before["seed"] == seed][0]
    assert change * 60.0 == pytest.approx(force / 0.5, abs=0.35)


def test_a_glass_vessel_a_slope_and_the_emitter_are_shown(stage: Stage) -> None:
    stage.set(rate=0.0)
    plain = stage.pixels()
    for values in ({"obstacle": "sphere", "hollow": True}, {"ground_tilt": 20.0},
                   {"emitter": "torus", "show_emitter": True}, {"obstacle": "torus"}):
        stage.apply_preset(PRESETS["fountain"])
        stage.set(rate=0.0, **values)
        assert np.abs(stage.pixels().astype(int) - plain).max() > 20, values


def test_trails_and_strands_show(stage: Stage) -> None:
    stage.seek(60)
    stage.set(trail_length=1.0)
    stage.seek(90)
    assert ink(stage) > 0.2
    stage.set(strands=True, emitter="sphere", emitter_height=1.0, burst=2000, rate=0.0)
    assert stage.measure()["alive"] == 2000
    stage.seek(100)
    assert stage.measure()["alive"] == 2000, "hair does not age"


def test_a_window_that_stalls_loses_nothing(stage: Stage) -> None:
    stage.seek(30)
    for _ in range(3):
        stage.advance(5.0)
    geometry = stage.geometry()
    assert all(np.isfinite(values).all() for values in geometry.values())
    assert geometry["position"][:, 1].min() > 0.0
    told = stage.measure()
    assert told["emitted"] + told["children"] == told["alive"] + told["died"]


def test_the_poster_is_the_default_view(context: moderngl.Context, capsys: pytest.CaptureFixture[str],
                                        tmp_path: Path) -> None:
    """`capture` without frames draws the frame that shows the scene best, and the preset `fountain` is the default."""
    assert main(["list", "--json"]) in (0, None)
    told = next(scene for scene in json.loads(capsys.readouterr().out) if scene["name"] == "particle_fountain")
    assert told["poster"] > 0
    with viewer.headless("particle_fountain", size=(64, 36), samples=0) as one, \
            viewer.headless("particle_fountain", size=(64, 36), samples=0, preset="fountain") as other:
        for stage in (one, other):
            stage.seek(60)
        assert np.array_equal(one.pixels(), other.pixels())


def test_files_that_hold_no_mesh_are_told_and_the_picture_stays(stage: Stage, tmp_path: Path) -> None:
    flat = tmp_path / "flat.obj"
    flat.write_text("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")
    broken = tmp_path / "broken.obj"
    broken.write_text("v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n")
    stage.seek(20)
    before = stage.pixels()
    for what in ("emitter", "obstacle"):
        for path in (flat, broken):
            with pytest.raises(viewer.DemoscopeError) as told:
                stage.set(**{f"{what}_file": str(path), what: "mesh"})
            assert path.name in str(told.value) and "\n" not in str(told.value)
            assert np.array_equal(stage.pixels(), before)


def test_capacity_beyond_memory_is_refused_with_an_estimate(context: moderngl.Context,
                                                            monkeypatch: pytest.MonkeyPatch) -> None:
    import psutil

    class Little:
        available = 64 * 2**20

    monkeypatch.setattr(psutil, "virtual_memory", Little)
    with pytest.raises(viewer.ParameterError, match=r"count = 4194304 needs about 0\.\d GiB of memory and 0\.1 GiB"):
        viewer.render("particle_fountain", params={"count": 4194304})
