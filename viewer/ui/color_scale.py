"""The scale of a picture's colours, in the picture's lower corner where everybody looks."""

from __future__ import annotations

from itertools import pairwise

from imgui_bundle import imgui, implot

from viewer.engine.scene import ColorScale
from viewer.ui import theme
from viewer.ui.layout import Box

STEPS = 32
WIDTH_EMS, HEIGHT_EMS, MARGIN_EMS = 14.0, 0.8, 1.0


def draw_color_scale(scale: ColorScale, box: Box, *, above: bool = False) -> None:
    """Draw ``scale`` over the picture in ``box``, behind all panels; ``above`` in its upper right corner."""
    em = imgui.get_font_size()
    width = min(WIDTH_EMS * em, box.width - 4.0 * MARGIN_EMS * em)
    if width < 4.0 * em or box.height < 8.0 * em:
        return
    left, bottom = box.x + 2.0 * MARGIN_EMS * em, box.y + box.height - MARGIN_EMS * em
    if above:
        left = box.x + box.width - width - 2.0 * MARGIN_EMS * em
        bottom = box.y + (3.9 + MARGIN_EMS) * em
    behind = imgui.get_background_draw_list()
    plate = imgui.get_color_u32(imgui.ImVec4(*theme.PLATE))
    pad = 0.7 * em
    behind.add_rect_filled(imgui.ImVec2(left - pad, bottom - 3.9 * em), imgui.ImVec2(left + width + pad, bottom),
                           plate, 0.4 * em)
    _bar(behind, left, bottom - 2.4 * em, width, HEIGHT_EMS * em)
    _label(behind, scale.title, left, bottom - 3.7 * em)
    _label(behind, reading(scale.low, scale.unit), left, bottom - 1.4 * em)
    high = reading(scale.high, scale.unit)
    _label(behind, high, left + width - imgui.calc_text_size(high).x, bottom - 1.4 * em)


def reading(number: float, unit: str) -> str:
    """A number with its unit, apart from it unless that is a sign such as ° or %."""
    return f"{number:g}{unit}" if unit.startswith(("°", "%")) else f"{number:g} {unit.strip()}".rstrip()


def _bar(behind: imgui.ImDrawList, left: float, top: float, width: float, height: float) -> None:
    """Viridis from left to right, as ``shaders/lib/color.glsl`` has it."""
    colors = [imgui.get_color_u32(implot.sample_colormap(step / STEPS, implot.Colormap_.viridis))
              for step in range(STEPS + 1)]
    for step, (start, end) in enumerate(pairwise(colors)):
        near, far = left + width * step / STEPS, left + width * (step + 1) / STEPS
        behind.add_rect_filled_multi_color(imgui.ImVec2(near, top), imgui.ImVec2(far, top + height),
                                           start, end, end, start)


def _label(behind: imgui.ImDrawList, text: str, x: float, y: float) -> None:
    behind.add_text(imgui.ImVec2(x, y), imgui.get_color_u32(imgui.Col_.text), text)
