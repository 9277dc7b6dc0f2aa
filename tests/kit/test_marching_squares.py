"""Marching squares against closed forms, another implementation, and every pattern of signs there can be."""

from __future__ import annotations

import itertools
import time
from collections import Counter

import numpy as np
import pytest
from numpy.typing import NDArray
from skimage.measure import find_contours

from viewer.kit.interpolation import NEAREST
from viewer.kit.level_curve import distances, jumping
from viewer.kit.marching_squares import (
    AMBIGUOUS,
    NOT_A_VALUE,
    case_table,
    cell_cases,
    curve_count,
    joined,
    marching_squares,
    segments_of,
    trace,
)
from viewer.kit.sampled_square import errors_by_resolution, sample
from viewer.kit.square_cell import SquareCell

Numbers = NDArray[np.float64]
SADDLES = ("connect", "separate", "decider")
CIRCLE = 0.3


def circle(points: Numbers) -> Numbers:
    """Below zero within 0.3 of the unit square's middle."""
    return np.asarray(np.hypot(points[:, 0] - 0.5, points[:, 1] - 0.5) - CIRCLE)


def noises() -> list[Numbers]:
    """Random grids: real numbers, and small integers of which many equal the level."""
    chance = np.random.default_rng(3)
    return [chance.normal(size=(23, 31)), chance.integers(-1, 2, (40, 17)).astype(float),
            chance.integers(-2, 3, (30, 30)).astype(float)]


def loose_ends(values: Numbers, saddle: str, level: float = 0.0) -> list[NDArray[np.float32]]:
    """Ends of segments that no other segment continues from, apart from those on the grid's border."""
    segments = marching_squares(values, level, saddle=saddle)
    begins, ends = (Counter(map(tuple, segments[:, end])) for end in (0, 1))
    assert not segments.size or max([*begins.values(), *ends.values()]) == 1
    last = np.array(values.shape) - 1
    return [np.array(point) for point in begins.keys() ^ ends.keys()
            if not ((np.array(point) == 0) | (np.array(point) == last)).any()]


def bilinear(values: Numbers, points: Numbers) -> Numbers:
    """The samples' bilinear interpolation at ``points`` (n, 2) in cells."""
    i, j = np.minimum(points.astype(int), np.array(values.shape) - 2).T
    u, v = points[:, 0] - i, points[:, 1] - j
    return np.asarray((values[i, j] * (1 - u) + values[i + 1, j] * u) * (1 - v)
                      + (values[i, j + 1] * (1 - u) + values[i + 1, j + 1] * u) * v)


# The table

def test_the_sixteen_cases() -> None:
    """None, one or two segments, each edge whose corners differ used once and no other."""
    edges = ((0, 1), (1, 3), (2, 3), (0, 2))                    # bottom, right, top, left
    for case, answer in itertools.product(range(16), SADDLES[:2]):
        segments = segments_of(case, answer)
        differing = [edge for edge, (a, b) in enumerate(edges) if (case >> a ^ case >> b) & 1]
        assert sorted(edge for segment in segments for edge in segment) == differing
        assert len(segments) == (2 if case in AMBIGUOUS else int(case not in (0, 15)))
    table = case_table()
    assert table.shape == (2, 16, 2, 2)
    assert np.flatnonzero((table[0] != table[1]).any(axis=(1, 2))).tolist() == list(AMBIGUOUS)


@pytest.mark.parametrize("case", range(16))
def test_the_inside_is_on_the_left(case: int) -> None:
    """A step to the left of each segment's middle lowers the value, to the right raises it."""
    values = np.array([[-1.0 if case >> (x + 2 * y) & 1 else 1.0 for y in (0, 1)] for x in (0, 1)])
    for saddle in SADDLES:
        segments = marching_squares(values, saddle=saddle).astype(float)
        along = segments[:, 1] - segments[:, 0]
        left = 0.05 * np.stack([-along[:, 1], along[:, 0]], axis=1)
        middle = segments.mean(axis=1)
        assert (bilinear(values, middle + left) < bilinear(values, middle - left)).all()


def test_the_two_ways_to_join() -> None:
    """Connect leaves the cell's middle inside, separate outside; the decider asks the saddle."""
    for values in (np.array([[-1.0, 1.0], [1.0, -1.0]]), np.array([[1.0, -1.0], [-1.0, 1.0]])):
        for saddle, inside in (("connect", True), ("separate", False)):
            segments = marching_squares(values, saddle=saddle).astype(float)
            along, to_middle = segments[:, 1] - segments[:, 0], 0.5 - segments[:, 0]
            on_left = along[:, 0] * to_middle[:, 1] - along[:, 1] * to_middle[:, 0] > 0.0
            assert len(segments) == 2 and (on_left == inside).all()
        for lift, like in ((-0.1, "connect"), (0.1, "separate"), (0.0, "separate")):   # at the level: outside
            decided = marching_squares(values + lift)
            assert np.array_equal(decided, marching_squares(values + lift, saddle=like))


