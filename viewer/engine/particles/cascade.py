"""Particles that come from particles: during their life, where they strike, and when they die."""

from __future__ import annotations

from typing import Any

from viewer.engine.declarations import choice, gradient, interval, slider
from viewer.engine.params import Parameters

GENERATIONS = 4
MOMENTS = {
    "never": "They have none", "life": "All through life: so many each second",
    "collision": "Each time it strikes something: so many at once", "death": "When it dies: so many at once"}
FAMILIES = ("children", "grandchildren", "great_grandchildren")
Range = tuple[float, float]


def _family(name: str, parents: str, moment: str, number: Range, lifetime: Range, speed: Range, size: Range,
            spread: float) -> dict[str, Any]:
    """The declarations of one generation's parameters, by name; ``parents`` is what the one before is called."""
    group = name.replace("_", "-").capitalize()
    where: dict[str, Any] = {"group": group, "when": f"{name}_when!=never"}
    own = {
        "when": choice(moment, MOMENTS, f"When a particle of the {parents} generation gives rise to others",
                       group=group),
        "": interval(number, 0.0, 4000.0, "How many: each second, or at once", handy=(0.0, 200.0), **where),
        "lifetime": interval(lifetime, 0.02, 600.0, "How long they live", unit="s", handy=(0.02, 5.0), **where),
        "speed": interval(speed, 0.0, 200.0, "How fast they are sent off", unit="m/s", handy=(0.0, 10.0), **where),
        "spread": slider(spread, 0.0, 180.0, "Largest angle to the parent's way, or to the normal of what it struck",
                         unit="degrees", **where),
        "inherit": slider(0.15, 0.0, 1.0, "Part of the parent's velocity that they keep", **where),
        "size": interval(size, 1e-4, 20.0, "Their diameter", unit="m", logarithmic=True, **where),
        "color": gradient("0:#ffffff, 1:#9fd0ff", "Their colour over life", **where)}
    return {f"{name}_{quality}".rstrip("_"): declared for quality, declared in own.items()}


class CascadeParameters(Parameters):
    """Three generations of children; each inherits part of its parent's velocity."""

    locals().update(_family("children", "first", "collision", (1.0, 3.0), (0.25, 0.6), (0.6, 1.8), (0.006, 0.014),
                            70.0))
    locals().update(_family("grandchildren", "second", "never", (2.0, 4.0), (0.3, 0.6), (0.5, 1.0), (0.006, 0.012),
                            180.0))
    locals().update(_family("great_grandchildren", "third", "never", (2.0, 4.0), (0.2, 0.4), (0.3, 0.8),
                            (0.004, 0.008), 180.0))


def moments(params: CascadeParameters) -> list[str]:
    """When each generation has children; ``never`` too where their number is zero or no parents are born."""
    found, born = [], True
    for family in FAMILIES:
        when = params.get(f"{family}_when") if params.get(family)[1] > 0.0 else "never"
        born = born and when != "never"
        found.append(when if born else "never")
    return found


def cascade_constants(params: CascadeParameters) -> str:
    """The include ``generated/cascade.glsl``."""
    chosen = zip(FAMILIES, moments(params), strict=True)
    lines = [f"const int {family.upper()}_WHEN = {list(MOMENTS).index(when)};" for family, when in chosen]
    return "\n".join([*lines, ""])


def has_children(params: CascadeParameters) -> bool:
    """Whether any particle comes from another."""
    return moments(params)[0] != "never"
