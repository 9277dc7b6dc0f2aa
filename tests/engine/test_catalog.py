"""Finding scenes in packs, and what is said of those that cannot be loaded."""

from __future__ import annotations

import json
from importlib.metadata import EntryPoint
from pathlib import Path

import pytest

from tests import packs
from tests.conftest import ScenePack
from viewer.engine import catalog
from viewer.engine.catalog import Catalog, summary
from viewer.engine.scene import SceneError

BROKEN = {
    "class Tile(": r"tile\.py:1: SyntaxError: ",
    "import numpy\nx = (\n": r"tile\.py:2: SyntaxError: '\(' was never closed",
    "import no_such_module": r"tile\.py:1: ModuleNotFoundError: No module named 'no_such_module'",
    "from viewer import Skene": r"tile\.py:1: ImportError: ",
    "\n\n1 / 0": r"tile\.py:3: ZeroDivisionError: division by zero",
    "x = 1": "one class derived from Scene is expected, not 0",
    packs.TILE + packs.WALK: "one class derived from Scene is expected, not 2",
    "raise SystemExit(3)": r"tile\.py:1: SystemExit: 3",
    "x = '\0'": "null byte",
    "from viewer import Parameters, slider\nclass P(Parameters):\n    a = slider(5, 0, 1, '')\n":
        r"tile\.py:3: ParameterError: default = 5 is outside 0 to 1",
}


@pytest.mark.parametrize("source", BROKEN)
def test_a_scene_file_that_cannot_be_loaded_says_where(scene_pack: ScenePack, source: str) -> None:
    """In one line, with the file and the line at fault."""
    entry = Catalog([scene_pack(tile=source)]).find("tile")
    with pytest.raises(SceneError, match=BROKEN[source]) as refused:
        entry.load()
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("content", [b"\xff\xfe", "# -*- coding: latin-1 -*-\nname = 'é'\n".encode("latin-1")])
def test_a_file_of_odd_bytes_is_no_crash(scene_pack: ScenePack, content: bytes) -> None:
    """It is either read as Python reads it, or refused."""
    pack = scene_pack(tile="")
    (pack / "scenes/tile.py").write_bytes(content)
    with pytest.raises(SceneError, match=r"tile\.py"):
        Catalog([pack]).find("tile").load()


def test_a_byte_order_mark_does_no_harm(scene_pack: ScenePack) -> None:
    """Some editors on Windows write one."""
    pack = scene_pack(tile="")
    (pack / "scenes/tile.py").write_bytes(b"\xef\xbb\xbf" + packs.TILE.encode())
    assert summary(Catalog([pack]).find("tile").load()) == "A tile of one shade."


def test_imported_scenes_do_not_count(scene_pack: ScenePack) -> None:
    """Only a class that the file itself defines is its scene."""
    assert Catalog([scene_pack(tile=packs.TILE)]).find("tile").load().__name__ == "Tile"


def test_the_first_pack_wins_and_files_with_an_underscore_are_no_scenes(scene_pack: ScenePack, tmp_path: Path) -> None:
    """A pack may replace a built-in scene by its name."""
    pack = scene_pack(rippling_sphere=packs.TILE, _common="x = 1", another=packs.WALK)
    other = tmp_path / "other"
    (other / "scenes").mkdir(parents=True)
    (other / "scenes/another.py").write_text("")
    entries = {entry.name: entry for entry in Catalog([pack, other]).entries()}
    assert {"rippling_sphere", "another"} <= set(entries)
    assert "_common" not in entries
    assert entries["rippling_sphere"].pack == entries["another"].pack == pack
    assert Catalog([pack]).find("another").load().__name__ == "Walk"


@pytest.mark.parametrize(("name", "message"), [
    ("rippling_spere", "unknown scene rippling_spere; did you mean rippling_sphere\\?; known: .*rippling_sphere"),
    ("zzz", "unknown scene zzz; known: "), ("../evil", "unknown scene ../evil"), ("", "unknown scene ; known"),
    ("x" * 300, "unknown scene xxx"), ("a\0b", "unknown scene a"),
])
def test_an_unknown_scene_is_refused_with_the_nearest_name(name: str, message: str) -> None:
    """Whatever the name is made of."""
    with pytest.raises(SceneError, match=message):
        Catalog().find(name)


@pytest.mark.parametrize("pack", ["/nowhere", __file__, "x" * 300, "a\0b"])
def test_a_pack_without_scenes_is_refused(pack: str) -> None:
    """By its name."""
    with pytest.raises(SceneError, match=r"pack .* (has no folder scenes|cannot be read)"):
        Catalog([pack])


def test_installed_packs_are_found_and_the_remains_of_one_passed_over(monkeypatch: pytest.MonkeyPatch,
                                                                       scene_pack: ScenePack) -> None:
    """An entry point whose package has gone hides no other."""
    pack = scene_pack({"__init__.py": ""}, tile=packs.TILE)
    monkeypatch.syspath_prepend(str(pack.parent))
    points = [EntryPoint(name, value, catalog.ENTRY_POINTS) for name, value in
              (("gone", "no_such_package.deep:x"), ("pack", "pack"))]
    monkeypatch.setattr("importlib.metadata.entry_points", lambda group: points)
    assert Catalog().find("tile").pack == pack
    assert [entry.name for entry in Catalog().entries()].count("tile") == 1


def test_a_description_holds_every_parameter(scene_pack: ScenePack) -> None:
    """As JSON, in the order of declaration."""
    about = json.loads(json.dumps(Catalog([scene_pack(tile=packs.TILE)]).find("tile").describe()))
    assert (about["name"], about["description"]) == ("tile", "A tile of one shade.")
    assert [one["name"] for one in about["parameters"]] == ["shade", "height", "sides"]


@pytest.mark.parametrize(("line", "message"), [
    ("camera = None", "camera has to be an Orbit"),
    ("camera = Orbit(distance=0)", "camera distance = 0 is not a number from 0.001 to 10000"),
    ("camera = Orbit(yaw='left')", "camera yaw = left is not a number"),
    ("camera = Orbit(field_of_view=180)", "camera field_of_view = 180 is not a number from 1 to 170"),
    ("studio = None", "studio has to be a Studio"),
    ("studio = Studio(radius=0)", "studio radius = 0 is not a number above 0"),
    ("studio = Studio(center=(0, 0))", "studio center = (0, 0) is not three numbers"),
    ("studio = Studio(backdrop=('#zz', '#000000'))", "studio backdrop = #zz is not a colour"),
    ("studio = Studio(ground=float('nan'))", "studio ground = nan is neither a number nor None")])
def test_a_set_or_a_pose_that_cannot_be_is_refused_at_once(scene_pack: ScenePack, line: str, message: str) -> None:
    """Where it is written, not when it is first drawn: an edited scene would take the present one along."""
    source = packs.TILE.replace("import Parameters", "import Orbit, Parameters")
    source = source.replace("studio = Studio(ground=None)", line)
    with pytest.raises(SceneError) as caught:
        Catalog([scene_pack(tile=source)]).find("tile").load()
    assert message in str(caught.value)
