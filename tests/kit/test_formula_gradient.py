"""Derivatives of formulas: against differences in double precision, at kinks, and as text."""

from __future__ import annotations

import numpy as np
import pytest

from tests.kit.random_formulas import FormulaSource, points
from viewer.kit.formula import Formula, parse

STENCIL = {1: 4 / 5, 2: -1 / 5, 3: 4 / 105, 4: -1 / 280}  # eighth-order central difference

SMOOTH = [
    "x + 2*y - z/3 + height*x",
    "x*y*z*height",
    "x / (3 + y) / (4 + z)",
    "-(x - y) - -z*x",
    "x % (y + 3)",
    "(x + 5) % y",
    "x^2 + y^3 + z^5 + x^-1 + y^-4 + height^9 + z^1 + z^0",
    "abs(x)^y + abs(y)^2.5 + abs(z)^0.5 + 2^z + e^x + 0.5^(x*y)",
    "x^round(y) + (-x)^round(z)",
    "sin(x*y) + cos(z + x) + tan(x/3) + sin(cos(x))",
    "asin(x/3) + acos(y/3) + atan(z) + atan2(x, y) + atan2(z, height)",
    "sinh(x) + cosh(y) + tanh(z) + tanh(x*y)",
    "exp(x*y) + log(abs(x)) + log2(3 + y) + sqrt(3 + z) + cbrt(x)",
    "abs(x) + sign(y)*x + floor(z)*x + ceil(x)*y + round(y)*z + fract(x*2)*y",
    "min(x, y, z) + max(x, y*z, 0.2) + clamp(x, -0.5, y + 2)",
    "mix(x, y, z) + step(0, x)*y",
    "smoothstep(-1, 1, x) + smoothstep(y - 3, z + 3, x) + smoothstep(1, -1, z)",
    "length(x, y, z) + length(x) + length(x, y, z, height, x*y, 2)",
    "mod(x, 0.7) + mod(5, z)",
    "pow(abs(x) + 1, y)",
    "(x < y)*z + (x <= 0)*y + (x == y) + (z != 0)*x",
    "x if y > 0 else z^2",
    "log(x) if x > 0 else sin(x) if y > 0 and z < 1 or not height else y*z",
    "noise(x) + noise(x, y) + noise(x*2, y + z, z*height)",
    "turbulence(x, y, z) + turbulence(x/3)*y",
    "height*cos(x*height)",
]


def differences(formula: Formula, name: str, values: dict[str, np.ndarray], step: float) -> np.ndarray:
    def shifted(distance: float) -> np.ndarray:
        return formula.evaluate(**{**values, name: values[name] + distance})

    with np.errstate(all="ignore"):
        return sum(w * (shifted(k * step) - shifted(-k * step)) for k, w in STENCIL.items()) / step


def assert_gradient_agrees(formula: Formula, values: dict[str, np.ndarray], through_infinity: bool = False) -> int:
    """Compare where three steps give the same difference, so away from kinks; how many points that is.

    A formula such as 1/(1/(x - x)) has values where no derivative can be had: ``through_infinity`` lets
    the derivative be undefined.
    """
    compared = 0
    for name, slope in formula.gradient().items():
        if name not in formula.variables:
            assert str(slope) == "0"
            continue
        fine, medium, coarse = (differences(formula, name, values, step) for step in (4.1e-4, 7.3e-4, 1.1e-3))
        with np.errstate(all="ignore"):
            spread = np.maximum(np.abs(fine - coarse), np.abs(fine - medium))
            smooth = np.isfinite(fine) & (spread < 1e-8 * (1 + np.abs(fine))) & (np.abs(fine) < 1e4)
        exact = slope.evaluate(**values)
        if through_infinity:
            smooth &= np.isfinite(exact)
        where = f"d/d{name} {formula}"
        np.testing.assert_allclose(exact[smooth], fine[smooth], rtol=2e-7, atol=2e-7, err_msg=where)
        compared += int(smooth.sum())
    return compared


@pytest.mark.parametrize("text", SMOOTH)
def test_gradient_agrees_with_differences(text: str) -> None:
    formula = parse(text)
    values = points(300)
    if "round(y)" in text and "^round" in text:
        values["y"], values["z"] = np.round(values["y"]) + 0.0, np.round(values["z"]) + 0.0
    compared = assert_gradient_agrees(formula, values)
    assert compared > 100 * len(formula.variables)


@pytest.mark.parametrize("text", SMOOTH)
def test_second_derivatives_agree_with_differences(text: str) -> None:
    formula = parse(text)
    values = points(150, seed=1)
    if "^round" in text:
        values["y"], values["z"] = np.round(values["y"]), np.round(values["z"])
    for name, slope in formula.gradient().items():
        if slope.variables and name != "height":
            assert_gradient_agrees(slope, values)


def test_gradient_of_random_formulas_agrees_with_differences() -> None:
    source = FormulaSource(seed=8)
    compared = sum(assert_gradient_agrees(parse(source.formula()), points(30, seed), True) for seed in range(70))
    assert compared > 3_000


