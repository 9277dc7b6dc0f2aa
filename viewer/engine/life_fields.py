"""Parameters that hold over a life, from 0, its birth, to 1, its death: curves and gradients."""

from __future__ import annotations

from typing import Any

from viewer.engine.fields import Field, ParameterError
from viewer.kit.gradient import MOST_STOPS, Gradient
from viewer.kit.life_curve import MOST_POINTS, LifeCurve
from viewer.kit.life_points import LifeError, number_text


class LifeCurveField(Field[LifeCurve]):
    """A number over a life, written ``0:0, 0.2:1, 1:0``; its values stay within two limits."""

    kind = "curve"

    def __init__(self, default: object, minimum: float, maximum: float, help: str, *, unit: str = "",
                 rebuild: bool = False) -> None:
        if not minimum < maximum:
            raise ParameterError(f"a range from {minimum} to {maximum} holds no curve to choose")
        self.minimum, self.maximum = minimum, maximum
        super().__init__(default, help, unit=unit, rebuild=rebuild)

    @property
    def range_text(self) -> str:
        """The limits as messages and tooltips write them."""
        return f"{self.minimum:g} to {self.maximum:g}"

    def parse(self, value: object) -> LifeCurve:
        try:
            curve = LifeCurve.parse(value)
        except LifeError as error:
            raise self.refuse(value, error.why) from error
        for _, along in curve.points:
            if not self.minimum <= along <= self.maximum:
                raise self.refuse(value, f"has the value {number_text(along)}, which is outside {self.range_text}")
        return curve

    def stored(self, value: LifeCurve) -> str:
        return str(value)

    def limits(self) -> dict[str, Any]:
        return {"minimum": self.minimum, "maximum": self.maximum, "most_points": MOST_POINTS}


class GradientField(Field[Gradient]):
    """A colour over a life, written ``0:#ffffff, 0.4:#ff8800, 1:#300000``, or ``#ff8800`` where it never changes."""

    kind = "gradient"

    def parse(self, value: object) -> Gradient:
        try:
            return Gradient.parse(value)
        except LifeError as error:
            raise self.refuse(value, error.why) from error

    def stored(self, value: Gradient) -> str:
        return str(value)

    def limits(self) -> dict[str, Any]:
        return {"most_stops": MOST_STOPS}
