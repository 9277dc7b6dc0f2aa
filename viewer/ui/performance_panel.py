"""What a frame costs, read a few times a second so that one can read it."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import numpy as np
from imgui_bundle import imgui

from viewer.ui import theme
from viewer.ui.typography import fitted, tooltip

if TYPE_CHECKING:
    from viewer.ui.workbench import Workbench

FRAMES_SHOWN = 120
READ_EVERY_SECONDS = 0.3
DASH = "–"


class PerformancePanel:
    """Frames per second with their recent course; times on CPU and GPU; the renderer's name."""

    def __init__(self, bench: Workbench) -> None:
        self.bench = bench
        self.renderer = str(bench.context.info["GL_RENDERER"])
        self._milliseconds = np.zeros(FRAMES_SHOWN, np.float32)
        self._next = 0
        self._last_draw: float | None = None
        self._read_at = 0.0
        self._read_for: object = None
        self._rate = DASH
        self._times = ("", "")

    def draw(self, *, one_row: bool) -> None:
        """The plot on the left, two lines of text on its right."""
        self._refresh()
        em = imgui.get_font_size()
        height = imgui.get_frame_height() if one_row else imgui.get_content_region_avail().y
        width = 8.0 * em
        imgui.push_style_color(imgui.Col_.plot_lines, theme.ACCENT_DEEP)
        imgui.plot_lines("##frames", self._milliseconds, self._next, self._rate, 0.0, 50.0, imgui.ImVec2(width, height))
        imgui.pop_style_color()
        tooltip(lambda: f"Time of the last {FRAMES_SHOWN} frames, 0 to 50 ms, and frames per second")
        imgui.same_line(0.0, 0.8 * em)
        imgui.begin_group()
        imgui.text_unformatted(self._times[0])
        if not one_row:
            imgui.push_style_color(imgui.Col_.text, theme.QUIET_TEXT)
            imgui.text_unformatted(self._times[1])
            imgui.pop_style_color()
        imgui.end_group()
        tooltip(lambda: f"{self.renderer}\nCPU: playing and drawing the scene. GPU: drawing it. Panels: drawing these.")

    def tick(self) -> None:
        """A frame is done: note how long after the one before."""
        if self.bench.steady:
            return
        now = time.perf_counter()
        if self._last_draw is not None:
            self._milliseconds[self._next] = 1e3 * (now - self._last_draw)
            self._next = (self._next + 1) % FRAMES_SHOWN
        self._last_draw = now

    def _refresh(self) -> None:
        """Write the figures anew, a few times a second or where they have to fit otherwise."""
        now = 0.0 if self.bench.steady else time.perf_counter()
        stage = self.bench.stage
        shown = (stage.size if stage else None, imgui.get_content_region_avail().x, imgui.get_font_size())
        if shown != self._read_for or (now >= self._read_at and not self.bench.steady):
            self._read_at, self._read_for = now + READ_EVERY_SECONDS, shown
            self._read()

    def _read(self) -> None:
        live = self.bench.live
        if live is None:
            return
        gpu = live.gpu_milliseconds
        known = self._milliseconds[self._milliseconds > 0.0]
        self._rate = f"{1e3 / known.mean():.0f} fps" if known.size else f"{DASH} fps"
        cpu, panels = (DASH, DASH) if self.bench.steady else (
            f"{live.cpu_milliseconds:.1f}", f"{self.bench.pace.cpu_milliseconds:.1f}")
        on_gpu = DASH if self.bench.steady or gpu is None else f"{gpu:.1f}"
        width, height = live.stage.size
        size = f"{width} × {height}"
        room = imgui.get_content_region_avail().x - 10.0 * imgui.get_font_size()
        times, place = f"CPU {cpu}   GPU {on_gpu}   panels {panels} ms", f"{size}   {self.renderer}"
        self._times = fitted(times, room), fitted(place, room)
