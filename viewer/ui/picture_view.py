"""The stage's picture in the middle of the window, and the hand that turns its camera."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import imgui

from viewer.ui import theme
from viewer.ui.color_scale import draw_color_scale
from viewer.ui.layout import Box

if TYPE_CHECKING:
    from viewer.ui.workbench import Workbench

LEFT, RIGHT, MIDDLE = 0, 1, 2


class PictureView:
    """Shows the finished picture behind all panels; the mouse is the camera's wherever no panel is."""

    def __init__(self, bench: Workbench) -> None:
        self.bench = bench
        self._dragging: int | None = None

    def draw(self) -> None:
        """Show the picture and move the camera."""
        box, stage = self.bench.layout.picture, self.bench.stage
        if not box.shown:
            return
        behind = imgui.get_background_draw_list()
        corners = imgui.ImVec2(box.x, box.y), imgui.ImVec2(box.x + box.width, box.y + box.height)
        if stage is None:
            behind.add_rect_filled(*corners, imgui.get_color_u32(imgui.ImVec4(*theme.rgb("#101214"))))
            return
        shown = self.bench.session.renderer.lend(stage.picture.texture)
        behind.add_image(shown, *corners, imgui.ImVec2(0, 1), imgui.ImVec2(1, 0))
        scale = self.bench.live.color_scale() if self.bench.live else None
        if scale:
            draw_color_scale(scale, box)
        self._move_camera()

    def _move_camera(self) -> None:
        assert self.bench.stage
        io, camera = imgui.get_io(), self.bench.stage.camera
        self._drag(self.bench.layout.picture)
        if not io.want_capture_mouse and self._over():
            if io.mouse_wheel:
                camera.zoom(io.mouse_wheel)
            if imgui.is_mouse_double_clicked(LEFT):
                camera.reset()
            for button in (LEFT, RIGHT, MIDDLE):
                if self._dragging is None and imgui.is_mouse_clicked(button):
                    self._dragging = button

    def _drag(self, box: Box) -> None:
        """Follow the mouse since the button went down, up to and including the frame in which it comes up."""
        if self._dragging is None:
            return
        assert self.bench.stage
        io, camera = imgui.get_io(), self.bench.stage.camera
        if io.mouse_delta.x or io.mouse_delta.y:
            right, down = io.mouse_delta.x / box.height, io.mouse_delta.y / box.height
            if self._dragging != LEFT or io.key_shift:
                camera.pan(right, down, box.width / box.height)
            else:
                camera.drag(right, down)
        if not imgui.is_mouse_down(self._dragging):
            self._dragging = None

    def _over(self) -> bool:
        box, mouse = self.bench.layout.picture, imgui.get_mouse_pos()
        return box.x <= mouse.x < box.x + box.width and box.y <= mouse.y < box.y + box.height
