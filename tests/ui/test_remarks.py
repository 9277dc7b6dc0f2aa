"""Remarks: on a plate over the picture, asked for when something changed, and cut where they are too long."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from viewer.ui.remark_plate import MOST_LINES, in_lines

if TYPE_CHECKING:
    from tests.ui.conftest import Hand

SCENE = """
from viewer import ColorScale, Parameters, Scene, Studio, slider

class Odd(Scene):
    \"\"\"Has something to remark.\"\"\"

    class Params(Parameters):
        level: float = slider(0.5, 0.0, 1.0, "Where the surface lies")

    studio = Studio(ground=None)
    asked = 0

    def draw(self):
        pass

    def color_scale(self):
        return ColorScale("height", 0.0, 1.0)

    def remarks(self):
        Odd.asked += 1
        if self.params.level > 0.9:
            raise ValueError("no level")
        return ["There is no\\n surface", "There is no surface", ""] if self.params.level > 0.6 else []
"""


@pytest.fixture
def odd(make_hand: Callable[..., Hand], pack: Path) -> Hand:
    """A bench that shows a scene with a remark at high levels."""
    (pack / "scenes" / "odd.py").write_text(SCENE)
    return make_hand(scene="odd")


def set_level(hand: Hand, level: float) -> None:
    hand.bench.change("level", {"level": level})
    hand.frames(40)


def picture(hand: Hand) -> np.ndarray:
    box = hand.bench.layout.picture
    return hand.pixels()[int(box.y):int(box.y + box.height), int(box.x):int(box.x + box.width)].astype(int)


def test_a_remark_stands_in_the_upper_left_of_the_picture(odd: Hand) -> None:
    """And goes with its cause; panels may be hidden meanwhile. The scale of the colours stays free."""
    plain = picture(odd)
    set_level(odd, 0.8)
    assert odd.bench.remarker.remarks == ("There is no surface",)
    down, across = np.nonzero(np.abs(picture(odd) - plain).max(axis=2) > 8)
    assert down.size > 500
    assert down.max() < 0.1 * plain.shape[0]
    assert across.max() < 0.7 * plain.shape[1]
    odd.bench.toggle("panels")
    odd.frames(3)
    assert odd.bench.remarker.remarks
    odd.bench.toggle("panels")
    set_level(odd, 0.4)
    assert odd.bench.remarker.remarks == ()
    assert np.array_equal(picture(odd), plain)


def test_a_scene_is_asked_when_something_changed(odd: Hand) -> None:
    scene = type(odd.bench.stage.scene)
    odd.frames(5)
    asked = scene.asked
    odd.frames(30)
    odd.drag((600.0, 300.0), (40.0, 0.0))
    assert scene.asked == asked, "the camera is no concern of the remarks"
    set_level(odd, 0.3)
    assert scene.asked == asked + 1


def test_remarks_that_fail_say_so_in_their_place(odd: Hand) -> None:
    """The picture goes on."""
    set_level(odd, 0.95)
    (said,) = odd.bench.remarker.remarks
    assert said.startswith("odd failed in remarks: odd.py:")
    assert said.endswith("ValueError: no level")
    assert odd.bench.live.problem is None
    set_level(odd, 0.5)
    assert odd.bench.remarker.remarks == ()


def test_a_scene_without_remarks_is_not_asked(hand: Hand, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hand.bench.stage, "remarks", lambda: 1 / 0)
    hand.bench.change("size", {"size": 0.7})
    hand.frames(20)
    assert hand.bench.remarker.remarks == ()


def test_long_remarks_are_cut_to_three_lines(odd: Hand) -> None:
    """Each begins with the icon; an ellipsis tells that there is more."""
    lines: list[list[tuple[str, bool]]] = []

    def part() -> None:
        for remarks in (["one two"], ["one", "two"], ["word " * 40], ["a", "b", "c", "d"]):
            lines.append([(line.text, line.first) for line in in_lines(remarks, 200.0)])

    odd.bench.session.frame(odd.surface, 0.02, 1.0, part)
    assert lines[0] == [("one two", True)]
    assert lines[1] == [("one", True), ("two", True)]
    assert [first for _, first in lines[2]] == [True, False, False]
    assert len(lines[2]) == MOST_LINES and lines[2][-1][0].endswith("word …")
    assert lines[3] == [("a", True), ("b", True), ("c …", True)]
