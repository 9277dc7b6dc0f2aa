"""How many particles are due, and when: whatever the steps, the same births at the same moments."""

from __future__ import annotations

import itertools
from fractions import Fraction

import numpy as np
import pytest
from numpy.typing import NDArray

from viewer.engine.clock import FRAME_SECONDS
from viewer.engine.particles.qualities import EmissionParameters
from viewer.engine.particles.schedule import Births, Schedule

STEPS = [1 / 60, 1 / 30, 1 / 50, 1 / 24, 1 / 144, 1 / 1000, 0.1, 1 / 3, 1.0, 0.0123456789, 20.0]


def schedule(**values: object) -> Schedule:
    return Schedule(EmissionParameters({"rate": 0.0, **values}))


def moments(births: list[Births], end: float) -> list[float]:
    """When each was born, in seconds since the start, for births in a step that ends at ``end``."""
    return [end - due.lived + number * due.between for due in births for number in range(due.number)]


def played(some: Schedule, seconds: float, step: float = FRAME_SECONDS) -> list[float]:
    """The moments of all births in so many seconds, the first included; the last step may be shorter."""
    born = moments(some.first(), 0.0)
    passed, whole = 0.0, int(seconds / step + 1e-9)
    for duration in [step] * whole + [seconds - whole * step] * (seconds - whole * step > 1e-9):
        passed += duration
        born += moments(some.due(duration), passed)
    return born


def number(births: list[Births]) -> int:
    return sum(due.number for due in births)


@pytest.mark.parametrize("step", STEPS)
def test_a_rate_of_37_3_gives_746_in_20_seconds_at_every_step(step: float) -> None:
    assert len(played(schedule(rate=37.3), 20.0, step)) in (745, 746)


def test_steps_of_any_length_mixed_give_the_same_number() -> None:
    steps = np.random.default_rng(3).exponential(0.01, 4000)
    some = schedule(rate=37.3)
    found = sum(number(some.due(float(step))) for step in steps)
    assert abs(found - 37.3 * steps.sum()) <= 1.0 + 1e-6


@pytest.mark.parametrize("rate", [0.05, 1.0, 37.3, 60.0, 59.999, 600.0, 12345.6, 5e6])
def test_no_particle_is_lost_or_won_in_ten_minutes(rate: float) -> None:
    """After each of 36,000 frames the number is the whole part of rate times time, but for rounding."""
    some, born = schedule(rate=rate), 0
    for frame in range(1, 36_001):
        born += number(some.due(FRAME_SECONDS))
        if frame % 360 == 0:
            exact = float(Fraction(rate) * frame / 60)
            assert exact - 1.001 <= born <= exact + 0.001


@pytest.mark.parametrize("rate", [7.0, 37.3, 60.0, 61.3, 1234.5])
@pytest.mark.parametrize("step", [1 / 60, 0.0123456789, 0.25])
def test_births_are_equally_far_apart_across_the_borders_of_steps(rate: float, step: float) -> None:
    born = np.array(played(schedule(rate=rate), 5.0, step))
    np.testing.assert_allclose(np.diff(born), 1.0 / rate, atol=1e-9)
    assert born[0] == pytest.approx(1.0 / rate, abs=1e-9)


@pytest.mark.parametrize("rate", [37.3, 60.0, 5e6, 0.3])
def test_each_birth_lies_within_its_step(rate: float) -> None:
    some = schedule(rate=rate, burst=3, burst_every=0.0371)
    some.first()
    for _ in range(2000):
        for due in some.due(FRAME_SECONDS):
            last = due.lived - (due.number - 1) * due.between
            assert -1e-9 <= last <= due.lived <= FRAME_SECONDS + 1e-9
            assert due.number > 0


def test_without_rate_or_burst_nobody_is_born() -> None:
    assert played(schedule(), 3.0) == []


def test_one_burst_is_there_at_the_very_start_and_never_again() -> None:
    some = schedule(burst=50)
    assert some.first() == [Births(50, 0.0)]
    assert all(some.due(FRAME_SECONDS) == [] for _ in range(600))


@pytest.mark.parametrize("every", [0.1, 0.25, 1 / 60, 0.7, 0.013])
@pytest.mark.parametrize("step", [1 / 60, 0.01, 0.3])
def test_bursts_come_at_whole_multiples_of_their_period(every: float, step: float) -> None:
    born = np.array(played(schedule(burst=2, burst_every=every), 6.0, step)).reshape(-1, 2)
    np.testing.assert_allclose(born, np.repeat(np.arange(len(born))[:, None] * every, 2, axis=1), atol=1e-8)
    assert abs(len(born) - (6.0 / every + 1)) <= 1


def test_many_bursts_do_not_drift() -> None:
    """The ten thousandth comes when ten thousand periods have passed."""
    born = played(schedule(burst=1, burst_every=0.1), 600.0)
    np.testing.assert_allclose(born, 0.1 * np.arange(len(born)), atol=1e-7)
    assert len(born) == 6001


def test_bursts_and_rate_add_up() -> None:
    assert len(played(schedule(burst=5, burst_every=0.5, rate=37.3), 20.0)) in (745 + 205, 746 + 205)


