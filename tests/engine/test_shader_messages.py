"""Shader files: includes flattened, and every driver's complaints brought back to file and line."""

from __future__ import annotations

from pathlib import Path

import pytest

from viewer.engine.shaders import ShaderError, ShaderFolders, Source, explain

ROOT_FILE = """#version 330 core
#include "lib/outer.glsl"
// a comment with #include "lib/no.glsl" in it
  #  include <lib/inner.glsl> // once more, and no second time
void main() {
    gl_Position = vec4(outer());
}
"""
OUTER = '#include "lib/inner.glsl"\nfloat outer() { return inner(); }\n'
INNER = "float inner() {\n    return 1.0;\n}\n"


@pytest.fixture
def shaders(tmp_path: Path) -> Path:
    """A folder with a shader, an include, and an include of that."""
    (tmp_path / "lib").mkdir()
    (tmp_path / "draw.vert").write_text(ROOT_FILE)
    (tmp_path / "lib/outer.glsl").write_text(OUTER)
    (tmp_path / "lib/inner.glsl").write_text(INNER)
    return tmp_path


def flatten(folder: Path, name: str = "draw.vert", **generated: str) -> Source:
    made = {f"generated/{key}.glsl": (lambda text=text: text) for key, text in generated.items()}
    return ShaderFolders([folder]).flatten(name, made)


def test_includes_come_in_once_each_and_in_place(shaders: Path) -> None:
    """Recursively, with the place each line came from."""
    source = flatten(shaders)
    assert source.lines == [
        "#version 330 core", *INNER.splitlines(), "float outer() { return inner(); }",
        '// a comment with #include "lib/no.glsl" in it', "void main() {", "    gl_Position = vec4(outer());", "}"]
    assert source.origins == [
        ("draw.vert", 1), ("lib/inner.glsl", 1), ("lib/inner.glsl", 2), ("lib/inner.glsl", 3), ("lib/outer.glsl", 2),
        ("draw.vert", 3), ("draw.vert", 5), ("draw.vert", 6), ("draw.vert", 7)]
    assert source.files == {shaders / name for name in ("draw.vert", "lib/outer.glsl", "lib/inner.glsl")}


def test_a_cycle_ends(shaders: Path) -> None:
    """Each file once holds for files that include each other, and themselves."""
    (shaders / "lib/inner.glsl").write_text('#include "lib/outer.glsl"\n#include "lib/inner.glsl"\n' + INNER)
    assert flatten(shaders).lines.count("float inner() {") == 1


@pytest.mark.parametrize(("file", "content", "place"), [
    ("draw.vert", '#version 330 core\n\n#include "lib/gone.glsl"\n', "draw.vert:3"),
    ("lib/outer.glsl", OUTER + '#include "lib/gone.glsl"\n', "lib/outer.glsl:3"),
])
def test_a_missing_include_is_told_where_it_stands(shaders: Path, file: str, content: str, place: str) -> None:
    """By the file and line of the include, wherever it is."""
    (shaders / file).write_text(content)
    with pytest.raises(ShaderError, match=f"^{place}: no shader file lib/gone.glsl in {shaders}"):
        flatten(shaders)


def test_a_missing_root_file_is_named(shaders: Path) -> None:
    """It has no line to tell."""
    with pytest.raises(ShaderError, match=f"^draw.frag: no shader file draw.frag in {shaders}"):
        flatten(shaders, "draw.frag")


@pytest.mark.parametrize("first", ["", "// hello", "#version 330", "#version 430 core", "#version 330 core // 4.6"])
def test_the_first_line_is_the_version(shaders: Path, first: str) -> None:
    """GLSL 3.30 core and nothing else."""
    (shaders / "draw.vert").write_text(f"{first}\nvoid main() {{}}\n")
    with pytest.raises(ShaderError, match=r"^draw.vert:1: the first line has to be #version 330 core$"):
        flatten(shaders)


def test_any_editor_s_files_are_read(shaders: Path) -> None:
    """A byte order mark and Windows line ends do no harm."""
    (shaders / "draw.vert").write_bytes(b"\xef\xbb\xbf" + ROOT_FILE.replace("\n", "\r\n").encode())
    assert flatten(shaders).lines[0] == "#version 330 core"
    (shaders / "draw.vert").write_bytes(b"#version 330 core\n\xff")
    with pytest.raises(ShaderError, match=r"^draw.vert: cannot be read"):
        flatten(shaders)


def test_the_first_folder_that_has_a_file_wins(shaders: Path, tmp_path: Path) -> None:
    """A pack may bring its own, and falls back on the built-in library."""
    mine = tmp_path / "mine"
    (mine / "lib").mkdir(parents=True)
    (mine / "lib/inner.glsl").write_text("float inner() { return 2.0; }\n")
    source = ShaderFolders([mine, shaders]).flatten("draw.vert")
    assert "float inner() { return 2.0; }" in source.lines
    assert ("lib/outer.glsl", 2) in source.origins


def test_generated_text_is_included_by_name(shaders: Path) -> None:
    """What is not a file has lines to tell too."""
    (shaders / "lib/inner.glsl").write_text('#include "generated/f.glsl"\nfloat inner() { return f(); }\n')
    source = flatten(shaders, f="float f() {\nreturn 1.0; }\n")
    assert source.origins[1:4] == [("generated/f.glsl", 1), ("generated/f.glsl", 2), ("lib/inner.glsl", 2)]


