"""What a click on cells hits, against walking along the ray from plane to plane."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from viewer.kit.ray import first_cell

Floats = NDArray[np.float64]
SIZE = 6

pytestmark = pytest.mark.filterwarnings("error")


def walked(cells: Floats, origin: Floats, direction: Floats) -> tuple[int, ...] | None:
    """The first cell on the ray: it lies in one cell between any two planes of the grid that it crosses."""
    wanted = {tuple(map(int, cell)) for cell in cells}
    moving = direction != 0.0
    crossed = (np.arange(-1.0, SIZE + 2.0)[:, None] - origin[moving]) / direction[moving]
    along = np.concatenate([[0.0], np.sort(crossed[crossed > 0.0])])
    for middle in 0.5 * (along[1:] + along[:-1]):
        cell = tuple(np.floor(origin + middle * direction).astype(int).tolist())
        if cell in wanted:
            return cell
    return None


def some_cells(chance: np.random.Generator) -> Floats:
    """A few cells of a grid, in any order."""
    every = np.stack(np.meshgrid(*[np.arange(SIZE)] * 3), axis=-1).reshape(-1, 3).astype(np.float64)
    return np.asarray(chance.permutation(every)[:int(chance.integers(1, 60))])


@pytest.mark.parametrize("still", [(), (0,), (1,), (2,), (0, 1), (1, 2), (2, 0)])
@pytest.mark.parametrize("where", ["outside", "among the cells"])
def test_a_ray_hits_the_nearest_cell(where: str, still: tuple[int, ...]) -> None:
    """From outside or from among them; also at right angles to axes."""
    chance = np.random.default_rng(31)
    hits = 0
    for _ in range(150):
        cells, target = some_cells(chance), chance.uniform(0.0, SIZE, 3)
        direction = chance.normal(size=3)
        direction[list(still)] = chance.choice([0.0, -0.0])
        direction /= np.linalg.norm(direction)
        origin = target - (20.0 if where == "outside" else 0.0) * direction
        found = first_cell(cells, origin, direction)
        assert found == walked(cells, origin, direction)
        assert first_cell(cells, origin, 1e-3 * direction) == found
        hits += found is not None
    assert 40 < hits < 140


def test_a_ray_hits_the_cell_it_starts_in() -> None:
    """Whatever its direction; but nothing behind it."""
    cells = np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0]])
    for direction in np.concatenate([np.eye(3), -np.eye(3), [[1.0, 2.0, -3.0]]]):
        assert first_cell(cells, np.array([0.4, 0.5, 0.6]), direction) == (0, 0, 0)
    between = np.array([2.0, 0.5, 0.5])
    assert first_cell(cells, between, np.array([1.0, 0.0, 0.0])) == (3, 0, 0)
    assert first_cell(cells, between, np.array([-1.0, 0.0, 0.0])) == (0, 0, 0)
    assert first_cell(cells, between, np.array([0.0, 1.0, 0.0])) is None
    assert first_cell(cells, np.array([9.0, 0.5, 0.5]), np.array([1.0, 0.0, 0.0])) is None


def test_a_ray_that_starts_on_a_face_does_not_hit_the_cell_behind() -> None:
    """Which it leaves where it starts."""
    cells, face = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]), np.array([1.0, 0.5, 0.5])
    assert first_cell(cells, face, np.array([1.0, 0.0, 0.0])) == (1, 0, 0)
    assert first_cell(cells, face, np.array([-1.0, 0.0, 0.0])) == (0, 0, 0)
    assert first_cell(cells[:1], face, np.array([1.0, 0.1, 0.0])) is None


def test_a_ray_in_the_plane_between_two_cells_hits_either() -> None:
    """It is in both, and in no third."""
    cells = np.array([[2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [1.0, 3.0, 0.0]])
    hit = first_cell(cells, np.array([-1.0, 1.0, 0.5]), np.array([1.0, 0.0, 0.0]))
    assert hit in ((2, 0, 0), (2, 1, 0))


def test_without_cells_nothing_is_hit() -> None:
    """None at all."""
    assert first_cell(np.empty((0, 3)), np.zeros(3), np.ones(3)) is None
