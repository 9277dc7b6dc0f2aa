"""Formulas in NumPy: their values against plain Python, shapes, types and quiet."""

from __future__ import annotations

import math
import time

import numpy as np
import pytest

from viewer.kit import noise
from viewer.kit.formula import FormulaError, parse

RANDOM = np.random.default_rng(11)


def python_smoothstep(low: float, high: float, value: float) -> float:
    t = min(max((value - low) / (high - low), 0.0), 1.0)
    return t * t * (3 - 2 * t)


PYTHON = {
    "x + y": lambda x, y: x + y,
    "x - y": lambda x, y: x - y,
    "x * y": lambda x, y: x * y,
    "x / y": lambda x, y: x / y,
    "x % y": lambda x, y: x % y,
    "mod(x, y)": lambda x, y: x - y * math.floor(x / y),
    "abs(x) ^ y": lambda x, y: abs(x) ** y,
    "pow(abs(x), y)": lambda x, y: abs(x) ** y,
    "x^3": lambda x, y: x**3,
    "x^-3": lambda x, y: x**-3,
    "x^64 + x^100": lambda x, y: x**64 + x**100,
    "x^7 * y^13": lambda x, y: x**7 * y**13,
    "x < y": lambda x, y: float(x < y),
    "x <= y": lambda x, y: float(x <= y),
    "x > y": lambda x, y: float(x > y),
    "x >= y": lambda x, y: float(x >= y),
    "round(x) == round(y)": lambda x, y: float(round(x) == round(y)),
    "round(x) != round(y)": lambda x, y: float(round(x) != round(y)),
    "(x > 0) + (y > 0)": lambda x, y: float((x > 0) + (y > 0)),
    "x > 0 and y > 0": lambda x, y: float(x > 0 and y > 0),
    "x > 0 or y": lambda x, y: 1.0,
    "not x > 0": lambda x, y: float(not x > 0),
    "x if y > 0 else 1 - x": lambda x, y: x if y > 0 else 1 - x,
    "sin(x)": lambda x, y: math.sin(x),
    "cos(x)": lambda x, y: math.cos(x),
    "tan(x)": lambda x, y: math.tan(x),
    "asin(x/4)": lambda x, y: math.asin(x / 4),
    "acos(x/4)": lambda x, y: math.acos(x / 4),
    "atan(x)": lambda x, y: math.atan(x),
    "atan2(x, y)": lambda x, y: math.atan2(x, y),
    "sinh(x)": lambda x, y: math.sinh(x),
    "cosh(x)": lambda x, y: math.cosh(x),
    "tanh(x)": lambda x, y: math.tanh(x),
    "exp(x)": lambda x, y: math.exp(x),
    "log(abs(x))": lambda x, y: math.log(abs(x)),
    "log2(abs(x))": lambda x, y: math.log2(abs(x)),
    "sqrt(abs(x))": lambda x, y: math.sqrt(abs(x)),
    "cbrt(x)": lambda x, y: math.copysign(abs(x) ** (1 / 3), x),
    "abs(x)": lambda x, y: abs(x),
    "sign(x)": lambda x, y: math.copysign(1.0, x),
    "floor(x)": lambda x, y: math.floor(x),
    "ceil(x)": lambda x, y: math.ceil(x),
    "fract(x)": lambda x, y: x - math.floor(x),
    "round(x)": lambda x, y: round(x),
    "round(floor(x) + 0.5)": lambda x, y: round(math.floor(x) + 0.5),
    "min(x, y, 0.5)": lambda x, y: min(x, y, 0.5),
    "max(x, y, 0.5)": lambda x, y: max(x, y, 0.5),
    "clamp(x, -1, 2)": lambda x, y: min(max(x, -1), 2),
    "mix(x, y, 0.25)": lambda x, y: 0.75 * x + 0.25 * y,
    "step(x, y)": lambda x, y: float(y >= x),
    "smoothstep(-1, 2, x)": lambda x, y: python_smoothstep(-1, 2, x),
    "smoothstep(2, -1, x)": lambda x, y: python_smoothstep(2, -1, x),
    "length(x, y)": lambda x, y: math.hypot(x, y),
    "length(x, y, 1, x, y)": lambda x, y: math.sqrt(2 * x * x + 2 * y * y + 1),
    "noise(x)": lambda x, y: noise.noise(x, 0, 0),
    "noise(x, y, 0.3)": lambda x, y: noise.noise(x, y, 0.3),
    "turbulence(x, y)": lambda x, y: noise.turbulence(x, y, 0),
}


@pytest.mark.parametrize("text", PYTHON)
def test_value_agrees_with_plain_python(text: str) -> None:
    x, y = RANDOM.uniform(-4, 4, (2, 200))
    expected = [float(PYTHON[text](a, b)) for a, b in zip(x.tolist(), y.tolist(), strict=True)]
    np.testing.assert_allclose(parse(text).evaluate(x=x, y=y), expected, rtol=2e-13, atol=1e-13)


