"""The stage's picture in the middle of the window, and the hand that turns its camera and what it shows."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from viewer.errors import DemoscopeError
from viewer.ui import theme
from viewer.ui.color_scale import draw_color_scale
from viewer.ui.gizmo import Gizmo
from viewer.ui.layout import Box
from viewer.ui.remark_plate import RemarkPlate

if TYPE_CHECKING:
    from viewer.ui.workbench import Workbench

LEFT, RIGHT, MIDDLE = 0, 1, 2
CLICK_EMS = 0.25        # a hand that moves no farther means a click


class PictureView:
    """Shows the finished picture behind all panels; the mouse is the camera's and the scene's wherever no panel is."""

    def __init__(self, bench: Workbench) -> None:
        self.bench = bench
        self._plate = RemarkPlate()
        self._gizmo = Gizmo()
        self._dragging: int | None = None
        self._dragged_to = (0.0, 0.0)
        self._pressed_at: tuple[float, float] | None = None     # while it may still become a click

    @property
    def hand_on_handle(self) -> bool:
        """Whether a hand holds something in the picture."""
        return self._gizmo.held

    def stage_changed(self) -> None:
        """Another stage is on: what the hand held is gone."""
        self._gizmo.let_go()

    def draw(self) -> None:
        """Show the picture, and move the camera or what a hand holds in it."""
        box, stage = self.bench.layout.picture, self.bench.stage
        if not box.shown:
            self._gizmo.let_go()
            return
        behind = imgui.get_background_draw_list()
        corners = imgui.ImVec2(box.x, box.y), imgui.ImVec2(box.x + box.width, box.y + box.height)
        if stage is None:
            behind.add_rect_filled(*corners, imgui.get_color_u32(imgui.ImVec4(*theme.rgb("#101214"))))
            return
        shown = self.bench.session.renderer.lend(stage.picture.texture)
        behind.add_image(shown, *corners, imgui.ImVec2(0, 1), imgui.ImVec2(1, 0))
        self._move_camera()
        self._offer_handle()
        self._take_presses()
        scale = self.bench.live.color_scale() if self.bench.live else None
        if scale:
            draw_color_scale(scale, box, above=bool(self.bench.live and self.bench.live.card_below()))
        if self.bench.remarker and not self.bench.problem:
            self._plate.draw(self.bench.remarker.remarks, box)

    def _move_camera(self) -> None:
        assert self.bench.stage
        io, camera = imgui.get_io(), self.bench.stage.camera
        self._drag(self.bench.layout.picture)
        if self._free():
            if io.mouse_wheel:
                camera.zoom(io.mouse_wheel)
            if imgui.is_mouse_double_clicked(LEFT):
                camera.reset()

    def _offer_handle(self) -> None:
        """Show what a hand can take hold of, as the camera now sees it, and let the scene follow the hand."""
        bench, box = self.bench, self.bench.layout.picture
        assert bench.live and bench.stage
        stage, handle = bench.stage, bench.live.handle()
        middle = bench.live.middle() if handle else None
        if handle is None or middle is None:
            self._gizmo.let_go()
            return
        projection = stage.camera.projection(stage.size[0] / stage.size[1], middle)
        dragged = self._gizmo.draw(handle, stage.camera.view(), projection, box)
        if dragged:
            self._obey(f"drag {handle.name}", lambda: stage.dragged(dragged))

    def _take_presses(self) -> None:
        if self._free():
            for button in (LEFT, RIGHT, MIDDLE):
                if self._dragging is None and imgui.is_mouse_clicked(button):
                    self._press(button)

    def _press(self, button: int) -> None:
        io = imgui.get_io()
        self._dragging, self._dragged_to = button, (io.mouse_pos.x, io.mouse_pos.y)
        plain = button == LEFT and not io.key_mods and not imgui.is_mouse_double_clicked(LEFT)
        self._pressed_at = self._dragged_to if plain else None

    def _drag(self, box: Box) -> None:
        """Follow the mouse since the button went down, up to and including the frame in which it comes up."""
        if self._dragging is None:
            return
        io = imgui.get_io()
        here, (x, y) = (io.mouse_pos.x, io.mouse_pos.y), self._dragged_to
        if self._pressed_at and math.dist(here, self._pressed_at) >= CLICK_EMS * imgui.get_font_size():
            self._pressed_at = None
        if here != (x, y) and not self._pressed_at:     # what may become a click leaves the camera alone
            self._turn((here[0] - x) / box.height, (here[1] - y) / box.height, box)
            self._dragged_to = here
        if not imgui.is_mouse_down(self._dragging):
            self._dragging = None
            if self._pressed_at:
                self._click(*self._pressed_at)

    def _turn(self, right: float, down: float, box: Box) -> None:
        assert self.bench.stage
        camera = self.bench.stage.camera
        if self._dragging != LEFT or imgui.get_io().key_shift:
            camera.pan(right, down, box.width / box.height)
        else:
            camera.drag(right, down)

    def _click(self, x: float, y: float) -> None:
        """Set what the scene takes a click there for, as one step of the history."""
        stage, box = self.bench.stage, self.bench.layout.picture
        assert stage
        width, height = stage.size
        self._obey("click", lambda: stage.clicked((x - box.x) * width / box.width, (y - box.y) * height / box.height))

    def _obey(self, subject: str, ask: Callable[[], Mapping[str, object]]) -> None:
        """Set what the scene takes a hand's doing for; tell if it fails."""
        try:
            values = ask()
            refused = self.bench.change(subject, values) if values else None
        except DemoscopeError as error:
            refused = error
        if refused:
            self.bench.tell(refused)

    def _free(self) -> bool:
        """Whether the mouse is on the picture, and on nothing that lies over it."""
        return not imgui.get_io().want_capture_mouse and not self._gizmo.under_mouse and self._over()

    def _over(self) -> bool:
        box, mouse = self.bench.layout.picture, imgui.get_mouse_pos()
        return box.x <= mouse.x < box.x + box.width and box.y <= mouse.y < box.y + box.height
