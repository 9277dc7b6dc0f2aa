"""What moves particles: gravity, wind, attractors, a vortex and turbulence."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from viewer.engine.declarations import choice, slider
from viewer.engine.params import Parameters
from viewer.engine.program import Program
from viewer.kit.curl_noise import curl_noise

ATTRACTORS = {
    "none": "Nothing attracts", "point": "Towards a point, as gravity towards a planet: the inverse square",
    "line": "Towards a vertical line: the inverse of the distance"}


class ForceParameters(Parameters):
    """The forces that an artist plays with."""

    gravity: float = slider(9.81, -50.0, 50.0, "Downward acceleration; negative lets things rise", unit="m/s²",
                            group="Forces", handy=(-5.0, 15.0))
    wind: float = slider(0.0, 0.0, 50.0, "Speed of the air; it moves what has drag", unit="m/s", group="Forces",
                         handy=(0.0, 10.0))
    wind_heading: float = slider(0.0, -180.0, 180.0, "Where the wind blows to: 0 along x, 90 towards the back",
                                 unit="degrees", group="Forces")
    gusts: float = slider(0.0, 0.0, 1.0, "How much the wind comes and goes", group="Forces")
    turbulence: float = slider(0.0, 0.0, 100.0, "Force of swirling air without sources or sinks", unit="N",
                               group="Forces", handy=(0.0, 10.0))
    turbulence_size: float = slider(1.0, 0.05, 20.0, "Width of the swirls", unit="m", logarithmic=True,
                                    group="Forces")
    turbulence_pace: float = slider(0.5, 0.0, 10.0, "How fast the swirls drift through space, in widths a second",
                                    group="Forces")
    attractor: str = choice("none", ATTRACTORS, "What attracts", group="Forces")
    attraction: float = slider(5.0, -200.0, 200.0, "Acceleration at one metre; negative repels", unit="m/s²",
                               group="Forces", handy=(-20.0, 20.0), when="attractor!=none")
    vortex: float = slider(0.0, -100.0, 100.0, "Acceleration around the vertical through the attractor's place",
                           unit="m/s²", group="Forces", handy=(-20.0, 20.0))
    attractor_core: float = slider(0.3, 0.01, 20.0, "Distance within which attraction and vortex soften", unit="m",
                                   logarithmic=True, group="Forces")
    attractor_x: float = slider(0.0, -50.0, 50.0, "Place of attractor and vortex", unit="m", group="Forces",
                                handy=(-5.0, 5.0))
    attractor_y: float = slider(1.5, -50.0, 50.0, "Place of attractor and vortex", unit="m", group="Forces",
                                handy=(-5.0, 5.0))
    attractor_z: float = slider(0.0, -50.0, 50.0, "Place of attractor and vortex", unit="m", group="Forces",
                                handy=(-5.0, 5.0))


class Forces:
    """Tells the step shader which forces there are, and how strong."""

    def __init__(self, params: ForceParameters) -> None:
        self.params = params

    def constants(self) -> str:
        """The include ``generated/forces.glsl``: what is not there is not even compiled."""
        params = self.params
        flags = {
            "HAS_DRAG": self.has_drag, "HAS_WIND": self.has_drag and params.wind > 0.0,
            "HAS_GUSTS": params.gusts > 0.0, "HAS_TURBULENCE": params.turbulence > 0.0,
            "HAS_VORTEX": params.vortex != 0.0, "FORCES_VARY": self.vary}
        lines = [f"const bool {name} = {str(bool(value)).lower()};" for name, value in flags.items()]
        names = [f"ATTRACTOR_{name.upper()} = {index}" for index, name in enumerate(ATTRACTORS)]
        chosen = list(ATTRACTORS).index(params.attractor)
        return "\n".join([*lines, f"const int {', '.join(names)}, ATTRACTOR = {chosen};", ""])

    @property
    def has_drag(self) -> bool:
        """Whether the air slows anything."""
        return bool(self.params.get("drag")[1] > 0.0)

    @property
    def vary(self) -> bool:
        """Whether any force depends on the place."""
        params = self.params
        return bool(params.attractor != "none" or params.vortex or params.turbulence
                    or (params.gusts and params.wind))

    def apply(self, program: Program, seconds: float) -> None:
        """Set what follows from the parameters but is none of them; ``seconds`` is the middle of the step."""
        program["u_time"] = seconds
        program["u_wind_velocity"] = tuple(self.wind_velocity)
        program["u_attractor_place"] = tuple(self.attractor_place)

    @property
    def wind_velocity(self) -> NDArray[np.float64]:
        """How the air moves, (3,), in m/s."""
        heading = math.radians(self.params.wind_heading)
        return self.params.wind * np.array([math.cos(heading), 0.0, -math.sin(heading)])

    @property
    def attractor_place(self) -> NDArray[np.float64]:
        """Where the attractor and the vortex are, (3,), in metres."""
        return np.array([self.params.attractor_x, self.params.attractor_y, self.params.attractor_z])

    def on_particle(self, place: NDArray[np.float64], velocity: NDArray[np.float64], mass: float, drag: float,
                    seconds: float) -> dict[str, NDArray[np.float64]]:
        """Each force on one particle by name, (3,) in newtons, as the step shader reckons them."""
        params, forces = self.params, {"gravity": np.array([0.0, -self.params.gravity * mass, 0.0])}
        away = place - self.attractor_place
        core = params.attractor_core**2
        if params.attractor == "point":
            forces["attraction"] = -params.attraction * mass * away / (away @ away + core)**1.5
        if params.attractor == "line":
            across = away * [1.0, 0.0, 1.0]
            forces["attraction"] = -params.attraction * mass * across / (across @ across + core)
        if params.vortex:
            around = np.array([away[2], 0.0, -away[0]])
            forces["vortex"] = 2.0 * params.vortex * params.attractor_core * mass * around / (around @ around + core)
        if params.turbulence:
            drift = params.turbulence_pace * seconds * np.array([0.31, 0.83, -0.46])
            forces["turbulence"] = params.turbulence * curl_noise([place / params.turbulence_size + drift])[0]
        if drag:
            forces["air"] = drag * (self._air_velocity(place, seconds) - velocity)
        return forces

    def _air_velocity(self, place: NDArray[np.float64], seconds: float) -> NDArray[np.float64]:
        """Wind with its gusts, as ``gust`` in particles/forces.glsl has it."""
        wind, speed = self.wind_velocity, self.params.wind
        along = place @ wind / max(speed, 1e-6) - speed * seconds
        waves = 0.6 * math.sin(1.1 * along + 0.7 * place[2]) + 0.4 * math.sin(2.7 * along - 1.3 * place[0] + 1.9)
        return np.asarray(wind * (1.0 + self.params.gusts * waves))

    def potential_energy(self, place: NDArray[np.float64], mass: NDArray[np.float64]) -> NDArray[np.float64]:
        """Of gravity, counted from y = 0, and of the attractor, counted from afar or from one metre: (n,) in joules."""
        params = self.params
        height: NDArray[np.float64] = params.gravity * place[:, 1]
        if params.attractor == "none":
            return mass * height
        away = place - self.attractor_place
        if params.attractor == "line":
            squared = away[:, 0]**2 + away[:, 2]**2 + params.attractor_core**2
            height += 0.5 * params.attraction * np.log(squared)
        else:
            height -= params.attraction / np.sqrt((away**2).sum(axis=1) + params.attractor_core**2)
        return mass * height

    def greatest_acceleration(self) -> float:
        """No force accelerates the lightest particle more than this, in m/s²."""
        params = self.params
        core = params.attractor_core
        pull = {"none": 0.0, "point": 0.385 / core**2, "line": 0.5 / core}[params.attractor] * abs(params.attraction)
        rough = 5.0 * params.turbulence / params.get("mass")[0]
        blown = params.get("drag")[1] / params.get("mass")[0] * params.wind * (1.0 + params.gusts)
        return float(abs(params.gravity) + pull + abs(params.vortex) + rough + blown)
