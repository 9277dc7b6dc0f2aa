"""How particles move: against the closed forms of mechanics, and never into what is solid."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tests.scenes.particle_stage import (
    Numbers,
    energy,
    followed,
    played,
    seconds,
    set_anew,
    stage_of_particles,
)
from viewer.engine.stage import Stage
from viewer.kit.curl_noise import curl_noise

pytestmark = pytest.mark.usefixtures("context")
G = 9.81
DT = 1 / 60
UP = np.array([0.0, 1.0, 0.0])


@pytest.fixture(scope="module")
def shared(only_context: moderngl.Context) -> Iterator[Stage]:
    with stage_of_particles() as stage:
        yield stage


def motion(stage: Stage, frames: int, start: int = 0, **values: object) -> dict[str, Numbers]:
    """How everyone of a burst moves from frame ``start`` on."""
    set_anew(stage, {"burst": 64, **values})
    return followed(stage, frames, start)


def one(stage: Stage, frames: int, **values: object) -> tuple[Numbers, Numbers]:
    """Where one particle is and how fast, (frames + 1, 3) each."""
    track = motion(stage, frames, **{"burst": 1, **values})
    return track["position"][:, 0], track["velocity"][:, 0]


# Flight


@pytest.mark.parametrize("gravity", [G, 1.62, -3.0, 0.0, 50.0])
def test_free_flight_is_a_parabola(shared: Stage, gravity: float) -> None:
    """After 2 s it errs by far less than 1e-4 of the path."""
    track = motion(shared, 120, gravity=gravity, speed=(6.0, 9.0), spread=70.0)
    t = seconds(120)[:, None, None]
    start, launch = track["position"][:1], track["velocity"][:1]
    exact = start + launch * t - 0.5 * gravity * t**2 * UP
    path = np.linalg.norm(np.diff(track["position"], axis=0), axis=-1).sum(axis=0)
    error = np.linalg.norm(track["position"] - exact, axis=-1)
    assert (error[-1] < 1e-4 * path).all()
    assert (error < 2e-6 * path).all()
    np.testing.assert_allclose(track["velocity"], launch - gravity * t * UP, atol=1e-4 * max(1.0, abs(gravity) / G))


def test_a_stream_flies_as_a_burst_does(shared: Stage) -> None:
    """Those born in the middle of a step too: where each is follows from its age."""
    set_anew(shared, {"rate": 733.0, "speed": (7.0, 7.0), "emitter_tilt": 30.0})
    found = played(shared, 100)
    t = found["age"].astype(np.float64)[:, None]
    launch = 7.0 * np.array([math.sin(math.pi / 6), math.cos(math.pi / 6), 0.0])
    assert len(t) == int(733.0 * 100 / 60 + 1e-9)
    np.testing.assert_allclose(found["position"], launch * t - 0.5 * G * t**2 * UP, atol=2e-4)
    np.testing.assert_allclose(found["velocity"], launch - G * t * UP, atol=2e-4)


@pytest.mark.parametrize("gravity", [0.0, G])
@pytest.mark.parametrize(("mass", "drag"), [(1.0, 0.5), (0.2, 1.0), (1.0, 0.01), (0.001, 5.0), (50.0, 1000.0)])
def test_linear_drag_has_its_closed_form(shared: Stage, gravity: float, mass: float, drag: float) -> None:
    track = motion(shared, 120, gravity=gravity, speed=(5.0, 9.0), spread=60.0, mass=(mass, mass), drag=(drag, drag))
    t, c = seconds(120)[:, None, None], drag / mass
    final = -gravity / c * UP
    launch = track["velocity"][:1]
    fading = np.exp(-c * t)
    np.testing.assert_allclose(track["velocity"], final + (launch - final) * fading, atol=5e-5)
    np.testing.assert_allclose(track["position"], final * t + (launch - final) * (1 - fading) / c, atol=2e-4)


def test_drag_acts_by_the_mass_that_each_has(shared: Stage) -> None:
    """Masses differ and drags do: each slows down by its own drag over its own mass."""
    drags = (0.5, 0.5)
    track = motion(shared, 60, gravity=0.0, speed=(10.0, 10.0), mass=(0.2, 5.0), drag=drags)
    mass = track["mass"][0]
    assert mass.max() / mass.min() > 10.0
    np.testing.assert_allclose(track["velocity"][-1, :, 1], 10.0 * np.exp(-0.5 / mass), rtol=1e-5)
    varied = motion(shared, 60, gravity=0.0, speed=(10.0, 10.0), mass=(2.0, 2.0), drag=(0.2, 5.0))
    rate = -np.log(varied["velocity"][-1, :, 1] / 10.0) * 2.0
    assert (rate > 0.2 - 1e-4).all() and (rate < 5.0 + 1e-4).all()
    assert np.ptp(rate) > 3.0


def test_in_a_vacuum_mass_does_not_matter(shared: Stage) -> None:
    track = motion(shared, 60, mass=(0.001, 1000.0), speed=(3.0, 3.0), wind=40.0)
    assert np.ptp(track["mass"]) > 300.0
    assert np.ptp(track["position"], axis=1).max() == 0.0


@pytest.mark.parametrize(("mass", "drag"), [(1.0, 2.0), (0.1, 0.5)])
@pytest.mark.parametrize("wind", [0.0, 12.0])
def test_everything_ends_up_at_its_terminal_velocity(shared: Stage, mass: float, drag: float, wind: float) -> None:
    """It falls at m g / c, and goes along with the wind."""
    set_anew(shared, {"burst": 1, "mass": (mass, mass), "drag": (drag, drag), "wind": wind, "wind_heading": 90.0,
                      "speed": (20.0, 20.0)})
    np.testing.assert_allclose(played(shared, 600)["velocity"][0], [0.0, -mass * G / drag, -wind], atol=1e-3)


def test_wind_acts_through_drag_alone(shared: Stage) -> None:
    still = motion(shared, 30, speed=(1.0, 3.0), spread=90.0)
    windy = motion(shared, 30, speed=(1.0, 3.0), spread=90.0, wind=50.0, gusts=1.0)
    np.testing.assert_array_equal(still["position"], windy["position"])
    blown = motion(shared, 30, speed=(1.0, 3.0), spread=90.0, wind=50.0, drag=(0.1, 0.1))
    assert (blown["velocity"][-1, :, 0] > still["velocity"][-1, :, 0] + 1.0).all()


def test_gusts_come_and_go_and_are_the_wind_in_the_mean(shared: Stage) -> None:
    """What follows the air at once shows how it blows: between none and twice as much."""
    air = {"gravity": 0.0, "wind": 5.0, "mass": (0.001, 0.001), "drag": (10.0, 10.0)}
    steady = one(shared, 30, **air)[1][2:, 0]
    np.testing.assert_allclose(steady, 5.0, rtol=1e-4)
    gusty = motion(shared, 120, **air, gusts=1.0, emitter="ground", emitter_size=20.0, burst=1000)["velocity"][2:]
    assert gusty[..., 0].min() > -0.01 and gusty[..., 0].max() < 10.01
    assert gusty[..., 0].std() > 1.5
    assert gusty[..., 0].mean() == pytest.approx(5.0, abs=0.5)
    assert np.abs(gusty[..., 1:]).max() < 1e-3


# Forces


def test_turbulence_is_the_flow_of_curl_noise(shared: Stage) -> None:
    """One step from rest gives force over mass times the step."""
    track = motion(shared, 1, gravity=0.0, turbulence=3.0, turbulence_size=0.7, turbulence_pace=0.0,
                   emitter="sphere", emitter_size=5.0, emit_from="volume", burst=500, mass=(0.5, 2.0))
    force = 3.0 * curl_noise(track["position"][0] / 0.7)
    np.testing.assert_allclose(track["velocity"][1], force / track["mass"][0][:, None] * DT, atol=3e-5)


def test_turbulence_drifts(shared: Stage) -> None:
    """It is another after a while, by as many widths a second as said, and only if it is told to drift."""
    rest = {"gravity": 0.0, "turbulence": 1.0, "emitter": "sphere", "emit_from": "volume", "burst": 0,
            "burst_every": 0.5}
    seen = []
    for pace in (0.0, 2.0):
        set_anew(shared, {**rest, "turbulence_pace": pace})
        shared.seek(60)
        shared.set(burst=400)
        late = played(shared, 61)
        seen.append(late["velocity"] / (late["age"][:, None] + 1e-12))
        places = late["position"]
        if pace == 0.0:
            np.testing.assert_allclose(seen[0], curl_noise(places), atol=0.02)
    assert np.abs(seen[0] - seen[1]).max() > 0.5


@pytest.mark.parametrize("core", [0.01, 0.3])
def test_a_planet_stays_in_its_circle(shared: Stage, core: float) -> None:
    """Around a point: at the speed that holds it there for many periods, which are Kepler's."""
    radius, pull = 2.0, 20.0
    speed = math.sqrt(pull * radius**2 / (radius**2 + core**2)**1.5)
    place, velocity = one(shared, 600, gravity=0.0, attractor="point", attraction=pull, attractor_core=core,
                          attractor_x=0.0, attractor_y=radius + 0.5, emitter_height=0.5, emitter_tilt=90.0,
                          speed=(speed, speed))
    away = place - np.array([0.0, radius + 0.5, 0.0])
    np.testing.assert_allclose(np.linalg.norm(away, axis=1), radius, rtol=2e-3)
    np.testing.assert_allclose(np.linalg.norm(velocity, axis=1), speed, rtol=2e-3)
    turned = np.unwrap(np.arctan2(away[:, 1], away[:, 0]))
    period = 2 * math.pi * radius / speed
    assert abs(turned[-1] - turned[0]) == pytest.approx(2 * math.pi * 10.0 / period, rel=2e-3)


