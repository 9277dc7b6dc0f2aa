"""A formula parameter as an include for shaders, with its exact gradient."""

from __future__ import annotations

from viewer.engine.params import Parameters, formula_uniform
from viewer.kit.formula import Formula, glsl_vector

AXES = ("x", "y", "z")


def formula_include(params: Parameters, name: str) -> str:
    """GLSL for the formula parameter ``name``: ``float NAME(vec3 p)`` and ``vec3 NAME_gradient(vec3 p)``.

    The numbers that the formula mentions become uniforms that every program gets. The time is read
    from ``lib/frame.glsl``, which has to be included first, and only where the formula has a ``t``.
    """
    formula: Formula = params.get(name)
    sources = {"x": "p.x", "y": "p.y", "z": "p.z", "t": "u_frame.time"}
    numbers = [variable for variable in formula.variables if variable not in sources]
    sources |= {number: formula_uniform(name, number) for number in numbers}
    arguments = [*AXES, *(variable for variable in formula.variables if variable not in AXES)]
    gradient = formula.gradient()
    passed = ", ".join(sources[argument] for argument in arguments)
    return "\n".join([
        formula.glsl(f"{name}_formula", arguments),
        glsl_vector(f"{name}_formula_gradient", [gradient[axis] for axis in AXES], arguments),
        *(f"uniform float {sources[number]};" for number in numbers),
        f"float {name}(vec3 p) {{ return {name}_formula({passed}); }}",
        f"vec3 {name}_gradient(vec3 p) {{ return {name}_formula_gradient({passed}); }}",
        ""])
