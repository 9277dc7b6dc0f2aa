"""Perlin noise and turbulence: the published values, and what defines them."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from viewer.kit.noise import (
    PERMUTATION,
    TURBULENCE_OCTAVES,
    noise,
    noise_derivative,
    turbulence,
    turbulence_derivative,
)

ORDERS = [order for order in product(range(4), repeat=3) if 0 < sum(order) <= 3]


def central_difference(function, point, axis, step=1e-3):
    """Sixth-order central difference along one axis; point has shape (3, n)."""
    offset = np.zeros((3, 1))
    offset[axis] = step
    weights = {1: 3 / 4, 2: -3 / 20, 3: 1 / 60}
    rises = (w * (function(*(point + k * offset)) - function(*(point - k * offset))) for k, w in weights.items())
    return sum(rises) / step


def inner_points(count, scale=1.0, low=-20, high=20):
    """Random points at least 5 % of a cell away from every face of the lattice of the finest octave."""
    random = np.random.default_rng(4)
    cells = random.integers(low * scale, high * scale, (3, count))
    return (cells + random.uniform(0.05, 0.95, (3, count))) / scale


def test_noise_has_perlins_published_value() -> None:
    assert noise(3.14, 42, 7) == pytest.approx(0.13691995878400012, abs=0)


def test_table_is_a_permutation() -> None:
    assert sorted(PERMUTATION) == list(range(256))


def test_noise_is_zero_at_lattice_points() -> None:
    lattice = np.arange(-300, 300)
    assert not noise(lattice, lattice[::-1], 7).any()


def test_noise_has_period_256() -> None:
    x, y, z = np.random.default_rng(1).integers(-2**20, 2**20, (3, 500)) / 2**10
    np.testing.assert_array_equal(noise(x, y, z), noise(x + 256, y - 512, z + 1024))


def test_gradient_at_lattice_points_is_the_direction_of_an_edge() -> None:
    x, y, z = np.random.default_rng(2).integers(-500, 500, (3, 500))
    gradient = np.array([noise_derivative(x, y, z, order) for order in np.eye(3, dtype=int)])
    np.testing.assert_array_equal(np.sort(np.abs(gradient), axis=0).T, np.tile([0.0, 1.0, 1.0], (500, 1)))


def test_noise_stays_within_its_range_and_averages_to_nothing() -> None:
    values = noise(*np.random.default_rng(3).uniform(-128, 128, (3, 200_000)))
    assert 0.8 < np.abs(values).max() < 1.05
    assert abs(values.mean()) < 0.01


@pytest.mark.parametrize("order", [order for order in product(range(3), repeat=3) if sum(order) <= 2])
def test_noise_is_continuous_to_its_second_derivative(order) -> None:
    random = np.random.default_rng(6)
    for axis in range(3):
        point = random.uniform(-20, 20, (3, 300))
        point[axis] = np.round(point[axis])
        before, after = point.copy(), point.copy()
        before[axis] -= 1e-9
        after[axis] += 1e-9
        np.testing.assert_allclose(noise_derivative(*before, order), noise_derivative(*after, order), atol=2e-6)


@pytest.mark.parametrize("order", ORDERS)
def test_derivative_of_noise_agrees_with_central_differences(order) -> None:
    axis = next(axis for axis in range(3) if order[axis])
    lower = tuple(n - (k == axis) for k, n in enumerate(order))
    point = inner_points(400)
    expected = central_difference(lambda x, y, z: noise_derivative(x, y, z, lower), point, axis)
    np.testing.assert_allclose(noise_derivative(*point, order), expected, atol=1e-7)


def test_turbulence_sums_the_sizes_of_its_octaves() -> None:
    x, y, z = np.random.default_rng(7).uniform(-9, 9, (3, 200))
    expected = sum(abs(noise(2**i * x, 2**i * y, 2**i * z)) / 2**i for i in range(TURBULENCE_OCTAVES))
    np.testing.assert_allclose(turbulence(x, y, z), expected, rtol=1e-14)


@pytest.mark.parametrize("order", [order for order in ORDERS if sum(order) <= 2])
def test_derivative_of_turbulence_agrees_with_central_differences(order) -> None:
    axis = next(axis for axis in range(3) if order[axis])
    lower = tuple(n - (k == axis) for k, n in enumerate(order))
    point = inner_points(1000, scale=32)
    octaves = [noise(*(point * 2**i)) for i in range(TURBULENCE_OCTAVES)]
    point = point[:, np.min(np.abs(octaves), axis=0) > 0.02]
    expected = central_difference(lambda x, y, z: turbulence_derivative(x, y, z, lower), point, axis, step=2e-5)
    np.testing.assert_allclose(turbulence_derivative(*point, order), expected, rtol=1e-6, atol=2e-6)
    assert point.shape[1] > 300


def test_arguments_broadcast_and_missing_ones_are_zero() -> None:
    x, y = np.linspace(0, 3, 4), np.linspace(0, 2, 5)[:, None]
    assert noise(x, y).shape == (5, 4)
    np.testing.assert_array_equal(noise(x + 0.3), noise(x + 0.3, 0, 0))
    np.testing.assert_array_equal(turbulence(x + 0.3), turbulence(x + 0.3, 0, 0))


def test_type_follows_the_arrays() -> None:
    x = np.linspace(0.1, 9, 20, dtype=np.float32)
    assert noise(x).dtype == turbulence(x, 0.5).dtype == np.float32
    assert noise(x, x.astype(np.float64)).dtype == noise(np.arange(3)).dtype == np.float64
    np.testing.assert_allclose(noise(x), noise(x.astype(np.float64)), atol=1e-6)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_no_number_gives_no_number_without_a_warning(value, recwarn) -> None:
    assert np.isnan(noise(value, 1.5, 2.5))
    assert np.isnan(turbulence(np.array([value]))).all()
    assert np.isfinite(noise(1e300, -1e25, 0.5))
    assert not recwarn.list
