"""Scripts: ``viewer.render`` and ``viewer.headless``."""

from __future__ import annotations

import subprocess
import sys
import threading
from pathlib import Path

import moderngl
import numpy as np
import pytest

import viewer
from tests import packs
from tests.conftest import ScenePack

SMALL = {"subdivision": 3}


def test_render_gives_a_picture(context: moderngl.Context) -> None:
    """As the contract says: bytes, height by width by four, top row first; the same each time."""
    picture = viewer.render("rippling_sphere", frame=30, size=(64, 36), params={"amplitude": 0.1, **SMALL})
    assert picture.shape == (36, 64, 4)
    assert picture.dtype == np.uint8
    assert picture.flags["C_CONTIGUOUS"]
    again = viewer.render("rippling_sphere", 30, size=(64, 36), params={"amplitude": "0.1", "subdivision": "3"})
    assert np.array_equal(picture, again)
    other = viewer.render("rippling_sphere", 30, size=(64, 36), params={"amplitude": 0.4, **SMALL})
    assert not np.array_equal(picture, other)


def test_headless_gives_a_stage_to_play_with(context: moderngl.Context) -> None:
    """Set, seek, then pixels, geometry and measurements as mappings."""
    with viewer.headless("rippling_sphere", size=(64, 36), params=SMALL, seed=5) as stage:
        stage.set(amplitude="0.2", direction="x")
        stage.seek(60)
        assert (stage.frame, stage.params.amplitude, stage.params.seed) == (60, 0.2, 5)
        assert stage.pixels().shape == (36, 64, 4)
        assert {"vertices", "triangles", "normals"} == set(stage.geometry())
        assert stage.measure()["vertices"] == len(stage.geometry()["vertices"])
        with pytest.raises(viewer.ParameterError, match=r"amplitude = 9 is outside 0 to 0.5"):
            stage.set(amplitude=9, direction="normal")
        assert stage.params.direction == "x"


def test_params_stand_above_the_preset_and_camera_above_both(context: moderngl.Context, tmp_path: Path) -> None:
    """What is said more closely wins."""
    path = tmp_path / "look.toml"
    path.write_text("[parameters]\namplitude = 0.2\nfrequency = 5\nsubdivision = 2\n[camera]\nyaw = 77\n")
    with viewer.headless("rippling_sphere", size=(8, 8), preset=path, params={"frequency": 7}) as stage:
        assert (stage.params.amplitude, stage.params.frequency, stage.camera.yaw) == (0.2, 7.0, 77.0)
        assert stage.camera.pitch == stage.scene_class.camera.pitch
    with viewer.headless("rippling_sphere", size=(8, 8), preset=path, camera=viewer.Orbit(1, 2, 3)) as stage:
        assert (stage.camera.yaw, stage.camera.distance) == (1.0, 3.0)


@pytest.mark.parametrize(("arguments", "message"), [
    ({"scene": "rippling"}, "unknown scene rippling; did you mean rippling_sphere"),
    ({"params": {"amplitud": 1}}, "unknown parameter amplitud; did you mean amplitude"),
    ({"preset": "nothing-like-it"}, "has no preset nothing-like-it"),
    ({"size": (0, 10)}, "a picture of 0x10 is outside"),
    ({"frame": -1}, "frame = -1 is before the first"), ({"packs": ["/nowhere"]}, "pack /nowhere has no folder scenes"),
    ({"packs": "/nowhere"}, "pack /nowhere has no folder scenes"),
])
def test_mistakes_are_one_family(context: moderngl.Context, arguments: dict[str, object], message: str) -> None:
    """A script may catch them all by ``viewer.DemoscopeError``; nothing is left on the GPU."""
    with pytest.raises(viewer.DemoscopeError, match=message):
        viewer.render(**{"scene": "rippling_sphere", "size": (8, 8), **arguments})


def test_an_error_inside_the_block_frees_the_stage(context: moderngl.Context) -> None:
    """The ``context`` fixture counts what is left."""
    with pytest.raises(ZeroDivisionError), viewer.headless("rippling_sphere", size=(8, 8), params=SMALL):
        _ = 1 / 0


def test_two_stages_may_be_open_at_once(context: moderngl.Context, scene_pack: ScenePack) -> None:
    """Side by side, of different scenes."""
    pack = scene_pack(tile=packs.TILE)
    alone = viewer.render("rippling_sphere", size=(32, 32), params=SMALL)
    with (viewer.headless("rippling_sphere", size=(32, 32), params=SMALL) as one,
          viewer.headless("tile", size=(8, 8), packs=[pack]) as other):
        other.pixels()
        assert np.array_equal(viewer.render("rippling_sphere", size=(32, 32), params=SMALL), alone)
        assert np.array_equal(one.pixels(), alone)
        assert other.pixels().shape == (8, 8, 4)
    assert np.array_equal(viewer.render("rippling_sphere", size=(32, 32), params=SMALL), alone)


def test_a_script_may_have_a_context_of_its_own(context: moderngl.Context) -> None:
    """Drawing goes to the right one, and the script makes its own current again, as moderngl has it."""
    alone = viewer.render("rippling_sphere", size=(32, 32), params=SMALL)
    own = moderngl.create_context(standalone=True, require=330, **(
        {"backend": "egl"} if sys.platform.startswith("linux") else {}))
    buffer = own.buffer(b"mine")
    assert np.array_equal(viewer.render("rippling_sphere", size=(32, 32), params=SMALL), alone)
    with own:
        assert buffer.read() == b"mine"
        assert own.error == "GL_NO_ERROR"
        buffer.release()
    own.release()
    assert np.array_equal(viewer.render("rippling_sphere", size=(32, 32), params=SMALL), alone)


def test_a_thread_may_draw(context: moderngl.Context) -> None:
    """Each thread has a context of its own."""
    pictures = []

    def draw() -> None:
        pictures.append(viewer.render("rippling_sphere", size=(32, 32), params=SMALL))

    thread = threading.Thread(target=draw)
    thread.start()
    thread.join()
    draw()
    assert np.array_equal(*pictures)


def test_every_public_name_is_there() -> None:
    """Names are fetched when asked for; a wrong one is an AttributeError as ever."""
    assert set(viewer.__all__) == {name for name in viewer.__all__ if getattr(viewer, name) is not None}
    with pytest.raises(AttributeError, match="sclider"):
        _ = viewer.sclider


def test_the_kit_needs_no_opengl() -> None:
    """It is importable where there is no moderngl at all."""
    modules = [path.stem for path in sorted((Path(viewer.__file__).parent / "kit").glob("*.py"))]
    code = "import sys\nfor name in ('moderngl', 'pyrr', 'PIL', 'trimesh'): sys.modules[name] = None\n"
    code += "".join(f"import viewer.kit.{name}\n" for name in modules if name != "__init__")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


def test_a_preset_s_bad_value_names_the_file(tmp_path: Path) -> None:
    """Not so a bad value given beside the preset."""
    path = tmp_path / "mine.toml"
    path.write_text("[parameters]\namplitud = 0.1\n")
    with pytest.raises(viewer.DemoscopeError, match=r"mine\.toml: unknown parameter amplitud"):
        viewer.render("rippling_sphere", size=(8, 8), preset=path)
    path.write_text("[parameters]\namplitude = 0.1\n")
    with pytest.raises(viewer.ParameterError, match=r"^amplitude = 9 is outside 0 to 0\.5$"):
        viewer.render("rippling_sphere", size=(8, 8), preset=path, params={"amplitude": 9})
