"""The real panels, driven by synthetic mouse and key events."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from imgui_bundle import imgui

from viewer.engine.scene import SceneError
from viewer.ui import actions

if TYPE_CHECKING:
    from tests.ui.conftest import Hand

Key = imgui.Key
PICTURE = (500.0, 300.0)    # somewhere in the middle of the window, on the picture


def test_a_drag_on_a_slider_is_one_entry_of_the_history(hand: Hand) -> None:
    hand.drag("size", (40.0, 0.0))
    dragged = hand.value("size")
    assert dragged > 0.5
    hand.key(Key.left_ctrl, Key.mod_ctrl, Key.z)
    assert hand.value("size") == 0.5
    assert not hand.bench.history.can_undo
    hand.key(Key.left_ctrl, Key.mod_ctrl, Key.y)
    assert hand.value("size") == dragged
    hand.key(Key.left_ctrl, Key.mod_ctrl, Key.z)
    hand.key(Key.left_ctrl, Key.mod_ctrl, Key.left_shift, Key.mod_shift, Key.z)
    assert hand.value("size") == dragged


def test_a_slider_changes_the_picture_at_once(hand: Hand) -> None:
    before = hand.pixels()
    hand.drag("size", (-60.0, 0.0))
    assert not np.array_equal(hand.pixels()[200:500, 300:700], before[200:500, 300:700])


def test_a_typed_value_beyond_the_range_is_refused_in_words(hand: Hand) -> None:
    hand.point("size")
    hand.bench.session.io.add_key_event(Key.mod_ctrl, True)
    hand.click("size")
    hand.bench.session.io.add_key_event(Key.mod_ctrl, False)
    hand.type("7")
    hand.key(Key.enter)
    assert hand.value("size") == 0.5
    assert "is outside 0 to 1" in hand.bench.panels.parameters._errors["size"][0]
    hand.frames(3)
    hand.drag("size", (30.0, 0.0))
    assert not hand.bench.panels.parameters._errors


def test_toggle_integer_interval_and_choice(hand: Hand) -> None:
    hand.click("shown", across=0.1)
    assert hand.value("shown") is False
    hand.drag("count", (60.0, 0.0))
    assert hand.value("count") > 3
    hand.click("right")
    assert hand.value("way") == "right"
    hand.click("pattern")
    hand.click("dotted")
    assert hand.value("pattern") == "dotted"
    hand.point("spread", across=0.2)
    hand.drag((hand.bench.session.io.mouse_pos.x, hand.bench.session.io.mouse_pos.y), (30.0, 0.0))
    assert hand.value("spread")[0] > 0.2
    assert hand.value("spread")[1] == 0.6


def test_a_wrong_formula_keeps_the_last_good_one(hand: Hand) -> None:
    hand.click("formula")
    hand.key(Key.mod_ctrl, Key.a)
    hand.type("bump*x")
    assert hand.value("height").text == "size*x", "the keys have not rested yet"
    hand.frames(12)
    assert hand.value("height").text == "bump*x"
    assert "bump" in hand.places, "a name that nobody declared becomes a slider"
    hand.type("+*")
    draft = hand.bench.panels.parameters._typed._drafts["height"]
    assert hand.value("height").text == "bump*x+" or hand.value("height").text == "bump*x"
    assert draft.text == "bump*x+*"
    assert draft.error
    assert draft.position == 8
    hand.key(Key.backspace)
    hand.key(Key.backspace)
    assert not draft.error
    hand.frames(12)
    assert hand.value("height").text == "bump*x"


def test_a_formula_is_in_force_as_soon_as_its_input_is_left(hand: Hand) -> None:
    hand.click("formula")
    hand.key(Key.end)
    hand.type("*3")
    hand.click(PICTURE)
    assert hand.value("height").text == "size*x*3"


def test_a_word_typed_into_a_formula_is_undone_as_one(hand: Hand) -> None:
    hand.click("formula")
    hand.key(Key.end)
    hand.type("*1.25")
    hand.frames(12)
    assert hand.value("height").text == "size*x*1.25"
    hand.click(PICTURE)
    hand.key(Key.left_ctrl, Key.mod_ctrl, Key.z)
    assert hand.value("height").text == "size*x"
    assert hand.bench.panels.parameters._typed._drafts["height"].text == "size*x"


def test_reset_of_one_parameter_and_of_all(hand: Hand) -> None:
    hand.drag("size", (40.0, 0.0))
    hand.drag("count", (60.0, 0.0))
    hand.places.pop("reset", None)
    hand.frames()
    hand.click("reset")      # the last drawn one: count's
    assert hand.value("count") == 3
    assert hand.value("size") != 0.5
    hand.click("Reset all")
    assert hand.value("size") == 0.5
    hand.key(Key.left_ctrl, Key.mod_ctrl, Key.z)
    assert hand.value("size") != 0.5


def test_text_and_file(hand: Hand, pack: Path) -> None:
    typed = hand.bench.panels.parameters._typed
    error = hand.bench.change("name", {"name": "floor"})
    assert error is None
    hand.frames()
    assert typed._drafts["name"].text == "floor"
    typed._try(hand.bench.stage.params.field("picture"), typed._drafts["picture"], str(pack / "missing.png"))
    assert "is not a file that exists" in typed._drafts["picture"].error
    assert hand.value("picture") is None


def test_playing_stepping_and_seeking(hand: Hand) -> None:
    clock = hand.bench.stage.clock
    hand.click("start")
    hand.key(Key.period)
    hand.key(Key.period)
    assert (hand.bench.stage.frame, clock.playing) == (2, False)
    hand.key(Key.comma)
    assert hand.bench.stage.frame == 1
    hand.click("\uf04b###play")
    assert clock.playing
    hand.frames(20)
    assert 15 < hand.bench.stage.frame < 40
    hand.key(Key.space)
    assert not clock.playing
    hand.key(Key.home)
    assert hand.bench.stage.frame == 0
    hand.click("##scrub", across=0.5)
    assert 200 < hand.bench.stage.frame < 400
    hand.click("##scrub", across=0.25)
    assert 100 < hand.bench.stage.frame < 200
    hand.click("##speed")
    hand.click("0.25×")
    assert clock.speed == 0.25


def test_the_mouse_moves_the_camera_only_on_the_picture(hand: Hand) -> None:
    camera = hand.bench.stage.camera
    hand.drag(PICTURE, (50.0, 20.0))
    assert camera.yaw != camera.start.yaw
    assert np.array_equal(camera.target, camera.start.target)
    hand.drag(PICTURE, (50.0, 20.0), number=1)
    assert not np.array_equal(camera.target, camera.start.target)
    hand.point(PICTURE)
    hand.bench.session.io.add_mouse_wheel_event(0.0, 0.4)
    hand.frames(2)
    assert camera.distance < camera.start.distance
    hand.key(Key.r)
    assert (camera.yaw, camera.distance) == (camera.start.yaw, camera.start.distance)
    hand.drag("size", (40.0, 0.0))
    hand.point("count")
    hand.bench.session.io.add_mouse_wheel_event(0.0, 3.0)
    hand.frames(2)
    assert (camera.yaw, camera.distance) == (camera.start.yaw, camera.start.distance)
    hand.drag(PICTURE, (50.0, 20.0))
    hand.frames(30)
    for _ in range(2):
        hand.button(True)
        hand.button(False)
    assert camera.yaw == camera.start.yaw


def test_hidden_panels_leave_the_whole_window_to_the_picture(hand: Hand) -> None:
    hand.key(Key.h)
    hand.frames(2)
    assert hand.bench.stage.size == (1024, 768)
    hand.key(Key.h)
    hand.frames(2)
    assert hand.bench.stage.size[0] < 700
    hand.key(Key.f3)
    hand.frames(2)
    assert hand.bench.stage.size[0] > 700


def test_a_column_is_widened_by_its_edge(hand: Hand) -> None:
    before = hand.bench.layout.right.width
    hand.drag((hand.bench.layout.right.x, 300.0), (-100.0, 0.0))
    hand.frames(2)
    assert hand.bench.layout.right.width == pytest.approx(before + 100.0, abs=2.0)
    assert hand.bench.stage.camera.yaw == hand.bench.stage.camera.start.yaw


def test_a_dense_screen_gets_larger_text(hand: Hand) -> None:
    usual = hand.bench.layout.menu_height
    hand.surface = dataclasses.replace(hand.surface, dpi=2.0)
    hand.frames(3)
    assert hand.bench.layout.menu_height == pytest.approx(2 * usual, abs=2.0)


def test_letters_typed_into_a_formula_are_no_commands(hand: Hand) -> None:
    hand.click("formula")
    hand.key(Key.h)
    hand.key(Key.space)
    assert hand.bench.view.panels
    assert not hand.bench.stage.clock.playing


def test_scale_by_keys(hand: Hand) -> None:
    hand.key(Key.left_ctrl, Key.mod_ctrl, Key.equal)
    assert hand.bench.view.scale == 1.25
    for _ in range(9):
        hand.key(Key.left_ctrl, Key.mod_ctrl, Key.equal)
    assert hand.bench.view.scale == 3.0
    hand.frames(2)
    hand.key(Key.left_ctrl, Key.mod_ctrl, Key._0)
    assert hand.bench.view.scale == 1.0


def test_help_lists_every_key_and_escape_closes_it(hand: Hand) -> None:
    before = hand.pixels()
    hand.key(Key.f1)
    hand.frames(3)
    assert hand.bench.view.help
    assert not np.array_equal(hand.pixels(), before)
    hand.key(Key.escape)
    hand.frames(2)
    assert not hand.bench.view.help
    hand.type("?")
    assert hand.bench.view.help
    hand.frames(2)
    hand.click((3.0, 600.0))
    assert not hand.bench.view.help
    chords = [chord for action in actions.ACTIONS for chord in action.chords]
    assert len(chords) == len(set(chords)), "no chord does two things"


def test_measurements_are_shown_and_rare(hand: Hand) -> None:
    measurer = hand.bench.measurer
    assert measurer.report.readouts == [("steps", "0"), ("tilt mean", "6.451°")]
    assert measurer.report.plots[0].title == "area"
    report = measurer.report
    hand.frames(3)
    assert measurer.report is report, "nothing changed, so nothing is measured"


def test_a_measure_that_raises_stands_in_its_panel(hand: Hand, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail() -> None:
        raise SceneError("tile failed in measure: no ruler")

    monkeypatch.setattr(hand.bench.stage, "measure", fail)
    hand.drag("size", (40.0, 0.0))
    hand.frames(30)
    assert hand.bench.measurer.failure == "tile failed in measure: no ruler"
    assert hand.bench.live.problem is None


def test_a_panel_that_raises_leaves_the_rest_alive(hand: Hand, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(**_: object) -> None:
        imgui.push_id("left behind")
        imgui.begin_child("left open")
        raise ValueError("a broken panel")

    monkeypatch.setattr(hand.bench.panels.timeline, "draw", fail)
    hand.frames(3)
    hand.drag("size", (40.0, 0.0))
    assert hand.value("size") > 0.5


def test_a_shader_edit_is_taken_over_and_a_wrong_one_named(hand: Hand, pack: Path) -> None:
    path = pack / "shaders" / "tile" / "tile.frag"
    good = path.read_text()
    picture = hand.bench.stage.picture.pixels()
    path.write_text(good.replace("u_tint, 1.0", "u_tint, oops"))
    hand.frames(4, seconds=0.1)
    problem = hand.bench.live.problem
    assert (problem.place, problem.line) == ("tile/tile.frag", 5)
    assert "oops" in problem.source
    assert np.array_equal(hand.bench.stage.picture.pixels(), picture), "the last good picture goes on"
    path.write_text(good.replace("u_tint, 1.0", "u_tint.bgr, 1.0"))
    hand.frames(4, seconds=0.1)
    assert hand.bench.live.problem is None
    assert not np.array_equal(hand.bench.stage.picture.pixels(), picture)


def test_a_scene_edit_is_taken_over_and_a_wrong_one_named(hand: Hand, pack: Path) -> None:
    path = pack / "scenes" / "tile.py"
    good = path.read_text()
    hand.bench.change("size", {"size": 0.75})
    path.write_text(good.replace("        self.steps = 0", "        self.steps = nothing"))
    hand.frames(4, seconds=0.1)
    assert "nothing" in hand.bench.live.problem.text
    assert hand.bench.live.problem.source == "self.steps = nothing"
    path.write_text(good.replace('"How many"', '"How many tiles"'))
    hand.frames(4, seconds=0.1)
    assert hand.bench.live.problem is None
    assert hand.bench.stage.params.field("count").help == "How many tiles"
    assert hand.value("size") == 0.75


def test_a_scene_that_raises_while_it_plays_pauses(hand: Hand, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(dt: float) -> None:
        raise RuntimeError("out of steam")

    monkeypatch.setattr(hand.bench.stage.scene, "update", fail)
    hand.key(Key.space)
    hand.frames(5)
    assert not hand.bench.stage.clock.playing
    assert "out of steam" in hand.bench.live.problem.text


def test_a_scene_that_cannot_be_loaded_leaves_the_one_before(hand: Hand, pack: Path) -> None:
    (pack / "scenes" / "broken.py").write_text("import nothing_of_that_name\n")
    assert not hand.bench.open("broken")
    assert "nothing_of_that_name" in hand.bench.notice.text
    hand.frames(2)
    assert hand.bench.stage.entry.name == "tile"
    hand.key(Key.escape)
    assert hand.bench.notice is None


def test_a_window_without_a_scene_shows_the_list(make_hand: Callable[..., Hand], pack: Path) -> None:
    hand = make_hand(scene="broken")
    assert hand.bench.stage is None
    assert "unknown scene broken" in hand.bench.notice.text
    hand.frames(2)
    hand.click(" Tile##tile")
    assert hand.bench.stage.entry.name == "tile"


def test_presets_are_saved_and_loaded(hand: Hand, pack: Path) -> None:
    hand.bench.change("size", {"size": 0.8})
    presets = hand.bench.panels.presets
    presets._name = "Large tile"
    hand.click("\uf0c7##save")
    hand.frames(2)
    hand.click("Save")
    path = pack / "mine" / "tile" / "large-tile.toml"
    assert "0.8" in path.read_text()
    hand.bench.change("size", {"size": 0.9})
    hand.click("\uf0c7##save")
    hand.click("Save")
    assert "0.8" in path.read_text(), "it asks before it replaces"
    hand.click("Replace")
    assert "0.9" in path.read_text()
    hand.bench.reset()
    hand.click("##presets")
    hand.click("Large tile##large-tile")
    assert hand.value("size") == 0.9
    hand.key(Key.left_ctrl, Key.mod_ctrl, Key.z)
    assert hand.value("size") == 0.5


def test_a_preset_is_replaced_from_the_keyboard(hand: Hand, pack: Path) -> None:
    """Enter saves, and Enter once more says that it may take the other's place."""
    for size, name in ((0.8, "large"), (0.9, "")):      # the second time the name is there already
        hand.bench.change("size", {"size": size})
        hand.click("\uf0c7##save")
        hand.frames(4)
        hand.type(name)
        hand.key(Key.enter)
        hand.frames(4)
    path = pack / "mine" / "tile" / "large.toml"
    assert "0.8" in path.read_text(), "it asks before it replaces"
    hand.key(Key.enter)
    assert "0.9" in path.read_text()


