"""Surfaces through grids of samples: nothing gapes, whatever the samples; smooth shapes come out as they are."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter
from scipy.special import elliprg
from skimage import measure

from tests.kit.surface_checks import (
    METHODS,
    areas,
    corners_of,
    crossed_edge_count,
    euler_characteristic,
    inner_open_edges,
    open_edges,
    sample_places,
    soup,
    winding_numbers,
)
from viewer.kit import marching_grid
from viewer.kit.interpolation import NEAREST
from viewer.kit.marching import marching_cubes
from viewer.kit.marching_grid import MOST_SAMPLES

pytestmark = [pytest.mark.filterwarnings("error"), pytest.mark.parametrize("method", METHODS)]

Floats = NDArray[np.float64]
Place = tuple[Floats, Floats, Floats]

DTYPES = ["?", "i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8", "f2", "f4", "f8", "g",
          ">i2", ">u4", ">i8", ">f2", ">f4", ">f8", "<f4", "<f8"]


def noises(count: int, whole: bool) -> Iterator[Floats]:
    """Random grids of many shapes: real numbers, or ``whole`` ones, a third of which equal 0."""
    chance = np.random.default_rng(11)
    for _ in range(count):
        shape = tuple(chance.integers(2, 9, 3))
        yield chance.integers(-1, 2, shape).astype(float) if whole else chance.normal(size=shape)


def padded(values: NDArray[Any], value: float) -> NDArray[Any]:
    """A layer of one value around a grid."""
    return np.pad(values, 1, constant_values=value)


# Every pattern of signs

@pytest.mark.parametrize("around", [1.0, -1.0], ids=["outside around", "inside around"])
def test_a_lone_cell_is_surrounded(method: str, around: float) -> None:
    """All 256 patterns: a closed surface with just the inside samples on its inner side."""
    places = sample_places((4, 4, 4))
    for case in range(256):
        values = padded(np.where(case >> np.arange(8) & 1, -1.0, 1.0).reshape(2, 2, 2), around)
        vertices, triangles = marching_cubes(values, method=method)
        assert not len(open_edges(vertices, triangles))
        if len(triangles):
            surrounded = winding_numbers(vertices, triangles, places).reshape(values.shape)
            assert np.allclose(surrounded, (values < 0.0).astype(float) - (around < 0.0), atol=1e-6)
        else:
            assert (values == around).all()


@pytest.mark.parametrize("size", ["one", "random", "whole"])
@pytest.mark.parametrize("axis", range(3))
def test_no_pair_of_cells_gapes(method: str, axis: int, size: str) -> None:
    """All 4096 patterns of two cells side by side, in blocks that samples without a value keep apart."""
    shape = np.full(3, 2)
    shape[axis] = 3
    inside = (np.arange(4096)[:, None] >> np.arange(12) & 1).astype(bool).reshape(16, 16, 16, *shape)
    values = np.where(inside, -1.0, 1.0)
    if size == "random":
        values *= np.random.default_rng(5).uniform(1e-3, 1.0, inside.shape)
    elif size == "whole":
        values[~inside] = 0.0
    apart = np.pad(values, [(0, 0)] * 3 + [(0, 1)] * 3, constant_values=np.nan)
    grid = apart.transpose(0, 3, 1, 4, 2, 5).reshape(16 * (shape + 1))
    vertices, triangles = marching_cubes(grid, method=method)
    if method == "cubes":
        assert len(vertices) == sum(int((inside.take(range(1, n), 3 + a) ^ inside.take(range(n - 1), 3 + a)).sum())
                                    for a, n in enumerate(shape))
    within = vertices[open_edges(vertices, triangles)] % (shape + 1)
    outer = (within == 0.0).all(axis=1) | (within == shape - 1.0).all(axis=1)
    assert outer.any(axis=1).all()


@pytest.mark.parametrize("whole", [False, True], ids=["200 real grids", "100 whole grids"])
def test_noise_neither_gapes_nor_branches(method: str, whole: bool) -> None:
    """The surface ends only where the grid does; cubes have one vertex for each crossed edge, on that edge."""
    for values in noises(100 if whole else 200, whole):
        vertices, triangles = marching_cubes(values, method=method)
        assert not len(inner_open_edges(vertices, triangles, values.shape))
        if method == "cubes":
            assert len(vertices) == crossed_edge_count(values < 0.0)
            assert ((vertices != vertices.round()).sum(axis=1) == 1).all()


def test_noise_closes_once_outside_samples_surround_it(method: str) -> None:
    """And goes once around each inside sample, around no other: also where samples are exactly at the level."""
    for whole in (False, True):
        for values in noises(5, whole):
            closed = padded(values, 2.0)
            vertices, triangles = marching_cubes(closed, method=method)
            assert not len(open_edges(vertices, triangles))
            surrounded = winding_numbers(vertices, triangles, sample_places(closed.shape)).reshape(closed.shape)
            assert np.allclose(surrounded, closed < 0.0, atol=1e-5)


def test_crossings_divide_their_edges(method: str) -> None:
    """Interpolating the samples linearly along a vertex's edge gives the level."""
    values = np.random.default_rng(4).normal(size=(9, 8, 7))
    vertices, _ = marching_cubes(values, 0.25, method=method)
    low, high = np.floor(vertices).astype(int), np.ceil(vertices).astype(int)
    t = (vertices - low).max(axis=1)
    between = values[tuple(low.T)] * (1.0 - t) + values[tuple(high.T)] * t
    kept_off = (t < 1.5 * NEAREST) | (t > 1.0 - 1.5 * NEAREST)
    assert np.abs(between - 0.25)[~kept_off].max() < 1e-5
    moved = (vertices - low)[(high - low).sum(axis=1) > 1]
    assert (np.ptp(np.where(moved == 0.0, moved.max(axis=1, keepdims=True), moved), axis=1) < 1e-5).all()


