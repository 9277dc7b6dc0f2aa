"""A formula parameter as an include for shaders, with its exact gradient."""

from __future__ import annotations

from viewer.engine.params import Parameters, formula_uniform
from viewer.kit.formula import Formula, glsl_vector, parse

SOURCES = {"x": "p.x", "y": "p.y", "z": "p.z", "t": "u_frame.time"}
ZERO = parse("0")


def formula_include(params: Parameters, name: str) -> str:
    """GLSL for the formula parameter ``name``: ``float NAME(vec3 p)`` and ``vec3 NAME_gradient(vec3 p)``.

    The numbers that the formula mentions become uniforms that every program gets. The time is read
    from ``lib/frame.glsl``, which has to be included first, and only where the formula has a ``t``.
    """
    formula: Formula = params.get(name)
    variables = params.field(name).limits()["variables"]
    sources = {variable: source for variable, source in SOURCES.items() if variable in variables}
    numbers = [variable for variable in formula.variables if variable not in sources]
    sources |= {number: formula_uniform(name, number) for number in numbers}
    arguments = list(formula.variables)
    gradient = formula.gradient()
    slopes = [gradient[axis] if axis in variables else ZERO for axis in "xyz"]
    passed = ", ".join(sources[argument] for argument in arguments)
    return "\n".join([
        formula.glsl(f"{name}_formula", arguments),
        glsl_vector(f"{name}_formula_gradient", slopes, arguments),
        *(f"uniform float {sources[number]};" for number in numbers),
        f"float {name}(vec3 p) {{ return {name}_formula({passed}); }}",
        f"vec3 {name}_gradient(vec3 p) {{ return {name}_formula_gradient({passed}); }}",
        ""])
