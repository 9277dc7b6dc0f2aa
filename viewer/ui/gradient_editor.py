"""The widget of a gradient over a life: a bar of its colours, and under it a handle for each stop."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import TypeAlias

import numpy as np
from imgui_bundle import imgui

from viewer.engine.life_fields import GradientField
from viewer.kit.gradient import MOST_STOPS, Gradient, Rgb
from viewer.kit.srgb import encoded
from viewer.ui import theme
from viewer.ui.grip import Grip

Patch: TypeAlias = tuple[imgui.ImVec2, imgui.ImVec2, int, int]

GESTURES = "Drag a stop, click it to change its colour, click the bar to add one, right-click a stop to remove it"
BAR_EMS = 1.4
HANDLE_EMS = 0.8            # width and height of a handle
POINTER_EMS = 0.35          # height of its point
PICKER_EMS = 12.0
PICKER_SHARE = 0.55         # of the window's height, at most
PICKER = "colour of the stop"
PICKER_FLAGS = int(imgui.ColorEditFlags_.display_hex | imgui.ColorEditFlags_.no_side_preview)
DECIMALS = 3                # of a position under the hand
# Where a bar between two stops is cut: its ends bend most, as light is mixed and not its code.
CUTS = (0.0, 1 / 64, 1 / 32, 1 / 16, 1 / 8, 1 / 4, 3 / 8, 1 / 2, 5 / 8, 3 / 4, 7 / 8, 15 / 16, 31 / 32, 63 / 64, 1.0)


@dataclass(frozen=True)
class Bar:
    """Where the life from 0 to 1 lies on the screen, between the bar's ``left`` and its right end."""

    left: float
    top: float
    width: float
    height: float

    def x(self, position: float) -> float:
        """A position on the screen."""
        return self.left + position * self.width


def draw_gradient(field: GradientField, value: Gradient, width: float) -> Gradient | None:
    """The bar of ``value``; returns the gradient that the hand asks for, or None where it did nothing."""
    em, corner = imgui.get_font_size(), imgui.get_cursor_screen_pos()
    imgui.invisible_button("##value", imgui.ImVec2(width, (BAR_EMS + POINTER_EMS + HANDLE_EMS + 0.1) * em))
    inset = 0.5 * HANDLE_EMS * em
    bar = Bar(corner.x + inset, corner.y, max(1.0, width - 2.0 * inset), BAR_EMS * em)
    grip, over, new = Grip(), -1, None
    hovered, active = imgui.is_item_hovered(), imgui.is_item_active()
    if hovered or active or imgui.is_item_deactivated():
        over = _stop_under_mouse(value, bar, em) if hovered else -1
        new = _handled(grip, value, bar, over)
    lit = grip.held if active or imgui.is_popup_open(PICKER) else over
    _draw_bar(value, bar)
    for index, (position, color) in enumerate(value.stops):
        _draw_handle(bar, position, color, em, lit=index == lit)
    return _picked(grip, value) or new


# The hand

def _stop_under_mouse(value: Gradient, bar: Bar, em: float) -> int:
    """The stop whose handle the mouse is on, or, on the bar, whose position it is at; else -1."""
    mouse = imgui.get_mouse_pos()
    reach = (0.2 if mouse.y < bar.top + bar.height else 0.5 * HANDLE_EMS + 0.1) * em
    far = [abs(bar.x(position) - mouse.x) for position, _ in value.stops]
    return far.index(min(far)) if min(far) < reach else -1


def _handled(grip: Grip, value: Gradient, bar: Bar, over: int) -> Gradient | None:
    """What a press, a drag or a click makes of ``value``."""
    if imgui.is_item_activated():
        return _pressed(grip, value, bar, over)
    if imgui.is_item_active():
        to = grip.dragged((1.0 / bar.width, 0.0))
        return _moved(value, grip.held, to[0]) if to and 0 <= grip.held < len(value.stops) else None
    if imgui.is_item_deactivated() and 0 <= grip.held < len(value.stops) and not grip.moved and grip.new < 0:
        grip.paint(value.stops[grip.held][1])
        imgui.open_popup(PICKER)
    return _without(value, over) if over >= 0 and imgui.is_mouse_clicked(1) else None


def _pressed(grip: Grip, value: Gradient, bar: Bar, over: int) -> Gradient | None:
    """Take hold of a stop; on the bar, where there is none, of a new one."""
    grip.take(over, (value.stops[over][0], 0.0))
    mouse = imgui.get_mouse_pos()
    position = round(min(1.0, max(0.0, (mouse.x - bar.left) / bar.width)), DECIMALS)
    crowded = any(abs(position - other) < 10.0 ** -DECIMALS for other, _ in value.stops)
    if over >= 0 or mouse.y > bar.top + bar.height or crowded or len(value.stops) >= MOST_STOPS:
        return None
    red, green, blue = encoded(value.linear(position)).tolist()
    stops = tuple(sorted((*value.stops, (position, (red, green, blue)))))
    grip.take([where for where, _ in stops].index(position), (position, 0.0), new=True)
    return Gradient(stops)