# Samples exactly at the level

@pytest.mark.parametrize("axis", range(3))
def test_a_plane_of_samples_at_the_level_is_one_sheet(method: str, axis: int) -> None:
    """They count as outside: the sheet lies just below them, flat, and faces the larger values."""
    shape = (5, 6, 7)
    values = np.arange(shape[axis]).reshape([-1 if a == axis else 1 for a in range(3)]) * np.ones(shape) - 2.0
    for level_set in (values, np.minimum(values, 0.0)):
        vertices, triangles = marching_cubes(level_set, method=method)
        assert not len(inner_open_edges(vertices, triangles, shape))
        assert np.allclose(vertices[:, axis], 2.0 - NEAREST, atol=1e-6)
        assert areas(vertices, triangles).sum() == pytest.approx(np.prod(np.array(shape) - 1) / (shape[axis] - 1))
        a, b, c = corners_of(vertices, triangles).transpose(1, 0, 2)
        assert (np.cross(b - a, c - a)[:, axis] > 0.0).all()


def test_a_lone_sample_at_the_level_makes_a_tiny_hole(method: str) -> None:
    """Outside among inside: closed, round the sample and next to it; inside among outside it does not show."""
    values = np.full((3, 3, 3), -1.0)
    values[1, 1, 1] = 0.0
    vertices, triangles = marching_cubes(values, method=method)
    assert not len(open_edges(vertices, triangles)) and euler_characteristic(vertices, triangles) == 2
    assert np.abs(vertices - 1.0).max() == pytest.approx(NEAREST, rel=1e-2)
    assert winding_numbers(vertices, triangles, np.ones((1, 3))) == pytest.approx(-1.0)
    assert not len(marching_cubes(-values, method=method)[1])


# Nothing to draw

