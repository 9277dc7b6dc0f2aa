"""The panels: which there are, in which windows they stand, and what each window holds."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from viewer.ui import help_overlay, menu, message, splitter
from viewer.ui.code_panel import CodePanel
from viewer.ui.guard import guarded
from viewer.ui.layout import Box
from viewer.ui.lesson_panel import LessonPanel
from viewer.ui.measurement_panel import MeasurementPanel
from viewer.ui.parameter_panel import ParameterPanel
from viewer.ui.performance_panel import PerformancePanel
from viewer.ui.preset_panel import PresetPanel
from viewer.ui.scene_list import SceneList
from viewer.ui.timeline import Timeline
from viewer.ui.typography import FIXED

if TYPE_CHECKING:
    from viewer.ui.workbench import Workbench

ROOM_FOR_SCENE_LIST = 30.0   # ems of height under which the scenes become a drop-down list
ROOM_FOR_PERFORMANCE = 50.0


class Panels:
    """Draws every panel in its place; a panel that raises shows its message and leaves the rest alive."""

    def __init__(self, bench: Workbench) -> None:
        self.bench = bench
        self.scene_list = SceneList(bench)
        self.presets = PresetPanel(bench)
        self.parameters = ParameterPanel(bench)
        self.measurements = MeasurementPanel(bench)
        self.lesson = LessonPanel(bench)
        self.code = CodePanel(bench)
        self.timeline = Timeline(bench)
        self.performance = PerformancePanel(bench)
        self.measurements_visible = False
        self.hand_on_widget = False

    def stage_changed(self) -> None:
        """Forget what was typed for the former stage."""
        for panel in (self.presets, self.parameters, self.lesson, self.code, self.timeline):
            panel.forget()

    def release(self) -> None:
        """Free what panels hold apart from ImGui itself."""
        self.lesson.release()

    @staticmethod
    def text_metrics() -> tuple[float, float]:
        """Height of the text and of a menu bar, in the window's units."""
        return imgui.get_font_size(), imgui.get_frame_height()

    def draw(self) -> None:
        """Draw them all, for the bench's present layout."""
        bench, layout = self.bench, self.bench.layout
        self.measurements_visible = False
        self.hand_on_widget = imgui.is_any_item_active() or bench.picture_view.hand_on_handle
        if not self.hand_on_widget:
            bench.history.settle()
        if bench.view.panels:
            guarded("menu", lambda: menu.draw(bench))
            self._window("left", layout.left, self._draw_left)
            self._window("right", layout.right, self._draw_right)
            self._window("bottom", layout.bottom, self._draw_bottom)
            splitter.draw(bench)
        guarded("messages", lambda: message.draw(bench))
        guarded("help", lambda: help_overlay.draw(bench))

    def _window(self, name: str, box: Box, draw: Callable[[], None]) -> None:
        if not box.shown:
            return
        imgui.set_next_window_pos(imgui.ImVec2(box.x, box.y))
        imgui.set_next_window_size(imgui.ImVec2(box.width, box.height))
        imgui.begin(name, None, FIXED)
        guarded(name, draw)
        imgui.end()

    def _draw_left(self) -> None:
        layout = self.bench.layout
        roomy = layout.left.height > ROOM_FOR_SCENE_LIST * imgui.get_font_size() and not layout.one_column
        guarded("scenes", lambda: self.scene_list.draw(roomy))
        if not self.bench.stage:
            return
        if layout.one_column:
            self._draw_tabs({"Tune": self._draw_all_controls} | self._right_tabs("Data"))
        else:
            self._draw_controls()

    def _draw_all_controls(self) -> None:
        """Presets and parameters scroll together where there is little height."""
        guarded("presets", self.presets.draw)
        guarded("parameters", self.parameters.draw)

    def _draw_controls(self) -> None:
        guarded("presets", self.presets.draw)
        imgui.begin_child("controls")
        guarded("parameters", self.parameters.draw)
        imgui.end_child()

    def _draw_right(self) -> None:
        if self.bench.stage:
            self._draw_tabs(self._right_tabs())

    def _right_tabs(self, first: str = "Measurements") -> dict[str, Callable[[], None]]:
        return {first: self._draw_measurements, "Lesson": self.lesson.draw, "Code": self.code.draw}

    def _draw_tabs(self, tabs: dict[str, Callable[[], None]]) -> None:
        em = imgui.get_font_size()
        padding = imgui.ImVec2((0.3 if self.bench.layout.one_column else 0.5) * em, 0.25 * em)
        imgui.push_style_var(imgui.StyleVar_.frame_padding, padding)
        shown = imgui.begin_tab_bar("tabs", imgui.TabBarFlags_.fitting_policy_scroll)
        imgui.pop_style_var()
        if not shown:
            return
        for title, draw in tabs.items():
            imgui.push_style_var(imgui.StyleVar_.frame_padding, padding)
            chosen = imgui.begin_tab_item(title)[0]
            imgui.pop_style_var()
            if chosen:
                imgui.begin_child(title)
                guarded(title.lower(), draw)
                imgui.end_child()
                imgui.end_tab_item()
        imgui.end_tab_bar()

    def _draw_measurements(self) -> None:
        self.measurements_visible = True
        self.measurements.draw()

    def _draw_bottom(self) -> None:
        layout, em = self.bench.layout, imgui.get_font_size()
        room = imgui.get_content_region_avail()
        beside = layout.bottom.width > ROOM_FOR_PERFORMANCE * em
        width = room.x - min(0.42 * room.x, 29.0 * em) - 1.5 * em if beside else room.x
        imgui.begin_child("timeline", imgui.ImVec2(width, 0))
        guarded("timeline", lambda: self.timeline.draw(one_row=layout.one_row))
        imgui.end_child()
        if beside:
            imgui.same_line(0.0, 1.5 * em)
            imgui.begin_child("performance")
            guarded("performance", lambda: self.performance.draw(one_row=layout.one_row))
            imgui.end_child()
