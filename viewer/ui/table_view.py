"""A table of measurements on screen: headed columns, numbers at their right, words at their left."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

from imgui_bundle import imgui

from viewer.ui import theme
from viewer.ui.text_table import Column, TextTable
from viewer.ui.theme import Fonts
from viewer.ui.typography import fitted, heading, tooltip, wrapped

MOST_ROWS_SHOWN = 14
PADDING_EMS = 0.4, 0.1      # around a cell
NARROWEST_WORDS_EMS = 4.0
TEXT_SIZES = 1.0, 0.9, 0.8   # tried in turn, until a table fits
STEP_EMS = 0.5              # widths go up in steps, lest columns tremble while numbers change
FLAGS: int = (imgui.TableFlags_.sizing_fixed_fit | imgui.TableFlags_.row_bg | imgui.TableFlags_.no_saved_settings
              | imgui.TableFlags_.no_pad_outer_x)
FIXED = int(imgui.TableColumnFlags_.width_fixed)
HEADERS = int(imgui.TableRowFlags_.headers)


@dataclass
class Arrangement:
    """How a table stands in a room: its text's size, its columns' widths, and headings in lines.

    ``cut`` are words as they fit, and ``indents`` the room left of numbers, by column and text.
    """

    table: TextTable
    room: float
    full_size: float
    size: float
    widths: list[float]
    titles: list[list[str]]
    fits: bool
    cut: dict[tuple[int, str], str] = field(default_factory=dict)
    indents: dict[tuple[int, str], float] = field(default_factory=dict)

    def indent(self, index: int, text: str) -> float:
        """How far a text has to go in to end at the right of its column."""
        if (index, text) not in self.indents:
            self.indents[index, text] = max(0.0, self.widths[index] - imgui.calc_text_size(text).x)
        return self.indents[index, text]

    def fitted(self, index: int, text: str) -> str:
        """A text, cut where it is wider than its column."""
        if (index, text) not in self.cut:
            self.cut[index, text] = fitted(text, self.widths[index])
        return self.cut[index, text]


class TableView:
    """Draws tables; each is arranged once for a room and a size of text."""

    def __init__(self, fonts: Fonts) -> None:
        self.fonts = fonts
        self._arrangements: dict[str, Arrangement] = {}

    def draw(self, table: TextTable) -> None:
        """The title, the headings and as many rows as there is room for; the others scroll."""
        imgui.dummy(imgui.ImVec2(0, 0.2 * imgui.get_font_size()))
        heading(table.title, self.fonts)
        if table.columns:
            arrangement = self._arranged(table, imgui.get_content_region_avail().x)
            _push_size(arrangement.size)
            self._grid(arrangement)
            _pop_size()
        if table.left_out:
            imgui.text_disabled(f"and {table.left_out} more rows")

    def _grid(self, arrangement: Arrangement) -> None:
        table, flags, padding = arrangement.table, FLAGS, 2 * imgui.get_style().cell_padding.y
        line = imgui.get_text_line_height() + padding
        height = 0.0
        if table.rows > MOST_ROWS_SHOWN or not arrangement.fits:
            flags |= imgui.TableFlags_.scroll_y | (0 if arrangement.fits else imgui.TableFlags_.scroll_x)
            lines = max(map(len, arrangement.titles))
            height = lines * (line - padding) + padding + line * min(table.rows, MOST_ROWS_SHOWN + 0.5)
            height += 0.0 if arrangement.fits else imgui.get_style().scrollbar_size
        if not imgui.begin_table(table.title, len(table.columns), flags, imgui.ImVec2(0, height)):
            return
        for column, width in zip(table.columns, arrangement.widths, strict=True):
            imgui.table_setup_column(column.title, FIXED, width)
        imgui.table_setup_scroll_freeze(0, 1)
        starts = _headings(arrangement)
        for row in _rows_in_sight(table.rows, line):
            imgui.table_next_row()
            for index, column in enumerate(table.columns):
                imgui.table_next_column()
                _cell(arrangement, index, column, row, starts[index])
        imgui.end_table()

    def _arranged(self, table: TextTable, room: float) -> Arrangement:
        known, full = self._arrangements.get(table.title), imgui.get_font_size()
        if not known or known.table is not table or (known.room, known.full_size) != (room, full):
            for share in TEXT_SIZES:
                _push_size(share * full)
                known = _arrangement(table, room, full)
                _pop_size()
                if known.fits:
                    break
            assert known
            self._arrangements[table.title] = known
        return known


def _arrangement(table: TextTable, room: float, full_size: float) -> Arrangement:
    em = imgui.get_font_size()

    def wide(text: str) -> float:
        return math.ceil(imgui.calc_text_size(text).x / (STEP_EMS * em)) * STEP_EMS * em

    free = room - 2 * imgui.get_style().cell_padding.x * (len(table.columns) - 1)
    if table.rows > MOST_ROWS_SHOWN:
        free -= imgui.get_style().scrollbar_size
    widths = table.widths(free, wide, NARROWEST_WORDS_EMS * em)
    titles = [wrapped(column.title, width) for column, width in zip(table.columns, widths, strict=True)]
    return Arrangement(table, room, full_size, em, widths, titles, sum(widths) <= free + 0.5)


def _push_size(size: float) -> None:
    imgui.push_font(None, size / imgui.get_style().font_scale_main / imgui.get_style().font_scale_dpi)
    em = imgui.get_font_size()
    imgui.push_style_var(imgui.StyleVar_.cell_padding, imgui.ImVec2(*(em * share for share in PADDING_EMS)))


def _pop_size() -> None:
    imgui.pop_style_var()
    imgui.pop_font()


def _headings(arrangement: Arrangement) -> list[float]:
    """Draw the row of headings; returns where each column starts."""
    starts = []
    imgui.table_next_row(HEADERS)
    imgui.push_style_color(imgui.Col_.text, theme.QUIET_TEXT)
    imgui.push_style_var(imgui.StyleVar_.item_spacing, imgui.ImVec2(0, 0))
    for index, column in enumerate(arrangement.table.columns):
        imgui.table_next_column()
        starts.append(imgui.get_cursor_pos_x())
        for line in arrangement.titles[index]:
            imgui.set_cursor_pos_x(starts[-1] + (arrangement.indent(index, line) if column.is_numbers else 0.0))
            imgui.text_unformatted(line)
    imgui.pop_style_var()
    imgui.pop_style_color()
    return starts


def _cell(arrangement: Arrangement, index: int, column: Column, row: int, start: float) -> None:
    text = column.cells[row]
    if column.numbers[row]:
        imgui.set_cursor_pos_x(start + arrangement.indent(index, text))
        imgui.text_unformatted(text)
        return
    shown = arrangement.fitted(index, text)
    imgui.text_unformatted(shown)
    if shown != text:
        tooltip(lambda: text)


def _rows_in_sight(rows: int, line: float) -> Iterator[int]:
    if rows <= MOST_ROWS_SHOWN:
        yield from range(rows)
        return
    clipper = imgui.ListClipper()
    clipper.begin(rows, line)
    while clipper.step():
        yield from range(clipper.display_start, clipper.display_end)
