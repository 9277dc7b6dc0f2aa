"""The nine kinds of parameter, each with its parsing, its limits and its three spellings.

A field is declared once, in a scene's ``Params``. Its ``parse`` takes a Python value of the kind or
the text that the command line takes; ``text`` gives that text back; ``stored`` gives what a preset or
JSON holds; ``uniform`` gives what a shader gets. The window picks its widget by ``kind``.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar, Generic, TypeAlias, TypeVar

from viewer.errors import DemoscopeError
from viewer.kit.formula import Formula, FormulaError, parse

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
    camera, the clock and every other value.
    """

    kind: ClassVar[str]

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
        return about | {"unit": self.unit, "help": self.help, "rebuild": self.rebuild} | self.limits()

    def limits(self) -> dict[str, Any]:
        """The allowed values, ready for JSON."""
        return {}

    def refuse(self, value: object, why: str) -> ParameterError:
        """The error for ``value``, its text cut to a length that one can read."""
        shown = str(value)
        shown = shown if len(shown) <= 60 else shown[:57] + "..."
        return ParameterError(" ".join(f"{self.name or 'default'} = {shown} {why}".split()))


class Number(Field[T]):
    """What sliders, integers and intervals share: finite numbers between two ends."""

    def __init__(self, default: object, minimum: float, maximum: float, help: str, *,
                 unit: str = "", logarithmic: bool = False, rebuild: bool = False) -> None:
        if not minimum < maximum or (logarithmic and minimum <= 0):
            raise ParameterError(f"a range from {minimum} to {maximum} holds no numbers to choose from")
        self.minimum, self.maximum, self.logarithmic = minimum, maximum, logarithmic
        super().__init__(default, help, unit=unit, rebuild=rebuild)

    @property
    def range_text(self) -> str:
        """The range as messages and tooltips write it."""
        return f"{self.minimum:g} to {self.maximum:g}"

    @property
    def widget_range(self) -> tuple[float, float]:
        """The ends of the slider on screen."""
        return self.minimum, self.maximum

    def limits(self) -> dict[str, Any]:
        return {"minimum": self.minimum, "maximum": self.maximum, "logarithmic": self.logarithmic}

    def spelled(self, number: float) -> str:
        """``number`` as short as single precision allows, unless that rounds it out of the range."""
        short = f"{number:.9g}"
        return short if self.minimum <= float(short) <= self.maximum else repr(float(number))

    def number(self, value: object, whole: object) -> float:
        """``value`` as a finite float inside the range; ``whole`` is what the message quotes."""
        try:
            if isinstance(value, bool):
                raise TypeError
            number = float(value)  # type: ignore[arg-type]
        except (TypeError, ValueError, OverflowError):
            raise self.refuse(whole, f"is not a number; allowed: {self.range_text}") from None
        if not math.isfinite(number):
            raise self.refuse(whole, f"is not a finite number; allowed: {self.range_text}")
        if not self.minimum <= number <= self.maximum:
            raise self.refuse(whole, f"is outside {self.range_text}")
        return number


class Slider(Number[float]):
    """A real number."""

    kind = "slider"

    def parse(self, value: object) -> float:
        return self.number(value, value)

    def text(self, value: float) -> str:
        return self.spelled(value)

    def uniform(self, value: float) -> Uniform:
        return value


class FormulaSlider(Slider):
    """The slider that a name nobody declared gets when a formula uses it.

    Nobody stated a range either, so the widget offers a handy one and typing reaches further.
    """

    def __init__(self, name: str, formula_name: str) -> None:
        super().__init__(1.0, -1e6, 1e6, f"Your own name in {formula_name}")
        self.name = name

    @property
    def widget_range(self) -> tuple[float, float]:
        return -10.0, 10.0


class Integer(Number[int]):
    """A whole number."""

    kind = "integer"

    def parse(self, value: object) -> int:
        number = self.number(value, value)
        if number != round(number):
            raise self.refuse(value, f"is not a whole number; allowed: {self.range_text}")
        return int(number)

    def uniform(self, value: int) -> Uniform:
        return value


