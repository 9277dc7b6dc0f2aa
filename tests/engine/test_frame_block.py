"""The uniform block: every field arrives in shaders as the engine meant it."""

from __future__ import annotations

import math
import re
from pathlib import Path

import moderngl
import numpy as np
import pytest

from tests.conftest import MakeStage
from viewer.engine import labels
from viewer.engine.camera import Orbit
from viewer.engine.frame import FRAME

GLSL = Path(__file__).parents[2] / "shaders" / "lib" / "frame.glsl"
FLOATS = {"mat4": 16, "vec4": 4, "vec3": 3, "vec2": 2, "float": 1}
FIELDS = re.findall(r"^\s+(mat4|vec[234]|float) (\w+);", GLSL.read_text("utf-8"), re.MULTILINE)

# One float for each vertex: the numbers of one field after the other.
READER = """#version 330 core
#include "lib/frame.glsl"
out float v_number;
void main() {{
    int n = gl_VertexID;
    v_number = -1.0;
{cases}
    gl_Position = vec4(0.0);
}}
"""
SCENE = '''
from viewer import Orbit, Scene, Studio

class Reader(Scene):
    """Reads the frame block back."""

    camera = Orbit(40, 25, 6, (0.5, 0.25, -0.5), 42)
    studio = Studio((0.5, 0.25, -0.5), 2.5, -1.75, ("#112233", "#445566"))

    def __init__(self, gpu, params):
        self.array = gpu.vertex_array(gpu.program("reader/reader.vert"))

    def draw(self):
        pass

    def geometry(self):
        return self.array.capture({"v_number": 1}, COUNT)
'''
WITHOUT_GROUND = SCENE.replace("-1.75", "None")


def reader() -> str:
    """The shader that gives out every number of the block in order."""
    cases, start = [], 0
    for kind, name in FIELDS:
        index = f"n - {start}"
        part = {"mat4": f"[({index}) / 4][({index}) % 4]", "float": ""}.get(kind, f"[{index}]")
        cases.append(f"    if (n >= {start} && n < {start + FLOATS[kind]}) v_number = u_frame.{name}{part};")
        start += FLOATS[kind]
    return READER.format(cases="\n".join(cases))


def linear(code: str) -> list[float]:
    channels = [int(code[i:i + 2], 16) / 255 for i in (1, 3, 5)]
    return [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]


def test_the_layout_is_that_of_the_shader() -> None:
    """Same names in the same order, at the offsets that std140 prescribes."""
    assert [name for _, name in FIELDS] == list(FRAME.names or ())
    alignment = {"mat4": 16, "vec4": 16, "vec3": 16, "vec2": 8, "float": 4}
    offset = 0
    for kind, name in FIELDS:
        offset = math.ceil(offset / alignment[kind]) * alignment[kind]
        assert FRAME.fields[name][1] == offset, name
        offset += 4 * FLOATS[kind]
    assert math.ceil(offset / 16) * 16 == FRAME.itemsize


@pytest.mark.parametrize("scene", [SCENE, WITHOUT_GROUND])
def test_every_field_arrives(make_stage: MakeStage, scene: str) -> None:
    """Read back by a shader, against values worked out here."""
    count = sum(FLOATS[kind] for kind, _ in FIELDS)
    stage = make_stage(scene.replace("COUNT", str(count)), name="reader", size=(48, 30),
                       files={"shaders/reader/reader.vert": reader()})
    stage.camera.pose(Orbit(70, 10, 3, (0, 1, 0), 50))
    stage.seek(90)
    numbers = stage.geometry()["v_number"]
    read, start = {}, 0
    for kind, name in FIELDS:
        read[name] = numbers[start:start + FLOATS[kind]]
        start += FLOATS[kind]

    yaw, pitch = math.radians(70), math.radians(10)
    eye = np.array([0, 1, 0]) + 3 * np.array(
        [math.sin(yaw) * math.cos(pitch), math.sin(pitch), math.cos(yaw) * math.cos(pitch)])
    view, projection = read["view"].reshape(4, 4), read["projection"].reshape(4, 4)
    assert np.allclose(view, stage.camera.view(), atol=1e-6)
    assert np.allclose(projection, stage.camera.projection(48 / 30), atol=1e-6)
    both = read["view_projection"].reshape(4, 4)
    assert np.allclose(both, view @ projection, atol=1e-4)
    assert np.allclose(both @ read["clip_to_world"].reshape(4, 4), np.eye(4), atol=1e-3)
    assert read["eye"] == pytest.approx(eye, abs=1e-6)
    assert read["time"] == pytest.approx(1.5)
    assert read["number"] == 90
    assert list(read["resolution"]) == [48, 30]
    assert read["has_ground"] == (scene is SCENE)
    assert read["ground_height"] == (-1.75 if scene is SCENE else 0)
    assert read["center"] == pytest.approx([0.5, 0.25, -0.5])
    assert read["radius"] == 2.5
    assert np.linalg.norm(read["key_direction"]) == pytest.approx(1.0)
    assert read["key_direction"][1] > 0.5
    assert read["backdrop_low"] == pytest.approx([*linear("#112233"), 1.0], abs=1e-6)
    assert read["backdrop_high"] == pytest.approx([*linear("#445566"), 1.0], abs=1e-6)

    to_shadow = read["world_to_shadow"].reshape(4, 4).astype(float)
    assert np.append(read["center"], 1) @ to_shadow == pytest.approx([0.5, 0.5, 0.5, 1.0], abs=1e-6)
    nearest = np.append(read["center"] + 2.5 * read["key_direction"], 1) @ to_shadow
    assert nearest == pytest.approx([0.5, 0.5, 0.0, 1.0], abs=1e-6)


def test_an_object_goes_without_a_name_where_the_driver_refuses(context: moderngl.Context) -> None:
    """An error left over from before costs the label, not the picture."""
    buffer = context.buffer(reserve=4)
    context.enable_direct(0xBAD)                    # GL_INVALID_ENUM, pending
    labels.label(buffer, "x" * 1000)
    assert context.error == "GL_NO_ERROR"
    labels.label(buffer, "named")
    assert buffer.label == "named"
    buffer.release()
