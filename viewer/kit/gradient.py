"""A colour over a particle's life: stops between which light is mixed.

    fire = Gradient.parse("0:#ffffff, 0.4:#ff8800, 1:#300000")
    fire.linear(np.array([0.0, 0.2]))   # (2, 3), in linear light
    fire.table(64)                      # for a texture
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Self, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from viewer.kit.life_points import LifeError, life_pairs, number_text, shown
from viewer.kit.srgb import code_of, color_of, linear_light

__all__ = ["MOST_STOPS", "Gradient", "LifeError"]

Rgb: TypeAlias = tuple[float, float, float]

MOST_STOPS = 12
EXAMPLE = "0:#ffffff, 0.4:#ff8800, 1:#300000"
NOUN = "gradient"


@dataclass(frozen=True)
class Gradient:
    """Stops (position, sRGB colour in 0 to 1), positions rising within 0 to 1, at most ``MOST_STOPS``.

    Before and after them the colour is constant. Colours are held in eight bits a channel, as they are written;
    between stops linear light is interpolated, which is what lamps and cameras do. Raises LifeError.
    """

    stops: tuple[tuple[float, Rgb], ...]

    def __post_init__(self) -> None:
        pairs = life_pairs(NOUN, self.stops, MOST_STOPS, EXAMPLE)
        object.__setattr__(self, "stops", tuple((x, _color(self.stops, color)) for x, color in pairs))

    @classmethod
    def parse(cls, value: object) -> Self:
        """The gradient that a text such as ``0:#ffffff, 1:#300000`` or ``#ff8800`` means, a sequence or a gradient.

        The members of a sequence are (position, colour), a colour being its code or its channels in 0 to 1.
        """
        if isinstance(value, cls):
            return value
        pairs = life_pairs(NOUN, value, MOST_STOPS, EXAMPLE)
        return cls(tuple((x, _color(value, color)) for x, color in pairs))

    def __str__(self) -> str:
        position, color = self.stops[0]
        if len(self.stops) == 1 and position == 0.0:
            return code_of(color)
        return ", ".join(f"{number_text(position)}:{code_of(color)}" for position, color in self.stops)

    def linear(self, x: ArrayLike) -> NDArray[np.float64]:
        """The colours (..., 3) in linear light at ``x`` (...)."""
        x = np.asarray(x, np.float64)
        positions, colors = self._columns
        return np.stack([np.interp(x, positions, channel) for channel in colors], axis=-1)

    def table(self, count: int) -> NDArray[np.float32]:
        """The colours (count, 3) in linear light at equal steps from 0 to 1, both ends included."""
        return self.linear(np.linspace(0.0, 1.0, count)).astype(np.float32)

    @cached_property
    def _columns(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Positions (n,), and red, green and blue in linear light (3, n)."""
        lights = [[linear_light(channel) for channel in color] for _, color in self.stops]
        return np.array([position for position, _ in self.stops]), np.array(lights).T


def _color(whole: object, color: object) -> Rgb:
    """A code, or three channels rounded to eight bits."""
    try:
        if isinstance(color, str):
            return color_of(color)
        if not isinstance(color, Iterable):
            raise TypeError
        red, green, blue = (float(channel) for channel in color)
        if not all(0.0 <= channel <= 1.0 for channel in (red, green, blue)):
            raise ValueError
        return color_of(code_of((red, green, blue)))
    except (TypeError, ValueError, OverflowError):
        raise LifeError(NOUN, whole, f"has the colour {shown(color) or 'nothing'}, "
                                     "which is not written like #ff8800") from None