def test_screenshots_tell_where_they_are(hand: Hand, pack: Path) -> None:
    from PIL import Image

    hand.key(Key.f12)
    assert Image.open(pack / "tile-000000.png").size == hand.bench.stage.size
    hand.key(Key.left_shift, Key.mod_shift, Key.f12)
    hand.frames(2)
    assert Image.open(pack / "tile-000000-2.png").size == (1024, 768)
    assert str(pack) in hand.bench.toast
    hand.frames(12, seconds=0.5)
    assert not hand.bench.toast


def test_tabs_of_lesson_and_code(hand: Hand, pack: Path) -> None:
    (pack / "assets" / "lessons").mkdir(parents=True)
    (pack / "assets" / "lessons" / "tile.md").write_text("# Tiles\n\nA *tile* has `four` corners.\n\n- one\n- two\n")
    hand.click("Lesson")
    hand.frames(3)
    hand.click("Code")
    hand.frames(3)
    assert [path.name for path in hand.bench.panels.code._files] == ["tile.py", "tile.frag", "tile.vert"]
    hand.click("##file")
    hand.click("shaders/tile/tile.frag")
    assert hand.bench.panels.code._editor.get_text().startswith("#version 330 core")


@pytest.mark.parametrize("size", [(1, 1), (40, 30), (320, 200), (640, 360), (1920, 1080)])
@pytest.mark.parametrize("scale", [1.0, 3.0])
def test_any_size_and_scale(make_hand: Callable[..., Hand], size: tuple[int, int], scale: float) -> None:
    hand = make_hand(size)
    hand.bench.view.scale = scale
    hand.bench.view.help = True
    hand.bench.tell(SceneError("a message of some length that has to be wrapped in a small window"))
    hand.frames(3)
    width, height = hand.bench.stage.size
    assert 1 <= width <= size[0]
    assert 1 <= height <= size[1]
    assert hand.bench.live.problem is None
