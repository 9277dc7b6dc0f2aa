"""Demoscope: computer graphics, live. What a scene author or a script imports.

The names are fetched when first asked for, so that ``viewer.kit`` needs no OpenGL.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from viewer.engine.annotations import Click, Handle, Label, Table
    from viewer.engine.camera import Orbit
    from viewer.engine.carried_words import CarriedWords
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
    from viewer.engine.fish.fins import FinParameters
    from viewer.engine.fish.flock import Flock
    from viewer.engine.fish.look import FishLookParameters
    from viewer.engine.fish.model import FishModel, detail_of
    from viewer.engine.fish.school import SchoolParameters
    from viewer.engine.fish.spine import Spine
    from viewer.engine.fish.swimming import Swimming, SwimParameters
    from viewer.engine.formula_shader import formula_include
    from viewer.engine.gpu import Gpu
    from viewer.engine.insets import Insets
    from viewer.engine.isosurface import Isosurface
    from viewer.engine.limb_captions import LimbCaptions
    from viewer.engine.limb_report import limb_comparison, limb_curves
    from viewer.engine.limb_skin import LimbModel, LimbSkin
    from viewer.engine.params import Parameters
    from viewer.engine.particles.draw_timer import DrawTimer
    from viewer.engine.particles.inspector import InspectParameters, ParticleInspector
    from viewer.engine.particles.look import LookParameters
    from viewer.engine.particles.solid import Solid
    from viewer.engine.particles.sprites import Sprites
    from viewer.engine.particles.strands import Strands
    from viewer.engine.particles.system import ParticleParameters, ParticleSystem
    from viewer.engine.particles.trails import TrailParameters, Trails, trail_bytes
    from viewer.engine.program import Program, VertexArray
    from viewer.engine.scene import ColorScale, Curve, Geometry, Measurements, Scene, Studio
    from viewer.engine.sketch import Sketch, strokes
    from viewer.engine.skin import BonePalette, skin_attributes
    from viewer.engine.stage import Stage
    from viewer.engine.underwater import WATERS, Underwater, WaterParameters
    from viewer.engine.vertex_textures import Wanted
    from viewer.errors import DemoscopeError
    from viewer.output.headless import headless, render

__version__ = "0.1.0"

__all__ = [
    "WATERS",
    "BonePalette",
    "CarriedWords",
    "CellInspector",
    "Click",
    "ColorScale",
    "Curve",
    "DemoscopeError",
    "DrawTimer",
    "FieldSamples",
    "FinParameters",
    "FishLookParameters",
    "FishModel",
    "Flock",
    "Geometry",
    "Gpu",
    "Handle",
    "Insets",
    "InspectParameters",
    "Isosurface",
    "Label",
    "Lattice",
    "LimbCaptions",
    "LimbModel",
    "LimbSkin",
    "LookParameters",
    "Measurements",
    "Orbit",
    "ParameterError",
    "Parameters",
    "ParticleInspector",
    "ParticleParameters",
    "ParticleSystem",
    "Program",
    "Scene",
    "SchoolParameters",
    "Sketch",
    "Solid",
    "Spine",
    "Sprites",
    "Stage",
    "Strands",
    "Studio",
    "SwimParameters",
    "Swimming",
    "Table",
    "TrailParameters",
    "Trails",
    "Underwater",
    "VertexArray",
    "Wanted",
    "WaterParameters",
    "choice",
    "color",
    "curve",
    "detail_of",
    "file",
    "formula",
    "formula_include",
    "gradient",
    "headless",
    "integer",
    "interval",
    "limb_comparison",
    "limb_curves",
    "render",
    "room_for_samples",
    "skin_attributes",
    "slider",
    "strokes",
    "text",
    "toggle",
    "trail_bytes",
]

# Where they live, the first that has a name being its home.
_HOMES = ("errors", "engine.fields", "engine.params", "engine.declarations", "engine.camera", "engine.annotations",
          "engine.gpu", "engine.formula_shader", "engine.field_samples", "engine.vertex_textures",
          "engine.isosurface", "engine.cell_inspector", "engine.insets", "engine.sketch", "engine.skin",
          "engine.limb_skin", "engine.limb_captions", "engine.carried_words", "engine.limb_report",
          "engine.scene", "engine.stage", "output.headless",
          *(f"engine.particles.{noun}" for noun in ("system", "look", "sprites", "solid", "inspector", "draw_timer",
                                                    "trails", "strands")),
          "engine.program", "engine.underwater",
          *(f"engine.fish.{noun}" for noun in ("swimming", "fins", "school", "flock", "look", "model", "spine")))


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    for home in _HOMES:
        module = import_module(f"{__name__}.{home}")
        if name in vars(module):
            globals()[name] = vars(module)[name]
            return globals()[name]
    raise AttributeError(f"module {__name__!r} has lost {name!r}")
