"""The panels without a window: the same classes over the same picture, for pictures of the whole."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.catalog import Catalog
from viewer.engine.clock import FRAME_SECONDS
from viewer.engine.stage import Stage
from viewer.ui.imgui_session import Surface
from viewer.ui.screenshot import surface_pixels
from viewer.ui.workbench import Workbench

SETTLING_FRAMES = 4     # panels learn their sizes from one frame to the next


class HeadlessPanels:
    """Draws ``stage`` with panels around it in a picture of the stage's size; byte for byte the same each time."""

    def __init__(self, stage: Stage, catalog: Catalog, *, scale: float = 1.0) -> None:
        self.stage = stage
        self.bench = Workbench(stage.context, catalog, steady=True)
        self.bench.view.scale = scale
        self.bench.show(stage, borrowed=True)
        self._target: moderngl.Framebuffer | None = None

    def pixels(self) -> NDArray[np.uint8]:
        """The window as it would look now: uint8 (height, width, 4), top row first."""
        size = self.stage.size
        surface = Surface(self._target_of(size), size)
        try:
            for _ in range(SETTLING_FRAMES):
                self.bench.draw(FRAME_SECONDS, surface)
            if self.bench.live and self.bench.live.failure:
                raise self.bench.live.failure
            return surface_pixels(surface)
        finally:
            self.stage.resize(size)

    def release(self) -> None:
        """Free the panels; the stage stays its owner's."""
        self._free_target()
        self.bench.release()

    def _target_of(self, size: tuple[int, int]) -> moderngl.Framebuffer:
        if self._target is None or self._target.size != size:
            self._free_target()
            self._target = self.stage.context.framebuffer([self.stage.context.renderbuffer(size, 4)])
        return self._target

    def _free_target(self) -> None:
        if self._target:
            self.stage.context.detect_framebuffer(0).use()   # a framebuffer that is freed may not stay bound
            for buffer in self._target.color_attachments:
                buffer.release()
            self._target.release()
            self._target = None


def panels(stage: Stage, catalog: Catalog) -> HeadlessPanels:
    """Panels over ``stage``; ``pixels()`` draws, ``release()`` frees."""
    return HeadlessPanels(stage, catalog)
