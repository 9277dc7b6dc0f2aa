"""The GLSL text that a formula becomes, as a student reads it."""

from __future__ import annotations

import re

import numpy as np
import pytest

from viewer.kit.formula import glsl_vector, parse
from viewer.kit.formula_glsl import argument_name, literal


def body(source: str) -> list[str]:
    return [line.strip() for line in source.splitlines() if line.startswith("    ")]


def test_function_reads_like_one_written_by_hand() -> None:
    assert parse("amplitude * cos(frequency * x)").glsl("height") == (
        "float height(float a_amplitude, float a_frequency, float a_x) {\n"
        "    return a_amplitude * cos(a_frequency * a_x);\n"
        "}\n"
    )


def test_value_used_twice_is_computed_once() -> None:
    assert body(parse("sin(x*y) + sin(x*y)^2").glsl("f")) == [
        "float t1 = sin(a_x * a_y);",
        "return t1 + t1 * t1;",
    ]


def test_gradient_shares_what_its_components_have_in_common() -> None:
    slopes = parse("exp(sin(x*y) + z)").gradient()
    source = glsl_vector("slope", [slopes[name] for name in "xyz"], ["x", "y", "z"])
    assert source.startswith("vec3 slope(float a_x, float a_y, float a_z) {")
    assert source.count("exp(") == source.count("cos(") == source.count("sin(") == 1


def test_noise_and_its_gradient_cost_one_call() -> None:
    formula = parse("noise(x, y) * 2")
    slopes = formula.gradient()
    source = glsl_vector("f", [*(slopes[name] for name in "xyz"), formula], ["x", "y", "z"])
    assert source.startswith('#include "lib/noise.glsl"\nvec4 f(')
    assert source.count("perlin_") == source.count("perlin_noise_gradient(vec3(a_x, a_y, 0.0))") == 1


def test_second_derivatives_of_noise_cost_one_call() -> None:
    slopes = parse("noise(x, y, z)").gradient()
    seconds = [slopes["x"].gradient()["x"], slopes["x"].gradient()["z"], slopes["y"].gradient()["y"]]
    source = glsl_vector("f", seconds, ["x", "y", "z"])
    assert source.count("perlin_") == source.count("perlin_noise_hessian(") == 1


def test_noise_is_included_only_where_it_is_used() -> None:
    assert "#include" not in parse("x").glsl("f")
    assert parse("noise(x)").glsl("f").startswith('#include "lib/noise.glsl"\n')
    assert "#include" not in parse("x + noise(y)").gradient()["x"].glsl("f")


def test_arguments_may_come_in_another_order_and_be_more() -> None:
    source = parse("b - a").glsl("f", ["time", "b", "a"])
    assert source.startswith("float f(float a_time, float a_b, float a_a) {")


@pytest.mark.parametrize("arguments", [["x"], ["x", "y", "y"]])
def test_arguments_that_cannot_be_are_refused(arguments: list[str]) -> None:
    with pytest.raises(ValueError, match=r"y not among the arguments of f|named twice"):
        parse("x + y").glsl("f", arguments)


@pytest.mark.parametrize("name", ["", "2f", "gl_f", "a__b", "f_", "f()", "f g", "é"])
def test_function_name_that_glsl_reserves_is_refused(name: str) -> None:
    with pytest.raises(ValueError, match="is not a name for a GLSL function"):
        parse("x").glsl(name)


@pytest.mark.parametrize("count", [0, 1, 5])
def test_vector_has_two_to_four_components(count: int) -> None:
    with pytest.raises(ValueError, match="2 to 4 components"):
        glsl_vector("f", [parse("x")] * count, ["x"])


def test_argument_names_are_never_reserved_and_never_the_same() -> None:
    names = ["x", "_", "__", "_x", "x_", "x__y", "x_0y", "_0x", "0_".join("abc"), "gl_Position", "float", "a_x", "b_0x"]
    names += ["".join(letters) for letters in np.random.default_rng(3).choice(list("_0ab"), (2000, 5)).tolist()]
    mangled = {name: argument_name(name) for name in names}
    assert len(set(mangled.values())) == len(set(names))
    assert all(re.fullmatch(r"(?!.*__)[ab]_\w+", name) for name in mangled.values())


@pytest.mark.parametrize("value", [0.0, 1.0, 0.1, 1e-30, 1e30, 123456789.0, 3.4028234e38, 1 / 3, 2.0**-149, 16777217.0])
def test_literal_is_a_float_that_reads_back_as_itself(value: float) -> None:
    text = literal(value)
    assert "." in text or "e" in text
    assert np.float32(text) == np.float32(value)


def test_lines_stay_readable() -> None:
    source = parse(" + ".join(f"sin(x*{n}.5)" for n in range(1, 80))).glsl("f")
    assert max(map(len, source.splitlines())) < 120


@pytest.mark.parametrize(
    ("text", "expression"),
    [
        ("x^2", "a_x * a_x"),
        ("x^4", "a_x * a_x * a_x * a_x"),
        ("x^-1", "1.0 / a_x"),
        ("x^7", "f_power_7(a_x)"),
        ("x^0.5", "f_power(a_x, 0.5)"),
        ("2^x", "pow(2.0, a_x)"),
        ("x - (y - 1)", "a_x - (a_y - 1.0)"),
        ("x*(y*2)", "a_x * a_y * 2.0"),
        ("x/(y*2)", "a_x / (a_y * 2.0)"),
        ("x*(y/2)", "a_x * (a_y / 2.0)"),
        ("-(-x)", "-(-a_x)"),
        ("1 - -x", "1.0 - (-a_x)"),
        ("x - -1*y", "a_x - (-1.0 * a_y)"),
        ("x < 1", "float(a_x < 1.0)"),
        ("0 < x < 1", "float(0.0 < a_x && a_x < 1.0)"),
        ("x if x > y else 2", "(a_x > a_y) ? a_x : 2.0"),
        ("1 if x else 2", "(a_x != 0.0) ? 1.0 : 2.0"),
        ("not x", "float(!(a_x != 0.0))"),
        ("round(x)", "roundEven(a_x)"),
        ("x % 2", "mod(a_x, 2.0)"),
        ("smoothstep(0, 1, x)", "smoothstep(0.0, 1.0, a_x)"),
        ("smoothstep(1, 0, x)", "f_smoothstep(1.0, 0.0, a_x)"),
    ],
)
def test_expression_is_written_plainly(text: str, expression: str) -> None:
    assert body(parse(text).glsl("f"))[-1] == f"return {expression};"
