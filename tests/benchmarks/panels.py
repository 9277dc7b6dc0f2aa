"""The panels of the window: what building and drawing them costs the CPU in each frame."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.benchmarks.report import Row, Section, at_most
from viewer.engine.catalog import Catalog
from viewer.engine.clock import FRAME_SECONDS
from viewer.engine.stage import Stage
from viewer.output.headless import shared_context

Seconds = NDArray[np.float64]
SIZE = (1280, 800)
FRAMES_A_ROUND = 60
SETTLING_FRAMES = 60
FRAMES_A_FIGURE = 20       # some frames build the panels and some only draw them: each figure is a mean of so many
MOST_SECONDS = 1e-3


def sections(rounds: int) -> list[Section]:
    """The scene playing, with nobody at the mouse, and with a mouse that moves in every frame."""
    rows: list[Row] = []
    for name, moving in (("Demoscope, playing", False), ("Demoscope, playing under a moving mouse", True)):
        both = Row(name, ours=True)
        rows.append(both)
        try:
            building, drawing = panel_times(FRAMES_A_ROUND * rounds, moving=moving)
        except ImportError as error:
            both.failure = str(error)
            continue
        both.times = (building + drawing).tolist()
        both.target = at_most(both, MOST_SECONDS)
        rows += [Row("  of this, building the panels", building.tolist()),
                 Row("  and drawing them", drawing.tolist())]
    return [Section(f"All panels, {SIZE[0]}x{SIZE[1]}, a frame; CPU time of the thread that draws", rows)]


def panel_times(frames: int, *, moving: bool) -> tuple[Seconds, Seconds]:
    """CPU seconds a frame for building and for drawing the panels, once they have settled."""
    from viewer.ui.imgui_session import Surface
    from viewer.ui.workbench import Workbench

    context = shared_context()
    target = context.framebuffer([context.renderbuffer(SIZE, 4)])
    bench: Any = Workbench(context, Catalog())
    bench.show(Stage(context, Catalog().find("rippling_sphere"), samples=0, params={"subdivision": 2}))
    building, drawing = timed(bench.session, "frame"), timed(bench.session, "paint")
    seconds = np.zeros((2, frames))
    try:
        for number in range(-SETTLING_FRAMES, frames):
            building.clear()
            drawing.clear()
            if moving:
                bench.session.io.add_mouse_pos_event(600.0 + number % 50, 300.0)
            bench.draw(FRAME_SECONDS, Surface(target, SIZE))
            context.finish()
            seconds[:, number] = sum(building), sum(drawing)
    finally:
        bench.release()
        target.release()
    building_means, drawing_means = seconds.reshape(2, -1, FRAMES_A_FIGURE).mean(axis=2)
    return building_means, drawing_means


def timed(owner: object, name: str) -> list[float]:
    """Let a method note, from now on, the CPU seconds of its thread for each call, in the list returned."""
    method: Callable[..., Any] = getattr(owner, name)
    seconds: list[float] = []

    def noting(*arguments: Any, **named: Any) -> Any:
        start = time.thread_time()
        try:
            return method(*arguments, **named)
        finally:
            seconds.append(time.thread_time() - start)

    setattr(owner, name, noting)
    return seconds