def test_an_ellipse_keeps_its_energy_and_its_area(shared: Stage) -> None:
    """Kepler's second law, and what measure() says of the energy."""
    options: dict[str, Any] = {"gravity": 0.0, "attractor": "point", "attraction": 20.0, "attractor_core": 0.01,
                               "attractor_y": 2.0, "emitter_tilt": 90.0, "speed": (2.2, 2.2)}
    place, velocity = one(shared, 600, **options)
    away = place - np.array([0.0, 2.0, 0.0])
    swept = np.cross(away, velocity)[:, 2]
    np.testing.assert_allclose(swept, swept[0], rtol=1e-3)
    total = 0.5 * (velocity**2).sum(axis=1) - 20.0 / np.sqrt((away**2).sum(axis=1) + 1e-4)
    assert np.ptp(total) < 0.02 * abs(total[0])
    measured = shared.measure()
    assert measured["kinetic_energy"] + measured["potential_energy"] == pytest.approx(total[-1], rel=1e-5)


def test_a_line_attracts_as_the_inverse_of_the_distance(shared: Stage) -> None:
    """Any circle around it has the same speed, and nothing pulls along it."""
    place, velocity = one(shared, 300, gravity=0.0, attractor="line", attraction=9.0, attractor_core=0.01,
                          attractor_x=0.0, attractor_z=-2.0, emitter_tilt=90.0, speed=(3.0, 3.0))
    away = place - np.array([0.0, 0.0, -2.0])
    np.testing.assert_allclose(np.hypot(away[:, 0], away[:, 2]), 2.0, rtol=2e-3)
    np.testing.assert_allclose(place[:, 1], 0.0, atol=1e-4)
    np.testing.assert_allclose(np.linalg.norm(velocity, axis=1), 3.0, rtol=2e-3)


