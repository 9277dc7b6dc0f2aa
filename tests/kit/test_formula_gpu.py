"""Formulas and noise mean the same on the GPU as in NumPy: values, gradients and second derivatives."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from tests.kit.random_formulas import NAMES, FormulaSource, points
from viewer.kit import noise
from viewer.kit.formula import Formula, glsl_vector, parse

moderngl = pytest.importorskip("moderngl")

NOISE_SOURCE = Path(__file__).parents[2] / "shaders" / "lib" / "noise.glsl"
INCLUDE = '#include "lib/noise.glsl"\n'
VERTEX = """#version 330 core
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = vec4(corner * 4.0 - 1.0, 0.0, 1.0);
}
"""
FRAGMENT = """#version 330 core
uniform sampler2D u_points;
out vec4 out_value;
{functions}
void main() {{
    vec4 p = texelFetch(u_points, ivec2(int(gl_FragCoord.x), 0), 0);
    int row = int(gl_FragCoord.y);
    out_value = vec4(0.0);
{rows}
}}
"""
GpuValues = Callable[[str, Sequence[str], dict[str, NDArray[np.float64]]], NDArray[np.float32]]


@pytest.fixture(scope="module")
def gpu() -> Iterator[GpuValues]:
    """A function that evaluates vec4 expressions of the point p, one to a row, in a float32 framebuffer."""
    with pytest.MonkeyPatch.context() as patch:
        if os.environ.get("MESA_GL_VERSION_OVERRIDE") is None:
            patch.setenv("MESA_GL_VERSION_OVERRIDE", "3.3")
            patch.setenv("MESA_GLSL_VERSION_OVERRIDE", "330")
        try:
            context = moderngl.create_context(standalone=True, backend="egl", require=330)
        except Exception as error:
            pytest.skip(f"no OpenGL 3.3 through EGL: {error}")
        context.gc_mode = "context_gc"

        def evaluate(
            functions: str, expressions: Sequence[str], values: dict[str, NDArray[np.float64]]
        ) -> NDArray[np.float32]:
            if INCLUDE in functions:
                functions = NOISE_SOURCE.read_text() + functions.replace(INCLUDE, "")
            rows = "".join(f"    if (row == {n}) out_value = {text};\n" for n, text in enumerate(expressions))
            program = context.program(VERTEX, FRAGMENT.format(functions=functions, rows=rows))
            data = np.stack([values[name] for name in NAMES], axis=1).astype(np.float32)
            texture = context.texture((len(data), 1), 4, data.tobytes(), dtype="f4")
            target = context.simple_framebuffer((len(data), len(expressions)), 4, dtype="f4")
            target.use()
            texture.use(0)
            context.vertex_array(program, []).render(moderngl.TRIANGLES, vertices=3)
            result = np.frombuffer(target.read(components=4, dtype="f4"), np.float32)
            assert context.error == "GL_NO_ERROR"
            return result.reshape(len(expressions), len(data), 4)

        yield evaluate
        context.gc()
        context.release()


def run_formulas(
    gpu: GpuValues, groups: Sequence[Sequence[Formula]], values: dict[str, NDArray[np.float64]]
) -> NDArray[np.float32]:
    """Each group of four formulas as one GLSL function, all in one shader."""
    sources = [glsl_vector(f"formula{n}", group, NAMES) for n, group in enumerate(groups)]
    calls = [f"formula{n}(p.x, p.y, p.z, p.w)" for n in range(len(groups))]
    return gpu("".join(sources), calls, values)


def assert_agree(
    found: NDArray[np.float32], formula: Formula, values: dict[str, NDArray[np.float64]], where: str
) -> int:
    """Compare where rounding the arguments hardly changes the value; how many points that is.

    What float32 does to a formula in NumPy, and what it does to neighbouring points, is the measure of what
    it may do on the GPU.
    """
    expected = formula.evaluate(**values)
    single = formula.evaluate(**{name: value.astype(np.float32) for name, value in values.items()})
    with np.errstate(all="ignore"):
        spread = np.abs(single - expected)
        for factor in (1 - 2e-6, 1 + 2e-6, 1 + 1e-6):
            near = formula.evaluate(**{name: value * factor for name, value in values.items()})
            spread = np.maximum(spread, np.abs(near - expected))
        size = np.abs(expected)
        steady = np.isfinite(expected) & (spread < 1e-3 * (1 + size)) & (size < 1e6)
        wrong = ~(np.abs(found - expected) <= 2e-4 * (1 + size) + 10 * spread) & steady
    assert not wrong.any(), (where, {n: v[wrong][:3] for n, v in values.items()}, expected[wrong], found[wrong])
    return int(steady.sum())


def quadruple(formula: Formula) -> list[Formula]:
    slopes = formula.gradient()
    return [formula, *(slopes[name] for name in "xyz")]


EVERYTHING = [
    "x + y", "x - y", "x * y", "x / y", "x % y", "mod(y, x)", "-x", "x^y", "pow(abs(x), y)", "abs(x)^2.5",
    "x^0.5", "x^2", "x^3", "x^5", "x^13", "x^64", "x^70", "x^-1", "x^-2", "x^-7", "(-2)^round(x)", "0^abs(x)",
    "x^round(y*2)", "2^x", "e^x",
    "x < y", "x <= y", "x > y", "x >= y", "round(x) == round(y)", "round(x) != round(y)", "-1 < x < y <= 1",
    "x > 0 and y > 0", "x > 0 or y > 0", "not x > 0", "not x or y", "x if y > 0 else z", "x if y else z",
    "x if x > 1 else y if y > 1 else z", "(x > 0) * (y < 0) + (z > 0)", "(x if x < y else y) * z",
    "sin(x)", "cos(x)", "tan(x)", "asin(x/2.5)", "acos(x/2.5)", "atan(x)", "atan2(x, y)", "sinh(x)", "cosh(x)",
    "tanh(x)", "tanh(x*100)", "exp(x)", "log(abs(x))", "log2(abs(x))", "sqrt(abs(x))", "cbrt(x)", "abs(x)",
    "sign(x)", "floor(x)", "ceil(x)", "fract(x)", "round(x)", "round(floor(x) + 0.5)", "min(x, y)",
    "max(x, y, z, 0.5)", "clamp(x, -1, y)", "mix(x, y, z)", "step(x, y)", "smoothstep(-1, 1, x)",
    "smoothstep(1, -1, x)", "smoothstep(x, y, z)", "length(x)", "length(x, y)", "length(x, y, z)",
    "length(x, y, z, height, 1, x)", "noise(x)", "noise(x*3, y)", "noise(x, y, z)", "turbulence(x)",
    "turbulence(x, y*2)", "turbulence(x, y, z)", "pi", "x - (y - z)", "x / (y * z)", "x * (y / z)", "-x*-y",
]  # fmt: skip


def test_every_function_and_operator_agrees_with_numpy_in_value_and_gradient(gpu: GpuValues) -> None:
    values = points(256)
    for start in range(0, len(EVERYTHING), 30):
        texts = EVERYTHING[start : start + 30]
        groups = [quadruple(parse(text)) for text in texts]
        found = run_formulas(gpu, groups, values)
        for text, group, row in zip(texts, groups, found, strict=True):
            compared = assert_agree(row[:, 0], group[0], values, text)
            assert compared > (80 if "^" in text else 200), text
            for axis in range(3):
                assert_agree(row[:, axis + 1], group[axis + 1], values, f"d/d{'xyz'[axis]} {text}")


def test_random_formulas_agree_with_numpy_in_value_and_gradient(gpu: GpuValues) -> None:
    source = FormulaSource(seed=21)
    values = points(64, seed=2)
    compared = 0
    for _ in range(6):
        groups = [quadruple(parse(source.formula(3))) for _ in range(20)]
        found = run_formulas(gpu, groups, values)
        for group, row in zip(groups, found, strict=True):
            for position, formula in enumerate(group):
                compared += assert_agree(row[:, position], formula, values, f"{position} of {group[0]}")
    assert compared > 0.8 * 120 * 4 * 64


def test_second_derivatives_agree_with_numpy(gpu: GpuValues) -> None:
    texts = ["x^3*y^-2", "sin(x*y)*exp(z)", "length(x, y, z)", "smoothstep(-2, 2, x*y)", "atan2(x, y)", "abs(x)^y"]
    texts += ["noise(x, y*2, z) * x", "turbulence(x/16, y/16)", "x*y*z if x > 0 else cbrt(y)"]
    values = points(128, seed=3)
    groups = [quadruple(parse(text).gradient()[name]) for text in texts for name in "xy"]
    found = run_formulas(gpu, groups, values)
    for group, row in zip(groups, found, strict=True):
        for position, formula in enumerate(group):
            assert_agree(row[:, position], formula, values, f"{position} of {group[0]}")


def test_values_at_the_edge_of_a_domain_agree_with_numpy(gpu: GpuValues) -> None:
    texts = ["x^y", "x^0", "x^1.5", "x^-1", "cbrt(x)", "atan2(x, x)", "tanh(x*50)", "sign(x)", "sqrt(x*x)", "abs(x)^y"]
    texts += ["length(x, x)", "1/x if x else 7", "log(x) if x > 0 else 5", "round(x/2)", "x % 2", "fract(x)"]
    grid = np.stack(np.meshgrid([-3.0, -2.0, -1.0, 0.0, 1.0, 2.0], [-2.0, -1.0, 0.0, 0.5, 1.0, 2.0, 3.0]))
    x, y = grid.reshape(2, -1)
    values = {"x": x, "y": y, "z": x, "height": y}
    groups = [quadruple(parse(text)) for text in texts]
    found = run_formulas(gpu, groups, values)
    for group, row in zip(groups, found, strict=True):
        for position in (0, 1):
            expected = group[position].evaluate(**values)
            np.testing.assert_allclose(row[:, position], expected, rtol=1e-4, atol=1e-5, err_msg=str(group[0]))


def test_names_that_glsl_reserves_are_allowed(gpu: GpuValues) -> None:
    names = "input float vec3 sampler2D gl_Position texture mix2 main out_value p __proto__ _ t1 n1".split()
    formula = parse(" + ".join(f"{n + 1}*{name}^1.5" for n, name in enumerate(names)) + " + noise(t1, n1)")
    source = formula.glsl("height")
    call = "vec4(height(" + ", ".join(["p.x"] * len(formula.variables)) + "))"
    values = points(16, low=0.5)
    expected = formula.evaluate(**dict.fromkeys(formula.variables, values["x"]))
    np.testing.assert_allclose(gpu(source, [call], values)[0, :, 0], expected, rtol=1e-4)


@pytest.mark.parametrize("join", ["+", "*", "-"])
def test_long_formula_and_its_gradient_compile(gpu: GpuValues, join: str) -> None:
    formula = parse(join.join(["x", "y"] * 250))
    values = points(8, low=0.95, high=1.0)
    found = run_formulas(gpu, [quadruple(formula)], values)[0]
    np.testing.assert_allclose(found[:, 0], formula.evaluate(**values), rtol=1e-3, atol=1e-3)
    np.testing.assert_allclose(found[:, 1], formula.gradient()["x"].evaluate(**values), rtol=1e-3, atol=1e-3)


HESSIAN = [(2, 0, 0), (1, 1, 0), (1, 0, 1), (0, 2, 0), (0, 1, 1), (0, 0, 2)]


@pytest.mark.parametrize("kind", ["noise", "turbulence"])
def test_noise_library_agrees_with_numpy(gpu: GpuValues, kind: str) -> None:
    values = points(4096, seed=5, low=-30, high=30)
    if kind == "turbulence":
        values = {name: value / 32 for name, value in values.items()}
    point = [values[name] for name in "xyz"]
    hessian = f"perlin_{kind}_hessian(p.xyz)"
    rows = [
        f"vec4(perlin_{kind}(p.xyz))",
        f"perlin_{kind}_gradient(p.xyz)",
        *(f"vec4({hessian}[{axis}], 0.0)" for axis in range(3)),
        f"vec4(perlin_{kind}_derivative(p.xyz, ivec3(1, 1, 1)))",
        f"vec4(perlin_{kind}_derivative(p.xyz, ivec3(0, 3, 0)))",
        f"vec4(perlin_{kind}_derivative(p.xyz, ivec3(0)))",
    ]
    value, gradient, *seconds, mixed, third, same = gpu(INCLUDE, rows, values)
    steady = np.ones(4096, bool)
    if kind == "turbulence":
        steady = np.min([np.abs(noise.noise(*(2**i * c for c in point))) for i in range(6)], axis=0) > 1e-4

    def exact(*order: int) -> NDArray[np.float64]:
        function = noise.noise_derivative if kind == "noise" else noise.turbulence_derivative
        return function(*point, order)[steady]

    scale = 1 if kind == "noise" else 32
    np.testing.assert_allclose(value[steady, 0], exact(0, 0, 0), atol=1e-5)
    np.testing.assert_allclose(gradient[steady, 3], exact(0, 0, 0), atol=1e-5)
    for axis, order in enumerate(np.eye(3, dtype=int)):
        np.testing.assert_allclose(gradient[steady, axis], exact(*order), atol=4e-5)
    for order in HESSIAN:
        row, column = (axis for axis, count in enumerate(order) for _ in range(count))
        np.testing.assert_allclose(seconds[row][steady, column], exact(*order), atol=1e-4 * scale)
        np.testing.assert_allclose(seconds[column][steady, row], exact(*order), atol=1e-4 * scale)
    np.testing.assert_allclose(mixed[steady, 0], exact(1, 1, 1), atol=1e-3 * scale**2)
    np.testing.assert_allclose(third[steady, 0], exact(0, 3, 0), atol=1e-3 * scale**2)
    np.testing.assert_allclose(same[steady, 0], exact(0, 0, 0), atol=1e-5)