def test_derivative_exists_for_x_y_z_and_every_variable() -> None:
    assert list(parse("amplitude*y").gradient()) == ["x", "y", "z", "amplitude"]
    assert all(str(slope) == "0" for slope in parse("7").gradient().values())


@pytest.mark.parametrize(
    ("text", "name", "expected"),
    [
        ("amplitude*cos(frequency*x)", "x", "-amplitude*frequency*sin(frequency*x)"),
        ("amplitude*cos(frequency*x)", "amplitude", "cos(frequency*x)"),
        ("amplitude*cos(frequency*x)", "frequency", "-amplitude*x*sin(frequency*x)"),
        ("x^2 + y^2 + z^2 - 1", "x", "2*x"),
        ("x^3", "x", "3*x^2"),
        ("x*y*z", "y", "x*z"),
        ("x*x", "x", "2*x"),
        ("1/x", "x", "-1/x^2"),
        ("exp(-x^2/2)", "x", "-x*exp(-x^2/2)"),
        ("sqrt(x^2 + y^2)", "x", "0 if sqrt(x^2 + y^2) == 0 else x/sqrt(x^2 + y^2)"),
        ("abs(x)", "x", "sign(x)"),
        ("max(x, y)", "x", "0 if x < y else 1"),
        ("sin(x) if x > 0 else x", "x", "cos(x) if x > 0 else 1"),
        ("x % y", "y", "-floor(x/y)"),
        ("noise(x, y)", "y", "noise_y(x, y, 0)"),
        ("floor(x)*x", "x", "floor(x)"),
        ("2^x", "x", "0.693147181*2^x"),
        ("e^x", "x", "exp(x)"),
        ("3*x + 4*x", "x", "7"),
    ],
)
def test_derivative_reads_like_one_written_by_hand(text: str, name: str, expected: str) -> None:
    assert str(parse(text).gradient()[name]) == expected


def test_text_of_a_derivative_is_a_formula_of_the_same_value() -> None:
    source = FormulaSource(seed=9)
    values = points(50)
    checked = 0
    for _ in range(200):
        slope = parse(source.formula(3)).gradient()["x"]
        if "noise" not in str(slope) and "turbulence" not in str(slope) and "..." not in str(slope):
            expected = slope.evaluate(**values)
            found = parse(str(slope)).evaluate(**values)
            close = np.isclose(found, expected, rtol=1e-4, atol=1e-4, equal_nan=True)
            assert close.mean() > 0.9, (slope.text, found, expected)
            checked += 1
    assert checked > 100


@pytest.mark.parametrize(
    ("text", "x", "expected"),
    [
        ("sqrt(x)", 0, 0),
        ("cbrt(x)", 0, 0),
        ("abs(x)", 0, 0),
        ("length(x, 0)", 0, 0),
        ("length(x)", 0, 0),
        ("x^0.5", 0, 0),
        ("x^1.5", 0, 0),
        ("x^2", 0, 0),
        ("x^1", 0, 1),
        ("x^3", -2, 12),
        ("x^-1", -2, -0.25),
        ("x^y", -2, 12),
        ("x^y", 0, 0),
        ("x^(y - 2)", 0, 1),
        ("x^(y - 3)", 0, 0),
        ("x^(y - 2.5)", 0, 0),
        ("y^x", 0, np.log(3)),
        ("0^x", 1, 0),
        ("x^x", 0, 0),
        ("min(x, 0)", 1, 0),
        ("clamp(x, 0, 1)", 2, 0),
        ("floor(x)", 0, 0),
        ("sign(x)", 0, 0),
        ("smoothstep(0, 1, x)", 5, 0),
    ],
)
def test_derivative_has_its_agreed_value_where_there_is_a_kink(text, x, expected, recwarn) -> None:
    slope = parse(text).gradient()["x"]
    assert float(slope.evaluate(x=x, y=3)) == pytest.approx(expected, abs=1e-15)
    assert not recwarn.list


@pytest.mark.parametrize(
    ("text", "x"),
    [
        ("log(x) if x > 0 else 5", -1.0),
        ("1/x if x else 7", 0.0),
        ("sqrt(x) if x > 1 else x", 0.0),
        ("max(log(x), -3) if x > 0 else x", -2.0),
        ("(1/x if x > 1 else 0) * x if x > 0.5 else x^2", 0.0),
    ],
)
def test_branch_not_taken_does_not_poison_the_derivatives(text: str, x: float) -> None:
    slope = parse(text).gradient()["x"]
    assert np.isfinite(slope.evaluate(x=x))
    assert np.isfinite(slope.gradient()["x"].evaluate(x=x))


def test_mean_curvature_of_a_sphere_follows_from_second_derivatives() -> None:
    sphere = parse("length(x, y, z) - 2")
    random = np.random.default_rng(0).normal(size=(3, 100))
    x, y, z = 2 * random / np.linalg.norm(random, axis=0)
    laplacian = sum(sphere.gradient()[n].gradient()[n].evaluate(x=x, y=y, z=z) for n in "xyz")
    np.testing.assert_allclose(laplacian, 2 / 2, rtol=1e-12)
