"""Parameters that are functions the audience edits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from viewer.engine.fields import Field, ParameterError
from viewer.kit.formula import Formula, FormulaError, parse


class FormulaField(Field[Formula]):
    """A function that the audience edits, in ``variables``, in number parameters and in names of its own."""

    kind = "formula"

    def __init__(self, default: str, help: str, *, variables: Sequence[str] = ("x", "y", "z", "t"),
                 rebuild: bool = False) -> None:
        self.variables = tuple(variables)
        super().__init__(default, help, rebuild=rebuild)

    def parse(self, value: object) -> Formula:
        if isinstance(value, Formula):
            return value
        try:
            return parse(value if isinstance(value, str) else format(value))
        except FormulaError as error:
            raise ParameterError(f"{self.name}: {error}" if self.name else str(error)) from error

    def text(self, value: Formula) -> str:
        return value.text

    def stored(self, value: Formula) -> str:
        return value.text

    def limits(self) -> dict[str, Any]:
        return {"variables": list(self.variables)}
