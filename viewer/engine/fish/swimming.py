"""How a fish swims: what an artist sets of it, the beat that goes on, and what the shaders get to know."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from viewer.engine.declarations import slider, toggle
from viewer.engine.fish.fins import fin_pose
from viewer.engine.params import Parameters
from viewer.engine.program import Program
from viewer.kit.rig import Skeleton
from viewer.kit.swim import Swim

GROUP = "Swimming"
FULL_TURN = 2.0 * math.pi


class SwimParameters(Parameters):
    """How the body moves. Each part of the motion can be switched on alone."""

    tail_beat_hz: float = slider(1.8, 0.0, 15.0, "Beats of the tail each second; in a school, at the cruising speed",
                                 unit="Hz", handy=(0.0, 6.0), group=GROUP)
    turn: float = slider(0.0, -120.0, 120.0, "Angle between tail and nose, a steady bend, positive to the left; a "
                         "school swims along such bends", unit="degrees", group=GROUP)
    wave: bool = toggle(True, "The travelling wave: a sideways swing that grows from head to tail", group=GROUP)
    amplitude: float = slider(0.1, 0.0, 0.25, "How far the tail swings to either side", unit="body lengths",
                              group=GROUP, when="wave")
    wavelength: float = slider(1.0, 0.6, 3.0, "Length of the wave, of the twist's too", unit="body lengths",
                               group=GROUP)
    stiffness: float = slider(0.6, 0.0, 1.0, "0 an eel, whose whole body undulates, to 1 a tuna, which moves but its "
                              "tail; shapes the twist too", group=GROUP)
    side_to_side: bool = toggle(False, "The whole body moves from side to side", group=GROUP)
    sway: float = slider(0.06, 0.0, 0.25, "How far to either side", unit="body lengths", group=GROUP,
                         when="side_to_side")
    yaw: bool = toggle(False, "The whole body turns about the vertical", group=GROUP)
    yaw_angle: float = slider(10.0, 0.0, 45.0, "How far to either side", unit="degrees", group=GROUP, when="yaw")
    roll: bool = toggle(False, "The whole body turns about its own length", group=GROUP)
    roll_angle: float = slider(12.0, 0.0, 60.0, "How far to either side", unit="degrees", group=GROUP, when="roll")
    twist: bool = toggle(True, "A roll that runs along the body as the wave does", group=GROUP)
    twist_angle: float = slider(6.0, 0.0, 60.0, "How far the tail turns to either side", unit="degrees",
                                group=GROUP, when="twist")


@dataclass(frozen=True)
class SwimmingSnapshot:
    """Where in its beat a fish is: phases in radians."""

    phase: float
    fin_phase: float
    nbytes: int = 16


class Swimming:
    """The hero's beat. Its phases are integrated, so that another frequency changes the pace and never jumps."""

    def __init__(self, params: Any) -> None:
        self.params = params
        self.phase = 0.0
        self.fin_phase = 0.0

    @property
    def swim(self) -> Swim:
        """The way of swimming that the parameters ask for; parts that are switched off are 0."""
        p = self.params
        return Swim(amplitude=p.wave * p.amplitude, wavelength=p.wavelength, stiffness=p.stiffness,
                    sway=p.side_to_side * p.sway, yaw=p.yaw * math.radians(p.yaw_angle),
                    roll=p.roll * math.radians(p.roll_angle), twist=p.twist * math.radians(p.twist_angle))

    def advance(self, dt: float) -> None:
        """Go on by ``dt`` seconds at the frequencies that now are."""
        self.phase += FULL_TURN * self.params.tail_beat_hz * dt
        self.fin_phase += FULL_TURN * self.params.fin_beat_hz * dt

    def snapshot(self) -> SwimmingSnapshot:
        """All that the future follows from."""
        return SwimmingSnapshot(self.phase, self.fin_phase)

    def restore(self, snapshot: SwimmingSnapshot) -> None:
        """Go back to a moment."""
        self.phase, self.fin_phase = snapshot.phase, snapshot.fin_phase

    def fin_pose(self, skeleton: Skeleton) -> NDArray[np.float64]:
        """Each joint of the hero's fins in its parent's frame, (j, 4, 4)."""
        return fin_pose(skeleton, self.phase, math.radians(self.params.turn), self.params, self.fin_phase)

    def tell(self, program: Program) -> None:
        """Give a program that includes ``fish/swim.glsl`` what it asks for, and ``u_phase`` of the hero."""
        swim = self.swim
        program["u_phase"] = self.phase % FULL_TURN
        program["u_swim_amplitude"] = swim.reach
        program["u_swim_wave_number"] = swim.wave_number
        program["u_swim_envelope"] = tuple(swim.envelope.tolist())
        program["u_swim_sway"], program["u_swim_yaw"] = swim.sway, swim.yaw
        program["u_swim_roll"], program["u_swim_twist"] = swim.roll, swim.twist

    def remarks(self) -> Sequence[str]:
        """What the parameters ask for and cannot have any effect."""
        p, swim, found = self.params, self.swim, []
        if swim.reach < swim.amplitude:
            found.append(f"The tail swings {swim.reach:.3f} of the amplitude's {swim.amplitude:.3f} body lengths: a "
                         f"wave of {swim.wavelength:g} cannot swing wider without stretching the body")
        if not (p.wave or p.twist):
            found.append("Nothing runs along the body: wave and twist are off, wavelength and stiffness shape nothing")
        return found
