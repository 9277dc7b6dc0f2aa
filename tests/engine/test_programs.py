"""Programs on the driver at hand: errors located, bad edits survived, and nothing above OpenGL 3.3."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import moderngl
import numpy as np
import pytest

from tests import packs
from tests.conftest import MakeStage
from viewer.engine.gpu import Gpu, GpuError
from viewer.engine.scene import SceneError
from viewer.engine.shaders import ShaderError
from viewer.engine.stage import Stage

FRAGMENT = packs.SHADERS["shaders/tile/draw.frag"]
WITH_INCLUDE = FRAGMENT.replace("in vec3", '#include "lib/outer.glsl"\nin vec3').replace("vec3(u_shade)", "outer()")
OUTER = '#include "lib/inner.glsl"\nvec3 outer() {\n    return inner();\n}\n'
INNER = "uniform float u_inner;\nvec3 inner() {\n    return vec3(0.5) + 0.0 * u_inner;\n}\n"
MISMATCHED = WITH_INCLUDE.replace("vec3 v_value", "vec2 v_value").replace("0.0 * v_value", "v_value.x")
INCLUDES = {"shaders/lib/outer.glsl": OUTER, "shaders/lib/inner.glsl": INNER, "shaders/tile/draw.frag": WITH_INCLUDE}
Edit = Callable[[str, str], None]


def shaders_of(stage: Stage) -> Path:
    return stage.entry.pack / "shaders"


def grey(stage: Stage) -> int:
    """The picture's one colour."""
    pixels = stage.pixels()[..., :3]
    assert int(pixels.max()) - int(pixels.min()) <= 1       # the dither
    return round(float(pixels.mean()))


@pytest.mark.parametrize(("file", "content", "place"), [
    ("tile/draw.frag", FRAGMENT.replace("vec3(u_shade)", "vec3(u_shad)"), "tile/draw.frag:6: `u_shad' undeclared"),
    ("tile/draw.vert", packs.SHADERS["shaders/tile/draw.vert"].replace("float(gl", "flot(gl"), "tile/draw.vert:6: "),
    ("lib/outer.glsl", OUTER.replace("inner()", "innr()"), "lib/outer.glsl:3: "),
    ("lib/inner.glsl", INNER.replace("vec3(0.5)", "vec2(0.5)"), "lib/inner.glsl:3: "),
    ("lib/inner.glsl", "vec3 inner();\n", "tile/draw.frag: "),
    ("tile/draw.frag", MISMATCHED, "tile/draw.frag: "),
])
def test_an_error_is_told_by_file_and_line(make_stage: MakeStage, file: str, content: str, place: str) -> None:
    """In the file where it is, through two includes too; a link error by the program."""
    with pytest.raises(ShaderError) as refused:
        make_stage(files={**INCLUDES, f"shaders/{file}": content})
    assert str(refused.value).startswith(place)
    assert "\n" not in str(refused.value)


def test_an_error_in_a_generated_include_is_told_as_such(make_stage: MakeStage) -> None:
    """By the include's name and its own line."""
    source = packs.TILE.replace('"tile/draw.frag")', '"tile/draw.frag", generated={"generated/f.glsl": lambda: TEXT})')
    files = {"shaders/tile/draw.frag": FRAGMENT.replace("in vec3", '#include "generated/f.glsl"\nin vec3')}
    with pytest.raises(ShaderError, match=r"^generated/f\.glsl:2: ") as refused:
        make_stage("TEXT = 'float f() {\\n return g(); }\\n'\n" + source, files=files)
    assert refused.value.generated


@pytest.mark.skipif(os.environ.get("MESA_GLSL_VERSION_OVERRIDE") != "330", reason="make test limits Mesa to GLSL 3.30")
@pytest.mark.parametrize("line", [
    "layout(std430) buffer Numbers { float numbers[]; };", "layout(binding = 0) uniform sampler2D u_picture;",
    "uniform image2D u_image;", "subroutine vec3 shade();",
])
def test_the_test_run_refuses_what_needs_more_than_3_3(make_stage: MakeStage, line: str) -> None:
    """So that nothing newer slips in where the driver knows it."""
    with pytest.raises(ShaderError, match=r"^tile/draw\.frag:2: "):
        make_stage(files={"shaders/tile/draw.frag": FRAGMENT.replace("core\n", f"core\n{line}\n")})


