"""A sphere of many triangles in the full studio, for measuring how fast it is drawn."""

from __future__ import annotations

from viewer import Gpu, Orbit, Parameters, Scene, Studio, integer
from viewer.kit import mesh


class BigSphere(Scene):
    """A plain sphere that swells and shrinks with time."""

    class Params(Parameters):
        bands: int = integer(300, 4, 2000, "Bands from pole to pole, and around", rebuild=True)

    camera = Orbit(yaw=28, pitch=16, distance=4.6)
    studio = Studio(radius=1.6, ground=-1.12)

    def __init__(self, gpu: Gpu, params: Params) -> None:
        vertices, triangles = mesh.uv_sphere(params.bands, params.bands)
        program = gpu.program("big_sphere/surface.vert", "big_sphere/surface.frag")
        corners = gpu.buffer(vertices.astype("f4"), label="sphere")
        self.surface = gpu.vertex_array(program, [(corners, "3f", "in_position")], gpu.buffer(triangles), closed=True)

    def draw(self) -> None:
        self.surface.render()
