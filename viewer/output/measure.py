"""A scene's measurements as JSON."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np

from viewer.engine.annotations import Cell, Table
from viewer.engine.scene import Curve, Measurements


def as_json(measurements: Measurements) -> str:
    """Numbers by name, curves as lists by name, tables as their rows; what is not a finite number is null."""
    plain = {name: _plain(value) for name, value in measurements.items()}
    return json.dumps(plain, indent=2, allow_nan=False)


def _plain(value: float | Curve | Table) -> Any:
    if isinstance(value, Table):
        return [{name: _word_or_number(cell) for name, cell in row.items()} for row in value.records()]
    if isinstance(value, Curve):
        return {name: [_finite(number) for number in numbers] for name, numbers in value.lists().items()}
    return _finite(value)


def _word_or_number(cell: Cell) -> Any:
    return cell if isinstance(cell, str) else _finite(cell)


def _finite(number: float) -> float | int | None:
    if not math.isfinite(number):
        return None
    return int(number) if isinstance(number, (int, np.integer)) else float(number)
