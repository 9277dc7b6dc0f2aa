"""A school of fish: Reynolds' three rules, a tank to stay in, and what swimming does to each body.

Craig Reynolds, "Flocks, Herds, and Schools: A Distributed Behavioral Model", SIGGRAPH 1987: a fish keeps away from
neighbours that are too near, swims as they do, and seeks their middle. This is the plain form in double precision,
each fish with each other, against which ``shaders/fish/flock.frag`` is tested. Metres, seconds, radians; y is up.

The state of n fish is an array (n, 12): place x, y, z, phase of the tail's beat; velocity x, y, z, length of the body;
bend of the body, bank, both positive to the left, a random phase of the fish's own will, and room for the
number of a cell.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Numbers: TypeAlias = NDArray[np.float64]
Pairs: TypeAlias = NDArray[np.intp]

PLACE, PHASE, VELOCITY, SIZE, BEND, BANK, WILL, CELL = slice(0, 3), 3, slice(4, 7), 7, 8, 9, 10, 11
COLUMNS = 12


@dataclass(frozen=True)
class SchoolRules:
    """The numbers that a school goes by.

    ``separation``, ``alignment`` and ``cohesion`` weigh Reynolds' rules. A fish sees others within ``perception`` and
    wants none within ``personal_space``. It swims at ``slowest`` to ``fastest`` m/s, accelerates by at most ``agility``
    m/s² and climbs by at most ``steepest`` radians. ``half_axes`` are those of the ellipsoid that nobody leaves.
    ``turn`` is a bend, for each body length, that everyone swims along. ``tail_beat_hz`` is the beat of a fish of
    size 1 at cruising speed.
    """

    half_axes: tuple[float, float, float] = (9.0, 3.6, 6.6)
    separation: float = 1.0
    alignment: float = 1.0
    cohesion: float = 1.0
    perception: float = 1.3
    personal_space: float = 1.17
    wander: float = 0.3
    slowest: float = 0.8
    fastest: float = 1.8
    agility: float = 3.0
    steepest: float = math.radians(30.0)
    most_bank: float = math.radians(25.0)
    turn: float = 0.0
    tail_beat_hz: float = 1.8

    @property
    def cruising(self) -> float:
        """The speed that a fish tends to, in m/s."""
        return 0.5 * (self.slowest + self.fastest)


# How strongly each rule acts where its weight is 1, and how fast what follows from it comes about.
KEEPING_AWAY = 8.0          # m/s², from one neighbour at no distance
LIKENESS = 3.0              # 1/s: of the difference in velocity
SEEKING = 3.0               # m/s², towards a middle at the edge of what is seen
KEEPING_PACE = 1.0          # 1/s: of the difference to the cruising speed
LEVELLING = 0.5             # 1/s: of the speed up or down
FORESIGHT = 1.0             # s: so far ahead a fish looks for the wall
WALL_BEGINS = 0.8           # of the way from the tank's middle to its wall, there fish begin to turn
WALL_TURNING = 3.0          # 1/s: of the difference to a velocity along the wall
INWARD = 0.35               # how much of that velocity leads away from the wall
MOST_BEND = 1.2             # radians from tail to nose
BENDING = 4.0               # 1/s: how fast the body follows its turn
BANKING = 3.0               # 1/s: how fast it leans
FULL_BANK_RATE = 1.0        # radians a second, the turn in which a fish leans as far as it does


def school_step(state: ArrayLike, rules: SchoolRules, seconds: float, dt: float, pairs: Pairs | None = None) -> Numbers:
    """The state (n, 12) after ``dt`` seconds, from that at ``seconds``.

    ``pairs`` (m, 2) names, once each, all pairs of fish within the perception of one another; without it everybody
    looks at everybody.
    """
    state = np.asarray(state, np.float64)
    wish = _social(state, rules, near_pairs(state[:, PLACE], rules.perception) if pairs is None else pairs)
    wish += _own(state, rules, seconds)
    after = state.copy()
    after[:, VELOCITY] = _steered(state, _limited(wish, rules.agility), rules, dt)
    after[:, PLACE] = state[:, PLACE] + dt * after[:, VELOCITY]
    _keep_inside(after, rules)
    _follow_with_body(after, state[:, VELOCITY], rules, dt)
    return after


def near_pairs(places: Numbers, distance: float) -> Pairs:
    """All pairs (m, 2) of ``places`` (n, 3) that are nearer than ``distance``, found by comparing each with each."""
    found = [np.stack([np.full(len(near), first), near], axis=1)
             for first in range(len(places) - 1)
             if len(near := first + 1 + np.flatnonzero(
                 ((places[first + 1:] - places[first]) ** 2).sum(axis=1) < distance**2))]
    return np.concatenate(found) if found else np.empty((0, 2), np.intp)


def polarisation(velocities: ArrayLike) -> float:
    """The length of the mean heading of velocities (n, 3): 1 where all swim the same way, near 0 where none do."""
    velocities = np.asarray(velocities, np.float64)
    headings = velocities / np.linalg.norm(velocities, axis=1, keepdims=True)
    return float(np.linalg.norm(headings.mean(axis=0)))


def _social(state: Numbers, rules: SchoolRules, pairs: Pairs) -> Numbers:
    """The accelerations (n, 3) that the three rules ask for."""
    first, second = pairs.T
    way = state[second, PLACE] - state[first, PLACE]
    distance = np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-6)
    attention = np.maximum(0.0, 1.0 - (distance / rules.perception) ** 2)
    crowding = np.maximum(0.0, 1.0 - distance / rules.personal_space) ** 2
    difference = state[second, VELOCITY] - state[first, VELOCITY]
    keep_away, seek, alike = (_gathered(pairs, each, -each, len(state)) for each in (
        -crowding / distance * way, attention * way, attention * difference))
    total = _gathered(pairs, attention, attention, len(state))
    share = 1.0 / np.maximum(total, 1.0)        # whoever sees next to nobody is not drawn with full force
    return np.asarray(rules.separation * KEEPING_AWAY * keep_away + rules.alignment * LIKENESS * share * alike
                      + rules.cohesion * SEEKING / rules.perception * share * seek)


def _gathered(pairs: Pairs, to_first: Numbers, to_second: Numbers, count: int) -> Numbers:
    """What pairs (m, 2) give to each of them, (m, c) both, summed for each of ``count`` fish: (count, c)."""
    who, what = pairs.T.ravel(), np.concatenate([to_first, to_second])
    return np.stack([np.bincount(who, column, count) for column in what.T], axis=1)


def _own(state: Numbers, rules: SchoolRules, seconds: float) -> Numbers:
    """What a fish wants by itself: to wander, to keep its pace, to swim level, and the bend that all swim along."""
    velocity, will = state[:, VELOCITY], state[:, WILL]
    speed, left = np.linalg.norm(velocity, axis=1), _left(velocity)
    sideways = rules.wander * 0.5 * (np.sin(0.7 * seconds + will) + np.sin(1.3 * seconds + 3.0 * will))
    sideways += rules.turn * speed**2 / state[:, SIZE]
    wish = sideways[:, None] * left + (KEEPING_PACE * (rules.cruising - speed) / speed)[:, None] * velocity
    wish[:, 1] += rules.wander * 0.3 * np.sin(0.9 * seconds + 5.0 * will) - LEVELLING * velocity[:, 1]
    return np.asarray(wish)


def _steered(state: Numbers, wish: Numbers, rules: SchoolRules, dt: float) -> Numbers:
    """Velocities (n, 3) after a step: as wished, but along the wall for whoever is about to meet it."""
    velocity, half_axes = state[:, VELOCITY], np.array(rules.half_axes)
    speed = np.linalg.norm(velocity, axis=1, keepdims=True)
    ahead = (state[:, PLACE] + FORESIGHT * velocity) / half_axes
    reach = np.maximum(np.linalg.norm(ahead, axis=1, keepdims=True), 1e-6)
    outward = _unit(ahead / half_axes)
    urgency = np.clip((reach - WALL_BEGINS) / (1.0 - WALL_BEGINS), 0.0, 1.0)
    # Whoever swims straight at the wall turns to the side that it leans to anyway, which is its left for half of all.
    along = velocity - (velocity * outward).sum(axis=1, keepdims=True) * outward
    along += 0.1 * speed * np.sign(np.sin(state[:, WILL]))[:, None] * _left(velocity)
    turning = WALL_TURNING * (speed * _unit(_unit(along) - INWARD * outward) - velocity)
    changed = velocity + dt * ((1.0 - urgency) * wish + urgency * _limited(turning, 2.0 * rules.agility))
    level = np.maximum(np.hypot(changed[:, 0], changed[:, 2]), 1e-4)
    changed[:, 1] = np.clip(changed[:, 1], -math.tan(rules.steepest) * level, math.tan(rules.steepest) * level)
    now = np.linalg.norm(changed, axis=1, keepdims=True)
    return np.asarray(changed * np.clip(now, rules.slowest, rules.fastest) / now)


def _keep_inside(after: Numbers, rules: SchoolRules) -> None:
    """Whoever has left the ellipsoid all the same is put onto its wall."""
    reach = np.linalg.norm(after[:, PLACE] / np.array(rules.half_axes), axis=1, keepdims=True)
    after[:, PLACE] /= np.maximum(reach, 1.0)


def _follow_with_body(after: Numbers, before: Numbers, rules: SchoolRules, dt: float) -> None:
    """Beat, bend and bank, from the velocities ``before`` to those after the step."""
    velocity, size = after[:, VELOCITY], after[:, SIZE]
    speed = np.linalg.norm(velocity, axis=1)
    turned = np.arctan2(before[:, 2] * velocity[:, 0] - before[:, 0] * velocity[:, 2],
                        before[:, 0] * velocity[:, 0] + before[:, 2] * velocity[:, 2]) / dt
    bend = np.clip(turned * size / speed, -MOST_BEND, MOST_BEND)
    bank = rules.most_bank * np.clip(turned / FULL_BANK_RATE, -1.0, 1.0)
    after[:, BEND] += (1.0 - math.exp(-BENDING * dt)) * (bend - after[:, BEND])
    after[:, BANK] += (1.0 - math.exp(-BANKING * dt)) * (bank - after[:, BANK])
    beat = rules.tail_beat_hz * speed / (rules.cruising * size)
    after[:, PHASE] = (after[:, PHASE] + 2.0 * math.pi * beat * dt) % (2.0 * math.pi)


def _left(velocity: Numbers) -> Numbers:
    """Unit vectors to the left of velocities (n, 3), level."""
    return _unit(np.stack([velocity[:, 2], np.zeros(len(velocity)), -velocity[:, 0]], axis=1))


def _unit(vectors: Numbers) -> Numbers:
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-9))


def _limited(vectors: Numbers, most: float) -> Numbers:
    """Vectors (n, 3), those that are longer than ``most`` cut to that length."""
    length = np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-9)
    return np.asarray(vectors * np.minimum(1.0, most / length))
