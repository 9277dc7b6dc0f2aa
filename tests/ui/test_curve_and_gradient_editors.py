"""The editors of curves and gradients, by hand: points and stops added, moved, recoloured, removed, taken back."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from imgui_bundle import imgui

from viewer.engine.life_fields import LifeCurveField
from viewer.engine.presets import load_preset, save_preset
from viewer.kit.gradient import Gradient
from viewer.kit.life_curve import MOST_POINTS, LifeCurve
from viewer.ui import curve_editor, gradient_editor
from viewer.ui.curve_axis import fitted_top
from viewer.ui.widgets import explain

if TYPE_CHECKING:
    from tests.ui.conftest import Hand

Key = imgui.Key
SCENE = '''
from viewer import Parameters, Scene, Studio, curve, gradient, slider, toggle

class Ember(Scene):
    """Something that glows and fades."""

    class Params(Parameters):
        glow = gradient("0:#ffffff, 0.5:#ff8800, 1:#300000", "Its colour")
        size = curve("0:0, 0.25:1, 1:0", 0.0, 1.0, "Its size", unit="m")
        shown: bool = toggle(False, "Whether it shows")
        spin = curve("0.5", -2.0, 2.0, "How fast it spins", when="shown")
        fog = gradient("#808890", "Colour of the fog")
        last: float = slider(0.0, 0.0, 1.0, "The last one")

    studio = Studio(ground=None)

    def draw(self):
        pass
'''
CINDER = '''
from viewer import Parameters, Scene, Studio, curve, interval

class Cinder(Scene):
    """Something that turns."""

    class Params(Parameters):
        girth = curve("0:0.8, 0.5:1, 1:1", 0.0, 4.0, "Its girth")
        turn = interval((0.0, 90.0), 0.0, 720.0, "How fast it turns", unit="degrees/s")
        wait = interval((0.0, 1.0), 0.0, 2.0, "How long it waits", unit="s")

    studio = Studio(ground=None)

    def draw(self):
        pass
'''
START = "0:0, 0.25:1, 1:0"
PIXEL = 0.025       # of a curve's range, at most: ImGui cuts the mouse to whole pixels
COLORS = "0:#ffffff, 0.5:#ff8800, 1:#300000"


@pytest.fixture
def make_ember(make_hand: Callable[..., Hand], pack: Path) -> Callable[..., Hand]:
    """Opens a scene with curves and gradients."""
    (pack / "scenes" / "ember.py").write_text(SCENE)
    return lambda **options: make_hand(scene="ember", **options)


@pytest.fixture
def hand(make_ember: Callable[..., Hand]) -> Hand:
    """That scene in a window of 1024x768."""
    return make_ember()


@pytest.fixture
def cinder(make_hand: Callable[..., Hand], pack: Path) -> Hand:
    """A scene with a curve that may go much higher than it does, and ranges."""
    (pack / "scenes" / "cinder.py").write_text(CINDER)
    return make_hand(scene="cinder")


def em(hand: Hand) -> float:
    return hand.bench.panels.text_metrics()[0]


def on_plot(hand: Hand, x: float, y: float, name: str = "size", low: float = 0.0,
            high: float = 1.0) -> tuple[float, float]:
    """A point of a curve's range in the window."""
    left, top, right, bottom = hand.places[name]
    margin = curve_editor.MARGIN_EMS * em(hand)
    share = (high - y) / (high - low)
    return left + margin + x * (right - left - 2 * margin), top + margin + share * (bottom - top - 2 * margin)


def on_bar(hand: Hand, position: float, name: str = "glow") -> tuple[float, float]:
    """A place on a gradient's bar."""
    left, top, right, _ = hand.places[name]
    inset = 0.5 * gradient_editor.HANDLE_EMS * em(hand)
    return left + inset + position * (right - left - 2 * inset), top + 0.5 * em(hand)


def on_handle(hand: Hand, position: float, name: str = "glow") -> tuple[float, float]:
    """A place on the handle of a stop."""
    return on_bar(hand, position, name)[0], hand.places[name][3] - 0.5 * em(hand)