def test_a_uniform_of_another_type_is_named(make_stage: MakeStage) -> None:
    """A slider is a float; a shader that declares a vec3 cannot take it."""
    wrong = FRAGMENT.replace("float u_shade", "vec3 u_shade").replace("vec3(u_shade)", "u_shade")
    stage = make_stage(files={"shaders/tile/draw.frag": wrong})
    with pytest.raises(ShaderError, match=r"^tile/draw\.frag: uniform u_shade is of a type that does not take 0\.25$"):
        stage.render()
    (shaders_of(stage) / "tile/draw.frag").write_text(FRAGMENT)
    assert stage.refresh_shaders() is None
    grey(stage)


@pytest.fixture
def edited(make_stage: MakeStage) -> tuple[Stage, Edit]:
    """A stage whose shaders have includes, and what edits them on disk."""
    stage = make_stage(files=INCLUDES)

    def edit(name: str, content: str) -> None:
        path = shaders_of(stage) / name
        path.write_text(content)
        os.utime(path, ns=(0, path.stat().st_mtime_ns + edit.calls))
        edit.calls += 1_000_000

    edit.calls = 1_000_000
    return stage, edit


def test_an_edit_is_taken_over(edited: tuple[Stage, Edit]) -> None:
    """Of the file itself and of what it includes; parameters and other uniforms keep their values."""
    stage, edit = edited
    before = grey(stage)
    edit("lib/inner.glsl", INNER.replace("0.5", "0.1"))
    assert stage.refresh_shaders() is None
    assert grey(stage) < before - 20
    edit("tile/draw.frag", FRAGMENT)
    stage.set(shade=0.9)
    assert stage.refresh_shaders() is None
    assert grey(stage) > before


@pytest.mark.parametrize(("name", "broken", "whole", "place"), [
    ("lib/inner.glsl", INNER.replace(";", "", 1), INNER.replace("0.5", "0.9"), "lib/inner.glsl:2: "),
    ("tile/draw.frag", WITH_INCLUDE.replace("core", "compatibility"), WITH_INCLUDE, "tile/draw.frag:1: the first line"),
    ("tile/draw.frag", WITH_INCLUDE.replace("outer.", "out."), WITH_INCLUDE, "tile/draw.frag:3: no shader file lib"),
    ("tile/draw.frag", "", WITH_INCLUDE, "tile/draw.frag:1: the first line"),
    ("tile/draw.frag", MISMATCHED, WITH_INCLUDE, "tile/draw.frag: "),
])
def test_a_bad_edit_leaves_the_last_good_program(edited: tuple[Stage, Edit], name: str, broken: str, whole: str,
                                                 place: str) -> None:
    """The picture goes on, the error stands until the file is mended, then the new text draws."""
    stage, edit = edited
    before = grey(stage)
    edit(name, broken)
    for _ in range(3):
        error = stage.refresh_shaders()
        assert str(error).startswith(place)
        assert grey(stage) == before
    with pytest.raises(ShaderError):
        stage.set(height=3, sides=5)        # which needs a new scene, and that the broken file
    assert (stage.params.height, stage.params.sides, grey(stage)) == (2, 4, before)
    edit(name, whole)
    assert stage.refresh_shaders() is None
    assert (grey(stage) == before) == (whole == WITH_INCLUDE)


def test_a_missing_include_that_appears_mends_the_program(edited: tuple[Stage, Edit]) -> None:
    """Without touching the file that includes it."""
    stage, edit = edited
    edit("tile/draw.frag", WITH_INCLUDE.replace("outer.glsl", "late.glsl"))
    assert "no shader file lib/late.glsl" in str(stage.refresh_shaders())
    (shaders_of(stage) / "lib/late.glsl").write_text("vec3 outer() { return vec3(0.9); }\n")
    assert stage.refresh_shaders() is None
    assert grey(stage) > 180


def test_a_deleted_file_is_an_error_until_it_is_back(edited: tuple[Stage, Edit]) -> None:
    """Editors delete and rename while they save."""
    stage, edit = edited
    before = grey(stage)
    (shaders_of(stage) / "lib/inner.glsl").unlink()
    assert str(stage.refresh_shaders()).startswith("lib/outer.glsl:1: no shader file lib/inner.glsl")
    assert grey(stage) == before
    edit("lib/inner.glsl", INNER)
    assert stage.refresh_shaders() is None


