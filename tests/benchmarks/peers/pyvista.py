"""PyVista, off-screen."""

from __future__ import annotations

import sys
from collections.abc import Callable

import numpy as np
import pyvista
from numpy.typing import NDArray

from tests.benchmarks.sphere import COLOR, SIZE, big_sphere, eye, small_sphere, swollen

DISTANCE = 4.6


def plotter_of(vertices: NDArray[np.float64], triangles: NDArray[np.int32]) -> tuple[pyvista.Plotter, pyvista.PolyData]:
    """A plotter with a smooth mesh in it."""
    plotter = pyvista.Plotter(off_screen=True, window_size=list(SIZE))
    surface = pyvista.PolyData.from_regular_faces(vertices.astype("f4"), triangles)
    surface.point_data.active_normals = vertices.astype("f4")
    plotter.add_mesh(surface, smooth_shading=True, color=COLOR)
    return plotter, surface


def frames(samples: str, moving: str) -> Callable[[int], object]:
    """Frames of the large sphere; the ``camera`` moves, or the ``mesh``."""
    vertices, triangles = big_sphere()
    plotter, surface = plotter_of(vertices, triangles)
    _multisample(plotter, int(samples))
    camera = plotter.camera
    camera.view_angle, camera.focal_point, camera.up = 35.0, (0.0, 0.0, 0.0), (0.0, 1.0, 0.0)
    camera.position = eye(0, DISTANCE)

    def draw(number: int) -> object:
        if moving == "mesh":
            surface.points = swollen(vertices, number).astype("f4")
        else:
            camera.position = eye(number, DISTANCE)
        plotter.renderer.reset_camera_clipping_range()
        plotter.render()
        return plotter.screenshot(None, return_img=True)

    return draw


def _multisample(plotter: pyvista.Plotter, samples: int) -> None:
    if samples:
        plotter.enable_anti_aliasing("msaa", multi_samples=samples)
    else:
        plotter.disable_anti_aliasing()
        plotter.render_window.SetMultiSamples(0)


if __name__ == "__main__":
    plotter_of(*small_sphere())[0].screenshot(sys.argv[1])
