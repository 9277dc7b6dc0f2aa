"""Perlin's gradient noise and turbulence, with their exact partial derivatives.

Noise is Ken Perlin, "Improving Noise", SIGGRAPH 2002: gradients chosen by a fixed permutation are blended
between the eight corners of a lattice cell with weights fade(t) = 6t^5 - 15t^4 + 10t^3. Turbulence is Ken
Perlin, "An Image Synthesizer", SIGGRAPH 1985. ``shaders/lib/noise.glsl`` gives the same values on the GPU.
"""

from __future__ import annotations

from functools import cache
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.floating[Any]]
Order = tuple[int, int, int]

TURBULENCE_OCTAVES = 6

PERMUTATION = np.array(
    [
        151, 160, 137, 91, 90, 15, 131, 13, 201, 95, 96, 53, 194, 233, 7, 225, 140, 36, 103, 30, 69, 142,
        8, 99, 37, 240, 21, 10, 23, 190, 6, 148, 247, 120, 234, 75, 0, 26, 197, 62, 94, 252, 219, 203, 117,
        35, 11, 32, 57, 177, 33, 88, 237, 149, 56, 87, 174, 20, 125, 136, 171, 168, 68, 175, 74, 165, 71,
        134, 139, 48, 27, 166, 77, 146, 158, 231, 83, 111, 229, 122, 60, 211, 133, 230, 220, 105, 92, 41,
        55, 46, 245, 40, 244, 102, 143, 54, 65, 25, 63, 161, 1, 216, 80, 73, 209, 76, 132, 187, 208, 89,
        18, 169, 200, 196, 135, 130, 116, 188, 159, 86, 164, 100, 109, 198, 173, 186, 3, 64, 52, 217, 226,
        250, 124, 123, 5, 202, 38, 147, 118, 126, 255, 82, 85, 212, 207, 206, 59, 227, 47, 16, 58, 17, 182,
        189, 28, 42, 223, 183, 170, 213, 119, 248, 152, 2, 44, 154, 163, 70, 221, 153, 101, 155, 167, 43,
        172, 9, 129, 22, 39, 253, 19, 98, 108, 110, 79, 113, 224, 232, 178, 185, 112, 104, 218, 246, 97,
        228, 251, 34, 242, 193, 238, 210, 144, 12, 191, 179, 162, 241, 81, 51, 145, 235, 249, 14, 239, 107,
        49, 192, 214, 31, 181, 199, 106, 157, 184, 84, 204, 176, 115, 121, 50, 45, 127, 4, 150, 254, 138,
        236, 205, 93, 222, 114, 67, 29, 24, 72, 243, 141, 128, 195, 78, 66, 215, 61, 156, 180,
    ],
    dtype=np.intp,
)  # fmt: skip

# The 12 edge directions of a cube, four of them twice so that four bits of the hash choose one.
GRADIENTS = np.array(
    [
        (1, 1, 0), (-1, 1, 0), (1, -1, 0), (-1, -1, 0), (1, 0, 1), (-1, 0, 1), (1, 0, -1), (-1, 0, -1),
        (0, 1, 1), (0, -1, 1), (0, 1, -1), (0, -1, -1), (1, 1, 0), (0, -1, 1), (-1, 1, 0), (0, -1, -1),
    ],
    dtype=np.float32,
)  # fmt: skip

# Twice in a row, as Perlin has it: sums of an entry and a coordinate need no wrapping.
_HASH = np.concatenate([PERMUTATION, PERMUTATION])
_CORNER_GRADIENT = np.ascontiguousarray(GRADIENTS[_HASH & 15].T)

FADE = (6.0, -15.0, 10.0, 0.0, 0.0, 0.0)


def noise(x: ArrayLike, y: ArrayLike = 0.0, z: ArrayLike = 0.0) -> FloatArray:
    """Perlin's improved noise, of period 256 in each coordinate, zero at all integer points.

    The arguments broadcast. The result is float32 if every array is float32, otherwise float64; it lies
    within about -1.04 and 1.04. NaN and infinities give NaN.
    """
    return noise_derivative(x, y, z, (0, 0, 0))


