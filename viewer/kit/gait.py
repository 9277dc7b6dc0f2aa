"""What can be measured of the way a fish swims, from where its spine is at the moments of a beat.

The terms are those of Videler, "Fish Swimming", 1993. Lengths are in body lengths.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Numbers: TypeAlias = NDArray[np.float64]
STRIDE = 0.7            # body lengths with each beat: Bainbridge, "The Speed of Swimming of Fish", 1958
STILL = 1e-6            # body lengths: a spine that swings less does not swing
LEAST_DELAY = 1e-6      # radians from a place to the next: with less no wave runs


class Gait(NamedTuple):
    """Numbers of a beat; ``amplitude`` (s,) is half of each place's way from side to side."""

    amplitude: Numbers
    wavelength: float           # of the wave that runs along the body; infinite where none runs
    body_length_ratio: float    # the length along the spine by that at rest, at the moment where it is farthest from 1

    @property
    def head_amplitude(self) -> float:
        """How far the nose swings to either side."""
        return float(self.amplitude[0])

    @property
    def tail_amplitude(self) -> float:
        """How far the tail's tip swings to either side."""
        return float(self.amplitude[-1])

    @property
    def strouhal(self) -> float:
        """The tail's way from side to side, times its frequency, by the speed: here by the stride of live fish."""
        return 2.0 * self.tail_amplitude / STRIDE


def gait(spines: ArrayLike) -> Gait:
    """What ``spines`` (moments, places, 3) tell: evenly over one beat, and from nose to tail over a body of length 1.

    The wavelength follows from how fast the phase of the sideways motion falls from nose to tail, each place counting
    by the power of its swing; a motion that turns or shifts the whole body has no such fall.
    """
    spines = np.asarray(spines, np.float64)
    aside = spines[:, :, 2]
    amplitude = 0.5 * np.ptp(aside, axis=0)
    lengths = np.linalg.norm(np.diff(spines, axis=1), axis=2).sum(axis=1)
    return Gait(amplitude, _wavelength(aside), float(lengths[np.argmax(np.abs(lengths - 1.0))]))


def _wavelength(aside: Numbers) -> float:
    moments, places = aside.shape
    swing = np.exp(-2j * np.pi * np.arange(moments) / moments) @ aside
    if np.abs(swing).max() < STILL * moments:
        return float("inf")
    step = float(np.angle(np.vdot(swing[:-1], swing[1:])))
    return 2.0 * np.pi / (-step * (places - 1)) if step < -LEAST_DELAY else float("inf")
