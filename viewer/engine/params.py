"""A scene's parameters: declared once, and from there to widgets, options, presets and uniforms.

    class Params(Parameters):
        amplitude: float = slider(0.05, 0.0, 0.5, "Ripple height, in radii")

Reading ``params.amplitude`` gives a float; assigning checks the value first. A name in a formula that
nobody declared becomes a slider of its own for as long as the formula uses it. A class with several bases
has the parameters of each, in the order of the bases.
"""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from typing import Any, ClassVar, TypeAlias

from viewer.engine.conditions import Condition, conditions_of
from viewer.engine.fields import Field, ParameterError, Uniform, nearest
from viewer.engine.formula_field import FormulaField
from viewer.engine.number_fields import FormulaSlider, Integer, Number, Slider
from viewer.engine.word_fields import Toggle
from viewer.kit.formula import Formula

Snapshot: TypeAlias = tuple[dict[str, Any], dict[str, Field[Any]]]


class Parameters:
    """Base of every scene's ``Params``; an instance holds one value for each declared field.

    ``seed`` feeds whatever a scene draws at random. ``revision`` grows with every change.
    """

    declared: ClassVar[dict[str, Field[Any]]] = {}
    _conditions: ClassVar[dict[str, Condition]] = {}

    def __init_subclass__(cls) -> None:
        own = {name: field for name, field in vars(cls).items() if isinstance(field, Field)}
        taken = [name for name in own if hasattr(Parameters, name)]
        if taken:
            raise ParameterError(f"{taken[0]} cannot name a parameter: Parameters already uses it")
        inherited = [base.declared for base in cls.__bases__ if issubclass(base, Parameters)]
        cls.declared = {name: field for fields in (*inherited, own) for name, field in fields.items()}
        cls._conditions = conditions_of(cls.declared)

    def __init__(self, values: Mapping[str, object] | None = None, *, seed: int = 0) -> None:
        self.seed = seed
        self.revision = 0
        self._offered: dict[str, Field[Any]] = {}
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

    def offer(self, name: str, low: float, high: float) -> None:
        """Let the slider of a number on screen run from ``low`` to ``high``, here and now."""
        field = copy(self.field(name))
        if isinstance(field, Number) and max(low, field.minimum) < min(high, field.maximum):
            field.handy = max(low, field.minimum), min(high, field.maximum)
            self._offered[name] = field

    def offered(self, name: str) -> Field[Any]:
        """The declaration of a parameter, as its widget is to show it."""
        return self._offered.get(name) or self.field(name)

    def is_default(self, name: str) -> bool:
        """Whether a parameter still has its declared value."""
        field = self.field(name)
        return not _differs(field, field.default, self.get(name))

    def is_active(self, name: str) -> bool:
        """Whether a parameter now has any effect, as far as its declaration tells; it can be set all the same."""
        if name in self._born:
            return any(self.is_active(formula) for formula in self.formulas_with(name))
        return all(term.holds(self._values) for term in self.condition(name))

    def condition(self, name: str) -> Condition:
        """What has to hold for a declared parameter to have any effect; empty where it always has one."""
        self.field(name)
        return self._conditions.get(name, ())

    def formulas_with(self, variable: str) -> list[str]:
        """The formulas, by name, that mention ``variable``."""
        formulas = [name for name, field in self.declared.items() if isinstance(field, FormulaField)]
        return [name for name in formulas if variable in self.get(name).variables]

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
                born[variable] = FormulaSlider(variable, name).placed(field.group, field.when)
            elif not isinstance(declared[variable], (Slider, Integer, Toggle)):
                kind = declared[variable].kind
                raise ParameterError(f"{name}: {variable} is a {kind}; a formula takes numbers only")
    return born
