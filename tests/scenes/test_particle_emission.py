"""How particles come into the world and leave it: how many, when, with which qualities, and from whom."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import moderngl
import numpy as np
import pytest
from scipy import stats

from tests.scenes.particle_stage import QUIET, Numbers, followed, played, set_anew, stage_of_particles
from viewer.engine.number_fields import Number
from viewer.engine.particles.system import ParticleParameters
from viewer.engine.particles.tally import Tally
from viewer.engine.scene import Geometry
from viewer.engine.stage import Stage
from viewer.errors import DemoscopeError

pytestmark = pytest.mark.usefixtures("context")
DT = 1 / 60
G = 9.81
QUALITIES = ("position", "velocity", "age", "life", "size", "mass", "generation", "seed")
CASCADE: dict[str, Any] = {
    "children_when": "death", "children": (3.0, 3.0), "children_lifetime": (0.2, 0.3),
    "grandchildren_when": "death", "grandchildren": (2.0, 2.0), "grandchildren_lifetime": (0.2, 0.3),
    "great_grandchildren_when": "death", "great_grandchildren": (4.0, 4.0),
    "great_grandchildren_lifetime": (5.0, 5.0)}


@pytest.fixture(scope="module")
def shared(only_context: moderngl.Context) -> Iterator[Stage]:
    with stage_of_particles() as stage:
        yield stage


def born(stage: Stage, frame: int = 1, **values: object) -> Geometry:
    """What a stage has at ``frame`` with these values."""
    set_anew(stage, values)
    return played(stage, frame)


def tally(stage: Stage) -> Tally:
    """What the particle system has counted."""
    counted: Tally = stage.scene.system.tally       # type: ignore[attr-defined]
    return counted


def check_books(stage: Stage, found: Geometry) -> None:
    """Whoever was born lives or has died, and what is told of them agrees."""
    counted = tally(stage)
    alive = len(found["seed"])
    assert counted.emitted + counted.children == alive + counted.died
    assert counted.live[-1] == alive
    assert alive <= stage.params.count      # type: ignore[attr-defined]
    assert len(np.unique(found["seed"])) == alive
    assert ((found["age"] >= 0.0) & (found["age"] <= found["life"])).all()


def evenly(values: Numbers, low: float, high: float) -> float:
    """The chance that numbers as these are drawn evenly from a range (Kolmogorov and Smirnov)."""
    assert values.min() >= low - 1e-6 * abs(low) and values.max() <= high + 1e-6 * abs(high)
    return float(stats.kstest(values, stats.uniform(low, high - low).cdf).pvalue)


# How many, and when


def test_a_rate_of_37_3_gives_746_in_20_seconds(shared: Stage) -> None:
    found = born(shared, 1200, rate=37.3)
    assert len(found["age"]) in (745, 746)
    measured = shared.measure()
    assert measured["emitted"] == measured["alive"] == len(found["age"])


@pytest.mark.parametrize("lifetime", [100.0, 600.0])
def test_ages_are_equally_far_apart(shared: Stage, lifetime: float) -> None:
    """Also across the borders of steps, and however long they have to live."""
    found = born(shared, 600, rate=37.3, lifetime=(lifetime, lifetime))
    ages = np.sort(found["age"].astype(np.float64))[::-1]
    np.testing.assert_allclose(ages, 10.0 - np.arange(1, len(ages) + 1) / 37.3, atol=2e-6)


def test_as_many_live_as_the_rate_and_the_mean_life_say(shared: Stage) -> None:
    found = born(shared, 240, rate=1000.0, lifetime=(0.5, 1.5))
    assert len(found["age"]) == pytest.approx(1000.0, rel=0.05)
    assert shared.measure()["alive"] == len(found["age"])


def test_each_dies_when_its_time_is_up(shared: Stage) -> None:
    """In the frame in which its life ends, to the frame; even those who live for less than one."""
    life = born(shared, 0, burst=500, lifetime=(0.02, 1.0))["life"].astype(np.float64)
    for frame in range(1, 63, 5):
        shared.seek(frame)
        gone = np.count_nonzero(life <= frame * DT)
        assert abs(int(tally(shared).died) - gone) <= np.count_nonzero(np.abs(life - frame * DT) < 1e-5)
    assert len(played(shared, 62)["age"]) == 0


def test_count_caps_and_refuses_the_rest(shared: Stage) -> None:
    """Never more live than there is room for; who finds none is counted, and room that gets free is used."""
    with stage_of_particles(count=500, rate=3000.0, lifetime=(0.2, 0.4), burst=700) as stage:
        asked = 0
        for frame in range(60):
            found = played(stage, frame)
            check_books(stage, found)
            asked = 700 + 50 * frame
            assert tally(stage).emitted + tally(stage).refused == asked
        assert tally(stage).refused > 0
        assert len(found["age"]) == pytest.approx(500, abs=60)


@pytest.mark.parametrize("count", [1, 2, 17, 257])
def test_small_pools_are_filled_to_the_last_slot(count: int) -> None:
    with stage_of_particles(count=count, burst=1000) as stage:
        found = played(stage, 3)
        assert len(found["age"]) == count
        assert tally(stage).refused == 1000 - count


def test_bursts_come_when_they_are_due(shared: Stage) -> None:
    found = born(shared, 61, burst=10, burst_every=0.3, emit_until=0.85)
    np.testing.assert_allclose(np.unique(found["age"].astype(np.float64).round(5)),
                               np.array([61, 61 - 18, 61 - 36])[::-1] / 60, atol=1e-5)
    assert len(found["age"]) == 30


def test_more_than_a_batch_at_once(only_context: moderngl.Context) -> None:
    """Seventy thousand in one frame: each with its own age, seed and place in line."""
    with stage_of_particles(count=200_000, rate=70_000.0 * 60) as stage:
        found = played(stage, 1)
        order = np.argsort(found["seed"])
        np.testing.assert_array_equal(found["seed"][order], np.arange(70_000))
        ages = found["age"][order].astype(np.float64)
        np.testing.assert_allclose(ages, DT - np.arange(1, 70_001) / (70_000 * 60), atol=1e-7)
        assert len(np.unique(found["life"])) == 1


# Qualities


def test_qualities_fill_their_ranges_evenly(shared: Stage) -> None:
    found = born(shared, 0, burst=4000, lifetime=(0.5, 3.0), speed=(2.0, 9.0), size=(0.1, 0.4), mass=(0.5, 8.0),
                 spread=60.0)
    speed = np.linalg.norm(found["velocity"].astype(np.float64), axis=1)
    cosine = found["velocity"][:, 1] / speed
    chances = {"life": evenly(found["life"], 0.5, 3.0), "size": evenly(found["size"], 0.1, 0.4),
               "mass": evenly(found["mass"], 0.5, 8.0), "speed": evenly(speed, 2.0, 9.0),
               "cosine": evenly(cosine, 0.5, 1.0),
               "heading": evenly(np.arctan2(found["velocity"][:, 2], found["velocity"][:, 0]), -math.pi, math.pi)}
    assert min(chances.values()) > 1e-3, chances


def test_qualities_do_not_depend_on_each_other_nor_on_the_one_before(shared: Stage) -> None:
    found = born(shared, 0, burst=4000, lifetime=(0.5, 3.0), speed=(2.0, 9.0), size=(0.1, 0.4), mass=(0.5, 8.0),
                 spread=60.0)
    columns = np.stack([found["life"], found["size"], found["mass"], np.linalg.norm(found["velocity"], axis=1),
                        found["velocity"][:, 0]])
    related = np.corrcoef(np.concatenate([columns[:, 1:], columns[:, :-1]]))
    assert np.abs(related - np.eye(len(related))).max() < 0.08


@pytest.mark.parametrize("name", ["lifetime", "size", "mass"])
def test_a_range_of_one_value_gives_that(shared: Stage, name: str) -> None:
    found = born(shared, 0, burst=300, **{name: "0.7..0.7"})
    assert (found[name.replace("lifetime", "life")] == np.float32(0.7)).all()


def test_a_range_may_be_given_as_text_or_as_a_pair(shared: Stage) -> None:
    text = born(shared, 0, burst=300, lifetime="2..3", speed="1..4")
    pair = born(shared, 0, burst=300, lifetime=(2.0, 3.0), speed=(1.0, 4.0))
    for name in QUALITIES:
        assert text[name].tobytes() == pair[name].tobytes()


@pytest.mark.parametrize(("name", "value"), [("lifetime", "3..2"), ("lifetime", (0.0, 1.0)), ("lifetime", (-2.0, -1.0)),
                                             ("speed", (math.nan, 1.0)), ("mass", (0.0, 1.0)), ("rate", math.inf),
                                             ("count", 0), ("count", 5_000_000), ("children", "x"),
                                             ("restitution", 1.5), ("emitter", "cloud"), ("speed", (1.0, 2.0, 3.0))])
def test_mistakes_are_told_and_change_nothing(shared: Stage, name: str, value: object) -> None:
    before = born(shared, 5, rate=3000.0)
    with pytest.raises(DemoscopeError, match=name):
        shared.update_params({name: value})
    after = shared.geometry()
    for quality in QUALITIES:
        assert before[quality].tobytes() == after[quality].tobytes()


def test_the_same_seed_gives_the_same_bytes_and_another_others() -> None:
    values = {"rate": 900.0, "speed": (1.0, 4.0), "spread": 30.0, "lifetime": (0.2, 0.9), **CASCADE}
    runs = []
    for seed in (3, 3, 4):
        with stage_of_particles(seed=seed, **values) as stage:
            runs.append(played(stage, 45))
    for name in QUALITIES:
        assert runs[0][name].tobytes() == runs[1][name].tobytes()
    for name in ("position", "velocity", "life"):
        assert runs[0][name].tobytes() != runs[2][name].tobytes()
    assert len(np.intersect1d(runs[0]["life"], runs[2]["life"])) < 5


@pytest.mark.parametrize("seed", [2**32, 2**63, -1, 10**30])
def test_great_seeds_differ_too(seed: int) -> None:
    """Where they are taken at all."""
    lives = []
    for one in (seed, seed + 1):
        try:
            with stage_of_particles(seed=one, burst=50, lifetime=(1.0, 2.0)) as stage:
                lives.append(played(stage, 0)["life"])
        except DemoscopeError:
            return
    assert (lives[0] != lives[1]).any()


# Who is who


def test_a_seed_is_given_once_and_stays(shared: Stage) -> None:
    """Each particle's numbers stay with it while its age grows by a frame; no number ever comes back."""
    set_anew(shared, {"rate": 1500.0, "lifetime": (0.1, 0.5), "speed": (1.0, 5.0), "mass": (1.0, 2.0),
                      "ground": True, **CASCADE})
    known: dict[str, Any] = {}
    gone = np.empty(0, np.int64)
    for frame in range(90):
        found = played(shared, frame)
        check_books(shared, found)
        assert not np.isin(found["seed"], gone).any()
        if known and len(known["seed"]):
            same, here, there = np.intersect1d(found["seed"], known["seed"], return_indices=True)
            for name in ("life", "size", "mass", "generation"):
                np.testing.assert_array_equal(found[name][here], known[name][there])
            np.testing.assert_allclose(found["age"][here], known["age"][there] + DT, atol=1e-6)
            fresh = np.setdiff1d(found["seed"], same)
            assert len(fresh) == 0 or fresh.min() > known["seed"].max()
            assert (found["age"][np.isin(found["seed"], fresh)] <= DT + 1e-6).all()
            gone = np.union1d(gone, np.setdiff1d(known["seed"], same))
        known = found
    assert len(gone) > 1000


