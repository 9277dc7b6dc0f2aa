"""The level set of the trilinear function: its topology by two independent methods, and a mesh without a flaw."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import ndimage, sparse

from viewer.kit.trilinear import trilinear_surface

Array: TypeAlias = NDArray[np.float64]
Counts: TypeAlias = NDArray[np.int64]

SIGNS = np.array([[[[1.0 if case >> (i + 2 * j + 4 * k) & 1 else -1.0 for k in (0, 1)] for j in (0, 1)] for i in (0, 1)]
                  for case in range(256)])
ALTERNATING = SIGNS[0b01101001]
OPPOSITE = SIGNS[[0x81, 0x7E, 0x42, 0xBD, 0x24, 0xDB, 0x18, 0xE7]]    # two opposite corners against six
HAIR, DUST = 1e-4, 1e-6


def random_cells(kind: str, count: int, seed: int = 7) -> Array:
    """``count`` cells (n, 2, 2, 2) minus their level, of one distribution."""
    rng = np.random.default_rng(seed)
    shape = (count, 2, 2, 2)
    case = rng.integers(0, 256, count)
    some_small = np.where(rng.random(shape) < 0.5, 1.0, 0.2)
    kinds: dict[str, Callable[[], Array]] = {
        "uniform": lambda: rng.uniform(-1.0, 1.0, shape),
        "gaussian": lambda: rng.standard_normal(shape),
        "every sign": lambda: SIGNS[case] * rng.uniform(0.01, 1.0, shape),
        "every magnitude": lambda: SIGNS[case] * 10.0 ** rng.uniform(-3.0, 1.0, shape),
        "case 13": lambda: ALTERNATING * rng.choice([-1.0, 1.0], (count, 1, 1, 1)) * rng.uniform(0.05, 1.0, shape),
        "tunnels": lambda: OPPOSITE[rng.integers(0, 8, count)] * some_small * rng.uniform(0.05, 1.0, shape),
        "small integers": lambda: rng.integers(-1, 2, shape).astype(np.float64),
        "integers": lambda: rng.integers(-3, 4, shape).astype(np.float64),
        "saddles at the level": lambda: np.where(rng.random((count, 1, 1, 1)) < 0.5, 1.0, -1.0) * ALTERNATING
        * rng.integers(0, 5, shape),
    }
    return kinds[kind]()


KINDS = ("uniform", "gaussian", "every sign", "every magnitude", "case 13", "tunnels")
EXACT_KINDS = ("small integers", "integers", "saddles at the level")    # samples and saddles exactly at the level


def in_a_row(boxes: Array) -> Array:
    """One grid (a, b, 3 n) with all the boxes (n, a, b, 2), slices without values between them."""
    grid = np.full((*boxes.shape[1:3], 3 * len(boxes)), np.nan)
    grid[:, :, 0::3], grid[:, :, 1::3] = boxes[..., 0].transpose(1, 2, 0), boxes[..., 1].transpose(1, 2, 0)
    return grid


def box_in_row(points: Array) -> Counts:
    """The number of the box in a row that points (n, ..., 3) lie in."""
    return np.asarray(points[..., 2] // 3, np.int64)


def directed_edges(triangles: NDArray[np.int32]) -> NDArray[np.int32]:
    """The edges (3 m, 2) of triangles (m, 3), as each of them runs around it."""
    return np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])


def assert_sound(vertices: Array, triangles: NDArray[np.int32]) -> Array:
    """No zero area, no unused vertex, every edge with one triangle on either side; the (n, 2, 3) ends of open edges."""
    assert vertices.dtype == np.float64 and triangles.dtype == np.int32 and np.isfinite(vertices).all()
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    assert (np.linalg.norm(np.cross(b - a, c - a), axis=1) > 1e-9).all()
    assert (np.bincount(triangles.ravel(), minlength=len(vertices)) > 0).all()
    edges = directed_edges(triangles).astype(np.int64)
    there, back = edges @ [len(vertices), 1], edges @ [1, len(vertices)]
    assert len(np.unique(there)) == len(there)
    return vertices[edges[~np.isin(there, back)]]


def on_border(ends: Array, shape: tuple[int, ...]) -> bool:
    """Whether each of the edges (n, 2, 3) lies in one of the grid's outer faces."""
    upper = np.array(shape) - 1
    return bool(((ends == 0).all(axis=1) | (ends == upper).all(axis=1)).any(axis=1).all())


