"""The panels of the window: what building and drawing them costs the CPU in each frame."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from tests.benchmarks.report import Row, Section, at_most
from viewer.engine.catalog import Catalog
from viewer.engine.clock import FRAME_SECONDS
from viewer.engine.stage import Stage
from viewer.output.headless import shared_context

SIZE = (1280, 800)
FRAMES_A_ROUND = 60
SETTLING_FRAMES = 20
MOST_SECONDS = 1e-3


def sections(rounds: int) -> list[Section]:
    """With the picture drawn anew in every frame, by software where there is no GPU, and with it left standing."""
    rows: list[Row] = []
    for name, drawn in (("Demoscope, picture standing", False), ("Demoscope, picture drawn anew", True)):
        both = Row(name, ours=True)
        rows.append(both)
        try:
            building, drawing = panel_times(FRAMES_A_ROUND * rounds, picture=drawn)
        except ImportError as error:
            both.failure = str(error)
            continue
        both.times = (np.array(building) + drawing).tolist()
        both.target = at_most(both, MOST_SECONDS)
        rows += [Row("  of this, building the panels", building), Row("  and drawing them", drawing)]
    return [Section(f"All panels, {SIZE[0]}x{SIZE[1]}, a frame; CPU time of the thread that draws", rows)]


def panel_times(frames: int, *, picture: bool) -> tuple[list[float], list[float]]:
    """CPU seconds for building and for drawing the panels in each frame, once they have settled."""
    from viewer.ui.imgui_session import Surface
    from viewer.ui.workbench import Workbench

    context = shared_context()
    target = context.framebuffer([context.renderbuffer(SIZE, 4)])
    bench: Any = Workbench(context, Catalog(), steady=True)
    bench.show(Stage(context, Catalog().find("rippling_sphere"), samples=0, params={"subdivision": 2}))
    building, drawing = timed(bench.session, "frame"), timed(bench.session, "paint")
    try:
        for number in range(frames + SETTLING_FRAMES):
            if number == SETTLING_FRAMES and not picture:
                bench.live.render = lambda: None
            bench.draw(FRAME_SECONDS, Surface(target, SIZE))
            context.finish()
    finally:
        bench.release()
        target.release()
    return building[SETTLING_FRAMES:], drawing[SETTLING_FRAMES:]


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
