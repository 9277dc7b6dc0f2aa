"""A formula parameter as an include for shaders, with its exact gradient."""

from __future__ import annotations

from viewer.engine.params import Parameters, formula_uniform
from viewer.kit.formula import Formula, glsl_vector


def formula_include(params: Parameters, name: str) -> str:
    """GLSL for the formula parameter ``name``: ``float NAME(vec3 p, float t)`` and ``vec3 NAME_gradient``.

    The parameters that the formula mentions become uniforms that every program gets.
    """
    formula: Formula = params.get(name)
    place = ("x", "y", "z", "t")
    numbers = [variable for variable in formula.variables if variable not in place]
    arguments = [*place, *numbers]
    gradient = formula.gradient()
    functions = [
        formula.glsl(f"{name}_formula", arguments),
        glsl_vector(f"{name}_formula_gradient", [gradient["x"], gradient["y"], gradient["z"]], arguments),
    ]
    uniforms = [f"uniform float {formula_uniform(name, number)};" for number in numbers]
    passed = ", ".join(["p.x", "p.y", "p.z", "t", *(formula_uniform(name, number) for number in numbers)])
    wrappers = [
        f"float {name}(vec3 p, float t) {{ return {name}_formula({passed}); }}",
        f"vec3 {name}_gradient(vec3 p, float t) {{ return {name}_formula_gradient({passed}); }}",
    ]
    return "\n".join([*functions, *uniforms, *wrappers, ""])

