"""A scene's parameters: declared once, and from there to widgets, options, presets and uniforms.

    class Params(Parameters):
        amplitude: float = slider(0.05, 0.0, 0.5, "Ripple height, in radii")

Reading ``params.amplitude`` gives a float; assigning checks the value first. A name in a formula that
nobody declared becomes a slider of its own for as long as the formula uses it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar, TypeAlias

from viewer.engine.color_field import Color
from viewer.engine.fields import Field, ParameterError, Uniform, nearest
from viewer.engine.file_field import File
from viewer.engine.formula_field import FormulaField
from viewer.engine.number_fields import FormulaSlider, Integer, Interval, Slider
from viewer.engine.word_fields import Choice, Text, Toggle
from viewer.kit.formula import Formula

Snapshot: TypeAlias = tuple[dict[str, Any], dict[str, Field[Any]]]


class Parameters:
    """Base of every scene's ``Params``; an instance holds one value for each declared field.

    ``seed`` feeds whatever a scene draws at random. ``revision`` grows with every change.
    """

    declared: ClassVar[dict[str, Field[Any]]] = {}

    def __init_subclass__(cls) -> None:
        own = {name: field for name, field in vars(cls).items() if isinstance(field, Field)}
        taken = [name for name in own if hasattr(Parameters, name)]
        if taken:
            raise ParameterError(f"{taken[0]} cannot name a parameter: Parameters already uses it")
        cls.declared = {**cls.declared, **own}

    def __init__(self, values: Mapping[str, object] | None = None, *, seed: int = 0) -> None:
        self.seed = seed
        self.revision = 0
        self._values: dict[str, Any] = {name: field.default for name, field in self.declared.items()}
        self._born: dict[str, Field[Any]] = _fields_from_formulas(self.declared, self._values)
        self.update(values or {})

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name not in self._born:
            raise AttributeError(name)
        return self.get(name)

    @property
    def fields(self) -> dict[str, Field[Any]]:
        """Every parameter by name: the declared ones in order, then those that formulas gave rise to."""
        return {**self.declared, **self._born}

    def get(self, name: str) -> Any:
        """The value of a parameter; raises ParameterError with the nearest name if there is none."""
        return self._values.get(name, self.field(name).default)

    def field(self, name: str) -> Field[Any]:
        """The declaration of a parameter; raises ParameterError with the nearest name if there is none."""
        field = self.declared.get(name) or self._born.get(name)
        if field is None:
            raise ParameterError(f"unknown parameter {name}{nearest(name, tuple(self.fields))}")
        return field

    def set(self, name: str, value: object) -> None:
        """Set one parameter to a value of its kind or to the text of one."""
        self.update({name: value})

    def snapshot(self) -> Snapshot:
        """Every value, to be put back by ``restore``."""
        return dict(self._values), dict(self._born)

    def restore(self, snapshot: Snapshot) -> None:
        """Put every value back to what it was."""
        self._values, self._born = dict(snapshot[0]), dict(snapshot[1])
        self.revision += 1

    def update(self, values: Mapping[str, object]) -> frozenset[str]:
        """Set several parameters, all or none, and return the names of those that changed.

        Formulas come first, so that the names they bring can be set in the same call. Raises
        ParameterError.
        """
        after = dict(self._values)
        for name in values:
            if isinstance(self.declared.get(name), FormulaField):
                after[name] = self.declared[name].parse(values[name])
        born = _fields_from_formulas(self.declared, after)
        fields = {**self.declared, **born}
        for name, value in values.items():
            if name not in fields:
                raise ParameterError(f"unknown parameter {name}{nearest(name, tuple(fields))}")
            if not isinstance(fields[name], FormulaField):
                after[name] = fields[name].parse(value)
        changed = frozenset(name for name in values if name not in self._values
                            or _differs(fields[name], self._values[name], after[name]))
        if changed:
            self._values, self._born = after, born
            self.revision += 1
        return changed

    def reset(self, name: str | None = None) -> frozenset[str]:
        """Back to the default, for one parameter or for all; returns the names that changed."""
        return self.update(self.completed({}) if name is None else {name: self.field(name).default})

    def completed(self, values: Mapping[str, object]) -> dict[str, object]:
        """``values``, and the default of each parameter that they leave out, their formulas' own sliders too."""
        complete = {name: values.get(name, field.default) for name, field in self.declared.items()}
        formulas = {name: field.parse(complete[name]) for name, field in self.declared.items()
                    if isinstance(field, FormulaField)}
        born = _fields_from_formulas(self.declared, formulas)
        return {**complete, **{name: field.default for name, field in born.items()}, **values}

    def is_default(self, name: str) -> bool:
        """Whether a parameter still has its declared value."""
        field = self.field(name)
        return not _differs(field, field.default, self.get(name))

    def stored(self) -> dict[str, Any]:
        """Every value as a preset holds it."""
        return {name: field.stored(self.get(name)) for name, field in self.fields.items()}

    def uniforms(self) -> dict[str, Uniform]:
        """What shaders get, by uniform name: ``u_amplitude``, and for formulas what they mention."""
        values = {f"u_{name}": field.uniform(self.get(name)) for name, field in self.fields.items()}
        for name, field in self.declared.items():
            if isinstance(field, FormulaField):
                numbers = self.numbers(self.get(name))
                values |= {formula_uniform(name, number): value for number, value in numbers.items()}
        return {name: value for name, value in values.items() if value is not None}

    def numbers(self, formula: Formula) -> dict[str, float]:
        """The parameters that ``formula`` mentions, as numbers to evaluate it with."""
        names = [name for name in formula.variables if name in self.fields]
        return {name: float(self.get(name)) for name in names}


