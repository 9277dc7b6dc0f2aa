"""A stage that goes on whatever happens: errors stop playback and are kept for the banner."""

from __future__ import annotations

import re
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import moderngl

from viewer.engine.annotations import Handle
from viewer.engine.catalog import SceneEntry
from viewer.engine.file_stamp import file_stamp
from viewer.engine.scene import ColorScale
from viewer.engine.shaders import ShaderError
from viewer.engine.stage import Stage
from viewer.ui.guard import one_line

Answer = TypeVar("Answer")
WATCH_SECONDS = 0.2
PLACE_IN_SCENE = re.compile(r"(?P<file>[\w.-]+\.py):(?P<line>\d+)")


@dataclass(frozen=True)
class Problem:
    """Something to tell the audience: what is wrong, and the line of the file where it is."""

    text: str
    place: str = ""
    line: int = 0
    source: str = ""


def problem_of(error: Exception, entry: SceneEntry) -> Problem:
    """``error`` with the source line it speaks of, where it speaks of one."""
    if isinstance(error, ShaderError):
        path = entry.shaders.find(error.place)
        return Problem(error.text, error.place, error.line, _line_of(path, error.line) if path else "")
    text = one_line(error)
    place = PLACE_IN_SCENE.search(text)
    if place and place["file"] == entry.file.name:
        line = int(place["line"])
        return Problem(text, place["file"], line, _line_of(entry.file, line))
    return Problem(text)


class LiveStage:
    """Plays, draws, times and hot-reloads a stage, and remembers what went wrong last.

    ``problem`` is what the banner has to say. ``query`` times the GPU; it is lent, since moderngl
    cannot free one.
    """

    def __init__(self, stage: Stage, query: moderngl.Query) -> None:
        self.stage = stage
        self.cpu_milliseconds = 0.0
        self.gpu_milliseconds: float | None = None
        self._failure: Problem | None = None
        self._error: Exception | None = None
        self._failed_doing, self._failed_with = "", -1
        self._shader_problem: Problem | None = None
        self._scene_problem: Problem | None = None
        self._scene_stamp = file_stamp(stage.entry.file)
        self._since_watch = 0.0
        self._drawn: object = None
        self._handle: Handle | None = None
        self._handle_shown: object = None
        self._query = query
        self._query_pending = False

    @property
    def problem(self) -> Problem | None:
        """What the banner says, the root cause first."""
        return self._scene_problem or self._shader_problem or self._failure

    @property
    def failure(self) -> Exception | None:
        """What the scene raised, as long as that has not gone well since."""
        return self._error if self._failure else None

    def advance(self, seconds: float) -> None:
        """Play on, and look after edited files now and then."""
        started = time.perf_counter()
        self.attempt("play", lambda: self.stage.advance(seconds))
        self.cpu_milliseconds = 1e3 * (time.perf_counter() - started)
        self._since_watch += seconds
        if self._since_watch >= WATCH_SECONDS:
            self._since_watch = 0.0
            self.watch()

    def attempt(self, doing: str, work: Callable[[], object]) -> None:
        """Do ``work`` on the stage; if it raises, pause and say why until the same goes well."""
        try:
            if work() != 0 and self._failed_doing == doing:     # 0: there was no frame to play
                self._failure = None
        except Exception as error:
            self._fail(doing, error)
            self.stage.clock.playing = False

    def watch(self) -> None:
        """Take over edited shader and scene files."""
        error = self.stage.refresh_shaders()
        self._shader_problem = problem_of(error, self.stage.entry) if error else None
        stamp = file_stamp(self.stage.entry.file)
        if stamp != self._scene_stamp:
            self._scene_stamp = stamp
            self.reload()

    def reload(self) -> None:
        """Build the scene from its file anew."""
        try:
            self.stage.reload_scene()
            self._scene_problem = self._failure = None
        except Exception as error:
            self._scene_problem = problem_of(error, self.stage.entry)

    def resize(self, size: tuple[int, int]) -> None:
        """Draw pictures of ``size`` from now on."""
        if size != self.stage.size:
            self._drawn = None
            self.attempt("resize", lambda: self.stage.resize(size))

    def render(self) -> None:
        """Draw the picture if anything that it shows has changed; the last good one stays otherwise."""
        if self.stage.showing == self._drawn:
            return
        started = time.perf_counter()
        self._read_query()
        if self.stage.params.revision != self._failed_with:
            self._failure = None
        self.attempt("draw", self._timed_render)
        self._drawn = self.stage.showing
        self.cpu_milliseconds += 1e3 * (time.perf_counter() - started)

    def color_scale(self) -> ColorScale | None:
        """What the picture's colours stand for, if they stand for a number."""
        return self._answer("colour scale", self.stage.color_scale)

    def handle(self) -> Handle | None:
        """What a hand can turn or move, if anything; the scene is asked only where something has changed."""
        showing = self.stage.showing
        if self._handle_shown != showing:
            self._handle_shown = showing
            self._handle = self._answer("handle", self.stage.handle)
            if self._failed_doing == "handle" and self._failure:
                self._handle_shown = None       # it may go well the next time
        return self._handle

    def middle(self) -> tuple[float, float] | None:
        """Where in the picture the camera's target stands; None while the scene fails, which ``render`` tells."""
        try:
            return self.stage.middle
        except Exception:
            return None

    def card_below(self) -> bool:
        """Whether the scene has moved up to make room below."""
        middle = self.middle()
        return bool(middle and middle[1] > 0.0)

    def release(self) -> None:
        """Free the stage."""
        self.stage.release()

    def _answer(self, doing: str, ask: Callable[[], Answer]) -> Answer | None:
        """What the stage answers; if it raises, None, and why until the same goes well."""
        try:
            answer = ask()
        except Exception as error:
            self._fail(doing, error)
            return None
        if self._failed_doing == doing:
            self._failure = None
        return answer

    def _fail(self, doing: str, error: Exception) -> None:
        self._failure, self._failed_doing, self._error = problem_of(error, self.stage.entry), doing, error
        self._failed_with = self.stage.params.revision

    def _timed_render(self) -> None:
        with self._query:
            self.stage.render()
        self._query_pending = True

    def _read_query(self) -> None:
        """Last frame's time on the GPU: read now, it is long finished and nothing waits."""
        if self._query_pending:
            self.gpu_milliseconds = self._query.elapsed * 1e-6
            self._query_pending = False


def _line_of(path: Path, line: int) -> str:
    try:
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return ""
    return lines[line - 1].strip() if 1 <= line <= len(lines) else ""
