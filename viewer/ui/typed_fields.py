"""Parameters that are typed: formulas, texts and files. What is typed stays, right or wrong."""

from __future__ import annotations

import shutil
import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from imgui_bundle import imgui, portable_file_dialogs

from viewer.engine.fields import Field, ParameterError
from viewer.engine.file_field import File
from viewer.engine.formula_field import FormulaField
from viewer.kit.formula import FormulaError
from viewer.ui import theme
from viewer.ui.guard import one_line
from viewer.ui.typography import icon_button

if TYPE_CHECKING:
    from viewer.ui.workbench import Workbench

FORMULA_LINES = (2, 5)     # as many as the text takes, within these
PAUSE_SECONDS = 0.12       # between keys, after which a formula is compiled: a driver may take as long


@dataclass
class Draft:
    """A text being typed, the stored value that it was last equal to, and what is wrong with it."""

    text: str
    stored: str
    error: str = ""
    position: int | None = None
    due: float | None = None


class TypedFields:
    """The drafts of one stage's typed parameters, by name."""

    def __init__(self, bench: Workbench) -> None:
        self.bench = bench
        self._drafts: dict[str, Draft] = {}
        self._dialog: tuple[str, portable_file_dialogs.open_file] | None = None

    def wrong(self, name: str) -> bool:
        """Whether what stands in the input is not what is in force."""
        draft = self._drafts.get(name)
        return bool(draft and draft.error)

    def discard(self, name: str) -> None:
        """Forget what was typed."""
        self._drafts.pop(name, None)

    def draw(self, field: Field[Any], value: Any, width: float) -> None:
        """The input, and under it what is wrong."""
        draft = self._draft(field, value)
        if isinstance(field, FormulaField):
            self._draw_formula(field, draft, width)
        elif isinstance(field, File):
            self._draw_file(field, draft, width)
        else:
            imgui.set_next_item_width(width)
            changed, text = imgui.input_text("##value", draft.text)
            if changed:
                self._try(field, draft, text)
        if draft.error:
            _show_error(draft, self.bench)

    def _draft(self, field: Field[Any], value: Any) -> Draft:
        """The present draft, replaced where the value was changed elsewhere: undo, a preset, a reset."""
        stored = field.text(value)
        draft = self._drafts.get(field.name)
        if draft is None or draft.stored != stored:
            draft = self._drafts[field.name] = Draft(stored, stored)
        return draft

    def _draw_formula(self, field: FormulaField, draft: Draft, width: float) -> None:
        imgui.push_font(self.bench.session.fonts.code, 0.0)
        if draft.error:
            imgui.push_style_color(imgui.Col_.frame_bg, theme.WARNING_DEEP)
        height = _lines(draft.text, width) * imgui.get_text_line_height() + 3 * imgui.get_style().frame_padding.y
        changed, text = imgui.input_text_multiline("##value", draft.text, imgui.ImVec2(width, height),
                                                   imgui.InputTextFlags_.word_wrap)
        if draft.error:
            imgui.pop_style_color()
        imgui.pop_font()
        if changed:
            self._typed(field, draft, text)
        if draft.due is not None and (imgui.get_time() >= draft.due or not imgui.is_item_active()):
            self._try(field, draft, draft.text)

    def _typed(self, field: FormulaField, draft: Draft, text: str) -> None:
        """Say at once what is wrong with a formula; one that is right is put in force when the keys rest."""
        try:
            field.parse(text)
        except ParameterError:
            self._try(field, draft, text)
            return
        draft.text, draft.error, draft.position = text, "", None
        draft.due = imgui.get_time() + PAUSE_SECONDS

    def _draw_file(self, field: File, draft: Draft, width: float) -> None:
        browse = 1.9 * imgui.get_font_size() if dialogs_exist() else 0.0
        imgui.set_next_item_width(width - browse)
        changed, text = imgui.input_text_with_hint("##value", " ".join(field.suffixes) or "path", draft.text)
        if changed:
            draft.text = text
        if imgui.is_item_deactivated_after_edit():
            self._try(field, draft, draft.text)
        if browse:
            imgui.same_line(0.0, 2.0)
            if icon_button(theme.Icon.OPEN, "browse", "Choose a file"):
                pattern = [" ".join(f"*{suffix}" for suffix in field.suffixes) or "*"]
                self._dialog = field.name, portable_file_dialogs.open_file("Choose a file", "", ["Files", *pattern])
        self._take_dialog(field, draft)

    def _take_dialog(self, field: File, draft: Draft) -> None:
        if self._dialog and self._dialog[0] == field.name and self._dialog[1].ready(0):
            chosen = self._dialog[1].result()
            self._dialog = None
            if chosen:
                self._try(field, draft, chosen[0])

    def _try(self, field: Field[Any], draft: Draft, text: str) -> None:
        """Put ``text`` in force, or keep it beside what is wrong with it."""
        draft.text, draft.due = text, None
        error = self.bench.change(field.name, {field.name: text})
        if error is None:
            assert self.bench.stage
            draft.stored = field.text(self.bench.stage.params.get(field.name))
            draft.error, draft.position = "", None
            return
        cause = error.__cause__
        draft.position = cause.position if isinstance(cause, FormulaError) else None
        draft.error = one_line(cause if isinstance(cause, FormulaError) else error).removeprefix(f"{field.name}: ")


def dialogs_exist() -> bool:
    """Whether the system can show its own file dialog; on Linux that takes zenity or kdialog."""
    return not sys.platform.startswith("linux") or any(map(shutil.which, ("zenity", "kdialog", "qarma", "matedialog")))


def _lines(text: str, width: float) -> float:
    """How many lines a formula takes, about, in an input of ``width``."""
    columns = max(1, int((width - 2 * imgui.get_font_size()) / max(1.0, imgui.calc_text_size("m").x)))
    needed = sum(1 + len(line) // columns for line in text.split("\n"))
    return min(FORMULA_LINES[1], max(FORMULA_LINES[0], needed))


def _show_error(draft: Draft, bench: Workbench) -> None:
    imgui.push_style_color(imgui.Col_.text, theme.WARNING)
    if draft.position is not None and draft.text.strip():
        imgui.push_font(bench.session.fonts.code, 0.0)
        columns = int(imgui.get_content_region_avail().x / max(1.0, imgui.calc_text_size("m").x)) - 1
        shown, marker = excerpt(draft.text, draft.position, columns)
        imgui.text_unformatted(f"{shown}\n{marker}")
        imgui.pop_font()
    imgui.text_wrapped(draft.error)
    imgui.pop_style_color()


def excerpt(text: str, position: int, columns: int) -> tuple[str, str]:
    """The part of ``text`` around the 1-based ``position`` that fits, and a line that points at it."""
    flat = text.replace("\n", " ").replace("\t", " ")
    index = max(0, min(position - 1, len(flat)))
    first = max(0, index - max(4, columns - 6)) if len(flat) > columns else 0
    shown = ("…" if first else "") + flat[first + bool(first):first + max(8, columns)]
    return shown, " " * (index - first) + "^"
