"""Transport and scrub bar."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from viewer.engine.clock import SPEEDS
from viewer.ui import theme
from viewer.ui.typography import icon_button, tooltip
from viewer.ui.widgets import begin_bar, end_bar

if TYPE_CHECKING:
    from viewer.engine.stage import Stage
    from viewer.ui.workbench import Workbench

FIRST_RANGE = 600
SLOW_SEEK_SECONDS = 0.15


class Timeline:
    """Scrubbing follows the hand while seeking is quick, and waits for it to let go where it is slow."""

    def __init__(self, bench: Workbench) -> None:
        self.bench = bench
        self.forget()

    def forget(self) -> None:
        """Another stage is on."""
        self._last_frame = FIRST_RANGE
        self._wanted: int | None = None
        self._seek_seconds = 0.0

    def draw(self, *, one_row: bool) -> None:
        """Buttons, time and speed; the scrub bar beside or under them."""
        stage = self.bench.stage
        if stage is None:
            return
        self._transport(stage)
        if one_row:
            imgui.same_line()
            self._scrub(stage, imgui.get_content_region_avail().x - 6.0 * imgui.get_font_size())
            imgui.same_line()
            self._speed(stage, 5.0 * imgui.get_font_size())
            return
        imgui.same_line(0.0, 0.8 * imgui.get_font_size())
        imgui.align_text_to_frame_padding()
        imgui.text_unformatted(f"frame {stage.frame}")
        imgui.same_line(0.0, 0.8 * imgui.get_font_size())
        imgui.push_style_color(imgui.Col_.text, theme.QUIET_TEXT)
        imgui.text_unformatted(f"{stage.clock.seconds:.2f} s")
        imgui.pop_style_color()
        width = 5.0 * imgui.get_font_size()
        imgui.same_line(max(0.0, imgui.get_window_width() - width))
        self._speed(stage, width)
        self._scrub(stage, imgui.get_content_region_avail().x)

    def _transport(self, stage: Stage) -> None:
        width = 1.9 * imgui.get_font_size()
        playing = stage.clock.playing
        if icon_button(theme.Icon.START, "start", "Back to frame 0 (Home)", width=width):
            self.bench.seek(0)
        imgui.same_line(0.0, 1.0)
        if icon_button(theme.Icon.BACK, "back", "One frame back (,)", width=width):
            self.bench.step(-1)
        imgui.same_line(0.0, 1.0)
        imgui.push_style_color(imgui.Col_.button, theme.ACCENT_DEEP)
        if imgui.button(f"{theme.Icon.PAUSE if playing else theme.Icon.PLAY}###play", imgui.ImVec2(1.5 * width, 0)):
            self.bench.toggle_playing()
        imgui.pop_style_color()
        tooltip(lambda: "Pause (Space)" if playing else "Play (Space)")
        imgui.same_line(0.0, 1.0)
        if icon_button(theme.Icon.FORWARD, "forward", "One frame forward (.)", width=width):
            self.bench.step(1)

    def _scrub(self, stage: Stage, width: float) -> None:
        frame = stage.frame if self._wanted is None else self._wanted
        if frame > self._last_frame:
            self._last_frame = 2 * frame
        width = max(1.0, width)
        imgui.set_next_item_width(width)
        begin_bar(frame / self._last_frame, width)
        moved, wanted = imgui.slider_int("##scrub", frame, 0, self._last_frame, "%d", imgui.SliderFlags_.always_clamp)
        end_bar()
        if moved:
            self._wanted = wanted
        if self._wanted is not None and (not imgui.is_item_active() or self._seek_seconds < SLOW_SEEK_SECONDS):
            started = time.perf_counter()
            self.bench.seek(self._wanted)
            self._seek_seconds = 0.0 if self.bench.steady else time.perf_counter() - started
            self._wanted = None

    def _speed(self, stage: Stage, width: float) -> None:
        imgui.set_next_item_width(width)
        if imgui.begin_combo("##speed", f"{stage.clock.speed:g}×"):
            for speed in SPEEDS:
                if imgui.selectable(f"{speed:g}×", speed == stage.clock.speed)[0]:
                    stage.clock.speed = speed
            imgui.end_combo()
        tooltip(lambda: "Speed of playing")
