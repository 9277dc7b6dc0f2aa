"""Sources of small scenes and shaders from which the tests make packs."""

from __future__ import annotations

# A triangle over the whole picture, far nearer than the backdrop, in one colour.
SHADERS = {
    "shaders/tile/draw.vert": """#version 330 core
out vec3 v_value;
uniform float u_height;
void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    v_value = vec3(u_height, float(gl_VertexID), 1.0);
    gl_Position = vec4(corner, 0.0, 1.0);
}
""",
    "shaders/tile/draw.frag": """#version 330 core
uniform float u_shade;
in vec3 v_value;
out vec4 out_color;
void main() {
    out_color = vec4(vec3(u_shade) + 0.0 * v_value, 1.0);
}
""",
}

# Shows the parameter ``shade``; ``sides`` needs a new scene.
TILE = '''
from viewer import Parameters, Scene, Studio, integer, slider

class Tile(Scene):
    """A tile of one shade."""

    class Params(Parameters):
        shade: float = slider(0.25, 0.0, 1.0, "How bright")
        height: float = slider(2.0, 0.0, 5.0, "What is captured")
        sides: int = integer(4, 1, 12, "How many sides", rebuild=True)

    studio = Studio(ground=None)

    def __init__(self, gpu, params):
        if params.sides == 7:
            raise ValueError("seven sides cannot be drawn")
        self.program = gpu.program("tile/draw.vert", "tile/draw.frag")
        self.array = gpu.vertex_array(self.program)
        self.built_with = params.sides

    def draw(self):
        self.array.render(vertices=3)

    def geometry(self):
        return self.array.capture({"v_value": 3}, 4)

    def measure(self):
        return {"sides": self.built_with, "frame": self.frame}
'''

# Each frame follows from the one before, by chance and by a parameter; the shade shows the state.
WALK = '''
import numpy as np

from viewer import Parameters, Scene, Studio, integer, slider

class Walk(Scene):
    """A shade that wanders."""

    class Params(Parameters):
        stride: float = slider(0.1, 0.0, 1.0, "How far a step goes")
        breaks_at: int = integer(1000, 0, 1000, "The frame at which update fails", rebuild=True)

    studio = Studio(ground=None)

    def __init__(self, gpu, params):
        self.params = params
        self.program = gpu.program("tile/draw.vert", "tile/draw.frag")
        self.array = gpu.vertex_array(self.program)
        self.random = np.random.default_rng(params.seed)
        self.steps = 0
        self.place = 0.5

    def update(self, dt):
        assert abs(dt - 1 / 60) < 1e-12
        self.steps += 1
        if self.steps == self.params.breaks_at:
            raise RuntimeError("stumbled")
        self.place = (3.7 * self.place * (1 - self.place) + self.params.stride * self.random.random()) % 1.0

    def draw(self):
        self.program["u_shade"] = self.place
        self.array.render(vertices=3)

    def geometry(self):
        return {"position": np.array([[self.place]])}

    def measure(self):
        return {"steps": self.steps, "place": self.place}
'''


def failing(where: str, statement: str = "raise KeyError('depth')") -> str:
    """The tile, with ``statement`` as the first of its method ``where``."""
    head = f"    def {where}(self):\n"
    if where == "__init__":
        head = "    def __init__(self, gpu, params):\n"
    if where == "update":
        return TILE + f"\n    def update(self, dt):\n        {statement}\n"
    assert TILE.count(head) == 1
    return TILE.replace(head, f"{head}        {statement}\n")


def line_of(source: str, statement: str) -> int:
    """The number, from 1, of the first line of ``source`` that holds ``statement``."""
    return next(number for number, line in enumerate(source.splitlines(), 1) if statement in line)
