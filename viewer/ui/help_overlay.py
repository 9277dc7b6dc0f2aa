"""The keys and what the mouse does, over everything."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import imgui

from viewer.ui import theme
from viewer.ui.actions import ACTIONS, MOUSE
from viewer.ui.typography import FLOATING, heading

if TYPE_CHECKING:
    from viewer.ui.workbench import Workbench

TITLE = "Keys and mouse"
ROOM_FOR_ALL = 30.0
KEY_EMS = 8.5
COLUMN_EMS = 22.0
TWO_COLUMNS_FROM = 48.0


def draw(bench: Workbench) -> None:
    """The overlay, where it is open; a click beside it closes it."""
    if not bench.view.help:
        return
    if not imgui.is_popup_open(TITLE):
        imgui.open_popup(TITLE)
    view, em = imgui.get_main_viewport(), imgui.get_font_size()
    columns = 2 if view.size.x > TWO_COLUMNS_FROM * em else 1
    imgui.set_next_window_pos(view.get_center(), imgui.Cond_.always, imgui.ImVec2(0.5, 0.5))
    most = imgui.ImVec2(max(1.0, view.size.x - em), max(1.0, view.size.y - em))
    imgui.set_next_window_size_constraints(imgui.ImVec2(0, 0), most)
    imgui.push_style_var(imgui.StyleVar_.window_padding, imgui.ImVec2(1.4 * em, 1.1 * em))
    roomy = view.size.y > ROOM_FOR_ALL * em
    flags = FLOATING if roomy else FLOATING & ~imgui.WindowFlags_.no_scrollbar
    if imgui.begin_popup_modal(TITLE, None, flags | imgui.WindowFlags_.always_auto_resize)[0]:
        _columns(bench, columns)
        inside = imgui.is_window_hovered(imgui.HoveredFlags_.root_and_child_windows)
        if imgui.is_mouse_clicked(0) and not inside:
            bench.view.help = False
        imgui.end_popup()
    imgui.pop_style_var()


def _columns(bench: Workbench, columns: int) -> None:
    groups: dict[str, list[tuple[str, str]]] = {"Mouse": list(MOUSE)}
    for action in ACTIONS:
        if action.keys:
            groups.setdefault(action.menu, []).append((action.keys, action.title))
    order = ["Play", "Edit", "Picture", "Help", "View", "Mouse"]
    if imgui.begin_table("columns", columns, imgui.TableFlags_.sizing_fixed_fit | imgui.TableFlags_.no_host_extend_x):
        width = COLUMN_EMS * imgui.get_font_size()
        for index in range(columns):
            imgui.table_setup_column(str(index), imgui.TableColumnFlags_.width_fixed, width)
        imgui.table_next_column()
        for name in order:
            if columns == 2 and name == "View":
                imgui.table_next_column()
            heading(name, bench.session.fonts)
            for keys, title in groups[name]:
                _line(keys, title)
            imgui.dummy(imgui.ImVec2(0, 0.3 * imgui.get_font_size()))
        imgui.end_table()


def _line(keys: str, title: str) -> None:
    start = imgui.get_cursor_pos_x()
    imgui.push_style_color(imgui.Col_.text, theme.ACCENT)
    imgui.text_unformatted(keys)
    imgui.pop_style_color()
    imgui.same_line()
    imgui.set_cursor_pos_x(start + KEY_EMS * imgui.get_font_size())
    imgui.push_text_wrap_pos(start + COLUMN_EMS * imgui.get_font_size())
    imgui.text_unformatted(title)
    imgui.pop_text_wrap_pos()
