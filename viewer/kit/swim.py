"""How a fish swims: a wave runs along its middle line from head to tail, and the body goes along.

Body-caudal-fin locomotion as Lighthill ("Note on the swimming of slender fish", 1960) and Videler ("Fish Swimming",
1993) describe it: at the place s along the body, 0 at the nose and 1 at the tail, the middle line swings sideways by

    h(s, phase) = amplitude e(s) sin(phase - 2 pi s / wavelength),     e(1) = 1

where s is counted along the bent body: so the line moves ahead by sqrt(1 - h'^2) for each unit of its own length and
never stretches. Lengths are in body lengths, angles in radians. The straight fish has its nose at x = 0.5, its tail
at x = -0.5, up along +y, its right along +z. ``shaders/fish/swim.glsl`` gives the same on the GPU.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Numbers: TypeAlias = NDArray[np.float64]

MIDDLE = 0.5            # the place that stays where it is along x, and keeps its heading in a turn
STEEPEST = 0.85         # of h': with 1 the body would stand across its way
NODES = 32              # of the integration along the body
# e(s) = c0 + c1 s + c2 s^2 + c4 s^4, of a body without stiffness, all of which undulates, and of a stiff one
EEL = (0.12, 0.20, 0.68, 0.0)
TUNA = (0.04, 0.0, 0.0, 0.96)


@dataclass(frozen=True)
class BodyPlaces:
    """Places along a bent body: ``place`` and ``forward`` (..., 2) are x and z, the rest (...,).

    ``forward`` is the unit vector along the middle line towards the nose; ``bend`` how fast its angle grows with s,
    ``roll`` the body's turn about it, ``roll_rate`` how fast that grows with s.
    """

    place: Numbers
    forward: Numbers
    bend: Numbers
    roll: Numbers
    roll_rate: Numbers


@dataclass(frozen=True)
class Swim:
    """The numbers that a way of swimming consists of.

    ``amplitude`` is how far the tail is to swing to either side; ``reach`` is how far it does. ``stiffness`` goes from
    0, an eel, to 1, a tuna. ``sway`` moves, ``yaw`` and ``roll`` turn the whole body; ``twist`` is a roll that runs
    along the body as the wave does, as large as that at the tail.
    """

    amplitude: float = 0.1
    wavelength: float = 1.0
    stiffness: float = 0.5
    sway: float = 0.0
    yaw: float = 0.0
    roll: float = 0.0
    twist: float = 0.0

    @property
    def wave_number(self) -> float:
        """2 pi over the wavelength, in radians for each body length."""
        return 2.0 * math.pi / self.wavelength

    @property
    def envelope(self) -> Numbers:
        """c0, c1, c2 and c4 of e(s), (4,)."""
        return np.asarray((1.0 - self.stiffness) * np.array(EEL) + self.stiffness * np.array(TUNA))

    @property
    def reach(self) -> float:
        """How far the tail swings: the amplitude, or less where the body would have to stretch for it.

        h' is largest at the tail, amplitude * hypot(e'(1), wave number), and no larger than ``STEEPEST``.
        """
        slope = float(self.envelope @ (0.0, 1.0, 2.0, 4.0))
        return min(self.amplitude, STEEPEST / math.hypot(slope, self.wave_number))

    def wave(self, s: ArrayLike, phase: ArrayLike) -> tuple[Numbers, Numbers, Numbers]:
        """e(s) sin(phase - k s) and its first and second derivative by s; ``s`` and ``phase`` broadcast."""
        s, phase = np.asarray(s, np.float64), np.asarray(phase, np.float64)
        c0, c1, c2, c4 = self.envelope
        e = c0 + c1 * s + c2 * s**2 + c4 * s**4
        de, dde = c1 + 2.0 * c2 * s + 4.0 * c4 * s**3, 2.0 * c2 + 12.0 * c4 * s**2
        k = self.wave_number
        sine, cosine = np.sin(phase - k * s), np.cos(phase - k * s)
        return e * sine, de * sine - k * e * cosine, (dde - k * k * e) * sine - 2.0 * k * de * cosine

    def midline(self, s: ArrayLike, phase: ArrayLike, turn: ArrayLike = 0.0) -> Numbers:
        """Where the places ``s`` of the middle line are, (..., 2): x and z; without sway and yaw."""
        return self.body(s, phase, turn).place

    def body(self, s: ArrayLike, phase: ArrayLike, turn: ArrayLike = 0.0) -> BodyPlaces:
        """How the body lies at the places ``s``; ``s``, ``phase`` and ``turn`` broadcast.

        ``turn`` bends the whole into an arc: the angle between tail and nose, positive to the left.
        """
        s, phase, turn = np.broadcast_arrays(*(np.asarray(each, np.float64) for each in (s, phase, turn)))
        nodes, weights = gauss_legendre(NODES)
        between = MIDDLE + (s[..., None] - MIDDLE) * nodes
        ways = self._forward(between, phase[..., None], turn[..., None])
        start = np.stack([np.zeros_like(s), self.reach * self.wave(MIDDLE, phase)[0]], axis=-1)
        value, slope, curving = self.wave(s, phase)
        ahead = np.sqrt(1.0 - (self.reach * slope) ** 2)
        return BodyPlaces(
            start + (MIDDLE - s)[..., None] * np.einsum("n,...nc->...c", weights, ways),
            self._forward(s, phase, turn), turn - self.reach * curving / ahead,
            self.roll * np.sin(phase) + self.twist * value, self.twist * slope)

    def deform(self, positions: ArrayLike, normals: ArrayLike, phase: ArrayLike,
               turn: ArrayLike = 0.0) -> tuple[Numbers, Numbers]:
        """Positions and unit normals (..., 3) of the straight fish on the swimming one.

        Before the nose and behind the tail the body goes on straight. The normals are exact: the cofactors of the
        deformation's Jacobian turn them.
        """
        positions, normals = np.asarray(positions, np.float64), np.asarray(normals, np.float64)
        x, y, z = np.moveaxis(positions, -1, 0)
        s = np.clip(MIDDLE - x, 0.0, 1.0)
        body = self.body(s, phase, turn)
        bends = np.abs(x) <= 0.5
        stretch = np.where(bends, 1.0 + body.bend * (y * np.sin(body.roll) + z * np.cos(body.roll)), 1.0)
        rate = np.where(bends, body.roll_rate, 0.0)
        ahead = normals[..., 0] - rate * (z * normals[..., 1] - y * normals[..., 2])
        turned = np.stack([ahead, stretch * normals[..., 1], stretch * normals[..., 2]], axis=-1)
        moved = self._out_of_body(np.stack([x - (MIDDLE - s), y, z], axis=-1), body)
        middle = np.stack([body.place[..., 0], np.zeros_like(s), body.place[..., 1]], axis=-1)
        placed = self._yawed(middle + moved, phase) + self._swayed(phase)
        turned = self._yawed(self._out_of_body(turned, body), phase)
        return placed, turned / np.linalg.norm(turned, axis=-1, keepdims=True)

    def _forward(self, s: Numbers, phase: Numbers, turn: Numbers) -> Numbers:
        """Unit vectors along the middle line towards the nose, (..., 2)."""
        slope = self.reach * self.wave(s, phase)[1]
        angle = turn * (MIDDLE - s)
        ahead = np.sqrt(1.0 - slope * slope)
        return np.stack([np.cos(angle) * ahead - np.sin(angle) * slope,
                         -np.cos(angle) * slope - np.sin(angle) * ahead], axis=-1)

    def _out_of_body(self, vectors: Numbers, body: BodyPlaces) -> Numbers:
        """Vectors (..., 3) in the frame that goes along with the body, ahead, up and right, in the fish's own."""
        ahead, up, right = np.moveaxis(vectors, -1, 0)
        up, right = (np.cos(body.roll) * up - np.sin(body.roll) * right,
                     np.sin(body.roll) * up + np.cos(body.roll) * right)
        along, across = np.moveaxis(body.forward, -1, 0)
        return np.stack([ahead * along - right * across, up, ahead * across + right * along], axis=-1)

    def _yawed(self, vectors: Numbers, phase: ArrayLike) -> Numbers:
        angle = self.yaw * np.sin(np.asarray(phase, np.float64))
        x, y, z = np.moveaxis(vectors, -1, 0)
        return np.stack([np.cos(angle) * x + np.sin(angle) * z, y, np.cos(angle) * z - np.sin(angle) * x], axis=-1)

    def _swayed(self, phase: ArrayLike) -> Numbers:
        sway = self.sway * np.sin(np.asarray(phase, np.float64))
        return np.stack([np.zeros_like(sway), np.zeros_like(sway), sway], axis=-1)


@lru_cache(maxsize=8)
def gauss_legendre(count: int) -> tuple[Numbers, Numbers]:
    """Places and weights (count,) of the rule for integrals from 0 to 1."""
    places, weights = np.polynomial.legendre.leggauss(count)
    return 0.5 * (places + 1.0), 0.5 * weights
