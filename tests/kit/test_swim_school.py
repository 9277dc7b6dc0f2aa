"""The rules of a school in NumPy, and the grid of cells by which neighbours are found."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from viewer.kit.swim_cells import MOST_CELLS, PARTS, cell_grid
from viewer.kit.swim_school import (
    BANK,
    BEND,
    COLUMNS,
    PHASE,
    PLACE,
    SIZE,
    VELOCITY,
    WILL,
    SchoolRules,
    near_pairs,
    polarisation,
    school_step,
)

Numbers = NDArray[np.float64]
DT = 1.0 / 60.0
OPEN = SchoolRules(half_axes=(1e3, 1e3, 1e3), wander=0.0)     # water without walls, fish without wills
ALONE = replace(OPEN, separation=0.0, alignment=0.0, cohesion=0.0)


def school(places: list[list[float]], velocities: list[list[float]]) -> Numbers:
    """Fish of length 1 at these places with these velocities."""
    state = np.zeros((len(places), COLUMNS))
    state[:, PLACE], state[:, VELOCITY], state[:, SIZE] = places, velocities, 1.0
    return state


def played(state: Numbers, rules: SchoolRules, seconds: float) -> Numbers:
    """The school after so many seconds."""
    for step in range(round(seconds / DT)):
        state = school_step(state, rules, step * DT, DT)
    return state


def test_pairs_are_those_that_a_tree_finds() -> None:
    """Each once, and none in a school of one or none."""
    places = np.random.default_rng(1).uniform(-3.0, 3.0, (400, 3))
    found = {tuple(pair) for pair in np.sort(near_pairs(places, 1.2), axis=1).tolist()}
    assert found == cKDTree(places).query_pairs(1.2)
    assert near_pairs(places[:1], 1.0).shape == near_pairs(places[:0], 1.0).shape == (0, 2)


def test_polarisation_is_that_of_headings() -> None:
    """1 for all the same way, whatever the speed; 0 for two opposite ones."""
    assert polarisation([[1.0, 0.0, 0.0], [3.0, 0.0, 0.0]]) == pytest.approx(1.0)
    assert polarisation([[1.0, 0.0, 0.0], [-3.0, 0.0, 0.0]]) == pytest.approx(0.0)
    assert polarisation([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]) == pytest.approx(np.sqrt(0.5))


def test_a_fish_alone_swims_straight_on_at_its_pace() -> None:
    """Slower or faster at first, level in the end."""
    for start in ([0.8, 0.0, 0.0], [1.5, 0.3, 0.0]):
        after = played(school([[0.0, 0.0, 0.0]], [start]), ALONE, 12.0)
        np.testing.assert_allclose(after[0, VELOCITY], [ALONE.cruising, 0.0, 0.0], atol=0.01)
        assert abs(after[0, BEND]) < 1e-6 and abs(after[0, BANK]) < 1e-6


def test_the_tail_beats_faster_the_faster_and_the_shorter_a_fish_is() -> None:
    """In proportion; a fish of length 1 at cruising speed beats as often as the parameter says."""
    rules = replace(ALONE, tail_beat_hz=2.0)
    state = school([[0.0, 0.0, 0.0], [50.0, 0.0, 0.0]], [[rules.cruising, 0.0, 0.0]] * 2)
    state[1, SIZE] = 0.5
    np.testing.assert_allclose(school_step(state, rules, 0.0, DT)[:, PHASE], 2.0 * np.pi * DT * np.array([2.0, 4.0]))


def test_two_that_are_too_near_part() -> None:
    """And two that only see each other come nearer."""
    for rule, distance, wider in (({"separation": 1.0}, 0.4, True), ({"cohesion": 1.0, "perception": 2.0}, 1.3, False)):
        state = school([[0.0, 0.0, 0.0], [0.0, 0.0, distance]], [[1.3, 0.0, 0.0]] * 2)
        after = played(state, replace(ALONE, **rule), 0.5)
        apart = float(np.linalg.norm(after[1, PLACE] - after[0, PLACE]))
        assert (apart > distance + 0.05) if wider else (apart < distance - 0.002)


def test_neighbours_come_to_swim_alike() -> None:
    """Two headings at right angles become one, the mean."""
    state = school([[0.0, 0.0, 0.0], [0.3, 0.0, 0.3]], [[1.3, 0.0, 0.0], [0.0, 0.0, 1.3]])
    after = played(state, replace(ALONE, alignment=4.0, perception=5.0), 3.0)
    assert polarisation(state[:, VELOCITY]) < 0.75
    assert polarisation(after[:, VELOCITY]) > 0.999
    mean = after[:, VELOCITY].mean(axis=0)
    np.testing.assert_allclose(mean / np.linalg.norm(mean), np.array([1.0, 0.0, 1.0]) / np.sqrt(2.0), atol=0.02)


def test_what_rules_ask_for_adds_up_to_nothing() -> None:
    """What one neighbour does to another it does back: apart from the limits, a school cannot pull itself along."""
    random = np.random.default_rng(4)
    velocities = random.normal(size=(6, 3)) * 0.1 + [1.3, 0.0, 0.0]
    state = school(random.uniform(-1.0, 1.0, (6, 3)).tolist(), velocities.tolist())
    rules = replace(ALONE, agility=1e6, steepest=1.5, slowest=0.01, fastest=2.59)
    alone, together = (school_step(state, replace(rules, separation=weight), 0.0, DT)[:, VELOCITY]
                       for weight in (0.0, 0.2))
    assert np.abs(together - alone).max() > 1e-3
    np.testing.assert_allclose((together - alone).sum(axis=0), 0.0, atol=1e-12)


def test_a_turn_is_an_arc_that_the_body_bends_along() -> None:
    """Of a radius of one over the bend for each body length, to the left: seen from above, counter-clockwise."""
    rules = replace(ALONE, turn=0.5)
    state = school([[0.0, 0.0, 0.0]], [[1.3, 0.0, 0.0]])
    track = []
    for step in range(900):
        state = school_step(state, rules, step * DT, DT)
        track.append(state[0, PLACE])
    line = np.array(track)
    assert np.ptp(line[:, 2]) == pytest.approx(2.0 * 2.0, rel=0.02)
    assert line[60, 2] < 0.0        # to the left
    assert state[0, BEND] == pytest.approx(0.5, rel=0.02)
    assert state[0, BANK] > 0.0


@pytest.mark.parametrize("heading", [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.9, 0.43, 0.0], [-0.6, -0.2, 0.77]])
def test_a_fish_turns_before_the_wall(heading: list[float]) -> None:
    """Even straight at it, and it bends no more than it can."""
    rules = replace(ALONE, half_axes=(6.0, 3.0, 5.0))
    state, farthest = school([[0.0, 0.0, 0.0]], [heading]), 0.0
    state[0, WILL] = 1.0
    for step in range(1200):
        state = school_step(state, rules, step * DT, DT)
        farthest = max(farthest, float(np.linalg.norm(state[0, PLACE] / rules.half_axes)))
    assert 0.6 < farthest < 1.0


def test_nobody_swims_upside_down() -> None:
    """Or steeper than allowed, however they are chased up."""
    rules = SchoolRules(half_axes=(4.0, 4.0, 4.0), separation=4.0, steepest=np.radians(35.0))
    random = np.random.default_rng(5)
    state = school(random.uniform(-1.0, 1.0, (60, 3)).tolist(), random.normal(size=(60, 3)).tolist())
    for step in range(240):
        state = school_step(state, rules, step * DT, DT)
        climb = np.arctan2(np.abs(state[:, 5]), np.hypot(state[:, 4], state[:, 6]))
        assert climb.max() <= rules.steepest + 1e-9
        assert np.abs(state[:, BANK]).max() <= rules.most_bank + 1e-9


# Cells


@pytest.mark.parametrize("sight", [0.3, 1.5, 40.0])
@pytest.mark.parametrize("half_axes", [(4.8, 2.0, 3.3), (30.0, 12.0, 20.0), (1.0, 100.0, 1.0)])
def test_everybody_in_sight_is_in_a_run(half_axes: tuple[float, float, float], sight: float) -> None:
    """The nine runs around a fish hold whoever it sees, and of all not many more."""
    random = np.random.default_rng(6)
    places = (random.uniform(-1.0, 1.0, (500, 3)) * half_axes).astype(np.float32)
    grid = cell_grid(half_axes, sight)
    order, cells = grid.sort(places)
    runs = grid.runs(cells).astype(int)
    assert grid.count <= MOST_CELLS and (np.diff(cells) >= 0).all()
    ordered = places[order]
    for fish, cell in enumerate(cells.tolist()):
        rows = [cell + grid.size[0] * (y + grid.size[1] * z) for z in (-1, 0, 1) for y in (-1, 0, 1)]
        near = np.concatenate([np.arange(*runs[row]) for row in rows])
        seen = np.flatnonzero(np.linalg.norm(ordered - ordered[fish], axis=1) < sight)
        assert len(np.unique(near)) == len(near)
        assert np.isin(seen, near).all()
        assert (np.abs(ordered[near] - ordered[fish]).max(axis=0) <= 2.01 * grid.cell_size).all()


def test_who_lies_in_the_same_cell_keeps_its_order() -> None:
    """So that sums do not depend on how they are sorted."""
    order, _ = cell_grid((5.0, 5.0, 5.0), 20.0).sort(np.zeros((300, 3), np.float32))
    np.testing.assert_array_equal(order, np.arange(300))


def test_who_is_outside_counts_to_the_nearest_cell() -> None:
    """Where it is asked for nobody, and nothing breaks."""
    grid = cell_grid((2.0, 2.0, 2.0), 1.0)
    _, cells = grid.sort(np.array([[-9.0, 0.1, 0.1], [9.0, 0.1, 0.1]], np.float32))
    along = cells % grid.size[0]
    np.testing.assert_array_equal(along, [PARTS, grid.size[0] - PARTS - 1])
