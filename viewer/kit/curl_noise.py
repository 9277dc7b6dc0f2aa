"""A smooth random flow without sources or sinks, from Perlin's noise.

The flow is the curl of the vector potential a grad(b), which is grad(a) x grad(b), for two noises a and b
(Bridson, Houriham and Nordenstam, "Curl-Noise for Procedural Fluid Flow", 2007, for the idea of a potential;
DeWolf, "Divergence-Free Noise", 2005, for this one, which takes two noises instead of three).
``shaders/lib/curl_noise.glsl`` gives the same flow on the GPU.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from viewer.kit.noise import noise_derivative

APART = np.array([31.416, -47.853, 12.793])     # between the two noises
SCALE = 0.814                                   # makes the mean square 1


def curl_noise(points: ArrayLike) -> NDArray[np.float64]:
    """The flow at ``points`` (n, 3), as (n, 3) float64; its mean square is about 1, its eddies about one unit wide."""
    places = np.asarray(points, np.float64)
    return SCALE * np.cross(_gradient(places), _gradient(places + APART))


def _gradient(places: NDArray[np.float64]) -> NDArray[np.float64]:
    x, y, z = places.T
    orders = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
    return np.stack([np.asarray(noise_derivative(x, y, z, order), np.float64) for order in orders], axis=1)