@pytest.mark.parametrize("dtype", ["?", "i8", "u1", "f4", "f8"])
def test_a_constant_has_no_surface(method: str, dtype: str) -> None:
    """Below the level, at it and above it; the arrays are empty, and of the usual types."""
    for value, level in product((0, 1), (-1e300, -1.0, 0, 0.0, 0.5, 1.0, 1.5, 300.5, 1e300)):
        vertices, triangles = marching_cubes(np.full((4, 3, 2), value, dtype), level, method=method)
        assert (vertices.shape, vertices.dtype) == ((0, 3), np.float32)
        assert (triangles.shape, triangles.dtype) == ((0, 3), np.int32)


@pytest.mark.parametrize("dtype", ["i1", "u8", "f2", "f4", "f8"])
def test_a_level_that_no_sample_reaches_has_no_surface(method: str, dtype: str) -> None:
    """However far away: also beyond what the samples' type can hold."""
    values = np.random.default_rng(2).integers(0, 6, (5, 5, 5)).astype(dtype)
    for level in (-1e300, -1e30, -1.0, 0.0, 6.0, 70000.0, 1e30, 1e300):
        assert not len(marching_cubes(values, level, method=method)[0]), level


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_cells_without_a_value_yield_nothing(method: str, value: float) -> None:
    """The rest is as it would be; no vertex is left without a triangle, in either order of memory."""
    chance = np.random.default_rng(6)
    whole = chance.normal(size=(9, 8, 10))
    missing = chance.random(whole.shape) < 0.04
    broken = np.where(missing, value, whole)
    touched = np.zeros(np.array(whole.shape) - 1, bool)
    for i, j, k in np.argwhere(missing):
        touched[max(i - 1, 0):i + 1, max(j - 1, 0):j + 1, max(k - 1, 0):k + 1] = True
    vertices, triangles = marching_cubes(whole, method=method)
    cells = np.floor(corners_of(vertices, triangles).mean(axis=1)).astype(int)
    expected = soup(vertices, triangles[~touched[tuple(cells.T)]])
    assert 100 < len(expected) < len(triangles) - 100
    for samples in (broken, np.asfortranarray(broken), broken.astype(np.float32)):
        found = marching_cubes(samples, method=method)
        open_edges(*found)
        assert np.allclose(soup(*found), expected, atol=1e-5)
    assert not len(marching_cubes(np.full((4, 4, 4), value), method=method)[0])


def test_huge_values_have_a_surface(method: str) -> None:
    """The samples' sum is infinite, but none of them is."""
    values = np.random.default_rng(3).choice(np.array([-3e38, 3e38, 2e38], np.float32), (6, 6, 6))
    vertices, triangles = marching_cubes(values, method=method)
    assert not len(inner_open_edges(vertices, triangles, values.shape))
    assert len(vertices) == len(marching_cubes(np.sign(values), method=method)[0])


# Arrays of every kind

@pytest.mark.parametrize("dtype", DTYPES)
def test_every_type_of_number_has_the_same_surface(method: str, dtype: str) -> None:
    """As the same numbers in float64, at levels that samples have and at levels between."""
    numbers = np.random.default_rng(8).integers(0, 2 if dtype == "?" else 6, (7, 6, 5))
    for level in (1, 0.5) if dtype == "?" else (2, 2.0, 2.5, np.float32(3.25), np.int8(4)):
        expected = marching_cubes(numbers.astype(np.float64), float(level), method=method)
        found = marching_cubes(numbers.astype(dtype), level, method=method)
        assert len(expected[1]) and all(map(np.array_equal, found, expected))


def test_a_levels_type_makes_no_difference(method: str) -> None:
    """Samples at 0.7 as float32 has it are at the level 0.7, of whatever type: outside."""
    values = (np.random.default_rng(9).integers(0, 15, (8, 8, 8)) / 10.0).astype(np.float32)
    for level in (0.1, 0.3, 0.7, 0.9):
        expected = soup(*marching_cubes(values, np.float32(level), method=method))
        assert np.array_equal(soup(*marching_cubes(values, level, method=method)), expected)
        assert np.array_equal(soup(*marching_cubes(values, np.float64(level), method=method)), expected)


