"""A quantity over a particle's life: a smooth curve through a few points that never overshoots them.

    size = LifeCurve.parse("0:0, 0.2:1, 1:0")
    size(np.array([0.0, 0.1, 0.2]))     # 0, between, 1
    size.table(64)                      # for a texture
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Self, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from viewer.kit.life_points import LifeError, life_pairs, number_in, number_text

__all__ = ["LARGEST", "MOST_POINTS", "LifeCurve", "LifeError"]

Values: TypeAlias = NDArray[np.float64]

MOST_POINTS = 16
LARGEST = 1e30      # of a value, either way: far inside single precision
EXAMPLE = "0:0, 0.2:1, 1:0"
NOUN = "life curve"


@dataclass(frozen=True)
class LifeCurve:
    """Points (x, y), x rising within 0 to 1, at most ``MOST_POINTS``; before and after them the curve is level.

    Monotone cubic Hermite interpolation after Fritsch and Carlson, "Monotone Piecewise Cubic Interpolation", SIAM
    Journal on Numerical Analysis 17, 1980, with the slopes of Fritsch and Butland, "A Method for Constructing
    Local Monotone Piecewise Cubic Interpolants", SIAM Journal on Scientific and Statistical Computing 5, 1984.
    Raises LifeError.
    """

    points: tuple[tuple[float, float], ...]

    def __post_init__(self) -> None:
        pairs = life_pairs(NOUN, self.points, MOST_POINTS, EXAMPLE)
        object.__setattr__(self, "points", tuple((x, _finite(self.points, y)) for x, y in pairs))

    @classmethod
    def parse(cls, value: object) -> Self:
        """The curve that a text such as ``0:0, 0.2:1, 1:0`` means, a sequence of pairs, a number or a curve."""
        if isinstance(value, cls):
            return value
        if isinstance(value, (int, float, np.number)) and not isinstance(value, bool):
            value = str(value)
        pairs = life_pairs(NOUN, value, MOST_POINTS, EXAMPLE)
        return cls(tuple((x, _finite(value, y)) for x, y in pairs))

    def __str__(self) -> str:
        return ", ".join(f"{number_text(x)}:{number_text(y)}" for x, y in self.points)

    def __call__(self, x: ArrayLike) -> Values:
        """The values (...) at ``x`` (...)."""
        positions, values = self._columns
        x = np.clip(np.asarray(x, np.float64), positions[0], positions[-1])
        if len(positions) == 1:
            return np.full(x.shape, values[0])
        left = np.clip(np.searchsorted(positions, x, side="right") - 1, 0, len(positions) - 2)
        start, end, width = values[left], values[left + 1], np.diff(positions)[left]
        t, (begins, ends) = (x - positions[left]) / width, (width * self._slopes[left], width * self._slopes[left + 1])
        bend = 2.0 * (start - end) + begins + ends
        value = start + t * (begins + t * (end - start - begins - bend + t * bend))
        return np.clip(value, np.minimum(start, end), np.maximum(start, end))

    def table(self, count: int) -> NDArray[np.float32]:
        """The values (count,) at equal steps from 0 to 1, both ends included."""
        return self(np.linspace(0.0, 1.0, count)).astype(np.float32)

    @cached_property
    def _columns(self) -> tuple[Values, Values]:
        positions, values = np.array(self.points).T
        return positions, values

    @cached_property
    def _slopes(self) -> Values:
        """The slope of the curve at each point, (n,)."""
        positions, values = self._columns
        widths = np.diff(positions)
        chords = np.diff(values) / widths
        if len(chords) == 1:
            return np.repeat(chords, 2)
        slopes = np.empty(len(positions))
        slopes[1:-1] = _inner_slopes(widths, chords)
        slopes[0] = _end_slope(widths[0], widths[1], chords[0], chords[1])
        slopes[-1] = _end_slope(widths[-1], widths[-2], chords[-1], chords[-2])
        return slopes


def _inner_slopes(widths: Values, chords: Values) -> Values:
    """Weighted harmonic means of the chords on either side; level where those turn (Fritsch and Butland 1984)."""
    near, far = 2.0 * widths[1:] + widths[:-1], widths[1:] + 2.0 * widths[:-1]
    before, after = chords[:-1], chords[1:]
    same = np.sign(before) * np.sign(after) > 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(same, (near + far) / (near / before + far / after), 0.0)


def _end_slope(width: float, next_width: float, chord: float, next_chord: float) -> float:
    """The parabola's slope through three points, held where the curve would overshoot (Moler, "Numerical Computing
    with MATLAB", 2004, section 3.6)."""
    slope = ((2.0 * width + next_width) * chord - width * next_chord) / (width + next_width)
    if slope * chord <= 0.0:
        return 0.0
    turns = np.sign(chord) != np.sign(next_chord)
    return 3.0 * chord if turns and abs(slope) > 3.0 * abs(chord) else slope


def _finite(whole: object, y: object) -> float:
    value = number_in(NOUN, whole, "value", y, EXAMPLE)
    if not math.isfinite(value):
        raise LifeError(NOUN, whole, f"has the value {value}, which is not a finite number")
    if abs(value) > LARGEST:
        raise LifeError(NOUN, whole, f"has the value {value:g}, which is beyond {LARGEST:g}")
    return value