def test_books_are_kept_at_every_frame_with_everything_at_once(shared: Stage) -> None:
    set_anew(shared, {**CASCADE, "rate": 3000.0, "burst": 300, "burst_every": 0.21, "ground": True,
                      "lifetime": (0.05, 0.8), "speed": (1.0, 6.0), "spread": 60.0, "obstacle": "sphere",
                      "grandchildren_when": "life", "grandchildren": (5.0, 40.0), "collision": "die",
                      "great_grandchildren_when": "collision"})
    for frame in range(100):
        check_books(shared, played(shared, frame))
    assert tally(shared).refused > 0        # the pool is full by then
    assert tally(shared).children > 1000


# Cascades


def test_three_generations_of_death_have_exactly_as_many_children(shared: Stage) -> None:
    """3, then 2 each, then 4 each; of 20 that die."""
    found = born(shared, 0, burst=20, lifetime=(0.1, 0.2), **CASCADE)
    assert len(found["age"]) == 20
    found = played(shared, 80)
    generations = np.bincount(found["generation"], minlength=4)
    assert generations.tolist() == [0, 0, 0, 20 * 3 * 2 * 4]
    assert tally(shared).children == 20 * 3 * (1 + 2 * (1 + 4))
    assert tally(shared).died == 20 + 60 + 120


