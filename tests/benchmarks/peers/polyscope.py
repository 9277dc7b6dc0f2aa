"""Polyscope, without a window; its floor is a mirror by default."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import polyscope
from numpy.typing import NDArray

from tests.benchmarks.sphere import COLOR, SIZE, big_sphere, eye, small_sphere, swollen

DISTANCE = 4.6


def open_with(vertices: NDArray[np.float64], triangles: NDArray[np.int32]) -> Any:
    """The library with a mesh in it."""
    polyscope.set_allow_headless_backends(True)
    polyscope.set_use_prefs_file(False)
    polyscope.set_verbosity(0)
    polyscope.init("openGL3_egl" if sys.platform.startswith("linux") else "auto")
    polyscope.set_window_size(*SIZE)
    polyscope.set_vertical_fov_degrees(35.0)
    polyscope.register_surface_mesh("sphere", vertices, triangles, smooth_shade=True, color=COLOR)
    return polyscope


def frames(ground: str, moving: str) -> Callable[[int], object]:
    """Frames of the large sphere on a ``ground`` of Polyscope's; the ``camera`` moves, or the ``mesh``."""
    vertices, triangles = big_sphere()
    scene = open_with(vertices, triangles)
    scene.set_ground_plane_mode(ground)
    mesh = scene.get_surface_mesh("sphere")

    def draw(number: int) -> object:
        if moving == "mesh":
            mesh.update_vertex_positions(swollen(vertices, number))
        else:
            scene.look_at(eye(number, DISTANCE), (0.0, 0.0, 0.0))
        return scene.screenshot_to_buffer(False)

    scene.look_at(eye(0, DISTANCE), (0.0, 0.0, 0.0))
    return draw


if __name__ == "__main__":
    open_with(*small_sphere()).screenshot(sys.argv[1], False)
