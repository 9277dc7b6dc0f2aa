"""What went wrong, over the picture; and short notes that pass."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import imgui

from viewer.ui import theme
from viewer.ui.live_stage import Problem
from viewer.ui.typography import FLOATING, icon_button

if TYPE_CHECKING:
    from viewer.ui.workbench import Workbench


def draw(bench: Workbench) -> None:
    """The banners at the top of the picture, the toast at its bottom."""
    box, em = bench.layout.picture, imgui.get_font_size()
    top = box.y + 0.6 * em
    problem = bench.live.problem if bench.live else None
    if problem:
        top = _banner("problem", problem, bench, top, False)
    if bench.notice and _banner("notice", bench.notice, bench, top, True) < 0.0:
        bench.notice = None
    if bench.toast:
        _toast(bench)
    elif not bench.live and not bench.notice:
        _hint(bench)


def _banner(name: str, problem: Problem, bench: Workbench, top: float, dismissable: bool) -> float:
    """Draws one banner; returns where the next may begin, or -1 when it was dismissed."""
    box, em = bench.layout.picture, imgui.get_font_size()
    width = max(1.0, min(box.width - 1.2 * em, 46.0 * em))
    imgui.set_next_window_pos(imgui.ImVec2(box.x + (box.width - width) / 2, top))
    imgui.set_next_window_size(imgui.ImVec2(width, 0))
    imgui.push_style_color(imgui.Col_.window_bg, theme.WARNING_DEEP)
    imgui.begin(name, None, FLOATING)
    dismissed = False
    if dismissable:
        imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + imgui.get_content_region_avail().x - 1.6 * em)
        start = imgui.get_cursor_pos_y()
        dismissed = icon_button(theme.Icon.CLOSE, "dismiss", "Dismiss (Esc)")
        imgui.set_cursor_pos_y(start)
    _problem_text(problem, bench, imgui.get_content_region_avail().x - (2.2 * em if dismissable else 0.0))
    bottom = imgui.get_window_pos().y + imgui.get_window_size().y
    imgui.end()
    imgui.pop_style_color()
    return -1.0 if dismissed else bottom + 0.4 * em


def _problem_text(problem: Problem, bench: Workbench, width: float) -> None:
    where = f"{problem.place}, line {problem.line}" if problem.line else problem.place
    imgui.push_text_wrap_pos(imgui.get_cursor_pos_x() + width)
    if where:
        imgui.push_font(bench.session.fonts.bold, 0.0)
        imgui.text_unformatted(f"{theme.Icon.WARNING}  {where}")
        imgui.pop_font()
        imgui.text_unformatted(problem.text)
    else:
        imgui.text_unformatted(f"{theme.Icon.WARNING}  {problem.text}")
    imgui.pop_text_wrap_pos()
    if problem.source:
        imgui.push_font(bench.session.fonts.code, 0.0)
        imgui.push_style_color(imgui.Col_.text, theme.WARNING)
        imgui.text_unformatted(problem.source)
        imgui.pop_style_color()
        imgui.pop_font()


def _toast(bench: Workbench) -> None:
    box, em = bench.layout.picture, imgui.get_font_size()
    imgui.set_next_window_pos(imgui.ImVec2(box.x + box.width / 2, box.y + box.height - 0.8 * em), imgui.Cond_.always,
                              imgui.ImVec2(0.5, 1.0))
    imgui.set_next_window_bg_alpha(0.9)
    imgui.begin("toast", None, FLOATING | imgui.WindowFlags_.always_auto_resize | imgui.WindowFlags_.no_inputs)
    imgui.text_unformatted(bench.toast)
    imgui.end()


def _hint(bench: Workbench) -> None:
    box = bench.layout.picture
    imgui.set_next_window_pos(imgui.ImVec2(box.x + box.width / 2, box.y + box.height / 2), imgui.Cond_.always,
                              imgui.ImVec2(0.5, 0.5))
    imgui.set_next_window_bg_alpha(0.0)
    imgui.begin("hint", None, FLOATING | imgui.WindowFlags_.always_auto_resize | imgui.WindowFlags_.no_inputs)
    imgui.text_disabled("Choose a scene")
    imgui.end()
