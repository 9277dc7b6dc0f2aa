"""Fish: a step of a school beside a tree of neighbours in NumPy and SciPy, and pictures of it."""

from __future__ import annotations

import math
from typing import Any

import viewer
from tests.benchmarks import shower
from tests.benchmarks.isosurfaces import seconds
from tests.benchmarks.particles import drawn
from tests.benchmarks.report import Row, Section, at_most, faster_than
from viewer.engine.stage import Stage
from viewer.kit.swim_school import PLACE, Pairs, school_step

STEPS = ((1_000, 3e-3), (10_000, 15e-3))        # how many fish, and in what time a step is asked for
PICTURES = ((1, None, ""), (1_000, 0.1, ""), (10_000, 1.0 / 200.0, "200 a second on a GPU"))
PICTURE = (640, 360)
SETTLED = 180           # steps after which a school is as crowded as it stays


def sections(rounds: int) -> list[Section]:
    """All of it."""
    return [stepping(3 * rounds), drawing(rounds)]


def stepping(rounds: int) -> Section:
    """One step of Reynolds' rules, neighbours found and the tail's beat included."""
    rows = []
    for count, most in STEPS:
        ours, tree = Row(f"Demoscope: {count:,} fish", ours=True), Row("  SciPy's k-d tree and NumPy")
        rows += [ours, tree]
        with viewer.headless("fish", params={"school": count}) as stage:
            settle(stage)
            flock: Any = stage.scene.flock      # type: ignore[attr-defined]
            for row, times in zip((ours, tree), steps_in_turn(flock, rounds), strict=True):
                row.times = times
            near = 2.0 * len(tree_pairs(flock)) / count
        ours.extra = f"{near:.0f} neighbours each"
        ours.target = f"{at_most(ours, most)}, {faster_than(ours, tree, 'the tree')}"
    return Section("A step of a school of fish", rows)


def tree_pairs(flock: Any) -> Pairs:
    """Who sees whom, as SciPy's tree finds it."""
    from scipy.spatial import cKDTree

    pairs: Pairs = cKDTree(flock.state[:, PLACE]).query_pairs(flock.rules.perception, output_type="ndarray")
    return pairs


def steps_in_turn(flock: Any, rounds: int) -> tuple[list[float], list[float]]:
    """How long a step takes on the GPU and with the tree, the result of which is thrown away; one first to warm up."""
    ours: list[float] = []
    tree: list[float] = []
    for _ in range(rounds + 1):
        ours.append(seconds(lambda: flock.step(shower.STEP)))
        tree.append(seconds(lambda: school_step(flock.state, flock.rules, flock.seconds, shower.STEP,
                                                tree_pairs(flock))))
    return ours[1:], tree[1:]


def settle(stage: Stage) -> None:
    """Let a school swim until it is as crowded as it stays."""
    for _ in range(SETTLED):
        stage.scene.update(shower.STEP)


def drawing(rounds: int) -> Section:
    """A step and a picture of all of a school, the whole of which is seen."""
    rows = []
    for count, most, wish in PICTURES:
        row = Row(f"Demoscope: {count:,} fish", ours=True)
        rows.append(row)
        with viewer.headless("fish", size=PICTURE, params={"school": count}) as stage:
            settle(stage)
            stage.camera.distance = seen_whole(stage)
            for turn in range(3 * rounds + 1):
                figure = seconds(lambda stage=stage: frame(stage))
                row.times = [*row.times, *([figure] if turn else [])]
        row.extra = f"{1.0 / row.median:.1f} a second"
        row.target = at_most(row, most, wish) if most else ""
    return Section(f"A step and a picture of fish, {PICTURE[0]}x{PICTURE[1]}", rows)


def frame(stage: Stage) -> None:
    """Go on by a frame and draw it."""
    stage.scene.update(shower.STEP)
    drawn(stage)


def seen_whole(stage: Stage) -> float:
    """How far away the camera sees all of a school, in metres; of the hero alone, where it stands."""
    flock: Any = stage.scene.flock              # type: ignore[attr-defined]
    if flock.count == 1:
        return stage.camera.distance
    slope = math.tan(math.radians(stage.camera.field_of_view) / 2.0) * stage.size[0] / stage.size[1]
    return float(1.2 * flock.half_axes[0] / slope)
