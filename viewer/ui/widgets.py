"""A widget for each kind of parameter: shows a value, returns the one the hand asks for, or None."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from imgui_bundle import imgui

from viewer.engine.color_field import Color
from viewer.engine.fields import Field
from viewer.engine.life_fields import LifeCurveField
from viewer.engine.number_fields import Integer, Interval, Number, Slider
from viewer.engine.word_fields import Choice, Toggle
from viewer.ui import curve_editor, gradient_editor, theme
from viewer.ui.curve_editor import draw_curve
from viewer.ui.gradient_editor import draw_gradient
from viewer.ui.typography import tooltip

DRAG_PIXELS = 300.0     # of mouse travel across the whole of an interval's range
MOST_SEGMENTS = 4
LOGARITHMIC = int(imgui.SliderFlags_.logarithmic)
ALWAYS_CLAMP = int(imgui.SliderFlags_.always_clamp)
GESTURES = {"curve": curve_editor.GESTURES, "gradient": gradient_editor.GESTURES}

BAR_COLORS, IDLE_BAR_COLORS = [[imgui.color_convert_float4_to_u32(imgui.ImVec4(*color)) for color in colors]
                               for colors in ((theme.WELL, theme.ACCENT_DEEP, theme.ACCENT),
                                              (theme.HEADING, theme.WELL_HOVERED, theme.WELL_ACTIVE))]
BAR_GLOW = [(int(role), imgui.ImVec4(1, 1, 1, alpha)) for role, alpha in (
    (imgui.Col_.frame_bg, 0.0), (imgui.Col_.frame_bg_hovered, 0.06), (imgui.Col_.frame_bg_active, 0.1),
    (imgui.Col_.slider_grab, 0.0), (imgui.Col_.slider_grab_active, 0.0))]


def draw_value(field: Field[Any], value: Any, width: float) -> Any:
    """The widget for ``field`` at ``value``; returns a new value, or None where the hand did nothing."""
    imgui.set_next_item_width(width)
    return WIDGETS[field.kind](field, value, width)


def number_format(field: Number[Any], digits: str) -> str:
    """How a number and its unit are written on a slider."""
    unit = field.unit.replace("%", "%%")
    return f"{digits} {unit}".rstrip()


def explain(field: Field[Any]) -> str:
    """What a tooltip says of a parameter: help, range, default."""
    lines = [field.help]
    if isinstance(field, (Number, LifeCurveField)):
        lines.append(f"{field.range_text} {field.unit}".rstrip())
    lines.append(f"Default: {field.text(field.default) or 'none'}")
    if isinstance(field, Number):
        lines.append("Drag an end" if isinstance(field, Interval) else "Ctrl+click to type a value")
    if field.kind in GESTURES:
        lines.append(GESTURES[field.kind])
    return "\n".join(lines)


def _slider(field: Slider, value: float, width: float) -> float | None:
    low, high = field.widget_range
    flags = LOGARITHMIC if field.logarithmic else 0
    begin_bar(share(field, value), width)
    changed, number = imgui.slider_float("##value", value, low, high, number_format(field, "%.4g"), flags)
    end_bar()
    return _decimal(number) if changed else None


def _integer(field: Integer, value: int, width: float) -> int | None:
    flags = LOGARITHMIC if field.logarithmic else 0
    low, high = int(field.minimum), int(field.maximum)
    begin_bar(share(field, value), width)
    changed, number = imgui.slider_int("##value", value, low, high, number_format(field, "%d"), flags)
    end_bar()
    return number if changed else None


def _interval(field: Interval, value: tuple[float, float], width: float) -> tuple[float, float] | None:
    flags = ALWAYS_CLAMP | (LOGARITHMIC if field.logarithmic else 0)
    low, high = field.widget_range
    changed, start, end = imgui.drag_float_range2(
        "##value", *value, (high - low) / DRAG_PIXELS, field.minimum, field.maximum,
        _interval_format(field, value, width), None, flags)
    return (_decimal(start), _decimal(end)) if changed else None


def _interval_format(field: Interval, value: tuple[float, float], width: float) -> str:
    """How both numbers are written, each in half the width: with the unit only where there is room for it."""
    style = imgui.get_style()
    room = 0.5 * (width - style.item_inner_spacing.x) - 2.0 * style.frame_padding.x
    numbers = *value, field.minimum, field.maximum, 0.8888     # lest the unit come and go under the hand
    widest = max(imgui.calc_text_size(f"{number:.4g} {field.unit}".rstrip()).x for number in numbers)
    return number_format(field, "%.4g") if widest <= room else "%.4g"


def _toggle(field: Toggle, value: bool, width: float) -> bool | None:
    changed, on = imgui.checkbox("##value", value)
    return on if changed else None


def _color(field: Color, value: tuple[float, float, float], width: float) -> tuple[float, ...] | None:
    changed, channels = imgui.color_edit3("##value", list(value), imgui.ColorEditFlags_.display_hex)
    return tuple(min(1.0, max(0.0, _decimal(channel))) for channel in list(channels)[:3]) if changed else None


def _choice(field: Choice, value: str, width: float) -> str | None:
    if _fit_as_segments(field.options, width):
        return _segments(field, value, width)
    chosen = None
    if imgui.begin_combo("##value", label(value), imgui.ComboFlags_.height_large):
        for option in field.options:
            if imgui.selectable(label(option), option == value)[0]:
                chosen = option
            _option_tooltip(field, option)
            if option == value:
                imgui.set_item_default_focus()
        imgui.end_combo()
    return chosen if chosen != value else None


def _segments(field: Choice, value: str, width: float) -> str | None:
    """A row of buttons of which one is down."""
    chosen, gap = None, max(1.0, round(0.1 * imgui.get_font_size()))
    each = (width - gap * (len(field.options) - 1)) / len(field.options)
    imgui.begin_group()
    for index, option in enumerate(field.options):
        if index:
            imgui.same_line(0.0, gap)
        imgui.push_style_color(imgui.Col_.button, theme.ACCENT_DEEP if option == value else theme.WELL)
        imgui.push_style_var(imgui.StyleVar_.frame_padding, imgui.ImVec2(0, imgui.get_style().frame_padding.y))
        if imgui.button(label(option), imgui.ImVec2(each, 0)) and option != value:
            chosen = option
        imgui.pop_style_var()
        imgui.pop_style_color()
        _option_tooltip(field, option)
    imgui.end_group()
    return chosen


def share(field: Number[Any], value: float) -> float:
    """How far along its slider a value lies, 0 to 1."""
    low, high = field.widget_range
    if field.logarithmic:
        low, high, value = math.log(low), math.log(high), math.log(max(value, low))
    return min(1.0, max(0.0, (value - low) / (high - low)))


def begin_bar(filled: float, width: float) -> None:
    """Draw a bar filled so far, over which ImGui's slider writes the value; its own grab would hide that."""
    low, height, round_by = imgui.get_cursor_screen_pos(), imgui.get_frame_height(), imgui.get_style().frame_rounding
    edge, thin, draw = low.x + filled * width, max(1.0, 0.12 * imgui.get_font_size()), imgui.get_window_draw_list()
    color = BAR_COLORS if imgui.get_style().alpha == 1.0 else IDLE_BAR_COLORS
    draw.add_rect_filled(low, imgui.ImVec2(low.x + width, low.y + height), color[0], round_by)
    draw.add_rect_filled(low, imgui.ImVec2(edge, low.y + height), color[1], round_by)
    at = min(max(low.x, edge - thin), low.x + width - thin)
    draw.add_rect_filled(imgui.ImVec2(at, low.y), imgui.ImVec2(at + thin, low.y + height), color[2])
    for role, glow in BAR_GLOW:
        imgui.push_style_color(role, glow)


def end_bar() -> None:
    imgui.pop_style_color(5)


def _fit_as_segments(options: tuple[str, ...], width: float) -> bool:
    if not 2 <= len(options) <= MOST_SEGMENTS:
        return False
    widest = max(imgui.calc_text_size(label(option)).x for option in options)
    return (widest + 0.6 * imgui.get_font_size()) * len(options) <= width


def _option_tooltip(field: Choice, option: str) -> None:
    note = field.notes.get(option, "")
    if note:
        tooltip(lambda: note)


def label(name: str) -> str:
    """A name from code as one reads it."""
    return name.replace("_", " ")


def _decimal(number: float) -> float:
    """ImGui's single precision as the decimal number that was meant."""
    return float(f"{number:.7g}") if math.isfinite(number) else number


WIDGETS: dict[str, Callable[[Any, Any, float], Any]] = {
    "slider": _slider, "integer": _integer, "interval": _interval, "toggle": _toggle, "color": _color,
    "choice": _choice, "curve": draw_curve, "gradient": draw_gradient,
}
