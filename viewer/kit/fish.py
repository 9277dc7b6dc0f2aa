"""A fish of our own: one metre along x, nose at +x, back towards +y, its left side towards -z.

    x = 0.5         the nose, the middle of the body's cross sections a little below y = 0
    0.5 to -0.36    the body: oval cross sections, highest (0.26 m) and widest (0.15 m) at x = 0.16
    -0.2 to -0.36   the stalk of the tail, slimmest at x = -0.29
    -0.32 to -0.5   the tail fin, forked, in the plane z = 0
    0.39            the eyes

Each piece is closed and stands in those next to it, so that the whole may bend but nothing comes off.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from viewer.kit.mesh import Mesh, Triangles, Vertices, normalized, quads_to_triangles, uv_sphere
from viewer.kit.mesh_measure import volume

NOSE, STALK_END, TAIL_END = 0.5, -0.36, -0.5        # along x, metres
# Along the body, 0 at the nose and 1 where the stalk ends: half height, half width, middle of the cross section.
SECTIONS = np.array([
    [0.00, 0.000, 0.000, -0.016],
    [0.04, 0.043, 0.030, -0.014],
    [0.12, 0.079, 0.053, -0.009],
    [0.25, 0.116, 0.071, -0.003],
    [0.40, 0.131, 0.074, 0.000],
    [0.55, 0.117, 0.062, 0.002],
    [0.70, 0.081, 0.040, 0.004],
    [0.85, 0.044, 0.020, 0.005],
    [0.94, 0.036, 0.013, 0.005],
    [1.00, 0.000, 0.000, 0.005],
])
BACK_WIDER = 0.14       # how much wider the upper half of a cross section is than the lower
FIN_THICKNESS = 0.0065  # metres, half of it to either side
RIB_DEPTH = 0.35        # of a fin's rays, as a part of its thickness
EYE = (0.392, 0.016, 0.0175)      # x, y, radius


def fish_mesh(rings: int = 96, segments: int = 64, rays: int = 14) -> Mesh:
    """The whole fish: vertices (n, 3) in metres and triangles (m, 3), counter-clockwise from outside.

    ``rings`` cross sections and ``segments`` around make the body; a fin has about ``rays`` rays, which take
    six strips each.
    """
    pieces = list(fish_pieces(rings, segments, rays).values())
    first = np.cumsum([0] + [len(vertices) for vertices, _ in pieces[:-1]])
    triangles = [triangles + np.int32(start) for start, (_, triangles) in zip(first, pieces, strict=True)]
    return np.concatenate([vertices for vertices, _ in pieces]), np.concatenate(triangles).astype(np.int32)


def fish_pieces(rings: int = 96, segments: int = 64, rays: int = 14) -> dict[str, Mesh]:
    """The pieces of ``fish_mesh`` by name, each closed: body, tail, fins and eyes, in that order."""
    pieces = {"body": _body(rings, segments), "tail": _tail(rays), "dorsal": _dorsal(rays), "anal": _anal(rays)}
    for side, sign in (("left", -1.0), ("right", 1.0)):
        pieces[f"{side} pectoral"] = _pectoral(sign, rays)
        pieces[f"{side} pelvic"] = _pelvic(sign, rays)
    for side, sign in (("left", -1.0), ("right", 1.0)):
        pieces[f"{side} eye"] = _eye(sign)
    return pieces


def body_section(x: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Half height, half width and middle y of the body's cross section at ``x``, in metres; 0, 0 beyond its ends."""
    along = np.clip((NOSE - np.asarray(x, np.float64)) / (NOSE - STALK_END), 0.0, 1.0)
    # By the angle on a half circle, over which a round nose rises straight.
    knots = np.arccos(1.0 - 2.0 * SECTIONS[:, 0])
    height, width, middle = np.moveaxis(_spline(knots, SECTIONS[:, 1:], np.arccos(1.0 - 2.0 * along)), -1, 0)
    return np.maximum(height, 0.0), np.maximum(width, 0.0), middle


