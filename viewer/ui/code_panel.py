"""The scene's own file and its shaders, with highlighting and the error that stands."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from imgui_bundle import imgui
from imgui_bundle.imgui_color_text_edit import TextEditor

from viewer.ui import theme

if TYPE_CHECKING:
    from viewer.engine.catalog import SceneEntry
    from viewer.ui.workbench import Workbench

SHADER_SUFFIXES = {".vert", ".frag", ".geom", ".glsl"}


class CodePanel:
    """Read-only: the file belongs in one's editor, and every save there shows up here and in the picture."""

    def __init__(self, bench: Workbench) -> None:
        self.bench = bench
        self._editor: TextEditor | None = None
        self._files: list[Path] = []
        self._chosen: Path | None = None
        self._shown: tuple[Path, int, int] | None = None
        self._marked: object = None

    def forget(self) -> None:
        """Another stage is on."""
        self._files, self._chosen, self._shown = [], None, None

    def draw(self) -> None:
        """A choice of files, and the text of the chosen one."""
        stage = self.bench.stage
        if stage is None:
            return
        if not self._files or imgui.is_window_appearing():
            self._files = files_of(stage.entry)
            self._chosen = self._chosen or self._files[0]
        self._choose(stage.entry)
        self._read()
        self._mark()
        imgui.push_font(self.bench.session.fonts.code, 0.9 * imgui.get_style().font_size_base)
        self._editor_now().render("code", imgui.ImVec2(0, 0))
        imgui.pop_font()

    def _choose(self, entry: SceneEntry) -> None:
        assert self._chosen
        imgui.set_next_item_width(-1)
        if imgui.begin_combo("##file", name_of(self._chosen, entry)):
            for path in self._files:
                if imgui.selectable(name_of(path, entry), path == self._chosen)[0]:
                    self._chosen = path
            imgui.end_combo()

    def _editor_now(self) -> TextEditor:
        if self._editor is None:
            self._editor = TextEditor()
            self._editor.set_read_only_enabled(True)
            self._editor.set_palette(TextEditor.get_dark_palette())
            self._editor.set_show_whitespaces_enabled(False)
            self._editor.set_show_scrollbar_mini_map_enabled(False)
            self._editor.set_carets_visible(False)
        return self._editor

    def _read(self) -> None:
        assert self._chosen
        path = self._chosen
        try:
            status = path.stat()
            stamp = path, status.st_mtime_ns, status.st_size
            if stamp == self._shown:
                return
            text = path.read_text(encoding="utf-8", errors="replace")
        except OSError as error:
            stamp, text = (path, 0, -1), str(error)
        editor = self._editor_now()
        editor.set_language(TextEditor.Language.python() if path.suffix == ".py" else TextEditor.Language.glsl())
        editor.set_text(text)
        self._shown, self._marked = stamp, None

    def _mark(self) -> None:
        """A mark on the line of the problem that stands, if it is in this file."""
        assert self.bench.live and self._chosen
        problem, editor = self.bench.live.problem, self._editor_now()
        here = problem is not None and problem.line > 0 and str(self._chosen).endswith(problem.place)
        wanted = (self._shown, problem) if here else None
        if wanted == self._marked:
            return
        editor.clear_markers()
        if here and problem:
            color = imgui.color_convert_float4_to_u32(imgui.ImVec4(*theme.WARNING_DEEP))
            editor.add_marker(problem.line - 1, color, color, problem.text, problem.text)
            editor.scroll_to_line(problem.line - 1, TextEditor.Scroll.align_middle)
        self._marked = wanted


def files_of(entry: SceneEntry) -> list[Path]:
    """The scene's file, then the shaders in its folder."""
    folder = entry.pack / "shaders" / entry.name
    shaders = sorted(path for path in folder.glob("*") if path.suffix in SHADER_SUFFIXES)
    return [entry.file, *shaders]


def name_of(path: Path, entry: SceneEntry) -> str:
    """A file as one would name it inside its pack."""
    return path.relative_to(entry.pack).as_posix() if path.is_relative_to(entry.pack) else path.name