def components(count: int, pairs: NDArray[np.int32]) -> NDArray[np.int32]:
    """The number of the connected component of each of ``count`` vertices."""
    graph = sparse.coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    label: NDArray[np.int32] = sparse.csgraph.connected_components(graph, directed=False)[1]
    return label


def topology(vertices: Array, triangles: NDArray[np.int32], group: Counts, groups: int) -> tuple[Counts, Counts]:
    """The Euler characteristic and the number of components of the mesh, for each group of vertices."""
    edges = np.unique(np.sort(directed_edges(triangles), axis=1), axis=0)
    vertex_count, edge_count, triangle_count = (
        np.bincount(group[part], minlength=groups) for part in (slice(None), edges[:, 0], triangles[:, 0]))
    first = np.unique(components(len(vertices), edges), return_index=True)[1]
    return vertex_count - edge_count + triangle_count, np.bincount(group[first], minlength=groups)


def cell_topology(cells: Array) -> tuple[Counts, Counts]:
    """The same for each of ``cells``, whose meshes it checks."""
    vertices, triangles = trilinear_surface(in_a_row(cells), 0.0)
    ends = assert_sound(vertices, triangles)
    assert (vertices >= 0.0).all() and (vertices[:, :2] <= 1.0).all() and (vertices[:, 2] % 3 <= 1.0).all()
    assert on_border(ends - [0, 0, 3] * box_in_row(ends)[..., None], (2, 2, 2))
    return topology(vertices, triangles, box_in_row(vertices), len(cells))


# The first independent method: Morse theory.

def bilinear(square: Array, s: Array, t: Array) -> Array:
    """The bilinear functions between corners (n, 2, 2) at (s, t)."""
    return (square[:, 0, 0] * (1 - s) * (1 - t) + square[:, 1, 0] * s * (1 - t)
            + square[:, 0, 1] * (1 - s) * t + square[:, 1, 1] * s * t)


def inside_unit(*places: Array) -> NDArray[np.bool_]:
    """Where all of the places are between 0 and 1."""
    return np.asarray(np.all([(place > 0) & (place < 1) for place in places], axis=0), np.bool_)


def body_saddles(cells: Array) -> list[tuple[NDArray[np.bool_], Array, Array]]:
    """The two points where the gradient vanishes: whether in the cell, the value and the Hessian's determinant."""
    h = cells[:, 0, 0, 0]
    e, f, g = cells[:, 1, 0, 0] - h, cells[:, 0, 1, 0] - h, cells[:, 0, 0, 1] - h
    b, c, d = cells[:, 1, 1, 0] - h - e - f, cells[:, 0, 1, 1] - h - f - g, cells[:, 1, 0, 1] - h - e - g
    a = cells[:, 1, 1, 1] - h - e - f - g - b - c - d    # a xyz + b xy + c yz + d zx + e x + f y + g z + h
    saddles = []
    with np.errstate(all="ignore"):
        p, q, r = e - b * d / a, f - b * c / a, g - c * d / a
        for sign in (1, -1):
            x = sign * np.sqrt(-q * r / (a * p))
            x, y, z = x - c / a, -r / (a * x) - d / a, -q / (a * x) - b / a
            value = a * x * y * z + b * x * y + c * y * z + d * z * x + e * x + f * y + g * z + h
            saddles.append((inside_unit(x, y, z), value, 2 * (a * z + b) * (a * x + c) * (a * y + d)))
    return saddles


