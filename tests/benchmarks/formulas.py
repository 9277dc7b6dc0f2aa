"""Formulas: from typing to a new picture, and how fast NumPy computes one."""

from __future__ import annotations

import random
import time
from collections.abc import Callable

import numpy as np

import viewer
from tests.benchmarks.report import Row, Section
from viewer.kit.formula import glsl_vector, parse

RIPPLE = "amplitude*cos(frequency*x)*exp(-y*y) + 0.1*smoothstep(0, 1, abs(z))"
GYROID = "sin(6*x)*cos(6*y) + sin(6*y)*cos(6*z) + sin(6*z)*cos(6*x)"
GRID = 128


def sections(rounds: int) -> list[Section]:
    """Compilation, evaluation, and the whole way to the screen."""
    compiling = Row("Demoscope: parse, differentiate, write GLSL", repeated(compiled, 20 * rounds), ours=True)
    screen = Row("Demoscope: a new formula, to its picture", until_on_screen(rounds), ours=True)
    return [Section("A formula typed by the user", [compiling]),
            Section("The same, drawn at 640x360 with four samples", [screen]),
            Section(f"A gyroid on {GRID}^3 points, float32", evaluations(rounds))]


def compiled() -> None:
    """All that happens to a formula before the driver sees it."""
    formula = parse(RIPPLE)
    formula.glsl("height")
    gradient = formula.gradient()
    glsl_vector("height_gradient", [gradient[name] for name in "xyz"], list(formula.variables))


def until_on_screen(rounds: int) -> list[float]:
    """Seconds from a formula that neither we nor the driver's cache has seen to its picture."""
    chance = random.Random(time.time_ns())
    times = []
    with viewer.headless("rippling_sphere") as stage:
        stage.pixels()
        for _ in range(rounds):
            text = f"0.05*cos({chance.uniform(5, 15)!r}*x) + 0.02*sin({chance.uniform(5, 15)!r}*y)"
            start = time.perf_counter()
            stage.set(displacement=text)
            stage.pixels()
            times.append(time.perf_counter() - start)
    return times


def evaluations(rounds: int) -> list[Row]:
    """Ours, plain NumPy and numexpr, in turn."""
    axis = np.linspace(-1.0, 1.0, GRID, dtype=np.float32)
    place = dict(zip("xyz", np.meshgrid(axis, axis, axis, indexing="ij"), strict=True))
    formula = parse(GYROID)
    ways: dict[str, Callable[[], object]] = {
        "Demoscope": lambda: formula.evaluate(**place), "the same written in NumPy": lambda: _by_hand(**place)}
    missing = ""
    try:
        import numexpr
    except ImportError as error:
        missing = str(error)
    else:
        ways["numexpr"] = lambda: numexpr.evaluate(GYROID, local_dict=place)
    rows = {name: Row(name, ours=name == "Demoscope") for name in ways}
    for turn in range(rounds + 1):
        for name, way in ways.items():
            rows[name].times = [*rows[name].times, *(repeated(way, 1) if turn else [])]
    return [*rows.values(), *([Row("numexpr", failure=missing)] if missing else [])]


def repeated(work: Callable[[], object], times: int) -> list[float]:
    """Seconds of each of so many calls."""
    taken = []
    for _ in range(times):
        start = time.perf_counter()
        work()
        taken.append(time.perf_counter() - start)
    return taken


def _by_hand(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
    sin, cos = np.sin, np.cos
    return sin(6 * x) * cos(6 * y) + sin(6 * y) * cos(6 * z) + sin(6 * z) * cos(6 * x)
