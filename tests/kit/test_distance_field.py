"""Distance fields of meshes and formulas: against closed forms, with the right sign, never too steep to step by."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from tests.kit.surface_checks import triangle_soup
from viewer.kit import mesh, shapes
from viewer.kit.distance_field import DistanceField, formula_distance_field, mesh_distance_field
from viewer.kit.field_function import FieldFunction
from viewer.kit.formula import parse
from viewer.kit.mesh import Mesh

Points = NDArray[np.float64]


def sample_places(field: DistanceField) -> Points:
    """Where each sample is: (nx, ny, nz, 3)."""
    axes = [first + step * np.arange(count) for first, step, count in
            zip(field.origin, field.spacing, field.values.shape, strict=True)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)


def box_distance(p: Points, half_extents: tuple[float, float, float]) -> Points:
    beyond = np.abs(p) - half_extents
    return np.linalg.norm(np.maximum(beyond, 0.0), axis=-1) + np.minimum(beyond.max(axis=-1), 0.0)


def torus_distance(p: Points, ring: float, tube: float) -> Points:
    return np.hypot(np.hypot(p[..., 0], p[..., 2]) - ring, p[..., 1]) - tube


def sphere_distance(p: Points) -> Points:
    return np.linalg.norm(p, axis=-1) - 1.0


def check(field: DistanceField, expected: Points, near: float = 0.02, far: float = 0.45) -> None:
    """Near the surface within ``near`` cells, elsewhere within ``far``, and the sign right wherever it matters."""
    error = np.abs(field.values - expected) / field.cell
    assert error[np.abs(expected) < 1.5 * field.cell].max() < near
    assert error.max() < far
    telling = np.abs(expected) > 1e-6
    assert ((field.values < 0.0) == (expected < 0.0))[telling].all()


def wedge(degrees: float) -> tuple[Mesh, Points, Points]:
    """A prism along z whose edge at the origin is acute: the mesh, and the other two corners in the plane z = 0."""
    half = np.radians(0.5 * degrees)
    upper, lower = np.array([np.cos(half), np.sin(half)]), np.array([np.cos(half), -np.sin(half)])
    flat = np.array([[0.0, 0.0], lower, upper])
    vertices = np.concatenate([np.c_[flat, np.full(3, -0.5)], np.c_[flat, np.full(3, 0.5)]])
    triangles = [[0, 2, 1], [3, 4, 5]]
    for i, j in ((0, 1), (1, 2), (2, 0)):
        triangles += [[i, j, j + 3], [i, j + 3, i + 3]]
    return (vertices, np.array(triangles, np.int32)), lower, upper


def test_sphere_and_torus_are_met_closely() -> None:
    sphere = mesh_distance_field(*mesh.ico_sphere(5))
    check(sphere, sphere_distance(sample_places(sphere)))
    torus = mesh_distance_field(*shapes.torus(1.0, 0.3, 192, 96), samples=48)
    check(torus, torus_distance(sample_places(torus), 1.0, 0.3))


@pytest.mark.parametrize("half_extents", [(1.0, 0.5, 0.7), (1.0, 0.06, 0.8), (0.07, 0.08, 1.0)])
def test_box_is_exact_near_its_surface_and_has_the_right_signs(half_extents: tuple[float, float, float]) -> None:
    field = mesh_distance_field(*shapes.box(half_extents), samples=40)
    check(field, box_distance(sample_places(field), half_extents), near=1e-4)


@pytest.mark.parametrize("degrees", [4.0, 20.0, 60.0])
def test_acute_wedge_has_the_right_signs(degrees: float) -> None:
    (vertices, triangles), lower, upper = wedge(degrees)
    field = mesh_distance_field(vertices, triangles, samples=48)
    p = sample_places(field)
    sides = [p[..., 0] * lower[1] - p[..., 1] * lower[0], p[..., 1] * upper[0] - p[..., 0] * upper[1],
             p[..., 0] - lower[0], np.abs(p[..., 2]) - 0.5]
    outermost = np.max(sides, axis=0)
    assert (field.values[outermost < -1e-6] < 0.0).all()
    thin_up_to = 1.5 / np.radians(degrees) + 1.0 if degrees < 45.0 else -np.inf        # there it has a shell
    away = p[..., 0] > thin_up_to * field.cell
    assert (field.values[(outermost > 1e-6) & away] > 0.0).all()
    inside = (outermost < 0.0) & away
    np.testing.assert_allclose(field.values[inside], outermost[inside], atol=0.45 * field.cell)


def turned(places: Points) -> Points:
    """By some angle about some axis."""
    turn, lean = np.radians(31.0), np.radians(17.0)
    about_y = np.array([[np.cos(turn), 0, np.sin(turn)], [0, 1, 0], [-np.sin(turn), 0, np.cos(turn)]])
    about_z = np.array([[np.cos(lean), -np.sin(lean), 0], [np.sin(lean), np.cos(lean), 0], [0, 0, 1]])
    return np.asarray(places @ (about_y @ about_z).T)


@pytest.mark.parametrize("half_thickness", [1e-4, 0.025, 0.075])
@pytest.mark.parametrize("leaning", [False, True])
def test_box_thinner_than_a_cell_is_solid_everywhere_in_its_middle(half_thickness: float, leaning: bool) -> None:
    vertices, triangles = shapes.box((3.0, half_thickness, 3.0))
    field = mesh_distance_field(turned(vertices) if leaning else vertices, triangles)
    middle = np.random.default_rng(2).uniform(-2.9, 2.9, (20_000, 3)) * [1.0, 0.0, 1.0]
    above = middle + np.array([0.0, half_thickness + 1.1 * field.cell, 0.0])
    assert field.at(turned(middle) if leaning else middle).max() < -0.1 * field.cell
    assert field.at(turned(above) if leaning else above).min() > 0.2 * field.cell


def test_torus_thinner_than_a_cell_is_solid_all_around() -> None:
    field = mesh_distance_field(*shapes.torus(1.0, 0.012, 192, 16))
    turn = np.linspace(0.0, 2.0 * np.pi, 5000)
    assert field.at(np.stack([np.cos(turn), 0.0 * turn, np.sin(turn)], axis=1)).max() < -0.1 * field.cell


def test_wedge_is_solid_up_to_its_edge() -> None:
    (vertices, triangles), lower, _ = wedge(5.0)
    field = mesh_distance_field(vertices, triangles)
    along = np.linspace(0.0, 0.99 * lower[0], 500)
    assert field.at(np.stack([along, 0.0 * along, 0.1 + 0.0 * along], axis=1)).max() < -0.1 * field.cell


def test_stepping_by_the_distance_never_goes_through_a_thin_box() -> None:
    field = mesh_distance_field(*shapes.box((1.0, 0.004, 1.0)), samples=32)
    generator = np.random.default_rng(5)
    start = field.origin + generator.uniform(-0.2, 1.2, (100_000, 3)) * field.extent
    end = start + 10.0 ** generator.uniform(-2.0, 0.5, (len(start), 1)) * field.cell * generator.normal(size=(1, 3))
    change = np.abs(field.at(start) - field.at(end))
    assert (change <= np.linalg.norm(start - end, axis=1) * (1.0 + 1e-3) + 1e-6).all()


def test_turning_a_closed_mesh_inside_out_changes_nothing() -> None:
    vertices, triangles = shapes.torus(1.0, 0.4, 48, 24)
    one = mesh_distance_field(vertices, triangles, samples=24)
    other = mesh_distance_field(vertices, triangles[:, ::-1], samples=24)
    np.testing.assert_allclose(one.values, other.values, atol=0.1 * one.cell)
    assert one.closed and other.closed


def test_vertices_that_every_triangle_has_for_itself_are_welded() -> None:
    vertices, triangles = triangle_soup(*shapes.torus(1.0, 0.4, 48, 24))
    assert mesh_distance_field(vertices, triangles, samples=24).closed


def test_gradient_is_of_length_one_but_where_two_sides_are_equally_near() -> None:
    field = mesh_distance_field(*mesh.ico_sphere(5))
    slope = np.linalg.norm(np.stack(np.gradient(field.values.astype(float), field.cell), axis=-1), axis=-1)
    radius = np.linalg.norm(sample_places(field), axis=-1)
    assert np.abs(slope[radius > 0.3] - 1.0).mean() < 0.02
    near = np.abs(radius - 1.0) < 1.5 * field.cell
    assert np.abs(slope[near] - 1.0).max() < 0.1


def test_open_mesh_becomes_a_thin_shell() -> None:
    vertices, triangles = mesh.ico_sphere(4)
    half = triangles[vertices[triangles].mean(axis=1)[:, 1] < 0.0]
    field = mesh_distance_field(vertices, half, samples=48)
    assert not field.closed
    middles = vertices[half].mean(axis=1)
    assert (field.at(middles) < 0.0).all()
    assert field.at(np.array([[0.0, -0.5, 0.0], [0.0, 0.0, 0.0], [0.0, -1.5, 0.0]])).min() > 0.2
    assert np.abs(field.values).min() < 0.8 * field.cell


@pytest.mark.parametrize("made", [mesh.ico_sphere(3), shapes.box((1.0, 0.3, 0.1)), shapes.cone(0.5, 1.5)])
def test_stepping_by_the_distance_never_goes_through(made: Mesh) -> None:
    field = mesh_distance_field(*made, samples=32)
    generator = np.random.default_rng(5)
    start = field.origin + generator.uniform(-0.5, 1.5, (200_000, 3)) * field.extent
    reach = 10.0 ** generator.uniform(-3.0, 0.5, (len(start), 1)) * field.cell
    end = start + reach * generator.normal(size=start.shape)
    change = np.abs(field.at(start) - field.at(end))
    assert (change <= np.linalg.norm(start - end, axis=1) * (1.0 + 1e-3) + 1e-6).all()


def test_formula_is_met_closely_and_has_its_own_sign() -> None:
    function = FieldFunction(parse("radius*radius - x*x - y*y - z*z"), (("radius", 0.7),))
    solid = formula_distance_field(FieldFunction(parse("-(radius*radius - x*x - y*y - z*z)"), (("radius", 0.7),)), 1.0)
    p = sample_places(solid.field)
    check(solid.field, np.linalg.norm(p, axis=-1) - 0.7, near=0.05)
    turned = formula_distance_field(function, 1.0).field        # all but a ball, as far as the cube goes
    assert turned.at(np.zeros((1, 3)))[0] > 0.5
    assert turned.at(np.full((1, 3), 0.9))[0] < 0.0
    assert turned.at(np.full((1, 3), 1.2))[0] > 0.1


@pytest.mark.parametrize("samples", [16, 64])
@pytest.mark.parametrize(("text", "reach"), [
    ("length(x, y, z) - 0.5", 1.0), ("length(x, y, z) - 0.5 - 0.1*sin(8*x)*sin(8*y)*sin(8*z)", 1.0),
    ("x^4 - 5*x^2 + y^4 - 5*y^2 + z^4 - 5*z^2 + 11.8", 3.0), ("max(abs(x), abs(y), abs(z)) - 0.6", 1.0),
])
def test_nowhere_inside_a_formula_is_the_distance_above_0(text: str, reach: float, samples: int) -> None:
    function = FieldFunction(parse(text))
    field, vertices, triangles = formula_distance_field(function, reach, samples)
    generator = np.random.default_rng(1)
    chosen = vertices[triangles[generator.integers(0, len(triangles), 200_000)]]
    near = np.einsum("ij,ijk->ik", generator.dirichlet((1.0, 1.0, 1.0), len(chosen)), chosen)
    spread = field.cell * generator.choice([0.01, 0.1, 0.5], (len(near), 1))
    places = near + spread * generator.normal(size=near.shape)
    values, slopes = function.at(places.astype(np.float32)), np.zeros(len(places))
    for axis in np.eye(3):
        ahead, behind = (function.at((places + step * axis).astype(np.float32)) for step in (1e-3, -1e-3))
        slopes += np.square((ahead - behind) / 2e-3)
    depth = -values / np.sqrt(slopes)
    distance = field.at(places)
    assert depth[(distance >= 0.0) & (slopes > 0.0)].max() < 1.5e-4
    assert np.abs(distance + depth)[np.abs(depth) < 0.05 * field.cell].mean() < 0.25 * field.cell


def test_formula_without_values_beside_its_solid_is_closed_there() -> None:
    solid = formula_distance_field(FieldFunction(parse("sqrt(x) + y*y + z*z - 0.3")), 1.0, samples=48)
    signs = solid.field.at(np.array([[0.02, 0.0, 0.0], [-0.2, 0.0, 0.0]]))
    assert signs[0] < 0.0 < signs[1]


@pytest.mark.parametrize(("text", "words"), [
    ("x*x + 1", "nowhere below 0"), ("-1 - x*x", "nowhere above 0"), ("sqrt(-1 - x*x)", "no value"),
])
def test_formula_without_a_surface_is_refused(text: str, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        formula_distance_field(FieldFunction(parse(text)), 1.0, samples=24)


def test_what_is_no_mesh_is_refused() -> None:
    vertices, triangles = shapes.box((1.0, 1.0, 1.0))
    with pytest.raises(ValueError, match="no triangles"):
        mesh_distance_field(vertices, np.empty((0, 3), np.int32))
    with pytest.raises(ValueError, match="no area"):
        mesh_distance_field(vertices * [1.0, 0.0, 0.0], triangles)
    with pytest.raises(ValueError, match="not finite"):
        mesh_distance_field(np.where(vertices > 0, np.nan, vertices), triangles)
    with pytest.raises(ValueError, match="beyond its 8"):
        mesh_distance_field(vertices, triangles + 1)
    with pytest.raises(ValueError, match="spacing"):
        DistanceField(np.zeros((2, 2, 2), np.float32), np.zeros(3), np.zeros(3))
