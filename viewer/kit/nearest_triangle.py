"""Which triangle of a mesh is nearest to a point, and where on it: for many points at once.

The triangles are cut into small pieces whose middles stand in a k-d tree. The triangles of the nearest few middles
are compared exactly; a point for which a nearer triangle is still possible looks at more of them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Indices = NDArray[np.intp]

MOST_PIECES = 1_000_000         # more only where there are as many triangles
FIRST_LOOK, MOST_LOOKED_AT = 8, 512
MOST_PAIRS = 4_000_000          # of a point and a triangle to compare in one round: seconds
PAIRS_AT_ONCE = 1 << 17         # as many as stay in the processor's cache
FACE = 6


class Nearest(NamedTuple):
    """For each of n points the number of its triangle (n,), the nearest place on it (n, 3), the distance (n,) and the
    feature there (n,): 0 to 2 for a corner, 3 to 5 for the sides ab, bc and ca, 6 for the face."""

    triangle: Indices
    place: Points
    distance: Points
    feature: Indices


class NearestTriangle:
    """Looks up the triangles ``corners`` (m, 3, 3), cut into pieces no longer than ``piece``.

    ``search`` may find a triangle that is further than the nearest, by ``tolerance`` at most; by a piece in a thicket
    of triangles where comparing more would take too long.
    """

    def __init__(self, corners: Points, piece: float, tolerance: float) -> None:
        from scipy.spatial import cKDTree  # here, because importing it takes longer than a window may wait

        self._rows = _rows(corners)
        self.middles, self._owners, self._reach = _pieces(corners, piece)
        self._tolerance = tolerance
        self._tree = cKDTree(self.middles, balanced_tree=False, compact_nodes=False)

    def search(self, points: Points, within: float) -> Nearest:
        """The triangle that is nearest to each point; a near one for points further than ``within`` from them all."""
        chosen = np.zeros(len(points), np.intp)
        open_points, looked_at = np.arange(len(points)), min(FIRST_LOOK, self._tree.n)
        while len(open_points):
            block = max(1, PAIRS_AT_ONCE // looked_at)
            parts = [open_points[start:start + block] for start in range(0, len(open_points), block)]
            open_points = np.concatenate([self._look(points, part, looked_at, within, chosen) for part in parts])
            more = min(4 * looked_at, self._tree.n)
            if looked_at in (MOST_LOOKED_AT, more) or len(open_points) * more > MOST_PAIRS:
                break
            looked_at = more
        return self.on(points, chosen)

    def on(self, points: Points, chosen: Indices) -> Nearest:
        """Where on the chosen triangles the points' nearest places are."""
        parts = [self._on(points[start:start + PAIRS_AT_ONCE], chosen[start:start + PAIRS_AT_ONCE])
                 for start in range(0, len(points), PAIRS_AT_ONCE)]
        return Nearest(*(np.concatenate(column) for column in zip(*parts, strict=True)))

    def _look(self, points: Points, part: Indices, count: int, within: float, chosen: Indices) -> Indices:
        """Choose among the triangles of the ``count`` nearest pieces; returns the points that have to look further."""
        distances, pieces = self._tree.query(points[part], k=np.arange(1, count + 1), workers=-1)
        candidates = self._owners[pieces]
        found = self._on(np.repeat(points[part], count, axis=0), candidates.ravel()).distance.reshape(-1, count)
        best = found.argmin(axis=1)[:, None]
        chosen[part] = np.take_along_axis(candidates, best, axis=1)[:, 0]
        smallest = np.take_along_axis(found, best, axis=1)[:, 0]
        unsure = (distances[:, -1] < smallest + self._reach - self._tolerance) & (smallest <= within)
        return np.asarray(part[unsure])

    def _on(self, points: Points, chosen: Indices) -> Nearest:
        rows = self._rows[chosen]
        along_ab, along_ac, feature = _nearest_on_triangles(points - rows[:, :3], rows)
        place = rows[:, :3] + along_ab[:, None] * rows[:, 3:6] + along_ac[:, None] * rows[:, 6:9]
        away = points - place
        return Nearest(chosen, place, np.sqrt(np.einsum("ij,ij->i", away, away)), feature)


def _rows(corners: Points) -> Points:
    """For each triangle a, ab, ac and their products ab·ab, ab·ac, ac·ac: (m, 12), so that one look gets them all."""
    a, ab, ac = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    products = [np.einsum("ij,ij->i", one, other) for one, other in ((ab, ab), (ab, ac), (ac, ac))]
    return np.concatenate([a, ab, ac, np.stack(products, axis=1)], axis=1)


