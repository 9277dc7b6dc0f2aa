"""The window: moderngl-window's GLFW backend, its events fed to a workbench, its frames filled by it."""

from __future__ import annotations

import gc
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from imgui_bundle import imgui  # noqa: F401  before glfw, for which it sets the library's path

import glfw  # isort: skip
from moderngl_window.context.glfw.window import Window as GlfwWindow  # isort: skip

from viewer.engine.camera import Orbit
from viewer.engine.catalog import Catalog
from viewer.engine.context import plain_words
from viewer.engine.presets import load_preset
from viewer.ui.glfw_input import GlfwInput
from viewer.ui.imgui_session import Surface
from viewer.ui.workbench import Workbench

TITLE = "Demoscope"
SHORTEST_FRAME_SECONDS = 1.0 / 250.0    # where the driver does not wait for the screen
MINIMISED_SECONDS = 0.1


def run(catalog: Catalog, scene_name: str | None, *, size: tuple[int, int] = (1280, 800), samples: int = 4,
        seed: int = 0, params: Mapping[str, object] | None = None, preset: str | Path | None = None,
        camera: Orbit | Mapping[str, Any] | None = None) -> None:
    """Open the window on ``scene_name`` (None: the catalogue's first) and stay until it is closed.

    ``preset`` comes first, then ``params``, then ``camera``. A scene that cannot be loaded leaves its message in
    the window. Raises ContextError where no window or no OpenGL 3.3 is to be had.
    """
    window = _opened(size)
    try:
        bench = Workbench(window.ctx, catalog, samples=samples, seed=seed)
        try:
            _begin(bench, scene_name, params, preset, camera)
            _Loop(window, bench).run()
        finally:
            bench.release()
    finally:
        window.destroy()


def _opened(size: tuple[int, int]) -> GlfwWindow:
    complaints: list[str] = []
    glfw.set_error_callback(lambda code, text: complaints.append(_decoded(text)))
    try:
        window = GlfwWindow(title=TITLE, gl_version=(3, 3), size=size, resizable=True, vsync=True, samples=0)
    except Exception as error:
        raise plain_words("; ".join([*complaints, str(error)])) from error
    glfw.set_error_callback(lambda code, text: None)
    _fit_on_screen(window._window)
    window.exit_key = window.fullscreen_key = None
    window.ctx.gc_mode = None  # type: ignore[assignment]
    return window


def _fit_on_screen(handle: Any) -> None:
    """Make a window that is larger than the screen as large as that: not every window manager does."""
    monitor = glfw.get_primary_monitor()
    if monitor:
        left, top, width, height = glfw.get_monitor_workarea(monitor)
        wide, high = glfw.get_window_size(handle)
        if wide > width or high > height:
            glfw.set_window_size(handle, min(wide, width), min(high, height))
            glfw.set_window_pos(handle, left, top)


def _begin(bench: Workbench, scene_name: str | None, params: Mapping[str, object] | None,
           preset: str | Path | None, camera: Orbit | Mapping[str, Any] | None) -> None:
    name = scene_name or next((entry.name for entry in bench.entries), None)
    if name is None:
        return
    try:
        chosen = load_preset(bench.catalog.find(name), preset) if preset else None
    except Exception as error:
        bench.tell(error)
        return
    if not bench.open(name, {**(chosen.values if chosen else {}), **(params or {})}) or not bench.stage:
        return
    place = camera or (chosen.camera if chosen else None)
    if place:
        bench.stage.camera.stand(place)


class _Loop:
    """One frame after the other, as fast as the screen shows them."""

    def __init__(self, window: GlfwWindow, bench: Workbench) -> None:
        self.window, self.bench = window, bench
        self.handle: Any = window._window
        self.input = GlfwInput(self.handle, bench.session)
        self._windowed: tuple[int, int, int, int] | None = None
        self._title = TITLE
        bench.on_fullscreen = self.toggle_fullscreen

    def run(self) -> None:
        """Until the window is closed."""
        gc.collect()
        gc.freeze()     # what is there by now stays; looking through it again and again would cost frames
        last = time.perf_counter()
        while not self.window.is_closing:
            surface = self._surface()
            if surface is None:
                glfw.wait_events_timeout(MINIMISED_SECONDS)
                last = time.perf_counter()
                continue
            now = time.perf_counter()
            self.bench.draw(now - last, surface)
            last = now
            self.input.show_cursor()
            self._show_title()
            self.window.swap_buffers()
            time.sleep(max(0.0, SHORTEST_FRAME_SECONDS - (time.perf_counter() - now)))

    def toggle_fullscreen(self) -> None:
        """Fill the screen that the window is mostly on (a projector's, say), or go back."""
        if self._windowed:
            glfw.set_window_monitor(self.handle, None, *self._windowed, 0)  # type: ignore[arg-type]
            self._windowed = None
        else:
            position, size = glfw.get_window_pos(self.handle), glfw.get_window_size(self.handle)
            monitor = _monitor_under(position, size)
            if monitor is None:
                return
            mode = glfw.get_video_mode(monitor)
            self._windowed = (*position, *size)
            glfw.set_window_monitor(self.handle, monitor, 0, 0, mode.size.width, mode.size.height, mode.refresh_rate)
        glfw.swap_interval(1)

    def _surface(self) -> Surface | None:
        """What there is to draw on now; None while the window is minimised or has no area."""
        width, height = glfw.get_window_size(self.handle)
        across, down = glfw.get_framebuffer_size(self.handle)
        if min(width, height, across, down) < 1 or glfw.get_window_attrib(self.handle, glfw.ICONIFIED):
            return None
        ratio = across / width, down / height
        return Surface(self.window.ctx.screen, (width, height), ratio, max(0.5, self._content_scale() / ratio[0]))

    def _content_scale(self) -> float:
        return float(glfw.get_window_content_scale(self.handle)[0]) or 1.0

    def _show_title(self) -> None:
        stage = self.bench.stage
        title = f"{stage.entry.name.replace('_', ' ').capitalize()} – {TITLE}" if stage else TITLE
        if title != self._title:
            self.window.title = self._title = title


def _monitor_under(position: tuple[int, int], size: tuple[int, int]) -> Any:
    """The monitor that holds the middle of a rectangle, or else the primary one."""
    x, y = position[0] + size[0] / 2, position[1] + size[1] / 2
    for monitor in glfw.get_monitors():
        left, top = glfw.get_monitor_pos(monitor)
        mode = glfw.get_video_mode(monitor)
        if left <= x < left + mode.size.width and top <= y < top + mode.size.height:
            return monitor
    return glfw.get_primary_monitor()


def _decoded(text: object) -> str:
    return text.decode("utf-8", "replace") if isinstance(text, bytes) else str(text)

