"""Spheres in triangles: closed, round, facing outwards, and as fine as asked."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import trimesh

from viewer.kit import mesh

SPHERES: dict[str, Callable[[], mesh.Mesh]] = {
    "uv 2x3": lambda: mesh.uv_sphere(2, 3), "uv 3x5": lambda: mesh.uv_sphere(3, 5),
    "uv 24x48": lambda: mesh.uv_sphere(24, 48),
    "cube 1": lambda: mesh.cube_sphere(1), "cube 3": lambda: mesh.cube_sphere(3),
    "cube 16": lambda: mesh.cube_sphere(16),
    "ico 0": lambda: mesh.ico_sphere(0), "ico 1": lambda: mesh.ico_sphere(1), "ico 4": lambda: mesh.ico_sphere(4),
}
COUNTS = {
    "uv 2x3": (5, 6), "uv 3x5": (12, 20), "uv 24x48": (23 * 48 + 2, 2 * 48 * 23),
    "cube 1": (8, 12), "cube 3": (56, 108),
    "cube 16": (6 * 256 + 2, 12 * 256), "ico 0": (12, 20), "ico 1": (42, 80), "ico 4": (2562, 5120),
}


@pytest.mark.parametrize("name", SPHERES)
def test_a_sphere_is_closed_and_faces_outwards(name: str) -> None:
    """Every edge between two triangles that agree, Euler's number 2, every vertex used and at distance 1."""
    vertices, triangles = SPHERES[name]()
    assert (len(vertices), len(triangles)) == COUNTS[name]
    assert triangles.dtype == np.int32
    assert np.allclose(np.linalg.norm(vertices, axis=1), 1.0, atol=1e-12)
    assert len(np.unique(vertices.round(9), axis=0)) == len(vertices)
    solid = trimesh.Trimesh(vertices, triangles, process=False)
    assert solid.is_watertight and solid.is_winding_consistent
    assert solid.euler_number == 2
    assert (np.linalg.det(vertices[triangles]) > 0).all()
    assert set(np.unique(triangles)) == set(range(len(vertices)))


@pytest.mark.parametrize("name", ["uv 24x48", "cube 16", "ico 4"])
def test_vertex_areas_add_up_to_the_sphere(name: str) -> None:
    """All of it, nearly 4 pi, and weights that integrate as the sphere does."""
    vertices, triangles = SPHERES[name]()
    area = mesh.vertex_areas(vertices, triangles)
    assert area.sum() == pytest.approx(4 * np.pi, rel=0.01)
    assert area.min() > 0
    assert area @ vertices[:, 0] ** 2 == pytest.approx(4 * np.pi / 3, rel=0.02)
    assert area @ vertices == pytest.approx([0, 0, 0], abs=1e-9)


@pytest.mark.parametrize(("name", "spread"), [("cube 16", 1.6), ("ico 4", 1.6)])
def test_the_cube_and_the_icosahedron_spread_evenly(name: str, spread: float) -> None:
    """The largest triangle is not much larger than the smallest, unlike at the poles of the UV sphere."""
    vertices, triangles = SPHERES[name]()
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    assert area.max() / area.min() < 1.4 * spread


def test_fibonacci_points_spread_evenly() -> None:
    """On the sphere, none near another, each octant with its share."""
    points = mesh.fibonacci_sphere(1000)
    assert np.allclose(np.linalg.norm(points, axis=1), 1.0)
    distance = np.linalg.norm(points[:, None] - points[None], axis=2) + 9 * np.eye(1000)
    assert distance.min() > 0.6 * np.sqrt(4 * np.pi / 1000)
    octants = np.unique((points > 0) @ [1, 2, 4], return_counts=True)[1]
    assert octants.min() > 110 and octants.max() < 140


def test_normalized_leaves_zero_alone() -> None:
    """Where there is no direction there is none to invent."""
    assert mesh.normalized(np.array([[3.0, 0.0, 4.0], [0.0, 0.0, 0.0]])).tolist() == [[0.6, 0, 0.8], [0, 0, 0]]
