"""Calls a scene's ``measure`` rarely enough that nobody notices, and prepares its results for the eye."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from viewer.engine.annotations import Table
from viewer.engine.scene import Curve, Measurements
from viewer.engine.stage import Stage
from viewer.ui.guard import one_line

SHARE_OF_TIME = 0.1
QUICK_SECONDS = 0.01        # a measure that takes no longer goes along with a drag
RESTED_SECONDS = 0.4        # a slider held still or a text left alone for so long has come to rest
MOST_POINTS = 1000
ANGLE_DIGITS = 0.001        # degrees; below it single precision has its say
UNITS = {"deg": "°", "ms": " ms", "percent": " %", "seconds": " s", "px": " px"}


@dataclass(frozen=True)
class Plot:
    """A curve, ready to draw: finite points only, no more than one can see."""

    title: str
    curve: Curve
    series: list[tuple[str, NDArray[np.float64], NDArray[np.float64]]]


@dataclass(frozen=True)
class Report:
    """What a scene measured, as (label, value) texts and plots."""

    readouts: list[tuple[str, str]]
    plots: list[Plot]


class Measurer:
    """Holds the latest report of one stage. ``patient`` is False headless, where time does not count."""

    def __init__(self, stage: Stage, *, patient: bool = True) -> None:
        self.stage = stage
        self.report: Report | None = None
        self.failure = ""
        self._patient = patient
        self._measured: object = None
        self._cost = 0.0
        self._not_before = 0.0
        self._revision, self._changed_at = -1, 0.0

    def run(self, *, dragging: bool) -> None:
        """Measure if something changed, if it is time, and if no hand is moving a slider or typing meanwhile."""
        state = self.stage.scene_showing
        if state == self._measured:
            return
        now = time.perf_counter()
        if self.stage.params.revision != self._revision:
            self._revision, self._changed_at = self.stage.params.revision, now
        moving = dragging and now - self._changed_at < RESTED_SECONDS
        if self._patient and (now < self._not_before or (moving and self._cost > QUICK_SECONDS)):
            return
        self._measured = state
        try:
            self.report, self.failure = prepared(self.stage.measure()), ""
        except Exception as error:
            self.failure = one_line(error)
        after = time.perf_counter()
        self._cost = after - now
        self._not_before = after + self._cost * (1.0 / SHARE_OF_TIME - 1.0)


def prepared(measurements: Measurements) -> Report:
    """Measurements as texts and plots."""
    readouts = [readout(name, value) for name, value in measurements.items() if not isinstance(value, (Curve, Table))]
    plots = [_plot(name, value) for name, value in measurements.items() if isinstance(value, Curve)]
    return Report(readouts, plots)


def readout(name: str, value: float) -> tuple[str, str]:
    """``normal_error_mean_deg`` and 6.4512 as "normal error mean" and "6.451°"."""
    stem, _, suffix = name.rpartition("_")
    unit = UNITS.get(suffix, "") if stem else ""
    return (stem if unit else name).replace("_", " "), number_text(value, ANGLE_DIGITS if unit == "°" else 0.0) + unit


def number_text(value: float, least: float = 0.0) -> str:
    """A number short enough to read aloud: whole ones in groups of three, others to four digits.

    What is smaller than ``least`` says only that.
    """
    number = float(value)
    if 0.0 < abs(number) < least:
        return f"< {least:g}"
    if not np.isfinite(number):
        return str(number)
    if number == round(number) and abs(number) < 1e12:
        return f"{round(number):,}".replace(",", "\u2009") if abs(number) >= 10_000 else f"{round(number)}"
    return f"{number:.4g}".replace("e-0", "e-").replace("e+0", "e+")


def _plot(name: str, curve: Curve) -> Plot:
    x = np.asarray(curve.x, np.float64).ravel()
    series = []
    for label, values in curve.series.items():
        y = np.asarray(values, np.float64).ravel()
        good = np.isfinite(x) & np.isfinite(y)
        if curve.log_x:
            good &= x > 0.0
        if curve.log_y:
            good &= y > 0.0
        stride = max(1, int(good.sum()) // MOST_POINTS)
        series.append((label.replace("_", " "), np.ascontiguousarray(x[good][::stride]),
                       np.ascontiguousarray(y[good][::stride])))
    return Plot(name.replace("_", " "), curve, series)