@pytest.mark.parametrize("step", [1 / 60, 0.1, 0.37, 5.0])
def test_the_emitter_runs_dry_in_the_middle_of_a_step(step: float) -> None:
    born = played(schedule(rate=100.0, burst=1, burst_every=0.4, emit_until=1.23), 5.0, step)
    steady = sorted(born)[-1]
    assert steady <= 1.23 + 1e-9
    assert len(born) == 123 + 4         # bursts at 0, 0.4, 0.8 and 1.2


def test_a_dry_emitter_goes_on_when_it_is_given_more_time() -> None:
    """From there on, without what it has missed."""
    some = schedule(rate=60.0, burst=10, burst_every=0.5, emit_until=1.0)
    played(some, 5.0)
    some.params.update({"emit_until": 100.0})
    later = [number(some.due(FRAME_SECONDS)) for _ in range(60)]
    assert sum(later) == pytest.approx(60 + 30, abs=1)      # bursts at 5, 5.5 and 6 seconds
    assert max(later) <= 11


def test_the_rate_may_change_at_any_time() -> None:
    some, expected, born = schedule(rate=0.0), 0.0, 0
    generator = np.random.default_rng(8)
    for rate in generator.uniform(0.0, 500.0, 200):
        some.params.update({"rate": float(rate)})
        for _ in range(int(generator.integers(1, 9))):
            born += number(some.due(FRAME_SECONDS))
            expected += rate * FRAME_SECONDS
            assert abs(born - expected) <= 1.0 + 1e-6
    for _ in range(60):
        some.params.update({"rate": 0.0})
        assert some.due(FRAME_SECONDS) == []


def test_a_lower_rate_does_not_delay_births_beyond_reason() -> None:
    """What is owed at a high rate is owed at a low one: the next comes within one period."""
    some = schedule(rate=5e6)
    some.due(0.0123)
    some.params.update({"rate": 2.0})
    assert number(some.due(0.5)) == 1


@pytest.mark.parametrize(("before", "after"), [(0.1, 1.0), (10.0, 0.1), (0.0, 0.5), (1.0, 0.0)])
def test_a_new_period_of_bursts_counts_from_now(before: float, after: float) -> None:
    """Neither are bursts that never were due made up for, nor is there silence longer than one period."""
    some = schedule(burst=1, burst_every=before)
    played(some, 20.0)
    some.params.update({"burst_every": after})
    later = [number(some.due(FRAME_SECONDS)) for _ in range(600)]
    assert max(later) <= 1
    if after == 0.0:
        assert sum(later) == 0
    else:
        assert abs(sum(later) - 10.0 / after) <= 1


def test_a_burst_asked_for_later_comes_once() -> None:
    """Not once for each period since the start."""
    some = schedule(burst=0, burst_every=1.0)
    played(some, 20.0)
    some.params.update({"burst": 7})
    later = [number(some.due(FRAME_SECONDS)) for _ in range(120)]
    assert max(later) == 7
    assert sum(later) in (14, 21)
    single = schedule(burst=0)
    played(single, 20.0)
    single.params.update({"burst": 7})
    assert sum(number(single.due(FRAME_SECONDS)) for _ in range(120)) == 7


def test_a_period_shorter_than_a_step_does_not_run_into_debt() -> None:
    """Bursts far too close together are not saved up for later."""
    some = schedule(burst=1, burst_every=1e-5)
    played(some, 1.0)
    some.params.update({"burst_every": 0.5})
    later = [number(some.due(FRAME_SECONDS)) for _ in range(120)]
    assert max(later) <= 1
    assert sum(later) in (3, 4, 5)


def test_a_state_put_back_gives_the_same_births() -> None:
    some = schedule(rate=37.3, burst=3, burst_every=0.21)
    played(some, 3.21)
    kept = some.state()
    ahead: list[list[Births]] = [some.due(FRAME_SECONDS) for _ in range(50)]
    other = schedule(rate=37.3, burst=3, burst_every=0.21)
    for one in (some, other):
        one.restore(kept)
        assert [one.due(FRAME_SECONDS) for _ in range(50)] == ahead


def test_a_wave_ends_when_it_has_run_over_the_sphere() -> None:
    """Half a turn round the sphere and its own width: then nobody is born any more."""
    some = schedule(rate=1000.0, emitter="sphere", emitter_size=2.0, wave_speed=1.5, wave_width=0.3)
    born: NDArray[np.float64] = np.array(played(some, 10.0))
    ends = (2.0 * np.pi + 0.3) / 1.5
    assert born.max() == pytest.approx(ends, abs=2e-3)
    assert born.max() <= ends
    assert len(born) == int(1000.0 * ends)


def test_steps_of_no_length_change_nothing() -> None:
    some = schedule(rate=37.3, burst=2, burst_every=0.5)
    some.first()
    total = sum(number(some.due(step)) for step in itertools.chain(*([0.0, FRAME_SECONDS, 0.0] for _ in range(1200))))
    assert total in (745 + 80, 746 + 80)
