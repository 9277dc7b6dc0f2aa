"""The scenes to choose from, each with its sentence."""

from __future__ import annotations

import ast
from functools import lru_cache, partial
from pathlib import Path
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from viewer.ui import theme
from viewer.ui.typography import heading, tooltip

if TYPE_CHECKING:
    from viewer.ui.workbench import Workbench


class SceneList:
    """A list where there is room, else a drop-down."""

    def __init__(self, bench: Workbench) -> None:
        self.bench = bench

    def draw(self, roomy: bool) -> None:
        """Show the scenes; ``roomy`` as a list."""
        if roomy:
            heading("Scenes", self.bench.session.fonts)
            self._rows()
            imgui.dummy(imgui.ImVec2(0, 0.3 * imgui.get_font_size()))
            return
        imgui.set_next_item_width(-1)
        present = self.bench.stage.entry.name if self.bench.stage else ""
        if imgui.begin_combo("##scenes", title(present) if present else "Choose a scene"):
            self._rows()
            imgui.end_combo()

    def _rows(self) -> None:
        present = self.bench.stage.entry.name if self.bench.stage else ""
        for entry in self.bench.entries:
            selected = entry.name == present
            if imgui.selectable(f" {title(entry.name)}##{entry.name}", selected)[0] and not selected:
                self.bench.choose(entry.name)
            if selected:
                _mark_item()
            tooltip(partial(sentence, entry.file))
        if not self.bench.entries:
            imgui.text_disabled("No scenes in any pack")


def title(name: str) -> str:
    """``rippling_sphere`` as "Rippling sphere"."""
    return name.replace("_", " ").capitalize()


@lru_cache(maxsize=256)
def sentence(file: Path) -> str:
    """The first line of the scene's docstring, found without running the file."""
    try:
        tree = ast.parse(file.read_text(encoding="utf-8"))
    except (OSError, SyntaxError, ValueError) as error:
        return f"This file cannot be read: {error}"
    for node in tree.body:
        if isinstance(node, ast.ClassDef) and any("Scene" in ast.unparse(base) for base in node.bases):
            return (ast.get_docstring(node) or node.name).splitlines()[0]
    return file.name


def _mark_item() -> None:
    """A bar at the left edge of the last item."""
    low, high, thin = imgui.get_item_rect_min(), imgui.get_item_rect_max(), 0.18 * imgui.get_font_size()
    color = imgui.get_color_u32(imgui.ImVec4(*theme.ACCENT))
    imgui.get_window_draw_list().add_rect_filled(low, imgui.ImVec2(low.x + thin, high.y), color)
