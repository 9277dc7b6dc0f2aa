"""Parameters that are numbers: sliders, integers and ranges."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from viewer.engine.fields import Field, ParameterError, T, Uniform


class Number(Field[T]):
    """What sliders, integers and intervals share: finite numbers between two ends."""

    def __init__(self, default: object, minimum: float, maximum: float, help: str, *, unit: str = "",
                 logarithmic: bool = False, rebuild: bool = False, handy: tuple[float, float] | None = None) -> None:
        if not minimum < maximum or (logarithmic and minimum <= 0):
            raise ParameterError(f"a range from {minimum} to {maximum} holds no numbers to choose from")
        self.minimum, self.maximum, self.logarithmic, self.handy = minimum, maximum, logarithmic, handy
        super().__init__(default, help, unit=unit, rebuild=rebuild)

    @property
    def range_text(self) -> str:
        """The range as messages and tooltips write it."""
        return f"{self.minimum:g} to {self.maximum:g}"

    @property
    def widget_range(self) -> tuple[float, float]:
        """The ends of the slider on screen; typing reaches all of the range."""
        return self.handy or (self.minimum, self.maximum)

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
        super().__init__(1.0, -1e6, 1e6, f"Your own name in {formula_name}", handy=(-10.0, 10.0))
        self.name = name


class Integer(Number[int]):
    """A whole number."""

    kind = "integer"

    @property
    def range_text(self) -> str:
        return f"{int(self.minimum)} to {int(self.maximum)}"

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
            ends: Sequence[object] = value.split("..") if "..." not in value else ()
            ends = list(ends) * 2 if len(ends) == 1 else ends
        elif isinstance(value, (Sequence, np.ndarray)) and np.ndim(value):
            ends = list(value)
        else:
            ends = [value, value]
        if len(ends) != 2 or (isinstance(value, str) and not all(_is_number(end) for end in ends)):
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


def _is_number(text: object) -> bool:
    try:
        float(str(text))
    except ValueError:
        return False
    return True