@pytest.mark.parametrize("dtype", ["f4", "u1", "?"])
def test_the_order_of_memory_makes_no_difference(method: str, dtype: str) -> None:
    """Fortran's, transposed, every other sample, backwards, repeated, and lists: as a plain copy."""
    values = (np.random.default_rng(10).normal(size=(8, 6, 10)) > 0.0).astype(dtype)
    views = [np.asfortranarray(values), values.T, values.transpose(1, 2, 0), values.transpose(0, 2, 1),
             values[::2, :, 1::3], values[::-1, ::-1], values.T[:, ::-1, 2:],
             np.broadcast_to(values[:, :1], (8, 5, 10))]
    for view in views:
        before = view.copy()
        found = soup(*marching_cubes(view, 0.5, (1, 2, 3), method))
        assert len(found) and np.array_equal(view, before)
        assert np.array_equal(found, soup(*marching_cubes(view.copy(order="C"), 0.5, (1, 2, 3), method)))
        assert np.array_equal(found, soup(*marching_cubes(view.tolist(), 0.5, (1, 2, 3), method)))


def test_turning_the_grid_turns_the_surface(method: str) -> None:
    """Exchanging axes exchanges coordinates, so that volumes change sign; tables know no axis better than others."""
    values = padded(gaussian_filter(np.random.default_rng(12).normal(size=(9, 10, 11)), 1.0), 1.0)
    vertices, triangles = marching_cubes(values, method=method)
    turned = marching_cubes(values.transpose(2, 0, 1), method=method)
    assert np.array_equal(np.unique(turned[0], axis=0), np.unique(vertices[:, [2, 0, 1]], axis=0))
    assert areas(*turned).sum() == pytest.approx(areas(vertices, triangles).sum(), rel=0.01)


def test_spacing_scales_the_vertices(method: str) -> None:
    """And nothing else."""
    values = np.random.default_rng(13).normal(size=(5, 6, 7))
    vertices, triangles = marching_cubes(values, method=method)
    for spacing in ((0.5, 2.0, 3.0), [1, 1, 4], np.array([0.25, 1.0, 2.0])):
        scaled = marching_cubes(values, 0.0, spacing, method)
        assert np.array_equal(scaled[1], triangles)
        assert np.allclose(scaled[0], vertices * spacing, rtol=1e-6)


