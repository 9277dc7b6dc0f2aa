"""The command line: what each command gives, and one clear line for each mistake."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pytest
from PIL import Image

from tests import packs
from tests.conftest import ScenePack
from viewer import cli

pytestmark = pytest.mark.usefixtures("context")
Run = Callable[..., str]
SPHERE = ["rippling_sphere", "--set", "subdivision=2"]
WITH_POSTER = packs.WALK.replace("    studio =", "    poster = 12\n    studio =")


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Run:
    """Runs a command that has to succeed quietly; returns what it prints."""

    def run(*words: object) -> str:
        status = cli.main([str(word) for word in words])
        printed = capsys.readouterr()
        assert (status, printed.err) == (0, "")
        return printed.out

    return run


@pytest.fixture
def refused(capsys: pytest.CaptureFixture[str]) -> Run:
    """Runs a command that has to fail as the user's mistake; returns its one line of complaint."""

    def refused(*words: object) -> str:
        try:
            status: object = cli.main([str(word) for word in words])
        except SystemExit as end:
            status = end.code
        printed = capsys.readouterr()
        assert status == 2
        assert printed.out == ""
        assert printed.err.startswith("error: ")
        assert printed.err.count("\n") == 1 and printed.err.endswith("\n")
        return printed.err.strip()

    return refused


def demoscope(*words: object, **variables: str) -> subprocess.CompletedProcess[str]:
    """The command in a process of its own, with environment variables changed; an empty one is taken away."""
    environment = {name: value for name, value in {**os.environ, **variables}.items() if value}
    return subprocess.run([sys.executable, "-m", "viewer", *map(str, words)], env=environment, capture_output=True,
                          text=True, check=False, timeout=60)


def pixels(path: Path) -> np.ndarray[Any, Any]:
    return np.asarray(Image.open(path))


# list, doctor, help

def test_list_names_every_scene(run: Run, scene_pack: ScenePack) -> None:
    """One to a line, with the sentence of its docstring; packs add theirs."""
    lines = run("list", "--pack", scene_pack(tile=packs.TILE)).splitlines()
    assert [line.split()[0] for line in lines] == sorted(line.split()[0] for line in lines)
    assert "tile                  A tile of one shade." in lines
    assert any(line.startswith("rippling_sphere ") for line in lines)


def test_list_as_json_tells_limits(run: Run, scene_pack: ScenePack) -> None:
    """Enough for a script to know what it may set."""
    pack = scene_pack(tile=packs.TILE)
    scenes = {scene["name"]: scene for scene in json.loads(run("list", "--json", "--pack", pack))}
    assert scenes["tile"]["description"] == "A tile of one shade."
    sides = next(one for one in scenes["tile"]["parameters"] if one["name"] == "sides")
    assert (sides["kind"], sides["minimum"], sides["maximum"], sides["default"], sides["rebuild"]) == (
        "integer", 1, 12, 4, True)


def test_list_as_json_tells_groups_and_conditions(run: Run, scene_pack: ScenePack) -> None:
    """As the scene wrote them; both are empty where it wrote none."""
    grouped = packs.TILE.replace('"How bright")', '"How bright", group="Light", when="lit")').replace(
        "        shade: float", '        lit: bool = toggle(True, "Whether it shines")\n        shade: float').replace(
        "integer, slider", "integer, slider, toggle")
    listed = json.loads(run("list", "--json", "--pack", scene_pack(tile=grouped)))
    about = {one["name"]: one for scene in listed if scene["name"] == "tile" for one in scene["parameters"]}
    assert (about["shade"]["group"], about["shade"]["when"]) == ("Light", "lit")
    assert (about["sides"]["group"], about["sides"]["when"]) == ("", "")


@pytest.mark.parametrize("form", [[], ["--json"]])
def test_list_goes_on_after_a_broken_scene(form: list[str], scene_pack: ScenePack,
                                           capsys: pytest.CaptureFixture[str]) -> None:
    """The others are listed as ever; the broken one is one line on stderr, and status 2."""
    pack = scene_pack(tile=packs.TILE, wrong="class")
    assert cli.main(["list", *form, "--pack", str(pack)]) == 2
    printed = capsys.readouterr()
    assert "tile" in printed.out and "rippling_sphere" in printed.out and "wrong" not in printed.out
    assert printed.err.startswith("error: wrong cannot be loaded: wrong.py:1: SyntaxError")
    assert printed.err.count("\n") == 1


