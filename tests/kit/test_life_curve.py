"""Curves over a life: against SciPy's own interpolation, and what is refused in which words."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from viewer.errors import DemoscopeError
from viewer.kit.life_curve import MOST_POINTS, LifeCurve
from viewer.kit.life_points import LifeError


def random_points(seed: int, draw: Callable[[np.random.Generator, int], np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(seed)
    x = np.unique(np.round(random.random(random.integers(2, MOST_POINTS + 1)), 3))
    x = x if len(x) > 1 else np.array([0.0, 1.0])
    return x, draw(random, len(x))


@pytest.mark.parametrize("draw", [
    lambda random, count: random.normal(size=count),
    lambda random, count: np.sort(random.random(count)),
    lambda random, count: random.integers(0, 3, count).astype(float),     # many level pieces and equal slopes
    lambda random, count: 10.0 ** random.uniform(-9, 9, count),
], ids=["rough", "rising", "level", "decades"])
def test_it_is_the_monotone_interpolation_of_scipy(draw: Callable[[np.random.Generator, int], np.ndarray]) -> None:
    for seed in range(60):
        x, y = random_points(seed, draw)
        curve = LifeCurve(tuple(zip(x.tolist(), y.tolist(), strict=True)))
        at = np.concatenate([np.linspace(x[0], x[-1], 301), x])
        expected = PchipInterpolator(x, y)(at)
        assert np.allclose(curve(at), expected, rtol=1e-12, atol=1e-12 * np.abs(y).max())


def test_it_never_overshoots_and_keeps_rising_where_its_points_rise() -> None:
    for seed in range(60):
        x, y = random_points(seed, lambda random, count: np.sort(random.random(count) ** 8))
        values = LifeCurve(tuple(zip(x.tolist(), y.tolist(), strict=True)))(np.linspace(0.0, 1.0, 2001))
        assert np.all(np.diff(values) >= -1e-15)
        assert values.min() >= y[0]
        assert values.max() <= y[-1]


def test_it_is_level_before_its_first_and_after_its_last_point() -> None:
    curve = LifeCurve.parse("0.25:3, 0.5:7")
    assert curve([-1.0, 0.0, 0.25, 0.5, 0.75, 2.0]).tolist() == [3.0, 3.0, 3.0, 7.0, 7.0, 7.0]


def test_one_point_is_a_constant_and_two_are_a_straight_line() -> None:
    assert LifeCurve.parse("0.3:2.5")(np.array([0.0, 0.3, 1.0])).tolist() == [2.5, 2.5, 2.5]
    x = np.linspace(0.0, 1.0, 33)
    assert np.allclose(LifeCurve.parse("0:-1, 1:3")(x), 4.0 * x - 1.0, atol=1e-15)


def test_shapes_and_tables() -> None:
    curve = LifeCurve.parse("0:0, 0.2:1, 1:0")
    assert curve(0.2).shape == ()
    assert curve(np.zeros((2, 3))).shape == (2, 3)
    table = curve.table(6)
    assert (table.shape, table.dtype) == ((6,), np.float32)
    assert table[[0, 1, 5]].tolist() == [0.0, 1.0, 0.0]
    assert np.allclose(table, PchipInterpolator([0, 0.2, 1], [0, 1, 0])(np.linspace(0, 1, 6)), atol=1e-7)


def test_the_steepest_curve_there_can_be_stays_finite() -> None:
    curve = LifeCurve(((0.5, -1e30), (0.500001, 1e30), (0.6, -1e30)))
    assert np.isfinite(curve.table(1025)).all()


@pytest.mark.parametrize("text", ["0:0, 0.2:1, 1:0", "0:0.5", "0.125:-3, 0.3333333333333333:1e-07, 1:1e+20"])
def test_the_text_reads_back(text: str) -> None:
    assert str(LifeCurve.parse(text)) == text
    assert LifeCurve.parse(str(LifeCurve.parse(text))) == LifeCurve.parse(text)


def test_every_spelling_means_the_same_hashable_curve() -> None:
    one = LifeCurve.parse("0:0, 1:2")
    others = [" 0 : 0 ,1.0:2e0", [(0, 0), (1, 2)], ((-0.0, -0.0), (1.0, 2.0)), np.array([[0, 0], [1, 2]]), one]
    assert {LifeCurve.parse(other) for other in others} == {one}
    assert LifeCurve.parse("0.5") == LifeCurve.parse(0.5) == LifeCurve(((0.0, 0.5),))


@pytest.mark.parametrize(("value", "why"), [
    ("", "is empty; allowed: 1 to 16 such as 0:0, 0.2:1, 1:0"),
    ([], "is empty; allowed: 1 to 16 such as 0:0, 0.2:1, 1:0"),
    ("0:0, 1.5:1", "has the position 1.5, which is outside 0 to 1"),
    ("-0.1:0", "has the position -0.1, which is outside 0 to 1"),
    ("nan:0", "has the position nan, which is outside 0 to 1"),
    ("0:1, 0:2", "has the position 0 after 0; each lies at least 1e-06 beyond the one before"),
    ("0:0, 0.6:1, 0.4:1", "has the position 0.4 after 0.6; each lies at least 1e-06 beyond the one before"),
    ("0:nan", "has the value nan, which is not a finite number"),
    ("0:0, 1:-inf", "has the value -inf, which is not a finite number"),
    ("0:1e31", "has the value 1e+31, which is beyond 1e+30"),
    ("0:high", "has the value high, which is not a number; write it like 0:0, 0.2:1, 1:0"),
    ("0:1:2", "has the value 1:2, which is not a number; write it like 0:0, 0.2:1, 1:0"),
    ("0:0,", "has the position nothing, which is not a number; write it like 0:0, 0.2:1, 1:0"),
    ("0:", "has the value nothing, which is not a number; write it like 0:0, 0.2:1, 1:0"),
    ([(0, True)], "has the value True, which is not a number; write it like 0:0, 0.2:1, 1:0"),
    ([(0, 1, 2)], "has (0, 1, 2), which is not a position with its value"),
    (["0:1"], "has 0:1, which is not a position with its value"),
    (None, "is not a list such as 0:0, 0.2:1, 1:0"),
    (True, "is not a list such as 0:0, 0.2:1, 1:0"),
    ({0: 1}, "is not a list such as 0:0, 0.2:1, 1:0"),
    ([(x / 16, x) for x in range(17)], "has 17 entries; at most 16 are allowed"),
])
def test_what_is_no_curve_is_refused_in_one_line(value: object, why: str) -> None:
    with pytest.raises(LifeError) as caught:
        LifeCurve.parse(value)
    assert caught.value.why == why
    assert isinstance(caught.value, (ValueError, DemoscopeError))
    assert str(caught.value).startswith("life curve ")
    assert str(caught.value).endswith(why)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 200


def test_a_curve_made_from_points_is_checked_too() -> None:
    for points in (((0.0, math.nan),), ((0.5, 0.0), (0.5, 1.0)), ()):
        with pytest.raises(LifeError):
            LifeCurve(points)
