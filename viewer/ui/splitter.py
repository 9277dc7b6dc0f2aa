"""The edges between columns and picture, to be dragged; a double click puts one back."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import imgui

from viewer.ui import theme
from viewer.ui.layout import Box
from viewer.ui.typography import FIXED

if TYPE_CHECKING:
    from viewer.ui.workbench import Workbench

THICKNESS_EMS = 0.4
IN_FRONT = (FIXED & ~imgui.WindowFlags_.no_bring_to_front_on_focus) | imgui.WindowFlags_.no_background


def draw(bench: Workbench) -> None:
    """A handle on the inner edge of each column that shows."""
    left, right, em = bench.layout.left, bench.layout.right, imgui.get_font_size()
    if left.shown:
        moved = _handle("left edge", left, left.width)
        if moved is not None:
            bench.view.left_ems = (left.width + moved) / em if moved else None
    if right.shown:
        moved = _handle("right edge", right, right.x)
        if moved is not None:
            bench.view.right_ems = (right.width - moved) / em if moved else None


def _handle(name: str, column: Box, x: float) -> float | None:
    """How far the edge at ``x`` was dragged in this frame; 0 after a double click, None if left alone."""
    thick = THICKNESS_EMS * imgui.get_font_size()
    imgui.set_next_window_pos(imgui.ImVec2(x - thick / 2, column.y))
    imgui.set_next_window_size(imgui.ImVec2(thick, column.height))
    imgui.push_style_var(imgui.StyleVar_.window_padding, imgui.ImVec2(0, 0))
    imgui.push_style_var(imgui.StyleVar_.window_min_size, imgui.ImVec2(1, 1))
    imgui.begin(name, None, IN_FRONT)
    imgui.invisible_button(name, imgui.ImVec2(thick, max(1.0, column.height)))
    hovered, active = imgui.is_item_hovered(), imgui.is_item_active()
    if hovered or active:
        imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
        low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
        color = imgui.color_convert_float4_to_u32(imgui.ImVec4(*theme.ACCENT_DEEP))
        imgui.get_window_draw_list().add_rect_filled(low, high, color)
    imgui.end()
    imgui.pop_style_var(2)
    if hovered and imgui.is_mouse_double_clicked(0):
        return 0.0
    return imgui.get_io().mouse_delta.x or None if active else None
