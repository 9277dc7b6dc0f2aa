"""Pictures of the whole window without one."""

from __future__ import annotations

from pathlib import Path

import moderngl
import numpy as np
import pytest

from tests import packs
from tests.conftest import ScenePack
from viewer.engine.catalog import Catalog
from viewer.engine.stage import Stage
from viewer.ui.headless import panels
from viewer.ui.imgui_session import Surface
from viewer.ui.workbench import Workbench


def test_panels_over_a_stage_are_the_same_each_time(context: moderngl.Context, pack: Path) -> None:
    catalog = Catalog([pack])
    stage = Stage(context, catalog.find("tile"), size=(800, 600))
    stage.seek(5)
    drawn = panels(stage, catalog)
    first = drawn.pixels()
    assert (first.shape, first.dtype) == ((600, 800, 4), np.uint8)
    assert stage.size == (800, 600)
    assert stage.frame == 5
    assert np.array_equal(drawn.pixels(), first)
    drawn.release()
    again = panels(stage, catalog)
    assert np.array_equal(again.pixels(), first)
    stage.seek(6)
    assert not np.array_equal(again.pixels(), first)
    again.release()
    stage.release()
    assert context.error == "GL_NO_ERROR"


@pytest.mark.parametrize("scale", ["'viridis'", "ColorScale('error', None, 1.0)", "1 / 0"])
def test_a_scale_that_cannot_be_drawn_is_told_and_the_picture_stays(context: moderngl.Context, scene_pack: ScenePack,
                                                                    scale: str) -> None:
    source = packs.TILE.replace("import Parameters", "import ColorScale, Parameters")
    source += f"\n    def color_scale(self):\n        return {scale}\n"
    bench = Workbench(context, Catalog([scene_pack(tile=source)]), steady=True)
    target = context.simple_framebuffer((320, 200))
    try:
        assert bench.open("tile")
        bench.draw(0.02, Surface(target, (320, 200)))
        assert bench.live and bench.live.problem
        assert bench.live.problem.text.startswith("tile failed in color_scale")
    finally:
        bench.release()
        for buffer in (*target.color_attachments, target.depth_attachment, target):
            buffer.release()


def test_a_middle_that_fails_beside_a_scale_is_told_and_the_window_goes_on(context: moderngl.Context,
                                                                           scene_pack: ScenePack) -> None:
    """The scale asks where it may stand; what the scene raises then must not break the frame."""
    source = packs.TILE.replace("import Parameters", "import ColorScale, Parameters")
    source += ("\n    def color_scale(self):\n        return ColorScale('height', 0.0, 1.0)\n"
               "\n    def middle(self):\n        return 1 / 0\n")
    bench = Workbench(context, Catalog([scene_pack(tile=source)]), steady=True)
    target = context.simple_framebuffer((320, 200))
    try:
        assert bench.open("tile")
        for _ in range(2):
            bench.draw(0.02, Surface(target, (320, 200)))
        assert bench.live and bench.live.problem
        assert bench.live.problem.text.startswith("tile failed in middle")
    finally:
        bench.release()
        for buffer in (*target.color_attachments, target.depth_attachment, target):
            buffer.release()