def morse_characteristic(cells: Array) -> tuple[Counts, Array]:
    """The Euler characteristic of each cell's level set 0, and how near to 0 a saddle's value comes.

    Stratified Morse theory (Goresky and MacPherson, 1988): where the level rises past a critical value, the
    region below changes its characteristic by 1 minus that of the directions in which values are lower. For
    the boundary of the region inside: level set + part of the cell's boundary = 2 * region.
    """
    region, boundary = np.zeros((2, len(cells)), np.int64)
    nearest = np.full(len(cells), np.inf)
    for i, j, k in np.ndindex(2, 2, 2):
        value = cells[:, i, j, k]
        rise = np.stack([cells[:, 1 - i, j, k], cells[:, i, 1 - j, k], cells[:, i, j, 1 - k]], axis=1) - value[:, None]
        lowest, highest = (value < 0) & (rise > 0).all(axis=1), (value < 0) & (rise < 0).all(axis=1)
        region += lowest
        boundary += lowest.astype(np.int64) + highest
    for axis, side in np.ndindex(3, 2):
        square, opposite = np.take(cells, side, axis + 1), np.take(cells, 1 - side, axis + 1)
        a, b, c, d = square[:, 0, 0], square[:, 1, 0], square[:, 1, 1], square[:, 0, 1]
        with np.errstate(all="ignore"):
            s, t, value = ((upper / (a + c - b - d)) for upper in (a - d, a - b, a * c - b * d))
            below = inside_unit(s, t) & (value < 0)
            region -= below & (bilinear(opposite, s, t) > value)
        boundary -= below
        nearest = np.where(inside_unit(s, t), np.minimum(nearest, np.abs(value)), nearest)
    for within, value, determinant in body_saddles(cells):
        region += np.where(within & (value < 0), np.where(determinant > 0, 1, -1), 0)
        nearest = np.where(within, np.minimum(nearest, np.abs(value)), nearest)
    return 2 * region - boundary, nearest


@pytest.mark.parametrize("kind", KINDS)
def test_every_cell_has_the_topology_that_its_critical_points_give(kind: str) -> None:
    """Exact, so that none is skipped. As there are discs and tubes only, the characteristic counts the discs."""
    cells = random_cells(kind, 8000)
    characteristic, pieces = cell_topology(cells)
    assert np.array_equal(characteristic, morse_characteristic(cells)[0])
    assert set(pieces - characteristic) <= {0, 1}    # at most one tube


@pytest.mark.parametrize("kind", EXACT_KINDS)
def test_a_saddle_or_a_sample_at_the_level_counts_as_outside(kind: str) -> None:
    """As if the level were a hair lower; some dust, finer still, splits critical points that coincide."""
    cells = random_cells(kind, 8000)
    dust = np.random.default_rng(8).uniform(-DUST, DUST, cells.shape)
    assert np.array_equal(cell_topology(cells)[0], morse_characteristic(cells + HAIR + dust)[0])


# The second independent method: count on a finer grid.

def refined(values: Array, parts: int) -> Array:
    """The trilinear interpolant of a grid on one with ``parts`` times as many cells along each axis."""
    for axis in range(3):
        place = np.arange((values.shape[axis] - 1) * parts + 1) / parts
        low = np.minimum(place.astype(np.int64), values.shape[axis] - 2)
        t = (place - low).reshape([-1 if other == axis else 1 for other in range(3)])
        values = np.take(values, low, axis) * (1 - t) + np.take(values, low + 1, axis) * t
    return values


def characteristic_of_samples(chosen: NDArray[np.bool_]) -> int:
    """Vertices - edges + squares - cubes among the chosen samples."""
    total = 0
    for directions in range(8):
        part = chosen
        for axis in (axis for axis in range(3) if directions >> axis & 1):
            low, high = ([slice(None)] * axis + [half] for half in (slice(None, -1), slice(1, None)))
            part = part[*low] & part[*high]
        total += (-1) ** directions.bit_count() * int(part.sum())
    return total


def counted_topology(values: Array, parts: int) -> tuple[int, int]:
    """Characteristic and components of the level set 0, from the two regions that it parts a box into.

    The regions overlap in the level set and make up the box, whose characteristic is 1; and a box has one
    region more than sheets in it.
    """
    inside = refined(values, parts) < 0.0
    regions = [inside, ~inside]
    return (sum(characteristic_of_samples(region) for region in regions) - 1,
            sum(int(ndimage.label(region)[1]) for region in regions) - 1)


