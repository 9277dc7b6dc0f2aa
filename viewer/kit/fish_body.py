"""The body of a fish as a surface: an oval for each place along it, then a mouth and gill covers raised on that.

    angle 0 the back, pi / 2 the left flank, pi the belly;  turn 0 the nose, pi the end of the tail's stalk
    along = (1 - cos turn) / 2, so that round ends rise straight from their poles
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from viewer.kit.fish_curve import Numbers, Values, bell, closed_curve, length, smoothstep
from viewer.kit.fish_species import NOSE, Eye, Gill, Keel, Mouth, Species

Relief = Callable[[Values, Values], Values]     # how far the skin is raised where it is seen at (x, y) from the side
SIDEWAYS = np.array([0.0, 1.0, 1.0])    # what is raised leaves the nose where it is
TINY = 1e-12            # square metres: there is no way into the mouth from the middle of the back
NOSE_DEPTH, STALK_DEPTH = 0.12, 0.02     # how far from the poles the points lie from which they are raised
ORBIT = 0.14            # how far the skin rises around an eye, as a part of its radius
EDGE = 0.006            # over how much the gill cover falls off behind its edge, and
COVER = 0.07            # over how much it rises before


class BodySurface:
    """A species' body; call it with turns and angles of one shape (...) for points (..., 3).

    With ``relief`` 1 there are mouth, gill covers, the mounds of the eyes and keels; with less the mouth is as much
    wider and shallower, for coarse meshes; with 0 the body is plain and oval.
    """

    def __init__(self, species: Species, relief: float = 1.0) -> None:
        self.species, self.relief = species, relief
        self.length = NOSE - species.stalk_end
        table = np.array([[row.along, row.back, row.belly, row.half_width, row.shoulders, row.fullness]
                          for row in species.sections])
        along, back, belly, width, shoulders, fullness = table.T
        turns = np.arccos(1.0 - 2.0 * along)
        # Once around the whole outline, up the belly to the nose and down the back: smooth at both poles.
        forth = np.stack([back, width, shoulders, fullness], axis=1)
        ahead = np.stack([belly, -width, shoulders, fullness], axis=1)
        self._outline = closed_curve(np.concatenate([-turns[:0:-1], turns]), np.concatenate([ahead[:0:-1], forth]))
        mouth = replace(species.mouth, gape=species.mouth.gape / (relief or 1.0), depth=species.mouth.depth * relief,
                        lips=species.mouth.lips * relief)
        self._raised = (_lips(mouth), _gill(species.gill), _orbit(species.eye), *map(_keel, species.keels))
        self._groove = _groove(mouth)

    def __call__(self, turn: Values, angle: Values) -> Values:
        """Points (..., 3), in metres."""
        x = self.x(turn)
        back, width, shoulders, fullness = np.moveaxis(self._outline(turn), -1, 0)
        belly = self._outline(-turn)[..., 0]
        cosine, sine = np.cos(angle), np.sin(angle)
        middle = 0.5 * (back + belly)
        y = middle + 0.5 * (back - belly) * cosine
        z = -width * sine * (1.0 + shoulders * cosine + fullness * cosine * cosine)
        plain = np.stack(np.broadcast_arrays(x, y, z), axis=-1)
        return plain + self._relief(x, y, z, middle) if self.relief else plain

    def _relief(self, x: Values, y: Values, z: Values, middle: Values) -> Values:
        """How far (..., 3) the plain skin at (x, y, z) is moved: up from the axis, and for the mouth into the head."""
        ahead = x - self._axis(x)
        off_axis = np.stack(np.broadcast_arrays(ahead, y - middle, z), axis=-1)
        in_line = np.stack(np.broadcast_arrays(ahead, self.species.mouth.slope * ahead, z), axis=-1)
        raised = sum((relief(x, y) for relief in self._raised), np.zeros_like(y))[..., None]
        cut = self._groove(x, y)[..., None]
        up, inward = off_axis / length(off_axis), in_line / np.sqrt(length(in_line) ** 2 + TINY)
        return np.asarray(raised * SIDEWAYS * up - cut * inward)

    def x(self, turn: Values) -> Values:
        """The place of a cross section."""
        return np.asarray(NOSE - 0.5 * self.length * (1.0 - np.cos(turn)))

    def along(self, turn: Numbers) -> Numbers:
        """From 0 at the nose to 1 at the end of the stalk."""
        return np.asarray(0.5 * (1.0 - np.cos(turn)))

    def turn(self, x: ArrayLike) -> Numbers:
        """Where the cross section at ``x`` is."""
        return np.asarray(np.arccos(np.clip(1.0 - 2.0 * (NOSE - np.asarray(x, np.float64)) / self.length, -1.0, 1.0)))

    def section(self, x: ArrayLike) -> tuple[Numbers, Numbers, Numbers]:
        """Half height, half width and middle y of the plain body at ``x``; 0, 0 beyond its ends."""
        turn = self.turn(x)
        back, belly = self._outline(turn), self._outline(-turn)
        return (np.asarray(0.5 * (back - belly)[..., 0]), np.asarray(back[..., 1]),
                np.asarray(0.5 * (back + belly)[..., 0]))

    def angle(self, x: ArrayLike, y: ArrayLike) -> Numbers:
        """The angle, on the left flank, of the plain skin seen at (x, y) from the side."""
        height, _, middle = self.section(x)
        return np.asarray(np.arccos(np.clip((np.asarray(y) - middle) / np.maximum(height, 1e-12), -1.0, 1.0)))

    def _axis(self, x: Values) -> Values:
        """The x of the point on the body's axis from which the skin at ``x`` is raised: short of both ends."""
        neck, stalk = NOSE - 2.0 * NOSE_DEPTH, self.species.stalk_end + 2.0 * STALK_DEPTH
        ahead = np.where(x.real > neck, x - neck, 0.0)
        behind = np.where(x.real < stalk, stalk - x, 0.0)
        return np.asarray(x - ahead * ahead / (4.0 * NOSE_DEPTH) + behind * behind / (4.0 * STALK_DEPTH))


