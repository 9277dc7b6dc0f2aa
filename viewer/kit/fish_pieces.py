"""From a fish's curved surfaces to its pieces: grids of vertices with all that a vertex has, cut into triangles."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from viewer.kit import fish_joints
from viewer.kit.fish_barbels import BarbelSurface, place_on_body
from viewer.kit.fish_body import BodySurface, body_surface
from viewer.kit.fish_curve import Numbers, Surface, normals_between_poles
from viewer.kit.fish_eyes import eye_points
from viewer.kit.fish_fins import Fin, median_fin, paired_fin
from viewer.kit.fish_lattice import even_lattice, fitted_lattice
from viewer.kit.fish_species import Barbel, MedianFin, PairedFin, Part, Species
from viewer.kit.mesh import Triangles, quads_to_triangles

SIDES = {"left": -1.0, "right": 1.0}
THINNER = 8     # how many times fewer bands and sectors than the body a barbel has


class Detail(NamedTuple):
    """How finely a fish is cut: a body's bands along and sectors around it, a fin's strips and layers, an eye's bands.

    With ``ribs`` a fin has that many ``strips`` for each of its rays, else that many in all,
    times its ``size``.
    """

    bands: int
    sectors: int
    strips: int
    layers: int
    eye: int
    ribs: bool
    relief: float


DETAILS = (
    Detail(6, 6, 2, 1, eye=0, ribs=False, relief=0.0),
    Detail(16, 12, 8, 3, eye=4, ribs=False, relief=0.0),
    Detail(48, 36, 24, 6, eye=8, ribs=False, relief=0.75),
    Detail(128, 84, 4, 12, eye=14, ribs=True, relief=1.0),
    Detail(224, 136, 6, 20, eye=24, ribs=True, relief=1.0),
)


class Piece(NamedTuple):
    """One closed piece of a fish, with the fields of ``FishMesh`` in float64."""

    positions: Numbers
    normals: Numbers
    coordinates: Numbers
    parts: NDArray[np.int32]
    joints: NDArray[np.int32]
    weights: Numbers
    triangles: Triangles


def pieces(species: Species, level: int) -> dict[str, Piece]:
    """All pieces by name, at a level of ``DETAILS``: the body, fins, barbels and eyes."""
    detail = DETAILS[level]
    surface = body_surface(species, detail.relief)
    made = {"body": _body_piece(surface, detail)}
    for number, median in enumerate(species.median_fins):
        if level >= median.coarsest:
            made[f"{median.part.name.lower()} {number}"] = _median_piece(median, surface, detail)
    for side, sign in SIDES.items():
        made |= {f"{side} {paired.part.name.lower()}": _paired_piece(paired, surface, detail, sign)
                 for paired in species.paired_fins if level >= paired.coarsest}
        made |= {f"{side} barbel {number}": _barbel_piece(barbel, surface, detail, sign)
                 for number, barbel in enumerate(species.barbels) if detail.relief}
        if detail.eye:
            made[f"{side} eye"] = _eye_piece(species, surface, detail, sign)
    return made


def _body_piece(surface: BodySurface, detail: Detail) -> Piece:
    """The body, its seam along the back."""
    size = detail.bands, detail.sectors
    turn, angle = fitted_lattice(surface, *size) if detail.relief else even_lattice(*size)
    positions, normals, triangles = _between_poles(surface, turn, angle)
    coordinates = np.stack([surface.along(turn), angle / (2.0 * np.pi)], axis=-1).reshape(-1, 2)
    return _rigid(positions, normals, coordinates, Part.BODY, triangles)


def _barbel_piece(barbel: Barbel, surface: BodySurface, detail: Detail, sign: float) -> Piece:
    """A feeler, of the colour of the skin it stands on."""
    turn, angle = even_lattice(detail.bands // THINNER, detail.sectors // THINNER)
    positions, normals, triangles = _between_poles(BarbelSurface(barbel, surface), turn, angle)
    coordinates = np.broadcast_to(place_on_body(barbel, surface, sign), (len(positions), 2))
    mirror = np.array([1.0, 1.0, sign])
    return _rigid(positions * mirror, normals * mirror, coordinates, Part.BODY,
                  triangles if sign > 0.0 else triangles[:, ::-1])


def _between_poles(surface: Surface, turn: Numbers, angle: Numbers) -> tuple[Numbers, Numbers, Triangles]:
    """Positions and normals (n, 3) at a lattice whose first and last rows are poles, and triangles.

    At a pole each triangle has a vertex of its own, whose angle, changed in place, is that of the triangle's middle.
    """
    angle[[0, -1], :-1] += 0.5 * np.diff(angle[[0, -1]], axis=1)
    index = np.arange(turn.size).reshape(turn.shape)
    caps = [np.stack([index[0, :-1], index[1, 1:], index[1, :-1]], axis=1),
            np.stack([index[-1, :-1], index[-2, :-1], index[-2, 1:]], axis=1)]
    bands = quads_to_triangles(index[1:-2, :-1], index[1:-2, 1:], index[2:-1, 1:], index[2:-1, :-1])
    triangles = np.concatenate([*caps, bands]).astype(np.int32)
    flat = turn.ravel(), angle.ravel()
    return surface(*flat), normals_between_poles(surface, *flat), triangles


def _median_piece(median: MedianFin, surface: BodySurface, detail: Detail) -> Piece:
    u, v = _places(detail, median)
    parts = np.full(len(u), median.part, np.int32)
    if median.tail is not None:
        before, until = median.tail
        parts = np.select([u < before, u <= until], [Part.DORSAL, Part.TAIL], Part.ANAL).astype(np.int32)
    return _fin_piece(median_fin(median, surface), (u, v), detail.ribs, parts,
                      *fish_joints.median_weights(median, u, v))


def _paired_piece(paired: PairedFin, surface: BodySurface, detail: Detail, sign: float) -> Piece:
    u, v = _places(detail, paired)
    parts = np.full(len(v), paired.part, np.int32)
    return _fin_piece(paired_fin(paired, surface, sign), (u, v), detail.ribs, parts,
                      *fish_joints.paired_weights(paired, sign, v))


def _places(detail: Detail, fin: MedianFin | PairedFin) -> tuple[Numbers, Numbers]:
    """Places (n,) along a fin's root and out from it, of the vertices of its upper and then of its lower side."""
    u, v = np.meshgrid(*_lattice(detail, fin), indexing="ij")
    return np.tile(u.ravel(), 2), np.tile(v.ravel(), 2)