def test_doctor_tells_what_works(run: Run) -> None:
    """Renderer, versions, limits."""
    lines = run("doctor")
    for word in ("renderer", "OpenGL", "moderngl", "numpy", "display", "largest picture"):
        assert any(line.startswith(word) for line in lines.splitlines())


@pytest.mark.parametrize("words", [["--help"], ["--version"], ["capture", "--help"]])
def test_help_is_there(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    """On stdout, status 0."""
    with pytest.raises(SystemExit) as end:
        cli.main(words)
    assert end.value.code == 0
    assert "demoscope" in capsys.readouterr().out


# capture

@pytest.mark.parametrize(("frames", "numbers"), [("0,30,60", [0, 30, 60]), ("0:3", [0, 1, 2]), ("0:9:4", [0, 4, 8])])
def test_capture_writes_a_picture_for_each_frame(run: Run, tmp_path: Path, frames: str, numbers: list[int]) -> None:
    """Named by scene and frame, of the size asked for; it prints where they are."""
    folder = tmp_path / "new" / "folder"
    printed = run("capture", *SPHERE, "--out", folder, "--frames", frames, "--size", "40x30", "--samples", 0)
    files = [folder / f"rippling_sphere-{number:06d}.png" for number in numbers]
    assert printed.split() == [str(file) for file in files]
    assert sorted(folder.iterdir()) == files
    assert all(pixels(file).shape == (30, 40, 4) for file in files)


def test_a_capture_without_frames_shows_the_poster(run: Run, tmp_path: Path, scene_pack: ScenePack) -> None:
    """The frame that the scene names, or 0; frames that are asked for come first."""
    pack = scene_pack(tile=packs.TILE, walk=WITH_POSTER)
    words = ["--pack", pack, "--size", "16x9"]
    for name, more, expected in (("walk", [], "walk-000012"), ("tile", [], "tile-000000"),
                                 ("walk", ["--frames", 0], "walk-000000")):
        folder = tmp_path / expected
        run("capture", name, "--out", folder, *words, *more)
        assert [file.stem for file in folder.iterdir()] == [expected]
    run("capture", "walk", "--out", tmp_path, "--frames", 12, *words)
    assert (tmp_path / "walk-000012.png").read_bytes() == (tmp_path / "walk-000012/walk-000012.png").read_bytes()


def test_measurements_start_at_frame_0_whatever_the_poster(run: Run, tmp_path: Path, scene_pack: ScenePack) -> None:
    """And so do exports."""
    pack = scene_pack(walk=WITH_POSTER)
    assert json.loads(run("measure", "walk", "--pack", pack))["steps"] == 0
    run("export", "walk", "--pack", pack, "--out", tmp_path / "a.npz")
    assert np.load(tmp_path / "a.npz")["position"] == 0.5


def test_list_as_json_tells_the_poster(run: Run, scene_pack: ScenePack) -> None:
    """The frame, 0 where the scene names none."""
    listed = json.loads(run("list", "--json", "--pack", scene_pack(tile=packs.TILE, walk=WITH_POSTER)))
    assert {scene["name"]: scene["poster"] for scene in listed}.items() >= {("tile", 0), ("walk", 12)}


@pytest.mark.parametrize("poster", ["-1", "1.5", "None", "True", "10**10"])
def test_a_poster_that_is_no_frame_is_one_line(tmp_path: Path, refused: Run, scene_pack: ScenePack,
                                               poster: str) -> None:
    """With the file and what is allowed."""
    pack = scene_pack(walk=WITH_POSTER.replace("poster = 12", f"poster = {poster}"))
    assert "walk.py: poster has to be a frame from 0 to 1000000000" in refused(
        "capture", "walk", "--pack", pack, "--out", tmp_path / "pictures")


def test_a_long_capture_shows_its_progress(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A bar on stderr, and on stdout how many, where, and how fast."""
    assert cli.main(["capture", *SPHERE, "--out", str(tmp_path), "--frames", "0:12", "--size", "8x8"]) == 0
    printed = capsys.readouterr()
    assert printed.out.startswith(f"12 pictures of 8x8, {tmp_path}/rippling_sphere-000000.png to ")
    assert "frames/s" in printed.out
    assert "12/12" in printed.err
    assert len(list(tmp_path.iterdir())) == 12


def test_two_captures_are_byte_identical(tmp_path: Path, run: Run) -> None:
    """From two processes, and from one that is used to capturing."""
    words = ["capture", *SPHERE, "--set", "displacement=0.1*noise(3*x,3*y,3*z+t)", "--frames", 45, "--size", "48x32"]
    for folder in ("one", "two"):
        assert demoscope(*words, "--out", tmp_path / folder).returncode == 0
    run(*words, "--out", tmp_path / "three")
    files = [(tmp_path / folder / "rippling_sphere-000045.png").read_bytes() for folder in ("one", "two", "three")]
    assert files[0] == files[1] == files[2]


def test_what_is_set_is_seen(tmp_path: Path, run: Run) -> None:
    """A formula's own sliders in any order; samples, seed and camera; each changes the picture or is its default."""
    taken = {}
    wave = ["--set", "displacement=lift*sin(k*x)"]
    variants: dict[str, list[str]] = {
        "plain": [], "k": [*wave, "--set", "k=9", "--set", "lift=0.1"],
        "order": ["--set", "lift=0.1", "--set", "k=9", *wave], "camera": ["--camera", "-90,10,5"],
        "samples": ["--samples", "0"], "seed": ["--seed", "7"],
        "twice": ["--set", "amplitude=0.4", "--set", "amplitude=0.05"]}
    for name, words in variants.items():
        run("capture", *SPHERE, "--out", tmp_path / name, "--size", "48x32", *words)
        taken[name] = (tmp_path / name / "rippling_sphere-000000.png").read_bytes()
    assert taken["k"] == taken["order"] != taken["plain"]
    assert taken["twice"] == taken["seed"] == taken["plain"]
    assert len({taken[name] for name in ("plain", "k", "camera", "samples")}) == 4


def test_presets_by_name_and_by_file(tmp_path: Path, run: Run, scene_pack: ScenePack) -> None:
    """The same look either way; ``--set`` stands above it."""
    pack = scene_pack({"assets/presets/tile/dark.toml": "[parameters]\nsides = 9\n"}, tile=packs.TILE)
    measured = [json.loads(run("measure", "tile", "--pack", pack, *words))["sides"] for words in (
        ["--preset", "dark"], ["--preset", pack / "assets/presets/tile/dark.toml"],
        ["--preset", "dark", "--set", "sides=3"], [])]
    assert measured == [9, 9, 3, 4]


def test_no_display_draws_every_scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, scene_pack: ScenePack,
                                      capsys: pytest.CaptureFixture[str]) -> None:
    """Into captures/ here, and says where; a broken scene is one line and the others are drawn."""
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.chdir(tmp_path)
    pack = scene_pack(tile=packs.TILE, walk=packs.WALK)
    assert cli.main(["--pack", str(pack), "--size", "32x20"]) == 0
    printed = capsys.readouterr()
    names = {file.name for file in (tmp_path / "captures").iterdir()}
    assert {"rippling_sphere-000000.png", "tile-000000.png", "walk-000000.png"} <= names
    assert all(str(tmp_path / "captures" / name) in printed.out for name in names)
    assert printed.err == ""

    broken = scene_pack({"shaders/bad/bad.vert": "#version 330 core\nvoid main() { }}\n"}, tile=packs.TILE,
                        wrong="class", bad=packs.TILE.replace("tile/draw.vert", "bad/bad.vert"))
    (tmp_path / "captures/tile-000000.png").unlink()
    assert cli.main(["--pack", str(broken), "--size", "32x20"]) == 2
    errors = capsys.readouterr().err.splitlines()
    assert [error.split(":")[1].split()[0] for error in errors] == ["bad/bad.vert", "wrong"]
    assert (tmp_path / "captures/tile-000000.png").exists()

    assert cli.main(["walk", "--pack", str(pack), "--size", "32x20", "--set", "stride=0.5"]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == str(tmp_path / "captures/walk-000000.png")


def test_no_display_draws_the_poster(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, scene_pack: ScenePack,
                                     capsys: pytest.CaptureFixture[str]) -> None:
    """A scene that is empty at first is shown as it is best seen, whether it was named or not."""
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.chdir(tmp_path)
    pack = scene_pack(tile=packs.TILE, walk=WITH_POSTER)
    for words in ([], ["walk"]):
        assert cli.main([*words, "--pack", str(pack), "--size", "32x20"]) == 0
        assert str(tmp_path / "captures/walk-000012.png") in capsys.readouterr().out.splitlines()
    assert not (tmp_path / "captures/walk-000000.png").exists()
    assert (tmp_path / "captures/tile-000000.png").exists()


def test_measure_gives_tables_as_rows(run: Run, scene_pack: ScenePack) -> None:
    """Cells by their columns' names; what is no finite number is null."""
    measured = "Table((\'case\', \'cells\', \'share\'), [(\'none\', 3, 0.5), (\'two\', 4, float(\'nan\'))])"
    source = packs.failing("measure", f"return {{'cases': {measured}}}").replace("import Param", "import Table, Param")
    assert json.loads(run("measure", "tile", "--pack", scene_pack(tile=source))) == {
        "cases": [{"case": "none", "cells": 3, "share": 0.5}, {"case": "two", "cells": 4, "share": None}]}


REMARKING = packs.TILE + """
    def geometry(self):
        return {"height": [1.0]}

    def remarks(self):
        return [f"Frame {self.frame} is\\n odd", "No surface", "No surface"]
"""


@pytest.mark.parametrize("words", [
    ["capture", "--frames", "0,7", "--size", "8x8", "--out", "."],
    ["capture", "--frames", "0,7", "--size", "64x48", "--out", ".", "--panels"],
    ["export", "--frame", "7", "--out", "tile.npz"], ["measure", "--frame", "7"]])
def test_remarks_are_notes_beside_the_result(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, scene_pack: ScenePack,
                                             capsys: pytest.CaptureFixture[str], words: list[str]) -> None:
    """Those of the final frame, each once, on stderr; it all went well."""
    pack = scene_pack(tile=REMARKING)
    monkeypatch.chdir(tmp_path)
    assert cli.main([words[0], "tile", "--pack", str(pack), *words[1:]]) == 0
    printed = capsys.readouterr()
    assert printed.err == "note: Frame 7 is odd\nnote: No surface\n"
    assert printed.out and "note" not in printed.out


# Mistakes

@pytest.mark.parametrize(("words", "message"), [
    (["capture", "rippling_spher"], "unknown scene rippling_spher; did you mean rippling_sphere?; known: "),
    (["capture", "x" * 300], "unknown scene xxx"),
    (["capture", *SPHERE, "--set", "amplitud=0.1"], "unknown parameter amplitud; did you mean amplitude?"),
    (["capture", *SPHERE, "--set", "amplitude=9"], "amplitude = 9 is outside 0 to 0.5"),
    (["capture", *SPHERE, "--set", "amplitude=nan"], "amplitude = nan is not a finite number"),
    (["capture", *SPHERE, "--set", "amplitude=high"], "amplitude = high is not a number; allowed: 0 to 0.5"),
    (["capture", *SPHERE, "--set", "amplitude"], "--set amplitude is not of the form NAME=VALUE"),
    (["capture", *SPHERE, "--set", "=3"], "--set =3 is not of the form NAME=VALUE"),
    (["capture", *SPHERE, "--set", "displacement=sine(x)"],
     "displacement: unknown function sine at 1; did you mean sin?"),
    (["capture", *SPHERE, "--set", "displacement=" + "(" * 10000 + "x" + ")" * 10000], "displacement: "),
    (["capture", *SPHERE, "--preset", "no-such-preset"], "has no preset no-such-preset"),
    (["capture", *SPHERE, "--preset", "x" * 300], "has no preset xxx"),
    (["capture", *SPHERE, "--preset", "/nowhere.toml"], "preset /nowhere.toml does not exist"),
    (["capture", *SPHERE, "--preset", "/dev/null/a.toml"], "preset /dev/null/a.toml cannot be read: "),
    (["capture", *SPHERE, "--size", "0x0"], "a picture of 0x0 is outside 1x1 to"),
    (["capture", *SPHERE, "--size", "99999x99999"], "a picture of 99999x99999 is outside 1x1 to"),
    (["capture", *SPHERE, "--size", "640"], "640 is not a size such as 640x360"),
    (["capture", *SPHERE, "--size=-4x4"], "-4x4 is not a size such as 640x360"),
    (["capture", *SPHERE, "--samples", "99"], "samples = 99 is outside 0 to 16"),
    (["capture", *SPHERE, "--samples", "few"], "few is not a whole number from 0 up"),
    (["capture", *SPHERE, "--frames", "abc"], "frames = abc is not a list such as"),
    (["capture", *SPHERE, "--frames", "5:1"], "frames = 5:1 is not a list such as"),
    (["capture", *SPHERE, "--frames", "-3"], "frames = -3 is not a list such as"),
    (["capture", *SPHERE, "--frames", "0:1:2:3"], "frames = 0:1:2:3 is not a list such as"),
    (["capture", *SPHERE, "--camera", "1,2"], "1,2 is not YAW,PITCH,DISTANCE such as 30,20,4"),
    (["capture", *SPHERE, "--camera", "1,95,2"], "camera pitch = 95.0 is not a number from -89 to 89"),
    (["capture", *SPHERE, "--camera", "nan,0,2"], "camera yaw = nan is not a number"),
    (["capture", *SPHERE, "--seed", "-1"], "-1 is not a whole number from 0 up"),
    (["capture", *SPHERE, "--seed", "9" * 20], f"{'9' * 20} is more than {'9' * 18}, the largest number allowed"),
    (["capture", *SPHERE, "--seed", "9" * 9999], f"{'9' * 40} is more than {'9' * 18}, the largest number allowed"),
    (["capture", *SPHERE, "--pack", "/nowhere"], "pack /nowhere has no folder scenes"),
    (["capture", *SPHERE, "--siez", "4x4"], "unrecognized arguments: --siez 4x4"),
    (["measure", *SPHERE, "--frame", "1.5"], "1.5 is not a whole number from 0 up"),
    (["export", *SPHERE, "--out", "mesh.fbx"], "mesh.fbx ends in none of .ply, .obj, .stl, .npz"),
    (["export", *SPHERE], "the following arguments are required: --out"),
    (["capture"], "the following arguments are required: "),
    (["measur", "rippling_sphere"], "unknown command measur; did you mean measure?"),
])
def test_a_mistake_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, refused: Run, words: list[str],
                               message: str) -> None:
    """Status 2, what is wrong and what is allowed, and nothing written."""
    monkeypatch.chdir(tmp_path)
    line = refused(*words, *(["--out", "pictures"] if words[0] == "capture" and len(words) > 1 else []))
    assert message in line
    assert len(line) < 700
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("words", [["capture"], ["export"]])
def test_what_cannot_be_written_is_one_line(tmp_path: Path, refused: Run, words: list[str]) -> None:
    """A path under a regular file stops root too; the file is unharmed and alone."""
    file = tmp_path / "file"
    file.write_text("precious")
    for folder in (file, file / "deeper"):
        out = folder if words == ["capture"] else folder / "mesh.ply"
        assert f"cannot write {folder}/" in refused(*words, *SPHERE, "--out", out)
    assert [each.name for each in tmp_path.iterdir()] == ["file"]
    assert file.read_text() == "precious"


@pytest.mark.parametrize(("source", "message"), [
    ("class", "tile cannot be loaded: tile.py:1: SyntaxError: "),
    ("import no_such_module", "tile cannot be loaded: tile.py:1: ModuleNotFoundError: "),
    ("x = 1", "one class derived from Scene is expected, not 0"),
    (packs.TILE + packs.WALK, "one class derived from Scene is expected, not 2"),
    (packs.failing("__init__"), "tile failed to build: tile.py:"),
    (packs.failing("draw"), "tile failed in draw: tile.py:"),
    (packs.failing("update"), "tile failed in update: tile.py:"),
    (packs.failing("draw", "raise RuntimeError('two\\n lines')"), "RuntimeError: two lines"),
])
def test_a_broken_scene_is_one_line(tmp_path: Path, refused: Run, scene_pack: ScenePack, source: str,
                                    message: str) -> None:
    """With its file and line, and nothing written."""
    out = tmp_path / "pictures"
    assert message in refused("capture", "tile", "--pack", scene_pack(tile=source), "--frames", "1", "--out", out)
    assert not out.exists()


def test_a_shader_that_does_not_compile_is_one_line(tmp_path: Path, refused: Run, scene_pack: ScenePack) -> None:
    """With its file and line."""
    pack = scene_pack({"shaders/tile/draw.frag": "#version 330 core\nvoid main() { oops(); }\n"}, tile=packs.TILE)
    assert "tile/draw.frag:2: " in refused("capture", "tile", "--pack", pack, "--out", tmp_path / "pictures")


def test_geometry_that_a_mesh_file_cannot_hold_is_one_line(tmp_path: Path, refused: Run, run: Run,
                                                           scene_pack: ScenePack) -> None:
    """It says which kind can."""
    bare = packs.TILE.replace('return self.array.capture({"v_value": 3}, 4)', "return {}")
    pack = scene_pack(walk=packs.WALK, bare=bare)
    assert "has position and no triangles; export it as .npz" in refused(
        "export", "walk", "--pack", pack, "--out", tmp_path / "a.ply")
    assert "has no geometry to export" in refused("export", "bare", "--pack", pack, "--out", tmp_path / "a.npz")
    run("export", "walk", "--pack", pack, "--out", tmp_path / "a.npz", "--frame", 3)
    assert list(np.load(tmp_path / "a.npz")) == ["position"]


# Processes of their own

@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="EGL and Mesa's variables")
@pytest.mark.parametrize(("variables", "message"), [
    ({"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent"}, "EGL finds no driver"),
    ({"LIBGL_DRIVERS_PATH": "/nonexistent"}, "EGL has no driver that starts"),
    ({"MESA_GL_VERSION_OVERRIDE": "2.1"}, "the driver's OpenGL is older than 3.3"),
])
def test_a_missing_driver_is_one_line_with_its_remedy(tmp_path: Path, variables: dict[str, str], message: str,
                                                      only_context: moderngl.Context) -> None:
    """What is missing and what helps; the doctor says it too."""
    if "Mesa" not in only_context.info["GL_VERSION"]:
        pytest.skip("not Mesa")
    for words in (["capture", *SPHERE, "--out", tmp_path / "pictures"], ["doctor"]):
        done = demoscope(*words, **variables)
        errors = [line for line in done.stderr.splitlines() if line.startswith("error: ")]
        assert (done.returncode, len(errors)) == (2, 1)
        assert "Traceback" not in done.stderr
        assert message in done.stdout + done.stderr
        assert "install" in done.stdout + done.stderr or "update" in done.stdout + done.stderr
    assert not (tmp_path / "pictures").exists()