def test_attraction_can_repel(shared: Stage) -> None:
    track = motion(shared, 30, gravity=0.0, attractor="point", attraction=-20.0, attractor_y=0.0, emitter="sphere")
    outward = (track["velocity"][-1] * track["position"][0]).sum(axis=-1)
    assert (outward > 1.0).all()


@pytest.mark.parametrize("strength", [4.0, -4.0])
def test_the_vortex_does_work(shared: Stage, strength: float) -> None:
    """From rest all are driven around the vertical, counter-clockwise seen from above where it is positive."""
    core, center = 0.3, np.array([0.5, 0.0, -0.25])
    track = motion(shared, 40, gravity=0.0, vortex=strength, attractor_core=core, attractor_x=0.5, attractor_z=-0.25,
                   emitter="ground", emitter_size=2.0, burst=300)
    away = track["position"][0] - center
    distance = np.hypot(away[:, 0], away[:, 2])
    around = np.stack([away[:, 2], 0 * distance, -away[:, 0]], axis=1)
    expected = 2 * strength * core * around / (distance**2 + core**2)[:, None]
    np.testing.assert_allclose(track["velocity"][1], expected * DT, atol=1e-5)
    assert np.linalg.norm(expected, axis=1).max() <= abs(strength)
    assert (np.diff(energy(track).sum(axis=1)) > 0.0).all()


# Bounces


def apexes(height: Numbers, velocity: Numbers, gravity: float = G) -> list[float]:
    """The heights reached between bounces, from the closed form through the frame next to each apex."""
    turning = np.flatnonzero((velocity[:-1] > 0) & (velocity[1:] <= 0))
    return [float(height[frame] + velocity[frame]**2 / (2 * gravity)) for frame in turning]


@pytest.mark.parametrize("restitution", [0.5, 0.6, 0.7, 0.8, 0.9, 0.95])
def test_apexes_fall_by_the_square_of_the_restitution(shared: Stage, restitution: float) -> None:
    """Five bounces, within 1 %."""
    place, velocity = one(shared, 400, ground=True, restitution=restitution, friction=0.0, emitter_height=2.0)
    heights = apexes(place[:, 1], velocity[:, 1])[:5]
    np.testing.assert_allclose(heights, 2.0 * restitution**(2 * np.arange(1, 6)), rtol=0.01)