def _body(rings: int, segments: int) -> Mesh:
    turn = np.pi * np.arange(1, rings) / rings
    x = NOSE - (NOSE - STALK_END) * 0.5 * (1.0 - np.cos(turn))
    height, width, middle = (each[:, None] for each in body_section(x))
    angle = 2.0 * np.pi * np.arange(segments) / segments
    y = middle + height * np.cos(angle)
    z = width * np.sin(angle) * (1.0 + BACK_WIDER * np.cos(angle))
    body = np.stack([np.broadcast_to(x[:, None], y.shape), y, z], axis=-1).reshape(-1, 3)
    ends = np.array([[NOSE, SECTIONS[0, 3], 0.0], [STALK_END, SECTIONS[-1, 3], 0.0]])
    index = np.arange((rings - 1) * segments).reshape(rings - 1, segments)
    onward = np.roll(index, -1, axis=1)
    nose, stalk = (np.full(segments, len(body) + end) for end in range(2))
    caps = [np.stack([nose, index[0], onward[0]], axis=1), np.stack([stalk, onward[-1], index[-1]], axis=1)]
    sides = quads_to_triangles(index[:-1], index[1:], onward[1:], onward[:-1])
    return _facing_outward(np.concatenate([body, ends]), np.concatenate([*caps, sides]).astype(np.int32))


def _tail(rays: int) -> Mesh:
    root = _level([(-0.325, -0.028), (-0.335, -0.014), (-0.335, 0.005), (-0.335, 0.024), (-0.325, 0.038)])
    bend = _level([(-0.385, -0.075), (-0.385, -0.035), (-0.38, 0.005), (-0.385, 0.045), (-0.385, 0.085)])
    tip = _level([(TAIL_END, -0.172), (-0.452, -0.082), (-0.428, 0.005), (-0.452, 0.092), (TAIL_END, 0.182)])
    return _fin(root, bend, tip, rays + 4)


def _dorsal(rays: int) -> Mesh:
    root = _at_body(np.linspace(0.15, -0.17, 5), 0.0, 0.86)
    tip = _level([(0.045, 0.212), (-0.03, 0.196), (-0.10, 0.163), (-0.165, 0.131), (-0.222, 0.104)])
    return _fin(root, _between(root, tip, (0.02, 0.012, 0.0)), tip, rays)


