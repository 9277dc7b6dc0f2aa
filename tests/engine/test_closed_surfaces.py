"""A surface said to be closed: the same picture for less work, and nothing of its inside."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tests.conftest import MakeStage

BALL = '''
import numpy as np
from viewer import Parameters, Scene, toggle
from viewer.kit import mesh

class Ball(Scene):
    """A ball, closed or not, perhaps inside out."""

    class Params(Parameters):
        closed: bool = toggle(False, "Promise that only its outside is seen", rebuild=True)
        inside_out: bool = toggle(False, "Turn its triangles around", rebuild=True)

    def __init__(self, gpu, params):
        vertices, triangles = mesh.ico_sphere(3)
        program = gpu.program("ball/draw.vert", "ball/draw.frag")
        order = triangles[:, ::-1] if params.inside_out else triangles
        self.ball = gpu.vertex_array(program, [(gpu.buffer(vertices.astype("f4")), "3f", "in_position")],
                                     gpu.buffer(np.ascontiguousarray(order)), closed=params.closed)

    def draw(self):
        self.ball.render()
'''
SHADERS = {
    "shaders/ball/draw.vert": """#version 330 core
#include "lib/frame.glsl"
in vec3 in_position;
out vec3 v_normal;
void main() { v_normal = in_position; gl_Position = u_frame.view_projection * vec4(in_position, 1.0); }
""",
    "shaders/ball/draw.frag": """#version 330 core
in vec3 v_normal;
out vec4 out_color;
void main() { out_color = vec4(gl_FrontFacing ? vec3(0.9, 0.1, 0.1) : vec3(0.1, 0.1, 0.9), 1.0); }
""",
}


def picture(make_stage: MakeStage, **params: object) -> NDArray[np.int16]:
    """The ball at 64 x 64."""
    stage = make_stage(BALL, name="ball", files=SHADERS, size=(64, 64), params=params)
    return stage.pixels().astype(np.int16)


def test_a_closed_surface_looks_the_same(make_stage: MakeStage) -> None:
    """Its inside was hidden anyway; its shadow stays."""
    assert np.array_equal(picture(make_stage, closed=False), picture(make_stage, closed=True))


def test_the_inside_of_a_closed_surface_is_left_out(make_stage: MakeStage) -> None:
    """Inside out, the near half is left out and nothing faces the camera but the far half's outside."""
    shown = picture(make_stage, closed=False, inside_out=True)[32, 32]
    left_out = picture(make_stage, closed=True, inside_out=True)[32, 32]
    assert shown[2] > shown[0] + 50        # the near half, seen from behind
    assert left_out[0] > left_out[2] + 50  # through it, the far half, which faces us


def test_the_studio_is_drawn_whole_after_a_closed_surface(make_stage: MakeStage) -> None:
    """Leaving out back faces ends with the surface: floor and backdrop cover all the rest."""
    corners = picture(make_stage, closed=True)[[0, 0, -1, -1], [0, -1, 0, -1], :3]
    assert (corners > 40).all()


def test_the_floor_hides_nothing_from_below(make_stage: MakeStage) -> None:
    """A camera that dives under the floor still sees the ball."""
    stage = make_stage(BALL, name="ball", files=SHADERS, size=(64, 64))
    for pitch in (20.0, -20.0, -80.0):
        stage.camera.stand({"pitch": pitch})
        red, _, blue, _ = stage.pixels()[32, 32].astype(int)
        assert red > blue + 50, f"at a pitch of {pitch} degrees"
