"""What there is to say of a twisted limb: numbers, and curves with the law drawn over what was measured."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from viewer.engine.annotations import Table
from viewer.engine.limb_skin import LimbSkin
from viewer.engine.scene import Curve
from viewer.kit import limb_measure

TWISTS = np.linspace(-360.0, 360.0, 49)
COLUMNS = ("method", "twist_bones", "min_radius_ratio", "volume_ratio", "area_ratio")


def limb_curves(skin: LimbSkin, local: NDArray[np.float64], degrees: float, marked: float) -> dict[str, Curve]:
    """Both curves of a limb that stands as ``local`` (j, 4, 4), twisted by ``degrees``; ``marked`` is a place on it."""
    return {"radius_along_limb": _radius_along_limb(skin, degrees, marked),
            "radius_vs_twist": _radius_vs_twist(skin, local, degrees)}


def limb_comparison(skins: Sequence[LimbSkin]) -> Table:
    """Ways of skinning side by side, in numbers."""
    rows: list[tuple[float | str, ...]] = []
    for skin in skins:
        found = skin.numbers()
        if found:
            rows.append((skin.method, skin.twist_bones, *(round(ratio, 4) for ratio in (
                found.min_radius_ratio, found.volume_ratio, found.area_ratio))))
    return Table(COLUMNS, rows)


def _radius_along_limb(skin: LimbSkin, degrees: float, marked: float) -> Curve:
    """How thick the limb is along its way, in shares of before, and what the law says for that twist."""
    shared = skin.shared
    assert shared.limb and shared.gauge
    shares = shared.limb.share[shared.limb.measured]
    rigid = skin.method == "dual_quaternion"
    law = np.ones(len(shares)) if rigid else limb_measure.law(shares, degrees, skin.twist_bones)
    places, measured, expected = shared.gauge.along(skin.radius_ratios(), law)
    return Curve("along", places, {"measured": measured, "law": expected}, x_label="place along the limb",
                 y_label="radius, after / before", now=marked, dots=("measured",))


def _radius_vs_twist(skin: LimbSkin, local: NDArray[np.float64], degrees: float) -> Curve:
    """How thin the limb becomes at all twists, as the vertex shader has it and by the law; ``skin`` stays as it was."""
    extra, thinnest = skin.twist_bones, []
    for twist in TWISTS:
        skin.pose(local, float(twist), extra, probes_only=True)
        thinnest.append(skin.thinnest())
    skin.pose(local, degrees, extra)
    rigid = skin.method == "dual_quaternion"
    law = np.ones(len(TWISTS)) if rigid else limb_measure.thinnest_by_law(TWISTS, extra)
    return Curve("twist", TWISTS, {"measured": thinnest, "law": law}, x_label="twist (degrees)",
                 y_label="smallest radius, after / before", now=degrees, dots=("measured",))
