"""What the hand holds in an editor of handles, kept by ImGui from frame to frame beside the widget."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

from imgui_bundle import imgui

from viewer.kit.srgb import code_of

Place: TypeAlias = tuple[float, float]
Rgb: TypeAlias = tuple[float, float, float]

REACH_EMS = 0.6     # within which a press takes hold of a handle
KEPT = "held", "new", "moved", "start 0", "start 1", "paint 0", "paint 1", "paint 2"
STILL_PIXELS = 3.0  # of travel below which a press is a click


class Grip:
    """The handle under the mouse button, of the widget whose ID stack is current where this is made."""

    def __init__(self) -> None:
        self._storage = imgui.get_state_storage()
        self._keys = {name: imgui.get_id(name) for name in KEPT}

    @property
    def held(self) -> int:
        """The handle's index, or -1."""
        return self._storage.get_int(self._keys["held"], -1)

    @property
    def new(self) -> int:
        """The handle that the last press made, or -1: the second click of two must not take it away again."""
        return self._storage.get_int(self._keys["new"], -1)

    @property
    def moved(self) -> bool:
        """Whether the hand has moved since it took hold."""
        return bool(self._storage.get_int(self._keys["moved"], 0))

    def take(self, index: int, at: Place = (0.0, 0.0), *, new: bool = False) -> None:
        """Take hold of handle ``index``, which stands at ``at`` in the editor's own units; of none by -1."""
        for name, number in (("held", index), ("new", index if new else -1), ("moved", 0)):
            self._storage.set_int(self._keys[name], number)
        self._keep("start", at)

    def dragged(self, scale: Place) -> Place | None:
        """Where the handle is to go, ``scale`` being units for each pixel; None while the hand is still."""
        if not imgui.is_mouse_dragging(0, STILL_PIXELS):
            return None
        self._storage.set_int(self._keys["moved"], 1)
        x, y = self._kept("start", 2)
        gone = imgui.get_mouse_drag_delta(0, STILL_PIXELS)
        return x + scale[0] * gone.x, y + scale[1] * gone.y

    def paint(self, color: Rgb) -> None:
        """Remember the colour that a picker shows, which is finer than eight bits."""
        self._keep("paint", color)

    def paint_for(self, color: Rgb) -> Rgb:
        """The colour that a picker is to show for ``color``: the remembered one, if that means the same."""
        red, green, blue = self._kept("paint", 3)
        return (red, green, blue) if code_of((red, green, blue)) == code_of(color) else color

    def _keep(self, name: str, numbers: Sequence[float]) -> None:
        for index, number in enumerate(numbers):
            self._storage.set_float(self._keys[f"{name} {index}"], number)

    def _kept(self, name: str, count: int) -> list[float]:
        return [self._storage.get_float(self._keys[f"{name} {index}"], 0.0) for index in range(count)]


def nearest(places: Sequence[Place], reach: float) -> int:
    """The one of ``places`` on the screen that the mouse is on, within ``reach`` pixels, or -1."""
    mouse = imgui.get_mouse_pos()
    far = [(x - mouse.x) ** 2 + (y - mouse.y) ** 2 for x, y in places]
    closest = min(far, default=reach * reach)
    return far.index(closest) if closest < reach * reach else -1
