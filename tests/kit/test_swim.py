"""Swimming: closed forms of the bent body, that it never stretches, how the wave travels, and exact normals."""

from __future__ import annotations

import math
from itertools import product

import numpy as np
import pytest
from numpy.typing import NDArray

from viewer.kit.swim import STEEPEST, Swim, gauss_legendre

Numbers = NDArray[np.float64]
STRAIGHT = Swim(amplitude=0.0)
PLACES = np.linspace(0.0, 1.0, 2001)
PHASES = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False)
# The corners of what the parameters allow, and the middle.
BOX = [Swim(*numbers) for numbers in product((0.0, 0.1, 0.25), (0.6, 1.0, 3.0), (0.0, 0.5, 1.0))]
TURNS = np.radians([-120.0, -30.0, 0.0, 120.0])
EVERYTHING = Swim(amplitude=0.11, wavelength=0.9, stiffness=0.4, sway=0.1, yaw=0.3, roll=0.4, twist=0.5)


def points_in_fish(count: int, seed: int = 1) -> tuple[Numbers, Numbers]:
    """Random points where a fish is, which is thin at its tail, and random unit normals, (count, 3) each."""
    random = np.random.default_rng(seed)
    points = random.uniform([-0.5, -0.15, -0.1], [0.5, 0.15, 0.1], (count, 3))
    points[:, 2] *= np.clip(points[:, 0] + 0.5, 0.1, 1.0)
    normals = random.normal(size=(count, 3))
    return points, normals / np.linalg.norm(normals, axis=1, keepdims=True)


def degrees_between(first: Numbers, second: Numbers) -> Numbers:
    """Angles between vectors (n, 3)."""
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(first, second), axis=1), (first * second).sum(axis=1)))


def test_a_fish_that_does_nothing_stays_straight() -> None:
    """Neither points nor normals move, before the nose and behind the tail too."""
    points, normals = points_in_fish(500)
    points[:, 0] *= 1.3
    moved, turned = STRAIGHT.deform(points, normals, 1.7)
    np.testing.assert_allclose(moved, points, atol=1e-14)
    np.testing.assert_allclose(turned, normals, atol=1e-14)


@pytest.mark.parametrize("turn", [-2.0, -0.4, 1e-6, 0.7, 2.0])
def test_a_turn_bends_the_body_into_an_arc(turn: float) -> None:
    """Of radius 1 / turn about a point to its left, where -z is, the middle staying where it is."""
    angle = turn * (0.5 - PLACES)
    arc = np.stack([np.sin(angle), np.cos(angle) - 1.0], axis=1) / turn
    np.testing.assert_allclose(STRAIGHT.midline(PLACES, 0.3, turn), arc, atol=1e-9)


def test_the_nose_points_into_the_turn() -> None:
    """To the left for a positive one: the nose ends up towards -z, half the turn away from straight ahead."""
    nose = STRAIGHT.body(0.0, 0.0, math.radians(60.0))
    np.testing.assert_allclose(nose.forward, [math.cos(math.radians(30.0)), -math.sin(math.radians(30.0))])
    assert nose.place[1] < 0.0


@pytest.mark.parametrize("swim", BOX)
def test_the_middle_line_swings_as_the_formula_says(swim: Swim) -> None:
    """Sideways by reach * e(s) sin(phase - 2 pi s / wavelength), s being counted along the bent body."""
    s, phase = PLACES[::20, None], PHASES[None]
    c0, c1, c2, c4 = swim.envelope
    expected = swim.reach * (c0 + c1 * s + c2 * s**2 + c4 * s**4) * np.sin(phase - 2.0 * np.pi * s / swim.wavelength)
    np.testing.assert_allclose(swim.midline(s, phase)[..., 1], expected, atol=1e-7)


@pytest.mark.parametrize("swim", BOX)
def test_the_body_never_stretches(swim: Swim) -> None:
    """Whatever the wave, the turn and the moment: as a whole and piece by piece, within a thousandth of the 2 %."""
    for turn in TURNS:
        line = swim.midline(PLACES, np.array([[0.3], [1.5], [2.6]]), turn)     # half a beat later it is mirrored
        pieces = np.linalg.norm(np.diff(line, axis=1), axis=2)
        np.testing.assert_allclose(pieces.sum(axis=1), 1.0, atol=2e-5)
        np.testing.assert_allclose(pieces * (len(PLACES) - 1), 1.0, atol=2e-4)


