"""Points spread evenly through the inside of a closed mesh, each with the room it has around it."""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from viewer.kit.mesh import Triangles, Vertices
from viewer.kit.shapes import face_normals
from viewer.kit.surface_sampling import SamplingTable

Pair: TypeAlias = tuple[NDArray[np.float64], NDArray[np.float64]]

COUNT = 2**16
SEED = 20260
SHIFTS = 1.324717957244746 ** np.array([-1.0, -2.0])     # by the plastic number
FINEST, COARSEST = 320, 8       # columns along each side of the box around a mesh
MOST_PAIRS = 2**22              # of a column and a triangle that it may cross, looked at together
MOST_PIECES = 400_000           # of the surface, to which distances are taken
FEW_PIECES = 12_000             # of the surface, among which the nearest one is looked for


class Spans(NamedTuple):
    """Stretches of vertical lines inside a mesh: where each line stands, x and z (s, 2), and from and to, y (s,).

    ``square`` (s, 2) says in which column and row of the lattice it stands.
    """

    square: NDArray[np.int64]
    line: NDArray[np.float64]
    low: NDArray[np.float64]
    high: NDArray[np.float64]


def volume_table(vertices: Vertices, triangles: Triangles, count: int = COUNT) -> SamplingTable:
    """About ``count`` points in a closed mesh, as many in each part of its volume: a place and a normal to an entry.

    w of a place is the radius of a ball around it that lies wholly inside and is no wider than the points are
    apart: points drawn from the balls are even, but for a tenth more or less within such a width of the surface.
    The normal is that of the surface nearest to the point. The points are the same in every run.
    Raises ValueError for a mesh that encloses nothing.
    """
    chance = np.random.default_rng(SEED)
    spans, square = interior_spans(vertices, triangles, chance)
    length = float((spans.high - spans.low).sum())
    if not length > 0.0:
        raise ValueError("it encloses no volume")
    points = _along(spans, length / count)
    apart = float(np.cbrt(length * square / count))
    room, nearest = clearance(vertices, triangles, points, 0.5 * apart)
    places = np.concatenate([points, room[:, None]], axis=1)
    return SamplingTable(places.astype(np.float32)[:, None], face_normals(vertices, triangles[nearest])
                         .astype(np.float32)[:, None])


def interior_spans(vertices: Vertices, triangles: Triangles,
                   chance: np.random.Generator) -> tuple[Spans, float]:
    """Where vertical lines, one somewhere in each square of a lattice, run inside; and a square's area.

    A line is inside where it has gone in through the surface more often than out, so that solids may overlap
    and a shell turned inside out is a hollow.
    """
    used = vertices[np.unique(triangles)]
    low, high = used.min(axis=0), used.max(axis=0)
    lines = _lattice_for(vertices, triangles, low, high)
    cell = (high - low)[[0, 2]] / lines
    stand = low[[0, 2]] + (np.moveaxis(np.indices((lines, lines)), 0, -1) + chance.random((lines, lines, 2))) * cell
    which, y, way = _crossings(vertices[triangles], stand.reshape(-1, 2), low, cell, lines)
    order = np.lexsort((y, which))
    which, y, way = which[order], y[order], way[order]
    even = np.bincount(which, way, lines * lines)[which] == 0.0     # else rounding lost one where triangles meet
    which, y, depth = which[even], y[even], np.cumsum(way[even])
    inside = np.nonzero((depth > 0)[:-1] & (which[1:] == which[:-1]))[0]
    square = np.stack(np.divmod(which[inside], lines), axis=1)
    return Spans(square, stand.reshape(-1, 2)[which[inside]], y[inside], y[inside + 1]), float(cell.prod())


def _along(spans: Spans, step: float) -> Vertices:
    """Points (p, 3) at every ``step`` along the lines, each line's shifted so that neighbours fill their gaps.

    The shifts are those of Roberts' sequence R2 ("The Unreasonable Effectiveness of Quasirandom Sequences", 2018).
    """
    shift = np.mod(0.5 + spans.square @ SHIFTS, 1.0)
    first = np.ceil(spans.low / step - shift).astype(np.int64)
    number = np.maximum(0, np.floor(spans.high / step - shift).astype(np.int64) - first + 1)
    owner = np.repeat(np.arange(len(number)), number)
    place = np.arange(len(owner)) - np.repeat(np.cumsum(number) - number, number)
    y = np.clip((first[owner] + place + shift[owner]) * step, spans.low[owner], spans.high[owner])
    return np.stack([spans.line[owner, 0], y, spans.line[owner, 1]], axis=1)