def right_click(hand: Hand, place: tuple[float, float]) -> None:
    hand.point(place)
    hand.button(True, 1)
    hand.button(False, 1)
    hand.frames(2)


def undo(hand: Hand) -> None:
    hand.key(Key.left_ctrl, Key.mod_ctrl, Key.z)


def rest(hand: Hand) -> None:
    """Let the time of a double click pass."""
    hand.frames(30)


def test_both_stand_across_the_whole_panel_under_their_labels(make_ember: Callable[..., Hand]) -> None:
    hand = make_ember(size=(1024, 960))         # all rows are in sight
    left, _, right, _ = hand.places["glow"]
    assert hand.places["last"][0] > left + 0.3 * (right - left), "a slider stands beside its label"
    assert hand.places["last"][2] == pytest.approx(right, abs=1.0)
    assert hand.places["size"][2] == pytest.approx(right, abs=1.0)
    assert hand.places["size"][3] - hand.places["size"][1] == pytest.approx(5.0 * em(hand), abs=1.0)


# Curves

def test_a_drag_moves_a_point_and_is_one_entry_of_the_history(hand: Hand) -> None:
    start, end = on_plot(hand, 0.25, 1.0), on_plot(hand, 0.6, 0.5)
    hand.drag(start, (end[0] - start[0], end[1] - start[1]))
    (first, moved, last) = hand.value("size").points
    assert (first, last) == ((0.0, 0.0), (1.0, 0.0))
    assert moved == pytest.approx((0.6, 0.5), abs=PIXEL)
    undo(hand)
    assert str(hand.value("size")) == START
    assert not hand.bench.history.can_undo


def test_a_point_stays_between_its_neighbours_and_within_the_limits(hand: Hand) -> None:
    hand.drag(on_plot(hand, 0.25, 1.0), (2000.0, 900.0))
    assert hand.value("size").points == ((0.0, 0.0), (0.999, 0.0), (1.0, 0.0))
    undo(hand)
    hand.drag(on_plot(hand, 0.0, 0.0), (900.0, -900.0))
    assert hand.value("size").points == ((0.249, 1.0), (0.25, 1.0), (1.0, 0.0))


def test_a_click_on_the_curve_adds_a_point_of_it(hand: Hand) -> None:
    before = hand.value("size")
    height = float(before(0.7))
    hand.click(on_plot(hand, 0.7, height + 0.02))
    after = hand.value("size").points
    assert len(after) == 4
    assert after[2] == pytest.approx((0.7, height), abs=PIXEL)
    undo(hand)
    assert hand.value("size") == before


def test_a_click_beside_the_curve_adds_a_point_there_which_the_same_press_can_drag(hand: Hand) -> None:
    start, end = on_plot(hand, 0.7, 0.95), on_plot(hand, 0.8, 0.7)
    hand.click(start)
    assert hand.value("size").points[2] == pytest.approx((0.7, 0.95), abs=PIXEL)
    undo(hand)
    rest(hand)
    hand.drag(start, (end[0] - start[0], end[1] - start[1]))
    assert hand.value("size").points[2] == pytest.approx((0.8, 0.7), abs=PIXEL)
    undo(hand)
    assert str(hand.value("size")) == START


def test_a_right_click_and_a_double_click_remove_a_point_but_never_the_last(hand: Hand) -> None:
    right_click(hand, on_plot(hand, 0.25, 1.0))
    assert str(hand.value("size")) == "0:0, 1:0"
    hand.click(on_plot(hand, 1.0, 0.0))
    assert str(hand.value("size")) == "0:0, 1:0"
    hand.click(on_plot(hand, 1.0, 0.0))
    assert str(hand.value("size")) == "0:0"
    rest(hand)
    right_click(hand, on_plot(hand, 0.0, 0.0))
    hand.click(on_plot(hand, 0.0, 0.0))
    hand.click(on_plot(hand, 0.0, 0.0))
    assert str(hand.value("size")) == "0:0"
    for expected in ("0:0, 1:0", START):
        undo(hand)
        assert str(hand.value("size")) == expected


