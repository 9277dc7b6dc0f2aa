"""Pictures of the whole window without one."""

from __future__ import annotations

from pathlib import Path

import moderngl
import numpy as np

from viewer.engine.catalog import Catalog
from viewer.engine.stage import Stage
from viewer.ui.headless import panels


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
