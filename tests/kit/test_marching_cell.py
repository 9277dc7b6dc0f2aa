"""One cell under the microscope says what the whole extraction makes of it."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.ndimage import label
from scipy.optimize import fsolve

from tests.kit.surface_checks import METHODS, soup
from viewer.kit.interpolation import NEAREST
from viewer.kit.marching import marching_cubes
from viewer.kit.marching_cases import CORNERS, FACES, TETRAHEDRA
from viewer.kit.marching_cell import AmbiguousFace, edge_name, examine, face_saddle

Floats = NDArray[np.float64]
CHECKERBOARD = np.array([-1.0, 1.0, 1.0, -3.0, 1.0, 1.0, 1.0, 1.0])         # on z = 0 alone
SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def cells(count: int) -> list[Floats]:
    """Corners with random values; every third with small whole ones, of which some are 0."""
    chance = np.random.default_rng(21)
    return [chance.integers(-1, 2, 8).astype(float) if n % 3 == 0 else chance.normal(size=8) for n in range(count)]


def on_grid(corners: Floats) -> Floats:
    """The values as a grid of two samples along each axis."""
    values = np.empty((2, 2, 2))
    values[tuple(CORNERS.T)] = corners
    return values


def bilinear(around: Floats, u: Floats | float, v: Floats | float) -> Floats:
    """Between four values around the unit square."""
    a, b, c, d = around
    return np.asarray(a * (1 - u) * (1 - v) + b * u * (1 - v) + c * u * v + d * (1 - u) * v)


def ambiguous_faces(count: int) -> list[Floats]:
    """Values around squares, of opposite signs in turn."""
    chance = np.random.default_rng(22)
    return [chance.uniform(0.05, 2.0, 4) * [1, -1, 1, -1] * chance.choice([-1, 1]) for _ in range(count)]


@pytest.mark.parametrize("method", METHODS)
def test_a_cell_has_the_triangles_of_the_surface(method: str) -> None:
    """Those that extraction finds in a grid of just this cell."""
    for corners in cells(400):
        cell = examine(corners, method)
        places = cell.places.astype(np.float32)
        expected = marching_cubes(on_grid(corners), method=method)
        assert len(places) == len(expected[0])
        assert np.array_equal(soup(places, cell.triangles), soup(*expected))


@pytest.mark.parametrize("method", METHODS)
def test_a_cell_is_worked_out(method: str) -> None:
    """Its case from the signs, and for each crossed edge the values at its ends, t and the place."""
    for corners in cells(100):
        cell = examine(corners, method)
        assert cell.has_values and np.array_equal(cell.values, corners)
        assert int(cell.binary, 2) == cell.case and len(cell.binary) == 8
        assert [cell.binary[7 - corner] == "1" for corner in range(8)] == (corners < 0.0).tolist()
        for crossing in cell.crossings:
            start, end = crossing.ends
            assert edge_name(crossing.edge) == f"{start}-{end}" and start < end
            assert corners[[start, end]].tolist() == [crossing.A, crossing.B]
            assert (crossing.A < 0.0) != (crossing.B < 0.0)
            wanted = np.clip(crossing.A / (crossing.A - crossing.B), NEAREST, 1.0 - NEAREST)
            assert crossing.t == pytest.approx(wanted, abs=1e-12)
            assert np.allclose(crossing.place, CORNERS[start] * (1 - wanted) + CORNERS[end] * wanted)


def test_triangles_lie_in_their_tetrahedra() -> None:
    """Those of cubes in none in particular."""
    for corners in cells(60):
        assert not examine(corners, "cubes").tetrahedron.any()
        cell = examine(corners, "tetrahedra")
        assert len(cell.tetrahedron) == len(cell.triangles) and not cell.ambiguous
        for triangle, index in zip(cell.triangles, cell.tetrahedron, strict=True):
            assert {corner for vertex in triangle for corner in cell.crossings[vertex].ends} <= set(TETRAHEDRA[index])


def test_ambiguous_faces_are_named() -> None:
    """With the values of their own corners."""
    cell = examine(CHECKERBOARD)
    assert [face.name for face in cell.ambiguous] == ["z = 0"]
    assert cell.ambiguous[0].saddle == pytest.approx((-1.0 * -3.0 - 1.0) / (-4.0 - 2.0))
    assert cell.ambiguous[0].joins_inside
    for face, corners in enumerate(FACES):
        axis, side = AmbiguousFace(face, 0.0).name.split(" = ")
        assert (CORNERS[list(corners), "xyz".index(axis)] == int(side)).all()
    assert not AmbiguousFace(0, 0.0).joins_inside
    for corners in cells(200):
        for face in examine(corners).ambiguous:
            around = corners[list(FACES[face.face])] < 0.0
            assert around[0] == around[2] != around[1] == around[3]


def test_the_saddle_is_where_the_slope_is_zero() -> None:
    """Inside the square: found by Newton's method, and with the value there."""
    for around in ambiguous_faces(50):
        a, b, c, d = around

        def slopes(place: Floats) -> list[float]:
            u, v = place
            return [(b - a) * (1 - v) + (c - d) * v, (d - a) * (1 - u) + (c - b) * u]     # noqa: B023

        u, v = fsolve(slopes, [0.5, 0.5])
        assert 0.0 < u < 1.0 and 0.0 < v < 1.0
        assert face_saddle(around) == pytest.approx(float(bilinear(around, u, v)), abs=1e-9)
        assert face_saddle(np.roll(around, 1)) == pytest.approx(face_saddle(around))
        assert face_saddle(around[::-1]) == pytest.approx(face_saddle(around))
    assert face_saddle([0.0, -1.0, 0.0, -2.0]) == pytest.approx(-2.0 / 3.0)


def test_the_saddle_tells_whether_inside_corners_are_joined() -> None:
    """As flooding the face from one to the other does."""
    u, v = np.meshgrid(np.linspace(0, 1, 201), np.linspace(0, 1, 201), indexing="ij")
    joined = 0
    for around in ambiguous_faces(40):
        pieces, _ = label(bilinear(around, u, v) < 0.0, structure=np.ones((3, 3)))
        at_corners = [pieces[-1 if i else 0, -1 if j else 0] for i, j in SQUARE]
        first, second = [piece for piece in at_corners if piece]
        if abs(face_saddle(around)) > 0.02:
            assert AmbiguousFace(0, face_saddle(around)).joins_inside == (first == second)
            joined += first == second
    assert 8 < joined < 32


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_a_cell_without_a_value_yields_nothing(method: str, value: float) -> None:
    """It still has its other values."""
    corners = np.where(np.arange(8) == 3, value, [-1.0, 1.0] * 4)
    cell = examine(corners, method)
    assert not cell.has_values and np.array_equal(cell.values, corners, equal_nan=True)
    assert not cell.crossings and not cell.ambiguous
    assert cell.triangles.shape == (0, 3) and cell.places.shape == (0, 3)


@pytest.mark.parametrize("method", METHODS)
def test_a_cell_of_one_sign_has_no_triangles(method: str) -> None:
    """Cases 0 and 255."""
    for sign, case in ((1.0, 0), (-1.0, 255)):
        cell = examine(np.full(8, sign), method)
        assert cell.case == case and cell.triangles.shape == (0, 3) and cell.places.shape == (0, 3)
