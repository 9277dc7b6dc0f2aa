"""NumPy, float32, all at once: full passes over arrays, and only whoever is touched or dead picked out."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tests.benchmarks.shower import (
    BALL_HEIGHT,
    BALL_RADIUS,
    DRAG,
    FRICTION,
    GRAVITY,
    LIFETIME,
    RESTITUTION,
    SPEED,
    SPREAD,
    STEP,
)

CENTER = np.array([[0.0], [BALL_HEIGHT], [0.0]], np.float32)
SETTLING = 60       # steps, from ages that are spread as they will be


class Shower:
    """``number`` particles: place and velocity (3, n), seconds left (n,)."""

    def __init__(self, number: int) -> None:
        self.chance = np.random.default_rng(1)
        self.place, self.velocity = np.zeros((3, number), np.float32), np.zeros((3, number), np.float32)
        self.left = self.chance.random(number, np.float32) * np.float32(LIFETIME[1])
        self._moved = np.empty_like(self.place)
        self._start(np.arange(number), keep_left=True)

    def step(self, _: int = 0) -> None:
        """The explicit step of Euler's; who is inside something is put onto its surface."""
        self.left -= np.float32(STEP)
        self.velocity *= np.float32(1.0 - STEP * DRAG)
        self.velocity[1] -= np.float32(STEP * GRAVITY)
        np.multiply(self.velocity, np.float32(STEP), out=self._moved)
        self.place += self._moved
        self._off_ground(np.flatnonzero(self.place[1] < 0.0))
        np.subtract(self.place, CENTER, out=self._moved)
        self._off_ball(np.flatnonzero(np.einsum("in,in->n", self._moved, self._moved) < BALL_RADIUS**2))
        self._start(np.flatnonzero(self.left <= 0.0))

    def _off_ground(self, who: np.ndarray) -> None:
        self.place[1, who] = 0.0
        self._bounce(who, np.tile(np.array([[0.0], [1.0], [0.0]], np.float32), len(who)))

    def _off_ball(self, who: np.ndarray) -> None:
        away = self._moved[:, who]
        normal = away / np.maximum(np.linalg.norm(away, axis=0), np.float32(1e-9))
        self.place[:, who] = CENTER + np.float32(BALL_RADIUS) * normal
        self._bounce(who, normal)

    def _bounce(self, who: np.ndarray, normal: np.ndarray) -> None:
        velocity = self.velocity[:, who]
        inward = np.minimum((velocity * normal).sum(axis=0), 0.0)
        along = velocity - inward * normal
        size = np.linalg.norm(along, axis=0) + np.float32(1e-9)
        kept = np.maximum(0.0, 1.0 + np.float32(FRICTION * (1.0 + RESTITUTION)) * inward / size)
        bounced = along * kept - np.float32(RESTITUTION) * inward * normal
        self.velocity[:, who] = np.where(inward < 0.0, bounced, velocity)

    def _start(self, who: np.ndarray, *, keep_left: bool = False) -> None:
        around, up, speed, left = self.chance.random((4, len(who)), np.float32)
        lowest = np.float32(np.cos(np.radians(SPREAD)))
        up = lowest + (1.0 - lowest) * up
        across = np.sqrt(1.0 - up * up)
        around *= np.float32(2.0 * np.pi)
        self.place[:, who] = 0.0
        self.velocity[:, who] = (SPEED[0] + (SPEED[1] - SPEED[0]) * speed) * np.stack(
            [across * np.cos(around), up, across * np.sin(around)])
        if not keep_left:
            self.left[who] = LIFETIME[0] + (LIFETIME[1] - LIFETIME[0]) * left


def frames(number: str) -> Callable[[int], object]:
    """Steps of ``number`` particles, in a steady state."""
    shower = Shower(int(number))
    for _ in range(SETTLING):
        shower.step()
    return shower.step