@pytest.mark.parametrize(("kind", "most_skipped"), [
    ("uniform", 0.02), ("gaussian", 0.03), ("every sign", 0.02), ("case 13", 0.11), ("tunnels", 0.01),
    ("integers", 0.08)])
def test_every_cell_has_the_topology_that_a_fine_grid_shows(kind: str, most_skipped: float) -> None:
    """A few cells are skipped, with a saddle so near the level that 40 samples a side cannot tell its side."""
    cells = random_cells(kind, 4000, seed=9)
    cells /= np.abs(cells).max(axis=(1, 2, 3), keepdims=True)
    characteristic, pieces = cell_topology(cells)
    clear = np.flatnonzero(morse_characteristic(cells)[1] > 0.003)
    assert len(clear) >= (1.0 - most_skipped) * len(cells)
    tubes = clear[pieces[clear] != characteristic[clear]]
    for cell in np.unique(np.concatenate([clear[:60], tubes[:20]])):
        assert (characteristic[cell], pieces[cell]) == counted_topology(cells[cell], 40)


def clear_noise(shape: tuple[int, int, int], seed: int) -> Array:
    """Noise whose samples and saddles all keep away from 0: cells with a near one drawn again until none is left."""
    rng = np.random.default_rng(seed)
    noise = rng.standard_normal(shape)
    while True:
        corners = np.stack([noise[i:i + shape[0] - 1, j:j + shape[1] - 1, k:k + shape[2] - 1].ravel()
                            for i, j, k in np.ndindex(2, 2, 2)], axis=1).reshape(-1, 2, 2, 2)
        near = np.flatnonzero(morse_characteristic(corners)[1] < 0.03)
        if not len(near):
            return noise
        for cell in near:
            i, j, k = np.unravel_index(cell, tuple(n - 1 for n in shape))
            noise[i + rng.integers(2), j + rng.integers(2), k + rng.integers(2)] = rng.standard_normal()


@pytest.mark.parametrize("seed", range(6))
def test_noise_has_the_topology_that_a_fine_grid_shows(seed: int) -> None:
    """Many cells together: as many components and handles as counted on a grid 24 times finer."""
    noise = clear_noise((5, 6, 7), seed)
    vertices, triangles = trilinear_surface(noise, 0.0)
    found = topology(vertices, triangles, np.zeros(len(vertices), np.int64), 1)
    assert (int(found[0][0]), int(found[1][0])) == counted_topology(noise, 24)


# The mesh.

@pytest.mark.parametrize("axis", range(3))
def test_cells_agree_on_the_face_they_share(axis: int) -> None:
    """All 4096 patterns of signs of two neighbours: open only at their common border."""
    pattern = np.arange(4096)[:, None] >> np.arange(12) & 1
    magnitude = np.random.default_rng(axis).uniform(0.01, 1.0, (4096, 12))
    pairs = (np.where(pattern, 1.0, -1.0) * magnitude).reshape(-1, 3, 2, 2)
    turned = [(k + axis) % 3 for k in range(3)]
    vertices, triangles = trilinear_surface(np.moveaxis(in_a_row(pairs), (0, 1, 2), turned), 0.0)
    ends = assert_sound(vertices, triangles)[..., turned]
    assert on_border(ends - [0, 0, 3] * box_in_row(ends)[..., None], (3, 2, 2))


@pytest.mark.parametrize("seed", range(100))
def test_noise_at_the_level_has_no_crack(seed: int) -> None:
    """Integers, so that many samples, saddles and crossings coincide with the level or with each other."""
    rng = np.random.default_rng(seed)
    grid = rng.integers(-1 - seed % 4, 2 + seed % 4, (6, 7, 8))
    ends = assert_sound(*trilinear_surface(grid, 0.0))
    assert len(ends) and on_border(ends, grid.shape)