# What drivers say of line 5 of the flattened text, which is line 2 of lib/outer.glsl. NVIDIA's own heading
# and moderngl's, warnings ahead of the error, and several errors, of which the first is the one to mend.
MODERNGL = "GLSL Compiler failed\n\n{stage}_shader\n{line}\n{text}\n"
MESA = "0:5(33): error: `innr' undeclared\n0:5(33): error: cannot construct `float' from a non-numeric data type\n"
MESSAGES = {
    "Mesa": (MESA, "`innr' undeclared"),
    "Mesa, warned before": ("0:2(7): warning: `a' used uninitialized\n" + MESA, "`innr' undeclared"),
    "Mesa's preprocessor": ("0:5(2): preprocessor error: #if with no expression\n", "#if with no expression"),
    "NVIDIA": ('0(5) : error C1503: undefined variable "innr"\n0(6) : error C0000: syntax error\n',
               'undefined variable "innr"'),
    "NVIDIA, warned before": ('0(2) : warning C7050: "a" might be used before being initialized\n'
                              '0(5) : error C1503: undefined variable "innr"\n', 'undefined variable "innr"'),
    "Apple": ("ERROR: 0:5: Use of undeclared identifier 'innr'\nERROR: 0:5: Invalid call of 'float'\n",
              "Use of undeclared identifier 'innr'"),
    "Apple, warned before": ("WARNING: 0:2: extension 'GL_ARB_x' is not supported\n"
                             "ERROR: 0:5: Use of undeclared identifier 'innr'\n",
                             "Use of undeclared identifier 'innr'"),
    "Intel": ("ERROR: 0:5: 'innr' : undeclared identifier \nERROR: 0:5: '' : compilation terminated \n"
              "ERROR: 2 compilation errors.  No code generated.\n", "'innr' : undeclared identifier"),
    "AMD": ("ERROR: 0:5: error(#143) Undeclared identifier: innr\nERROR: error(#273) 1 compilation errors.\n",
            "error(#143) Undeclared identifier: innr"),
}


@pytest.mark.parametrize("stage", ["vertex", "fragment"])
@pytest.mark.parametrize("driver", MESSAGES)
def test_a_driver_s_message_finds_its_file_and_line(shaders: Path, driver: str, stage: str) -> None:
    """In the stage that the message is about."""
    (shaders / "other.vert").write_text("#version 330 core\n" + "// filler\n" * 9)
    sources = {f"{stage}_shader": flatten(shaders)}
    other = "fragment" if stage == "vertex" else "vertex"
    for order in ([other, stage], [stage, other]):
        sources = {f"{name}_shader": flatten(shaders, "draw.vert" if name == stage else "other.vert") for name in order}
        message, text = MESSAGES[driver]
        error = explain(MODERNGL.format(stage=stage, line="=" * 13, text=message), sources, "draw.frag")
        assert (error.place, error.line, error.text) == ("lib/outer.glsl", 2, text)
        assert str(error) == f"lib/outer.glsl:2: {text}"


LINK = "GLSL Linker failed\n\nProgram\n=======\n{}\n"


@pytest.mark.parametrize(("message", "text"), [
    ("error: vertex shader output `a' declared as type `vec3', but fragment shader input declared as type `vec2'",
     "vertex shader output `a' declared as type `vec3', but fragment shader input declared as type `vec2'"),
    ("0:2(1): warning: unused\nerror: unresolved reference to function `g'", "unresolved reference to function `g'"),
    ('Fragment info\n-------------\n(0) : error C5041: cannot locate suitable resource to bind variable "u_x".',
     '(0) : error C5041: cannot locate suitable resource to bind variable "u_x".'),
    ("ERROR: Input of fragment shader 'v_a' not written by vertex shader",
     "ERROR: Input of fragment shader 'v_a' not written by vertex shader"),
    ("", "the driver refused it without a reason"),
])
def test_link_errors_name_the_program(shaders: Path, message: str, text: str) -> None:
    """They have no line; the reason stands without headings, rulers and warnings."""
    sources = {"vertex_shader": flatten(shaders), "fragment_shader": flatten(shaders)}
    error = explain(LINK.format(message), sources, "tile/draw.frag")
    assert (error.place, error.line, error.text) == ("tile/draw.frag", 0, text)


def test_nvidia_s_linker_names_the_stage_in_a_heading(shaders: Path) -> None:
    """Its line is one of that stage."""
    (shaders / "draw.frag").write_text("#version 330 core\n" + "// filler\n" * 9)
    sources = {"vertex_shader": flatten(shaders), "fragment_shader": flatten(shaders, "draw.frag")}
    heading = "{} info\n-------------\n0(5) : error C5145: must write to gl_Position\n"
    assert str(explain(LINK.format(heading.format("Vertex")), sources, "p")).startswith("lib/outer.glsl:2: must")
    assert str(explain(LINK.format(heading.format("Fragment")), sources, "p")).startswith("draw.frag:5: must")


def test_a_line_beyond_the_text_is_no_crash(shaders: Path) -> None:
    """Drivers count oddly at the end of a file."""
    error = explain("0:999(1): error: unexpected end of file", {"vertex_shader": flatten(shaders)}, "p")
    assert str(error) == "draw.vert: unexpected end of file"
