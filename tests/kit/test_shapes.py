"""Simple shapes in triangles: closed, of the right size, facing outwards, and parted where they are sharp."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import trimesh

from viewer.kit import mesh, shapes

SOLIDS: dict[str, tuple[Callable[[], mesh.Mesh], float, float, int]] = {
    "torus": (lambda: shapes.torus(1.0, 0.3), 2 * np.pi**2 * 0.09, 4 * np.pi**2 * 0.3, 0),
    "coarse torus": (lambda: shapes.torus(2.0, 1.0, 3, 3), np.nan, np.nan, 0),
    "box": (lambda: shapes.box((1.0, 2.0, 3.0)), 48.0, 88.0, 2),
    "cone": (lambda: shapes.cone(1.0, 2.0), 2 * np.pi / 3, np.pi * (1 + np.sqrt(5)), 2),
    "coarse cone": (lambda: shapes.cone(1.0, 1.0, 3, 1), np.sqrt(3) / 4, np.nan, 2),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_a_solid_is_closed_and_faces_outwards(name: str) -> None:
    """Every vertex in use, none twice, the volume and the area of the closed form."""
    make, volume, area, euler = SOLIDS[name]
    vertices, triangles = make()
    assert vertices.dtype == np.float64 and triangles.dtype == np.int32
    solid = trimesh.Trimesh(vertices, triangles, process=False)
    assert solid.is_watertight and solid.is_winding_consistent and solid.euler_number == euler
    assert solid.volume > 0 and solid.area_faces.min() > 0
    assert len(np.unique(vertices.round(9), axis=0)) == len(vertices) == len(np.unique(triangles))
    for found, expected in ((solid.volume, volume), (solid.area, area)):
        assert np.isnan(expected) or found == pytest.approx(expected, rel=0.005)


def test_solids_stand_around_the_y_axis() -> None:
    """Their bounds, and the cone on its base."""
    assert np.allclose(np.ptp(shapes.torus(1.0, 0.25)[0], axis=0), [2.5, 0.5, 2.5], atol=1e-9)
    base = shapes.cone(1.0, 2.0)[0]
    assert base[:, 1].min() == 0.0 and base[:, 1].max() == 2.0
    assert np.allclose(np.abs(shapes.box((1, 2, 3))[0]), [1, 2, 3])


@pytest.mark.parametrize(("make", "area"), [(lambda: shapes.disc(2.0), 4 * np.pi), (lambda: shapes.square(1.5), 9.0)])
def test_flat_shapes_face_up(make: Callable[[], mesh.Mesh], area: float) -> None:
    """In the plane y = 0, counter-clockwise seen from above."""
    vertices, triangles = make()
    assert (vertices[:, 1] == 0).all()
    assert np.allclose(shapes.face_normals(vertices, triangles), [0, 1, 0])
    assert trimesh.Trimesh(vertices, triangles, process=False).area == pytest.approx(area, rel=0.005)


def test_a_box_is_parted_at_its_edges_and_a_sphere_nowhere() -> None:
    """24 vertices with the sides' normals, also at its corners; those of a sphere look away from its centre."""
    vertices, normals, triangles = shapes.creased(*shapes.box((1, 2, 3)))
    assert len(vertices) == 24 and triangles.shape == (12, 3)
    assert np.allclose(normals[triangles], shapes.face_normals(vertices, triangles)[:, None])
    ball = mesh.ico_sphere(3)
    vertices, normals, triangles = shapes.creased(*ball)
    assert len(vertices) == len(ball[0]) and np.allclose(vertices, normals, atol=0.01)
    assert np.array_equal(vertices[triangles], ball[0][ball[1]])


def test_the_crease_angle_decides() -> None:
    """A roof of 40 degrees is one surface above that, two below; nothing joins across a mere point."""
    rise = np.tan(np.radians(20))
    vertices = np.array([[-1, 0, 0], [-1, 0, 1], [0, rise, 0], [0, rise, 1], [1, 0, 0], [1, 0, 1.0]])
    triangles = np.array([[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 5]], np.int32)
    assert len(shapes.creased(vertices, triangles, 39.0)[0]) == 8
    parted = shapes.creased(vertices, triangles, 41.0)
    assert len(parted[0]) == 6
    assert np.allclose(parted[1][np.isclose(parted[0][:, 0], 0)], [0, 1, 0])
    bowtie = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [-1, 0, 0], [-1, -1, 0.0]])
    assert len(shapes.creased(bowtie, np.array([[0, 1, 2], [0, 3, 4]], np.int32))[0]) == 6


def test_faces_wound_against_each_other_stay_apart() -> None:
    """Their normals would cancel."""
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.0]])
    _, normals, _ = shapes.creased(vertices, np.array([[0, 1, 2], [1, 2, 3]], np.int32))
    assert np.allclose(np.abs(normals), [0, 0, 1]) and len(normals) == 6


def test_a_triangle_without_area_has_no_normal() -> None:
    """It is zero, not NaN."""
    flat = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0.0]])
    assert not shapes.face_normals(flat, np.array([[0, 1, 2]])).any()
    assert np.isfinite(shapes.creased(flat, np.array([[0, 1, 2]], np.int32))[1]).all()