@pytest.mark.parametrize("restitution", [0.5, 0.8])
def test_apexes_wherever_in_the_step_the_impact_falls(shared: Stage, restitution: float) -> None:
    """Dropped from many heights at once."""
    track = motion(shared, 260, ground=True, ground_height=-1.0, restitution=restitution, friction=0.0,
                   emitter="box", emit_from="volume", emitter_thickness=0.1, emitter_height=0.5, burst=40)
    height, velocity = track["position"][..., 1] + 1.0, track["velocity"][..., 1]
    for one_height, one_velocity in zip(height.T, velocity.T, strict=True):
        heights = apexes(one_height, one_velocity)[:5]
        assert len(heights) >= 3
        np.testing.assert_allclose(heights, one_height[0] * restitution**(2 * np.arange(1, 1 + len(heights))),
                                   rtol=0.01)


@pytest.mark.parametrize("restitution", [0.5, 0.7, 0.9])
def test_bounces_on_a_slope(shared: Stage, restitution: float) -> None:
    """Along its normal the heights above it fall as on level ground; along it, without friction, it slides freely."""
    tilt = math.radians(25.0)
    normal = np.array([-math.sin(tilt), math.cos(tilt), 0.0])
    along = np.array([math.cos(tilt), math.sin(tilt), 0.0])
    place, velocity = one(shared, 400, ground=True, ground_tilt=25.0, restitution=restitution, friction=0.0,
                          emitter_height=2.0)
    pull = G * math.cos(tilt)
    heights = apexes(place @ normal, velocity @ normal, pull)[:5]
    np.testing.assert_allclose(heights, 2.0 * math.cos(tilt) * restitution**(2 * np.arange(1, 6)), rtol=0.01)
    t = seconds(400)
    np.testing.assert_allclose(velocity @ along, -G * math.sin(tilt) * t, atol=0.01 * G * math.sin(tilt) * t[-1])


@pytest.mark.parametrize("restitution", [0.5, 0.7, 0.9])
def test_bounces_on_the_pole_of_a_sphere(shared: Stage, restitution: float) -> None:
    place, velocity = one(shared, 340, obstacle="sphere", obstacle_size=0.8, obstacle_y=0.0, emitter_height=2.8,
                          restitution=restitution, friction=0.0)
    heights = apexes(place[:, 1] - 0.8, velocity[:, 1])[:5]
    np.testing.assert_allclose(heights, 2.0 * restitution**(2 * np.arange(1, 6)), rtol=0.01)
    assert np.abs(place[:, [0, 2]]).max() < 1e-3


def test_with_full_restitution_it_comes_back_for_ever(shared: Stage) -> None:
    place, velocity = one(shared, 900, ground=True, restitution=1.0, friction=0.0, emitter_height=1.0)
    heights = apexes(place[:, 1], velocity[:, 1])
    assert len(heights) >= 15
    assert max(heights) < 1.0 + 1e-4
    assert heights[-1] > 0.97


@pytest.mark.parametrize("mirror", [0.0, 30.0, -50.0])
def test_it_is_reflected_as_light_is(shared: Stage, mirror: float) -> None:
    """Without gravity, drag or loss: the angles are equal, whatever the slope."""
    track = motion(shared, 60, gravity=0.0, ground=True, ground_tilt=mirror, ground_height=-1.0, restitution=1.0,
                   friction=0.0, emitter_tilt=180.0, speed=(4.0, 6.0), spread=25.0)
    tilt = math.radians(mirror)
    normal = np.array([-math.sin(tilt), math.cos(tilt), 0.0])
    before, after = track["velocity"][0], track["velocity"][-1]
    np.testing.assert_allclose(after, before - 2 * (before @ normal)[:, None] * normal, atol=1e-4)


@pytest.mark.parametrize("friction", [0.0, 0.1, 0.3, 0.8, 2.0])
@pytest.mark.parametrize("restitution", [0.0, 0.4, 1.0])
def test_an_impact_rubs_as_coulomb_has_it(shared: Stage, friction: float, restitution: float) -> None:
    """The velocity along the surface falls by friction times (1 + e) times that into it, at most to nothing."""
    track = motion(shared, 30, gravity=0.0, ground=True, ground_height=-1.0, restitution=restitution,
                   friction=friction, emitter_tilt=135.0, speed=(5.0, 9.0), spread=20.0, burst=200)
    before, after = track["velocity"][0], track["velocity"][-1]
    across, into = np.linalg.norm(before[:, [0, 2]], axis=1), -before[:, 1]
    left = np.maximum(0.0, 1 - friction * (1 + restitution) * into / across)
    np.testing.assert_allclose(after[:, [0, 2]], before[:, [0, 2]] * left[:, None], atol=2e-4)
    np.testing.assert_allclose(after[:, 1], restitution * into, atol=2e-4)


