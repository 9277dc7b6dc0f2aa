"""How the panels look: a dark neutral room in which the picture is the brightest thing.

Colours are picked for contrast on a weak projector: text at 13:1 on panels, accents from the
colour-blind safe set of Okabe and Ito (2008).
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

import imgui_bundle
from imgui_bundle import imgui, implot

Rgba: TypeAlias = tuple[float, float, float, float]

FONT_FOLDER = Path(imgui_bundle.__file__).parent / "assets" / "fonts"
FONT_PIXELS = 16.0


def rgb(code: str, alpha: float = 1.0) -> Rgba:
    """A colour from its code, such as ``#56b4e9``."""
    red, green, blue = bytes.fromhex(code.removeprefix("#"))
    return red / 255.0, green / 255.0, blue / 255.0, alpha


PANEL = rgb("#1b1d20")
HEADING = rgb("#23262a")       # behind the title of what can be folded
WELL = rgb("#2a2d32")          # what holds a value: sliders, inputs, plots
WELL_HOVERED = rgb("#34383e")
WELL_ACTIVE = rgb("#3c4148")
PLATE = rgb("#16181c", 0.8)    # behind words in the picture
LINE = rgb("#3a3e45")
TEXT = rgb("#eceef0")
QUIET_TEXT = rgb("#a9afb8")
ACCENT = rgb("#56b4e9")
ACCENT_DEEP = rgb("#2f6f99")
WARNING = rgb("#ff8f5a")
WARNING_DEEP = rgb("#5a2a17")
SERIES = tuple(rgb(code) for code in ("#56b4e9", "#e69f00", "#009e73", "#cc79a7", "#f0e442", "#d55e00", "#0072b2"))


class Icon:
    """Glyphs of Font Awesome 6 Free, which is merged into every font."""

    PLAY, PAUSE = "\uf04b", "\uf04c"
    START, BACK, FORWARD = "\uf049", "\uf048", "\uf051"
    RESET, SAVE, OPEN, WARNING, CLOSE = "\uf2ea", "\uf0c7", "\uf07c", "\uf071", "\uf00d"


@dataclass(frozen=True)
class Fonts:
    """The faces in use: Roboto for words, Inconsolata for formulas and code."""

    regular: imgui.ImFont
    bold: imgui.ImFont
    code: imgui.ImFont


def load_fonts() -> Fonts:
    """Add the fonts that come with imgui-bundle to the current ImGui context."""
    return Fonts(_font("Roboto/Roboto-Regular.ttf"), _font("Roboto/Roboto-Bold.ttf"), _font("Inconsolata-Medium.ttf"))


def _font(name: str) -> imgui.ImFont:
    atlas = imgui.get_io().fonts
    face = atlas.add_font_from_file_ttf(str(FONT_FOLDER / name), FONT_PIXELS)
    icons = imgui.ImFontConfig()
    icons.merge_mode = True
    icons.pixel_snap_h = True
    atlas.add_font_from_file_ttf(str(FONT_FOLDER / "Font_Awesome_6_Free-Solid-900.otf"), FONT_PIXELS * 0.8, icons)
    return face


def apply(scale: float, dpi: float) -> None:
    """Dress the current ImGui and ImPlot contexts at ``scale`` (1 to 3) on a screen of density ``dpi``."""
    style = imgui.Style()
    imgui.style_colors_dark(style)
    _shape(style)
    for role, color in _colors().items():
        style.set_color_(role, imgui.ImVec4(*color))
    style.scale_all_sizes(scale * dpi)
    style.font_size_base = FONT_PIXELS
    style.font_scale_main = scale
    style.font_scale_dpi = dpi
    _install(style)
    _dress_plots(scale * dpi)


def _shape(style: imgui.Style) -> None:
    style.window_padding = imgui.ImVec2(12, 10)
    style.frame_padding = imgui.ImVec2(7, 3)
    style.item_spacing = imgui.ImVec2(8, 6)
    style.item_inner_spacing = imgui.ImVec2(6, 4)
    style.scrollbar_size = 10
    style.grab_min_size = 9
    style.window_border_size = 0
    style.child_border_size = 0
    style.popup_border_size = 1
    style.frame_rounding = style.grab_rounding = 3
    style.popup_rounding = style.scrollbar_rounding = 4
    style.window_rounding = 0
    style.tab_rounding = 3
    style.tab_bar_border_size = 1
    style.hover_delay_normal = 0.35
    style.log_slider_deadzone = 0


def _colors() -> dict[int, Rgba]:
    role = imgui.Col_
    return {
        role.text: TEXT, role.text_disabled: QUIET_TEXT, role.window_bg: PANEL, role.popup_bg: rgb("#24272b"),
        role.child_bg: rgb("#000000", 0.0), role.border: LINE, role.separator: LINE,
        role.frame_bg: WELL, role.frame_bg_hovered: WELL_HOVERED, role.frame_bg_active: WELL_ACTIVE,
        role.slider_grab: ACCENT, role.slider_grab_active: rgb("#8fd0f5"), role.check_mark: ACCENT,
        role.button: WELL, role.button_hovered: WELL_HOVERED, role.button_active: ACCENT_DEEP,
        role.header: rgb("#2d4557"), role.header_hovered: WELL_HOVERED, role.header_active: ACCENT_DEEP,
        role.menu_bar_bg: rgb("#141619"), role.scrollbar_bg: rgb("#000000", 0.0), role.scrollbar_grab: WELL_ACTIVE,
        role.tab: PANEL, role.tab_hovered: WELL_HOVERED, role.tab_selected: WELL,
        role.tab_selected_overline: ACCENT, role.text_selected_bg: ACCENT_DEEP, role.plot_lines: ACCENT,
        role.table_header_bg: HEADING, role.table_border_light: LINE, role.table_row_bg: rgb("#000000", 0.0),
        role.table_row_bg_alt: rgb("#ffffff", 0.05), role.plot_histogram: ACCENT_DEEP,
        role.modal_window_dim_bg: rgb("#000000", 0.45),
        role.text_link: ACCENT, role.nav_cursor: ACCENT,
    }


def _install(style: imgui.Style) -> None:
    """Copy ``style`` into the current context, which hands its own out by reference only."""
    current = imgui.get_style()
    for name in dir(style):
        if not name.startswith("_") and not callable(getattr(style, name)):
            setattr(current, name, getattr(style, name))
    for role in _colors():
        current.set_color_(role, style.color_(role))


def _dress_plots(scale: float) -> None:
    style = implot.get_style()
    style.plot_padding = imgui.ImVec2(10 * scale, 4 * scale)
    style.label_padding = imgui.ImVec2(4 * scale, 3 * scale)
    style.legend_padding = imgui.ImVec2(5 * scale, 4 * scale)
    style.legend_inner_padding = imgui.ImVec2(4 * scale, 3 * scale)
    style.plot_border_size = 0
    style.plot_min_size = imgui.ImVec2(60, 40)
    style.set_color_(implot.Col_.frame_bg, imgui.ImVec4(0, 0, 0, 0))
    style.set_color_(implot.Col_.plot_bg, imgui.ImVec4(*WELL))
    style.set_color_(implot.Col_.legend_bg, imgui.ImVec4(*WELL))
    style.set_color_(implot.Col_.legend_border, imgui.ImVec4(0, 0, 0, 0))
    style.set_color_(implot.Col_.axis_grid, imgui.ImVec4(1, 1, 1, 0.25))
