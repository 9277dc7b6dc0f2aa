"""A hand that turns and moves what a scene offers, in the picture: how far, and what must not happen meanwhile."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import moderngl
import numpy as np
import pytest
from imgui_bundle import imgui

from viewer.engine.catalog import Catalog
from viewer.engine.stage import Stage
from viewer.ui import theme
from viewer.ui.gizmo import axis_length
from viewer.ui.headless import panels
from viewer.ui.history import History

if TYPE_CHECKING:
    from tests.ui.conftest import Hand

Key = imgui.Key
Place = tuple[float, float]
SCENE = """
import math
import numpy as np
from viewer import Orbit, Parameters, Scene, Studio, integer, slider
from viewer.engine.annotations import Handle

class Dial(Scene):
    \"\"\"Turns about z and moves along x.\"\"\"

    class Params(Parameters):
        angle: float = slider(0.0, -170.0, 170.0, "How far it is turned")
        across: float = slider(0.0, -1.0, 1.0, "Where it stands")
        up: float = slider(0.3, -1.0, 1.0, "How high")
        clicks: int = integer(0, 0, 9, "How many clicks")

    camera = Orbit(yaw=20, pitch=15, distance=5)
    studio = Studio(ground=None)

    def draw(self):
        pass

    def middle(self):
        return MIDDLE

    def click(self, click):
        return {"clicks": self.params.clicks + 1}

    def standing(self):
        angle, matrix = math.radians(self.params.angle), np.eye(4)
        matrix[:2, :2] = [[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]]
        matrix[:3, 3] = self.params.across, self.params.up, 0.0
        return matrix

    def handle(self):
        OFFER

    def drag_handle(self, handle):
        angle = math.degrees(math.atan2(handle.matrix[1, 0], handle.matrix[0, 0]))
        FOLLOW
"""
OFFER = 'return Handle(self.standing(), "dial", moves=True)'
FOLLOW = """across, up = handle.matrix[:2, 3]
        return {"angle": min(170, max(-170, angle)), "across": min(1, max(-1, across)), "up": min(1, max(-1, up))}"""
MakeDial = Callable[..., "Hand"]


@pytest.fixture
def make_dial(make_hand: Callable[..., Hand], pack: Path) -> MakeDial:
    """Opens a scene with a handle; lines of Python say what it offers, how it follows and where the lens points.

    Without ``panels`` the window is smaller, and all picture.
    """

    def make(offer: str = OFFER, follow: str = FOLLOW, middle: str = "0.0, 0.0",
             panels: bool = False, **options: bool) -> Hand:
        source = SCENE.replace("OFFER", offer).replace("FOLLOW", follow).replace("MIDDLE", middle)
        (pack / "scenes" / "dial.py").write_text(source)
        hand = make_hand((1024, 768) if panels else (640, 480), scene="dial", samples=0, **options)
        hand.bench.view.panels = panels
        hand.frames()
        return hand

    return make


def on_screen(hand: Hand, point: object) -> Place:
    """Where in the window a place in the world is seen."""
    stage, box = hand.bench.stage, hand.bench.layout.picture
    clip = np.append(point, 1.0) @ stage.camera.view() @ stage.camera.projection(box.width / box.height, stage.middle)
    across, up = (clip[:2] / clip[3]).tolist()
    return box.x + (across + 1.0) / 2.0 * box.width, box.y + (1.0 - up) / 2.0 * box.height


def size_at(hand: Hand, place: object) -> float:
    """How long an arrow at ``place`` is in the world, from its size on the screen."""
    stage, box = hand.bench.stage, hand.bench.layout.picture
    projection = stage.camera.projection(box.width / box.height)
    depth = -float((np.append(place, 1.0) @ stage.camera.view())[2])
    return axis_length(box, theme.FONT_PIXELS * hand.surface.dpi) * depth / (projection[1, 1] * box.height / 2.0)


def on_ring(hand: Hand, degrees: float, axis: int = 2) -> Place:
    """A place on the ring about one of the handle's axes; 0 degrees are at the next axis."""
    matrix = hand.bench.stage.handle().matrix
    first, second = matrix[:3, (axis + 1) % 3], matrix[:3, (axis + 2) % 3]
    out = np.cos(np.radians(degrees)) * first + np.sin(np.radians(degrees)) * second
    return on_screen(hand, matrix[:3, 3] + 1.2 * size_at(hand, matrix[:3, 3]) * out)


