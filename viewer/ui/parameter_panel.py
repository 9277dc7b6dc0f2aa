"""The parameters of the scene, one row each, made from their declarations."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from imgui_bundle import imgui

from viewer.engine.fields import Field
from viewer.engine.formula_field import FormulaField
from viewer.engine.number_fields import FormulaSlider
from viewer.ui import theme
from viewer.ui.guard import one_line, show_failure
from viewer.ui.typed_fields import TypedFields
from viewer.ui.typography import fitted, heading, icon_button, tooltip
from viewer.ui.widgets import WIDGETS, draw_value, explain, label

if TYPE_CHECKING:
    from viewer.engine.stage import Stage
    from viewer.ui.workbench import Workbench

LABEL_SHARE = 0.42
RESET_EMS = 1.5


class ParameterPanel:
    """Rows of label, widget and reset; an error stands under the row that caused it."""

    def __init__(self, bench: Workbench) -> None:
        self.bench = bench
        self._typed = TypedFields(bench)
        self._errors: dict[str, tuple[str, int]] = {}
        self._texts: dict[tuple[str, int, float], str] = {}
        self._looked_at: object = None
        self._rows: list[Field[Any]] = []
        self._changed: set[str] = set()

    def forget(self) -> None:
        """Another stage is on, or everything was reset."""
        self._typed = TypedFields(self.bench)
        self._errors.clear()
        self._texts.clear()
        self._looked_at = None

    def draw(self) -> None:
        """Show every parameter."""
        stage = self.bench.stage
        if stage is None:
            return
        self._look(stage)
        self._title(stage)
        width = imgui.get_content_region_avail().x
        for field in self._rows:
            imgui.push_id(field.name)
            self._row(stage, field, width)
            imgui.pop_id()

    def _look(self, stage: Stage) -> None:
        """Find out what the rows are and which differ from the default, when something has changed."""
        state = id(stage.params), stage.params.revision
        if state != self._looked_at:
            self._looked_at = state
            self._rows = self._in_order(stage)
            self._changed = {field.name for field in self._rows if not stage.params.is_default(field.name)}

    def _title(self, stage: Stage) -> None:
        heading("Parameters", self.bench.session.fonts)
        if self._changed:
            width = imgui.calc_text_size("Reset all").x + 2 * imgui.get_style().frame_padding.x
            imgui.same_line(imgui.get_content_region_avail().x - width)
            if imgui.small_button("Reset all"):
                self.bench.reset()

    @staticmethod
    def _in_order(stage: Stage) -> list[Field[Any]]:
        """Declared order, with the sliders that a formula gave rise to right under it."""
        ordered: list[Field[Any]] = []
        fields = list(stage.params.fields.values())
        for field in fields:
            if isinstance(field, FormulaSlider):
                continue
            ordered.append(field)
            if isinstance(field, FormulaField):
                variables = set(stage.params.get(field.name).variables)
                ordered += [each for each in fields if isinstance(each, FormulaSlider) and each.name in variables
                            and each not in ordered]
        return ordered

    def _row(self, stage: Stage, field: Field[Any], width: float) -> None:
        value, reset = stage.params.get(field.name), RESET_EMS * imgui.get_font_size()
        own_line = isinstance(field, FormulaField)
        start = imgui.get_cursor_pos_x()
        beside = width if own_line else LABEL_SHARE * width
        resettable = field.name in self._changed or self._typed.wrong(field.name)
        self._label(field, beside - (reset if resettable else 0.0) - 0.3 * imgui.get_font_size())
        if resettable:
            self._reset(stage, field, start + beside - reset)
        if own_line:
            self._typed.draw(field, value, width)
            tooltip(lambda: explain(field))
            return
        imgui.same_line(start + LABEL_SHARE * width)
        room = (1.0 - LABEL_SHARE) * width
        if field.kind in WIDGETS:
            new = draw_value(field, value, room)
            tooltip(lambda: explain(field))
            if new is not None:
                self._set(stage, field, new)
        else:
            imgui.begin_group()
            self._typed.draw(field, value, room)
            imgui.end_group()
        self._show_error(stage, field)

    def _label(self, field: Field[Any], width: float) -> None:
        key = field.name, round(width), imgui.get_font_size()
        if key not in self._texts:
            self._texts[key] = fitted(label(field.name), width)
        imgui.align_text_to_frame_padding()
        imgui.text_unformatted(self._texts[key])
        tooltip(lambda: f"{label(field.name)}\n{explain(field)}")

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