def _nearest_on_triangles(ap: Points, rows: Points) -> tuple[Points, Points, Indices]:
    """Where the nearest place lies, as a + v ab + w ac: v (n,), w (n,) and the feature (n,).

    After Ericson, "Real-Time Collision Detection", 2005, 5.1.5; his d3 to d6 follow from d1, d2 and the triangle.
    """
    d1, d2 = np.einsum("ij,ij->i", rows[:, 3:6], ap), np.einsum("ij,ij->i", rows[:, 6:9], ap)
    ab_ab, ab_ac, ac_ac = rows[:, 9], rows[:, 10], rows[:, 11]
    d3, d4, d5, d6 = d1 - ab_ab, d2 - ab_ac, d1 - ab_ac, d2 - ac_ac
    va, vb, vc = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
    with np.errstate(all="ignore"):
        whole = va + vb + vc
        v, w = vb / whole, vc / whole
        feature = np.full(len(ap), FACE)
        for number, where, new_v, new_w in (     # the later ones go before the earlier ones
                (4, (va <= 0) & (d4 >= d3) & (d5 >= d6), None, (d4 - d3) / ((d4 - d3) + (d5 - d6))),
                (5, (vb <= 0) & (d2 >= 0) & (d6 <= 0), 0.0, d2 / ac_ac),
                (2, (d6 >= 0) & (d5 <= d6), 0.0, 1.0),
                (3, (vc <= 0) & (d1 >= 0) & (d3 <= 0), d1 / ab_ab, 0.0),
                (1, (d3 >= 0) & (d4 <= d3), 1.0, 0.0),
                (0, (d1 <= 0) & (d2 <= 0), 0.0, 0.0)):
            np.copyto(w, new_w, where=where)
            np.copyto(v, 1.0 - w if new_v is None else new_v, where=where)
            feature[where] = number
    return v, w, feature


def cut_to_pieces(corners: Points, longest: float) -> tuple[Points, Indices]:
    """Triangles halved across their longest side until none is longer than ``longest``.

    Returns the pieces (k, 3, 3) and the triangle each is of (k,).
    """
    done_pieces, done_owners = [], []
    pieces, owner, lengths = corners, np.arange(len(corners)), _lengths(corners)
    longest = _affordable(lengths, longest)
    while len(pieces):
        done = lengths.max(axis=1) <= longest
        done_pieces.append(pieces[done])
        done_owners.append(owner[done])
        pieces, owner = _halved(pieces[~done], lengths[~done]), np.repeat(owner[~done], 2)
        lengths = _lengths(pieces)
    return np.concatenate(done_pieces), np.concatenate(done_owners)


def _pieces(corners: Points, longest: float) -> tuple[Points, Indices, float]:
    """The middles (k, 3) of the pieces, the triangle each is of (k,) and how far a piece reaches from its middle."""
    pieces, owners = cut_to_pieces(corners, longest)
    middles = pieces.mean(axis=1)
    away = pieces - middles[:, None]
    return middles, owners, float(np.einsum("ijk,ijk->ij", away, away).max(initial=0.0)) ** 0.5


def _lengths(pieces: Points) -> Points:
    """Of each triangle's sides ab, bc and ca: (k, 3)."""
    sides = (pieces[:, (end + 1) % 3] - pieces[:, end] for end in range(3))
    return np.stack([np.sqrt(np.einsum("ij,ij->i", side, side)) for side in sides], axis=1)


def _halved(pieces: Points, lengths: Points) -> Points:
    """Each triangle cut in two at the middle of its longest side, the two halves next to each other."""
    turn = (lengths.argmax(axis=1)[:, None] + np.arange(3)) % 3
    a, b, c = np.take_along_axis(pieces, turn[:, :, None], axis=1).transpose(1, 0, 2)
    middle = 0.5 * (a + b)
    halves = np.stack([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)], axis=1)
    return halves.reshape(-1, 3, 3)


def _affordable(lengths: Points, longest: float) -> float:
    """``longest``, or more where that would make more pieces than memory is for."""
    perimeter = lengths.sum(axis=1)
    area = 0.05 * np.square(perimeter).sum()    # no triangle has more
    while 5.0 * area / longest**2 + perimeter.sum() / longest > MOST_PIECES + 2 * len(lengths):
        longest *= 1.5
    return longest