def test_each_crossed_edge_has_one_vertex() -> None:
    """At A / (A - B), kept from the ends; the others lie inside cells."""
    rng = np.random.default_rng(3)
    grid = rng.integers(-2, 3, (7, 8, 9)) + rng.choice([0.0, 0.25], (7, 8, 9))
    vertices, _ = trilinear_surface(grid, 0.0)
    on_edge = (vertices % 1 != 0).sum(axis=1) == 1
    assert ((vertices[~on_edge] % 1 > 1e-4).all())
    expected = []
    for axis in range(3):
        A, B = (np.delete(grid, end, axis) for end in (-1, 0))
        place = np.argwhere((A < 0) != (B < 0)).astype(np.float64)
        A, B = (part[(A < 0) != (B < 0)] for part in (A, B))
        place[:, axis] += np.clip(A / (A - B), 1e-4, 1 - 1e-4)
        expected.append(place)
    crossings = np.concatenate(expected)
    assert np.allclose(np.unique(vertices[on_edge].round(9), axis=0), np.unique(crossings.round(9), axis=0))
    assert on_edge.sum() == len(crossings)


def crossing_pairs(corners: Array, apart: NDArray[np.bool_]) -> Counts:
    """Which pairs of triangles (n, 2, 3, 3) cross: an edge of the one through the other, no corner shared by them."""
    crossed = np.zeros(len(corners), np.bool_)
    for one, other in ((0, 1), (1, 0)):
        a, b, c = corners[:, other].transpose(1, 0, 2)
        normal = np.cross(b - a, c - a)
        for k in range(3):
            p, q = corners[:, one, k], corners[:, one, (k + 1) % 3]
            height, end = (np.einsum("ij,ij->i", point - a, normal) for point in (p, q))
            through = (height * end < 0) & apart[:, one, k] & apart[:, one, (k + 1) % 3]
            with np.errstate(all="ignore"):
                at = p + (height / (height - end))[:, None] * (q - p)
                for u, v in ((a, b), (b, c), (c, a)):
                    through &= np.einsum("ij,ij->i", np.cross(v - u, at - u), normal) > 0
            crossed |= through
    return np.flatnonzero(crossed)


def triangle_pairs(triangles: NDArray[np.int32], cell: Counts) -> Counts:
    """All pairs of triangles of the same cell."""
    order = np.argsort(cell[triangles[:, 0]], kind="stable")
    count = np.bincount(cell[triangles[:, 0]])
    start = np.cumsum(count) - count
    pairs = [np.stack([(start[count == n][:, None] + half).ravel() for half in np.triu_indices(n, 1)], axis=1)
             for n in np.unique(count[count > 1])]
    return np.asarray(order[np.concatenate(pairs)], np.int64)


@pytest.mark.parametrize("kind", [*KINDS, "integers"])
def test_no_two_triangles_of_a_cell_cross(kind: str) -> None:
    """Discs and tubes keep apart from each other and from themselves; a check that finds triangles that do cross."""
    vertices, triangles = trilinear_surface(in_a_row(random_cells(kind, 3000)), 0.0)
    pairs = triangles[triangle_pairs(triangles, box_in_row(vertices))]
    same = pairs[:, 0, :, None] == pairs[:, 1, None, :]
    apart = np.stack([~same.any(axis=2), ~same.any(axis=1)], axis=1)
    assert not len(crossing_pairs(vertices[pairs], apart))
    assert len(crossing_pairs(np.random.default_rng(0).random((50, 2, 3, 3)), np.ones((50, 2, 3), np.bool_)))


def tangle(points: Array) -> Array:
    """The tangle cube of genus 5 at ``points`` (..., 3)."""
    return np.asarray((points**4 - 5.0 * points**2).sum(axis=-1) + 11.8)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_a_smooth_surface_faces_larger_values(dtype: type[np.floating]) -> None:
    """Closed, of Euler characteristic -8, its normals along the gradient, its vertices on the surface."""
    step = 6.4 / np.array([31.0, 36.0, 41.0])
    grid = np.moveaxis(np.indices((32, 37, 42)), 0, -1) * step - 3.2
    vertices, triangles = trilinear_surface(tangle(grid).astype(dtype), 0.0)
    assert not len(assert_sound(vertices, triangles))
    assert topology(vertices, triangles, np.zeros(len(vertices), np.int64), 1)[0][0] == -8
    points = vertices * step - 3.2
    a, b, c = points[triangles].transpose(1, 0, 2)
    middle = (a + b + c) / 3.0
    slope = np.cross(b - a, c - a) * (4.0 * middle**3 - 10.0 * middle)
    assert (slope.sum(axis=1) > 0).all()
    assert np.abs(tangle(points)).max() < 0.6


