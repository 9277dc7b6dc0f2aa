"""Clicks on the picture: where they land, what they set, and what is no click."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from imgui_bundle import imgui

if TYPE_CHECKING:
    from tests.ui.conftest import Hand

Key = imgui.Key
SCENE = """
from viewer import Parameters, Scene, Studio, integer, slider

class Spots(Scene):
    \"\"\"Tells where it was clicked.\"\"\"

    class Params(Parameters):
        across: float = slider(0.0, -1.0, 1.0, "From left to right")
        up: float = slider(0.0, -1.0, 1.0, "From bottom to top")
        clicks: int = integer(0, 0, 9, "How many clicks")

    studio = Studio(ground=None)

    def draw(self):
        pass

    def click(self, click):
        CLICK
"""
WELL = 'return {"across": click.place[0], "up": click.place[1], "clicks": self.params.clicks + 1}'


@pytest.fixture
def make_spots(make_hand: Callable[..., Hand], pack: Path) -> Callable[..., Hand]:
    """Opens a scene that takes clicks, and does with them what a line of Python says."""

    def make(statement: str = WELL, size: tuple[int, int] = (1024, 768)) -> Hand:
        (pack / "scenes" / "spots.py").write_text(SCENE.replace("CLICK", statement))
        return make_hand(size, scene="spots")

    return make


def place(hand: Hand, across: float, down: float) -> tuple[float, float]:
    """A place in the window, from the shares of the picture's width and height."""
    box = hand.bench.layout.picture
    return round(box.x + across * box.width), round(box.y + down * box.height)


def values(hand: Hand) -> tuple[float, float, int]:
    return hand.value("across"), hand.value("up"), hand.value("clicks")


@pytest.mark.parametrize(("units", "ratio", "dpi"), [
    ((1024, 768), 1.0, 1.0), ((1024, 768), 1.0, 2.0), ((512, 384), 2.0, 1.0), ((512, 384), 2.0, 0.75)])
def test_a_click_lands_where_the_mouse_is(make_spots: Callable[..., Hand], units: tuple[int, int], ratio: float,
                                          dpi: float) -> None:
    """At any scale of the text, and on screens with several pixels to a unit."""
    hand = make_spots()
    hand.surface = dataclasses.replace(hand.surface, size=units, pixel_ratio=(ratio, ratio), dpi=dpi)
    hand.frames(3)
    box = hand.bench.layout.picture
    assert hand.bench.stage.size == (round(box.width * ratio), round(box.height * ratio))
    spot = place(hand, 0.3, 0.6)
    hand.click(spot)
    expected = 2 * (spot[0] - box.x) / box.width - 1, 1 - 2 * (spot[1] - box.y) / box.height, 1
    assert values(hand) == pytest.approx(expected, abs=1e-6)


def test_a_click_is_one_step_of_the_history(make_spots: Callable[..., Hand]) -> None:
    hand = make_spots()
    hand.click(place(hand, 0.3, 0.6))
    first = values(hand)
    hand.frames(30)
    hand.click(place(hand, 0.7, 0.6))
    assert hand.value("clicks") == 2
    hand.key(Key.left_ctrl, Key.mod_ctrl, Key.z)
    assert values(hand) == first
    hand.key(Key.left_ctrl, Key.mod_ctrl, Key.z)
    assert values(hand) == (0.0, 0.0, 0)
    assert not hand.bench.history.can_undo


def test_a_drag_is_no_click_and_a_click_is_no_drag(make_spots: Callable[..., Hand]) -> None:
    """A hand that trembles by a pixel or two clicks, and leaves the camera where it is."""
    hand = make_spots()
    camera = hand.bench.stage.camera
    hand.drag(place(hand, 0.5, 0.5), (50.0, 20.0))
    assert hand.value("clicks") == 0
    yaw = camera.yaw
    assert yaw != camera.start.yaw
    hand.frames(30)
    hand.drag(place(hand, 0.5, 0.5), (2.0, 1.0))
    assert (hand.value("clicks"), camera.yaw) == (1, yaw)
    hand.frames(30)
    hand.point(place(hand, 0.5, 0.5))
    hand.button(True)
    hand.point(place(hand, 0.6, 0.5))
    hand.point(place(hand, 0.5, 0.5))
    hand.button(False)
    assert hand.value("clicks") == 1, "back at where it began, but it was a drag"
    assert camera.yaw == pytest.approx(yaw)


def test_a_drag_turns_the_camera_by_its_whole_length(make_spots: Callable[..., Hand]) -> None:
    """The first pixels, which might have become a click, are not lost."""
    hand = make_spots()
    camera = hand.bench.stage.camera
    hand.drag(place(hand, 0.4, 0.5), (120.0, 0.0))
    turned = camera.yaw - camera.start.yaw
    camera.reset()
    hand.point(place(hand, 0.4, 0.5))
    start = hand.bench.session.io.mouse_pos.x
    hand.frames(30)
    hand.button(True)
    for pixel in range(1, 121):
        hand.point((start + pixel, hand.bench.session.io.mouse_pos.y))
    hand.button(False)
    assert camera.yaw - camera.start.yaw == pytest.approx(turned)


def test_what_is_no_click(make_spots: Callable[..., Hand]) -> None:
    """Other buttons, modifiers, panels, and a press that began or ended elsewhere."""
    hand = make_spots()
    middle = place(hand, 0.5, 0.5)
    for number in (1, 2):
        hand.drag(middle, (0.0, 0.0), number)
    hand.bench.session.io.add_key_event(Key.mod_shift, True)
    hand.click(middle)
    hand.bench.session.io.add_key_event(Key.mod_shift, False)
    hand.click((60.0, 600.0))
    hand.point((60.0, 600.0))
    hand.button(True)
    hand.point(middle)
    hand.button(False)
    assert hand.value("clicks") == 0


def test_a_double_click_resets_the_camera_and_clicks_once(make_spots: Callable[..., Hand]) -> None:
    hand = make_spots()
    camera = hand.bench.stage.camera
    hand.drag(place(hand, 0.5, 0.5), (50.0, 20.0))
    hand.frames(30)
    for _ in range(2):
        hand.button(True)
        hand.button(False)
    assert camera.yaw == camera.start.yaw
    assert hand.value("clicks") == 1


@pytest.mark.parametrize(("statement", "message"), [
    ("return {'across': 9}", "across = 9 is outside -1 to 1"),
    ("return {'acros': 0.5}", "unknown parameter acros; did you mean across?"),
    ("return 3", "spots failed in click: "),
    ("raise ValueError('nothing there')", "spots failed in click: spots.py:18: ValueError: nothing there"),
])
def test_a_click_that_fails_is_told(make_spots: Callable[..., Hand], statement: str, message: str) -> None:
    hand = make_spots(statement)
    hand.click(place(hand, 0.5, 0.5))
    assert hand.bench.notice.text.startswith(message)
    assert values(hand) == (0.0, 0.0, 0)
    assert not hand.bench.history.can_undo


def test_a_scene_may_take_no_notice(make_spots: Callable[..., Hand]) -> None:
    hand = make_spots("return {}")
    hand.click(place(hand, 0.5, 0.5))
    assert hand.bench.notice is None
    assert not hand.bench.history.can_undo
