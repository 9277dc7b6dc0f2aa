"""Which joints the vertices of a glTF file follow, and how much each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from viewer.kit.gltf_accessor import FLOAT, SMALL, Accessors
from viewer.kit.gltf_document import Entry
from viewer.kit.skinning import normalise_weights

MOST_INFLUENCES = 8             # of a vertex; the shader has room for no more
FEW_INFLUENCES = 4              # are enough for most files, and one attribute less
MOST_SETS = 4                   # of four influences each that are looked at
VERTICES_AT_ONCE = 2**16


@dataclass(frozen=True, eq=False)
class Influences:
    """``joints`` (n, k) int32 of a skin and ``weights`` (n, k) float32, 0 or more and with the sum 1.

    ``unnormalised`` of the vertices had weights with another sum.
    """

    joints: NDArray[np.int32]
    weights: NDArray[np.float32]
    unnormalised: int


@dataclass
class Faults:
    """How many vertices have weights with another sum than 1, odd ones, none at all; how many joints one follows."""

    unnormalised: int = 0
    odd: int = 0
    empty: int = 0
    most: int = 0


def read_influences(attributes: Entry, accessors: Accessors, count: int, notes: list[str]) -> Influences | None:
    """The joints and weights of ``count`` vertices; None if there are no joints. ``notes`` is told what was changed."""
    joints, weights = _sets(attributes, accessors, count, notes)
    if not joints:
        return None
    width = FEW_INFLUENCES if len(joints) == 1 else MOST_INFLUENCES
    kept, normal = np.empty((count, width), np.int32), np.empty((count, width), np.float32)
    faults = Faults()
    for start in range(0, count, VERTICES_AT_ONCE):
        some = slice(start, start + VERTICES_AT_ONCE)
        kept[some], normal[some] = _heaviest(np.concatenate([one[some] for one in joints], axis=1),
                                             np.concatenate([one[some] for one in weights], axis=1), faults)
    notes += _remarks(attributes.place, faults)
    if faults.most <= FEW_INFLUENCES:
        kept, normal = kept[:, :FEW_INFLUENCES], normal[:, :FEW_INFLUENCES]
    return Influences(kept, normal, faults.unnormalised)


def attribute(attributes: Entry, name: str, accessors: Accessors, count: int) -> int | None:
    """The accessor of an attribute, which must have ``count`` elements; None if there is none."""
    number = attributes.index(name, "accessors")
    if number is not None and accessors.count(number) != count:
        attributes.document.refuse(f"{attributes.named(name)} has {accessors.count(number):,} elements; "
                                   f"{count:,} are needed, as many as there are positions")
    return number


def _sets(attributes: Entry, accessors: Accessors, count: int,
          notes: list[str]) -> tuple[list[NDArray[Any]], list[NDArray[np.float32]]]:
    """JOINTS_0, JOINTS_1 and so on, and the weights for each of them; zeros if there are no weights at all."""
    joints: list[NDArray[Any]] = []
    weights: list[NDArray[np.float32]] = []
    while True:
        number = len(joints)
        who, how_much = (attribute(attributes, f"{name}_{number}", accessors, count) for name in ("JOINTS", "WEIGHTS"))
        if who is None and how_much is None:
            return joints, weights
        if number == MOST_SETS:
            notes.append(f"{attributes.place} has more than {4 * MOST_SETS} joints for each vertex; "
                         "those beyond are left out.")
            return joints, weights
        if who is None or (how_much is None and number):
            missing, present = ("joints", "weights") if who is None else ("weights", "joints")
            notes.append(f"{attributes.place} has {present} number {number} without {missing}; they are left out.")
            return joints, weights
        joints.append(accessors.unsigned(who, "VEC4", count, SMALL))
        if how_much is None:
            notes.append(f"{attributes.place} has joints without weights.")
            return joints, [np.zeros((count, 4), np.float32)]
        weights.append(accessors.floats(how_much, "VEC4", count, {**FLOAT, **SMALL}, finite=False))


def _heaviest(joints: NDArray[Any], weights: NDArray[np.float32],
              faults: Faults) -> tuple[NDArray[Any], NDArray[np.float32]]:
    """The joints (n, k) of some vertices and their weights, normalised: all of four, else the eight heaviest."""
    positive = weights > 0.0
    faults.odd += int((~(positive | (weights == 0.0)) | np.isinf(weights)).any(axis=1).sum())
    faults.empty += int((~positive).all(axis=1).sum())
    normal, wrong = normalise_weights(weights)
    faults.unnormalised += wrong
    faults.most = max(faults.most, int((normal > 0.0).sum(axis=1).max()))
    if weights.shape[1] <= FEW_INFLUENCES:
        return joints, normal
    order = np.argsort(-normal, axis=1, kind="stable")[:, :MOST_INFLUENCES]
    normal, _ = normalise_weights(np.take_along_axis(normal, order, axis=1))
    return np.take_along_axis(joints, order, axis=1), normal


def _remarks(place: str, faults: Faults) -> list[str]:
    remarks = []
    if faults.odd:
        remarks.append(f"{place} has {faults.odd:,} vertices with weights that are negative or no numbers, "
                       "which count as 0.")
    if faults.empty:
        remarks.append(f"{place} has {faults.empty:,} vertices without any weight, which follow their first joint.")
    if faults.most > MOST_INFLUENCES:
        remarks.append(f"{place} has vertices that follow {faults.most} joints; the {MOST_INFLUENCES} heaviest "
                       "are kept.")
    return remarks
