"""Particles: a step beside other ways to make it, what a particle costs, drawing, going back, and allocation."""

from __future__ import annotations

import math
import tempfile
import tracemalloc
from collections.abc import Iterator
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import Any
from unittest.mock import patch

import moderngl

import viewer
from tests.benchmarks import shower
from tests.benchmarks.contest import Worker, frames_in_turn
from tests.benchmarks.isosurfaces import seconds
from tests.benchmarks.peers.particles import CALM, steady
from tests.benchmarks.report import Row, Section, at_most, in_time_of
from tests.benchmarks.sphere import small_sphere
from viewer.engine.stage import Stage

STEPS, COSTLY_STEPS = 8, 4      # in each turn
MOST_SECONDS = 12e-3
MOST_TAICHI = 4.0
EXPONENTS = (14, 16, 18, 20, 22)
FLAT = 1.5                      # the dearest particle, by the cheapest
VARIANTS = {"plain": "", "turbulence": ", with turbulence", "mesh": ", with a mesh as obstacle",
            "cascades": ", with cascades"}
PICTURE = (1280, 720)
SPRITES = ((100_000, 4.0, 50e-3), (1_000_000, 2.0, None))     # how many, how wide in pixels, what is asked
SCRUBBED, SCRUBBED_FRAME = 100_000, 600
ALLOCATING_FRAMES, HEAP_FRAMES = 100, 300
MOST_HEAP = 64 * 1024           # bytes: the curve of live counts grows by a number a frame
MAKERS = ("buffer", "texture", "texture3d", "texture_array", "depth_texture", "renderbuffer", "depth_renderbuffer",
          "framebuffer", "simple_framebuffer", "program", "vertex_array", "simple_vertex_array", "query", "sampler")


def sections(rounds: int) -> list[Section]:
    """All of it."""
    return [one_step(3 * rounds), *(costs(variant, rounds) for variant in VARIANTS), drawing(rounds),
            going_back(rounds), allocation()]


def one_step(rounds: int) -> Section:
    """The whole update in a steady state, births and the status read back included, beside Taichi and NumPy."""
    many = str(shower.MANY)
    ours = Worker(Row("Demoscope: the whole update", ours=True), "particles", "steady", many)
    taichi = Worker(Row("Taichi, CPU"), "particles_taichi", many)
    numpy = Worker(Row("NumPy, float32"), "particles_numpy", many)
    frames_in_turn([ours, taichi, numpy], rounds, STEPS)
    if ours.row.times:
        beside = in_time_of(ours.row, taichi.row, MOST_TAICHI, "Taichi")
        ours.row.target = f"{at_most(ours.row, MOST_SECONDS)}, {beside}"
    title = f"A step of {shower.MANY:,} particles: gravity, drag, ground, ball and respawn"
    return Section(title, [ours.row, taichi.row, numpy.row])


def costs(variant: str, rounds: int) -> Section:
    """Whole updates of ever more particles, and what that makes for each."""
    with tempfile.TemporaryDirectory() as folder:
        settings = [f"obstacle_file={ball_file(Path(folder))}"] if variant == "mesh" else []
        workers = [Worker(Row(f"2^{exponent} particles", ours=True), "particles", variant, str(2**exponent), *settings)
                   for exponent in EXPONENTS]
        frames_in_turn(workers, rounds, COSTLY_STEPS)
    rows = [worker.row for worker in workers]
    each = [row.median / 2**exponent for row, exponent in zip(rows, EXPONENTS, strict=True) if row.times]
    for row, exponent in zip(rows, EXPONENTS, strict=True):
        row.extra = f"{1e9 * row.median / 2**exponent:.0f} ns each" if row.times else ""
    if len(each) == len(rows):
        verdict = "met" if max(each) <= FLAT * min(each) else "MISSED"
        rows[-1].target = f"flat within {FLAT:g}: {verdict}, {max(each) / min(each):.1f}"
    return Section(f"What a particle costs{VARIANTS[variant]}", rows)


def ball_file(folder: Path) -> Path:
    """A ball of 20,480 triangles on disk."""
    vertices, triangles = small_sphere()
    lines = [*("v {} {} {}".format(*row) for row in vertices.tolist()),
             *("f {} {} {}".format(*row) for row in (triangles + 1).tolist())]
    path = folder / "ball.obj"
    path.write_text("\n".join([*lines, ""]), "utf-8")
    return path


