"""An arm of our own, like an artist's mannequin: a shoulder to stand on, elbow, wrist and a hand with five fingers.

    y = 0              the shoulder, cut off level
    y = 0.78           the elbow: bone 1 begins, the forearm
    y = 0.871 to 1.449 the straight part of the forearm, over which the hand's weight grows from 0 to 1
    y = 1.54           the wrist: bone 2 begins, the hand
    y = 2.1            the finger tips; the palm faces +z, the thumb points to +x

The area of the straight part's cross sections is alike on both sides of its middle but for the sign of what differs
from it, so that a twist takes as large a share of its volume as of a cylinder's.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from viewer.kit.mesh import Mesh, Vertices, area_weighted_normals, quads_to_triangles
from viewer.kit.quaternion import IDENTITY
from viewer.kit.rig import RiggedMesh, Skeleton, bound_at_rest

ELBOW, WRIST = 0.78, 1.54
STRAIGHT = (0.871, 1.449)               # from 12 to 88 hundredths of the forearm
FLEXING = (0.655, STRAIGHT[0])          # where the upper arm's weight passes to the forearm
NAMES = ("upper arm", "forearm", "hand")
SECTIONS = 120                          # of the straight part: 1/2, 1/4, 1/6, 1/8 and 1/10 of it are among them
AROUND = 72
CHECKS_AROUND = 12
CHECK = 0.066                           # the height of a check of the pattern

# Half widths across (x) and from front to back (z), and how far the middle lies towards +z.
ABOVE_ELBOW = np.array([
    [0.00, 0.196, 0.178, 0.000],
    [0.10, 0.206, 0.190, 0.000],
    [0.22, 0.196, 0.184, 0.004],
    [0.36, 0.160, 0.166, 0.014],
    [0.48, 0.146, 0.158, 0.016],
    [0.60, 0.136, 0.138, 0.006],
    [0.70, 0.136, 0.124, -0.006],
    [0.78, 0.141, 0.128, -0.010],
])
BEYOND_STRAIGHT = np.array([
    [1.50, 0.1035, 0.0700, 0.000],
    [1.56, 0.1075, 0.0650, 0.000],
    [1.63, 0.1155, 0.0610, 0.001],
    [1.71, 0.1240, 0.0560, 0.003],
    [1.78, 0.1265, 0.0495, 0.005],
    [1.84, 0.1220, 0.0400, 0.006],
])
PALM_END = 1.868
# Root, a point that the curve leans towards, tip; radius at the root and at the tip.
FINGERS = (
    ((-0.091, 1.82, 0.004), (-0.112, 1.94, 0.000), (-0.118, 2.015, 0.034), 0.0265, 0.0195),
    ((-0.031, 1.84, 0.004), (-0.038, 1.99, 0.000), (-0.040, 2.085, 0.040), 0.0290, 0.0205),
    ((0.031, 1.84, 0.004), (0.034, 2.00, 0.000), (0.036, 2.100, 0.042), 0.0295, 0.0205),
    ((0.090, 1.82, 0.004), (0.102, 1.97, 0.000), (0.106, 2.055, 0.040), 0.0280, 0.0200),
    ((0.086, 1.60, 0.014), (0.168, 1.68, 0.036), (0.190, 1.800, 0.066), 0.0370, 0.0245),
)


@lru_cache(maxsize=1)
def arm() -> RiggedMesh:
    """The arm, bound to three bones; over the straight part the weights of forearm and hand pass evenly."""
    limb, limb_checks = _limb()
    tubes = [_tube_along(*finger) for finger in FINGERS]
    pieces = [limb, *(finger for finger, _ in tubes)]
    first = np.cumsum([0] + [len(vertices) for vertices, _ in pieces[:-1]])
    positions = np.concatenate([vertices for vertices, _ in pieces])
    triangles = np.concatenate([piece + start for start, (_, piece) in zip(first, pieces, strict=True)])
    shares = _weights(positions[:, 1])
    shares[len(limb[0]):] = 0.0, 0.0, 1.0, 0.0
    skeleton = _skeleton()
    bones = np.arange(3, dtype=np.int32)
    return RiggedMesh(
        positions.astype(np.float32), area_weighted_normals(positions, triangles).astype(np.float32),
        np.concatenate([limb_checks, *(checks for _, checks in tubes)]).astype(np.float32),
        np.broadcast_to(np.array([0, 1, 2, 0], np.int32), (len(positions), 4)).copy(), shares.astype(np.float32),
        triangles.astype(np.int32), skeleton, bones, bound_at_rest(skeleton, bones))


def straight_area(along: ArrayLike) -> NDArray[np.float64]:
    """The area of the straight part's cross section, divided by pi; ``along`` goes from 0 to 1."""
    along = np.asarray(along, np.float64)
    return np.asarray(0.01265 + 0.0053 * np.cos(np.pi * along) + 0.0018 * np.sin(2.0 * np.pi * along))