def _moved(value: Gradient, index: int, to: float) -> Gradient | None:
    """The gradient with one stop elsewhere between its neighbours."""
    stops, gap = list(value.stops), 10.0 ** -DECIMALS
    low = stops[index - 1][0] + gap if index else 0.0
    high = stops[index + 1][0] - gap if index + 1 < len(stops) else 1.0
    position = round(min(high, max(low, to)), DECIMALS)
    if position == stops[index][0] or not low - gap / 2 <= position <= high + gap / 2:
        return None
    stops[index] = position, stops[index][1]
    return Gradient(tuple(stops))


def _without(value: Gradient, index: int) -> Gradient | None:
    """The gradient with one stop less; the last one stays."""
    stops = value.stops[:index] + value.stops[index + 1:]
    return Gradient(stops) if stops else None


def _picked(grip: Grip, value: Gradient) -> Gradient | None:
    """The popup in which the held stop's colour is chosen, and the gradient with the colour chosen there."""
    if not imgui.begin_popup(PICKER):
        return None
    new = None
    if 0 <= grip.held < len(value.stops):
        position, color = value.stops[grip.held]
        room = imgui.get_io().display_size.y
        imgui.set_next_item_width(min(PICKER_EMS * imgui.get_font_size(), PICKER_SHARE * room))
        changed, channels = imgui.color_picker3("##color", list(grip.paint_for(color)), PICKER_FLAGS)
        if changed:
            red, green, blue = (min(1.0, max(0.0, channel)) for channel in list(channels)[:3])
            grip.paint((red, green, blue))
            stops = list(value.stops)
            stops[grip.held] = position, (red, green, blue)
            new = Gradient(tuple(stops))
    imgui.end_popup()
    return new


# The picture

def _draw_bar(value: Gradient, bar: Bar) -> None:
    draw = imgui.get_window_draw_list()
    for low, high, start, end in _patches(value, bar, imgui.get_style().alpha):
        draw.add_rect_filled_multi_color(low, high, start, end, end, start)
    draw.add_rect(imgui.ImVec2(bar.left, bar.top), imgui.ImVec2(bar.left + bar.width, bar.top + bar.height),
                  imgui.get_color_u32(imgui.ImVec4(*theme.LINE)))


@lru_cache(maxsize=64)
def _patches(value: Gradient, bar: Bar, alpha: float) -> list[Patch]:
    """The bar in pieces: corners, and the colours at the left and at the right."""
    positions = [position for position, _ in value.stops]
    cuts = np.unique([0.0, 1.0, *(start + cut * (end - start) for start, end in pairwise(positions) for cut in CUTS)])
    colors = [imgui.color_convert_float4_to_u32(imgui.ImVec4(red, green, blue, alpha))
              for red, green, blue in encoded(value.linear(cuts)).tolist()]
    edges, bottom = (bar.left + cuts * bar.width).tolist(), bar.top + bar.height
    return [(imgui.ImVec2(left, bar.top), imgui.ImVec2(right, bottom), start, end)
            for (left, start), (right, end) in pairwise(zip(edges, colors, strict=True))]


def _draw_handle(bar: Bar, position: float, color: Rgb, em: float, *, lit: bool) -> None:
    """A swatch in the stop's colour that points at its place on the bar."""
    draw, half, x = imgui.get_window_draw_list(), 0.5 * HANDLE_EMS * em, bar.x(position)
    tip, top = bar.top + bar.height, bar.top + bar.height + POINTER_EMS * em
    rim = imgui.get_color_u32(imgui.ImVec4(*(theme.TEXT if lit else theme.QUIET_TEXT)))
    edge, round_by = max(1.0, (0.14 if lit else 0.09) * em), imgui.get_style().frame_rounding
    draw.add_triangle_filled(imgui.ImVec2(x, tip), imgui.ImVec2(x + half, top), imgui.ImVec2(x - half, top), rim)
    low, high = imgui.ImVec2(x - half, top), imgui.ImVec2(x + half, top + HANDLE_EMS * em)
    draw.add_rect_filled(low, high, rim, round_by)
    draw.add_rect_filled(imgui.ImVec2(low.x + edge, low.y + edge), imgui.ImVec2(high.x - edge, high.y - edge),
                         imgui.get_color_u32(imgui.ImVec4(*color, 1.0)), 0.6 * round_by)