def _lattice(detail: Detail, fin: MedianFin | PairedFin) -> tuple[Numbers, Numbers]:
    strips = detail.strips * fin.rays if detail.ribs else max(1, round(detail.strips * fin.size))
    layers = max(1, round(detail.layers * min(1.0, fin.size)))
    return np.linspace(0.0, 1.0, strips + 1), np.linspace(0.0, 1.0, layers + 1)


def _fin_piece(fin: Fin, places: tuple[Numbers, Numbers], ribs: bool, parts: NDArray[np.int32],
               joints: NDArray[np.int32], weights: Numbers) -> Piece:
    """A fin of two sides whose borders coincide, at ``places`` of its upper and then of its lower side."""
    u, v = places
    count, layers = len(u) // 2, int((u == 0.0).sum()) // 2
    side = np.repeat([1.0, -1.0], count)
    upper = _cut(np.arange(count).reshape(-1, layers))
    if fin.handedness < 0.0:
        upper = upper[:, ::-1]
    triangles = np.concatenate([upper, upper[:, ::-1] + count]).astype(np.int32)
    if layers == 2:     # both ends of a ray and nothing between: no thickness
        positions, normals = fin.points(u, v, 0.0, ribs), side[:, None] * fin.middle_normals(u, v)
    else:
        positions, normals = fin.points(u, v, side, ribs), fin.normals(u, v, side, ribs)
    return Piece(positions, normals, np.stack([u, v], axis=1), parts, joints, weights, triangles)


def _cut(index: NDArray[np.int64]) -> Triangles:
    """Two triangles for each square of a grid of vertices, none of them with all three corners on its border.

    So no triangle of one side of a fin coincides with one of the other side.
    """
    quads = np.stack([index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]])
    for corner in ((slice(None), -1, 0), (slice(None), 0, -1)):
        quads[corner] = np.roll(quads[corner], -1)
    return quads_to_triangles(*quads)


def _eye_piece(species: Species, surface: BodySurface, detail: Detail, sign: float) -> Piece:
    """A ball whose poles are the pupil and, within the head, its back."""
    sectors = 2 * detail.eye
    latitude = np.pi * np.arange(1, detail.eye)[:, None] / detail.eye
    longitude = 2.0 * np.pi * np.arange(sectors) / sectors
    rings = np.stack(np.broadcast_arrays(np.sin(latitude) * np.cos(longitude), np.sin(latitude) * np.sin(longitude),
                                         np.cos(latitude)), axis=-1).reshape(-1, 3)
    unit = np.concatenate([[[0.0, 0.0, 1.0]], rings, [[0.0, 0.0, -1.0]]])
    index = 1 + np.arange(len(rings)).reshape(-1, sectors)
    onward = np.roll(index, -1, axis=1)
    pupil, back = np.zeros(sectors, np.int64), np.full(sectors, len(unit) - 1)
    caps = [np.stack([pupil, index[0], onward[0]], axis=1), np.stack([back, onward[-1], index[-1]], axis=1)]
    triangles = np.concatenate([*caps, quads_to_triangles(index[:-1], index[1:], onward[1:], onward[:-1])])
    positions, normals = eye_points(species.eye, surface, sign, unit)
    # Ahead, up and outward are right-handed on the right side only.
    return _rigid(positions, normals, unit[:, :2], Part.EYE, triangles if sign > 0.0 else triangles[:, ::-1])


def _rigid(positions: Numbers, normals: Numbers, coordinates: Numbers, part: Part, triangles: Triangles) -> Piece:
    """A piece that follows the body alone."""
    shape = len(positions), fish_joints.INFLUENCES
    weights = np.zeros(shape)
    weights[:, 0] = 1.0
    parts = np.full(shape[0], part, np.int32)
    return Piece(positions, normals, coordinates, parts, np.zeros(shape, np.int32), weights, triangles.astype(np.int32))
