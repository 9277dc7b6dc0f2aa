"""Parameters under headings that fold, and grey ones that have no effect now."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from viewer import Parameters, formula, integer, slider, toggle
from viewer.ui.parameter_groups import grouped

if TYPE_CHECKING:
    from tests.ui.conftest import Hand

SCENE = """
from viewer import Parameters, Scene, Studio, choice, slider, text, toggle

class Folders(Scene):
    \"\"\"Parameters under headings.\"\"\"

    class Params(Parameters):
        method: str = choice("cubes", ["cubes", "octree"], "How")
        depth: float = slider(0.5, 0.0, 1.0, "How deep", when="method=octree")
        walk: bool = toggle(False, "Go through the cells", group="Cells")
        speed: float = slider(0.5, 0.0, 1.0, "How fast", group="Cells", when="walk")
        levels: float = slider(0.5, 0.0, 1.0, "How many levels", group="Tree", when="method=octree")
        caption: str = text("root", "What stands there", group="Tree", when="method=octree")

    studio = Studio(ground=None)

    def draw(self):
        pass
"""


@pytest.fixture
def folders(make_hand: Callable[..., Hand], pack: Path) -> Hand:
    """A bench that shows parameters in two groups, of which one has no effect."""
    (pack / "scenes" / "folders.py").write_text(SCENE)
    return make_hand(scene="folders")


def is_shown(hand: Hand, name: str) -> bool:
    hand.places.pop(name, None)
    hand.frames()
    return name in hand.places


def test_groups_stand_where_their_first_member_was_declared() -> None:
    """Those without a heading come first; a formula's own sliders stand right under it."""

    class Params(Parameters):
        first: float = slider(0.0, 0.0, 1.0, "", group="Late")
        second: int = integer(1, 0, 9, "")
        height = formula("lift*x", "", group="Field", when="on")
        on: bool = toggle(False, "", group="Late")
        third: float = slider(0.0, 0.0, 1.0, "", group="Field", when="on")

    groups = [(group.title, [field.name for field in group.fields], group.idle) for group in grouped(Params())]
    assert groups == [("", ["second"], False), ("Late", ["first", "on"], False),
                      ("Field", ["height", "lift", "third"], True)]


def test_a_grey_slider_ignores_the_hand(folders: Hand) -> None:
    folders.drag("depth", (40.0, 0.0))
    assert folders.value("depth") == 0.5
    folders.click("octree")
    folders.drag("depth", (40.0, 0.0))
    assert folders.value("depth") > 0.5
    folders.click("cubes")
    assert folders.bench.change("depth", {"depth": 0.25}) is None
    assert folders.value("depth") == 0.25


def test_grey_looks_different_and_says_why(folders: Hand) -> None:
    panel, stage = folders.bench.panels.parameters, folders.bench.stage
    assert panel._explained(stage, stage.params.field("depth")).startswith(
        "Has an effect only where method is octree\nHow deep")
    low_x, low_y, high_x, high_y = map(int, folders.places["depth"])
    grey = folders.pixels()[low_y:high_y, low_x:high_x, :3].astype(int)
    folders.click("octree")
    assert panel._explained(stage, stage.params.field("depth")).startswith("How deep")
    assert folders.pixels()[low_y:high_y, low_x:high_x, :3].astype(int).max() > grey.max() + 30


def test_a_heading_folds_and_unfolds(folders: Hand) -> None:
    assert is_shown(folders, "walk")
    folders.click("Cells")
    assert not is_shown(folders, "walk")
    folders.click("Cells")
    assert is_shown(folders, "walk")


def test_a_group_without_effect_is_folded_until_it_has_one(folders: Hand) -> None:
    assert not is_shown(folders, "levels")
    folders.click("octree")
    assert is_shown(folders, "levels")
    folders.click("cubes")
    folders.click("Tree")
    assert is_shown(folders, "levels"), "a hand may look into it all the same"


def test_folds_are_remembered_for_each_scene(folders: Hand) -> None:
    folders.click("Cells")
    assert folders.bench.open("tile")
    folders.frames(3)
    assert folders.bench.open("folders")
    folders.frames(3)
    assert not is_shown(folders, "walk")


def test_rows_out_of_sight_are_not_drawn_but_keep_their_room(make_hand: Callable[..., Hand], pack: Path) -> None:
    """Scrolling down gets to the last of many, and that takes the hand."""
    declared = "".join(f'        level_{n} = slider(0.5, 0.0, 1.0, "One of many")\n' for n in range(60))
    source = SCENE.replace('        method: str', f"{declared}        method: str")
    (pack / "scenes" / "folders.py").write_text(source)
    hand = make_hand(scene="folders")
    hand.frames(3)
    assert is_shown(hand, "level_0")
    assert not is_shown(hand, "level_59")
    hand.point("level_3")
    hand.bench.session.io.add_mouse_wheel_event(0.0, -300.0)
    hand.frames(30)
    assert is_shown(hand, "speed")
    assert not is_shown(hand, "level_0")
    assert hand.bench.change("walk", {"walk": True}) is None
    hand.frames(3)
    assert hand.places["speed"][3] < hand.bench.layout.left.height
    hand.drag("speed", (40.0, 0.0))
    assert hand.value("speed") > 0.5
