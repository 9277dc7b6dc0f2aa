"""Demoscope itself, drawing the large sphere of the pack beside this folder."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

import viewer
from tests.benchmarks.sphere import SIZE

PACK = Path(__file__).parents[1] / "pack"
_open_stages = ExitStack()      # until the process ends


def frames(samples: str, moving: str) -> Callable[[int], object]:
    """``moving`` is ``camera``, where the shadow stays as it is, or ``mesh``, where it is drawn anew."""
    stage = _open_stages.enter_context(viewer.headless("big_sphere", size=SIZE, samples=int(samples), packs=[PACK]))

    def draw(number: int) -> object:
        if moving == "mesh":
            stage.seek(number)
        else:
            stage.camera.drag(0.005, 0.0)
        return stage.pixels()

    return draw
