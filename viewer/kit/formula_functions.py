"""What every operation and function of the formula language computes, in NumPy.

An operation takes floating arrays (or 0-d values) of one type and gives the same type. Where GLSL and NumPy
define a function differently, the definition here follows GLSL, so that both give the same values.
Only what min, max and clamp make of an argument that is not a number is left open, as in GLSL: here it stays
not a number.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.floating[Any]]

LARGEST_PRODUCT_POWER = 64


class Signature(NamedTuple):
    """How many arguments a function takes; ``most`` is None where there is no limit."""

    least: int
    most: int | None

    def __str__(self) -> str:
        if self.most is None:
            return f"{self.least} or more arguments"
        if self.least == self.most:
            return f"{self.least} argument" + ("s" if self.least > 1 else "")
        return f"{self.least} to {self.most} arguments"


NAMED_ALIKE = (
    *("sin", "cos", "tan", "sinh", "cosh", "tanh"),
    *("exp", "log", "log2", "sqrt", "cbrt", "floor", "ceil"),
)
ONE_ARGUMENT = (*NAMED_ALIKE, "asin", "acos", "atan", "abs", "sign", "fract", "round")

FUNCTIONS: dict[str, Signature] = {
    **dict.fromkeys(ONE_ARGUMENT, Signature(1, 1)),
    **dict.fromkeys(("atan2", "step", "pow", "mod"), Signature(2, 2)),
    **dict.fromkeys(("clamp", "mix", "smoothstep"), Signature(3, 3)),
    **dict.fromkeys(("min", "max"), Signature(2, None)),
    **dict.fromkeys(("noise", "turbulence"), Signature(1, 3)),
    "length": Signature(1, None),
}
CONSTANTS = {"pi": math.pi, "tau": math.tau, "e": math.e}

COMPARISONS = frozenset({"less", "less_equal", "greater", "greater_equal", "equal", "not_equal"})
CONDITIONS = COMPARISONS | {"and", "or", "not"}


def integer_power(base: FloatArray, exponent: int) -> FloatArray:
    """``base`` to an integer power by repeated squaring, right for every sign of the base."""
    squares = base
    remaining = abs(exponent)
    power: FloatArray | None = None
    while remaining:
        if remaining & 1:
            power = squares if power is None else power * squares
        remaining >>= 1
        if remaining:
            squares = squares * squares
    if power is None:
        return np.ones_like(base)
    return 1.0 / power if exponent < 0 else power


def small_integer(number: float) -> int | None:
    """``number`` as an int if it is whole and small enough to be multiplied out, otherwise None."""
    return int(number) if number == int(number) and abs(number) <= LARGEST_PRODUCT_POWER else None


def _power(base: FloatArray, exponent: FloatArray) -> FloatArray:
    whole = small_integer(float(exponent)) if np.ndim(exponent) == 0 and np.isfinite(exponent) else None
    result: FloatArray = np.power(base, exponent) if whole is None else integer_power(base, whole)
    return result


def _mod(value: FloatArray, divisor: FloatArray) -> FloatArray:
    result: FloatArray = value - divisor * np.floor(value / divisor)
    return result


def _length(*coordinates: FloatArray) -> FloatArray:
    result: FloatArray = np.sqrt(sum(coordinate * coordinate for coordinate in coordinates))
    return result


def _smoothstep(low: FloatArray, high: FloatArray, value: FloatArray) -> FloatArray:
    t = np.minimum(np.maximum((value - low) / (high - low), 0), 1)
    result: FloatArray = t * t * (3 - 2 * t)
    return result


def _as_number(condition: Callable[..., Any]) -> Callable[..., FloatArray]:
    """``condition`` with 1 for true and 0 for false, of the type of its first argument."""
    return lambda *values: condition(*values).astype(values[0].dtype)


OPERATIONS: dict[str, Callable[..., Any]] = {
    "negate": np.negative,
    "add": np.add,
    "subtract": np.subtract,
    "multiply": np.multiply,
    "divide": np.divide,
    "mod": _mod,
    "power": _power,
    **{name: _as_number(getattr(np, name)) for name in COMPARISONS},
    "and": _as_number(np.logical_and),
    "or": _as_number(np.logical_or),
    "not": _as_number(np.logical_not),
    "choose": lambda condition, chosen, otherwise: np.where(condition != 0, chosen, otherwise),
    **{name: getattr(np, name) for name in NAMED_ALIKE},
    "asin": np.arcsin,
    "acos": np.arccos,
    "atan": np.arctan,
    "atan2": np.arctan2,
    "abs": np.abs,
    "sign": np.sign,
    "fract": lambda value: value - np.floor(value),
    "round": np.rint,
    "min": np.minimum,
    "max": np.maximum,
    "step": _as_number(lambda edge, value: np.greater_equal(value, edge)),
    "mix": lambda first, second, share: first * (1 - share) + second * share,
    "smoothstep": _smoothstep,
    "length": _length,
}
