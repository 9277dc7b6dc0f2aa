"""What an artist sets of a school: how many there are, the rules they follow, and how much water they have."""

from __future__ import annotations

from viewer.engine.declarations import integer, interval, slider
from viewer.engine.params import Parameters

GROUP = "School"


class SchoolParameters(Parameters):
    """Reynolds' three rules, and what limits a fish that follows them."""

    school: int = integer(1, 1, 10000, "How many fish; 1 is the hero alone", logarithmic=True, rebuild=True,
                          group=GROUP)
    fish_size: tuple[float, float] = interval((0.8, 1.1), 0.2, 2.0, "Length of each fish", unit="m", rebuild=True,
                                              group=GROUP)
    school_room: float = slider(4.0, 1.0, 200.0, "Water for each fish: how large an ellipsoid they all stay in",
                                unit="m³", logarithmic=True, rebuild=True, group=GROUP)
    separation: float = slider(1.0, 0.0, 4.0, "How strongly fish that are too near turn away from each other",
                               group=GROUP)
    alignment: float = slider(1.0, 0.0, 4.0, "How strongly a fish swims as its neighbours do", group=GROUP)
    cohesion: float = slider(1.0, 0.0, 4.0, "How strongly a fish seeks the middle of its neighbours", group=GROUP)
    perception: float = slider(1.3, 0.5, 5.0, "How far a fish sees its neighbours", unit="m", group=GROUP)
    personal_space: float = slider(0.9, 0.1, 1.0, "Nearer than this part of that is too near", group=GROUP)
    wander: float = slider(0.3, 0.0, 4.0, "How much each fish has a will of its own", unit="m/s²", group=GROUP)
    speed: tuple[float, float] = interval((0.8, 1.8), 0.05, 10.0, "Slowest and fastest; the middle is the cruising "
                                          "speed", unit="m/s", group=GROUP, handy=(0.1, 5.0))
    agility: float = slider(3.0, 0.1, 20.0, "The greatest acceleration, and so the tightest turn", unit="m/s²",
                            group=GROUP)
    steepest_climb: float = slider(30.0, 1.0, 75.0, "How steeply fish swim up or down", unit="degrees", group=GROUP)
    bank: float = slider(25.0, 0.0, 60.0, "How far a fish leans into a turn", unit="degrees", group=GROUP)
