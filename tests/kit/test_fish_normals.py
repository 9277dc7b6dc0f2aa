"""The normals of fish are those of the curves they are built from."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from viewer.kit.fish import SPECIES
from viewer.kit.fish_barbels import BarbelSurface
from viewer.kit.fish_body import BodySurface, body_surface, gill_edge
from viewer.kit.fish_curve import Surface, bell, closed_curve, normals_between_poles, open_curve, partial_derivatives
from viewer.kit.fish_eyes import eye_points
from viewer.kit.fish_fins import Fin, median_fin, paired_fin
from viewer.kit.fish_lattice import even_lattice
from viewer.kit.mesh import fibonacci_sphere, normalized, quads_to_triangles

Numbers = NDArray[np.float64]
BOTH = pytest.mark.parametrize("species", SPECIES)


def degrees_between(one: Numbers, other: Numbers) -> Numbers:
    """The angle between unit vectors, well for small ones too."""
    return np.degrees(2 * np.arcsin(np.minimum(1, 0.5 * np.linalg.norm(one - other, axis=-1))))


def by_differences(surface: Surface, u: Numbers, v: Numbers, step: float = 1e-6) -> Numbers:
    """Unit normals from central differences of positions alone."""
    along = surface(u + step, v) - surface(u - step, v)
    across = surface(u, v + step) - surface(u, v - step)
    normal = np.cross(across, along)
    return np.asarray(normal / np.linalg.norm(normal, axis=-1, keepdims=True))


def fins(species: str, body: BodySurface) -> list[Fin]:
    """All fins of a species."""
    plan = SPECIES[species]
    return [*(median_fin(fin, body) for fin in plan.median_fins),
            *(paired_fin(fin, body, sign) for fin in plan.paired_fins for sign in (-1.0, 1.0))]


@BOTH
def test_body_normals_are_those_of_central_differences(species: str) -> None:
    """Within a hundredth of a degree wherever one looks, mouth, gills and keels included."""
    body = body_surface(SPECIES[species])
    turn, angle = np.random.default_rng(1).uniform((0.02, 0), (np.pi - 0.02, 2 * np.pi), (20000, 2)).T
    assert degrees_between(normals_between_poles(body, turn, angle), by_differences(body, turn, angle)).max() < 0.01


@BOTH
def test_body_normals_are_those_of_a_much_finer_mesh(species: str) -> None:
    """Area-weighted means over 700,000 triangles, away from the poles, the mouth and the gill covers' edge."""
    plan, body = SPECIES[species], body_surface(SPECIES[species])
    turn, angle = even_lattice(800, 448)
    points = body(turn, angle)
    x, y = points[..., 0], points[..., 1]
    quiet = np.abs(x - gill_edge(plan.gill, y)) > 0.02
    quiet &= (x < plan.mouth.corner[0] - 0.02) & (x > plan.stalk_end + 0.01)
    quiet[:, [0, -1]] = False       # the seam, where each vertex has half of its triangles
    away = degrees_between(normals_between_poles(body, turn[quiet], angle[quiet]), area_weighted(points)[quiet])
    assert away.size > 200000 and away.max() < 0.1


@BOTH
def test_normals_of_fins_are_those_of_central_differences(species: str) -> None:
    """Both sides, with and without ribs, short of the border, where a fin ends in an edge."""
    u, v = np.random.default_rng(2).uniform(0.003, 0.997, (2, 2000))
    for fin in fins(species, body_surface(SPECIES[species])):
        for side in (1.0, -1.0):
            for ribs in (True, False):
                rough = by_differences(lambda a, b, fin=fin, side=side, ribs=ribs: fin.points(a, b, side, ribs), u, v)
                exact = fin.normals(u, v, side, ribs)
                rough *= np.sign(np.einsum("ij,ij->i", rough, exact))[:, None]
                assert np.quantile(degrees_between(exact, rough), 0.99) < 0.01     # a rib may have a kink between


@BOTH
def test_fins_are_graphs_over_their_middle_that_nowhere_fold(species: str) -> None:
    """A ray never runs along the edge in which the rays end, nor past its neighbour."""
    u, v = np.meshgrid(np.linspace(0, 1, 101), np.linspace(0, 1, 41))
    for fin in fins(species, body_surface(SPECIES[species])):
        assert (fin.middle_normals(u, v) @ fin.side).min() > 0.15