# Contact that lasts


@pytest.mark.parametrize(("tilt", "friction"), [(30.0, 0.0), (30.0, 0.2), (20.0, 0.1), (45.0, 0.5), (-35.0, 0.3)])
@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_it_slides_down_a_slope(shared: Stage, tilt: float, friction: float, restitution: float) -> None:
    """Put down at rest it is accelerated by g (sin - mu cos)."""
    angle = math.radians(abs(tilt))
    place, velocity = one(shared, 120, ground=True, ground_tilt=tilt, friction=friction, restitution=restitution)
    expected = G * (math.sin(angle) - friction * math.cos(angle))
    down = -math.copysign(1.0, tilt) * np.array([math.cos(math.radians(tilt)), math.sin(math.radians(tilt)), 0.0])
    t = seconds(120)
    np.testing.assert_allclose(velocity @ down, expected * t, atol=0.02 * expected * 2.0)
    np.testing.assert_allclose(place @ down, 0.5 * expected * t**2, atol=0.02 * expected * 2.0)


@pytest.mark.parametrize(("tilt", "friction"), [(30.0, 0.7), (20.0, 0.5), (-10.0, 0.2), (0.0, 0.0)])
def test_it_lies_still_where_friction_holds_it(shared: Stage, tilt: float, friction: float) -> None:
    place, velocity = one(shared, 240, ground=True, ground_tilt=tilt, friction=friction, emitter_height=0.0)
    assert np.linalg.norm(place, axis=1).max() < 2e-3
    assert np.abs(velocity[60:]).max() == 0.0
    assert np.ptp(place[60:], axis=0).max() == 0.0          # nor does it creep


def test_friction_stops_what_slides_on_level_ground(shared: Stage) -> None:
    """After v^2 / (2 mu g) metres."""
    place, velocity = one(shared, 240, ground=True, friction=0.3, restitution=0.0, emitter_tilt=90.0,
                          speed=(3.0, 3.0), emitter_height=0.0)
    assert place[-1, 0] == pytest.approx(9.0 / (2 * 0.3 * G), rel=0.02)
    assert np.linalg.norm(velocity[-1]) < 1e-3
    middle = 40
    assert velocity[middle, 0] == pytest.approx(3.0 - 0.3 * G * middle * DT, rel=0.03)


def test_all_come_to_rest(shared: Stage) -> None:
    """On level ground with loss and friction, without trembling, and none sinks in."""
    track = motion(shared, 30, 500, ground=True, restitution=0.5, friction=0.3, emitter_height=1.0, speed=(1.0, 4.0),
                   spread=60.0)
    assert np.abs(track["velocity"]).max() < 1e-3
    assert track["position"][..., 1].min() >= 0.0 and track["position"][..., 1].max() < 1e-3
    collisions = shared.measure()["collisions"]
    assert played(shared, 600) and shared.measure()["collisions"] == collisions     # lying is no striking


@pytest.mark.parametrize("surface", [{"ground": True, "ground_tilt": 20.0}, {"obstacle": "sphere", "obstacle_y": 0.0},
                                     {"obstacle": "torus", "obstacle_y": 0.0, "obstacle_size": 0.3}])
def test_what_sticks_stays_where_it_hit(shared: Stage, surface: dict[str, Any]) -> None:
    track = motion(shared, 90, 60, **surface, collision="stick", emitter_height=2.0, emitter="disc",
                   emitter_size=0.3, emitter_tilt=180.0, speed=(1.0, 8.0), burst=300)
    stuck = ~(track["velocity"] != 0.0).any(axis=(0, 2))
    assert stuck.any()
    assert np.ptp(track["position"][:, stuck], axis=0).max() == 0.0
    distance = outside(track["position"][-1, stuck], surface)
    assert distance.min() > -2e-6 and distance.max() < 2e-3
    assert shared.measure()["collisions"] == stuck.sum()