def test_the_window_s_modules_stay_out_of_captures(tmp_path: Path) -> None:
    """Nothing of the window, and no mesh library but for export, whichever command it is."""
    code = f"""
import sys
from viewer.cli import main
sphere, out = {SPHERE!r}, {str(tmp_path)!r}
assert main(["capture", *sphere, "--out", out, "--size", "8x8"]) == 0
assert main(["measure", *sphere]) == main(["list", "--json"]) == main(["doctor"]) == 0
heavy = {{"trimesh", "scipy"}} & set(sys.modules)
assert main(["export", *sphere, "--out", out + "/s.ply"]) == 0
of_the_window = ("imgui_bundle", "moderngl_window", "glfw", "pyglet", "viewer.ui")
window = [name for name in sys.modules if name.startswith(of_the_window)]
print("loaded:", sorted(heavy), window)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.stdout.splitlines()[-1] == "loaded: [] []", done.stderr


@pytest.mark.skipif(os.name != "posix", reason="needs a shell")
def test_a_reader_that_goes_away_is_no_error() -> None:
    """As with ``| head -1``: no word on stderr, whether the pipe breaks while printing or at the end."""
    for words in (["measure", *SPHERE], ["list", "--json"]):
        reader, writer = os.pipe()
        os.close(reader)
        with os.fdopen(writer, "w") as pipe:
            command = [sys.executable, "-m", "viewer", *words]
            done = subprocess.run(command, stdout=pipe, stderr=subprocess.PIPE, text=True, check=False)
        assert (done.returncode, done.stderr) == (141, "")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_full_disk_is_one_line(tmp_path: Path) -> None:
    """For what is printed and for what is written."""
    with Path("/dev/full").open("w") as full:
        done = subprocess.run([sys.executable, "-m", "viewer", "list"], stdout=full, stderr=subprocess.PIPE, text=True,
                              check=False)
    assert (done.returncode, done.stderr) == (2, "error: cannot print: No space left on device\n")
    limit = "import resource, sys; resource.setrlimit(resource.RLIMIT_FSIZE, (500, 500)); from viewer.cli import main; "
    for words in (["capture", *SPHERE, "--out", str(tmp_path)], ["export", *SPHERE, "--out", str(tmp_path / "s.ply")]):
        command = [sys.executable, "-c", f"{limit}sys.exit(main({words!r}))"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 2
        assert done.stderr.startswith("error: cannot write ") and done.stderr.endswith("File too large\n")
        assert done.stderr.count("\n") == 1
        assert list(tmp_path.iterdir()) == []


def heed_interrupts() -> None:
    """What a shell runs in the background ignores them, and so would all that it starts."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@pytest.mark.skipif(os.name != "posix", reason="POSIX signals")