@lru_cache
def body_surface(species: Species, relief: float = 1.0) -> BodySurface:
    """The body of a species, built once."""
    return BodySurface(species, relief)


def _groove(mouth: Mouth) -> Relief:
    """How deep the mouth is, along a line that ends at its corner."""
    return lambda x, y: np.asarray((mouth.depth + mouth.lips) * _along_mouth(mouth, x, y, 1.0))


def _lips(mouth: Mouth) -> Relief:
    """Three times as wide as the groove, which parts them."""
    return lambda x, y: np.asarray(mouth.lips * _along_mouth(mouth, x, y, 3.0))


def _along_mouth(mouth: Mouth, x: Values, y: Values, broad: float) -> Values:
    """1 on the line of the mouth, falling off as a bell ``broad`` times its gape and towards its corner."""
    open_by = smoothstep((x - mouth.corner[0]) / (0.6 * (mouth.tip[0] - mouth.corner[0])) + 0.15)
    gape = mouth.gape * (0.4 + 0.6 * open_by)
    return np.asarray(open_by * bell((y - mouth_line(mouth, x)) / (broad * gape)))


def mouth_line(mouth: Mouth, x: Values) -> Values:
    """The y of the line of the mouth at ``x``."""
    return np.asarray(mouth.tip[1] + mouth.slope * (x - mouth.tip[0]))


def _gill(gill: Gill) -> Relief:
    """Rising slowly to the cover's edge and falling off behind it."""

    def height(x: Values, y: Values) -> Values:
        behind = gill_edge(gill, y) - x
        scale = np.where(behind.real > 0.0, EDGE, COVER)
        aside = (y - gill.y) / gill.reach
        fade = np.where(np.abs(aside.real) < 1.0, 1.0 - aside * aside, 0.0)
        return np.asarray(gill.depth * fade**3 * bell(behind / scale))

    return height


def gill_edge(gill: Gill, y: Values) -> Values:
    """The x of the gill cover's edge at height ``y``."""
    return np.asarray(gill.x + gill.curl * (y - gill.y) ** 2)


def _orbit(eye: Eye) -> Relief:
    """A low mound that an eye stands on."""

    def height(x: Values, y: Values) -> Values:
        away = np.sqrt((x - eye.x) ** 2 + (y - eye.y) ** 2 + 1e-12)
        return np.asarray(ORBIT * eye.radius * bell(away / (1.4 * eye.radius)))

    return height


def _keel(keel: Keel) -> Relief:
    """A ridge, highest in its middle."""

    def height(x: Values, y: Values) -> Values:
        return np.asarray(keel.height * bell((x - keel.x) / keel.length) * bell((y - keel.y) / keel.thickness))

    return height