@pytest.mark.parametrize("number", [1.0, 2.0, 7.0, 40.0])
def test_each_death_brings_exactly_so_many(shared: Stage, number: float) -> None:
    born(shared, 30, burst=100, lifetime=(0.1, 0.4), children_when="death", children=(number, number),
         children_lifetime=(9.0, 9.0))
    assert tally(shared).children == 100 * number
    assert tally(shared).refused == 0


def test_a_range_of_children_is_met_in_the_mean(shared: Stage) -> None:
    found = born(shared, 30, burst=1000, lifetime=(0.1, 0.4), children_when="death", children=(0.5, 2.5),
                 children_lifetime=(9.0, 9.0))
    assert len(found["age"]) == pytest.approx(1500, abs=4 * math.sqrt(1000 * (1 / 3 + 1 / 4)))


@pytest.mark.parametrize("number", [0.5, 10.0, 60.0, 333.0])
def test_children_of_life_come_at_their_rate(shared: Stage, number: float) -> None:
    """So many each second of each life, to one."""
    parents, seconds = 10, 1.0
    born(shared, 90, burst=parents, lifetime=(seconds, seconds), children_when="life", children=(number, number),
         children_lifetime=(50.0, 50.0))
    assert abs(tally(shared).children - parents * number * seconds) <= parents
    assert tally(shared).died == parents


