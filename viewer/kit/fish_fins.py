"""Fins: thin sheets of rays between two curves, with two sides that meet all around, each a graph over its middle.

Along the root u runs 0 to 1, from the root out to the tip v runs 0 to 1; a ray of constant u is a parabola.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from viewer.kit.fish_body import BodySurface
from viewer.kit.fish_curve import Curve, Numbers, Values, length, open_curve, partial_derivatives, smoothstep
from viewer.kit.fish_species import MedianFin, PairedFin

RIB_DEPTH = 0.35        # of a fin's rays, as a part of its thickness
FLESHY = 0.4            # over which part of its length a fin is thicker at its root
RIM = 0.1               # over which part of its breadth a fin thickens from its edge
SUNK = 0.94             # where a paired fin's root lies, as a part of the way from the body's axis to its skin


class Frame(NamedTuple):
    """Where a fin stands: ``origin`` (3,), and ``axes`` (3, 3) whose columns point out, across and off its side."""

    origin: Numbers
    axes: Numbers


@dataclass(frozen=True)
class Fin:
    """One fin as a surface of two sides. ``root``, ``tip`` and ``bend`` are curves in the fish's space."""

    root: Curve
    tip: Curve
    bend: Curve
    side: Numbers       # (3,), the way from its middle to its upper side
    thickness: float
    flesh: float
    rays: int
    notch: float
    spiny: float

    def points(self, u: Values, v: Values, side: ArrayLike, ribs: bool) -> Values:
        """Points (..., 3) of the upper ``side`` +1 or the lower -1, with 0 of the middle."""
        root, tip = self.root(u), self.tip(u)
        way = (v * (1.0 - self._notch(u, ribs)))[..., None]
        middle = root + (tip - root) * way + 2.0 * way * (1.0 - way) * self.bend(u)
        return np.asarray(middle + (0.5 * np.asarray(side) * self._thickness(u, v, ribs))[..., None] * self.side)

    def normals(self, u: Numbers, v: Numbers, side: ArrayLike, ribs: bool) -> Numbers:
        """Unit normals (..., 3) off that ``side`` +1 or -1."""
        along, out = partial_derivatives(lambda a, b: self.points(a, b, side, ribs), u, v)
        normal = np.cross(along, out)
        return np.asarray((np.asarray(side) * self.handedness)[..., None] * normal / length(normal))

    def middle_normals(self, u: Numbers, v: Numbers) -> Numbers:
        """Unit normals (..., 3) of the middle, towards the upper side."""
        along, out = partial_derivatives(lambda a, b: self.points(a, b, 0.0, False), u, v)
        normal = np.cross(along, out)
        return np.asarray(self.handedness * normal / length(normal))

    @cached_property
    def handedness(self) -> float:
        """1 where u, v and the way to the upper side are right-handed, else -1."""
        along, out = partial_derivatives(lambda a, b: self.points(a, b, 0.0, False), *np.full((2, 1), 0.5))
        return float(np.sign(np.cross(along, out)[0] @ self.side))

    def _thickness(self, u: Values, v: Values, ribs: bool) -> Values:
        """None at the border, most near the root, with ribs along the rays."""
        u, v = np.broadcast_arrays(u, v)
        edge = np.where(u.real < 0.5, u, 1.0 - u) / RIM
        shape = _rising(edge) * _rising(v / RIM) * (1.0 - v) * (1.0 + 0.6 * v)
        shape = shape * (1.0 + self.flesh * (1.0 - smoothstep(v / FLESHY)))
        ribs_cut = RIB_DEPTH * smoothstep(2.0 * v) * self._between_rays(u, ribs)
        return np.asarray(self.thickness * shape * (1.0 - ribs_cut))

    def _notch(self, u: Values, ribs: bool) -> Values:
        """By which part a ray is shortened, which fades in a fifth of the breadth."""
        if not self.notch:
            return np.zeros_like(u)
        return np.asarray(self.notch * smoothstep((self.spiny - u) / 0.2 + 0.5) * self._between_rays(u, ribs))

    def _between_rays(self, u: Values, ribs: bool) -> Values:
        """0 on a ray, 1 half way between two; where rays are too fine to be shown, the mean but for the outermost."""
        return np.asarray(0.5 * (1.0 - np.cos(2.0 * np.pi * self.rays * u) if ribs else 1.0 - (2.0 * u - 1.0) ** 8))


def median_fin(fin: MedianFin, body: BodySurface) -> Fin:
    """A fin in the middle plane of the fish."""
    x, share = np.moveaxis(open_curve(fin.root)(np.linspace(0.0, 1.0, 33)).real, -1, 0)
    height, _, middle = body.section(x)
    root = np.stack([x, middle + share * height, np.zeros_like(x)], axis=1)
    tip = np.insert(np.asarray(fin.tip, np.float64), 2, 0.0, axis=1)
    bend = np.insert(np.asarray(fin.bend, np.float64), 2, 0.0, axis=1)
    return Fin(open_curve(root), open_curve(tip), _push(bend), np.array([0.0, 0.0, -1.0]), fin.thickness, fin.flesh,
               fin.rays, fin.notch, fin.spiny)


def paired_fin(fin: PairedFin, body: BodySurface, sign: float) -> Fin:
    """The left (``sign`` -1) or right one of a pair."""
    frame, mirror = paired_frame(fin, body), np.array([1.0, 1.0, sign])
    x, share = np.asarray(fin.root).T @ np.stack([np.linspace(1.0, 0.0, 9), np.linspace(0.0, 1.0, 9)])
    root = _right_skin(body, x, share)
    _, _, middle = body.section(x)
    axis = np.stack([x, middle, np.zeros_like(x)], axis=1)
    tip, bend = frame.origin + np.asarray(fin.tip) @ frame.axes.T, np.asarray(fin.bend) @ frame.axes.T
    return Fin(open_curve((axis + SUNK * (root - axis)) * mirror), open_curve(tip * mirror), _push(bend * mirror),
               frame.axes[:, 2] * mirror, fin.thickness, fin.flesh, fin.rays, 0.0, 1.0)


def paired_frame(fin: PairedFin, body: BodySurface) -> Frame:
    """Where the right one of a pair stands: on the skin, in the middle of its root."""
    origin = _right_skin(body, *np.mean(fin.root, axis=0)[:, None])[0]
    out = np.asarray(fin.out) / np.linalg.norm(fin.out)
    across = np.asarray(fin.across) - np.dot(fin.across, out) * out
    across /= np.linalg.norm(across)
    return Frame(origin, np.stack([out, across, np.cross(out, across)], axis=1))


def _right_skin(body: BodySurface, x: Numbers, share: Numbers) -> Numbers:
    """Points (n, 3) of the right flank at ``share`` of the half height above or below the middle."""
    return np.asarray(body(body.turn(x), -np.arccos(share)))


def _push(points: Numbers) -> Curve:
    return open_curve(np.repeat(points, 2, axis=0) if len(points) == 1 else points)


def _rising(t: Values) -> Values:
    """From 0 to 1, steepest at 0 and level from 1 on."""
    missing = np.where(t.real < 1.0, 1.0 - t, 0.0)
    return np.asarray(1.0 - missing * missing)
