"""Rings and arrows over the picture by which a hand turns and moves what a scene offers; ImGuizmo draws them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from imgui_bundle import imgui
from imgui_bundle.imguizmo import im_guizmo

from viewer.engine.annotations import Handle
from viewer.engine.matrices import Matrix
from viewer.ui import theme
from viewer.ui.layout import Box

AXIS_SHARE, AXIS_EMS, AXIS_LIMIT = 0.115, 2.5, 0.3
LINE, ARROW, CENTER, HATCHING = 4.0, 9.0, 5.0, 3.0      # thickness and sizes at a scale of 1
UNDER_MOUSE = 1.6           # how much thicker what the mouse is on is drawn
NEAREST, FARTHEST = 0.01, 1e6       # in clip space, between which ImGuizmo's single precision can tell
OPERATION = im_guizmo.OPERATION
# One after the other, since together rings bring one that faces the eye along and hides those that nearly do.
ARROWS, RINGS = (OPERATION.translate,), (OPERATION.rotate_x, OPERATION.rotate_y, OPERATION.rotate_z)


class Gizmo:
    """Draws a handle where the scene has it, or, while a hand holds it, where the hand does.

    ImGuizmo has one memory for the whole process. Which drag goes on in this window is known here alone: any
    other that ImGuizmo remembers is called off.
    """

    def __init__(self) -> None:
        self._in_hand: Handle | None = None
        self._part: im_guizmo.OPERATION | None = None       # what of it is under the mouse or in the hand

    @property
    def held(self) -> bool:
        """Whether a hand holds it."""
        return self._in_hand is not None

    @property
    def under_mouse(self) -> bool:
        """Whether a press takes hold of it, or has."""
        return self._part is not None

    def let_go(self) -> None:
        """The hand holds nothing any more, and nothing is there that it could take."""
        self._in_hand = self._part = None

    def draw(self, handle: Handle, view: Matrix, projection: Matrix, box: Box) -> Handle | None:
        """Draw ``handle`` over the picture in ``box``; returns it as a hand has just moved it, if one has.

        ``view`` and ``projection`` are the picture's, in the row order that GL reads as columns. A handle of
        another name, or with other rings and arrows, is not the one in the hand.
        """
        if self._in_hand and (_kind(self._in_hand) != _kind(handle) or not imgui.is_mouse_pos_valid()):
            self.let_go()
        if not self._in_hand:
            _call_off()
        shown = self._in_hand or handle
        if not _in_front(shown, view @ projection):
            self.let_go()
            return None
        _begin(box)
        return self._follow(shown, self._manipulated(shown, view, projection))

    def _manipulated(self, shown: Handle, view: Matrix, projection: Matrix) -> Handle:
        """Let ImGuizmo draw ``shown`` and do with it what the mouse does; know what of it the mouse is on."""
        matrix = im_guizmo.Matrix16(shown.matrix.T.ravel().tolist())
        eye = im_guizmo.Matrix16(view.ravel().tolist()), im_guizmo.Matrix16(projection.ravel().tolist())
        parts = shown.moves * ARROWS + shown.turns * RINGS
        was, self._part = self._part, None
        for part in (was,) if self.held and was else parts:
            _set_thickness(LINE * UNDER_MOUSE if part == was and not self.held else LINE)
            im_guizmo.manipulate(*eye, part, im_guizmo.MODE.local, matrix)
            hovered = im_guizmo.get_hovered_handle_type() != im_guizmo.MOVETYPE.mt_none
            if im_guizmo.is_using() or (hovered and self._part is None):
                self._part = part
            if im_guizmo.is_using():
                break       # the others are not drawn meanwhile
        return replace(shown, matrix=np.array(matrix.values, np.float64).reshape(4, 4).T)

    def _follow(self, shown: Handle, moved: Handle) -> Handle | None:
        """Know what is in the hand now; returns ``moved`` if the mouse has moved it."""
        mouse, held = imgui.get_io().mouse_delta, self.held
        went = held and bool(mouse.x or mouse.y) and bool(np.isfinite(moved.matrix).all())
        self._in_hand = (moved if went else shown) if im_guizmo.is_using() else None
        return moved if went and not np.array_equal(shown.matrix, moved.matrix) else None


def axis_length(box: Box, em: float) -> float:
    """How long an arrow to the side is over a picture in ``box``, ``em`` being the text's; rings reach a fifth farther.

    It grows with the picture's shorter side, but holds its own beside large text in a small picture.
    """
    short = min(box.width, box.height)
    return min(max(AXIS_SHARE * short, AXIS_EMS * em), AXIS_LIMIT * short)


def _kind(handle: Handle) -> tuple[str, bool, bool]:
    return handle.name, handle.turns, handle.moves


def _call_off() -> None:
    """Make ImGuizmo forget a drag whose end it has not seen: disabling it does that."""
    im_guizmo.enable(False)
    im_guizmo.enable(True)


def _in_front(handle: Handle, view_projection: Matrix) -> bool:
    """Whether it is in front of the eye, where ImGuizmo would draw it."""
    clip = handle.matrix[:, 3] @ view_projection
    return bool(clip[2] > NEAREST and np.abs(clip).max() < FARTHEST)


def _begin(box: Box) -> None:
    """Tell ImGuizmo where the picture is, to draw over it and behind all panels, and how large."""
    im_guizmo.begin_frame()
    im_guizmo.set_drawlist(imgui.get_background_draw_list())
    im_guizmo.set_rect(box.x, box.y, box.width, box.height)
    im_guizmo.set_orthographic(False)
    im_guizmo.set_gizmo_size_clip_space(2.0 * axis_length(box, imgui.get_font_size()) / max(box.width, box.height))
    style, scale = im_guizmo.get_style(), imgui.get_font_size() / theme.FONT_PIXELS
    style.translation_line_arrow_size, style.center_circle_size = ARROW * scale, CENTER * scale
    style.hatched_axis_line_thickness = HATCHING * scale


def _set_thickness(pixels: float) -> None:
    style, scale = im_guizmo.get_style(), imgui.get_font_size() / theme.FONT_PIXELS
    style.rotation_line_thickness = style.translation_line_thickness = pixels * scale