def drawing(rounds: int) -> Section:
    """A cloud of sprites, alone and as a picture."""
    rows = []
    for count, pixels, most in SPRITES:
        sprites, picture = Row(f"Demoscope: {count:,} of {pixels:g} px", ours=True), Row("  the whole picture")
        rows += [sprites, picture]
        with viewer.headless("particle_fountain", size=PICTURE, params=cloud(count)) as stage:
            if "draw_ms" not in stage.measure():
                sprites.failure = picture.failure = "the scene draws no sprites"
                continue
            stage.set(size=(world_width(stage, pixels),) * 2)
            stage.seek(60)
            for turn in range(rounds + 1):
                figures = seconds(lambda stage=stage: drawn(stage)), 1e-3 * float(stage.measure()["draw_ms"])
                for row, figure in zip((picture, sprites), figures, strict=True):
                    row.times = [*row.times, *([figure] if turn else [])]
        sprites.target = at_most(sprites, most) if most else ""
    return Section(f"Drawing particles, {PICTURE[0]}x{PICTURE[1]}", rows)


def cloud(count: int) -> dict[str, object]:
    """The parameters of a ball of particles that grows without anything in its way."""
    return {**CALM, "count": count, "burst": count, "rate": 0.0, "lifetime": (60.0, 60.0), "speed": (0.0, 2.0),
            "spread": 180.0, "emitter": "point", "emitter_height": 1.0, "gravity": 0.0, "ground": False,
            "billboard": "camera"}


def world_width(stage: Stage, pixels: float) -> float:
    """How wide a thing is, in metres, that covers so many pixels where the camera looks at."""
    camera = stage.camera
    return pixels / stage.size[1] * 2.0 * camera.distance * math.tan(math.radians(camera.field_of_view) / 2.0)


def drawn(stage: Stage) -> None:
    """A picture, whether or not anything has changed, and the GPU waited for."""
    stage.camera.drag(0.005, 0.0)
    stage.render()
    stage.context.finish()


def going_back(rounds: int) -> Section:
    """A user who steps back frame by frame; how much is kept for that, and what it would be without."""
    back, without = Row("Demoscope: one frame back", ours=True), Row("  without snapshots: from the beginning")
    with viewer.headless("particle_fountain", params=steady(int(SCRUBBED / 0.95))) as stage:
        stage.seek(SCRUBBED_FRAME)
        kept: Any = stage._rewind

        def step_back() -> None:
            stage.step(-1)
            stage.context.finish()

        back.extra = f"{kept.nbytes / 2**20:.0f} MiB kept"
        back.times = [seconds(step_back) for _ in range(4 * rounds)]
        kept.forget()
        without.times = [seconds(step_back)]
    return Section(f"Going back in time, {SCRUBBED:,} particles, from frame {SCRUBBED_FRAME}", [back, without])


def allocation() -> Section:
    """What updates and pictures leave behind, once everything is in its steady state."""
    rows = []
    with viewer.headless("particle_fountain", params=steady(int(SCRUBBED / 0.95))) as stage:
        frame(stage, shower.STEADY)
        frame(stage, 2, drawing=True)
        with counted_objects() as made:
            taken = seconds(lambda: frame(stage, ALLOCATING_FRAMES, drawing=True))
        verdict = "met" if not made else f"MISSED, {', '.join(sorted(set(made)))}"
        rows.append(Row(f"Demoscope: {ALLOCATING_FRAMES} updates and pictures", [taken], f"{len(made)} GL objects",
                        f"none made: {verdict}", ours=True))
        tracemalloc.start()
        frame(stage, 2)
        before = tracemalloc.get_traced_memory()[0]
        taken = seconds(lambda: frame(stage, HEAP_FRAMES))
        grown = tracemalloc.get_traced_memory()[0] - before
        tracemalloc.stop()
    verdict = "met" if grown <= MOST_HEAP else "MISSED"
    rows.append(Row(f"Demoscope: {HEAP_FRAMES} updates, traced", [taken], f"{grown / 1024:.1f} KiB more",
                    f"at most {MOST_HEAP // 1024} KiB more: {verdict}", ours=True))
    return Section(f"Allocation, {SCRUBBED:,} particles", rows)


def frame(stage: Stage, times: int, *, drawing: bool = False) -> None:
    """So many updates, with or without a picture after each."""
    for _ in range(times):
        stage.scene.update(shower.STEP)
        if drawing:
            drawn(stage)


@contextmanager
def counted_objects() -> Iterator[list[str]]:
    """The kind of each GL object that anybody makes meanwhile."""
    made: list[str] = []

    def counting(kind: str, maker: Any) -> Any:
        @wraps(maker)
        def make(*arguments: Any, **named: Any) -> Any:
            made.append(kind)
            return maker(*arguments, **named)
        return make

    makers = {kind: counting(kind, getattr(moderngl.Context, kind)) for kind in MAKERS}
    with patch.multiple(moderngl.Context, **makers):
        yield made