def clearance(vertices: Vertices, triangles: Triangles, points: Vertices,
              scale: float) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """How far each of ``points`` (p, 3) is from the surface at least, up to ``scale``, and which triangle is near.

    The surface is cut into pieces smaller than ``scale``; nothing of a piece is farther from its middle than
    two thirds of its longest side. The triangle is within a fifth of the distance of the nearest of some
    thousand pieces: near the middle of a ball, all of its surface is equally near.
    """
    from scipy.spatial import cKDTree

    corners = vertices[triangles]
    a, b, c = corners.transpose(1, 0, 2)
    lengths = [np.sqrt(np.einsum("ij,ij->i", side, side)) for side in (b - a, c - b, a - c)]
    longest = np.maximum(np.maximum(lengths[0], lengths[1]), lengths[2])
    side = 0.5 * scale
    cuts = np.maximum(1, np.ceil(longest / side)).astype(np.int64)
    while (cuts * cuts).sum() > len(cuts) + MOST_PIECES:
        side *= 1.5
        cuts = np.maximum(1, np.ceil(longest / side)).astype(np.int64)
    middles, owner = _pieces(corners, cuts)
    reach = (2.0 / 3.0) * float((longest / cuts).max())
    distance, _ = cKDTree(middles).query(points, distance_upper_bound=scale + reach)
    some = slice(None, None, 1 + len(middles) // FEW_PIECES)
    _, piece = cKDTree(middles[some]).query(points, eps=0.2)
    return np.clip(distance - reach, 0.0, scale), owner[some][piece]


def _pieces(corners: Vertices, cuts: NDArray[np.int64]) -> tuple[Vertices, NDArray[np.int64]]:
    """The middles of the cuts**2 equal triangles into which each triangle is cut, and whose they are."""
    owner = np.repeat(np.arange(len(cuts)), cuts * cuts)
    number = np.arange(len(owner)) - np.repeat(np.cumsum(cuts * cuts) - cuts * cuts, cuts * cuts)
    sides = cuts[owner]
    row = np.minimum(np.sqrt(number).astype(np.int64), sides - 1)
    place = number - row * row                      # row r holds 2 r + 1 pieces, upright and on their heads by turns
    upright = place % 2 == 0
    second = (place // 2 + np.where(upright, 1.0, 2.0) / 3.0) / sides
    first = 1.0 - (row + np.where(upright, 2.0, 1.0) / 3.0) / sides
    a, b, c = corners[owner].transpose(1, 0, 2)
    return first[:, None] * a + second[:, None] * c + (1.0 - first - second)[:, None] * b, owner


def _lattice_for(vertices: Vertices, triangles: Triangles, low: Vertices, high: Vertices) -> int:
    """How many columns along each side: as many as can be looked at in a moment."""
    least, most = _bounds(vertices[triangles])
    share = (most - least) / np.maximum((high - low)[[0, 2]], 1e-300)
    lines = FINEST
    while lines > COARSEST and ((share * lines + 1.0).prod(axis=1)).sum() > 4 * MOST_PAIRS:
        lines = lines * 3 // 4
    return lines


def _crossings(corners: Vertices, stand: NDArray[np.float64], low: Vertices, cell: NDArray[np.float64],
               lines: int) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.int64]]:
    """Where vertical lines pass through triangles: the line's number, y, and 1 where it goes in, -1 where out."""
    least, most = _bounds(corners)
    with np.errstate(divide="ignore", invalid="ignore"):
        first = np.nan_to_num((least - low[[0, 2]]) / cell).astype(np.int64)
        last = np.nan_to_num((most - low[[0, 2]]) / cell).astype(np.int64)
    first, last = np.clip(first, 0, lines - 1), np.clip(last, 0, lines - 1)
    wide, deep = (last - first + 1).T
    ends = np.cumsum(wide * deep)
    found = [_crossed(corners, stand, first, deep, part, ends, lines) for part in _portions(ends)]
    which, y, way = (np.concatenate(each) for each in zip(*found, strict=True))
    return which, y, way


def _portions(ends: NDArray[np.int64]) -> list[slice]:
    """Runs of triangles with about ``MOST_PAIRS`` pairs each."""
    cuts = np.searchsorted(ends, np.arange(MOST_PAIRS, ends[-1], MOST_PAIRS))
    bounds = np.unique(np.concatenate([[0], cuts, [len(ends)]]))
    return [slice(int(start), int(stop)) for start, stop in pairwise(bounds)]


def _crossed(corners: Vertices, stand: NDArray[np.float64], first: NDArray[np.int64], deep: NDArray[np.int64],
             part: slice, ends: NDArray[np.int64],
             lines: int) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.int64]]:
    """The crossings of some of the triangles, each with every line whose square its surroundings touch."""
    pairs = np.diff(ends[part], prepend=ends[part.start - 1] if part.start else 0)
    owner = np.repeat(np.arange(part.start, part.stop), pairs)
    number = np.arange(len(owner)) - np.repeat(np.cumsum(pairs) - pairs, pairs)
    which = (first[owner, 0] + number // deep[owner]) * lines + first[owner, 1] + number % deep[owner]
    x, z = stand[which].T
    a, b, c = ((corners[owner, corner, 0] - x, corners[owner, corner, 2] - z) for corner in range(3))
    ab, bc, ca = _side(a, b), _side(b, c), _side(c, a)
    hit = ((ab > 0) & (bc > 0) & (ca > 0)) | ((ab < 0) & (bc < 0) & (ca < 0))
    ab, bc, ca = ab[hit], bc[hit], ca[hit]
    height = corners[owner[hit], :, 1]
    y = (bc * height[:, 0] + ca * height[:, 1] + ab * height[:, 2]) / (ab + bc + ca)
    return which[hit], y, np.where(ab > 0, -1, 1)


def _side(one: Pair, other: Pair) -> NDArray[np.float64]:
    """On which side of the line from ``one`` to ``other``, x and z each, the origin lies from above; 0 on it."""
    return np.asarray(one[1] * other[0] - one[0] * other[1])


def _bounds(corners: Vertices) -> tuple[Vertices, Vertices]:
    """The least and the greatest x and z of each triangle, (t, 2) each."""
    a, b, c = (corners[:, corner, ::2] for corner in range(3))
    return np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
