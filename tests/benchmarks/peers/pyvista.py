"""PyVista, off-screen."""

from __future__ import annotations

import sys
from collections.abc import Callable

import numpy as np
import pyvista
from numpy.typing import NDArray

from tests.benchmarks.sphere import COLOR, SIZE, big_sphere, eye, small_sphere

DISTANCE = 4.6


def plotter_of(vertices: NDArray[np.float64], triangles: NDArray[np.int32]) -> pyvista.Plotter:
    """A plotter with a smooth mesh in it."""
    plotter = pyvista.Plotter(off_screen=True, window_size=SIZE)
    surface = pyvista.PolyData.from_regular_faces(vertices.astype("f4"), triangles)
    surface.point_data.active_normals = vertices.astype("f4")
    plotter.add_mesh(surface, smooth_shading=True, color=COLOR)
    return plotter


def frames(samples: str) -> Callable[[int], object]:
    """Frames of the large sphere."""
    plotter = plotter_of(*big_sphere())
    if int(samples):
        plotter.enable_anti_aliasing("msaa", multi_samples=int(samples))
    else:
        plotter.disable_anti_aliasing()
        plotter.render_window.SetMultiSamples(0)
    plotter.camera.view_angle = 35.0
    plotter.camera.focal_point = (0.0, 0.0, 0.0)
    plotter.camera.up = (0.0, 1.0, 0.0)

    def draw(number: int) -> object:
        plotter.camera.position = eye(number, DISTANCE)
        plotter.renderer.reset_camera_clipping_range()
        plotter.render()
        return plotter.screenshot(None, return_img=True)

    return draw


if __name__ == "__main__":
    plotter_of(*small_sphere()).screenshot(sys.argv[1])
