"""When panels are built anew: in every frame under somebody's hand, and else as often as one can read.

Between two builds the last one is drawn again, over a picture that moves on in every frame.
"""

from __future__ import annotations

from viewer.ui.imgui_session import Surface

AWAKE_SECONDS = 0.4         # after the last event: hover delays and double clicks run their course
RESTING_SECONDS = 0.05
NEWEST_SHARE = 0.05


class Pace:
    """Counts the time since panels were built, and since a hand was on mouse or keyboard."""

    def __init__(self) -> None:
        self.cpu_milliseconds = 0.0
        self._since_build = 0.0
        self._awake = AWAKE_SECONDS
        self._surface: Surface | None = None

    def hurry(self) -> None:
        """Build in the next frame, whatever the time."""
        self._surface = None

    def due(self, seconds: float, surface: Surface, *, touched: bool) -> float:
        """The time that the panels' next build stands for, or 0 where this frame can do without one."""
        self._since_build += seconds
        self._awake = AWAKE_SECONDS if touched else self._awake - seconds
        if surface == self._surface and self._awake < 0.0 and self._since_build < RESTING_SECONDS:
            return 0.0
        passed, self._since_build, self._surface = max(self._since_build, 1e-5), 0.0, surface
        return passed

    def spent(self, cpu_seconds: float) -> None:
        """Take what the panels cost in one frame into the running mean of ``cpu_milliseconds``."""
        self.cpu_milliseconds += NEWEST_SHARE * (1e3 * cpu_seconds - self.cpu_milliseconds)