def test_ctrl_c_ends_a_capture_at_once(tmp_path: Path) -> None:
    """Status 130, no traceback, and every picture there is a whole one."""
    command = [sys.executable, "-m", "viewer", "capture", *SPHERE, "--out", str(tmp_path), "--frames", "0:100000"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                               preexec_fn=heed_interrupts)
    end = time.monotonic() + 20
    while len(list(tmp_path.glob("*.png"))) < 3 and time.monotonic() < end:
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=20)
    assert process.returncode == 130
    assert "Traceback" not in errors
    assert [path.name for path in tmp_path.iterdir() if path.name.startswith(".")] == []
    assert all(pixels(path).shape == (360, 640, 4) for path in tmp_path.iterdir())


@pytest.mark.skipif(os.name != "posix", reason="a POSIX shell")
@pytest.mark.parametrize(("closed", "words", "status"), [
    (">&-", ["list"], 0), ("2>&-", ["capture", *SPHERE, "--frames", "0:11", "--out", "."], 0),
    (">&- 2>&-", ["measure", "nope"], 2)])
def test_streams_may_be_closed(tmp_path: Path, closed: str, words: list[str], status: int) -> None:
    """As some services start their programs: what there is to say goes nowhere, the work is done."""
    command = ["sh", "-c", f'exec "$0" "$@" {closed}', sys.executable, "-m", "viewer", *words]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path,
                          env={**os.environ, "PYTHONPATH": str(Path.cwd())})
    assert (done.returncode, done.stderr) == (status, "")