@pytest.mark.parametrize(
    ("text", "x", "expected"),
    [
        ("x^3", -2, -8),
        ("x^y", -2, -8),
        ("x^-1", -2, -0.5),
        ("x^0", 0, 1),
        ("x^y", 0, 0),
        ("x^0.5", -1, math.nan),
        ("x^-2", 0, math.inf),
        ("sqrt(x)", -1, math.nan),
        ("log(x)", 0, -math.inf),
        ("x/0", 1, math.inf),
        ("x % 0", 1, math.nan),
        ("tanh(x)", 1000, 1),
        ("atan2(x, x)", 0, 0),
        ("length(x, x)", 0, 0),
        ("exp(x)", 1000, math.inf),
        ("log(x) if x > 0 else 5", -1, 5),
        ("1/x if x else 7", 0, 7),
    ],
)
def test_edge_of_a_domain_has_its_agreed_value_and_no_warning(text, x, expected, recwarn) -> None:
    np.testing.assert_equal(float(parse(text).evaluate(x=x, y=3)), float(expected))
    assert not recwarn.list


def test_result_has_the_common_shape_of_everything_given() -> None:
    grid = {"x": np.zeros((4, 1, 1)), "y": np.zeros((5, 1)), "z": np.zeros(6)}
    assert parse("x + y").evaluate(**grid).shape == (4, 5, 6)
    constant = parse("3").evaluate(**grid)
    assert constant.shape == (4, 5, 6) and (constant == 3).all()
    constant[0, 0, 0] = 1  # an array of its own, not a view of one number
    assert constant.sum() == 3 * 4 * 5 * 6 - 2
    assert parse("x").evaluate(x=np.zeros((0, 3))).shape == (0, 3)
    assert isinstance(parse("x + 1").evaluate(x=1), float)


def test_result_never_shares_memory_with_an_argument() -> None:
    x = np.zeros(3)
    parse("x").evaluate(x=x)[0] = 1
    assert not x.any()


def test_large_grid_is_evaluated_in_blocks_like_a_small_one() -> None:
    x, y, z = np.linspace(-1, 1, 61)[:, None, None], np.linspace(0, 2, 47)[:, None], np.linspace(1, 3, 53)
    whole = parse("sin(x*3)*y + z^2 - noise(x, y*4, z)").evaluate(x=x, y=y, z=z)
    np.testing.assert_array_equal(whole, np.sin(x * 3) * y + z * z - noise.noise(x, y * 4, z))


@pytest.mark.parametrize("text", ["x + 1", "x^2.5 + noise(x)", "x < 2", "step(0, x) + pi", "3", "x if x else 1"])
def test_type_is_float32_only_if_all_arrays_are(text: str) -> None:
    formula = parse(text)
    x = np.linspace(0, 1, 5, dtype=np.float32)
    assert formula.evaluate(x=x).dtype == np.float32
    assert formula.evaluate(x=x.astype(np.float64)).dtype == np.float64
    assert formula.evaluate(x=np.arange(3)).dtype == np.float64
    assert formula.evaluate(x=np.array([True])).dtype == np.float64
    assert parse("x*gain").evaluate(x=x, gain=0.1).dtype == np.float32


def test_other_names_are_ignored_and_any_name_is_allowed() -> None:
    assert parse("self + arrays").evaluate(self=1, arrays=2, other="text") == 3


def test_missing_variable_is_named() -> None:
    with pytest.raises(FormulaError, match=r"^no value for b, c in a\*b\+c$"):
        parse("a*b+c").evaluate(a=1)


@pytest.mark.parametrize(
    ("value", "message"),
    [("1", "x is str32; real numbers are needed"), (1j, "x is complex128; real numbers are needed"),
     (None, "x is object; real numbers are needed")],
)  # fmt: skip
def test_value_that_is_no_real_number_is_refused(value, message) -> None:
    with pytest.raises(FormulaError) as caught:
        parse("x").evaluate(x=value)
    assert str(caught.value) == message


def test_shapes_that_do_not_fit_are_named() -> None:
    with pytest.raises(FormulaError, match=r"^shapes do not fit together: x \(3,\), y \(4,\)$"):
        parse("x+y").evaluate(x=np.zeros(3), y=np.zeros(4))


def test_thousand_operations_on_a_grid_need_little_memory_and_time() -> None:
    begin = time.perf_counter()
    parse("+".join(["x*y"] * 300)).evaluate(x=np.ones((64, 1, 1)), y=np.ones((64, 1)), z=np.ones(64))
    assert time.perf_counter() - begin < 2
