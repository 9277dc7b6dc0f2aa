"""The parts of the panels that need no picture."""

from __future__ import annotations

import time
from typing import cast

import numpy as np
import pytest

from viewer.engine.scene import Curve
from viewer.engine.stage import Stage
from viewer.ui import measurer, sparing_question
from viewer.ui.color_scale import reading
from viewer.ui.history import History
from viewer.ui.imgui_session import Surface
from viewer.ui.layout import View, arrange
from viewer.ui.measurer import prepared, readout
from viewer.ui.number_text import number_text
from viewer.ui.pace import Pace
from viewer.ui.typed_fields import excerpt


def test_history_melts_what_is_changed_without_letting_go() -> None:
    history = History()
    history.record("size", {"size": 1}, {"size": 2})
    history.record("size", {"size": 2}, {"size": 3})
    history.settle()
    history.record("size", {"size": 3}, {"size": 4})
    assert history.undo() == {"size": 3}
    assert history.undo() == {"size": 1}
    assert history.undo() is None
    assert history.redo() == {"size": 3}
    history.record("count", {"size": 3}, {"size": 9})
    assert history.redo() is None


def test_history_forgets_a_drag_that_came_back() -> None:
    history = History()
    history.record("size", {"size": 1}, {"size": 2})
    history.record("size", {"size": 2}, {"size": 1})
    assert not history.can_undo


@pytest.mark.parametrize(("name", "value", "expected"), [
    ("normal_error_mean_deg", 6.45123, ("normal error mean", "6.451°")),
    ("step_ms", 1.5, ("step", "1.5 ms")),
    ("triangles", 20480, ("triangles", "20\u2009480")),
    ("vertices", 42, ("vertices", "42")),
    ("epsilon", 1.5e-7, ("epsilon", "1.5e-7")),
])
def test_readouts(name: str, value: float, expected: tuple[str, str]) -> None:
    assert readout(name, value) == expected


def test_numbers_that_are_none() -> None:
    assert number_text(float("nan")) == "nan"


def test_curves_leave_out_what_a_logarithm_cannot_show() -> None:
    curve = Curve("x", [0.0, 1.0, 2.0, 3.0], {"y_mean": [1.0, -1.0, float("nan"), 5.0]}, log_x=True, log_y=True)
    (name, x, y), = prepared({"curve": curve}).plots[0].series
    assert (name, list(x), list(y)) == ("y mean", [3.0], [5.0])


def test_long_curves_are_thinned() -> None:
    curve = Curve("x", np.arange(100_000), {"y": np.arange(100_000)})
    assert len(prepared({"curve": curve}).plots[0].series[0][1]) <= 1010


def test_excerpt_points_at_the_character() -> None:
    shown, marker = excerpt("a + $ * b", 5, 40)
    assert shown[marker.index("^")] == "$"
    long = "+".join(["amplitude"] * 20) + "+$+x"
    shown, marker = excerpt(long, long.index("$") + 1, 30)
    assert shown[marker.index("^")] == "$"
    assert len(shown) <= 31


@pytest.mark.parametrize("size", [(1, 1), (300, 200), (1024, 768), (3840, 2160)])
@pytest.mark.parametrize("scale", [1.0, 2.0, 3.0])
def test_layout_covers_the_window(size: tuple[int, int], scale: float) -> None:
    layout = arrange(size, 16 * scale, 22 * scale, View())
    assert layout.left.width + layout.picture.width + layout.right.width == pytest.approx(size[0])
    assert layout.menu_height + layout.picture.height + layout.bottom.height == pytest.approx(size[1])


def test_the_picture_has_the_larger_part() -> None:
    layout = arrange((1024, 768), 16, 22, View())
    assert layout.picture.width > 450
    assert layout.picture.height > 600
    assert not layout.one_column


class Numbers:
    """A stage as far as measuring goes."""

    def __init__(self) -> None:
        self.params = self
        self.revision = 0
        self.measured = 0

    @property
    def scene_showing(self) -> int:
        return self.revision

    def measure(self) -> dict[str, float]:
        self.measured += 1
        time.sleep(0.02)
        return {}


def test_what_rests_is_measured_though_a_cursor_stays_in_the_text(monkeypatch: pytest.MonkeyPatch) -> None:
    """A formula that has been typed has its numbers beside it before the hand goes elsewhere."""
    monkeypatch.setattr(sparing_question, "SHARE_OF_TIME", 1.0)
    numbers = Numbers()
    watch = measurer.Measurer(cast(Stage, numbers))
    watch.run(dragging=True)
    numbers.revision = 1
    watch.run(dragging=True)
    assert numbers.measured == 1
    monkeypatch.setattr(sparing_question, "RESTED_SECONDS", 0.0)
    watch.run(dragging=True)
    assert numbers.measured == 2


def test_an_angle_below_rounding_is_said_to_be_that() -> None:
    """An audience reads "less than", not an exponent; counts and larger angles stay as they are."""
    assert readout("normal_error_mean_deg", 2.2e-6) == ("normal error mean", "< 0.001°")
    assert readout("normal_error_mean_deg", 0.0) == ("normal error mean", "0°")
    assert readout("normal_error_mean_deg", 6.4475) == ("normal error mean", "6.447°")
    assert readout("share", 2.2e-6) == ("share", "2.2e-6")


def test_panels_are_built_under_a_hand_and_else_as_often_as_one_can_read() -> None:
    """At 60 frames a second: every frame for a while after an event, then one in three or four."""
    surface = Surface(None, (640, 360))
    pace = Pace()
    frames = [pace.due(1 / 60, surface, touched=number == 0) for number in range(120)]
    assert all(frames[:24])
    assert 14 <= sum(map(bool, frames[60:])) <= 21
    assert sum(frames) == pytest.approx(2.0, abs=0.06), "no time is lost between builds"
    resized = Surface(None, (800, 600))
    assert pace.due(1 / 60, resized, touched=False), "another size is built at once"


@pytest.mark.parametrize(("number", "unit", "expected"), [
    (8.0, "m/s", "8 m/s"), (0.0, "kg", "0 kg"), (2.5, "°", "2.5°"), (40.0, "%", "40%"), (3.0, " cells", "3 cells"),
    (0.25, "", "0.25")])
def test_a_unit_stands_apart_from_its_number_unless_it_is_a_sign(number: float, unit: str, expected: str) -> None:
    assert reading(number, unit) == expected
