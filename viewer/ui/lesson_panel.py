"""The scene's lesson, a Markdown text beside its code."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import imgui_bundle
from imgui_bundle import imgui, rich_md

from viewer.ui import theme

if TYPE_CHECKING:
    from viewer.ui.workbench import Workbench


class LessonPanel:
    """Shows ``assets/lessons/<scene>.md`` of the scene's pack; read again when the file changes."""

    def __init__(self, bench: Workbench) -> None:
        self.bench = bench
        self._stamp = (0, -1)
        self._text = ""
        self._markdown: rich_md.Context | None = None

    def forget(self) -> None:
        """Another stage is on."""
        self._stamp = (0, -1)

    def draw(self) -> None:
        """The text, or a word that there is none."""
        stage = self.bench.stage
        if stage is None:
            return
        if imgui.is_window_appearing() or not imgui.get_frame_count() % 30 or self._stamp == (0, -1):
            self._read(stage.entry.pack / "assets" / "lessons" / f"{stage.entry.name}.md")
        if not self._text:
            imgui.text_disabled("This scene has no lesson text")
            return
        self._use_markdown()
        rich_md.render(self._text)

    def _read(self, path: Path) -> None:
        try:
            status = path.stat()
            stamp = status.st_mtime_ns, status.st_size
            if stamp != self._stamp:
                self._text = path.read_text(encoding="utf-8", errors="replace")
        except OSError:
            stamp, self._text = (0, 0), ""
        self._stamp = stamp

    def _use_markdown(self) -> None:
        """Each ImGui context needs a Markdown context of its own, since that holds fonts."""
        if self._markdown is None:
            rich_md.set_assets_folder(str(Path(imgui_bundle.__file__).parent / "assets"))
            options = rich_md.MarkdownOptions()
            options.font_options.regular_size = theme.FONT_PIXELS
            self._markdown = rich_md.create_context(options)
        rich_md.set_current_context(self._markdown)

    def release(self) -> None:
        """Free what Markdown holds, while the renderer is still there."""
        if self._markdown is not None:
            rich_md.destroy_context(self._markdown)
            self._markdown = None