def on_arrow(hand: Hand, axis: int = 0) -> Place:
    """The middle of the arrow along one of the handle's axes."""
    matrix = hand.bench.stage.handle().matrix
    return on_screen(hand, matrix[:3, 3] + 0.6 * size_at(hand, matrix[:3, 3]) * matrix[:3, axis])


def press(hand: Hand, place: Place) -> None:
    hand.point(place)
    hand.frames()
    hand.button(True)


def turn(hand: Hand, start: float, end: float, *, release: bool = True) -> None:
    """Drag along the ring about z, in small steps."""
    way = [on_ring(hand, degrees) for degrees in np.linspace(start, end, 9)]
    press(hand, way[0])
    for place in way[1:]:
        hand.point(place)
    if release:
        hand.button(False)
        hand.frames(2)


def values(hand: Hand) -> tuple[float, float, int]:
    return hand.value("angle"), hand.value("across"), hand.value("clicks")


def undo(hand: Hand) -> None:
    hand.key(Key.left_ctrl, Key.mod_ctrl, Key.z)


# What a drag does

@pytest.mark.parametrize("ends", [(-25.0, 60.0), (65.0, 10.0)])
@pytest.mark.parametrize("middle", ["0.0, 0.0", "0.3, -0.2"])
def test_a_ring_turns_by_as_much_as_the_hand_goes_round(make_dial: MakeDial, ends: Place, middle: str) -> None:
    """Counter-clockwise is positive; the camera stays, no click is made, and one undo brings all back."""
    hand = make_dial(middle=middle)
    look = hand.bench.stage.camera.look
    turn(hand, *ends)
    angle, across, clicks = values(hand)
    assert angle == pytest.approx(ends[1] - ends[0], abs=1.5)
    assert (across, clicks) == (pytest.approx(0.0, abs=1e-5), 0)
    assert hand.bench.stage.camera.look == look
    undo(hand)
    assert values(hand) == (0.0, 0.0, 0)
    assert not hand.bench.history.can_undo


@pytest.mark.parametrize(("units", "ratio", "dpi"), [
    ((1024, 768), 1.0, 2.0), ((512, 384), 2.0, 1.0), ((512, 384), 2.0, 0.75)])
@pytest.mark.parametrize("shown", [True, False])
def test_a_ring_is_where_the_picture_has_it(make_dial: MakeDial, units: tuple[int, int], ratio: float, dpi: float,
                                            shown: bool) -> None:
    """At any scale of the text, on screens with several pixels to a unit, and without panels."""
    hand = make_dial(middle="0.2, 0.1", panels=True)
    hand.bench.view.panels = shown
    hand.surface = dataclasses.replace(hand.surface, size=units, pixel_ratio=(ratio, ratio), dpi=dpi)
    hand.frames(3)
    turn(hand, 30.0, 90.0)
    assert values(hand) == (pytest.approx(60.0, abs=2.5), pytest.approx(0.0, abs=1e-5), 0)