def _anal(rays: int) -> Mesh:
    root = _at_body(np.linspace(-0.06, -0.22, 5), np.pi, 0.84)
    tip = _level([(-0.14, -0.158), (-0.172, -0.139), (-0.204, -0.115), (-0.234, -0.093), (-0.262, -0.074)])
    return _fin(root, _between(root, tip, (0.014, -0.008, 0.0)), tip, rays * 2 // 3)


def _pectoral(sign: float, rays: int) -> Mesh:
    root = _mirrored([(0.222, -0.032, 0.058), (0.214, -0.042, 0.057), (0.206, -0.052, 0.055),
                      (0.198, -0.062, 0.053)], sign)
    tip = _mirrored([(0.085, -0.052, 0.148), (0.068, -0.083, 0.142), (0.078, -0.108, 0.128),
                     (0.118, -0.12, 0.108)], sign)
    return _fin(root, _between(root, tip, (0.012, -0.004, 0.018 * sign)), tip, rays * 2 // 3)


def _pelvic(sign: float, rays: int) -> Mesh:
    root = _mirrored([(0.095, -0.104, 0.022), (0.075, -0.106, 0.023), (0.055, -0.106, 0.024)], sign)
    tip = _mirrored([(0.025, -0.188, 0.058), (-0.002, -0.172, 0.056), (-0.012, -0.148, 0.046)], sign)
    return _fin(root, _between(root, tip, (0.01, -0.006, 0.004 * sign)), tip, rays // 2)


def _eye(sign: float) -> Mesh:
    x, y, radius = EYE
    height, width, middle = body_section(x)
    beside = float(width * np.sqrt(1.0 - ((y - middle) / height) ** 2))
    vertices, triangles = uv_sphere(12, 20)
    return vertices * np.array([radius, radius, 0.6 * radius]) + np.array([x, y, sign * beside]), triangles


def _fin(root: ArrayLike, bend: ArrayLike, tip: ArrayLike, rays: int) -> Mesh:
    """A thin closed fin between two curves, each through k points (k, 3), its rays bent by those in ``bend``.

    Its two sides meet all around; they stand apart in the middle by the rays' ribs.
    """
    count = 6 * rays
    along, out = np.linspace(0.0, 1.0, count + 1), np.linspace(0.0, 1.0, 17) ** 0.8
    curves = [_spline(np.linspace(0.0, 1.0, len(curve)), curve, along)[:, None]
              for curve in (np.asarray(root), np.asarray(bend), np.asarray(tip))]
    v = out[:, None]
    sheet = (1.0 - v) ** 2 * curves[0] + 2.0 * v * (1.0 - v) * curves[1] + v * v * curves[2]
    way = normalized(np.cross(np.gradient(sheet, axis=0), np.gradient(sheet, axis=1)))
    rim = np.minimum(1.0, 12.0 * along * (1.0 - along))[:, None] ** 0.5
    rib = 1.0 - RIB_DEPTH * out * 0.5 * (1.0 + np.cos(2.0 * np.pi * rays * along[:, None]))
    thick = (FIN_THICKNESS / 2.0) * rim * rib * np.minimum(1.0, 8.0 * out) ** 0.5 * (1.0 - out) ** 0.6
    return _two_sided(sheet, way * thick[:, :, None])


def _two_sided(sheet: NDArray[np.float64], offset: NDArray[np.float64]) -> Mesh:
    """A closed solid from a grid of points (r, c, 3), to either side by ``offset``, which is left out at the border."""
    rows, columns = sheet.shape[:2]
    upper = np.arange(rows * columns).reshape(rows, columns)
    lower = upper.copy()
    lower[1:-1, 1:-1] = rows * columns + np.arange((rows - 2) * (columns - 2)).reshape(rows - 2, columns - 2)
    above, below = sheet.copy(), (sheet - offset)[1:-1, 1:-1]
    above[1:-1, 1:-1] += offset[1:-1, 1:-1]
    front, behind = _cut(upper), _cut(lower)[:, ::-1]
    return _facing_outward(np.concatenate([above.reshape(-1, 3), below.reshape(-1, 3)]),
                           np.concatenate([front, behind]).astype(np.int32))


def _cut(index: NDArray[np.int64]) -> Triangles:
    """Two triangles for each square of a grid of vertices, none of them with all three corners on its border."""
    quads = np.stack([index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]])
    for corner in ((slice(None), -1, 0), (slice(None), 0, -1)):
        quads[corner] = np.roll(quads[corner], -1)
    return quads_to_triangles(*quads)


def _at_body(x: NDArray[np.float64], angle: float, depth: float) -> NDArray[np.float64]:
    """Points (k, 3) under the skin: at ``angle`` around the body from its back, ``depth`` of the way to the skin."""
    height, _, middle = body_section(x)
    return np.stack([x, middle + depth * height * np.cos(angle), np.zeros_like(x)], axis=1)


def _between(root: ArrayLike, tip: ArrayLike, push: Sequence[float]) -> NDArray[np.float64]:
    """The middles between two curves' points, pushed aside, so that the rays of a fin are bent."""
    return np.asarray(0.5 * (np.asarray(root) + np.asarray(tip)) + np.asarray(push), np.float64)


def _spline(knots: NDArray[np.float64], values: NDArray[np.float64], where: ArrayLike) -> NDArray[np.float64]:
    """The smooth curve through ``values`` (k, c) at ``knots`` (k,), ``where`` it is asked for (n,): (n, c)."""
    from scipy.interpolate import CubicSpline

    return np.asarray(CubicSpline(knots, values)(where), np.float64)


def _level(points: Sequence[tuple[float, float]]) -> NDArray[np.float64]:
    """Points given by x and y, in the fish's middle plane."""
    return np.insert(np.asarray(points, np.float64), 2, 0.0, axis=1)


def _mirrored(points: Sequence[tuple[float, float, float]], sign: float) -> NDArray[np.float64]:
    return np.asarray(np.asarray(points) * np.array([1.0, 1.0, sign]))


def _facing_outward(vertices: Vertices, triangles: Triangles) -> Mesh:
    return vertices, triangles if volume(vertices, triangles) > 0.0 else triangles[:, ::-1].copy()
