"""Demoscope's own particles: a scene's system, stepped without a picture."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from typing import Any

import viewer
from tests.benchmarks import shower

CALM = {"children_when": "never"}
SHOWER: dict[str, object] = {
    **CALM, "emitter": "point", "emitter_height": 0.0, "emitter_tilt": 0.0, "gravity": shower.GRAVITY,
    "drag": (shower.DRAG, shower.DRAG), "restitution": shower.RESTITUTION, "friction": shower.FRICTION,
    "obstacle": "sphere", "obstacle_y": shower.BALL_HEIGHT, "obstacle_size": shower.BALL_RADIUS,
    "speed": shower.SPEED, "lifetime": shower.LIFETIME, "spread": shower.SPREAD, "ground": True}
VARIANTS: dict[str, dict[str, object]] = {
    "plain": {},
    "turbulence": {"turbulence": 3.0},
    "mesh": {"obstacle": "mesh", "obstacle_scale": 0.5},
    "cascades": {"children_when": "collision", "children": (0.0, 1.0), "children_lifetime": (0.02, 0.1)}}
_open_stages = ExitStack()      # until the process ends


def steady(count: int) -> dict[str, object]:
    """What keeps nearly ``count`` slots taken: 95 of 100."""
    return {**SHOWER, "count": count, "rate": 0.95 * count / (0.5 * sum(shower.LIFETIME))}


def crowd(count: int) -> dict[str, object]:
    """The same at once, for a second or two: all born in a burst, and a quarter of them replaced each second."""
    many = int(0.95 * count)
    return {**SHOWER, "count": count, "burst": many, "rate": 0.25 * many, "lifetime": (0.05, 4.0)}


def frames(kind: str, count: str, *settings: str) -> Callable[[int], object]:
    """Whole updates of ``count`` particles: ``steady``, or one of ``VARIANTS``; ``settings`` are NAME=VALUE."""
    params = steady(int(count)) if kind == "steady" else {**crowd(int(count)), **VARIANTS[kind]}
    params |= dict(setting.split("=", 1) for setting in settings)
    stage = _open_stages.enter_context(viewer.headless("particle_fountain", params=params))
    scene: Any = stage.scene

    def frame(_: int) -> None:
        scene.update(shower.STEP)
        stage.context.finish()

    for number in range(shower.STEADY if kind == "steady" else 4):
        frame(number)
    alive = scene.system.pool.alive_count
    if alive < 0.9 * int(count):
        raise RuntimeError(f"only {alive} of {count} particles are alive")
    return frame