def formula_uniform(formula: str, name: str) -> str:
    """The uniform through which ``formula`` gets the number ``name``; its own, lest a shader declares both."""
    uniform = f"u_{formula}_{name}"
    return f"u_{formula}_x{name.encode().hex()}" if "__" in uniform else uniform     # GLSL keeps __ for itself


def _differs(field: Field[Any], before: Any, after: Any) -> bool:
    return bool(field.stored(before) != field.stored(after))


def _fields_from_formulas(declared: Mapping[str, Field[Any]], values: Mapping[str, Any]) -> dict[str, Field[Any]]:
    """A slider for every name in a formula that is neither its variable nor a declared number."""
    born: dict[str, Field[Any]] = {}
    for name, field in declared.items():
        if not isinstance(field, FormulaField):
            continue
        for variable in values[name].variables:
            if variable in field.variables or variable in born:
                continue
            if variable not in declared:
                born[variable] = FormulaSlider(variable, name)
            elif not isinstance(declared[variable], (Slider, Integer, Toggle)):
                kind = declared[variable].kind
                raise ParameterError(f"{name}: {variable} is a {kind}; a formula takes numbers only")
    return born


# The declarations below are typed as the values they hold, so that a scene's own code type-checks.

def slider(default: float, minimum: float, maximum: float, help: str, *, unit: str = "",
           logarithmic: bool = False, rebuild: bool = False) -> Any:
    """A real number from ``minimum`` to ``maximum``; ``logarithmic`` suits ranges over decades."""
    return Slider(default, minimum, maximum, help, unit=unit, logarithmic=logarithmic, rebuild=rebuild)


def integer(default: int, minimum: int, maximum: int, help: str, *, unit: str = "",
            logarithmic: bool = False, rebuild: bool = False) -> Any:
    """A whole number from ``minimum`` to ``maximum``."""
    return Integer(default, minimum, maximum, help, unit=unit, logarithmic=logarithmic, rebuild=rebuild)


def interval(default: tuple[float, float], minimum: float, maximum: float, help: str, *, unit: str = "",
             logarithmic: bool = False, rebuild: bool = False) -> Any:
    """A range inside ``minimum`` to ``maximum``, as a pair."""
    return Interval(default, minimum, maximum, help, unit=unit, logarithmic=logarithmic, rebuild=rebuild)


def toggle(default: bool, help: str, *, rebuild: bool = False) -> Any:
    """A yes or no."""
    return Toggle(default, help, rebuild=rebuild)


def choice(default: str, options: Sequence[str] | Mapping[str, str], help: str, *, rebuild: bool = False) -> Any:
    """One of several names; a mapping gives each name a sentence. In shaders: its index, an int."""
    return Choice(default, options, help, rebuild=rebuild)


def color(default: str, help: str, *, rebuild: bool = False) -> Any:
    """A colour, declared as ``"#ff8800"`` and read as sRGB in 0 to 1; in shaders a linear vec3."""
    return Color(default, help, rebuild=rebuild)


def text(default: str, help: str, *, longest: int = 200, rebuild: bool = False) -> Any:
    """A line of text of at most ``longest`` characters."""
    return Text(default, help, longest=longest, rebuild=rebuild)


def formula(default: str, help: str, *, variables: Sequence[str] = ("x", "y", "z", "t"),
            rebuild: bool = False) -> Any:
    """An editable function of ``variables``; read as a ``viewer.kit.formula.Formula``."""
    return FormulaField(default, help, variables=variables, rebuild=rebuild)


def file(default: str | Path | None, help: str, *, suffixes: Sequence[str] = (), rebuild: bool = True) -> Any:
    """An existing file with one of ``suffixes``, or None; read as a ``pathlib.Path``."""
    return File(None if default is None else str(default), help, suffixes=suffixes, rebuild=rebuild)
