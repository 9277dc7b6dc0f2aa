"""Our renderer: the same picture for the same input, and nothing left behind."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import moderngl
import numpy as np
from imgui_bundle import imgui

from tests.ui.conftest import free, left_over
from viewer.ui.imgui_session import ImguiSession, Surface

if TYPE_CHECKING:
    from tests.ui.conftest import Hand


def draw_text(session: ImguiSession, surface: Surface, text: str, size: float = 20.0) -> bytes:
    def draw() -> None:
        imgui.set_next_window_pos(imgui.ImVec2(0, 0))
        imgui.set_next_window_size(imgui.ImVec2(320, 200))
        imgui.begin("text", None, imgui.WindowFlags_.no_decoration)
        imgui.push_font(session.fonts.regular, size)
        imgui.text_unformatted(text)
        imgui.pop_font()
        imgui.end()

    session.frame(surface, 1 / 60, 1.0, draw)
    surface.target.clear()
    session.paint(surface.target)
    return bytes(surface.target.read(components=4))


def test_textures_come_grow_and_go(context: moderngl.Context) -> None:
    left_over(context)
    target = context.framebuffer([context.renderbuffer((320, 200), 4)])
    session, surface = ImguiSession(context), Surface(target, (320, 200))
    first = draw_text(session, surface, "a")
    assert len(session.renderer._textures) == 1
    assert np.frombuffer(first, np.uint8).max() > 200
    for size in range(12, 90, 3):   # enough glyphs that the atlas has to grow
        draw_text(session, surface, "The quick brown fox jumps over the lazy dog 0123456789", size)
    for _ in range(4):
        draw_text(session, surface, "a")
    assert draw_text(session, surface, "a") == draw_text(session, surface, "a")
    made = list(session.renderer._textures.values())
    session.release()
    assert all(isinstance(texture.mglo, moderngl.mgl.InvalidObject) for texture in made)
    assert not session.renderer._textures
    free(target)
    del session, surface, target
    assert left_over(context) == []
    assert context.error == "GL_NO_ERROR"


def test_idle_frames_are_the_same_to_the_bit(make_hand: Callable[..., Hand]) -> None:
    hand = make_hand(steady=True)
    hand.frames(4)
    first = hand.pixels()
    hand.frames(5)
    assert np.array_equal(hand.pixels(), first)


def test_two_sessions_do_not_disturb_each_other(make_hand: Callable[..., Hand]) -> None:
    one, other = make_hand(steady=True), make_hand((640, 360), steady=True)
    other.frames(4)
    one.frames(4)
    before = one.pixels()
    other.frames(3)
    one.frames(2)
    assert np.array_equal(one.pixels(), before)


def test_a_retina_screen_gets_twice_the_pixels(make_hand: Callable[..., Hand], context: moderngl.Context) -> None:
    hand = make_hand()
    usual_surface = hand.surface
    target = context.framebuffer([context.renderbuffer((2048, 1536), 4)])
    hand.surface = Surface(target, (1024, 768), (2.0, 2.0), 1.0)
    usual = hand.bench.stage.size
    hand.frames(3)
    assert hand.bench.stage.size == (2 * usual[0], 2 * usual[1])
    assert hand.pixels().shape == (1536, 2048, 4)
    free(target)
    hand.surface = usual_surface