def noise_derivative(x: ArrayLike, y: ArrayLike, z: ArrayLike, order: Order) -> FloatArray:
    """The partial derivative of ``noise``, ``order`` times in x, y and z; ``(0, 0, 0)`` is the value.

    Shapes and types are those of ``noise``. Continuous up to total order 2. Each corner contributes
    X(x) Y(y) Z(z) (g . d) with fade weights X, Y, Z and d linear in the point, so Leibniz' rule leaves one
    term in which only the weights are differentiated and, per axis, one in which d is differentiated once.
    """
    point = _floating(x, y, z)
    dtype = point[0].dtype
    with np.errstate(all="ignore"):
        cells = [np.floor(coordinate) for coordinate in point]
        inside = [coordinate - cell for coordinate, cell in zip(point, cells, strict=True)]
        lattice = [cell.astype(np.int64) & 255 for cell in cells]
        weights = [_weights(t, n) for t, n in zip(inside, order, strict=True)]
        lowered = [_weights(t, n - 1) if n else None for t, n in zip(inside, order, strict=True)]
        gradients = _CORNER_GRADIENT.astype(dtype, copy=False)
        total: Any = np.zeros((), dtype)
        for here in product((0, 1), repeat=3):
            i, j, k = here
            index = _HASH[_HASH[lattice[0] + i] + lattice[1] + j] + lattice[2] + k
            direction = [axis.take(index) for axis in gradients]
            height = sum(direction[axis] * (inside[axis] - here[axis]) for axis in range(3))
            weight = [weights[axis][here[axis]] for axis in range(3)]
            total = total + weight[0] * weight[1] * weight[2] * height
            for axis, lower in enumerate(lowered):
                if lower is not None:
                    others = weight[axis - 1] * weight[axis - 2]
                    total = total + order[axis] * lower[here[axis]] * others * direction[axis]
    return np.asarray(total, dtype)


def turbulence(x: ArrayLike, y: ArrayLike = 0.0, z: ArrayLike = 0.0) -> FloatArray:
    """Perlin's turbulence: the sum over six octaves i = 0..5 of |noise(2^i p)| / 2^i; shapes as ``noise``."""
    return turbulence_derivative(x, y, z, (0, 0, 0))


def turbulence_derivative(x: ArrayLike, y: ArrayLike, z: ArrayLike, order: Order) -> FloatArray:
    """The partial derivative of ``turbulence``; on its creases, where an octave is zero, that octave adds 0.

    The chain rule gives each octave the factor 2^i once for every differentiation, over its own 2^-i.
    """
    point = _floating(x, y, z)
    depth = sum(order)
    with np.errstate(all="ignore"):
        total: Any = 0.0
        for octave in range(TURBULENCE_OCTAVES):
            scaled = [coordinate * 2.0**octave for coordinate in point]
            value = noise(*scaled)
            part = np.abs(value)
            if depth:
                part = np.sign(value) * noise_derivative(scaled[0], scaled[1], scaled[2], order)
            total = total + part * 2.0 ** (octave * (depth - 1))
    return np.asarray(total, point[0].dtype)


@cache
def _fade_coefficients(order: int) -> tuple[float, ...]:
    """The coefficients, highest power first, of the fade polynomial differentiated ``order`` times."""
    return tuple(float(coefficient) for coefficient in np.polyder(np.poly1d(FADE), order).coeffs)


def _weights(t: FloatArray, order: int) -> tuple[FloatArray, FloatArray]:
    """The blend weights of the lower and the upper corner along one axis, differentiated ``order`` times."""
    upper = np.zeros_like(t)
    for coefficient in _fade_coefficients(order):
        upper = upper * t + coefficient
    return (1 if order == 0 else 0) - upper, upper


def _floating(*values: ArrayLike) -> list[FloatArray]:
    """The values as arrays of one floating type, float32 only if all of them are."""
    arrays = [np.asarray(value) for value in values]
    pairs = zip(arrays, values, strict=True)
    kinds = {array.dtype for array, value in pairs if not isinstance(value, int | float)}
    dtype = np.float32 if kinds == {np.dtype(np.float32)} else np.float64
    return [array.astype(dtype, copy=False) for array in arrays]
