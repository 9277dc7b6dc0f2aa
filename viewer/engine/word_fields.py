"""Parameters that are words: yes or no, one of several names, a line of text."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

from viewer.engine.fields import Field, Uniform, nearest


class Toggle(Field[bool]):
    """Yes or no."""

    kind = "toggle"
    WORDS: ClassVar[Mapping[str, bool]] = {
        "true": True, "yes": True, "on": True, "1": True, "false": False, "no": False, "off": False, "0": False}

    def parse(self, value: object) -> bool:
        if isinstance(value, bool):
            return value
        word = str(value).strip().lower()
        if word not in self.WORDS:
            raise self.refuse(value, "is neither true nor false")
        return self.WORDS[word]

    def text(self, value: bool) -> str:
        return "true" if value else "false"

    def uniform(self, value: bool) -> Uniform:
        return value


class Choice(Field[str]):
    """One of a few names; a mapping gives each a sentence for its tooltip. Shaders get its index."""

    kind = "choice"

    def __init__(self, default: str, options: Sequence[str] | Mapping[str, str], help: str, *,
                 rebuild: bool = False) -> None:
        self.options = tuple(options)
        self.notes = dict(options) if isinstance(options, Mapping) else {}
        super().__init__(default, help, rebuild=rebuild)

    def parse(self, value: object) -> str:
        name = str(value).strip()
        if name not in self.options:
            raise self.refuse(value, f"is not one of {', '.join(self.options)}{nearest(name, self.options)}")
        return name

    def uniform(self, value: str) -> Uniform:
        return self.options.index(value)

    def limits(self) -> dict[str, Any]:
        return {"options": list(self.options), "option_help": self.notes}


class Text(Field[str]):
    """A line of text; where ``pattern``, a regular expression, is given, empty or all of it as in ``example``."""

    kind = "text"

    def __init__(self, default: str, help: str, *, longest: int = 200, pattern: str = "", example: str = "",
                 rebuild: bool = False) -> None:
        self.longest, self.pattern, self.example = longest, pattern, example
        super().__init__(default, help, rebuild=rebuild)

    def parse(self, value: object) -> str:
        if not isinstance(value, str):
            raise self.refuse(value, "is not text")
        if len(value) > self.longest or not value.isprintable():
            raise self.refuse(value, f"is not one line of at most {self.longest} characters")
        if self.pattern and value.strip() and not re.fullmatch(self.pattern, value.strip()):
            raise self.refuse(value, f"is not written like {self.example}")
        return value

    def limits(self) -> dict[str, Any]:
        return {"longest": self.longest, "pattern": self.pattern, "example": self.example}