def test_who_dies_early_has_the_children_of_the_life_it_had(shared: Stage) -> None:
    """One that ends at an impact does not have all the others at once."""
    set_anew(shared, {"burst": 10, "lifetime": (10.0, 10.0), "children_when": "life", "children": (30.0, 30.0),
                      "children_lifetime": (50.0, 50.0), "ground": True, "collision": "die", "emitter_height": 5.0,
                      "children_speed": (0.0, 0.0), "children_inherit": 0.0, "speed": (0.0, 0.0)})
    fall = math.sqrt(2 * 5.0 / G)
    shared.seek(int(fall * 60) + 3)
    assert abs(tally(shared).children - 10 * 30.0 * fall) <= 20


def test_children_of_life_come_all_along_the_way(shared: Stage) -> None:
    """Not only at the ends of steps."""
    found = born(shared, 60, burst=1, lifetime=(2.0, 2.0), speed=(6.0, 6.0), gravity=0.0, children_when="life",
                 children=(600.0, 600.0), children_lifetime=(9.0, 9.0), children_speed=(0.0, 0.0),
                 children_inherit=0.0)
    height = np.sort(found["position"][found["generation"] == 1, 1])
    assert len(height) == 600
    assert evenly(height.astype(np.float64), 0.0, 6.0) > 1e-3


def test_an_impact_brings_children_there(shared: Stage) -> None:
    """As many as the collisions that are counted, times their number; on the ground, within the normal's cone."""
    set_anew(shared, {"burst": 40, "ground": True, "emitter_height": 1.0, "emitter": "disc", "emitter_size": 0.2,
                      "restitution": 0.5, "children_when": "collision", "children": (3.0, 3.0),
                      "children_lifetime": (9.0, 9.0), "children_speed": (2.0, 2.0), "children_spread": 30.0,
                      "children_inherit": 0.0, "gravity": G})
    shared.seek(26)
    assert tally(shared).children == 0
    found = played(shared, 28)
    assert tally(shared).collisions == 40 and tally(shared).children == 120
    children = found["generation"] == 1
    assert children.sum() == 120
    assert np.abs(found["position"][children, 1]).max() < 0.08
    speed = np.linalg.norm(found["velocity"][children].astype(np.float64), axis=1)
    assert (found["velocity"][children, 1] / speed > math.cos(math.radians(31.0)) - 0.15).all()