@pytest.mark.parametrize("samples", [1, 40, 90])
def test_the_surface_does_not_depend_on_the_slabs(method: str, samples: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """In which it is made, to stay in the processor's cache: vertices between two are shared all the same."""
    values = np.random.default_rng(14).normal(size=(9, 5, 8))
    expected = [marching_cubes(order(values), method=method) for order in (np.array, np.asfortranarray)]
    monkeypatch.setattr(marching_grid, "SLAB_SAMPLES", samples)
    for order, (vertices, triangles) in zip((np.array, np.asfortranarray), expected, strict=True):
        found = marching_cubes(order(values), method=method)
        assert np.array_equal(found[0], vertices)
        assert np.array_equal(soup(*found), soup(vertices, triangles))


# What is refused

@pytest.mark.parametrize(("values", "word"), [
    (np.zeros((4, 4)), "shape"), (np.zeros((2, 2, 2, 2)), "shape"), (np.zeros((1, 4, 4)), "shape"),
    (np.zeros((4, 4, 1)), "shape"), (np.zeros((0, 4, 4)), "shape"), (3.0, "shape"),
    (np.broadcast_to(np.uint8(0), (1024, 1024, 513)), str(MOST_SAMPLES)),
    (np.zeros((3, 3, 3), complex), "complex"), (np.full((3, 3, 3), None), "object"),
    (np.full((3, 3, 3), "a"), "real"), (np.zeros((3, 3, 3), "M8[s]"), "real"), (np.zeros((3, 3, 3), "V4"), "real")])
def test_what_is_no_grid_of_numbers_is_refused(method: str, values: Any, word: str) -> None:
    """The message says what it is instead."""
    with pytest.raises(ValueError, match=word):
        marching_cubes(values, method=method)


@pytest.mark.parametrize(("name", "value"), [
    ("level", math.nan), ("level", math.inf), ("level", -math.inf), ("level", np.float32("nan")),
    ("spacing", (1, 1)), ("spacing", 1.0), ("spacing", (1, 1, 0)), ("spacing", (1, -1, 1)),
    ("spacing", (1, 1, math.nan)), ("spacing", (math.inf, 1, 1)), ("spacing", None), ("spacing", [[1, 1, 1]]),
    ("method", "cube"), ("method", None), ("topology", "tables"), ("topology", "")])
def test_what_is_no_choice_is_refused(method: str, name: str, value: Any) -> None:
    """The message names it."""
    with pytest.raises(ValueError, match=name):
        marching_cubes(np.zeros((3, 3, 3)), **{"method": method, name: value})


def test_tetrahedra_have_no_trilinear_surface(method: str) -> None:
    """Cubes have: for them it is only a matter of asking."""
    values = np.random.default_rng(15).normal(size=(4, 4, 4))
    if method == "tetrahedra":
        with pytest.raises(ValueError, match="trilinear"):
            marching_cubes(values, method=method, topology="trilinear")
    else:
        assert len(marching_cubes(values, method=method, topology="trilinear")[1])


# Shapes with closed forms

@dataclass(frozen=True)
class Shape:
    """A closed surface: where ``field`` is 0, within ``reach`` of the middle; ``bend`` is its largest curvature."""

    field: Callable[[Place], Floats]
    gradient: Callable[[Place], Place]
    reach: tuple[float, float, float]
    area: float
    bend: float
    euler: int

    def distance(self, places: Floats) -> Floats:
        """How far places (n, 3) next to the surface are from it."""
        p = places[:, 0], places[:, 1], places[:, 2]
        return np.asarray(np.abs(self.field(p)) / np.linalg.norm(self.gradient(p), axis=0))


RING, TUBE = 0.9, 0.35
# Of the tangle cube: scikit-image's area at 129 and 257 samples a side, extrapolated, and its largest curvature.
TANGLE_AREA, TANGLE_BEND = 100.9416, 4.852
AXES = (1.0, 0.8, 0.6)
SHAPES = {
    "sphere": Shape(lambda p: np.hypot(np.hypot(p[0], p[1]), p[2]) - 1.0, lambda p: p, (1.3, 1.25, 1.2),
                    4.0 * math.pi, 1.0, 2),
    "torus": Shape(
        lambda p: np.hypot(np.hypot(p[0], p[1]) - RING, p[2]) - TUBE,
        lambda p: (p[0] * (1.0 - RING / np.hypot(p[0], p[1])), p[1] * (1.0 - RING / np.hypot(p[0], p[1])), p[2]),
        (1.4, 1.5, 0.6), 4.0 * math.pi**2 * RING * TUBE, 1.0 / TUBE, 0),
    "ellipsoid": Shape(
        lambda p: sum((x / a)**2 for x, a in zip(p, AXES, strict=True)) - 1.0,
        lambda p: tuple(2.0 * x / a**2 for x, a in zip(p, AXES, strict=True)), (1.2, 1.0, 0.75),
        4.0 * math.pi * float(elliprg(*((AXES[0] * AXES[1] * AXES[2] / a)**2 for a in AXES))),
        AXES[0] / AXES[2]**2, 2),
    "tangle cube": Shape(
        lambda p: sum(x * x * (x * x - 5.0) for x in p) + 11.8,
        lambda p: tuple(x * (4.0 * x * x - 10.0) for x in p), (2.6, 2.5, 2.7), TANGLE_AREA, TANGLE_BEND, -8),
}


def sampled(shape: Shape, n: int) -> tuple[Floats, Floats]:
    """The field at n x (n - 2) x (n + 3) samples, and the spacing, which differs from axis to axis."""
    counts = np.array([n, n - 2, n + 3])
    reach = np.array(shape.reach)
    places = np.meshgrid(*(np.linspace(-r, r, m) for r, m in zip(reach, counts, strict=True)), indexing="ij")
    return shape.field((places[0], places[1], places[2])), 2.0 * reach / (counts - 1)


def orders(sizes: list[float], errors: list[float]) -> float:
    """The exponent with which errors fall from the coarsest grid to the finest."""
    return math.log(errors[0] / errors[-1]) / math.log(sizes[0] / sizes[-1])


@pytest.mark.parametrize("name", SHAPES)
def test_finer_grids_come_nearer_the_shape(method: str, name: str) -> None:
    """Area with the square of the spacing, normals in proportion to it; places within 1.2 h^2 times the bend."""
    shape = SHAPES[name]
    sizes, area_errors, angles = [], [], []
    for n in (17, 33, 65):
        values, spacing = sampled(shape, n)
        vertices, triangles = marching_cubes(values, 0.0, spacing, method)
        assert not len(open_edges(vertices, triangles))
        assert euler_characteristic(vertices, triangles) == shape.euler
        corners = corners_of(vertices, triangles) - shape.reach
        middles, area = corners.mean(axis=1), areas(vertices, triangles)
        sizes.append(float(spacing.max()))
        halves = 0.5 * (corners + np.roll(corners, 1, axis=1)).reshape(-1, 3)
        places = np.concatenate([corners.reshape(-1, 3), middles, halves])
        assert shape.distance(places).max() < 1.2 * shape.bend * sizes[-1]**2
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        true = np.stack(shape.gradient((middles[:, 0], middles[:, 1], middles[:, 2])), axis=1)
        cosine = np.einsum("ij,ij->i", normals, true) / np.linalg.norm(normals, axis=1) / np.linalg.norm(true, axis=1)
        area_errors.append(abs(float(area.sum()) - shape.area))
        angles.append(float((np.arccos(np.clip(cosine, -1.0, 1.0)) * area).sum() / area.sum()))
    assert orders(sizes, area_errors) >= 1.8
    assert orders(sizes, angles) >= 0.9
    assert angles[-1] < math.radians(3.0)


# Another implementation

@pytest.mark.parametrize("seed", range(4))
def test_smooth_fields_give_what_scikit_image_gives(method: str, seed: int) -> None:
    """Cubes the same vertices, as many triangles, and nearly the same area and volume; tetrahedra the latter."""
    spacing = (0.5, 1.0, 1.25)
    noise = gaussian_filter(np.random.default_rng(seed).normal(size=(20, 22, 24)), 3.0)
    values = padded(noise / noise.std(), 3.0)
    vertices, triangles = marching_cubes(values, -0.2, spacing, method)
    expected = measure.marching_cubes(values, -0.2, spacing=spacing, gradient_direction="ascent",
                                      allow_degenerate=False, method="lewiner")
    if method == "cubes":
        assert len(triangles) == len(expected[1])
        order, expected_order = np.lexsort(vertices.round(3).T), np.lexsort(expected[0].round(3).T)
        assert np.allclose(vertices[order], expected[0][expected_order], atol=2e-3)
    tolerance = 0.002 if method == "cubes" else 0.03
    assert areas(vertices, triangles).sum() == pytest.approx(areas(*expected[:2]).sum(), rel=tolerance)
    # Whichever way scikit-image's triangles are turned; ours face outwards.
    assert enclosed(vertices, triangles) == pytest.approx(abs(enclosed(*expected[:2])), rel=tolerance)


def enclosed(vertices: NDArray[np.floating], triangles: NDArray[np.integer]) -> float:
    """What a closed surface encloses."""
    return float(np.linalg.det(corners_of(vertices, triangles)).sum() / 6.0)
