"""Taichi on the CPU: one kernel that moves each particle and sends the dead off anew."""

from __future__ import annotations

import math
from collections.abc import Callable

import taichi as ti

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
    STEADY,
    STEP,
)

LOWEST = math.cos(math.radians(SPREAD))     # of a direction within the cone


@ti.data_oriented
class Shower:
    """``number`` particles: where they are, how fast, and how many seconds each has left."""

    def __init__(self, number: int) -> None:
        self.place, self.velocity = ti.Vector.field(3, ti.f32, number), ti.Vector.field(3, ti.f32, number)
        self.left = ti.field(ti.f32, number)

    @ti.kernel
    def begin(self):
        """Everybody's end comes at another time."""
        for i in self.left:
            self.left[i] = ti.random() * LIFETIME[1]

    @ti.kernel
    def step(self):
        """The explicit step of Euler's; who is inside something is put onto its surface."""
        for i in self.left:
            x, u, left = self.place[i], self.velocity[i], self.left[i] - STEP
            if left <= 0:
                around, up = ti.random() * 2.0 * math.pi, LOWEST + (1.0 - LOWEST) * ti.random()
                across = ti.sqrt(1.0 - up * up)
                speed = SPEED[0] + (SPEED[1] - SPEED[0]) * ti.random()
                x = ti.Vector([0.0, 0.0, 0.0])
                u = speed * ti.Vector([across * ti.cos(around), up, across * ti.sin(around)])
                left = LIFETIME[0] + (LIFETIME[1] - LIFETIME[0]) * ti.random()
            else:
                u += STEP * (ti.Vector([0.0, -GRAVITY, 0.0]) - DRAG * u)
                x += STEP * u
                if x[1] < 0:
                    x[1] = 0.0
                    if u[1] < 0:
                        along = ti.Vector([u[0], 0.0, u[2]])
                        kept = ti.max(0.0, 1.0 + FRICTION * (1.0 + RESTITUTION) * u[1] / (along.norm() + 1e-9))
                        u = along * kept - ti.Vector([0.0, RESTITUTION * u[1], 0.0])
                away = x - ti.Vector([0.0, BALL_HEIGHT, 0.0])
                distance = away.norm()
                if distance < BALL_RADIUS:
                    normal = away / distance
                    x = ti.Vector([0.0, BALL_HEIGHT, 0.0]) + BALL_RADIUS * normal
                    inward = u.dot(normal)
                    if inward < 0:
                        along = u - inward * normal
                        kept = ti.max(0.0, 1.0 + FRICTION * (1.0 + RESTITUTION) * inward / (along.norm() + 1e-9))
                        u = along * kept - RESTITUTION * inward * normal
            self.place[i], self.velocity[i], self.left[i] = x, u, left


def frames(number: str) -> Callable[[int], object]:
    """Steps of ``number`` particles, in a steady state."""
    ti.init(arch=ti.cpu, log_level=ti.ERROR)
    shower = Shower(int(number))

    def frame(_: int) -> None:
        shower.step()
        ti.sync()

    shower.begin()
    for start in range(STEADY):
        frame(start)
    return frame