@pytest.mark.parametrize("inherit", [0.0, 0.15, 1.0])
def test_children_inherit_part_of_the_velocity(shared: Stage, inherit: float) -> None:
    """What they have of their own goes off around that, at their own speed."""
    found = born(shared, 30, burst=50, speed=(10.0, 10.0), emitter_tilt=60.0, gravity=0.0, lifetime=(0.4, 0.4),
                 children_when="death", children=(8.0, 8.0), children_speed=(2.0, 2.0), children_spread=180.0,
                 children_inherit=inherit, children_lifetime=(9.0, 9.0), children_size=(0.3, 0.4))
    assert (found["generation"] == 1).all() and len(found["age"]) == 400
    kept = inherit * 10.0 * np.array([math.sin(math.radians(60.0)), math.cos(math.radians(60.0)), 0.0])
    own = found["velocity"] - kept
    np.testing.assert_allclose(np.linalg.norm(own, axis=1), 2.0, atol=1e-4)
    assert np.linalg.norm(own.mean(axis=0)) < 0.4
    assert evenly(found["size"].astype(np.float64), 0.3, 0.4) > 1e-3


def test_a_spread_of_nothing_sends_children_the_parents_way(shared: Stage) -> None:
    found = born(shared, 30, burst=5, speed=(10.0, 10.0), emitter_tilt=60.0, gravity=0.0, lifetime=(0.4, 0.4),
                 children_when="death", children=(4.0, 4.0), children_speed=(2.0, 2.0), children_spread=0.0,
                 children_inherit=0.0, children_lifetime=(9.0, 9.0))
    way = np.array([math.sin(math.radians(60.0)), math.cos(math.radians(60.0)), 0.0])
    np.testing.assert_allclose(found["velocity"], np.tile(2.0 * way, (20, 1)), atol=1e-4)


def test_grandchildren_need_children(shared: Stage) -> None:
    born(shared, 60, burst=50, lifetime=(0.1, 0.2), **{**CASCADE, "children_when": "never"})
    assert tally(shared).children == 0
    born(shared, 60, burst=50, lifetime=(0.1, 0.2), **{**CASCADE, "grandchildren": (0.0, 0.0)})
    assert tally(shared).children == 150


def test_more_children_than_there_is_room_for_are_refused(shared: Stage) -> None:
    """Thousands each from thousands at once: as many as fit are born, and all the others are counted.

    Who dies gives up its place only after its children have come.
    """
    found = born(shared, 3, burst=4000, lifetime=(0.02, 0.03), children_when="death", children=(4000.0, 4000.0),
                 children_lifetime=(9.0, 9.0))
    check_books(shared, found)
    assert len(found["age"]) == 4096 - 4000
    assert tally(shared).children + tally(shared).refused == 4000 * 4000


# The wave


@pytest.mark.parametrize("source", ["surface", "volume"])
def test_a_wave_emits_from_a_ring_evenly_by_area(shared: Stage, source: str) -> None:
    """On a sphere that is lifted and leans: where it has just come, and nowhere else."""
    speed, width, radius = 2.0, 0.6, 1.5
    set_anew(shared, {"emitter": "sphere", "emitter_size": radius, "emit_from": source, "emitter_height": 2.0,
                      "emitter_tilt": 40.0, "wave_speed": speed, "wave_width": width, "rate": 6000.0,
                      "gravity": 0.0})
    found = played(shared, 40)
    fresh = found["age"] < 1.01 * DT
    axis = np.array([math.sin(math.radians(40.0)), math.cos(math.radians(40.0)), 0.0])
    away = found["position"].astype(np.float64) - [0.0, 2.0, 0.0]
    distance = np.linalg.norm(away, axis=1)
    if source == "surface":
        np.testing.assert_allclose(distance, radius, atol=1e-4)
    else:
        assert distance.max() <= radius * (1 + 1e-5)
        assert evenly((distance / radius)**3, 0.0, 1.0) > 1e-3
    cosine = (away @ axis) / distance
    angle = np.arccos(np.clip(cosine, -1.0, 1.0))
    reach = speed * 40 * DT / radius
    ring = angle[fresh]
    assert len(ring) >= 100
    assert ring.min() > reach - width / radius - 1e-4 and ring.max() < reach + 1e-4
    low, high = math.cos(reach), math.cos(reach - width / radius)
    assert evenly(cosine[fresh], low - 1e-6, high + 1e-6) > 1e-3
    assert angle.max() < reach + 1e-4


# Born where something stands


