"""Asks a scene something costly rarely enough that nobody notices."""

from __future__ import annotations

import time
from collections.abc import Callable

from viewer.engine.stage import Stage

SHARE_OF_TIME = 0.1
QUICK_SECONDS = 0.01        # what takes no longer goes along with a drag
RESTED_SECONDS = 0.4        # a slider held still or a text left alone for so long has come to rest


class SparingQuestion:
    """When to ask a stage again. ``patient`` is False headless, where time does not count."""

    def __init__(self, stage: Stage, *, patient: bool) -> None:
        self.stage = stage
        self._patient = patient
        self._asked: object = None
        self._cost = 0.0
        self._not_before = 0.0
        self._revision, self._changed_at = -1, 0.0

    def run(self, ask: Callable[[], None], *, dragging: bool) -> None:
        """Ask if something changed, if it is time, and if no hand is moving a slider or typing meanwhile."""
        state = self.stage.scene_showing
        if state == self._asked:
            return
        now = time.perf_counter()
        if self.stage.params.revision != self._revision:
            self._revision, self._changed_at = self.stage.params.revision, now
        moving = dragging and now - self._changed_at < RESTED_SECONDS
        if self._patient and (now < self._not_before or (moving and self._cost > QUICK_SECONDS)):
            return
        self._asked = state
        ask()
        after = time.perf_counter()
        self._cost = after - now
        self._not_before = after + self._cost * (1.0 / SHARE_OF_TIME - 1.0)