def test_what_dies_on_impact_is_gone(shared: Stage) -> None:
    """At the moment of the impact, having struck once."""
    set_anew(shared, {"ground": True, "collision": "die", "emitter_height": 2.0, "burst": 50, "speed": (0.0, 3.0),
                      "emitter_tilt": 180.0})
    launch = -played(shared, 0)["velocity"][:, 1].astype(np.float64)
    falls = (np.sqrt(launch**2 + 2 * G * 2.0) - launch) / G
    for frame in range(0, 45, 4):
        alive = len(played(shared, frame)["age"])
        assert alive == np.count_nonzero(falls > frame * DT)
        measured = shared.measure()
        assert measured["died"] == measured["collisions"] == 50 - alive


# Nothing inside anything, nothing through it


def rotated(points: Numbers, turn: float, lean: float) -> Numbers:
    """World places in the obstacle's own directions: turned back about y, then leant back about z."""
    a, b = math.radians(turn), math.radians(lean)
    x, y, z = points.T
    x, z = math.cos(a) * x - math.sin(a) * z, math.sin(a) * x + math.cos(a) * z
    return np.stack([math.cos(b) * x + math.sin(b) * y, -math.sin(b) * x + math.cos(b) * y, z], axis=1)


def outside(points: Numbers, values: dict[str, Any]) -> Numbers:
    """How far places (n, 3) are from what is solid, negative inside it; worked out by this file itself."""
    points = np.asarray(points, np.float64).reshape(-1, 3)
    nearest = np.full(len(points), np.inf)
    if values.get("ground"):
        tilt = math.radians(values.get("ground_tilt", 0.0))
        normal = np.array([-math.sin(tilt), math.cos(tilt), 0.0])
        nearest = (points - [0.0, values.get("ground_height", 0.0), 0.0]) @ normal
    shape, size, thickness = values.get("obstacle"), values.get("obstacle_size", 0.5), values.get(
        "obstacle_thickness", 0.2)
    center = [values.get(f"obstacle_{axis}", default) for axis, default in zip("xyz", (0.0, 1.0, 0.0), strict=True)]
    local = rotated(points - center, values.get("obstacle_turn", 0.0), values.get("obstacle_lean", 0.0))
    if shape == "sphere":
        found = np.linalg.norm(local, axis=1) - size
    elif shape == "torus":
        found = np.hypot(np.hypot(local[:, 0], local[:, 2]) - size, local[:, 1]) - thickness
    elif shape == "box":
        beyond = np.abs(local) - [size, thickness, size]
        found = np.linalg.norm(np.maximum(beyond, 0.0), axis=1) + np.minimum(beyond.max(axis=1), 0.0)
    else:
        return nearest
    return np.minimum(nearest, -found if values.get("hollow") else found)


OBSTACLES: dict[str, dict[str, Any]] = {
    "sphere": {"obstacle": "sphere", "obstacle_size": 0.7},
    "box": {"obstacle": "box", "obstacle_turn": 30.0, "obstacle_lean": 20.0},
    "torus": {"obstacle": "torus", "obstacle_size": 0.7, "obstacle_lean": 35.0},
    "vessel": {"obstacle": "sphere", "obstacle_size": 1.0, "hollow": True},
    "chest": {"obstacle": "box", "obstacle_size": 0.8, "obstacle_thickness": 0.6, "hollow": True,
              "obstacle_lean": 20.0},
    "tube": {"obstacle": "torus", "obstacle_size": 1.0, "obstacle_thickness": 0.3, "hollow": True},
}


@pytest.mark.parametrize("restitution", [0.0, 0.8])
@pytest.mark.parametrize("name", OBSTACLES)
def test_nobody_is_inside_what_is_solid(shared: Stage, name: str, restitution: float) -> None:
    """At no frame, on a slope that leans against the obstacle, with others arriving all the time."""
    values = {**OBSTACLES[name], "ground": not name.startswith(("vessel", "chest", "tube")), "ground_height": 0.3,
              "ground_tilt": 15.0, "restitution": restitution, "friction": 0.3}
    inside = bool(values.get("hollow"))
    emitter = {"emitter": "torus", "emitter_size": 1.0, "emitter_thickness": 0.1, "emit_from": "volume",
               "emitter_height": 1.0} if name == "tube" else {
        "emitter": "sphere", "emitter_size": 0.3, "emitter_height": 1.0 if inside else 3.0, "emit_from": "volume"}
    set_anew(shared, {**values, **emitter, "burst": 500, "rate": 600.0, "speed": (0.0, 12.0), "spread": 180.0,
                      "lifetime": (1.5, 3.0)})
    for frame in (*range(0, 40), *range(40, 120, 7)):
        found = played(shared, frame)
        assert np.isfinite(found["position"]).all() and np.isfinite(found["velocity"]).all()
        distance = outside(found["position"], values)
        assert distance.min() > -3e-6, (frame, distance.min())
    assert shared.measure()["collisions"] > 100


