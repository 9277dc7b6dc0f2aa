"""One ImGui and one ImPlot context with our fonts, our renderer and no file on disk.

Several sessions live side by side (a window, a capture, a test): each makes itself current first.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import moderngl
from imgui_bundle import imgui, implot

from viewer.ui import theme
from viewer.ui.imgui_renderer import ImguiRenderer


@dataclass(frozen=True)
class Surface:
    """What panels are drawn on: a framebuffer, its size in the window system's units, and densities.

    ``pixel_ratio`` is framebuffer pixels per unit (2 on a Retina screen); ``dpi`` how much larger
    than usual a unit's worth of text has to be (1.5 on Windows at 150 %).
    """

    target: moderngl.Framebuffer
    size: tuple[int, int]
    pixel_ratio: tuple[float, float] = (1.0, 1.0)
    dpi: float = 1.0


class ImguiSession:
    """Owns the contexts; ``frame`` runs one frame from input to draw data, whatever happens in it."""

    def __init__(self, context: moderngl.Context) -> None:
        self._imgui = imgui.create_context()
        self._implot = implot.create_context()
        self.touched = False
        self.make_current()
        self._configure()
        self.fonts = theme.load_fonts()
        self.renderer = ImguiRenderer(context)
        self._dressed: tuple[float, float] | None = None

    @property
    def io(self) -> imgui.IO:
        """Where input events go in; whoever asks for it is taken to have one."""
        self.touched = True
        self.make_current()
        return imgui.get_io()

    def make_current(self) -> None:
        """Let every ImGui call from now on mean this session."""
        imgui.set_current_context(self._imgui)
        implot.set_imgui_context(self._imgui)
        implot.set_current_context(self._implot)

    def frame(self, surface: Surface, seconds: float, scale: float, draw: Callable[[], None]) -> None:
        """Run ``draw`` as one frame of ImGui's and send the result to the GPU; ``paint`` shows it."""
        self.make_current()
        self.touched = False
        io = imgui.get_io()
        if self._dressed != (scale, surface.dpi):
            theme.apply(scale, surface.dpi)
            self._dressed = (scale, surface.dpi)
        io.display_size = imgui.ImVec2(*surface.size)
        io.display_framebuffer_scale = imgui.ImVec2(*surface.pixel_ratio)
        io.delta_time = max(seconds, 1e-5)
        self.renderer.forget_lent()
        imgui.new_frame()
        try:
            draw()
        finally:
            imgui.render()
        self.renderer.prepare(imgui.get_draw_data())

    def paint(self, target: moderngl.Framebuffer) -> None:
        """Draw the last frame's panels over ``target``."""
        self.make_current()
        self.renderer.draw(target)

    def release(self) -> None:
        """Free everything on the GPU and both contexts."""
        self.make_current()
        self.renderer.release()
        implot.destroy_context(self._implot)
        imgui.destroy_context(self._imgui)

    @staticmethod
    def _configure() -> None:
        io = imgui.get_io()
        io.set_ini_filename("")
        io.set_log_filename("")
        io.config_error_recovery_enable_assert = False
        io.config_error_recovery_enable_debug_log = True   # ImGui insists on one way of telling; this one is silent:
        imgui.get_current_context().debug_log_flags = 0
        io.config_error_recovery_enable_tooltip = False
        io.config_windows_move_from_title_bar_only = True
        io.config_input_text_cursor_blink = False   # idle frames stay the same to the bit
