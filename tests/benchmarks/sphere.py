"""The meshes that everybody draws, without importing the viewer: its start is one of the things measured."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

COLOR = (0.847, 0.341, 0.165)
SIZE = (640, 360)
SMALL = 5       # of ico_sphere: 20,480 triangles, as rippling_sphere starts with
BIG = 300       # of uv_sphere: 179,400 triangles


def mesh_kit() -> Any:
    """``viewer.kit.mesh``, loaded by itself."""
    path = Path(__file__).parents[2] / "viewer" / "kit" / "mesh.py"
    spec = importlib.util.spec_from_file_location("mesh_kit", path)
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def small_sphere() -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Vertices and triangles of a sphere as ``rippling_sphere`` has it."""
    vertices, triangles = mesh_kit().ico_sphere(SMALL)
    return vertices, triangles


def big_sphere() -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Vertices and triangles of a large sphere."""
    vertices, triangles = mesh_kit().uv_sphere(BIG, BIG)
    return vertices, triangles


def eye(frame: int, distance: float) -> tuple[float, float, float]:
    """Where the camera is at a frame of a turn around the sphere."""
    yaw = 0.02 * frame
    return distance * float(np.sin(yaw)), 0.28 * distance, distance * float(np.cos(yaw))


def swollen(vertices: NDArray[np.float64], frame: int) -> NDArray[np.float64]:
    """The vertices at a frame of the motion that the pack's shader makes."""
    moved: NDArray[np.float64] = (1.0 + 0.05 * np.sin(frame / 60.0)) * vertices
    return moved
