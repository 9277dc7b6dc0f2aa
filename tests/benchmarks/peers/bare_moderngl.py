"""moderngl with nothing around it: one lit mesh on a plain ground colour, the least that can be done."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from tests.benchmarks.sphere import COLOR, SIZE, big_sphere, small_sphere

VERTEX = """#version 330 core
uniform float u_turn;
uniform float u_size;
in vec3 in_position;
out vec3 v_normal;
void main() {
    mat3 turn = mat3(cos(u_turn), 0.0, -sin(u_turn), 0.0, 1.0, 0.0, sin(u_turn), 0.0, cos(u_turn));
    v_normal = turn * in_position;
    gl_Position = vec4(u_size * v_normal * vec3(360.0 / 640.0, 1.0, -1.0), 1.0);
}
"""
FRAGMENT = """#version 330 core
uniform vec3 u_color;
in vec3 v_normal;
out vec4 out_color;
void main() {
    out_color = vec4(u_color * (0.2 + 0.8 * max(dot(normalize(v_normal), vec3(-0.45, 0.8, 0.4)), 0.0)), 1.0);
}
"""


class Sphere:
    """A context, a mesh and a picture."""

    def __init__(self, vertices: NDArray[np.float64], triangles: NDArray[np.int32], samples: int) -> None:
        backend: dict[str, Any] = {"backend": "egl"} if sys.platform.startswith("linux") else {}
        self.context = moderngl.create_context(standalone=True, require=330, **backend)
        self.program = self.context.program(VERTEX, FRAGMENT)
        self.program["u_color"] = COLOR
        corners = self.context.buffer(vertices.astype("f4"))
        self.mesh = self.context.vertex_array(self.program, [(corners, "3f", "in_position")],
                                              self.context.buffer(triangles))
        self.picture = self.context.simple_framebuffer(SIZE)
        self.drawn = self.context.simple_framebuffer(SIZE, samples=samples) if samples else self.picture
        self.context.enable(moderngl.DEPTH_TEST)

    def draw(self, number: int, *, swelling: bool = False) -> NDArray[np.uint8]:
        """Frame ``number`` of a turn, or of swelling, (height, width, 3), top row first."""
        self.program["u_turn"] = 0.0 if swelling else 0.02 * number
        self.program["u_size"] = 0.69 * (1.0 + 0.05 * np.sin(number / 60.0)) if swelling else 0.69
        self.drawn.use()
        self.drawn.clear(0.6, 0.6, 0.6, 1.0, depth=1.0)
        self.mesh.render()
        if self.drawn is not self.picture:
            self.context.copy_framebuffer(self.picture, self.drawn)
        rows = np.frombuffer(self.picture.read(components=3), np.uint8).reshape(SIZE[1], SIZE[0], 3)
        return np.ascontiguousarray(rows[::-1])


def frames(samples: str, moving: str) -> Callable[[int], object]:
    """Frames of the large sphere; the ``camera`` moves, or the ``mesh``."""
    sphere = Sphere(*big_sphere(), samples=int(samples))
    return lambda number: sphere.draw(number, swelling=moving == "mesh")


if __name__ == "__main__":
    from PIL import Image

    Image.fromarray(Sphere(*small_sphere(), samples=4).draw(0)).save(sys.argv[1])