def test_the_decider_follows_the_bilinear_curve() -> None:
    """On random cells: the middle of a segment lies where the bilinear function's sign at the saddle allows."""
    chance = np.random.default_rng(5)
    for _ in range(300):
        a, d = -chance.uniform(0.01, 1, 2)
        b, c = chance.uniform(0.01, 1, 2)
        if chance.random() < 0.5:
            a, b, c, d = b, a, d, c
        saddle = (a * d - b * c) / (a + d - b - c)
        values = np.array([[a, c], [b, d]])
        assert SquareCell((a, b, c, d)).saddle_value == pytest.approx(saddle)
        like = "connect" if saddle < 0 else "separate"
        assert np.array_equal(marching_squares(values), marching_squares(values, saddle=like))


@pytest.mark.parametrize("saddle", SADDLES)
def test_all_pairs_of_neighbouring_cells_fit(saddle: str) -> None:
    """Every pattern of signs on 2 x 3 and 3 x 2 samples, with sizes at random and with all alike."""
    chance = np.random.default_rng(1)
    for signs in itertools.product((-1.0, 1.0), repeat=6):
        for sizes in (np.ones(6), chance.uniform(0.1, 1, 6)):
            values = np.array(signs) * sizes
            for shape in ((2, 3), (3, 2)):
                assert not loose_ends(values.reshape(shape), saddle)


# Grids

@pytest.mark.parametrize("saddle", SADDLES)
def test_no_loose_ends_on_noise(saddle: str) -> None:
    """Nor a segment of no length, nor a crossing off its edge; samples may equal the level."""
    for values in noises():
        for level in (0.0, 0.5, -1.0):
            assert not loose_ends(values, saddle, level)
            segments = marching_squares(values, level, saddle=saddle).astype(float)
            assert np.isfinite(segments).all()
            assert (np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1) > 0.5 * NEAREST).all()
            on_line = np.abs(segments - np.round(segments)) == 0.0
            assert (on_line.sum(axis=2) == 1).all()


def test_the_same_curve_as_another_implementation() -> None:
    """scikit-image's contours on noise: the same crossings, the same length, the same pieces."""
    values = np.random.default_rng(7).normal(size=(40, 50))
    for saddle, connected in (("connect", "low"), ("separate", "high")):
        ours = trace(values, 0.1, saddle=saddle)
        theirs = find_contours(values, 0.1, fully_connected=connected)
        assert curve_count(ours.edges) == len(theirs)
        length = sum(np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line in theirs)
        assert ours.length == pytest.approx(length, rel=1e-5)
        points = np.unique(np.concatenate(theirs).round(4), axis=0)
        mine = np.unique(ours.segments.reshape(-1, 2).astype(float).round(4), axis=0)
        near = np.abs(points[:, None] - mine[None]).max(axis=2).min(axis=1)
        assert near.max() < 2 * NEAREST


def test_values_place_and_spacing() -> None:
    """values[i, j] sits at (i, j) times the spacing; t = A / (A - B)."""
    values = np.array([[-1.0, -1.0, -1.0], [3.0, 3.0, 3.0]])
    segments = marching_squares(values, spacing=(2.0, 10.0))
    assert segments.dtype == np.float32
    assert np.allclose(segments, [[[0.5, 0], [0.5, 10]], [[0.5, 10], [0.5, 20]]])
    assert np.array_equal(cell_cases(np.array([[0.0, 1.0], [-1.0, 0.0]])), [[2]])      # at the level: outside


def test_samples_without_a_value() -> None:
    """The cells that touch one yield nothing; the others what they always do."""
    chance = np.random.default_rng(2)
    values = chance.normal(size=(20, 25))
    whole = trace(values)
    holes = chance.integers(0, 20, (12, 2))
    for kind in (np.nan, np.inf, -np.inf):
        broken = values.copy()
        broken[tuple(holes.T)] = kind
        touched = cell_cases(broken) == NOT_A_VALUE
        kept = ~touched[tuple(whole.cells.T)]
        assert touched.any() and np.array_equal(trace(broken).segments, whole.segments[kept])
    assert marching_squares(np.full((5, 5), np.nan)).shape == (0, 2, 2)
    assert marching_squares(np.ones((5, 5))).shape == (0, 2, 2)
    huge = marching_squares(np.array([[-1.7e308, 1.7e308], [1.7e308, -1.7e308]]))
    assert np.isfinite(huge).all() and len(huge) == 2


@pytest.mark.parametrize(("values", "saddle"), [
    (np.zeros(4), "decider"), (np.zeros((1, 4)), "decider"), (np.zeros((3, 3), complex), "decider"),
    (np.zeros((3, 3)), "other")])
def test_what_is_no_grid_is_refused(values: NDArray[np.generic], saddle: str) -> None:
    """By name."""
    with pytest.raises(ValueError, match=r"is not one of|are no grid"):
        marching_squares(values, saddle=saddle)


