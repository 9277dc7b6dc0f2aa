"""Isosurfaces: from a function to a mesh with normals, from a typed formula to its picture, and memory."""

from __future__ import annotations

import random
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

import viewer
from tests.benchmarks.contest import ROOT
from tests.benchmarks.peers import isosurfaces as peers
from tests.benchmarks.report import Row, Section, at_most, in_time_of
from tests.benchmarks.tangle import REACH, Ours, by_hand
from viewer.engine.stage import Stage
from viewer.kit.marching import marching_cubes

CUBES, TETRAHEDRA = "Demoscope: cubes", "Demoscope: tetrahedra"
FLYING_EDGES, SCIKIT_IMAGE, PYMCUBES = "numexpr + FlyingEdges", "NumPy + scikit-image", "NumPy + PyMCubes, no normals"
SEPARATED = "NumPy along three lines + scikit-image"
MOST_SECONDS = {64: 6e-3}
MOST_FLYING_EDGES = {128: 1.5, 256: 1.2}        # times as long as these take
MOST_SCIKIT_IMAGE = 0.5
MOST_UNTIL_DRAWN = 60e-3
MOST_KIT = 2.0
MOST_MEMORY = 600.0
KIT_CELLS = 128
LARGE = 256                                     # fewer rounds do, and not everybody takes part
Ways = Mapping[str, Callable[[], Callable[[], Any]]]


def sections(rounds: int) -> list[Section]:
    """All of it."""
    large_rounds = -(-rounds // 2)
    return [meshes(64, 3 * rounds), meshes(128, rounds), meshes(LARGE, large_rounds),
            new_formulas(rounds), kit(rounds), memory()]


def meshes(cells: int, rounds: int) -> Section:
    """From the function to a mesh with normals, ready to be drawn."""
    ways: dict[str, Callable[[], Callable[[], Any]]] = {
        TETRAHEDRA: lambda: Ours(cells, "tetrahedra"), CUBES: lambda: Ours(cells, "cubes"),
        FLYING_EDGES: lambda: peers.flying_edges(cells), SCIKIT_IMAGE: lambda: peers.scikit_image(cells)}
    if cells < LARGE:
        ways[SEPARATED] = lambda: peers.scikit_image(cells, along_lines=True)
        ways[PYMCUBES] = lambda: peers.pymcubes(cells)
    rows = in_turn(ways, rounds)
    ours, flying, scikit = rows[CUBES], rows[FLYING_EDGES], rows[SCIKIT_IMAGE]
    if ours.times:
        targets = [at_most(ours, MOST_SECONDS[cells])] if cells in MOST_SECONDS else []
        if cells in MOST_FLYING_EDGES:
            targets.append(in_time_of(ours, flying, MOST_FLYING_EDGES[cells], "FlyingEdges"))
        ours.target = ", ".join([*targets, in_time_of(ours, scikit, MOST_SCIKIT_IMAGE, "scikit-image")])
    return Section(f"A function to a mesh with normals, {cells}^3 cells", list(rows.values()))


def new_formulas(rounds: int) -> Section:
    """From a formula that neither we nor the driver's cache on disk has seen to its picture, and where it goes."""
    whole = Row("Demoscope: a new formula, to its picture", ours=True)
    parts = [Row(f"  {name}") for name in (
        "of this, read and made ready", "samples", "mesh", "picture")]
    chance = random.Random(time.time_ns())
    with viewer.headless("marching_cubes", params={"resolution": 64, "extent": REACH}) as stage:
        for turn in range(rounds + 1):
            text = f"x^4 - 5*x^2 + y^4 - {chance.uniform(4.9, 5.1)!r}*y^2 + z^4 - 5*z^2 + 11.8"
            changed, drawn = seconds(lambda text=text: stage.set(formula=text)), seconds(lambda: drawn_out(stage))
            samples, mesh = 1e-3 * stage.scene.samples.evaluate_ms, 1e-3 * stage.scene.surface.extract_ms
            figures = changed + drawn, changed - samples - mesh, samples, mesh, drawn
            for row, figure in zip((whole, *parts), figures, strict=True):
                row.times = [*row.times, *([figure] if turn else [])]
    whole.target = at_most(whole, MOST_UNTIL_DRAWN)
    return Section("A formula typed by the user, drawn at 640x360 with four samples, 64^3 cells", [whole, *parts])


def kit(rounds: int) -> Section:
    """The same function's samples given: what a script without a GPU has."""
    z, y, x = peers.coordinates(KIT_CELLS, along_lines=True)
    values = by_hand(x, y, z)
    ways: dict[str, Callable[[], Callable[[], Any]]] = {
        "kit: cubes": lambda: lambda: marching_cubes(values),
        "kit: tetrahedra": lambda: lambda: marching_cubes(values, method="tetrahedra"),
        "kit: trilinear": lambda: lambda: marching_cubes(values, topology="trilinear"),
        "scikit-image, with normals": lambda: _scikit_image(values)}
    rows = in_turn(ways, rounds)
    cubes, *others, scikit = rows.values()
    cubes.target = in_time_of(cubes, scikit, MOST_KIT, "scikit-image")
    return Section(f"Samples to a mesh in NumPy, {KIT_CELLS}^3 cells, float32", [*others, cubes, scikit])


def memory() -> Section:
    """At the peak, above what the process had with everything imported and the GL context open."""
    rows = []
    for what, name in (("mesh", CUBES), ("scene", "Demoscope: the scene and one picture")):
        command = [sys.executable, "-m", "tests.benchmarks.peers.isosurface_memory", what, str(LARGE)]
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
        if done.returncode:
            rows.append(Row(name, failure=done.stderr.strip().splitlines()[-1], ours=True))
            continue
        taken, peak = map(float, done.stdout.split())
        verdict = "met" if peak <= MOST_MEMORY else "MISSED"
        rows.append(Row(name, [taken], f"{peak:.0f} MiB", f"at most {MOST_MEMORY:.0f} MiB: {verdict}", ours=True))
    return Section(f"Memory at the peak, {LARGE}^3 cells, a process's first surface, compiling included", rows)


def in_turn(ways: Ways, rounds: int) -> dict[str, Row]:
    """Each once to warm up, then ``rounds`` times in turn. One that cannot start says why."""
    rows = {name: Row(name, ours=name.startswith(("Demoscope", "kit"))) for name in ways}
    started: dict[str, Callable[[], Any]] = {}
    for name, start in ways.items():
        try:
            started[name] = start()
        except ImportError as error:
            rows[name].failure = str(error)
    try:
        for turn in range(rounds + 1):
            for name, run in started.items():
                taken = seconds(run)
                rows[name].times = [*rows[name].times, *([taken] if turn else [])]
    finally:
        for ours in started.values():
            if isinstance(ours, Ours):
                ours.release()
    return rows


def drawn_out(stage: Stage) -> None:
    """A frame drawn, and the GPU waited for."""
    stage.render()
    stage.context.finish()


def seconds(work: Callable[[], object]) -> float:
    """How long one call takes."""
    begun = time.perf_counter()
    work()
    return time.perf_counter() - begun


def _scikit_image(values: np.ndarray) -> Callable[[], Any]:
    from skimage.measure import marching_cubes as theirs

    return lambda: theirs(values, 0.0)
