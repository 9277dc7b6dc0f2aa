"""The clock: scene time in whole frames, whatever the wall clock does."""

from __future__ import annotations

import random

import pytest

from viewer.engine.clock import FRAME_SECONDS, MOST_STEPS_AT_ONCE, SPEEDS, Clock


@pytest.mark.parametrize("speed", SPEEDS)
@pytest.mark.parametrize("rate", [50, 60, 61.7, 144])
def test_frames_keep_pace_with_the_wall(speed: float, rate: float) -> None:
    """In ten seconds of unsteady pictures, sixty steps a second times the speed, none lost to rounding."""
    chance = random.Random(1)
    clock = Clock()
    clock.speed = speed
    passed, steps = 0.0, 0
    while passed < 10.0:
        seconds = chance.uniform(0.5, 1.5) / rate
        passed += seconds
        steps += clock.steps_due(seconds)
    assert abs(steps - passed * 60 * speed) <= 1


def test_a_stall_is_not_caught_up() -> None:
    """After a minute's sleep a handful of steps, then on as usual."""
    clock = Clock()
    assert clock.steps_due(60.0) == MOST_STEPS_AT_ONCE
    assert clock.steps_due(1.5 * FRAME_SECONDS) in (1, 2)
    assert clock.steps_due(-5.0) == 0


def test_pausing_stops_and_forgets_the_rest() -> None:
    """No step while paused, and none left over from before."""
    clock = Clock()
    clock.steps_due(0.9 * FRAME_SECONDS)
    clock.toggle()
    assert not clock.playing
    assert clock.steps_due(10.0) == 0
    clock.toggle()
    assert clock.steps_due(0.9 * FRAME_SECONDS) == 0


def test_scene_time_follows_from_the_frame() -> None:
    """A sixtieth of a second each."""
    clock = Clock()
    clock.frame = 90
    assert clock.seconds == pytest.approx(1.5)