@pytest.mark.parametrize(("size", "tilt"), [(0.5, 0.0), (50.0, 30.0), (20.0, -50.0)])
def test_whoever_is_born_in_the_ground_is_put_onto_it(shared: Stage, size: float, tilt: float) -> None:
    """Far from the origin too, where numbers are coarse."""
    found = born(shared, 1, burst=2000, emitter="ground", emitter_size=size, ground=True, ground_tilt=tilt)
    assert len(found["age"]) == 2000
    angle = math.radians(tilt)
    height = found["position"].astype(np.float64) @ [-math.sin(angle), math.cos(angle), 0.0]
    assert height.min() > -1e-6 * size


# Absurd values


def limits() -> list[tuple[str, object]]:
    """Each end of each number's range."""
    found: list[tuple[str, object]] = []
    for name, field in ParticleParameters.declared.items():
        if isinstance(field, Number):
            found += [(name, field.minimum), (name, field.maximum)]
        elif hasattr(field, "minimum"):
            low, high = field.minimum, field.maximum
            found += [(name, (low, low)), (name, (high, high)), (name, (low, high))]
    return found


@pytest.mark.slow
def test_the_ends_of_every_range_are_survived(only_context: moderngl.Context) -> None:
    """One at a time, in a scene in which all of it counts, for 30 frames: nothing but finite numbers."""
    busy = {**QUIET, **CASCADE, "count": 300, "rate": 600.0, "lifetime": (0.1, 0.6), "speed": (1.0, 6.0),
            "spread": 60.0, "ground": True, "obstacle": "torus", "turbulence": 2.0, "wind": 2.0, "gusts": 0.5,
            "drag": (0.01, 0.5), "mass": (0.5, 2.0), "attractor": "point", "vortex": 1.0, "emitter": "sphere",
            "wave_speed": 0.5, "burst": 20, "burst_every": 0.1, "children_when": "collision"}
    assert {"lifetime", "speed", "rate", "gravity", "children", "count"} <= {name for name, _ in limits()}
    refused: list[str] = []
    with stage_of_particles(**busy) as stage:
        for name, value in limits():
            if name in ("count", "warm_up"):
                continue
            stage.seek(0)
            try:
                stage.update_params(stage.params.completed({**busy, name: value}))
                stage.seek(30)
            except DemoscopeError:
                refused.append(name)
                continue
            found = stage.geometry()
            for quality in QUALITIES:
                assert np.isfinite(found[quality]).all(), (name, value, quality)
            check_books(stage, found)
            assert only_context.error == "GL_NO_ERROR", (name, value)
    assert not refused


@pytest.mark.parametrize("values", [{"mass": (1e-3, 1e-3), "drag": (1e3, 1e3), "wind": 50.0, "gusts": 1.0},
                                    {"attractor": "point", "attraction": 200.0, "attractor_core": 0.01,
                                     "attractor_y": 0.5},
                                    {"attractor": "line", "attraction": -200.0, "attractor_core": 0.01},
                                    {"turbulence": 100.0, "turbulence_size": 0.05, "mass": (1e-3, 1e-3)},
                                    {"vortex": 100.0, "gravity": -50.0, "lifetime": (600.0, 600.0)},
                                    {"ground": True, "ground_tilt": 60.0, "restitution": 1.0, "friction": 2.0},
                                    {"obstacle": "sphere", "obstacle_size": 20.0, "hollow": False}])
def test_the_worst_together(shared: Stage, values: dict[str, Any]) -> None:
    set_anew(shared, {"rate": 1200.0, "speed": (0.0, 200.0), "spread": 180.0, "lifetime": (0.02, 3.0),
                      "obstacle": "box", "obstacle_thickness": 0.01, "ground": True, **values})
    for frame in range(0, 121, 20):
        found = played(shared, frame)
        assert all(np.isfinite(found[name]).all() for name in QUALITIES)
        check_books(shared, found)
        assert all(np.isfinite(float(shared.measure()[name]))      # type: ignore[arg-type]
                   for name in ("kinetic_energy", "potential_energy", "fastest"))


def test_nobody_follows_nobody(shared: Stage) -> None:
    """An empty scene has arrays of no length, and measures nothing."""
    found = born(shared, 10)
    assert all(len(found[name]) == 0 for name in QUALITIES)
    assert found["position"].shape == found["velocity"].shape == (0, 3)
    measured = shared.measure()
    assert [measured[name] for name in ("alive", "emitted", "died", "kinetic_energy", "fastest")] == [0, 0, 0, 0, 0]
    assert followed(shared, 2)["position"].shape == (3, 0, 3)
