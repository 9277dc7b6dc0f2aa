"""Barbels: the tapering feelers at the mouth of a koi, each a closed tube around a parabola that sinks from its way."""

from __future__ import annotations

import numpy as np

from viewer.kit.fish_body import BodySurface
from viewer.kit.fish_curve import Numbers, Values, length
from viewer.kit.fish_species import Barbel

SUNK = 0.25                             # how much of its length a barbel goes on within the head
TAPER = 0.55                            # how much thinner it is at its tip
DOWN = np.array([0.0, -1.0, 0.0])


class BarbelSurface:
    """A right barbel; call it with ``turn`` from 0 at its root in the head to pi at its tip, and ``angle`` around."""

    def __init__(self, barbel: Barbel, body: BodySurface) -> None:
        self._barbel = barbel
        self._root = body(body.turn(barbel.x), -body.angle(barbel.x, barbel.y))
        self._way = np.asarray(barbel.way) / np.linalg.norm(barbel.way)
        self._fall = barbel.droop * DOWN
        aside = np.cross(self._way, DOWN)
        self._aside = aside / np.linalg.norm(aside)

    def __call__(self, turn: Values, angle: Values) -> Values:
        """Points (..., 3), in metres."""
        along = 0.5 * (1.0 - np.cos(turn))
        out = ((1.0 + SUNK) * along - SUNK)[..., None]
        middle = self._root + self._barbel.length * out * (self._way + out * self._fall)
        ahead = self._way + 2.0 * out * self._fall
        upward = np.cross(ahead / length(ahead), self._aside)
        radius = (self._barbel.radius * np.sin(turn) * (1.0 - TAPER * along))[..., None]
        cosine, sine = np.cos(angle)[..., None], np.sin(angle)[..., None]
        return np.asarray(middle + radius * (cosine * upward - sine * self._aside))


def place_on_body(barbel: Barbel, body: BodySurface, sign: float) -> Numbers:
    """The body's coordinates (2,) where the left (``sign`` -1) or right barbel stands."""
    around = float(body.angle(barbel.x, barbel.y)) / (2.0 * np.pi)
    return np.array([float(body.along(body.turn(barbel.x))), around if sign < 0.0 else 1.0 - around])
