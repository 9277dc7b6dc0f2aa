"""What the eleven kinds of parameter share: parsing, limits and three spellings.

A field is declared once, in a scene's ``Params``. Its ``parse`` takes a Python value of the kind or
the text that the command line takes; ``text`` gives that text back; ``stored`` gives what a preset or
JSON holds; ``uniform`` gives what a shader gets. The window picks its widget by ``kind``.
"""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from typing import Any, ClassVar, Generic, Self, TypeAlias, TypeVar

from viewer.errors import DemoscopeError

T = TypeVar("T")
Uniform: TypeAlias = float | int | bool | tuple[float, ...]


class ParameterError(DemoscopeError):
    """A parameter that does not exist, or a value that it does not take."""


def nearest(name: str, known: Sequence[str]) -> str:
    """``"; did you mean NAME?"`` for the known name closest to ``name``, or an empty string."""
    close = difflib.get_close_matches(name.lower(), known, n=1, cutoff=0.5)
    return f"; did you mean {close[0]}?" if close else ""


class Field(Generic[T]):
    """One declared parameter: its name, default, limits, unit, help and what a change entails.

    ``rebuild`` marks a parameter whose change needs a new scene; the stage makes one and keeps the
    camera, the clock and every other value. ``group`` is the heading under which it stands, ``when`` the
    condition, see ``conditions``, without which it has no effect.
    """

    kind: ClassVar[str]
    group: str = ""
    when: str = ""

    def __init__(self, default: object, help: str, *, unit: str = "", rebuild: bool = False) -> None:
        self.name = ""
        self.help = help
        self.unit = unit
        self.rebuild = rebuild
        self.default: T = self.parse(default)

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    def __get__(self, instance: Any, owner: type | None = None) -> Any:
        return self if instance is None else instance.get(self.name)

    def __set__(self, instance: Any, value: object) -> None:
        instance.set(self.name, value)

    def placed(self, group: str, when: str) -> Self:
        """The same field, under a heading and a condition."""
        self.group, self.when = group, when
        return self

    def parse(self, value: object) -> T:
        """The value meant by ``value``; raises ParameterError naming it and what is allowed."""
        raise NotImplementedError

    def text(self, value: T) -> str:
        """``value`` as one would type it after ``--set NAME=``."""
        return str(value)

    def stored(self, value: T) -> Any:
        """``value`` as TOML and JSON hold it; ``parse`` reads it back."""
        return value

    def uniform(self, value: T) -> Uniform | None:
        """``value`` as a shader's ``u_NAME`` gets it; None where a shader has no use for it."""
        return None

    def describe(self) -> dict[str, Any]:
        """Everything a script or a document needs to know of this parameter, ready for JSON."""
        about: dict[str, Any] = {"name": self.name, "kind": self.kind, "default": self.stored(self.default)}
        about |= {"unit": self.unit, "help": self.help, "rebuild": self.rebuild}
        return about | {"group": self.group, "when": self.when} | self.limits()

    def limits(self) -> dict[str, Any]:
        """The allowed values, ready for JSON."""
        return {}

    def refuse(self, value: object, why: str) -> ParameterError:
        """The error for ``value``, its text cut to a length that one can read."""
        shown = str(value)
        shown = shown if len(shown) <= 60 else shown[:57] + "..."
        return ParameterError(" ".join(f"{self.name or 'default'} = {shown} {why}".split()))