def test_samples_without_a_value_leave_their_cells_out() -> None:
    """Nothing next to NaN or infinity, the mesh elsewhere as if they were numbers, open at the gap only."""
    rng = np.random.default_rng(5)
    grid = rng.standard_normal((9, 9, 9))
    holed = grid.copy()
    holed[4, 4, 4], holed[0, 0, 0], holed[8, 4, 8] = np.nan, np.inf, -np.inf
    vertices, triangles = trilinear_surface(holed, 0.0)
    cell = np.floor(vertices[triangles].mean(axis=1))
    for hole in ((4, 4, 4), (0, 0, 0), (8, 4, 8)):
        assert not ((cell >= np.array(hole) - 1) & (cell <= hole)).all(axis=1).any()
    all_vertices, all_triangles = trilinear_surface(grid, 0.0)
    all_cell = np.floor(all_vertices[all_triangles].mean(axis=1))
    kept = [not any((np.abs(one - np.array(hole) + 0.5) < 1).all() for hole in ((4, 4, 4), (0, 0, 0), (8, 4, 8)))
            for one in all_cell]
    assert np.array_equal(all_vertices[all_triangles[kept]], vertices[triangles])
    ends = assert_sound(vertices, triangles)
    by_gap = np.array([(np.abs(ends - hole) <= 1).all(axis=(1, 2)) for hole in ((4, 4, 4), (0, 0, 0), (8, 4, 8))])
    assert on_border(ends[~by_gap.any(axis=0)], holed.shape)


@pytest.mark.parametrize(("values", "level"), [
    (np.zeros((4, 4, 4)), 0.0), (np.ones((4, 4, 4), int), 0.5), (np.full((3, 3, 3), np.nan), 0.0),
    (np.arange(8).reshape(1, 2, 4), 3.5), (np.zeros((0, 3, 3)), 0.0), (np.zeros((1, 1, 1)), 1.0)])
def test_nothing_to_draw_is_an_empty_mesh(values: Array, level: float) -> None:
    """A constant, no value at all, a grid without cells."""
    vertices, triangles = trilinear_surface(values, level)
    assert vertices.shape == (0, 3) and triangles.shape == (0, 3)
    assert vertices.dtype == np.float64 and triangles.dtype == np.int32


def test_levels_between_integers_and_far_magnitudes() -> None:
    """Integers with a fractional level, values whose products leave a float's range."""
    rng = np.random.default_rng(6)
    counts = rng.integers(0, 200, (6, 6, 6)).astype(np.uint8)
    expected = trilinear_surface(counts.astype(np.float64), 99.3)
    for values, level, scale in ((counts, 99.3, 1.0), (counts.astype(np.int64), 99.3, 1.0),
                                 (counts * 2.0**-1000, 99.3, 2.0**-1000), (counts * 2.0**1000, 99.3, 2.0**1000)):
        vertices, triangles = trilinear_surface(values, level * scale)
        assert np.array_equal(triangles, expected[1]) and np.allclose(vertices, expected[0], atol=1e-12)


@pytest.mark.parametrize("level", [0.1, 0.7])
def test_a_float32_sample_is_at_the_level_it_was_written_as(level: float) -> None:
    """Rounded to float32 one of these is above the level and one below; both are at it, so outside."""
    values = np.full((2, 2, 2), level, np.float32)
    values[0, 0, 0] = 0.0
    vertices, triangles = trilinear_surface(values, level)
    assert len(triangles) == 1 and (vertices.max(axis=1) > 0.999).all()


def test_a_grid_has_three_axes() -> None:
    """Anything else is refused by name."""
    with pytest.raises(ValueError, match=r"values: .*\(4, 4\)"):
        trilinear_surface(np.zeros((4, 4)), 0.0)
