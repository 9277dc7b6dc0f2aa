"""How the fins move: small joints that scull, steer and fan, by the fish's own beat."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from viewer.engine.declarations import choice, slider
from viewer.engine.params import Parameters
from viewer.kit import quaternion
from viewer.kit.fish_pieces import SIDES
from viewer.kit.rig import Skeleton

GROUP = "Fins"
FULL_BEND = math.radians(60.0)      # of the body, at which the fins steer as far as they do
STEERING_SPREAD = 30.0              # degrees that the inner pectoral fin then stands off
STEERING_BANK = 20.0                # degrees that both then turn about their length, one up and one down
TIP_LAG = 1.0                       # radians of the beat that a fin's tip comes after its root
TIP_SHARE = 0.6                     # of the stroke that its tip makes once more
PELVIC_SHARE = 0.4                  # of the pectorals' stroke and spread that the pelvic fins make
PELVIC_LAG = 0.8                    # radians of the beat


class FinParameters(Parameters):
    """How the limbs move: the pectoral and the pelvic fins, and the two lobes of the tail, alike in all of a school."""

    fin_beat_hz: float = slider(1.2, 0.0, 15.0, "Strokes of the pectoral fins each second, for a whole school at "
                                "once", unit="Hz", handy=(0.0, 6.0), group=GROUP)
    fin_stroke: float = slider(22.0, 0.0, 80.0, "How far a stroke of the pectoral fins goes to either side",
                               unit="degrees", group=GROUP)
    fin_feather: float = slider(18.0, 0.0, 80.0, "How far the pectoral fins turn about their own length in a stroke",
                                unit="degrees", group=GROUP)
    fin_rhythm: str = choice("together", {
        "together": "Left and right at once, as one who rows", "in_turn": "Left and right in turn, as one who paddles"},
        "How the pectoral fins keep time", group=GROUP)
    fin_spread: float = slider(0.0, -40.0, 60.0, "How far all paired fins stand off the body, from where they rest",
                               unit="degrees", group=GROUP)
    fin_steer: float = slider(1.0, 0.0, 2.0, "How much the pectoral fins spread and bank in a turn; all of a "
                              "school do so by `turn`, not by their own", group=GROUP)
    tail_fan: float = slider(8.0, 0.0, 40.0, "How far the lobes of the tail open and close with each beat",
                             unit="degrees", group=GROUP)
    tail_lag: float = slider(14.0, 0.0, 60.0, "How far the lobes of the tail stay behind its stalk", unit="degrees",
                             group=GROUP)
    fin_twist: float = slider(0.0, -360.0, 360.0, "Turn of the pectoral fins' tips about their own length",
                              unit="degrees", group=GROUP)
    fin_method: str = choice("linear", {
        "linear": "Linear blend skinning: matrices are blended, and a twist collapses",
        "dual_quaternion": "Dual quaternions: motions are blended, and a twist keeps its width"},
        "How the skin of the fins follows their joints", group=GROUP)


def fin_pose(skeleton: Skeleton, phase: float, turn: float, params: Any, fin_phase: float) -> NDArray[np.float64]:
    """Each joint of a fish's ``skeleton`` in its parent's frame, (j, 4, 4).

    ``phase`` is that of the tail's beat and ``fin_phase`` that of the pectoral fins', in radians; ``turn`` is the
    bend of the body in radians, positive to the left. Joints whose names are not those of ``viewer.kit.fish`` stay at
    rest.
    """
    turns = dict.fromkeys(skeleton.names, quaternion.IDENTITY)
    outward = _outward(skeleton)
    for side in SIDES:
        turns |= _pectoral(side, outward.get(f"{side} pectoral", 1.0), turn, params, fin_phase)
        turns |= _pelvic(side, outward.get(f"{side} pelvic", 1.0), params, fin_phase)
    turns |= _tail(phase - 2.0 * math.pi / params.wavelength, params)
    turned = np.array([turns[name] for name in skeleton.names])
    return skeleton.local(rotations=quaternion.multiply(skeleton.rotations, turned))


def _pectoral(side: str, outward: float, turn: float, params: Any, phase: float) -> dict[str, quaternion.Numbers]:
    """How a pectoral fin and its tip are turned from rest: it rows out and in, and its blade turns a quarter later."""
    inner = -params.fin_steer * SIDES[side] * max(-1.0, min(1.0, turn / FULL_BEND))
    phase += math.pi if side == "right" and params.fin_rhythm == "in_turn" else 0.0
    spread = params.fin_spread + STEERING_SPREAD * max(0.0, inner) + params.fin_stroke * math.sin(phase)
    feather = params.fin_feather * math.cos(phase) + STEERING_BANK * inner
    bent = TIP_SHARE * params.fin_stroke * math.sin(phase - TIP_LAG)
    mirrored = SIDES[side]
    return {f"{side} pectoral": _turned((mirrored * feather, outward * spread, 0.0)),
            f"{side} pectoral tip": _turned((mirrored * params.fin_twist, outward * bent, 0.0))}


def _pelvic(side: str, outward: float, params: Any, phase: float) -> dict[str, quaternion.Numbers]:
    """How a pelvic fin is turned: along with the pectoral fins, less and later."""
    spread = PELVIC_SHARE * (params.fin_spread + params.fin_stroke * math.sin(phase - PELVIC_LAG))
    return {f"{side} pelvic": _turned((0.0, outward * spread, 0.0))}


def _tail(phase: float, params: Any) -> dict[str, quaternion.Numbers]:
    """How the tail's lobes are turned: against the way that the stalk goes, and apart where it is fastest."""
    lag = -params.wave * params.tail_lag * math.cos(phase)
    fan = params.tail_fan * math.cos(2.0 * phase)
    return {"tail upper": _turned((0.0, lag, fan)), "tail lower": _turned((0.0, lag, -fan))}


@lru_cache(maxsize=16)
def _outward(skeleton: Skeleton) -> dict[str, float]:
    """The sign, by joint of a side, of a turn about its y axis that leads its tip away from the fish's middle plane."""
    across = skeleton.world()[:, 2, 2]      # how far each z axis points to the fish's right
    return {name: math.copysign(1.0, -SIDES[side] * across[joint]) for joint, name in enumerate(skeleton.names)
            if (side := name.split()[0]) in SIDES}


def _turned(degrees: tuple[float, float, float]) -> quaternion.Numbers:
    """A turn about x, after that about y, and after that about z, of the joint at rest."""
    x, y, z = (quaternion.from_axis_angle(axis, math.radians(angle))
               for axis, angle in zip(np.eye(3), degrees, strict=True))
    return quaternion.multiply(z, quaternion.multiply(y, x))
