"""Scene time: an integer frame of a sixtieth of a second, advanced by the wall clock or by hand."""

from __future__ import annotations

from operator import index
from typing import SupportsIndex

from viewer.engine.fields import ParameterError

FRAMES_PER_SECOND = 60
FRAME_SECONDS = 1.0 / FRAMES_PER_SECOND
LAST_FRAME = 10**9
MOST_STEPS_AT_ONCE = 8
SPEEDS = (0.1, 0.25, 0.5, 1.0, 2.0, 4.0)


def checked_frame(frame: SupportsIndex) -> int:
    """``frame`` as a whole number from 0 to LAST_FRAME; raises ParameterError."""
    try:
        number = index(frame)
    except TypeError:
        raise ParameterError(f"frame = {frame} is not a whole number") from None
    if number < 0:
        raise ParameterError(f"frame = {number} is before the first, which is 0")
    if number > LAST_FRAME:
        raise ParameterError(f"frame = {str(number)[:40]} is after the last, which is {LAST_FRAME}")
    return int(number)


class Clock:
    """Which frame it is, whether it plays, and how fast.

    The clock only counts; the stage makes the scene follow. After a stall the scene goes on from
    where it was rather than racing to catch up.
    """

    def __init__(self) -> None:
        self.frame = 0
        self.playing = True
        self.speed = 1.0
        self._owed = 0.0

    @property
    def seconds(self) -> float:
        """Scene time in seconds."""
        return self.frame * FRAME_SECONDS

    def toggle(self) -> None:
        """Play if paused, pause if playing."""
        self.playing = not self.playing
        self._owed = 0.0

    def steps_due(self, wall_seconds: float) -> int:
        """How many frames to step after ``wall_seconds`` more have passed, at most a handful."""
        if not self.playing:
            return 0
        self._owed += max(0.0, wall_seconds) * self.speed * FRAMES_PER_SECOND
        due = int(self._owed)
        self._owed -= due
        return min(due, MOST_STEPS_AT_ONCE)
