"""The parameters of the scene, one row each, made from their declarations."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from imgui_bundle import imgui

from viewer.engine.fields import Field
from viewer.engine.number_fields import FormulaSlider
from viewer.ui import theme
from viewer.ui.guard import one_line, show_failure
from viewer.ui.parameter_groups import Folds, Group, grouped
from viewer.ui.typed_fields import TypedFields
from viewer.ui.typography import fitted, heading, icon_button, tooltip
from viewer.ui.widgets import WIDGETS, draw_value, explain, label

if TYPE_CHECKING:
    from viewer.engine.stage import Stage
    from viewer.ui.workbench import Workbench

LABEL_SHARE = 0.42
FULL_WIDTH = "formula", "curve", "gradient"     # kinds that stand on a line of their own
RESET_EMS = 1.5


class ParameterPanel:
    """Rows of label, widget and reset; an error stands under the row that caused it."""

    def __init__(self, bench: Workbench) -> None:
        self.bench = bench
        self._typed = TypedFields(bench)
        self._errors: dict[str, tuple[str, int]] = {}
        self._texts: dict[tuple[str, int, float], str] = {}
        self._looked_at: object = None
        self._groups: list[Group] = []
        self._changed: set[str] = set()
        self._idle: set[str] = set()
        self._heights: dict[str, float] = {}
        self._folds = Folds()

    def forget(self) -> None:
        """Another stage is on, or everything was reset."""
        self._typed = TypedFields(self.bench)
        self._errors.clear()
        self._texts.clear()
        self._heights.clear()
        self._looked_at = None

    def draw(self) -> None:
        """Show every parameter."""
        stage = self.bench.stage
        if stage is None:
            return
        self._look(stage)
        self._title(stage)
        width = imgui.get_content_region_avail().x
        for group in self._groups:
            if group.title and not self._heading(stage, group):
                continue
            for field in group.fields:
                if not self._scrolled_away(field, width):
                    self._draw_row(stage, field, width)

    def _scrolled_away(self, field: Field[Any], width: float) -> bool:
        """Whether a row is out of sight, and then leave room for it; one under a hand or typed in is drawn anyway."""
        size = imgui.ImVec2(width, self._heights.get(field.name, 0.0))
        if not size.y or field.kind not in WIDGETS or self.bench.panels.hand_on_widget or imgui.is_rect_visible(size):
            return False
        imgui.dummy(size)
        return True

    def _draw_row(self, stage: Stage, field: Field[Any], width: float) -> None:
        top = imgui.get_cursor_pos_y()
        imgui.push_id(field.name)
        imgui.begin_disabled(field.name in self._idle)
        self._row(stage, field, width)
        imgui.end_disabled()
        imgui.pop_id()
        self._heights[field.name] = imgui.get_cursor_pos_y() - top - imgui.get_style().item_spacing.y

    def _look(self, stage: Stage) -> None:
        """Find out what the rows are, which differ from the default and which now have no effect."""
        state = id(stage.params), stage.params.revision
        if state != self._looked_at:
            self._looked_at = state
            self._groups = grouped(stage.params)
            names = list(stage.params.fields)
            self._changed = {name for name in names if not stage.params.is_default(name)}
            self._idle = {name for name in names if not stage.params.is_active(name)}

    def _title(self, stage: Stage) -> None:
        heading("Parameters", self.bench.session.fonts)
        if self._changed:
            width = imgui.calc_text_size("Reset all").x + 2 * imgui.get_style().frame_padding.x
            imgui.same_line(imgui.get_content_region_avail().x - width)
            if imgui.small_button("Reset all"):
                self.bench.reset()

    def _heading(self, stage: Stage, group: Group) -> bool:
        imgui.dummy(imgui.ImVec2(0, 0))
        return self._folds.heading(stage.entry.name, group.title, self.bench.session.fonts, idle=group.idle)

    def _row(self, stage: Stage, field: Field[Any], width: float) -> None:
        value, reset = stage.params.get(field.name), RESET_EMS * imgui.get_font_size()
        own_line = field.kind in FULL_WIDTH
        start = imgui.get_cursor_pos_x()
        beside = width if own_line else LABEL_SHARE * width
        resettable = field.name in self._changed or self._typed.wrong(field.name)
        self._label(stage, field, beside - (reset if resettable else 0.0) - 0.3 * imgui.get_font_size())
        if resettable:
            self._reset(stage, field, start + beside - reset)
        if not own_line:
            imgui.same_line(start + LABEL_SHARE * width)
        self._widget(stage, field, value, width if own_line else (1.0 - LABEL_SHARE) * width)
        self._show_error(stage, field)

    def _widget(self, stage: Stage, field: Field[Any], value: Any, room: float) -> None:
        if field.kind in WIDGETS:
            new = draw_value(stage.params.offered(field.name), value, room)
            if field.kind not in FULL_WIDTH or not imgui.is_item_active():
                tooltip(lambda: self._explained(stage, field))
            if new is not None:
                self._set(stage, field, new)
        elif field.kind in FULL_WIDTH:
            self._typed.draw(field, value, room)
            tooltip(lambda: self._explained(stage, field))
        else:
            imgui.begin_group()
            self._typed.draw(field, value, room)
            imgui.end_group()

    def _label(self, stage: Stage, field: Field[Any], width: float) -> None:
        key = field.name, round(width), imgui.get_font_size()
        if key not in self._texts:
            self._texts[key] = fitted(label(field.name), width)
        imgui.align_text_to_frame_padding()
        imgui.text_unformatted(self._texts[key])
        tooltip(lambda: f"{label(field.name)}\n{self._explained(stage, field)}")

    def _explained(self, stage: Stage, field: Field[Any]) -> str:
        """What there is to say of a parameter, and first of all why it is grey."""
        if field.name not in self._idle:
            return explain(field)
        declared = stage.params.formulas_with(field.name)[0] if isinstance(field, FormulaSlider) else field.name
        terms = [term.words() for term in stage.params.condition(declared)]
        return f"Has an effect only where {' and '.join(terms)}\n{explain(field)}"

    def _reset(self, stage: Stage, field: Field[Any], x: float) -> None:
        imgui.same_line(x)
        if icon_button(theme.Icon.RESET, "reset", f"Back to {field.text(field.default) or 'none'}"):
            self._typed.discard(field.name)
            self._errors.pop(field.name, None)
            self._keep_error(stage, field, self.bench.reset(field.name))

    def _set(self, stage: Stage, field: Field[Any], value: object) -> None:
        self._keep_error(stage, field, self.bench.change(field.name, {field.name: value}))

    def _keep_error(self, stage: Stage, field: Field[Any], error: Exception | None) -> None:
        if error:
            self._errors[field.name] = one_line(error), stage.params.revision
        else:
            self._errors.pop(field.name, None)

    def _show_error(self, stage: Stage, field: Field[Any]) -> None:
        """The error stands until something changes."""
        text, revision = self._errors.get(field.name, ("", 0))
        if not text:
            return
        if revision != stage.params.revision:
            del self._errors[field.name]
            return
        show_failure(text)
