"""Presets: found by name or file, read with care, and saved so that they bring the same look back."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.conftest import MakeStage, ScenePack
from viewer.engine.catalog import Catalog, SceneEntry
from viewer.engine.presets import PresetError, load_preset, presets_for, read_preset, save_preset, user_folder

RIPPLE = '''
from viewer import Parameters, Scene, choice, formula, interval, slider

class Ripple(Scene):
    """A scene with presets."""

    class Params(Parameters):
        displacement = formula("lift*x", "How far")
        amplitude: float = slider(0.05, 0.0, 0.5, "Height")
        direction: str = choice("x", ["x", "normal"], "Which way")
        lifetime: tuple[float, float] = interval((1, 2), 0, 10, "How long")

    def draw(self):
        pass
'''
NOTES = 'title = "As in the notes"\ndescription = "What was said."\n[parameters]\namplitude = 0.25\nlift = 3\n'


@pytest.fixture
def entry(scene_pack: ScenePack) -> SceneEntry:
    """A scene with one preset of its own."""
    pack = scene_pack({"assets/presets/ripple/notes.toml": NOTES}, ripple=RIPPLE)
    return Catalog([pack]).find("ripple")


def test_a_pack_s_preset_is_found_by_name_and_by_file(entry: SceneEntry) -> None:
    """Both ways read the same."""
    by_name = load_preset(entry, "notes")
    assert by_name == load_preset(entry, entry.pack / "assets/presets/ripple/notes.toml")
    assert (by_name.title, by_name.description) == ("As in the notes", "What was said.")
    assert by_name.values == {"amplitude": 0.25, "lift": 3}
    assert not by_name.camera


@pytest.mark.parametrize(("name", "message"), [
    ("note", "ripple has no preset note; did you mean notes?; known: notes"),
    ("qqqq", "ripple has no preset qqqq; known: notes"),
    ("nowhere.toml", "preset nowhere.toml does not exist"),
    ("x" * 300, "ripple has no preset xxx"),
])
def test_a_missing_preset_is_named(entry: SceneEntry, name: str, message: str) -> None:
    """With the nearest name, and with those that there are."""
    with pytest.raises(PresetError) as refused:
        load_preset(entry, name)
    assert str(refused.value).startswith(message)


@pytest.mark.parametrize(("content", "message"), [
    ("amplitude = ", "cannot be read"),
    ("\x00", "cannot be read"),
    ("[parameters", "cannot be read"),
    ("a = " + "[" * 5000, "cannot be read"),
    ("amplitude = 0.1", "has amplitude, which is none of title, description, parameters, camera"),
    ("parameters = 3", "parameters is not a table"),
    ("[camera]\nroll = 3", "camera has roll, which is none of yaw, pitch, distance"),
    ("[camera]\nyaw = nan", "camera yaw = nan is not a number from"),
    ("[camera]\nyaw = '30'", "camera yaw = 30 is not a number from"),
    ("[camera]\npitch = 90", "camera pitch = 90 is not a number from -89 to 89"),
    ("[camera]\ndistance = 0", "camera distance = 0 is not a number from"),
])
def test_a_corrupt_preset_is_refused_in_one_line(tmp_path: Path, content: str, message: str) -> None:
    """With the file's name and what is wrong with it."""
    path = tmp_path / "odd.toml"
    path.write_text(content)
    with pytest.raises(PresetError, match=r"odd.toml") as refused:
        read_preset(path)
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("content", [b"\xff\xfe\x00", None])
def test_what_is_no_text_is_refused(tmp_path: Path, content: bytes | None) -> None:
    """Bytes that are no UTF-8, and a folder."""
    path = tmp_path / "odd.toml"
    path.mkdir() if content is None else path.write_bytes(content)
    with pytest.raises(PresetError, match=r"odd\.toml cannot be read"):
        read_preset(path)