@pytest.mark.parametrize(("angle", "goes"), [(0.0, (0.4, 0.0)), (40.0, (0.306, 0.257))])
def test_an_arrow_moves_by_as_much_as_the_hand_goes(make_dial: MakeDial, angle: float, goes: Place) -> None:
    """Along the handle's own axis, however it is turned."""
    hand = make_dial()
    hand.bench.stage.set(angle=angle)
    start = np.array(on_arrow(hand))
    by = np.array(on_screen(hand, (goes[0], 0.3 + goes[1], 0.0))) - on_screen(hand, (0.0, 0.3, 0.0))
    look = hand.bench.stage.camera.look
    press(hand, tuple(start))
    for share in (0.2, 0.6, 1.0):
        hand.point(tuple(start + share * by))
    assert hand.bench.panels.hand_on_widget, "so that what is costly waits until the hand rests"
    hand.button(False)
    hand.frames(2)
    assert not hand.bench.panels.hand_on_widget
    assert hand.value("across") == pytest.approx(goes[0], abs=0.03)
    assert hand.value("up") == pytest.approx(0.3 + goes[1], abs=0.03)
    assert (hand.value("angle"), hand.value("clicks")) == (pytest.approx(angle, abs=1e-3), 0)
    assert hand.bench.stage.camera.look == look
    undo(hand)
    assert (hand.value("angle"), hand.value("across"), hand.value("up")) == (angle, 0.0, 0.3)


def test_each_drag_is_a_step_of_the_history(make_dial: MakeDial) -> None:
    hand = make_dial()
    turn(hand, 25.0, 65.0)
    first = values(hand)
    turn(hand, 25.0, 45.0)
    assert hand.value("angle") == pytest.approx(60.0, abs=2.5)
    undo(hand)
    assert values(hand) == first
    undo(hand)
    assert values(hand) == (0.0, 0.0, 0)
    assert not hand.bench.history.can_undo


def test_a_hand_beyond_the_limit_finds_back_to_where_it_was(make_dial: MakeDial) -> None:
    """The scene follows as far as it can, and again once the hand comes back so far."""
    hand = make_dial(follow='return {"angle": min(30, max(-30, angle))}')
    way = [on_ring(hand, degrees) for degrees in (20, 40, 70, 100, 70, 40)]
    press(hand, way[0])
    turned = []
    for place in way[1:]:
        hand.point(place)
        turned.append(hand.value("angle"))
    hand.button(False)
    assert turned == pytest.approx([20.0, 30.0, 30.0, 30.0, 20.0], abs=2.0)


def test_a_press_alone_changes_nothing(make_dial: MakeDial) -> None:
    hand = make_dial()
    for place in (on_ring(hand, 30.0), on_arrow(hand)):
        press(hand, place)
        hand.frames(3)
        hand.button(False)
        hand.frames(1, seconds=0.5)
    assert values(hand) == (0.0, 0.0, 0)
    assert not hand.bench.history.can_undo


# The camera and clicks

def test_the_camera_stays_while_the_mouse_is_on_a_handle(make_dial: MakeDial) -> None:
    """Neither the wheel, nor other buttons, nor a double click move it."""
    hand = make_dial()
    camera, place = hand.bench.stage.camera, on_ring(hand, 30.0)
    camera.drag(0.01, 0.0)
    look = camera.look
    place = on_ring(hand, 30.0)
    for button in (1, 2):
        hand.drag(place, (30.0, 0.0), button)
    hand.point(place)
    hand.bench.session.io.add_mouse_wheel_event(0.0, 1.0)
    hand.frames(2)
    for _ in range(2):
        hand.button(True)
        hand.button(False)
    hand.frames(2)
    assert camera.look == look
    assert values(hand) == (0.0, 0.0, 0)


def test_a_handle_that_comes_under_a_mouse_at_rest_is_taken_by_a_press(make_dial: MakeDial) -> None:
    """In the very frame in which it comes there, too; the camera does not take it as well."""
    hand = make_dial()
    hand.bench.stage.set(across=0.4)
    place, further = on_ring(hand, 30.0), on_ring(hand, 60.0)
    hand.bench.stage.set(across=-0.6)
    hand.frames(3)
    hand.point(place)
    look = hand.bench.stage.camera.look
    hand.bench.stage.set(across=0.4)
    hand.button(True)
    hand.point(further)
    hand.button(False)
    assert hand.bench.stage.camera.look == look
    assert values(hand) == (pytest.approx(30.0, abs=2.0), pytest.approx(0.4, abs=1e-5), 0)


