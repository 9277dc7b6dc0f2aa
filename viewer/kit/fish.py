"""Fish of our own, of several species: one metre along x, nose at +x, back towards +y, its left side towards -z.

A fish is a body, fins and eyes, each closed and standing in the body, so that the whole may bend but nothing comes
off. Normals are those of the curves it is built from, not means over its triangles.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from viewer.errors import DemoscopeError
from viewer.kit import fish_joints
from viewer.kit.fish_clownfish import CLOWNFISH
from viewer.kit.fish_eel import EEL
from viewer.kit.fish_koi import KOI
from viewer.kit.fish_pieces import DETAILS, Piece, pieces
from viewer.kit.fish_species import Part, Species
from viewer.kit.fish_tuna import TUNA
from viewer.kit.mesh import Mesh
from viewer.kit.rig import RiggedMesh, Skeleton, bound_at_rest

__all__ = ["ANAL", "BODY", "DETAILS", "DORSAL", "EYE", "PECTORAL", "PELVIC", "SPECIES", "TAIL", "FishError",
           "FishMesh", "fish", "fish_mesh", "fish_pieces", "fish_rig", "fish_skeleton"]

BODY, TAIL, DORSAL, ANAL, PECTORAL, PELVIC, EYE = Part
SPECIES: Mapping[str, Species] = MappingProxyType({each.name: each for each in (CLOWNFISH, TUNA, KOI, EEL)})


class FishError(DemoscopeError):
    """There is no such fish."""


class FishMesh(NamedTuple):
    """A fish at rest, in metres: n vertices, m triangles, which are counter-clockwise from outside.

    ``coordinates`` are, on the body, along it from 0 at the nose to 1 at the end of the tail's stalk, and around it
    from 0 at the back down the left side to 0.5 at the belly and up to 1 again; on a fin, along its root from the
    front or the top, and out from the root to its tip, each 0 to 1; on an eye, ahead and up on its disc from -1 to 1.
    ``parts`` says what a vertex belongs to, BODY to EYE. ``joints`` (into ``fish_skeleton``) have ``weights`` with
    the sum 1. Vertices are double where coordinates or normals jump: at the back, the poles and the fins' edges.
    """

    positions: NDArray[np.float32]      # (n, 3)
    normals: NDArray[np.float32]        # (n, 3)
    coordinates: NDArray[np.float32]    # (n, 2)
    parts: NDArray[np.int32]            # (n,)
    joints: NDArray[np.int32]           # (n, 4)
    weights: NDArray[np.float32]        # (n, 4)
    triangles: NDArray[np.int32]        # (m, 3)


@lru_cache(maxsize=64)
def fish(species: str, detail: int = 3) -> FishMesh:
    """A fish of a species at a ``detail`` from 0, for one far away, to 4; 3 is fine enough to fill the picture.

    At detail 0 fins have no thickness and there are no eyes. Raises FishError for what there is not.
    """
    return _joined(list(fish_pieces(species, detail).values()))


def fish_pieces(species: str, detail: int = 3) -> dict[str, Piece]:
    """The pieces of ``fish`` by name: body, fins and eyes, in that order. Raises FishError for what there is not."""
    if not 0 <= detail < len(DETAILS):
        raise FishError(f"detail = {detail} is outside 0 to {len(DETAILS) - 1}")
    return pieces(_species(species), detail)


@lru_cache
def fish_skeleton(species: str) -> Skeleton:
    """The joints of a species' fins; the same names in the same order for all of them."""
    skeleton = fish_joints.skeleton(_species(species))
    _shared(skeleton.parents, skeleton.translations, skeleton.rotations, skeleton.scales)
    return skeleton


@lru_cache(maxsize=64)
def fish_rig(species: str, detail: int = 3) -> RiggedMesh:
    """A fish bound to its skeleton; its palette has every joint, in the skeleton's order."""
    mesh, skeleton = fish(species, detail), fish_skeleton(species)
    bones = np.arange(len(skeleton.names), dtype=np.int32)
    inverse_bind = bound_at_rest(skeleton, bones)
    _shared(bones, inverse_bind)
    return RiggedMesh(mesh.positions, mesh.normals, mesh.coordinates, mesh.joints, mesh.weights, mesh.triangles,
                      skeleton, bones, inverse_bind)


@lru_cache
def fish_mesh(species: str = "koi", detail: int = 3) -> Mesh:
    """A fish as closed pieces that share their vertices: (n, 3) in metres, and triangles (m, 3)."""
    mesh = fish(species, detail)
    vertices, index = np.unique(mesh.positions.astype(np.float64).round(7) + 0.0, axis=0, return_inverse=True)
    triangles = index.reshape(-1)[mesh.triangles].astype(np.int32)
    _shared(vertices, triangles)
    return vertices, triangles


def _species(name: str) -> Species:
    if name not in SPECIES:
        raise FishError(f"species = {name} is none of {', '.join(SPECIES)}")
    return SPECIES[name]


def _joined(parts: list[Piece]) -> FishMesh:
    first = np.cumsum([0] + [len(piece.positions) for piece in parts[:-1]])
    triangles = [piece.triangles + start for piece, start in zip(parts, first, strict=True)]
    mesh = FishMesh(
        np.concatenate([piece.positions for piece in parts]).astype(np.float32),
        np.concatenate([piece.normals for piece in parts]).astype(np.float32),
        np.concatenate([piece.coordinates for piece in parts]).astype(np.float32),
        np.concatenate([piece.parts for piece in parts]),
        np.concatenate([piece.joints for piece in parts]),
        np.concatenate([piece.weights for piece in parts]).astype(np.float32),
        np.concatenate(triangles).astype(np.int32))
    _shared(*mesh)
    return mesh


def _shared(*arrays: NDArray[Any]) -> None:
    """Lock arrays that all who ask are given."""
    for array in arrays:
        array.setflags(write=False)
