"""Demoscope: computer graphics, live. What a scene author or a script imports.

The names are fetched when first asked for, so that ``viewer.kit`` needs no OpenGL.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from viewer.engine.annotations import Click, Label, Table
    from viewer.engine.camera import Orbit
    from viewer.engine.cell_inspector import CellInspector
    from viewer.engine.declarations import (
        choice,
        color,
        curve,
        file,
        formula,
        gradient,
        integer,
        interval,
        slider,
        text,
        toggle,
    )
    from viewer.engine.field_samples import FieldSamples, Lattice, room_for_samples
    from viewer.engine.fields import ParameterError
    from viewer.engine.formula_shader import formula_include
    from viewer.engine.gpu import Gpu
    from viewer.engine.isosurface import Isosurface
    from viewer.engine.params import Parameters
    from viewer.engine.particles.draw_timer import DrawTimer
    from viewer.engine.particles.inspector import InspectParameters, ParticleInspector
    from viewer.engine.particles.look import LookParameters
    from viewer.engine.particles.solid import Solid
    from viewer.engine.particles.sprites import Sprites
    from viewer.engine.particles.strands import Strands
    from viewer.engine.particles.system import ParticleParameters, ParticleSystem
    from viewer.engine.particles.trails import TrailParameters, Trails, trail_bytes
    from viewer.engine.scene import ColorScale, Curve, Geometry, Measurements, Scene, Studio
    from viewer.engine.stage import Stage
    from viewer.engine.vertex_textures import Wanted
    from viewer.errors import DemoscopeError
    from viewer.output.headless import headless, render

__version__ = "0.1.0"

__all__ = [
    "CellInspector",
    "Click",
    "ColorScale",
    "Curve",
    "DemoscopeError",
    "DrawTimer",
    "FieldSamples",
    "Geometry",
    "Gpu",
    "InspectParameters",
    "Isosurface",
    "Label",
    "Lattice",
    "LookParameters",
    "Measurements",
    "Orbit",
    "ParameterError",
    "Parameters",
    "ParticleInspector",
    "ParticleParameters",
    "ParticleSystem",
    "Scene",
    "Solid",
    "Sprites",
    "Stage",
    "Strands",
    "Studio",
    "Table",
    "TrailParameters",
    "Trails",
    "Wanted",
    "choice",
    "color",
    "curve",
    "file",
    "formula",
    "formula_include",
    "gradient",
    "headless",
    "integer",
    "interval",
    "render",
    "room_for_samples",
    "slider",
    "text",
    "toggle",
    "trail_bytes",
]

# Where they live, the first that has a name being its home.
_HOMES = ("errors", "engine.fields", "engine.params", "engine.declarations", "engine.camera", "engine.annotations",
          "engine.gpu", "engine.formula_shader", "engine.field_samples", "engine.vertex_textures",
          "engine.isosurface", "engine.cell_inspector",
          "engine.scene", "engine.stage", "output.headless",
          *(f"engine.particles.{noun}" for noun in ("system", "look", "sprites", "solid", "inspector", "draw_timer",
                                                    "trails", "strands")))


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    for home in _HOMES:
        module = import_module(f"{__name__}.{home}")
        if name in vars(module):
            globals()[name] = vars(module)[name]
            return globals()[name]
    raise AttributeError(f"module {__name__!r} has lost {name!r}")