@pytest.mark.parametrize(("line", "message"), [
    ("amplitud = 0.1", "unknown parameter amplitud; did you mean amplitude?"),
    ("amplitude = 9", "amplitude = 9 is outside 0 to 0.5"),
    ("amplitude = 'high'", "amplitude = high is not a number"),
    ("amplitude = [1, 2]", "amplitude = [1, 2] is not a number"),
    ("amplitude = nan", "amplitude = nan is not a finite number"),
    ("amplitude = 2020-01-01", "amplitude = 2020-01-01 is not a number"),
    ("direction = 1", "direction = 1 is not one of x, normal"),
    ("lifetime = {low = 1}", "lifetime = {'low': 1} is not a number"),
    ("displacement = 'x+'", "displacement: "),
])
def test_a_preset_s_bad_value_leaves_the_stage_alone(make_stage: MakeStage, tmp_path: Path, line: str,
                                                      message: str) -> None:
    """The message names the preset and the value; no other value of it is taken."""
    stage = make_stage(RIPPLE, params={"amplitude": 0.125})
    path = tmp_path / "odd.toml"
    path.write_text(f"[parameters]\nlift = 2\n{line}\n[camera]\nyaw = 5\n")
    before, yaw = stage.params.stored(), stage.camera.yaw
    with pytest.raises(PresetError, match=r"odd\.toml: ") as refused:
        stage.apply_preset(read_preset(path))
    assert message in str(refused.value)
    assert (stage.params.stored(), stage.camera.yaw) == (before, yaw)


def test_a_preset_is_the_whole_look(make_stage: MakeStage, tmp_path: Path) -> None:
    """What it leaves out goes to its default, the sliders of its formula included."""
    stage = make_stage(RIPPLE, params={"amplitude": 0.5, "lift": 7, "direction": "normal"})
    path = tmp_path / "plain.toml"
    path.write_text("[parameters]\nlifetime = [3, 4]\ndisplacement = 'lift*x*k'\n[camera]\nyaw = 5\n")
    stage.apply_preset(read_preset(path))
    assert stage.params.stored() == {"displacement": "lift*x*k", "amplitude": 0.05, "direction": "x",
                                     "lifetime": [3.0, 4.0], "lift": 1.0, "k": 1.0}
    assert (stage.camera.yaw, stage.camera.pitch) == (5.0, 20.0)


def test_saving_and_loading_brings_the_same_look_back(make_stage: MakeStage, home_of_its_own: Path) -> None:
    """Values, formula-born sliders and camera; the file lies in the user's folder and under a plain name."""
    stage = make_stage(RIPPLE, params={"displacement": "k*x", "k": 0.1 + 0.2, "amplitude": 1 / 3})
    stage.camera.drag(0.1, 0.05)
    before, pose = stage.params.stored(), (stage.camera.yaw, stage.camera.pitch, stage.camera.distance)
    path = save_preset(stage.entry, stage, "My Look", "for later")
    assert path == user_folder("tile") / "my-look.toml"
    assert path.is_relative_to(home_of_its_own)

    stage.reset_params()
    stage.camera.reset()
    preset = load_preset(stage.entry, "my-look")
    assert (preset.title, preset.description) == ("My Look", "for later")
    stage.apply_preset(preset)
    assert stage.params.stored() == before
    assert (stage.camera.yaw, stage.camera.pitch, stage.camera.distance) == pytest.approx(pose)
    assert [one.name for one in presets_for(stage.entry)] == ["my-look"]
    assert list(path.parent.iterdir()) == [path]
    path.unlink()


@pytest.mark.parametrize("name", ["", "../evil", "a/b", "x" * 61, "dot.dot", "new\nline"])
def test_a_preset_s_name_is_no_path(make_stage: MakeStage, name: str) -> None:
    """Nothing is written outside the user's folder."""
    stage = make_stage(RIPPLE)
    with pytest.raises(PresetError, match="may hold letters, digits, spaces"):
        save_preset(stage.entry, stage, name)


def test_the_user_s_preset_wins_and_broken_ones_are_not_listed(entry: SceneEntry) -> None:
    """A user may redo the pack's preset; a broken file hides no other."""
    folder = user_folder("ripple")
    folder.mkdir(parents=True)
    (folder / "notes.toml").write_text("title = 'Mine'")
    (folder / "broken.toml").write_text("title = ")
    try:
        assert load_preset(entry, "notes").title == "Mine"
        assert [preset.title for preset in presets_for(entry)] == ["Mine"]
        with pytest.raises(PresetError, match="cannot be read"):
            load_preset(entry, "broken")
    finally:
        for path in folder.iterdir():
            path.unlink()
