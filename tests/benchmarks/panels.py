"""The panels of the window: what they cost the CPU in each frame, on an idle scene and while it plays."""

from __future__ import annotations

import moderngl

from tests.benchmarks.report import Row, Section, at_most
from viewer.engine.catalog import Catalog
from viewer.engine.clock import FRAME_SECONDS
from viewer.engine.stage import Stage
from viewer.output.headless import shared_context

SIZE = (1280, 800)
FRAMES = 200
MOST_SECONDS = 1e-3


def sections(rounds: int) -> list[Section]:
    """Frames of the whole window; only the panels' part of each counts."""
    row = Row("Demoscope, all panels shown", ours=True)
    try:
        row.times = panel_times(FRAMES * max(1, rounds // 3))
    except ImportError as error:
        row.failure = str(error)
    else:
        row.target = at_most(row, MOST_SECONDS)
    return [Section(f"Panels: building and drawing all of them, {SIZE[0]}x{SIZE[1]}, a frame", [row])]


def panel_times(frames: int) -> list[float]:
    """Seconds that the panels took in each frame, once they have settled."""
    from viewer.ui.imgui_session import Surface
    from viewer.ui.workbench import Workbench

    context = shared_context()
    target = context.framebuffer([context.renderbuffer(SIZE, 4)])
    stage = Stage(context, Catalog().find("rippling_sphere"), size=SIZE, samples=0, params={"subdivision": 2})
    bench = Workbench(context, Catalog(), steady=True)
    bench.show(stage)
    try:
        return [_draw(bench, Surface(target, SIZE), context) for _ in range(frames + 20)][20:]
    finally:
        bench.release()
        target.release()


def _draw(bench: object, surface: object, context: moderngl.Context) -> float:
    bench.draw(FRAME_SECONDS, surface)  # type: ignore[attr-defined]
    context.finish()
    return 1e-3 * float(bench.panel_milliseconds)  # type: ignore[attr-defined]
