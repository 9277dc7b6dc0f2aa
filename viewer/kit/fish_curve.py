"""Curves through tables of points that take complex numbers, so that what is built on them has exact derivatives.

The derivative of f at a real t is the imaginary part of f(t + ih) / h. Nothing is subtracted, so h may be as small as
1e-30 and the result is right to the last digits (Squire and Trapp, "Using Complex Variables to Estimate Derivatives of
Real Functions", 1998). Whatever stands between t and f must be analytic, or made of pieces that are.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Numbers: TypeAlias = NDArray[np.float64]
Values: TypeAlias = NDArray[Any]      # float64, or complex128 with an imaginary step
Surface: TypeAlias = Callable[[Values, Values], Values]
STEP = 1e-30


class Curve:
    """Cubic pieces: ``knots`` (k,) and ``coefficients`` (4, k - 1, c) from the cube down, in t - knot."""

    def __init__(self, knots: Numbers, coefficients: Numbers) -> None:
        self.knots, self.coefficients = knots, coefficients

    def __call__(self, where: ArrayLike) -> Values:
        """The points (..., c) at ``where`` (...); beyond its ends the last piece goes on."""
        at = np.asarray(where)
        piece = np.clip(np.searchsorted(self.knots, at.real, "right") - 1, 0, len(self.knots) - 2)
        t = (at - self.knots[piece])[..., None]
        cube, square, slope, start = (row[piece] for row in self.coefficients)
        return np.asarray(((cube * t + square) * t + slope) * t + start)


def closed_curve(knots: Numbers, values: Numbers) -> Curve:
    """The periodic cubic spline, twice differentiable, through ``values`` (k, c), the last the same as the first."""
    from scipy.interpolate import CubicSpline

    return Curve(knots, np.asarray(CubicSpline(knots, values, bc_type="periodic").c, np.float64))


def open_curve(points: ArrayLike) -> Curve:
    """The curve through ``points`` (k, c), k > 1, evenly over 0 to 1, differentiable once (Catmull and Rom 1974).

    It is local: no point is felt farther than two away. At its ends it leaves as a parabola through three points.
    """
    values = np.asarray(points, np.float64)
    count = len(values) - 1
    slope = np.gradient(values, axis=0, edge_order=2 if count > 1 else 1)
    start, end, leave, arrive = values[:-1], values[1:], slope[:-1], slope[1:]
    pieces = np.stack([2 * (start - end) + leave + arrive, 3 * (end - start) - 2 * leave - arrive, leave, start])
    scale = float(count) ** np.arange(3, -1, -1)[:, None, None]
    return Curve(np.linspace(0.0, 1.0, count + 1), pieces * scale)


def partial_derivatives(surface: Surface, u: Numbers, v: Numbers) -> tuple[Numbers, Numbers]:
    """The exact derivatives (..., 3) of ``surface(u, v)`` by u and by v."""
    along = surface(u + 1j * STEP, v.astype(complex)).imag / STEP
    across = surface(u.astype(complex), v + 1j * STEP).imag / STEP
    return np.asarray(along), np.asarray(across)


def normals_between_poles(surface: Surface, turn: Numbers, angle: Numbers) -> Numbers:
    """Unit normals (..., 3) of a surface closed at the turns 0 and pi, which angles go around right-handed.

    At a pole, where all angles meet, a tangent at another angle stands for the derivative by the angle.
    """
    by_turn, by_angle = partial_derivatives(surface, turn, angle)
    pole = np.minimum(turn, np.pi - turn) < 1e-6
    if pole.any():
        beside, _ = partial_derivatives(surface, turn[pole], angle[pole] + 0.5 * np.pi)
        by_angle[pole] = beside * np.where(turn[pole] < 1.0, 1.0, -1.0)[..., None]
    normal = np.cross(by_angle, by_turn)
    return np.asarray(normal / length(normal))


def smoothstep(t: Values) -> Values:
    """0 before 0 and 1 after 1, in between 3 t^2 - 2 t^3."""
    rising = np.where(t.real <= 0.0, 0.0, np.where(t.real >= 1.0, 1.0, t))
    return np.asarray(rising * rising * (3.0 - 2.0 * rising))


def bell(t: Values) -> Values:
    """Nearly exp(-t^2), but exactly 0 from sqrt(6) on."""
    inside = np.where(np.abs(t.real) < np.sqrt(6.0), 1.0 - t * t / 6.0, 0.0)
    return np.asarray(inside**6)


def length(vectors: Values) -> Values:
    """The lengths (..., 1) of ``vectors`` (..., 3), analytic where they are not zero."""
    return np.asarray(np.sqrt(np.sum(vectors * vectors, axis=-1, keepdims=True)))