@pytest.mark.parametrize("speed", [20.0, 77.0, 200.0])
@pytest.mark.parametrize("plate", [
    {"obstacle": "box", "obstacle_size": 5.0, "obstacle_thickness": 0.01},
    {"obstacle": "box", "obstacle_size": 8.0, "obstacle_thickness": 0.02, "obstacle_lean": 40.0}])
def test_nothing_tunnels_through_a_thin_plate(shared: Stage, speed: float, plate: dict[str, Any]) -> None:
    """Fired at it from above and everywhere in the step; below it nobody ever is."""
    values = {**plate, "obstacle_y": 0.0, "restitution": 0.5}
    set_anew(shared, {**values, "emitter_height": 1.7, "emitter": "disc", "emitter_tilt": 180.0, "spread": 50.0,
                      "speed": (0.8 * speed, speed), "rate": 6000.0, "lifetime": (0.1, 0.1)})
    lean = math.radians(plate.get("obstacle_lean", 0.0))
    normal = np.array([-math.sin(lean), math.cos(lean), 0.0])
    for frame in range(1, 13):
        found = played(shared, frame)["position"].astype(np.float64)
        over = np.abs(rotated(found, 0.0, plate.get("obstacle_lean", 0.0))[:, [0, 2]]).max(axis=1) < 3.0
        assert (found[over] @ normal > 0.0).all()
        assert outside(found, values).min() > -3e-6
    assert shared.measure()["collisions"] > 100


def test_nothing_tunnels_through_a_bead(shared: Stage) -> None:
    """A ball of a centimetre in the way of 200 m/s is hit at once, from wherever in the step they come."""
    set_anew(shared, {"obstacle": "sphere", "obstacle_size": 0.01, "obstacle_y": 1.2345, "collision": "die",
                      "gravity": 0.0, "speed": (50.0, 200.0), "rate": 6000.0, "lifetime": (2.0, 2.0)})
    found = played(shared, 30)
    assert shared.measure()["emitted"] == 3000
    assert (found["position"][:, 1] < 1.2345).all()


def test_nothing_leaps_from_one_side_of_a_tube_to_the_other(shared: Stage) -> None:
    """Inside a hollow ring what flies towards the ring's middle hits the near wall, however fast."""
    set_anew(shared, {"obstacle": "torus", "obstacle_size": 1.0, "obstacle_thickness": 0.3, "obstacle_x": 1.0,
                      "obstacle_y": 0.0, "hollow": True, "collision": "stick", "gravity": 0.0, "emitter_tilt": 90.0,
                      "speed": (20.0, 200.0), "burst": 300})
    found = played(shared, 10)
    np.testing.assert_allclose(found["position"], np.tile([0.3, 0.0, 0.0], (300, 1)), atol=2e-3)


def test_who_is_on_the_way_tunnels_no_more_when_others_get_slow(shared: Stage) -> None:
    """What is in flight keeps its speed when the parameter falls, and is watched as closely as before."""
    ball = {"obstacle": "sphere", "obstacle_size": 0.5, "obstacle_x": 19.0, "obstacle_y": 0.0, "collision": "stick"}
    set_anew(shared, {**ball, "burst": 300, "gravity": 0.0, "speed": (100.0, 200.0), "emitter_tilt": 90.0})
    shared.seek(3)
    shared.set(speed=(1.0, 1.0))
    found = played(shared, 30)["position"]
    np.testing.assert_allclose(found, np.tile([18.5, 0.0, 0.0], (300, 1)), atol=2e-3)


@pytest.mark.parametrize("turbulence", [0.0, 5.0])
def test_an_obstacle_that_is_put_where_particles_are_pushes_them_out(shared: Stage, turbulence: float) -> None:
    set_anew(shared, {"burst": 2000, "emitter": "sphere", "emitter_size": 1.0, "emitter_height": 1.0,
                      "emit_from": "volume", "gravity": 0.0, "turbulence": turbulence})
    shared.seek(5)
    shared.set(obstacle="sphere", obstacle_size=0.6)
    found = played(shared, 6)["position"]
    assert len(found) == 2000
    assert outside(found, {"obstacle": "sphere", "obstacle_size": 0.6}).min() > -3e-6


# Energy


