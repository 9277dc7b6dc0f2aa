"""Calls a scene's ``measure`` now and then, and prepares its results for the eye."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from viewer.engine.annotations import Table
from viewer.engine.scene import Curve, Measurements
from viewer.engine.stage import Stage
from viewer.ui.guard import one_line
from viewer.ui.number_text import number_text
from viewer.ui.sparing_question import SparingQuestion
from viewer.ui.text_table import TextTable, text_table

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
    """What a scene measured, as (label, value) texts, tables and plots."""

    readouts: list[tuple[str, str]]
    tables: list[TextTable]
    plots: list[Plot]


class Measurer:
    """Holds the latest report of one stage. ``patient`` is False headless, where time does not count."""

    def __init__(self, stage: Stage, *, patient: bool = True) -> None:
        self.stage = stage
        self.report: Report | None = None
        self.failure = ""
        self._asking = SparingQuestion(stage, patient=patient)

    def run(self, *, dragging: bool) -> None:
        """Measure if something changed, if it is time, and if no hand is moving a slider or typing meanwhile."""
        self._asking.run(self._measure, dragging=dragging)

    def _measure(self) -> None:
        try:
            self.report, self.failure = prepared(self.stage.measure()), ""
        except Exception as error:
            self.failure = one_line(error)


def prepared(measurements: Measurements) -> Report:
    """Measurements as texts, tables and plots."""
    numbers = {name: value for name, value in measurements.items() if not isinstance(value, (Curve, Table))}
    tables = {name: value for name, value in measurements.items() if isinstance(value, Table)}
    curves = {name: value for name, value in measurements.items() if isinstance(value, Curve)}
    return Report([readout(name, value) for name, value in numbers.items()],
                  [text_table(name, value) for name, value in tables.items()],
                  [_plot(name, value) for name, value in curves.items()])


def readout(name: str, value: float) -> tuple[str, str]:
    """``normal_error_mean_deg`` and 6.4512 as "normal error mean" and "6.451°"."""
    stem, _, suffix = name.rpartition("_")
    unit = UNITS.get(suffix, "") if stem else ""
    return (stem if unit else name).replace("_", " "), number_text(value, ANGLE_DIGITS if unit == "°" else 0.0) + unit


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