@pytest.mark.parametrize("swim", BOX)
def test_the_tail_swings_by_the_reach_and_the_head_by_less(swim: Swim) -> None:
    """The further to the tail, the wider; a stiff fish moves little but its tail."""
    widths = np.abs(swim.midline(PLACES[::100], np.linspace(0.0, 2.0 * np.pi, 721)[:, None])[..., 1]).max(axis=0)
    assert widths[-1] == pytest.approx(swim.reach, rel=1e-4)
    assert (np.diff(widths) >= 0.0).all()
    assert widths[0] <= 0.13 * swim.reach + 1e-9
    middle = widths[len(widths) // 2]
    assert middle < 0.1 * swim.reach + 1e-9 if swim.stiffness == 1.0 else middle >= 0.15 * swim.reach


def test_a_stiff_fish_moves_less_of_its_body() -> None:
    """At any place but the ends, the stiffer the less."""
    widths = [Swim(stiffness=stiffness).envelope @ np.array([1.0, 0.5, 0.25, 0.0625])
              for stiffness in (0.0, 0.25, 0.5, 0.75, 1.0)]
    assert (np.diff(widths) < -0.05).all()


def test_the_amplitude_is_reached_unless_the_body_had_to_stretch() -> None:
    """The steepest slope of all, the tail's, by differences, is as steep as may be exactly where less is reached."""
    limited = 0
    for swim in BOX:
        near_tail = PLACES[-5:]
        sideways = swim.midline(near_tail, np.linspace(0.0, np.pi, 181)[:, None])[..., 1]
        steepest = np.abs(np.gradient(sideways, near_tail, axis=1)).max()
        assert swim.reach <= swim.amplitude
        if swim.reach < swim.amplitude:
            limited += 1
            assert steepest == pytest.approx(STEEPEST, abs=2e-3)
        else:
            assert steepest <= STEEPEST + 1e-9
    assert 3 < limited < len(BOX) - 3


@pytest.mark.parametrize(("hz", "wavelength", "stiffness"), [(1.0, 0.6, 0.0), (2.5, 1.0, 0.5), (0.7, 2.2, 1.0)])
def test_the_wave_travels_at_frequency_times_wavelength(hz: float, wavelength: float, stiffness: float) -> None:
    """The phase of the sideways motion, by Fourier's sum over a beat, falls by 2 pi with each wavelength."""
    swim = Swim(amplitude=0.08, wavelength=wavelength, stiffness=stiffness)
    seconds = np.arange(64) / 64.0 / hz
    sideways = swim.midline(PLACES[:, None], 2.0 * np.pi * hz * seconds)[..., 1]
    beat = np.unwrap(np.angle(sideways @ np.exp(-2j * np.pi * hz * seconds)))
    delay = -np.polyfit(PLACES, beat, 1)[0] / (2.0 * np.pi * hz)        # seconds for each body length
    assert 1.0 / delay == pytest.approx(hz * wavelength, rel=1e-6)


@pytest.mark.parametrize("swim", [EVERYTHING, *BOX[9:12], Swim(twist=1.0, amplitude=0.0), Swim(roll=1.0, twist=0.3)])
def test_normals_are_those_of_the_deformed_surface(swim: Swim) -> None:
    """Against the cofactors of the deformation's central differences."""
    points, normals = points_in_fish(400)
    points[:, 0] *= 0.99
    for phase, turn in ((0.4, 0.0), (2.9, 1.1), (5.0, -2.0)):
        jacobian = np.empty((len(points), 3, 3))
        for axis in range(3):
            step = 1e-5 * np.eye(3)[axis]
            ahead, behind = (swim.deform(points + sign * step, normals, phase, turn)[0] for sign in (1.0, -1.0))
            jacobian[:, :, axis] = (ahead - behind) / 2e-5
        determinant = np.linalg.det(jacobian)
        assert (determinant > 0.0).all()
        wanted = determinant[:, None] * np.einsum("nij,nj->ni", np.linalg.inv(jacobian).transpose(0, 2, 1), normals)
        assert degrees_between(swim.deform(points, normals, phase, turn)[1], wanted).max() < 1e-4


def test_normals_have_length_one() -> None:
    """Wherever the point is."""
    points, normals = points_in_fish(400)
    points[:, 0] *= 1.2
    np.testing.assert_allclose(np.linalg.norm(EVERYTHING.deform(points, normals, 1.0, 0.5)[1], axis=1), 1.0)


@pytest.mark.parametrize("swim", [Swim(amplitude=0.0, sway=0.1), Swim(amplitude=0.0, yaw=0.5),
                                  Swim(amplitude=0.0, roll=0.5)])
def test_sway_yaw_and_roll_move_the_fish_as_a_whole(swim: Swim) -> None:
    """Distances stay, and with them what the fish looks like."""
    points, normals = points_in_fish(100)
    moved, turned = swim.deform(points, normals, 1.1)
    assert np.abs(moved - points).max() > 0.02
    before, after = (np.linalg.norm(each[:, None] - each[None], axis=2) for each in (points, moved))
    np.testing.assert_allclose(after, before, atol=1e-12)
    angles = [each @ each.T for each in (normals, turned)]
    np.testing.assert_allclose(angles[1], angles[0], atol=1e-12)


def test_what_sway_yaw_and_roll_are() -> None:
    """At a quarter of the beat: to the right, the nose to the left, and the back to the right."""
    nose, back = np.array([0.5, 0.0, 0.0]), np.array([0.0, 0.1, 0.0])
    up = np.array([0.0, 1.0, 0.0])
    quarter = 0.5 * np.pi
    np.testing.assert_allclose(Swim(amplitude=0.0, sway=0.1).deform(nose, up, quarter)[0], [0.5, 0.0, 0.1], atol=1e-12)
    yawed = Swim(amplitude=0.0, yaw=0.3).deform(nose, up, quarter)[0]
    np.testing.assert_allclose(yawed, [0.5 * math.cos(0.3), 0.0, -0.5 * math.sin(0.3)], atol=1e-12)
    rolled, turned = Swim(amplitude=0.0, roll=0.3).deform(back, up, quarter)
    np.testing.assert_allclose(rolled, [0.0, 0.1 * math.cos(0.3), 0.1 * math.sin(0.3)], atol=1e-12)
    np.testing.assert_allclose(turned, [0.0, math.cos(0.3), math.sin(0.3)], atol=1e-12)


def test_a_twist_turns_each_cross_section_about_the_middle_line() -> None:
    """By twist * e(s) sin(phase - k s), which leaves the middle line alone."""
    swim = Swim(amplitude=0.0, twist=0.6, wavelength=1.3, stiffness=0.2)
    s = PLACES[::50]
    across = np.stack([0.5 - s, np.full_like(s, 0.1), np.zeros_like(s)], axis=1)
    moved = swim.deform(across, across, 0.8)[0]
    angle = np.arctan2(moved[:, 2], moved[:, 1])
    envelope = swim.envelope @ np.stack([np.ones_like(s), s, s**2, s**4])
    np.testing.assert_allclose(angle, 0.6 * envelope * np.sin(0.8 - 2.0 * np.pi * s / 1.3), atol=1e-9)
    np.testing.assert_allclose(moved[:, 0], across[:, 0], atol=1e-12)


def test_parts_add_up_to_the_whole_beat() -> None:
    """After a beat everything is where it was."""
    points, normals = points_in_fish(50)
    for moved, again in zip(EVERYTHING.deform(points, normals, 0.9, 0.4),
                            EVERYTHING.deform(points, normals, 0.9 + 2.0 * np.pi, 0.4), strict=True):
        np.testing.assert_allclose(moved, again, atol=1e-12)


def test_beyond_nose_and_tail_the_body_goes_on_straight() -> None:
    """Along the directions that it has at its ends."""
    for end, beyond in ((0.5, 0.6), (-0.5, -0.6)):
        points = np.array([[end, 0.0, 0.0], [beyond, 0.0, 0.0]])
        moved, _ = Swim(amplitude=0.1).deform(points, points, 2.0)
        forward = Swim(amplitude=0.1).body(0.5 - end, 2.0).forward
        np.testing.assert_allclose((moved[1] - moved[0])[[0, 2]], (beyond - end) * forward, atol=1e-12)


@pytest.mark.parametrize("count", [1, 5, 10, 32])
def test_the_rule_of_integration_is_exact_for_polynomials(count: int) -> None:
    """Up to the degree 2 n - 1, from 0 to 1."""
    places, weights = gauss_legendre(count)
    for degree in range(2 * count):
        assert weights @ places**degree == pytest.approx(1.0 / (degree + 1), rel=1e-12)