def test_a_double_click_beside_the_curve_leaves_the_point_that_it_made(hand: Hand) -> None:
    hand.click(on_plot(hand, 0.7, 0.95))
    hand.click(on_plot(hand, 0.7, 0.95))
    assert len(hand.value("size").points) == 4


def test_a_press_without_a_move_changes_nothing(hand: Hand) -> None:
    x, y = on_plot(hand, 0.25, 1.0)
    hand.click((x + 3.0, y + 3.0))
    assert str(hand.value("size")) == START
    assert not hand.bench.history.can_undo


def test_no_more_points_than_a_curve_holds(hand: Hand) -> None:
    full = LifeCurve(tuple((index / 15, 0.0) for index in range(MOST_POINTS)))
    hand.bench.change("size", {"size": full})
    hand.frames(2)
    hand.click(on_plot(hand, 0.5, 0.9))
    assert hand.value("size") == full


def test_what_has_no_effect_cannot_be_changed_by_hand(hand: Hand) -> None:
    centre = on_plot(hand, 0.3, 1.0, "spin", -2.0, 2.0)
    hand.click(centre)
    right_click(hand, centre)
    assert str(hand.value("spin")) == "0:0.5"
    hand.bench.change("shown", {"shown": True})
    hand.frames(2)
    hand.click(on_plot(hand, 0.5, -1.0, "spin", -2.0, 2.0))
    assert hand.value("spin").points[1] == pytest.approx((0.5, -1.0), abs=4 * PIXEL)


def test_the_curve_shows(hand: Hand) -> None:
    def column(x: float) -> np.ndarray[Any, Any]:
        at = round(on_plot(hand, x, 0.0)[0])
        top, bottom = (round(hand.places["size"][index]) for index in (1, 3))
        return hand.pixels()[top:bottom, at].astype(int)

    hand.bench.change("size", {"size": "0:0.5"})
    hand.point((600.0, 300.0))
    pixels = column(0.65)
    blue = pixels[:, 2] - pixels[:, 0]
    assert abs(int(np.argmax(blue)) / len(blue) - 1 / 3) < 0.06, "the axis ends at 0.75"
    assert blue[int(0.75 * len(blue))] > blue[int(0.25 * len(blue))] + 10, "and the area under it is shaded"


@pytest.mark.parametrize(("limits", "points", "top"), [
    ((0.0, 4.0), "0:0.8, 1:0.9", 1.0), ((0.0, 4.0), "0:1, 1:0", 2.0), ((0.0, 4.0), "0:0", 1.0),
    ((0.0, 4.0), "0:3.9", 4.0), ((0.0, 1.0), "0:1", 1.0), ((-2.0, 2.0), "0:0.1", 2.0), ((2.0, 10.0), "3", 4.0)])
def test_the_axis_goes_a_bit_higher_than_the_curve(limits: tuple[float, float], points: str, top: float) -> None:
    field = LifeCurveField(points, *limits, "A curve")
    assert fitted_top(field, field.default) == top


def test_the_axis_stays_under_the_hand_and_fits_when_it_has_gone(cinder: Hand) -> None:
    """A point lies under the mouse wherever it is dragged to in the plot, though its curve could do with less."""
    start, end = on_plot(cinder, 0.5, 1.0, "girth", high=2.0), on_plot(cinder, 0.6, 0.2, "girth", high=2.0)
    cinder.point(start)
    cinder.button(True)
    for place, expected in ((end, 0.2), (start, 1.0), (end, 0.2)):
        cinder.point(place)
        cinder.frames(3)
        assert cinder.value("girth").points[1][1] == pytest.approx(expected, abs=2 * PIXEL)
    cinder.button(False)
    cinder.click(end)
    assert len(cinder.value("girth").points) == 3, "it is still there"
    cinder.bench.change("girth", {"girth": "0:0.5"})
    cinder.point((600.0, 300.0))
    cinder.click(on_plot(cinder, 0.5, 0.9, "girth", high=1.0))
    assert cinder.value("girth").points[1] == pytest.approx((0.5, 0.9), abs=PIXEL)


