"""The widget of a curve over a life: a small plot whose points the hand adds, moves and takes away."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise
from typing import TypeAlias

import numpy as np
from imgui_bundle import imgui

from viewer.engine.life_fields import LifeCurveField
from viewer.kit.life_curve import MOST_POINTS, LifeCurve
from viewer.ui import theme
from viewer.ui.curve_axis import Plot, greatest, held_top, possible_tops
from viewer.ui.grip import REACH_EMS, Grip, Place, nearest

Line: TypeAlias = "list[imgui.ImVec2Like]"
Quad: TypeAlias = tuple[imgui.ImVec2, imgui.ImVec2, imgui.ImVec2, imgui.ImVec2]

GESTURES = "Drag a point, click to add one, right-click or double-click a point to remove it"
HEIGHT_EMS = 5.0
MARGIN_EMS = 0.45       # between the frame and the range, so that a point at a limit is whole
HANDLE_EMS = 0.26
LABEL_EMS = 0.8         # size of the numbers beside the plot
LABEL_GAP_EMS = 0.35
STEPS = 48              # of the polyline across the plot, and at least
STEPS_BETWEEN = 6       # from one point to the next
DECIMALS = 3            # of a position under the hand
GRID = 0.25, 0.5, 0.75
FILL, FAINT = (*theme.ACCENT[:3], 0.22), (*theme.TEXT[:3], 0.09)


def draw_curve(field: LifeCurveField, value: LifeCurve, width: float) -> LifeCurve | None:
    """The plot of ``value``; returns the curve that the hand asks for, or None where it did nothing."""
    em, corner = imgui.get_font_size(), imgui.get_cursor_screen_pos()
    gutter = _gutter(field, em)
    box = imgui.ImVec2(max(1.0, width - gutter), HEIGHT_EMS * em)
    imgui.set_cursor_screen_pos(imgui.ImVec2(corner.x + gutter, corner.y))
    imgui.invisible_button("##value", box)
    margin = MARGIN_EMS * em
    hovered, active = imgui.is_item_hovered(), imgui.is_item_active()
    held = held_top(field, value, hovered=hovered, active=active)
    under_hand = Plot(corner.x + gutter + margin, corner.y + margin, max(1.0, box.x - 2 * margin),
                      box.y - 2 * margin, field.minimum, held)
    plot = replace(under_hand, maximum=max(held, greatest(value)))
    _draw_limits(field, plot, corner, gutter)
    grip, over = Grip(), -1
    if hovered or active:
        over = nearest([plot.place(*point) for point in value.points], REACH_EMS * em)
    new = _handled(grip, field, value, under_hand, over) if hovered or active else None
    lit = grip.held if active and grip.held < len(value.points) else over
    _draw_plot(plot, value, margin, lit)
    if lit >= 0:
        _draw_reading(field, value.points[lit], plot, em)
    elif hovered and len(value.points) < MOST_POINTS:
        _draw_offer(value, plot, em)
    return new


# The hand

def _handled(grip: Grip, field: LifeCurveField, value: LifeCurve, plot: Plot, over: int) -> LifeCurve | None:
    """What a press, a drag or a click makes of ``value``."""
    if imgui.is_item_activated():
        return _pressed(grip, field, value, plot, over)
    if imgui.is_item_active():
        if not 0 <= grip.held < len(value.points):
            return None
        to = grip.dragged(plot.units)
        return _moved(field, value, grip.held, to, plot) if to else None
    return _without(value, over) if over >= 0 and imgui.is_mouse_clicked(1) else None


def _pressed(grip: Grip, field: LifeCurveField, value: LifeCurve, plot: Plot, over: int) -> LifeCurve | None:
    """Take hold of a point, made if there is none; a double click removes one that stood there before it."""
    if over < 0:
        return _added(grip, field, value, plot)
    if imgui.is_mouse_double_clicked(0) and grip.new != over:
        grip.take(-1)
        return _without(value, over)
    grip.take(over, value.points[over])
    return None


def _added(grip: Grip, field: LifeCurveField, value: LifeCurve, plot: Plot) -> LifeCurve | None:
    """A point under the mouse, or on the curve where that is as good as under it."""
    grip.take(-1)
    x, y = plot.point(imgui.get_mouse_pos())
    x = round(x, DECIMALS)
    if len(value.points) >= MOST_POINTS or any(abs(x - other) < 10.0 ** -DECIMALS for other, _ in value.points):
        return None
    here = float(value(x))
    y = _rounded(field, here if abs(here - y) < REACH_EMS * imgui.get_font_size() * -plot.units[1] else y, plot)
    points = tuple(sorted((*value.points, (x, y))))
    grip.take(points.index((x, y)), (x, y), new=True)
    return LifeCurve(points)


def _moved(field: LifeCurveField, value: LifeCurve, index: int, to: Place, plot: Plot) -> LifeCurve | None:
    """The curve with one point elsewhere, between its neighbours and within the limits."""
    points, gap = list(value.points), 10.0 ** -DECIMALS
    low = points[index - 1][0] + gap if index else 0.0
    high = points[index + 1][0] - gap if index + 1 < len(points) else 1.0
    x = round(min(high, max(low, to[0])), DECIMALS)
    points[index] = x if low - gap / 2 <= x <= high + gap / 2 else points[index][0], _rounded(field, to[1], plot)
    return LifeCurve(tuple(points)) if tuple(points) != value.points else None


def _without(value: LifeCurve, index: int) -> LifeCurve | None:
    """The curve with one point less; the last one stays."""
    points = value.points[:index] + value.points[index + 1:]
    return LifeCurve(points) if points else None


def _rounded(field: LifeCurveField, y: float, plot: Plot) -> float:
    """``y`` within the limits, to a hundredth of the axis or finer, which is less than a pixel as a rule."""
    decimals = 2 - math.floor(math.log10(plot.maximum - plot.minimum))
    return min(field.maximum, max(field.minimum, round(y, decimals)))


# The picture

def _gutter(field: LifeCurveField, em: float) -> float:
    """The room for the numbers at the left: for all that the axis may end with, lest it change under the hand."""
    ends = field.minimum, *possible_tops(field)
    return LABEL_EMS * max(imgui.calc_text_size(f"{end:g}").x for end in ends) + LABEL_GAP_EMS * em


def _draw_limits(field: LifeCurveField, plot: Plot, corner: imgui.ImVec2, gutter: float) -> None:
    """The ends of the axis at the left, as on any plot; while a point is dragged beyond the top, its reading tells."""
    em, quiet = imgui.get_font_size(), imgui.get_color_u32(imgui.ImVec4(*theme.QUIET_TEXT))
    size, ends = LABEL_EMS * em, [(plot.minimum, plot.top + plot.height)]
    if plot.maximum in possible_tops(field):
        ends.append((plot.maximum, plot.top))
    for end, y in ends:
        left = corner.x + gutter - LABEL_GAP_EMS * em - LABEL_EMS * imgui.calc_text_size(f"{end:g}").x
        place = imgui.ImVec2(left, y - 0.5 * size)
        imgui.get_window_draw_list().add_text(imgui.get_font(), size, place, quiet, f"{end:g}")


def _draw_plot(plot: Plot, value: LifeCurve, margin: float, lit: int) -> None:
    """The frame, the curve over its shade, and its points."""
    draw, color = imgui.get_window_draw_list(), _color
    low, high = _frame(plot, margin)
    draw.add_rect_filled(low, high, color(theme.WELL), imgui.get_style().frame_rounding)
    for share in GRID:
        x = round(plot.left + share * plot.width)
        draw.add_line(imgui.ImVec2(x, low.y), imgui.ImVec2(x, high.y), color(FAINT))
    if plot.minimum < 0.0 < plot.maximum:
        y = plot.place(0.0, 0.0)[1]
        draw.add_line(imgui.ImVec2(low.x, y), imgui.ImVec2(high.x, y), color(theme.LINE))
    line, area = _outline(value, plot, margin)
    fill, white = color(FILL), imgui.get_font_tex_uv_white_pixel()
    draw.prim_reserve(6 * len(area), 4 * len(area))     # smoothed edges would show as seams between the pieces
    for quad in area:
        draw.prim_quad_uv(*quad, white, white, white, white, fill)
    draw.add_polyline(line, color(theme.ACCENT), max(1.5, 0.1 * imgui.get_font_size()), 0)
    radius = HANDLE_EMS * imgui.get_font_size()
    for index, point in enumerate(value.points):
        at, grown = imgui.ImVec2(*plot.place(*point)), 1.3 if index == lit else 1.0
        draw.add_circle_filled(at, grown * radius, color(theme.TEXT if index == lit else theme.ACCENT))
        draw.add_circle(at, grown * radius, color(theme.PANEL), 0, max(1.0, 0.35 * radius))


@lru_cache(maxsize=64)
def _outline(value: LifeCurve, plot: Plot, margin: float) -> tuple[Line, list[Quad]]:
    """The curve as a polyline across the frame, and the area under it in upright pieces."""
    knots = [x for x, _ in value.points]
    between = np.interp(np.arange(STEPS_BETWEEN * (len(knots) - 1) + 1) / STEPS_BETWEEN, np.arange(len(knots)), knots)
    x = np.union1d(np.linspace(0.0, 1.0, STEPS + 1), between)
    share = (plot.maximum - value(x)) / (plot.maximum - plot.minimum)
    across, down = plot.left + x * plot.width, plot.top + share * plot.height
    low, high = _frame(plot, margin)
    across, down = np.array([low.x, *across, high.x]), np.array([down[0], *down, down[-1]])
    bent = np.abs(np.diff(np.diff(down) / np.maximum(np.diff(across), 1e-6))) > 1e-6
    across, down = across[needed := np.array([True, *bent, True])], down[needed]
    line = [imgui.ImVec2(*place) for place in zip(across.tolist(), down.tolist(), strict=True)]
    feet = [imgui.ImVec2(place.x, high.y) for place in line]
    pieces = zip(pairwise(line), pairwise(feet), strict=True)
    return list(line), [(left, right, right_foot, left_foot) for (left, right), (left_foot, right_foot) in pieces]


def _frame(plot: Plot, margin: float) -> tuple[imgui.ImVec2, imgui.ImVec2]:
    return (imgui.ImVec2(plot.left - margin, plot.top - margin),
            imgui.ImVec2(plot.left + plot.width + margin, plot.top + plot.height + margin))


def _draw_offer(value: LifeCurve, plot: Plot, em: float) -> None:
    """A hollow point on the curve, where a click would add one."""
    x, y = plot.point(imgui.get_mouse_pos())
    here = float(value(x))
    if abs(here - y) < REACH_EMS * em * -plot.units[1]:
        at = imgui.ImVec2(*plot.place(x, here))
        imgui.get_window_draw_list().add_circle(at, HANDLE_EMS * em, _color(theme.TEXT), 0, max(1.0, 0.08 * em))


def _draw_reading(field: LifeCurveField, point: Place, plot: Plot, em: float) -> None:
    """Where a point stands, in the upper corner that is farther from it."""
    text = f"{point[0]:g} : {point[1]:g} {field.unit}".rstrip()
    width, pad = imgui.calc_text_size(text).x, 0.3 * em
    left = plot.left if point[0] > 0.5 else plot.left + plot.width - width
    draw = imgui.get_window_draw_list()
    low, high = imgui.ImVec2(left - pad, plot.top - pad), imgui.ImVec2(left + width + pad, plot.top + 1.15 * em)
    draw.add_rect_filled(low, high, _color(theme.PLATE), imgui.get_style().frame_rounding)
    draw.add_text(imgui.ImVec2(left, plot.top - 0.1 * em), _color(theme.TEXT), text)


def _color(color: theme.Rgba) -> int:
    """A colour as draw lists take it, paler where the widget is disabled."""
    return imgui.get_color_u32(imgui.ImVec4(*color))
