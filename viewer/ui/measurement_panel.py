"""The scene's numbers, large enough for the last row, and its curves."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from imgui_bundle import imgui, implot
from numpy.typing import NDArray

from viewer.ui import theme
from viewer.ui.guard import show_failure
from viewer.ui.measurer import Plot
from viewer.ui.table_view import TableView
from viewer.ui.typography import heading

if TYPE_CHECKING:
    from viewer.ui.workbench import Workbench

PLOT_EMS = 15.0
PLOT_FLAGS: int = (implot.Flags_.no_menus | implot.Flags_.no_box_select | implot.Flags_.no_title
                   | implot.Flags_.no_mouse_text)
AXIS_FLAGS: int = implot.AxisFlags_.auto_fit | implot.AxisFlags_.no_highlight
MOST_DOTS = 45
LEGEND_FLAGS: int = implot.LegendFlags_.outside | implot.LegendFlags_.horizontal | implot.LegendFlags_.no_buttons
NOW_COLOR = imgui.ImVec4(*theme.rgb("#e8eaed", 0.7))
SERIES_COLORS = [imgui.ImVec4(*color) for color in theme.SERIES]


class MeasurementPanel:
    """Shows the latest report; the measurer decides when there is a new one."""

    def __init__(self, bench: Workbench) -> None:
        self.bench = bench
        self._tables = TableView(bench.session.fonts)

    def draw(self) -> None:
        """Readouts, then tables, then plots."""
        measurer = self.bench.measurer
        if measurer is None:
            return
        if measurer.failure:
            show_failure(measurer.failure)
        report = measurer.report
        if report is None:
            return
        if not report.readouts and not report.tables and not report.plots:
            imgui.text_disabled("This scene measures nothing")
        for name, value in report.readouts:
            self._readout(name, value)
        for table in report.tables:
            self._tables.draw(table)
        for plot in report.plots:
            self._plot(plot)

    def _readout(self, name: str, value: str) -> None:
        """Name on the left, value on the right; under it where they do not fit side by side."""
        room = imgui.get_content_region_avail().x
        imgui.push_style_color(imgui.Col_.text, theme.QUIET_TEXT)
        imgui.text_unformatted(name)
        imgui.pop_style_color()
        wide = imgui.get_item_rect_size().x
        imgui.push_font(self.bench.session.fonts.bold, 0.0)
        own = imgui.calc_text_size(value).x
        if wide + own + imgui.get_font_size() <= room:
            imgui.same_line()
        imgui.set_cursor_pos_x(max(0.0, imgui.get_cursor_start_pos().x + room - own))
        imgui.text_unformatted(value)
        imgui.pop_font()

    def _plot(self, plot: Plot) -> None:
        imgui.dummy(imgui.ImVec2(0, 0.2 * imgui.get_font_size()))
        heading(plot.title, self.bench.session.fonts)
        height = min(PLOT_EMS * imgui.get_font_size(), 0.9 * imgui.get_content_region_avail().x)
        if not implot.begin_plot(f"##{plot.title}", imgui.ImVec2(-1, height), PLOT_FLAGS):
            return
        try:
            _axes(plot)
            numbered = list(enumerate(plot.series))
            for index, (name, x, y) in sorted(numbered, key=lambda each: each[1][0] in plot.curve.dots):
                _draw_series(name, x, y, SERIES_COLORS[index % len(SERIES_COLORS)], dots=name in plot.curve.dots)
            if plot.curve.now is not None:
                spec = implot.Spec()
                spec.line_color = NOW_COLOR
                spec.line_weight = 0.12 * imgui.get_font_size()
                implot.plot_inf_lines("now", np.array([plot.curve.now]), spec)
        finally:
            implot.end_plot()


def _draw_series(name: str, x: NDArray[np.float64], y: NDArray[np.float64], color: imgui.ImVec4, *,
                 dots: bool) -> None:
    """A line, or some of its points, evenly chosen."""
    spec, em = implot.Spec(), imgui.get_font_size()
    spec.line_color, spec.line_weight = color, 0.12 * em
    if not dots:
        implot.plot_line(name, x, y, spec)
        return
    spec.marker, spec.marker_size = implot.Marker_.circle, 0.17 * em
    spec.marker_fill_color = spec.marker_line_color = color
    some = slice(None, None, 1 + len(x) // MOST_DOTS)
    implot.plot_scatter(name, np.ascontiguousarray(x[some]), np.ascontiguousarray(y[some]), spec)


def _axes(plot: Plot) -> None:
    curve = plot.curve
    implot.setup_axes(curve.x_label or curve.x_name, curve.y_label, AXIS_FLAGS, AXIS_FLAGS)
    if curve.log_x:
        implot.setup_axis_scale(implot.ImAxis_.x1, implot.Scale_.log10)
    if curve.log_y:
        implot.setup_axis_scale(implot.ImAxis_.y1, implot.Scale_.log10)
    implot.setup_legend(implot.Location_.north, LEGEND_FLAGS)
