"""Bones as rods and balls: the skeleton of a posed limb, with the bones that share its twist."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from viewer.kit.limb import Limb
from viewer.kit.models import Model, rgb
from viewer.kit.rig import RiggedMesh

BONE, CHOSEN, EXTRA = rgb("#f4f1ea"), rgb("#e69f00"), rgb("#56b4e9")
RADIUS = 0.02           # of a joint's ball, in the world


def bone_model(mesh: RiggedMesh, places: NDArray[np.float64], chosen: int, limb: Limb | None,
               twist_bones: int) -> Model:
    """Rods from joint to joint and balls on them, at ``places`` (b, 3) in the world; the limb's end in orange."""
    model, parents = Model(), mesh.bone_parents
    children = np.nonzero(parents >= 0)[0]
    plain = children[children != chosen]
    model.rods(places[parents[plain]], places[plain], 0.5 * RADIUS, BONE)
    model.balls(np.delete(places, chosen, axis=0), RADIUS, BONE)
    if parents[chosen] >= 0:
        model.rods(places[[parents[chosen]]], places[[chosen]], 0.5 * RADIUS, CHOSEN)
    if limb and twist_bones:
        parts = (np.arange(1, twist_bones + 1) / (twist_bones + 1))[:, None]
        model.balls(places[limb.upper] + parts * (places[limb.lower] - places[limb.upper]), RADIUS, EXTRA)
    model.balls(places[[chosen]], 1.25 * RADIUS, CHOSEN)
    return model
