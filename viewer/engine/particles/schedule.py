"""When the emitter gives birth: a steady rate and bursts, counted so that the step has no say in it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypeAlias

from viewer.engine.particles.qualities import EmissionParameters

TINY = 1e-9     # of a particle: what rounding may take from a whole one
ScheduleState: TypeAlias = tuple[float, float, int, float, float]


@dataclass(frozen=True)
class Births:
    """``number`` births in a row: at its end the first has lived ``lived`` seconds, each next ``between`` less."""

    number: int
    lived: float
    between: float = 0.0


class Schedule:
    """Carries the fraction of a particle over from step to step.

    ``owed`` is that fraction, ``seconds`` how long the emitter has been at work. Bursts are counted from the moment
    ``counted_from``, as many as ``bursts``, with a period of ``every``.
    """

    def __init__(self, params: EmissionParameters) -> None:
        self.params = params
        self.owed, self.seconds, self.bursts = 0.0, 0.0, 0
        self.counted_from, self.every = 0.0, params.burst_every

    def first(self) -> list[Births]:
        """What is there at the very start: the first burst."""
        self.bursts = 1 if self.params.burst else 0
        return [Births(self.params.burst, 0.0)] if self.params.burst else []

    def due(self, step: float) -> list[Births]:
        """The births within the next ``step`` seconds, which then have passed."""
        end = self.seconds + step
        births = self._bursts_until(end) + self._steady(step)
        self.seconds = end
        return births

    def state(self) -> ScheduleState:
        """All that the schedule remembers."""
        return self.owed, self.seconds, self.bursts, self.counted_from, self.every

    def restore(self, state: ScheduleState) -> None:
        """Go back to a ``state``."""
        self.owed, self.seconds, self.bursts, self.counted_from, self.every = state

    def _steady(self, step: float) -> list[Births]:
        rate, working = self.params.rate, self._working_seconds(step)
        if rate <= 0.0 or working <= 0.0:
            return []
        before, self.owed = self.owed, self.owed + rate * working
        number = int(self.owed + TINY)
        self.owed -= number
        first = max(0.0, (1.0 - before) / rate)     # into the step is when the next whole one is reached
        return [Births(number, step - first, 1.0 / rate)] if number else []

    def _bursts_until(self, end: float) -> list[Births]:
        """The bursts in the step that ends at ``end``, by their number rather than by adding up seconds."""
        self._follow_period()
        births: list[Births] = []
        while self.params.burst and (not self.bursts or self.every) and len(births) < 100:
            moment = self.counted_from + self.bursts * self.every
            if moment > end + TINY or self._dry(moment):
                break
            births.append(Births(self.params.burst, max(0.0, end - max(moment, self.seconds))))
            self.bursts += 1
        return births

    def _follow_period(self) -> None:
        """Count from the last burst where the period has changed; what was not given in its time is not made up for."""
        if self.params.burst_every != self.every:
            self.counted_from += max(0, self.bursts - 1) * self.every
            self.bursts, self.every = min(self.bursts, 1), self.params.burst_every
        if self.every:
            self.bursts = max(self.bursts, math.ceil((self.seconds - self.counted_from) / self.every - TINY))

    def _working_seconds(self, step: float) -> float:
        """How much of the next step passes before the emitter runs dry, or its wave has run all round."""
        ends = [until for until in (self.params.emit_until, self._wave_end()) if until]
        return min(step, min(ends) - self.seconds) if ends else step

    def _wave_end(self) -> float:
        speed = self.params.wave_speed
        around = math.pi * self.params.emitter_size
        return float((around + self.params.wave_width) / speed) if self.params.rides_wave else 0.0

    def _dry(self, moment: float) -> bool:
        return bool(self.params.emit_until and moment >= self.params.emit_until)