def test_normals_of_eyes_are_those_of_their_ellipsoid() -> None:
    """At right angles to every way along the ball, outward."""
    ball = fibonacci_sphere(500)
    plan, body = SPECIES["clownfish"], body_surface(SPECIES["clownfish"])
    for sign in (-1.0, 1.0):
        points, normals = eye_points(plan.eye, body, sign, ball)
        for axis in np.eye(3):
            aside = np.cross(ball, axis)
            turned = ball + 1e-6 * aside
            moved, _ = eye_points(plan.eye, body, sign, turned / np.linalg.norm(turned, axis=1, keepdims=True))
            assert np.abs(np.einsum("ij,ij->i", (moved - points) / 1e-6, normals)).max() < 1e-6
        assert (np.einsum("ij,ij->i", points - points.mean(axis=0), normals) > 0).all()


def test_normals_of_barbels_are_those_of_central_differences() -> None:
    """Of all that a koi has."""
    plan = SPECIES["koi"]
    turn, angle = np.random.default_rng(3).uniform((0.02, 0), (np.pi - 0.02, 2 * np.pi), (2000, 2)).T
    for barbel in plan.barbels:
        surface = BarbelSurface(barbel, body_surface(plan))
        exact, rough = normals_between_poles(surface, turn, angle), by_differences(surface, turn, angle)
        assert degrees_between(exact, rough).max() < 0.01


@BOTH
def test_normals_at_the_poles_are_the_limit_of_those_around(species: str) -> None:
    """Nose and end of the stalk: whatever way one comes from."""
    body = body_surface(SPECIES[species])
    around = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    for pole, near in ((0.0, 1e-5), (np.pi, np.pi - 1e-5)):
        there = normals_between_poles(body, np.full(24, pole), around)
        assert degrees_between(there, normals_between_poles(body, np.full(24, near), around)).max() < 0.1
        assert np.allclose(there, there[0], atol=1e-9)


def test_curves_go_through_their_points_and_have_exact_derivatives() -> None:
    """Against SciPy's own derivative of the same spline, and a parabola that must come back as it is."""
    from scipy.interpolate import CubicSpline

    knots = np.array([-3.0, -1.0, 0.5, 2.0, 3.0])
    values = np.array([[1.0, 0.0], [2.0, -1.0], [0.0, 3.0], [1.5, 1.0], [1.0, 0.0]])
    curve, spline = closed_curve(knots, values), CubicSpline(knots, values, bc_type="periodic")
    t = np.linspace(-3, 3, 50)
    assert np.allclose(curve(t), spline(t)) and np.allclose(curve(knots), values)
    assert np.allclose(curve(t + 1e-30j).imag / 1e-30, spline(t, 1), rtol=1e-12, atol=1e-12)
    places = np.linspace(0, 1, 7)
    parabola = open_curve((3 * places**2 - places + 1)[:, None])
    assert np.allclose(parabola(t / 6 + 0.5)[:, 0], 3 * (t / 6 + 0.5) ** 2 - (t / 6 + 0.5) + 1)


def test_partial_derivatives_are_exact_to_the_last_digits() -> None:
    """Of a surface whose derivatives are known."""
    u, v = np.random.default_rng(4).uniform(-2, 2, (2, 100))
    along, across = partial_derivatives(lambda a, b: np.stack([np.sin(a) * b, a * b * b, np.exp(a)], -1), u, v)
    assert np.allclose(along, np.stack([np.cos(u) * v, v * v, np.exp(u)], -1), rtol=1e-14, atol=1e-15)
    assert np.allclose(across, np.stack([np.sin(u), 2 * u * v, np.zeros_like(u)], -1), rtol=1e-14, atol=1e-15)


def test_a_bell_ends() -> None:
    """Close to exp(-t^2), then nothing."""
    t = np.linspace(-4, 4, 801)
    assert np.abs(bell(t) - np.exp(-t * t)).max() < 0.05 and (bell(t)[np.abs(t) > 2.4495] == 0).all()


def area_weighted(points: Numbers) -> Numbers:
    """Unit normals at a grid of points, each the sum over its triangles of their cross products."""
    index = np.arange(points.shape[0] * points.shape[1]).reshape(points.shape[:2])
    triangles = quads_to_triangles(index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1])
    corners = points.reshape(-1, 3)[triangles]
    faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    sums = np.stack([np.bincount(triangles.ravel(), np.repeat(faces[:, axis], 3), index.size) for axis in range(3)], -1)
    return np.asarray(normalized(sums).reshape(points.shape))