def test_curves_are_counted() -> None:
    """Closed and open ones, on noise against a search from segment to segment."""
    for values in noises():
        edges = trace(values).edges
        following = {begin: segment for segment, begin in enumerate(edges[:, 0])}
        curve, closed = joined(edges)
        seen: set[int] = set()
        starts = set(edges[:, 0].tolist()) - set(edges[:, 1].tolist())
        pieces = 0
        for first in [following[start] for start in sorted(starts)] + list(range(len(edges))):
            piece, here = [], first
            while here is not None and here not in seen:
                seen.add(here)
                piece.append(here)
                here = following.get(edges[here, 1])
            pieces += bool(piece)
            assert len({curve[segment] for segment in piece}) <= 1
            assert not piece or closed[piece].all() == (here is not None)
        assert pieces == curve_count(edges)


def test_a_million_samples_in_no_time() -> None:
    """A smooth function: 50 ms, here three times that for a busy machine."""
    x = np.linspace(0, 1, 1000)
    values = np.sin(30 * x)[:, None] * np.sin(30 * x)
    best = min(_seconds(values) for _ in range(5))
    assert best < 0.15


def _seconds(values: Numbers) -> float:
    start = time.perf_counter()
    marching_squares(values)
    return time.perf_counter() - start


# Closed forms, and the truth that the error is measured by

def test_a_circle_is_approached_with_the_square_of_the_cell() -> None:
    """Length and distance: a fourth for each halving; never more than h^2 / (2 R) off."""
    grids = [sample(circle, n) for n in (16, 32, 64, 128)]
    for grid in grids:
        assert grid.curves == 1 and joined(grid.tracing.edges)[1].all()
        assert grid.max_distance <= 1.0 / grid.resolution**2 / (2 * CIRCLE)
    lengths = np.array([abs(grid.tracing.length - 2 * np.pi * CIRCLE) for grid in grids])
    off = np.array([grid.max_distance for grid in grids])
    for errors in (lengths, off):
        assert np.log2(errors[0] / errors[-1]) / 3 > 1.8
    rungs = errors_by_resolution(circle, 0.0, "decider", "cut")
    assert rungs[-1] < 2e-5 and rungs[0] > 0.02


def test_distances_to_known_curves() -> None:
    """A circle, a line, and a square with creases, from up to a tenth away."""
    chance = np.random.default_rng(4)
    points = chance.uniform(0.1, 0.9, (400, 2))
    truth = np.abs(circle(points))
    near = truth < 0.1
    assert distances(circle, points[near], 0.2) == pytest.approx(truth[near], abs=1e-9)
    line = distances(lambda p: 1e12 * (p[:, 0] - 0.5), points, 1.0)
    assert line == pytest.approx(np.abs(points[:, 0] - 0.5), abs=1e-6)

    def box(p: Numbers) -> Numbers:
        return np.asarray(np.abs(p - 0.5).max(axis=1) - 0.3)

    inside = points[np.abs(box(points)) < 0.1]
    reached = distances(box, inside, 0.3)
    apart = np.abs(inside - 0.5) - 0.3
    to_box = np.where((apart > 0).all(axis=1), np.hypot(*apart.T), np.abs(apart.max(axis=1)))
    assert (reached >= to_box - 1e-9).all() and np.quantile(reached / to_box, 0.99) < 1.5
    with np.errstate(divide="ignore"):
        assert np.isnan(distances(lambda p: 1.0 / (p[:, 0] - 0.52), points, 0.1)).all()


@pytest.mark.parametrize(("function", "jumps"), [
    (lambda x: 1 / (x - 0.52), True), (lambda x: 1 / (x - 0.52) ** 3 + 2, True),
    (lambda x: x - 0.52 + 1e-5 / (x - 0.52), True),     # comes near to zero before it leaves
    (lambda x: np.sign(x - 0.52) + x / 2, True),
    (lambda x: np.where(x > 0.52, np.nan, x - 1) * -1 + (x < 0.3) * -9, True),
    (lambda x: x - 0.52, False), (lambda x: np.cbrt(x - 0.52), False), (lambda x: np.tanh(1e4 * (x - 0.52)), False),
    (lambda x: (x - 0.52) ** 3, False), (lambda x: 1e30 * (x - 0.52), False)])
def test_jumps_are_told_from_crossings(function: object, jumps: bool) -> None:
    """Poles, steps and places without a value, but not what is merely steep."""
    start, end = np.array([[0.0, 0.0]]), np.array([[1.0, 0.0]])
    with np.errstate(all="ignore"):
        assert jumping(lambda p: function(p[:, 0]), start, end).tolist() == [jumps]     # type: ignore[operator]


def test_a_cell_on_the_blackboard() -> None:
    """What is worked out for one cell is what the grid gets."""
    chance = np.random.default_rng(6)
    for _ in range(200):
        values = chance.normal(size=(2, 2))
        cell = SquareCell(tuple(values.T.ravel().tolist()))
        assert cell.case == cell_cases(values)[0, 0]
        for saddle in SADDLES:
            expected = marching_squares(values, saddle=saddle)
            assert np.array_equal(cell.segments(cell.answer(saddle)), expected)
        for crossing in cell.crossings:
            assert crossing.t == pytest.approx(crossing.A / (crossing.A - crossing.B))