def test_a_drag_beyond_the_top_stretches_the_axis_up_to_the_limit(cinder: Hand) -> None:
    start = on_plot(cinder, 0.5, 1.0, "girth", high=2.0)
    cinder.point(start)
    cinder.button(True)
    for height in (3.0, 2.5, 3.0, 9.0, 1.5, 3.0):
        cinder.point(on_plot(cinder, 0.5, height, "girth", high=2.0))
        cinder.frames(3)
        expected = min(height, 4.0)
        assert cinder.value("girth").points[1][1] == pytest.approx(expected, abs=2 * PIXEL), "it does not run away"
    cinder.button(False)
    cinder.point((600.0, 300.0))
    right_click(cinder, on_plot(cinder, 0.5, 3.0, "girth", high=4.0))
    assert str(cinder.value("girth")) == "0:0.8, 1:1"


def test_a_range_shows_its_unit_only_where_there_is_room(cinder: Hand, monkeypatch: pytest.MonkeyPatch) -> None:
    formats: dict[float, str] = {}
    original = imgui.drag_float_range2

    def noting(*arguments: Any) -> Any:
        formats[arguments[5]] = arguments[6]
        return original(*arguments)

    monkeypatch.setattr(imgui, "drag_float_range2", noting)
    cinder.frames(2)
    assert formats == {720.0: "%.4g", 2.0: "%.4g s"}


# Gradients

def test_a_drag_moves_a_stop_between_its_neighbours(hand: Hand) -> None:
    start, end = on_handle(hand, 0.5), on_handle(hand, 0.2)
    hand.drag(start, (end[0] - start[0], 0.0))
    assert hand.value("glow").stops[1][0] == pytest.approx(0.2, abs=6e-3)
    hand.drag(on_handle(hand, 1.0), (-2000.0, 0.0))
    assert hand.value("glow").stops[2][0] == pytest.approx(hand.value("glow").stops[1][0] + 1e-3, abs=1e-9)
    undo(hand)
    undo(hand)
    assert str(hand.value("glow")) == COLORS
    assert not hand.bench.history.can_undo
    assert not imgui.is_popup_open("", imgui.PopupFlags_.any_popup)


def test_a_click_on_the_bar_adds_a_stop_with_the_colour_there(hand: Hand) -> None:
    before = hand.value("glow")
    hand.click(on_bar(hand, 0.75))
    after = hand.value("glow")
    assert len(after.stops) == 4
    assert after.stops[2][0] == pytest.approx(0.75, abs=6e-3)
    x = np.linspace(0.0, 1.0, 101)
    assert np.allclose(after.linear(x), before.linear(x), atol=5e-3), "nothing else changes"
    assert not imgui.is_popup_open("", imgui.PopupFlags_.any_popup)
    undo(hand)
    assert hand.value("glow") == before


def test_a_right_click_removes_a_stop_but_never_the_last(hand: Hand) -> None:
    right_click(hand, on_handle(hand, 0.5))
    assert str(hand.value("glow")) == "0:#ffffff, 1:#300000"
    right_click(hand, on_handle(hand, 0.0))
    right_click(hand, on_handle(hand, 1.0))
    assert str(hand.value("glow")) == "1:#300000"
    undo(hand)
    undo(hand)
    assert str(hand.value("glow")) == COLORS


