"""The menu bar, made from the table of actions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import imgui

from viewer.ui.actions import ACTIONS, Action
from viewer.ui.layout import SCALES

if TYPE_CHECKING:
    from viewer.ui.workbench import Workbench

MENUS = tuple(dict.fromkeys(action.menu for action in ACTIONS))


def draw(bench: Workbench) -> None:
    """The bar across the top, with the scale of the text at its right end."""
    if not imgui.begin_main_menu_bar():
        return
    for name in MENUS:
        if imgui.begin_menu(name):
            for action in ACTIONS:
                if action.menu == name:
                    _entry(bench, action)
            if name == "View":
                _scale_slider(bench)
            imgui.end_menu()
    imgui.end_main_menu_bar()


def _entry(bench: Workbench, action: Action) -> None:
    enabled = {"Undo": bench.history.can_undo, "Redo": bench.history.can_redo}.get(action.title, True)
    checked = action.checked(bench) if action.checked else False
    if imgui.menu_item(action.title, action.keys, checked, enabled)[0]:
        action.run(bench)


def _scale_slider(bench: Workbench) -> None:
    """Takes effect when let go: text that grows under the mouse would run away from it."""
    imgui.separator()
    imgui.set_next_item_width(9.0 * imgui.get_font_size())
    storage, key = imgui.get_state_storage(), imgui.get_id("scale")
    percent = storage.get_int(key, 0) or round(100 * bench.view.scale)
    low, high = round(100 * SCALES[0]), round(100 * SCALES[-1])
    _, percent = imgui.slider_int("Size of text##scale", percent, low, high, "%d %%")
    storage.set_int(key, percent if imgui.is_item_active() else 0)
    if imgui.is_item_deactivated_after_edit():
        bench.view.scale = max(SCALES[0], min(SCALES[-1], percent / 100.0))