class Interval(Number[tuple[float, float]]):
    """A range from which something is drawn, written ``2..3``; a single number is a range of no width."""

    kind = "interval"

    def parse(self, value: object) -> tuple[float, float]:
        if isinstance(value, str):
            ends: Sequence[object] = value.split("..")
            ends = list(ends) * 2 if len(ends) == 1 else ends
        elif isinstance(value, Sequence):
            ends = value
        else:
            ends = [value, value]
        if len(ends) != 2:
            raise self.refuse(value, f"is not a range such as {self.minimum:g}..{self.maximum:g}")
        low, high = (self.number(end, value) for end in ends)
        if low > high:
            raise self.refuse(value, "has its ends swapped: the smaller comes first")
        return low, high

    def text(self, value: tuple[float, float]) -> str:
        return f"{self.spelled(value[0])}..{self.spelled(value[1])}"

    def stored(self, value: tuple[float, float]) -> list[float]:
        return list(value)

    def uniform(self, value: tuple[float, float]) -> Uniform:
        return value


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


class Color(Field[tuple[float, float, float]]):
    """An sRGB colour, written ``#ff8800`` or ``1,0.53,0``; shaders get it in linear light."""

    kind = "color"
    ALLOWED = "is not a colour such as #ff8800 or 1,0.53,0"

    def parse(self, value: object) -> tuple[float, float, float]:
        try:
            channels = self._channels(value)
        except (TypeError, ValueError, OverflowError):
            raise self.refuse(value, self.ALLOWED) from None
        if len(channels) != 3 or not all(0.0 <= channel <= 1.0 for channel in channels):
            raise self.refuse(value, self.ALLOWED)
        return channels[0], channels[1], channels[2]

    @staticmethod
    def _channels(value: object) -> list[float]:
        if not isinstance(value, str):
            return [float(channel) for channel in value]  # type: ignore[attr-defined]
        text = value.strip()
        if text.startswith("#"):
            if len(text) != 7:
                raise ValueError
            return [channel / 255.0 for channel in bytes.fromhex(text[1:])]
        return [float(channel) for channel in text.split(",")]

    def text(self, value: tuple[float, float, float]) -> str:
        return "#" + "".join(f"{round(channel * 255):02x}" for channel in value)

    def stored(self, value: tuple[float, float, float]) -> str:
        return self.text(value)

    def uniform(self, value: tuple[float, float, float]) -> Uniform:
        return tuple(linear_light(channel) for channel in value)


def linear_light(encoded: float) -> float:
    """One sRGB channel in 0 to 1 as linear light (IEC 61966-2-1)."""
    return encoded / 12.92 if encoded <= 0.04045 else ((encoded + 0.055) / 1.055) ** 2.4


class Text(Field[str]):
    """A line of text."""

    kind = "text"

    def __init__(self, default: str, help: str, *, longest: int = 200, rebuild: bool = False) -> None:
        self.longest = longest
        super().__init__(default, help, rebuild=rebuild)

    def parse(self, value: object) -> str:
        if not isinstance(value, str):
            raise self.refuse(value, "is not text")
        if len(value) > self.longest or not value.isprintable():
            raise self.refuse(value, f"is not one line of at most {self.longest} characters")
        return value

    def limits(self) -> dict[str, Any]:
        return {"longest": self.longest}


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


class File(Field[Path | None]):
    """A file to read, or none; ``suffixes`` says which kinds."""

    kind = "file"

    def __init__(self, default: str | None, help: str, *, suffixes: Sequence[str] = (),
                 rebuild: bool = True) -> None:
        self.suffixes = tuple(suffixes)
        super().__init__(default, help, rebuild=rebuild)

    def parse(self, value: object) -> Path | None:
        if value is None:
            return None
        if not isinstance(value, (str, Path)):
            raise self.refuse(value, "is not a file's path")
        if value == "":
            return None
        if self.suffixes and Path(value).suffix.lower() not in self.suffixes:
            raise self.refuse(value, f"does not end in {', '.join(self.suffixes)}")
        try:
            path = Path(value).expanduser()
            found = path.is_file()
        except (OSError, ValueError, RuntimeError):     # too long, a NUL, a user without a home
            found = False
        if not found:
            raise self.refuse(value, "is not a file that exists")
        return path

    def text(self, value: Path | None) -> str:
        return "" if value is None else str(value)

    def stored(self, value: Path | None) -> str:
        return self.text(value)

    def limits(self) -> dict[str, Any]:
        return {"suffixes": list(self.suffixes)}