def test_a_name_that_the_terminal_cannot_write_is_no_error(tmp_path: Path) -> None:
    """The picture is there; its name is printed as far as the terminal's letters go."""
    done = demoscope("capture", *SPHERE, "--size", "8x8", "--out", str(tmp_path / "\u00fc"), PYTHONIOENCODING="ascii")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.strip().endswith("\\xfc/rippling_sphere-000000.png")


@pytest.mark.parametrize(("where", "body", "command"), [
    ("measure", "return {'depth': 'deep'}", "measure"), ("measure", "return [1, 2]", "measure"),
    ("geometry", "return {'vertices': ['x'], 'triangles': [[0, 1, 2]]}", "export"),
    ("measure", "self.remarks = lambda: 3", "measure"), ("measure", "self.remarks = lambda: 1 / 0", "measure"),
    ("geometry", "return {'vertices': [[0, 0, 0]], 'triangles': [[0, 1, 2]]}", "export")])
def test_what_no_scene_may_give_is_one_line(tmp_path: Path, refused: Run, scene_pack: ScenePack, where: str, body: str,
                                            command: str) -> None:
    pack = scene_pack(tile=packs.failing(where, body))
    words = ["--out", str(tmp_path / "tile.ply")] if command == "export" else []
    refused(command, "tile", "--pack", str(pack), *words)


@pytest.mark.parametrize("where", ["__init__", "draw", "update"])
def test_a_scene_that_exits_is_one_line(tmp_path: Path, refused: Run, scene_pack: ScenePack, where: str) -> None:
    pack = scene_pack(tile=packs.failing(where, "raise SystemExit(3)"))
    line = refused("capture", "tile", "--pack", str(pack), "--out", str(tmp_path), "--frames", "1", "--size", "8x8")
    assert "SystemExit: 3" in line


def test_a_capture_with_panels_fails_with_its_scene(tmp_path: Path, refused: Run, scene_pack: ScenePack) -> None:
    """A picture of the message would pass for a good one."""
    pack = scene_pack(tile=packs.failing("draw"))
    line = refused("capture", "tile", "--pack", str(pack), "--out", str(tmp_path), "--panels")
    assert "tile failed in draw" in line
