"""What a twist does to a limb: how thin it gets and where, and how much of its volume and skin is left."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from viewer.kit.cross_section import flattened
from viewer.kit.limb import WHOLE, Limb, distances, size_of
from viewer.kit.mesh import Triangles, Vertices
from viewer.kit.mesh_measure import area, volume
from viewer.kit.quaternion import Numbers
from viewer.kit.surface_sampling import welded

PLACES = 161            # on the curve along a limb, where its vertices do not stand in rings


def law(share: ArrayLike, degrees: ArrayLike, twist_bones: int = 0) -> Numbers:
    """The factor by which linear blending changes a radius at ``share`` of the twist, from 0 to 1.

    Between two neighbours of the chain, twisted against each other by t, a point with weights w and 1 - w keeps
    sqrt(w^2 + (1 - w)^2 + 2 w (1 - w) cos t) of its distance from the axis: the length of the mean of two turned
    vectors. Dual quaternions keep all of it.
    """
    place = np.asarray(share, np.float64) * (twist_bones + 1)
    w = place - np.minimum(np.floor(place), twist_bones)
    cosine = np.cos(np.radians(np.asarray(degrees, np.float64)) / (twist_bones + 1))
    return np.asarray(np.sqrt(np.maximum(w * w + (1.0 - w) ** 2 + 2.0 * w * (1.0 - w) * cosine, 0.0)))


def thinnest_by_law(degrees: ArrayLike, twist_bones: int = 0) -> Numbers:
    """The smallest of these factors, cos(t / 2) with t the twist between neighbours; past half a turn it is 0 or less.

    Its amount is given: a limb turned inside out is as thick as it looks.
    """
    return np.abs(np.cos(np.radians(np.asarray(degrees, np.float64)) / (2.0 * (twist_bones + 1))))


@dataclass(frozen=True)
class LimbNumbers:
    """Ratios of after to before, 1 where nothing changed; nan where a limb has no such part."""

    min_radius_ratio: float         # at the vertices
    thinnest: float                 # anywhere on the edges between them: what one sees
    volume_ratio: float
    area_ratio: float


class LimbGauge:
    """Compares a limb's skin as it is with the skin as it was bound."""

    def __init__(self, limb: Limb) -> None:
        self.limb = limb

    def radius_ratios(self, posed: Vertices, upper: Numbers, vertices: NDArray[np.intp]) -> Numbers:
        """By how much the radius of each of ``vertices`` has changed; ``posed`` (n, 3) are where these are now.

        ``upper`` (4, 4) has moved the limb as a whole: it takes the axis along, and the size it gives does not count.
        """
        limb = self.limb
        size = size_of(upper)
        axis = upper[:3, :3] @ limb.axis
        origin = upper[:3, :3] @ limb.start + upper[:3, 3]
        now = distances(np.asarray(posed, np.float64), origin, axis / np.linalg.norm(axis))
        return np.asarray(now / size / limb.radius[vertices])

    def numbers(self, posed: Vertices, upper: Numbers) -> LimbNumbers:
        """All of them, for vertices (n, 3) of the whole mesh as they are now."""
        ratios = self.radius_ratios(posed[self.limb.measured], upper, self.limb.measured)
        size = size_of(upper)
        (volume_before, area_before), (volume_now, area_now) = self._bound_extent, self._extent(posed)
        return LimbNumbers(
            float(ratios.min()) if len(ratios) else np.nan, self._thinnest(posed, upper, ratios),
            _ratio(volume_now / size**3, volume_before), _ratio(area_now / size**2, area_before))

    def _thinnest(self, posed: Vertices, upper: Numbers, ratios: Numbers) -> float:
        """The smallest ratio on any edge between measured vertices: where it comes nearest to the axis."""
        first, second = self._edges.T
        if not len(first):
            return float(ratios.min()) if len(ratios) else np.nan
        now, bound = flattened(self.limb, posed, 0.0, upper), self._bound_across
        way = now[second] - now[first]
        squared = np.einsum("ij,ij->i", way, way)
        part = np.clip(np.divide(-np.einsum("ij,ij->i", now[first], way), squared, out=np.zeros(len(way)),
                                 where=squared > 0.0), 0.0, 1.0)[:, None]
        before = np.linalg.norm(bound[first] + part * (bound[second] - bound[first]), axis=1)
        return float((np.linalg.norm(now[first] + part * way, axis=1) / np.maximum(before, 1e-30)).min())

    @cached_property
    def _bound_across(self) -> Numbers:
        return flattened(self.limb, self.limb.mesh.positions.astype(np.float64), 0.0)

    @cached_property
    def _edges(self) -> NDArray[np.intp]:
        """The sides (e, 2) of triangles between measured vertices."""
        theirs = np.zeros(len(self.limb.mesh.positions), np.bool_)
        theirs[self.limb.measured] = True
        triangles = self.limb.mesh.triangles
        sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        sides = np.unique(np.sort(sides[theirs[sides].all(axis=1)], axis=1), axis=0)
        return sides.astype(np.intp)

    def along(self, ratios: Numbers, shares: Numbers) -> tuple[Numbers, Numbers, Numbers]:
        """Places on the limb from 0 to 1, the mean ratio and the mean share at each: of rings, else of slices."""
        limb = self.limb
        places = np.round(limb.along[limb.measured], 6)
        rings, ring = np.unique(places, return_inverse=True)
        if len(rings) > 4 * PLACES:
            slices = np.linspace(rings[0], rings[-1], PLACES + 1)
            ring = np.clip(np.searchsorted(slices, places, side="right") - 1, 0, PLACES - 1)
            _, ring = np.unique(ring, return_inverse=True)
            rings = np.bincount(ring, places) / np.bincount(ring)
        count = np.bincount(ring)
        return rings, np.bincount(ring, ratios) / count, np.bincount(ring, shares) / count

    @cached_property
    def _bound_extent(self) -> tuple[float, float]:
        return self._extent(self.limb.mesh.positions.astype(np.float64))

    def _extent(self, places: Vertices) -> tuple[float, float]:
        """Volume and area of the skin that is measured, its vertices (n, 3) of the whole mesh at ``places``."""
        rows, skin, rim = self._skin
        return _enclosed(places[rows], skin, rim), area(places[rows], skin)

    @cached_property
    def _skin(self) -> tuple[NDArray[np.int64], Triangles, NDArray[np.int64]]:
        """The vertices between the ends of the blending, else all, their triangles, and the edges (e, 2) around."""
        limb = self.limb
        triangles = welded(limb.mesh.positions.astype(np.float64), limb.mesh.triangles)
        low, high = limb.zone
        slack = 1e-4 * (high - low)
        inside = (limb.held > WHOLE) & (limb.along > low - slack) & (limb.along < high + slack)
        skin = triangles[inside[triangles].all(axis=1)]
        skin = skin if len(skin) else triangles
        rows, numbered = np.unique(skin, return_inverse=True)
        skin, count = numbered.reshape(skin.shape).astype(np.int32), len(rows)
        edges = np.concatenate([skin[:, [0, 1]], skin[:, [1, 2]], skin[:, [2, 0]]]).astype(np.int64)
        forward, backward = edges[:, 0] * count + edges[:, 1], edges[:, 1] * count + edges[:, 0]
        return rows.astype(np.int64), skin, edges[~np.isin(forward, backward)]


def _ratio(now: float, before: float) -> float:
    """What is left; nan where there was nothing, as in a flat sheet."""
    return now / before if abs(before) > 1e-30 else np.nan


def _enclosed(places: Vertices, skin: Triangles, rim: NDArray[np.int64]) -> float:
    """The volume inside the skin, each of its openings closed by a fan around its middle."""
    if not len(rim):
        return volume(places, skin)
    loops = _loops(rim)
    count = np.bincount(loops)
    middles = np.stack([np.bincount(loops, places[rim[:, 0]][:, axis]) / count for axis in range(3)], axis=1)
    fans = np.stack([rim[:, 1], rim[:, 0], len(places) + loops], axis=1)
    return volume(np.concatenate([places, middles]), np.concatenate([skin, fans]).astype(np.int32))


def _loops(rim: NDArray[np.int64]) -> NDArray[np.int64]:
    """Which opening each edge (e, 2) of the rim belongs to."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    vertices, ends = np.unique(rim, return_inverse=True)
    ends = ends.reshape(rim.shape)
    graph = coo_array((np.ones(len(rim)), (ends[:, 0], ends[:, 1])), shape=(len(vertices),) * 2)
    return np.asarray(connected_components(graph, directed=False)[1][ends[:, 0]], np.int64)