def test_a_click_on_a_handle_opens_a_picker_for_its_colour(hand: Hand, monkeypatch: pytest.MonkeyPatch) -> None:
    boxes: list[tuple[float, float]] = []
    original = imgui.color_picker3

    def noting(*arguments: Any) -> Any:
        result = original(*arguments)
        low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
        boxes.append((low.x + 0.2 * (high.x - low.x), low.y + 0.6 * (high.y - low.y)))
        return result

    monkeypatch.setattr(imgui, "color_picker3", noting)
    hand.click(on_handle(hand, 0.5))
    assert boxes, "the picker is there"
    assert str(hand.value("glow")) == COLORS
    hand.drag(boxes[-1], (20.0, 10.0))
    painted = hand.value("glow")
    assert painted.stops[0] == Gradient.parse(COLORS).stops[0]
    assert painted.stops[1][0] == 0.5
    assert painted.stops[1][1] != Gradient.parse(COLORS).stops[1][1]
    hand.key(Key.escape)
    hand.click((600.0, 300.0))
    undo(hand)
    assert str(hand.value("glow")) == COLORS, "a drag in the picker is one entry"


def test_the_bar_shows_the_light_that_is_mixed(hand: Hand) -> None:
    hand.bench.change("glow", {"glow": "0:#000000, 1:#ffffff"})
    hand.point((600.0, 300.0))
    pixels = hand.pixels()
    for position in (0.1, 0.25, 0.5, 0.9):
        x, y = on_bar(hand, position)
        expected = 255 * (1.055 * position ** (1 / 2.4) - 0.055)
        assert pixels[round(y), round(x)][:3] == pytest.approx([expected] * 3, abs=4)


# Both

def test_they_survive_a_preset_and_the_reset(hand: Hand) -> None:
    hand.click(on_plot(hand, 0.7, 0.95))
    hand.click(on_bar(hand, 0.75))
    assert hand.bench.stage
    saved = hand.value("size"), hand.value("glow")
    save_preset(hand.bench.stage.entry, hand.bench.stage, "Mine")
    hand.click("Reset all")
    assert (str(hand.value("size")), str(hand.value("glow"))) == (START, COLORS)
    hand.bench.apply_preset(load_preset(hand.bench.stage.entry, "mine"))
    assert (hand.value("size"), hand.value("glow")) == saved


def test_a_value_set_elsewhere_under_the_hand_breaks_nothing(hand: Hand) -> None:
    hand.point(on_plot(hand, 1.0, 0.0))
    hand.button(True)
    hand.point(on_plot(hand, 0.9, 0.2))
    hand.bench.change("size", {"size": "0:1"})
    hand.point(on_plot(hand, 0.8, 0.4))
    hand.button(False)
    assert str(hand.value("size")) == "0:1"
    hand.point(on_handle(hand, 1.0))
    hand.button(True)
    hand.bench.change("glow", {"glow": "#ff0000"})
    hand.frames()
    hand.button(False)
    hand.frames(2)
    assert str(hand.value("glow")) == "#ff0000"


def test_the_tooltip_explains_the_gestures(hand: Hand) -> None:
    assert hand.bench.stage
    curve, gradient = (hand.bench.stage.params.field(name) for name in ("size", "glow"))
    assert explain(curve).splitlines() == ["Its size", "0 to 1 m", f"Default: {START}", curve_editor.GESTURES]
    assert explain(gradient).splitlines() == ["Its colour", f"Default: {COLORS}", gradient_editor.GESTURES]


@pytest.mark.parametrize(("size", "scale"), [((1024, 768), 1.0), ((1024, 768), 3.0), ((1280, 800), 2.0),
                                             ((320, 240), 3.0)])
def test_they_are_drawn_at_every_size(make_ember: Callable[..., Hand], size: tuple[int, int], scale: float) -> None:
    hand = make_ember(size=size)
    hand.bench.view.scale = scale
    hand.frames(4)
    left, top, right, bottom = hand.places["glow"]
    assert right > left
    assert bottom > top
    assert right <= hand.bench.layout.left.width


def test_an_idle_frame_costs_next_to_nothing(hand: Hand) -> None:
    """What is drawn again is kept, not worked out again."""
    hand.frames(3)
    before = curve_editor._outline.cache_info().misses, gradient_editor._patches.cache_info().misses
    hand.frames(5)
    assert (curve_editor._outline.cache_info().misses, gradient_editor._patches.cache_info().misses) == before
