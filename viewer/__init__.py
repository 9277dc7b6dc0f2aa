"""Demoscope: computer graphics, live. What a scene author or a script imports."""

from __future__ import annotations

from viewer.engine.camera import Orbit
from viewer.engine.fields import ParameterError
from viewer.engine.formula_shader import formula_include
from viewer.engine.gpu import Gpu
from viewer.engine.params import (
    Parameters,
    choice,
    color,
    file,
    formula,
    integer,
    interval,
    slider,
    text,
    toggle,
)
from viewer.engine.scene import Curve, Geometry, Measurements, Scene, Studio
from viewer.engine.stage import Stage
from viewer.errors import DemoscopeError
from viewer.output.headless import headless, render

__version__ = "0.1.0"

__all__ = [
    "Curve",
    "DemoscopeError",
    "Geometry",
    "Gpu",
    "Measurements",
    "Orbit",
    "ParameterError",
    "Parameters",
    "Scene",
    "Stage",
    "Studio",
    "choice",
    "color",
    "file",
    "formula",
    "formula_include",
    "headless",
    "integer",
    "interval",
    "render",
    "slider",
    "text",
    "toggle",
]