def test_beside_a_handle_everything_is_as_without(make_dial: MakeDial) -> None:
    """A drag orbits, across the handle too, a click clicks and the wheel comes closer."""
    hand = make_dial()
    camera, box = hand.bench.stage.camera, hand.bench.layout.picture
    x, y = on_ring(hand, 30.0)
    hand.drag((x, box.y + 30.0), (0.0, 2.0 * (y - box.y - 30.0)))
    assert camera.pitch != camera.start.pitch
    assert values(hand) == (0.0, 0.0, 0)
    hand.frames(1, seconds=0.5)
    hand.click((box.x + 30.0, box.y + box.height - 30.0))
    assert hand.value("clicks") == 1
    hand.bench.session.io.add_mouse_wheel_event(0.0, 1.0)
    hand.frames(2)
    assert camera.distance < camera.start.distance


@pytest.mark.parametrize("offer", ["return None", OFFER.replace("moves=True", "turns=False")])
def test_where_nothing_is_offered_the_mouse_is_the_camera_s(make_dial: MakeDial, offer: str) -> None:
    hand = make_dial(offer)
    hand.drag(on_screen(hand, (0.0, 0.3, 0.0)), (40.0, 0.0))
    assert hand.bench.stage.camera.yaw != hand.bench.stage.camera.start.yaw
    assert values(hand) == (0.0, 0.0, 0)


# A drag that is cut short

def test_a_hand_that_lets_go_over_a_panel_has_let_go(make_dial: MakeDial) -> None:
    """It turns on over panels; after that the mouse may come back and nothing follows it."""
    hand = make_dial(panels=True)
    start = on_ring(hand, 60.0)
    press(hand, start)
    hand.point((60.0, 650.0))
    turned = hand.value("angle")
    assert abs(turned) > 60.0
    hand.button(False)
    hand.frames(2)
    assert not hand.bench.panels.hand_on_widget
    for place in (start, on_screen(hand, (0.0, -0.5, 0.0))):
        hand.point(place)
    assert hand.value("angle") == turned
    undo(hand)
    assert values(hand) == (0.0, 0.0, 0)


def test_a_handle_that_vanishes_is_let_go(make_dial: MakeDial) -> None:
    """The mouse then moves nothing, until it is pressed again."""
    hand = make_dial(f"if self.params.angle > 20.0:\n            return None\n        {OFFER}")
    look = hand.bench.stage.camera.look
    way = [on_ring(hand, degrees) for degrees in (20, 35, 50, 80)]
    press(hand, way[0])
    for place in way[1:]:
        hand.point(place)
    assert hand.value("angle") == pytest.approx(30.0, abs=2.0)
    assert not hand.bench.panels.hand_on_widget
    assert hand.bench.stage.camera.look == look
    hand.button(False)
    hand.frames()
    undo(hand)
    hand.point(way[0])
    assert values(hand) == (0.0, 0.0, 0)


@pytest.mark.parametrize("other", ['"dial", moves=False', '"knob", moves=True'])
def test_another_handle_in_its_place_is_not_in_the_hand(make_dial: MakeDial, other: str) -> None:
    hand = make_dial(f"if self.params.angle > 20.0:\n            return Handle(self.standing(), {other})\n"
                     f"        {OFFER}")
    turn(hand, 25.0, 105.0, release=False)
    assert 20.0 < hand.value("angle") < 32.0


def test_another_scene_is_not_turned_by_the_same_drag(make_dial: MakeDial) -> None:
    """Though its handle has the same name and stands in the same place."""
    hand = make_dial()
    turn(hand, 25.0, 65.0, release=False)
    hand.bench.choose("dial")
    hand.frames()
    camera = hand.bench.stage.camera
    for degrees in (50.0, 70.0):
        hand.point(on_ring(hand, degrees))
    assert values(hand) == (0.0, 0.0, 0)
    assert camera.look == camera.__class__(camera.start).look
    hand.button(False)
    turn(hand, 25.0, 65.0)
    assert hand.value("angle") == pytest.approx(40.0, abs=2.0)


