"""Polyscope, without a window; its floor is a mirror by default."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import polyscope
from numpy.typing import NDArray

from tests.benchmarks.sphere import COLOR, SIZE, big_sphere, eye, small_sphere

DISTANCE = 4.6


def open_with(vertices: NDArray[np.float64], triangles: NDArray[np.int32]) -> Any:
    """The library with a mesh in it."""
    polyscope.set_allow_headless_backends(True)
    polyscope.set_use_prefs_file(False)
    polyscope.set_verbosity(0)
    polyscope.init("openGL3_egl" if sys.platform.startswith("linux") else "")
    polyscope.set_window_size(*SIZE)
    polyscope.set_vertical_fov_degrees(35.0)
    polyscope.register_surface_mesh("sphere", vertices, triangles, smooth_shade=True, color=COLOR)
    return polyscope


def frames(ground: str) -> Callable[[int], object]:
    """Frames of the large sphere on a ``ground`` of Polyscope's."""
    scene = open_with(*big_sphere())
    scene.set_ground_plane_mode(ground)

    def draw(number: int) -> object:
        scene.look_at(eye(number, DISTANCE), (0.0, 0.0, 0.0))
        return scene.screenshot_to_buffer(False)

    return draw


if __name__ == "__main__":
    open_with(*small_sphere()).screenshot(sys.argv[1], False)
