"""Presets: a drop-down to load one, and a small dialog to save what is on under a name."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from viewer.engine.presets import Preset, presets_for, save_preset
from viewer.errors import DemoscopeError
from viewer.ui import theme
from viewer.ui.guard import one_line, show_failure
from viewer.ui.typography import icon_button, tooltip

if TYPE_CHECKING:
    from viewer.ui.workbench import Workbench

POPUP = "Save a preset"


class PresetPanel:
    """Reads the preset files when the list is opened, so that a file added meanwhile shows up."""

    def __init__(self, bench: Workbench) -> None:
        self.bench = bench
        self._presets: list[Preset] = []
        self._title = ""
        self._name = ""
        self._replacing = ""
        self._error = ""
        self._asking = False

    def forget(self) -> None:
        """Another stage is on."""
        self._presets, self._title, self._name = [], "", ""

    def draw(self) -> None:
        """One row: the list and the save button."""
        em = imgui.get_font_size()
        imgui.set_next_item_width(imgui.get_content_region_avail().x - 2.0 * em)
        if imgui.begin_combo("##presets", self._title or "Presets", imgui.ComboFlags_.height_large):
            if imgui.is_window_appearing():
                self._read()
            self._rows()
            imgui.end_combo()
        imgui.same_line(0.0, 0.2 * em)
        if icon_button(theme.Icon.SAVE, "save", "Save these values and this camera as a preset"):
            self._replacing = self._error = ""
            imgui.open_popup(POPUP)
        self._dialog()
        imgui.dummy(imgui.ImVec2(0, 0.2 * em))

    def _read(self) -> None:
        assert self.bench.stage
        self._presets = presets_for(self.bench.stage.entry)

    def _rows(self) -> None:
        if not self._presets:
            imgui.text_disabled("This scene has no presets yet")
        for preset in self._presets:
            if imgui.selectable(f"{preset.title}##{preset.name}", preset.title == self._title)[0]:
                self.bench.apply_preset(preset)
                self._title = preset.title
            if preset.description:
                tooltip(partial(str, preset.description))

    def _dialog(self) -> None:
        if not imgui.begin_popup(POPUP):
            return
        if imgui.is_window_appearing() or self._asking:
            imgui.set_keyboard_focus_here()     # so that Enter answers
            self._asking = False
        imgui.set_next_item_width(14.0 * imgui.get_font_size())
        entered, self._name = imgui.input_text_with_hint(
            "##name", "Name of the preset", self._name, imgui.InputTextFlags_.enter_returns_true)
        imgui.same_line()
        if imgui.button("Replace" if self._replacing else "Save") or entered:
            self._save()
        if self._replacing and self._replacing == self._name:
            imgui.text_unformatted("There is a preset of that name. Replace it?")
        if self._error:
            show_failure(self._error)
        if imgui.is_key_pressed(imgui.Key.escape):
            imgui.close_current_popup()
        imgui.end_popup()

    def _save(self) -> None:
        assert self.bench.stage
        self._read()
        stem = self._name.strip().replace(" ", "-").lower()
        if any(preset.name == stem for preset in self._presets) and self._replacing != self._name:
            self._replacing, self._asking = self._name, True
            return
        self._replacing = self._error = ""
        try:
            path = save_preset(self.bench.stage.entry, self.bench.stage, self._name)
        except DemoscopeError as error:
            self._error = one_line(error)
            return
        self.bench.say(f"Saved {path}")
        self._title = self._name
        imgui.close_current_popup()