def _skeleton() -> Skeleton:
    steps = np.diff([0.0, 0.0, ELBOW, WRIST])
    places = np.stack([np.zeros(3), steps, np.zeros(3)], axis=1)
    return Skeleton(NAMES, np.array([-1, 0, 1], np.int32), places, np.tile(IDENTITY, (3, 1)), np.ones((3, 3)))


def _weights(y: NDArray[np.float64]) -> Vertices:
    """The weights of upper arm, forearm and hand, and one that is not used: (n, 4)."""
    flexed, twisted = (np.clip((y - start) / (end - start), 0.0, 1.0) for start, end in (FLEXING, STRAIGHT))
    flexed = flexed * flexed * (3.0 - 2.0 * flexed)
    return np.stack([1.0 - flexed, flexed * (1.0 - twisted), twisted, np.zeros_like(y)], axis=1)


def _limb() -> tuple[Mesh, Vertices]:
    """From the shoulder to the end of the palm, closed, and its texture coordinates in checks."""
    y = _ring_heights()
    half_widths = _profile()(y)
    open_end = np.sqrt(np.clip(1.0 - np.clip((y - 1.80) / (PALM_END - 1.80), 0.0, 1.0) ** 2, 1e-6, 1.0))
    rim = np.sqrt(np.clip(1.0 - np.clip((0.03 - y) / 0.03, 0.0, 1.0) ** 2, 0.0, 1.0)) * 0.12 + 0.88
    angle = 2.0 * np.pi * np.arange(AROUND) / AROUND
    across, deep = (half_widths[:, [column]] * (open_end * rim)[:, None] for column in (0, 1))
    x, z = across * np.sin(angle), half_widths[:, [2]] + deep * np.cos(angle)
    rings = np.stack([x, np.broadcast_to(y[:, None], x.shape), z], axis=-1)
    return _closed_tube(rings, y / CHECK, (0, CHECKS_AROUND))


def _ring_heights() -> NDArray[np.float64]:
    """Where the rings are: evenly over the straight part, closer together at both ends."""
    straight = np.linspace(*STRAIGHT, SECTIONS + 1)
    below = np.linspace(0.03, STRAIGHT[0], 64, endpoint=False)
    beyond = np.linspace(STRAIGHT[1], 1.80, 30)[1:]
    end = 1.80 + (PALM_END - 1.80) * np.sin(np.linspace(0.0, 0.5 * np.pi, 14))[1:]
    rim = 0.03 * (1.0 - np.cos(np.linspace(0.0, 0.5 * np.pi, 6)[:-1]))
    return np.concatenate([rim, below, straight, beyond, end])