@pytest.mark.parametrize("restitution", [1.0, 0.9, 0.0])
@pytest.mark.parametrize("name", OBSTACLES)
def test_energy_never_grows(shared: Stage, name: str, restitution: float) -> None:
    """Of each particle, but for rounding, and so of all of them; with gravity and an obstacle and a slope."""
    values = {**OBSTACLES[name], "ground": True, "ground_height": 0.2, "ground_tilt": 10.0,
              "restitution": restitution, "friction": 0.0}
    emitter = {"emitter": "torus", "emitter_size": 1.0, "emitter_thickness": 0.1, "emitter_height": 1.0} \
        if name == "tube" else {"emitter": "sphere", "emitter_size": 0.3,
                                "emitter_height": 1.0 if "hollow" in values else 3.0}
    track = motion(shared, 90, **values, **emitter, emit_from="volume", speed=(0.0, 5.0), spread=180.0, burst=300)
    joules = energy(track, G)
    scale = np.abs(joules).max()
    assert (np.diff(joules, axis=0).max() < 1e-4 * scale)
    assert (joules[1:].sum(axis=1) <= joules[0].sum() * (1 + 1e-5)).all()
    gained = (joules[-1] - joules[0]).max()
    assert gained < 1e-3 * scale


def test_a_box_of_bouncing_balls_keeps_its_energy(shared: Stage) -> None:
    """A long run in a vessel without loss: none is won, and not much is lost."""
    set_anew(shared, {"obstacle": "box", "obstacle_size": 0.8, "obstacle_thickness": 0.6, "hollow": True,
                      "obstacle_y": 1.0, "emitter": "sphere", "emitter_size": 0.3, "emitter_height": 1.0,
                      "restitution": 1.0, "friction": 0.0, "speed": (1.0, 5.0), "spread": 180.0, "burst": 400})
    total = []
    for frame in range(0, 901, 60):
        shared.seek(frame)
        measured = shared.measure()
        total.append(float(measured["kinetic_energy"]) + float(measured["potential_energy"]))  # type: ignore[arg-type]
    assert (np.diff(total) < 1e-5 * total[0]).all()
    assert total[-1] > 0.8 * total[0]


def test_grazing_a_thin_plate_wins_no_energy(shared: Stage) -> None:
    """Where a path has to be searched through with many small steps."""
    track = motion(shared, 20, obstacle="box", obstacle_size=20.0, obstacle_thickness=0.01, obstacle_y=-0.02,
                   emitter_tilt=89.9, speed=(100.0, 200.0), spread=0.3, restitution=1.0, friction=0.0, burst=200)
    joules = energy(track, G)
    assert np.diff(joules, axis=0).max() < 1e-4 * joules.max()


def test_what_is_measured_is_what_is_there(shared: Stage) -> None:
    set_anew(shared, {"ground": True, "rate": 500.0, "speed": (2.0, 6.0), "spread": 40.0, "mass": (0.1, 3.0),
                      "lifetime": (0.2, 0.9)})
    found, measured = played(shared, 80), shared.measure()
    mass, squared = found["mass"].astype(np.float64), (found["velocity"].astype(np.float64)**2).sum(axis=1)
    assert measured["alive"] == len(mass)
    assert measured["kinetic_energy"] == pytest.approx(0.5 * mass @ squared, rel=1e-6)
    assert measured["potential_energy"] == pytest.approx(G * mass @ found["position"][:, 1], rel=1e-5)
    assert measured["fastest"] == pytest.approx(math.sqrt(squared.max()), rel=1e-6)
    assert measured["step_ms"] > 0.0        # type: ignore[operator]


# Stress


def test_a_stall_of_the_window_is_no_leap(shared: Stage) -> None:
    """After five seconds without a frame it goes on by a handful of steps, each as long as ever."""
    values = {"obstacle": "box", "obstacle_size": 5.0, "obstacle_thickness": 0.01, "obstacle_y": 0.0}
    set_anew(shared, {**values, "emitter_height": 1.0, "rate": 3000.0, "speed": (5.0, 60.0), "emitter_tilt": 180.0,
                      "spread": 60.0, "lifetime": (0.3, 0.3)})
    shared.seek(20)
    assert 1 <= shared.advance(5.0) <= 10
    stalled: dict[str, NDArray[Any]] = shared.geometry()
    frame = shared.frame
    set_anew(shared, {**values, "emitter_height": 1.0, "rate": 3000.0, "speed": (5.0, 60.0), "emitter_tilt": 180.0,
                      "spread": 60.0, "lifetime": (0.3, 0.3)})
    for name, found in played(shared, frame).items():
        assert found.tobytes() == stalled[name].tobytes()
    assert (stalled["position"][np.abs(stalled["position"]).max(axis=1) < 4.9][:, 1] > 0.0).all()