def test_captures_are_what_the_vertex_shader_computed(make_stage: MakeStage) -> None:
    """Each output apart, in vertex order, in single precision; parameters reach it."""
    stage = make_stage(params={"height": 3.5})
    value = stage.geometry()["v_value"]
    assert value.dtype == np.float32
    assert value.tolist() == [[3.5, 0, 1], [3.5, 1, 1], [3.5, 2, 1], [3.5, 3, 1]]
    stage.set(height=1)
    assert stage.geometry()["v_value"][0, 0] == 1.0


def test_attributes_that_a_purpose_does_not_use_are_passed_over(make_stage: MakeStage) -> None:
    """The shadow map needs no normals, a picture no tags; neither may upset the ones beside them, nor GL."""
    declared = "in vec2 in_middle;\nin float in_last;\nuniform"
    vertex = packs.SHADERS["shaders/tile/draw.vert"].replace("uniform", declared)
    vertex = vertex.replace("v_value = vec3(u_height, float(gl_VertexID)", "v_value = vec3(in_middle.y, in_last")
    arrays = '''numbers = np.arange(24, dtype="f4").reshape(4, 6)
        mixed = np.array([((0, 0, 0, 0), 10 * n) for n in range(4)], [("tint", "u1", 4), ("last", "f4")])
        self.array = gpu.vertex_array(self.program, [
            (gpu.buffer(numbers), "3f 2f 1x4 /v", "in_first", "in_middle"),
            (gpu.buffer(mixed), "4f1 1f", "in_tint", "in_last"), (gpu.buffer(numbers), "1f 20x /i", "in_each")])'''
    source = packs.TILE.replace("self.array = gpu.vertex_array(self.program)", arrays)
    stage = make_stage(f"import numpy as np\n{source}", files={"shaders/tile/draw.vert": vertex})
    stage.render()
    assert stage.geometry()["v_value"].tolist() == [[4 + 6 * n, 10 * n, 1] for n in range(4)]


def test_capturing_what_is_not_there_names_it(make_stage: MakeStage) -> None:
    """As a link error of the program."""
    stage = make_stage(packs.TILE.replace('"v_value": 3', '"v_other": 3'))
    with pytest.raises(ShaderError, match=r"^tile/draw\.frag: .*v_other"):
        stage.geometry()


@pytest.mark.parametrize("size", [(0, 4), (4, 0), (-1, 4), (100_000, 4), (4, 100_000)])
def test_sizes_beyond_the_driver_are_refused_before_it_fails_silently(context: moderngl.Context, make_stage: MakeStage,
                                                                      size: tuple[int, int]) -> None:
    """Textures, depth textures and pictures, by their size and the limit."""
    stage = make_stage()
    gpu = Gpu(context, stage.entry.shaders)
    limit = context.info["GL_MAX_TEXTURE_SIZE"]
    for attempt in (lambda: gpu.texture(size, 4), lambda: gpu.depth_texture(size), lambda: stage.resize(size)):
        with pytest.raises(GpuError, match=f"of {size[0]}x{size[1]} is outside 1x1 to {limit}x{limit}"):
            attempt()
    gpu.release()


def test_an_arena_frees_what_it_made_and_what_it_was_given(context: moderngl.Context, make_stage: MakeStage) -> None:
    """The ``context`` fixture counts what is left; releasing twice does no harm."""
    gpu = Gpu(context, make_stage().entry.shaders)
    texture = gpu.texture((4, 4), 4, np.zeros((4, 4, 4), "u1"), label="picture")
    gpu.framebuffer([texture], gpu.depth_renderbuffer((4, 4)))
    program = gpu.program("tile/draw.vert", "tile/draw.frag")
    gpu.vertex_array(program, [(gpu.buffer(np.zeros(3, "f4")), "1f", "in_unused")]).capture({"v_value": 3}, 2)
    gpu.own(context.buffer(reserve=4), "made elsewhere")
    gpu.release()
    gpu.release()


def test_a_scene_that_fails_half_way_leaves_nothing(make_stage: MakeStage) -> None:
    """What its constructor had made by then is freed again."""
    made = "        gpu.buffer(reserve=64)\n        1 / 0\n"
    source = packs.TILE.replace("        self.built_with", f"{made}        self.built_with")
    with pytest.raises(SceneError, match="ZeroDivisionError"):
        make_stage(source)
