"""What a scene writes in its ``Params``: one function for each kind of parameter.

All take ``group``, the heading under which the parameter stands in the window, and ``when``, the condition
without which it has no effect, such as ``"source=volume"``, ``"method=cubes|tetrahedra"``, ``"slice!=none"``,
``"walk"``, ``"!walk"`` or several joined by ``", "``. They are typed as the values they hold, so that a scene's
own code type-checks.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from viewer.engine.color_field import Color
from viewer.engine.file_field import File
from viewer.engine.formula_field import FormulaField
from viewer.engine.life_fields import GradientField, LifeCurveField
from viewer.engine.number_fields import Integer, Interval, Slider
from viewer.engine.word_fields import Choice, Text, Toggle


def slider(default: float, minimum: float, maximum: float, help: str, *, unit: str = "",
           logarithmic: bool = False, rebuild: bool = False, handy: tuple[float, float] | None = None,
           group: str = "", when: str = "") -> Any:
    """A real number from ``minimum`` to ``maximum``; ``logarithmic`` suits ranges over decades.

    ``handy`` is the part of the range that the slider on screen offers; typing reaches the rest.
    """
    return Slider(default, minimum, maximum, help, unit=unit, logarithmic=logarithmic, rebuild=rebuild,
                  handy=handy).placed(group, when)


def integer(default: int, minimum: int, maximum: int, help: str, *, unit: str = "",
            logarithmic: bool = False, rebuild: bool = False, group: str = "", when: str = "") -> Any:
    """A whole number from ``minimum`` to ``maximum``."""
    return Integer(default, minimum, maximum, help, unit=unit, logarithmic=logarithmic,
                   rebuild=rebuild).placed(group, when)


def interval(default: tuple[float, float], minimum: float, maximum: float, help: str, *, unit: str = "",
             logarithmic: bool = False, rebuild: bool = False, handy: tuple[float, float] | None = None,
             group: str = "", when: str = "") -> Any:
    """A range inside ``minimum`` to ``maximum``, as a pair; dragging suits the part that is ``handy``."""
    return Interval(default, minimum, maximum, help, unit=unit, logarithmic=logarithmic, rebuild=rebuild,
                    handy=handy).placed(group, when)


def toggle(default: bool, help: str, *, rebuild: bool = False, group: str = "", when: str = "") -> Any:
    """A yes or no."""
    return Toggle(default, help, rebuild=rebuild).placed(group, when)


def choice(default: str, options: Sequence[str] | Mapping[str, str], help: str, *, rebuild: bool = False,
           group: str = "", when: str = "") -> Any:
    """One of several names; a mapping gives each name a sentence. In shaders: its index, an int."""
    return Choice(default, options, help, rebuild=rebuild).placed(group, when)


def color(default: str, help: str, *, rebuild: bool = False, group: str = "", when: str = "") -> Any:
    """A colour, declared as ``"#ff8800"`` and read as sRGB in 0 to 1; in shaders a linear vec3."""
    return Color(default, help, rebuild=rebuild).placed(group, when)


def curve(default: object, minimum: float, maximum: float, help: str, *, unit: str = "", rebuild: bool = False,
          group: str = "", when: str = "") -> Any:
    """A number over a life, ``"0:0, 0.2:1, 1:0"``; read as a ``viewer.kit.life_curve.LifeCurve``, not in shaders.

    Its values stay from ``minimum`` to ``maximum``.
    """
    return LifeCurveField(default, minimum, maximum, help, unit=unit, rebuild=rebuild).placed(group, when)


def gradient(default: object, help: str, *, rebuild: bool = False, group: str = "", when: str = "") -> Any:
    """A colour over a life, ``"0:#ffffff, 1:#300000"``; read as a ``viewer.kit.gradient.Gradient``, not in shaders."""
    return GradientField(default, help, rebuild=rebuild).placed(group, when)


def text(default: str, help: str, *, longest: int = 200, pattern: str = "", example: str = "",
         rebuild: bool = False, group: str = "", when: str = "") -> Any:
    """A line of text of at most ``longest`` characters: where there is a ``pattern``, empty or like ``example``."""
    return Text(default, help, longest=longest, pattern=pattern, example=example, rebuild=rebuild).placed(group, when)


def formula(default: str, help: str, *, variables: Sequence[str] = ("x", "y", "z", "t"),
            rebuild: bool = False, group: str = "", when: str = "") -> Any:
    """An editable function of ``variables``; read as a ``viewer.kit.formula.Formula``."""
    return FormulaField(default, help, variables=variables, rebuild=rebuild).placed(group, when)


def file(default: str | Path | None, help: str, *, suffixes: Sequence[str] = (), rebuild: bool = True,
         group: str = "", when: str = "") -> Any:
    """An existing file with one of ``suffixes``, or None; read as a ``pathlib.Path``."""
    return File(None if default is None else str(default), help, suffixes=suffixes, rebuild=rebuild).placed(group, when)
