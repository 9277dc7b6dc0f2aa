"""Headings, labels and tooltips that look alike in every panel."""

from __future__ import annotations

from collections.abc import Callable

from imgui_bundle import imgui

from viewer.ui import theme
from viewer.ui.theme import Fonts

TOOLTIP_EMS = 22.0
CLEAR = imgui.ImVec4(0, 0, 0, 0)
RESTING = int(imgui.HoveredFlags_.for_tooltip | imgui.HoveredFlags_.allow_when_disabled)
FIXED = (imgui.WindowFlags_.no_decoration | imgui.WindowFlags_.no_move | imgui.WindowFlags_.no_saved_settings
         | imgui.WindowFlags_.no_bring_to_front_on_focus | imgui.WindowFlags_.no_nav)
FLOATING = (imgui.WindowFlags_.no_decoration | imgui.WindowFlags_.no_move | imgui.WindowFlags_.no_saved_settings
            | imgui.WindowFlags_.no_nav | imgui.WindowFlags_.no_focus_on_appearing)


def heading(text: str, fonts: Fonts) -> None:
    """A small bold line over a group."""
    imgui.push_font(fonts.bold, 0.0)
    imgui.push_style_color(imgui.Col_.text, theme.QUIET_TEXT)
    imgui.text(text)
    imgui.pop_style_color()
    imgui.pop_font()


def tooltip(text: Callable[[], str]) -> None:
    """Explain the last item while the mouse rests on it; the text is only made then."""
    if imgui.is_item_hovered(RESTING):
        imgui.push_style_var(imgui.StyleVar_.window_padding, imgui.ImVec2(10, 8))
        if imgui.begin_tooltip():
            imgui.push_text_wrap_pos(TOOLTIP_EMS * imgui.get_font_size())
            imgui.text_unformatted(text())
            imgui.pop_text_wrap_pos()
            imgui.end_tooltip()
        imgui.pop_style_var()


def icon_button(icon: str, name: str, explain: str, *, enabled: bool = True, width: float = 0.0) -> bool:
    """A button with a picture only, without a background until the mouse is on it."""
    imgui.push_style_color(imgui.Col_.button, CLEAR)
    imgui.begin_disabled(not enabled)
    pressed = imgui.button(f"{icon}##{name}", imgui.ImVec2(width, 0))
    imgui.end_disabled()
    imgui.pop_style_color()
    tooltip(lambda: explain)
    return pressed


def fitted(text: str, width: float) -> str:
    """``text``, cut with an ellipsis where it is wider than ``width``."""
    if imgui.calc_text_size(text).x <= width:
        return text
    while text and imgui.calc_text_size(text + "…").x > width:
        text = text[:-1]
    return text.rstrip() + "…"


def wrapped(text: str, width: float) -> list[str]:
    """``text`` in lines of at most ``width``, parted between words."""
    lines = [""]
    for word in text.split():
        longer = f"{lines[-1]} {word}".lstrip()
        if lines[-1] and imgui.calc_text_size(longer).x > width:
            lines.append(word)
        else:
            lines[-1] = longer
    return lines
