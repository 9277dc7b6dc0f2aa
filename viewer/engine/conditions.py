"""When a parameter has any effect, told by the values of toggles and choices.

    source=volume               the choice ``source`` stands at ``volume``
    method=cubes|tetrahedra     at either of them
    slice!=none                 at anything else
    walk, !paused               the toggle ``walk`` is on and ``paused`` is off: a comma means and
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from viewer.engine.fields import Field, ParameterError, nearest
from viewer.engine.word_fields import Choice, Toggle

TERM = re.compile(r"(?P<off>!?)\s*(?P<name>\w+)|(?P<choice>\w+)\s*(?P<sign>!?=)(?P<options>.*)", re.DOTALL)


@dataclass(frozen=True)
class Term:
    """One comparison: whether ``name`` has one of ``values``, or, ``negated``, none of them."""

    name: str
    values: tuple[object, ...]
    negated: bool

    def holds(self, values: Mapping[str, Any]) -> bool:
        """Whether it is so for these values."""
        return (values[self.name] in self.values) != self.negated

    def words(self) -> str:
        """The comparison as one says it: ``method is cubes or tetrahedra``, ``walk is off``."""
        name = self.name.replace("_", " ")
        if self.values == (True,):
            return f"{name} is {'off' if self.negated else 'on'}"
        options = [str(value).replace("_", " ") for value in self.values]
        if len(options) > 1 and self.negated:
            return f"{name} is neither {' nor '.join(options)}"
        return f"{name} is {'not ' if self.negated else ''}{' or '.join(options)}"


Condition: TypeAlias = tuple[Term, ...]


def conditions_of(fields: Mapping[str, Field[Any]]) -> dict[str, Condition]:
    """The condition of each field that has one, by name; raises ParameterError for one that cannot be."""
    return {name: _parsed(field, fields) for name, field in fields.items() if field.when}


def _parsed(field: Field[Any], fields: Mapping[str, Field[Any]]) -> Condition:
    try:
        return tuple(_term(text.strip(), field.name, fields) for text in field.when.split(","))
    except ParameterError as error:
        raise ParameterError(f"{field.name}: when = {field.when}: {error}") from None


def _term(text: str, owner: str, fields: Mapping[str, Field[Any]]) -> Term:
    match = TERM.fullmatch(text)
    if match is None:
        raise ParameterError(f"{text or 'nothing'} is not of the form choice=option, choice!=option, toggle or !toggle")
    name = match["name"] or match["choice"]
    known = tuple(other for other in fields if other != owner)
    if name not in known:
        raise ParameterError(f"unknown parameter {name}{nearest(name, known)}")
    field = fields[name]
    if match["name"]:
        return _toggled(field, bool(match["off"]))
    options = tuple(option.strip() for option in match["options"].split("|"))
    return _chosen(field, options, match["sign"] == "!=")


def _toggled(field: Field[Any], off: bool) -> Term:
    if not isinstance(field, Toggle):
        raise ParameterError(f"{field.name} is a {field.kind} and cannot stand alone; only a toggle can")
    return Term(field.name, (True,), off)


def _chosen(field: Field[Any], options: tuple[str, ...], negated: bool) -> Term:
    if isinstance(field, Toggle):
        raise ParameterError(f"{field.name} is a toggle; write {field.name} or !{field.name}")
    if not isinstance(field, Choice):
        raise ParameterError(f"{field.name} is a {field.kind}; only choices and toggles decide about others")
    return Term(field.name, tuple(field.parse(option) for option in options), negated)
