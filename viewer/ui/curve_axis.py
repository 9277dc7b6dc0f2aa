"""Where a curve lies on the screen, and how much of its range the axis shows: enough for the curve to be seen."""

from __future__ import annotations

from dataclasses import dataclass

from imgui_bundle import imgui

from viewer.engine.life_fields import LifeCurveField
from viewer.kit.life_curve import LifeCurve
from viewer.ui.grip import Place

PARTS = 0.25, 0.5, 0.75, 1.0    # of the range that the axis may show; it shows the least that holds the curve
HEADROOM = 1.05                 # the axis goes at least so many times as high as the curve


@dataclass(frozen=True)
class Plot:
    """Where the axes of a curve, 0 to 1 across and ``minimum`` to ``maximum`` up, lie on the screen."""

    left: float
    top: float
    width: float
    height: float
    minimum: float
    maximum: float

    @property
    def units(self) -> Place:
        """What a pixel to the right and one downwards are worth."""
        return 1.0 / self.width, (self.minimum - self.maximum) / self.height

    def place(self, x: float, y: float) -> Place:
        """A point of the curve on the screen."""
        share = (self.maximum - y) / (self.maximum - self.minimum)
        return self.left + x * self.width, self.top + share * self.height

    def point(self, mouse: imgui.ImVec2) -> Place:
        """The point between the axes under the mouse, or the one nearest to it."""
        across, down = self.units
        x, y = across * (mouse.x - self.left), self.maximum + down * (mouse.y - self.top)
        return min(1.0, max(0.0, x)), min(self.maximum, max(self.minimum, y))


def possible_tops(field: LifeCurveField) -> list[float]:
    """What the axis may end with above: only the limit where the range goes below zero."""
    if field.minimum < 0.0:
        return [field.maximum]
    parts = (field.minimum + part * (field.maximum - field.minimum) for part in PARTS[:-1])
    return [*parts, field.maximum]


def fitted_top(field: LifeCurveField, value: LifeCurve) -> float:
    """The least of ``possible_tops`` that leaves some room above the curve, or the limit."""
    return next((top for top in possible_tops(field) if HEADROOM * greatest(value) <= top), field.maximum)


def held_top(field: LifeCurveField, value: LifeCurve, *, hovered: bool, active: bool) -> float:
    """As ``fitted_top``, but as it was while the hand is over the plot or drags, lest it run away under the hand.

    ImGui keeps it, for the widget whose ID stack is current.
    """
    storage, key, tops = imgui.get_state_storage(), imgui.get_id("top"), possible_tops(field)
    index = storage.get_int(key, -1)
    if 0 <= index < len(tops) and (active or (hovered and greatest(value) <= tops[index])):
        return tops[index]
    fitted = fitted_top(field, value)
    storage.set_int(key, tops.index(fitted))
    return fitted


def greatest(value: LifeCurve) -> float:
    """The largest value of a curve, which never goes beyond its points."""
    return max(y for _, y in value.points)