@lru_cache(maxsize=1)
def _profile() -> Callable[[NDArray[np.float64]], Vertices]:
    """Half width across, half width from front to back and middle, (n, 3), at each height."""
    from scipy.interpolate import CubicSpline

    along = np.linspace(0.0, 1.0, 25)
    flat = 1.06 + 0.36 * along**2 * (3.0 - 2.0 * along)        # a forearm is round, a wrist is not
    radius = np.sqrt(straight_area(along))
    height = STRAIGHT[0] + (STRAIGHT[1] - STRAIGHT[0]) * along
    middle = -0.006 * (1.0 - along) ** 2
    straight = np.stack([height, radius * np.sqrt(flat), radius / np.sqrt(flat), middle], axis=1)
    knots = np.concatenate([ABOVE_ELBOW, straight, BEYOND_STRAIGHT])
    spline = CubicSpline(knots[:, 0], knots[:, 1:])
    return lambda y: np.asarray(spline(y), np.float64)


def _tube_along(root: ArrayLike, lean: ArrayLike, tip: ArrayLike, thick: float, thin: float) -> tuple[Mesh, Vertices]:
    """A finger: a tube along a bent line, round at its tip, and its texture coordinates in checks."""
    t = np.concatenate([np.linspace(0.0, 0.86, 16), 0.86 + 0.14 * np.sin(np.linspace(0.0, 0.5 * np.pi, 9))[1:]])
    root, lean, tip = (np.asarray(point, np.float64) for point in (root, lean, tip))
    s = t[:, None]
    line = (1.0 - s) ** 2 * root + 2.0 * s * (1.0 - s) * lean + s**2 * tip
    along = 2.0 * (1.0 - s) * (lean - root) + 2.0 * s * (tip - lean)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    front = np.array([0.0, 0.0, 1.0]) - along * along[:, 2:]
    front /= np.linalg.norm(front, axis=1, keepdims=True)
    side = np.cross(along, front)
    knuckles = 1.0 + 0.05 * np.cos(6.0 * np.pi * t)
    rounded = np.sqrt(np.clip(1.0 - np.clip((t - 0.86) / 0.14, 0.0, 1.0) ** 2, 1e-6, 1.0))
    radius = ((thick + (thin - thick) * t) * knuckles * rounded)[:, None, None]
    angle = 2.0 * np.pi * np.arange(18) / 18
    rings = line[:, None] + radius * (np.sin(angle)[:, None] * -side[:, None] + np.cos(angle)[:, None] * front[:, None])
    length = np.linalg.norm(np.diff(line, axis=0), axis=1)
    return _closed_tube(rings, np.concatenate([[0.0], np.cumsum(length)]) / CHECK, (1, 3))


def _closed_tube(rings: NDArray[np.float64], up: NDArray[np.float64],
                 checks: tuple[int, int]) -> tuple[Mesh, Vertices]:
    """Rings of points (r, k, 3), each counter-clockwise seen from the next, joined and closed by two middles.

    The pattern goes around from the first of ``checks`` to the second, and ``up`` (r,) along. The seam is there twice.
    """
    rings = np.concatenate([rings, rings[:, :1]], axis=1)
    count, around = rings.shape[:2]
    index = np.arange(count * around).reshape(count, around)
    sides = quads_to_triangles(index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1])
    ends = np.stack([rings[0, :-1].mean(axis=0), rings[-1, :-1].mean(axis=0)])
    low, high = (np.full(around - 1, index.size + end) for end in range(2))
    caps = [np.stack([low, index[0, 1:], index[0, :-1]], axis=1),
            np.stack([high, index[-1, :-1], index[-1, 1:]], axis=1)]
    across = np.broadcast_to(np.linspace(*checks, around), (count, around))
    pattern = np.stack([across, np.broadcast_to(up[:, None], (count, around))], axis=-1).reshape(-1, 2)
    pattern = np.concatenate([pattern, [[0.5, up[0]], [0.5, up[-1]]]])
    return ((np.concatenate([rings.reshape(-1, 3), ends]), np.concatenate([sides, *caps]).astype(np.int32)), pattern)
