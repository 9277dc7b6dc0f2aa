"""What a window shows: the catalogue, the stage that is on, its panels, and what the user did to them.

Knows nothing of the window system: input comes in through ImGui's events, the picture goes out to a
``Surface``. The window, the headless capture with panels and the tests all drive this one class.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping

import moderngl

from viewer.engine.catalog import Catalog, SceneEntry
from viewer.engine.stage import Stage
from viewer.errors import DemoscopeError
from viewer.ui import actions, screenshot
from viewer.ui.editor import Editor
from viewer.ui.guard import one_line
from viewer.ui.history import History
from viewer.ui.imgui_session import ImguiSession, Surface
from viewer.ui.layout import Box, Layout, View, arrange
from viewer.ui.live_stage import LiveStage, Problem
from viewer.ui.measurer import Measurer
from viewer.ui.pace import Pace
from viewer.ui.panels import Panels
from viewer.ui.picture_view import PictureView
from viewer.ui.remarker import Remarker

TOAST_SECONDS = 5.0
LONGEST_WALL_STEP = 0.25
# This thread's own work, where the system counts it finely, and not what it waits for.
cpu_seconds = time.thread_time if time.get_clock_info("thread_time").resolution < 1e-4 else time.perf_counter


class Workbench(Editor):
    """Shows one stage at a time. With ``steady`` everything that a wall clock would change stands still."""

    def __init__(self, context: moderngl.Context, catalog: Catalog, *, samples: int = 4, seed: int = 0,
                 steady: bool = False) -> None:
        super().__init__()
        self.context = context
        self.catalog = catalog
        self.samples, self.seed, self.steady = samples, seed, steady
        self.view: View = View()
        self.entries: list[SceneEntry] = catalog.entries()
        self.live: LiveStage | None = None
        self.measurer: Measurer | None = None
        self.remarker: Remarker | None = None
        self.notice: Problem | None = None
        self.toast = ""
        self.pace = Pace()
        self.on_fullscreen: Callable[[], None] = lambda: None
        self.session = ImguiSession(context)
        self.layout = Layout(Box())
        self.surface: Surface | None = None
        self.picture_view = PictureView(self)
        self.panels = Panels(self)
        self._query = context.query(time=True)
        self._toast_left = 0.0
        self._screenshot_due = False
        self._borrowed = False
        self._chosen = ""

    # Scenes

    @property
    def stage(self) -> Stage | None:
        """The stage that is on, if any."""
        return self.live.stage if self.live else None

    @property
    def problem(self) -> Problem | None:
        """What the banners over the picture say, if anything."""
        return (self.live.problem if self.live else None) or self.notice

    def open(self, name: str, params: Mapping[str, object] | None = None) -> bool:
        """Put another scene on; the present one stays, with a message, if that one cannot be built."""
        try:
            size = self.stage.size if self.stage else self._picture_pixels()
            stage = Stage(self.context, self.catalog.find(name), size=size, samples=self.samples, params=params,
                          seed=self.seed)
        except Exception as error:
            self.tell(error)
            return False
        self.show(stage)
        return True

    def choose(self, name: str) -> None:
        """Open a scene before the next frame: in this one its forerunner's picture is still to be drawn."""
        self._chosen = name

    def show(self, stage: Stage, *, borrowed: bool = False) -> None:
        """Put ``stage`` on and release the one before; a ``borrowed`` stage is released by its owner."""
        former, former_borrowed = self.live, self._borrowed
        self.live, self._borrowed = LiveStage(stage, self._query), borrowed
        self.measurer = Measurer(stage, patient=not self.steady)
        self.remarker = Remarker(stage, patient=not self.steady)
        self.history = History()
        self.notice = None
        self.panels.stage_changed()
        self.picture_view.stage_changed()
        self.pace.hurry()
        if former and not former_borrowed:
            former.release()

    def reset(self, name: str | None = None) -> DemoscopeError | None:
        """Set one parameter, or all and forget what was typed, to the default."""
        if name is None and self.stage:
            self.panels.stage_changed()
        return super().reset(name)

    # Time and camera

    def toggle_playing(self) -> None:
        """Play if paused, pause if playing."""
        if self.stage:
            self.stage.clock.toggle()

    def step(self, frames: int) -> None:
        """Pause and go some frames on or back."""
        if self.live:
            stage = self.live.stage
            stage.clock.playing = False
            self.live.attempt("play", lambda: stage.step(frames))

    def seek(self, frame: int) -> None:
        """Go to a frame."""
        if self.live:
            stage = self.live.stage
            self.live.attempt("play", lambda: stage.seek(frame))

    def reset_camera(self) -> None:
        """Back to where the scene starts the camera."""
        if self.stage:
            self.stage.camera.reset()

    # The view

    def toggle(self, part: str) -> None:
        """Show or hide a part of the view, by its name in ``View``."""
        setattr(self.view, part, not getattr(self.view, part))

    def close_overlays(self) -> None:
        """What Esc does; the window stays."""
        self.view.help = False
        self.notice = None

    def tell(self, error: Exception) -> None:
        """Show an error in the banner until it is dismissed."""
        self.notice = Problem(one_line(error))

    def say(self, text: str) -> None:
        """Show a short text for a few seconds."""
        self.toast, self._toast_left = text, TOAST_SECONDS

    def screenshot(self, *, panels: bool) -> None:
        """Save the picture, or the whole window once it is drawn."""
        if panels:
            self._screenshot_due = True
        elif self.stage:
            screenshot.save(self, screenshot.picture_pixels(self.stage))

    # A frame

    def draw(self, seconds: float, surface: Surface) -> None:
        """Play on by ``seconds`` of wall time and draw everything."""
        if self._chosen:
            name, self._chosen = self._chosen, ""
            self.open(name)
        if self.live and not self.steady:
            self.live.advance(min(seconds, LONGEST_WALL_STEP))
        self.surface = surface
        building = self._build_panels(seconds, surface)
        self._observe()
        surface.target.use()
        surface.target.clear(0.0, 0.0, 0.0, 1.0)
        started = cpu_seconds()
        self.session.paint(surface.target)
        if building is not None:
            self.pace.spent(building + cpu_seconds() - started)
        self.panels.performance.tick()
        if self._screenshot_due:
            self._screenshot_due = False
            screenshot.save(self, screenshot.surface_pixels(surface))
        self._toast_left -= seconds
        if self._toast_left <= 0.0:
            self.toast = ""

    def release(self) -> None:
        """Free everything on the GPU, but not a borrowed stage."""
        if self.live and not self._borrowed:
            self.live.release()
        self.live = None
        self.session.make_current()
        self.panels.release()
        self.session.release()

    # Inside

    def _build_panels(self, seconds: float, surface: Surface) -> float | None:
        """Build the panels if that is due; returns the CPU seconds that it took.

        None where a hand changed the scene in them: what that costs is not the panels'.
        """
        passed = self.pace.due(seconds, surface, touched=self.session.touched)
        if self.steady:
            passed = seconds
        if not passed:
            return 0.0
        scene, started = self._scene_state(), cpu_seconds()
        self.session.frame(surface, passed, self.view.scale, self._draw_panels)
        return cpu_seconds() - started if scene == self._scene_state() else None

    def _observe(self) -> None:
        """Measure, ask for remarks and draw the picture, as far as any of it shows."""
        if self.measurer and self.panels.measurements_visible:
            self.measurer.run(dragging=self.panels.hand_on_widget)
        if self.live and self.remarker and self.layout.picture.shown:
            self.remarker.run(dragging=self.panels.hand_on_widget)
            self.live.render()

    def _scene_state(self) -> object:
        stage = self.stage
        return (stage.params.revision, stage.size, stage.frame) if stage else None

    def _draw_panels(self) -> None:
        assert self.surface
        actions.run_pressed(self)
        em, menu_height = self.panels.text_metrics()
        self.layout = arrange(self.surface.size, em, menu_height, self.view)
        if self.live and self.layout.picture.shown:
            self.live.resize(self._picture_pixels())
        self.picture_view.draw()
        self.panels.draw()

    def _picture_pixels(self) -> tuple[int, int]:
        box, surface = self.layout.picture, self.surface
        ratio = surface.pixel_ratio if surface else (1.0, 1.0)
        return max(1, round(box.width * ratio[0])), max(1, round(box.height * ratio[1]))