def test_a_window_without_room_lets_go(make_dial: MakeDial) -> None:
    """Whether the button comes up meanwhile or later, the picture comes back as it was."""
    hand = make_dial()
    surface = hand.surface
    for released_first in (True, False):
        turn(hand, 25.0, 45.0, release=False)
        turned = hand.value("angle")
        hand.surface = dataclasses.replace(surface, size=(0, 0))
        hand.frames(2)
        if released_first:
            hand.button(False)
        hand.surface = surface
        hand.frames(2)
        hand.point(on_ring(hand, 60.0))
        hand.button(False)
        hand.frames(2)
        assert hand.value("angle") == turned
    assert turned == pytest.approx(40.0, abs=2.5)


def test_a_drag_in_one_window_turns_nothing_in_another(make_dial: MakeDial) -> None:
    """ImGuizmo remembers one drag for all of them."""
    first, second = make_dial(), make_dial()
    turn(first, 25.0, 65.0, release=False)
    for degrees in (0.0, 30.0, 60.0):
        second.point(on_ring(second, degrees))
    assert values(second) == (0.0, 0.0, 0)
    first.button(False)
    turn(second, 25.0, 65.0)
    assert second.value("angle") == pytest.approx(40.0, abs=2.0)


# Mistakes

@pytest.mark.parametrize(("offer", "message"), [
    ("return Handle(np.eye(3), 'dial')", "ValueError: handle dial has a matrix of shape (3, 3)"),
    ("return self.standing()", "TypeError: handle gives neither a Handle nor None"),
    ("raise KeyError('bone')", "dial.py:36: KeyError: 'bone'"),
])
def test_a_handle_that_fails_is_told_until_it_is_mended(make_dial: MakeDial, offer: str, message: str) -> None:
    """The window, its clicks and its camera go on."""
    hand = make_dial(f"if self.params.across > 0.5:\n            {offer}\n        {OFFER}")
    assert hand.bench.problem is None
    hand.bench.change("across", {"across": 0.9})
    hand.frames(3)
    problem = hand.bench.live.problem
    assert problem.text.startswith("dial failed in handle: ") and message in problem.text
    assert "\n" not in problem.text
    camera, box = hand.bench.stage.camera, hand.bench.layout.picture
    hand.click((box.x + 30.0, box.y + box.height - 30.0))
    hand.drag(on_screen(hand, (0.9, 0.3, 0.0)), (40.0, 0.0))
    assert hand.value("clicks") == 1 and camera.yaw != camera.start.yaw
    assert hand.bench.live.problem
    hand.bench.change("across", {"across": 0.0})
    hand.frames(3)
    assert hand.bench.problem is None
    camera.reset()
    hand.frames(3)
    turn(hand, 25.0, 65.0)
    assert hand.value("angle") == pytest.approx(40.0, abs=2.0)


def test_a_middle_that_fails_beside_a_handle_is_told(make_dial: MakeDial) -> None:
    hand = make_dial(middle="1 / 0")
    hand.point((500.0, 300.0))
    hand.frames(3)
    assert hand.bench.live.problem.text.startswith("dial failed in middle")


@pytest.mark.parametrize(("follow", "message"), [
    ('return {"angle": 900.0}', "angle = 900"), ('return {"angel": 9.0}', "unknown parameter angel"),
    ("return 3", "dial failed in drag_handle: "),
    ("raise ValueError('stiff')", "dial failed in drag_handle: dial.py:39: ValueError: stiff")])
def test_a_drag_that_fails_is_told_and_changes_nothing(make_dial: MakeDial, follow: str, message: str) -> None:
    hand = make_dial(follow=follow)
    look = hand.bench.stage.camera.look
    turn(hand, 25.0, 65.0)
    assert hand.bench.notice.text.startswith(message)
    assert values(hand) == (0.0, 0.0, 0)
    assert not hand.bench.history.can_undo
    assert hand.bench.stage.camera.look == look


def test_a_scene_may_take_no_notice(make_dial: MakeDial) -> None:
    hand = make_dial(follow="return {}")
    turn(hand, 25.0, 65.0)
    assert hand.bench.problem is None
    assert not hand.bench.history.can_undo


