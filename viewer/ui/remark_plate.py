"""What is unusual about the picture, in its upper corner."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from imgui_bundle import imgui

from viewer.ui import theme
from viewer.ui.layout import Box
from viewer.ui.typography import wrapped

MOST_LINES = 3
WIDTH_EMS, MARGIN_EMS, PAD_EMS, ICON_EMS = 30.0, 0.9, 0.6, 1.5
NARROWEST_EMS = 8.0
PLATE = imgui.color_convert_float4_to_u32(imgui.ImVec4(*theme.PLATE))
ICON = imgui.color_convert_float4_to_u32(imgui.ImVec4(*theme.WARNING))
TEXT = imgui.color_convert_float4_to_u32(imgui.ImVec4(*theme.TEXT))


@dataclass(frozen=True)
class Line:
    """A line of a remark; the first has the icon."""

    text: str
    first: bool


class RemarkPlate:
    """Draws remarks over the picture and behind all panels; they are parted into lines when they change."""

    def __init__(self) -> None:
        self._parted: object = None
        self._lines: list[Line] = []
        self._width = 0.0

    def draw(self, remarks: Sequence[str], box: Box) -> None:
        """Show ``remarks`` in ``box``, the picture's."""
        em = imgui.get_font_size()
        room = min(WIDTH_EMS * em, box.width - 2 * (MARGIN_EMS + PAD_EMS) * em) - ICON_EMS * em
        if not remarks or room < NARROWEST_EMS * em:
            return
        if self._parted != (remarks, room, em):
            self._parted = remarks, room, em
            self._lines = in_lines(remarks, room)
            self._width = max(imgui.calc_text_size(line.text).x for line in self._lines)
        left, top, pad = box.x + MARGIN_EMS * em, box.y + MARGIN_EMS * em, PAD_EMS * em
        right = left + self._width + ICON_EMS * em + 2 * pad
        height, behind = 1.25 * em, imgui.get_background_draw_list()
        bottom = top + len(self._lines) * height + pad
        behind.add_rect_filled(imgui.ImVec2(left, top), imgui.ImVec2(right, bottom), PLATE, 0.4 * em)
        for number, line in enumerate(self._lines):
            y = top + 0.5 * pad + number * height + 0.5 * (height - em)
            if line.first:
                behind.add_text(imgui.ImVec2(left + pad, y), ICON, theme.Icon.WARNING)
            behind.add_text(imgui.ImVec2(left + pad + ICON_EMS * em, y), TEXT, line.text)


def in_lines(remarks: Sequence[str], room: float) -> list[Line]:
    """``remarks`` in lines no wider than ``room``; what does not fit in as many as allowed ends in an ellipsis."""
    lines = [Line(text, not number) for remark in remarks for number, text in enumerate(wrapped(remark, room))]
    if len(lines) > MOST_LINES:
        last = lines[MOST_LINES - 1]
        words = last.text.rstrip(".,;: ")
        while imgui.calc_text_size(f"{words} …").x > room and " " in words:
            words = words.rpartition(" ")[0]
        lines[MOST_LINES - 1:] = [Line(f"{words} …", last.first)]
    return lines