@pytest.mark.parametrize("place", ["(0.0, 0.0, 50.0)", "camera_eye", "(1e30, 0.0, 0.0)", "(0.0, 0.0, -1e7)"])
def test_a_handle_that_cannot_be_seen_does_no_harm(make_dial: MakeDial, place: str) -> None:
    """Behind the eye, in it, or farther away than numbers go: nothing is drawn, and nothing can be held."""
    eye = "5 * np.array([math.sin(math.radians(20)) * math.cos(math.radians(15)), math.sin(math.radians(15)), " \
          "math.cos(math.radians(20)) * math.cos(math.radians(15))])"
    hand = make_dial(f"matrix = self.standing()\n        matrix[:3, 3] = {place.replace('camera_eye', eye)}\n"
                     "        return Handle(matrix, moves=True)", steady=True)
    assert np.array_equal(hand.pixels(), make_dial("return None", steady=True).pixels())
    box = hand.bench.layout.picture
    hand.drag((box.x + box.width / 2, box.y + box.height / 2), (40.0, 20.0))
    assert hand.bench.problem is None
    assert hand.bench.stage.camera.yaw != hand.bench.stage.camera.start.yaw
    assert values(hand) == (0.0, 0.0, 0)


# The picture

def test_a_handle_is_drawn_over_the_picture_and_under_what_lies_on_it(make_dial: MakeDial) -> None:
    """One that stands in the picture's upper corner reaches neither out of it nor over a message there."""
    windows = []
    for offer in (OFFER, "return None"):
        hand = make_dial(offer, steady=True, panels=True)
        box = hand.bench.layout.picture
        hand.bench.tell(ValueError("not here"))
        x, y = on_screen(hand, (0.0, 0.3, 0.0))
        hand.bench.stage.camera.pan((box.x - x + 5.0) / box.height, (box.y - y + 5.0) / box.height,
                                    box.width / box.height)
        hand.frames(4)
        windows.append(hand.pixels())
    left, top = round(box.x), round(box.y)
    differs = (windows[0] != windows[1]).any(axis=2)
    assert differs[top:top + 8, left:left + 80].any() and differs[top + 20:top + 80, left:left + 5].any()
    assert not differs[:top].any() and not differs[:, :left].any()
    plate = slice(top + 12, top + 30), slice(left + 12, left + 100)
    assert windows[1][plate][0, 0, :3].tolist() == [round(255 * part) for part in theme.WARNING_DEEP[:3]]
    assert not differs[plate].any()


def test_a_capture_with_panels_shows_it_each_time_alike(context: moderngl.Context, make_dial: MakeDial,
                                                        pack: Path) -> None:
    """Whatever another window has in its hand."""
    turn(make_dial(), 25.0, 65.0, release=False)
    catalog, pictures = Catalog([pack]), []
    for _ in range(2):
        stage = Stage(context, catalog.find("dial"), size=(800, 600))
        drawn = panels(stage, catalog)
        pictures.append(drawn.pixels())
        box = drawn.bench.layout.picture
        drawn.release()
        stage.release()
    assert np.array_equal(*pictures)
    x, y, width, height = (round(number) for number in (box.x, box.y, box.width, box.height))
    red, green, blue = (pictures[0][y:y + height, x:x + width, channel].astype(int) for channel in range(3))
    for strong, weak, faint in ((red, green, blue), (green, red, blue), (blue, red, green)):
        assert ((strong > 140) & (weak < 30) & (faint < 30)).sum() > 50, "each ring has its colour"


def test_a_hand_that_passes_where_it_began_melts_into_nothing_earlier() -> None:
    """A drag against a slider's end and back is taken back alone, not with the drag before."""
    history = History()
    history.record("drag", {"angle": 0.0}, {"angle": 1.0})
    history.settle()
    for before, after in ((1.0, 2.0), (2.0, 1.0), (1.0, 0.5), (0.5, 0.25)):
        history.record("drag", {"angle": before}, {"angle": after})
    assert history.undo() == {"angle": 1.0}
    assert history.undo() == {"angle": 0.0}
    assert not history.can_undo
