"""A scene's measurements as JSON."""

from __future__ import annotations

import json
import math
from typing import Any

from viewer.engine.scene import Curve, Measurements


def as_json(measurements: Measurements) -> str:
    """The numbers by name and the curves as lists by name; what is not a finite number is null."""
    plain = {name: _plain(value) for name, value in measurements.items()}
    return json.dumps(plain, indent=2, allow_nan=False)


def _plain(value: float | Curve) -> Any:
    if isinstance(value, Curve):
        return {name: [_finite(number) for number in numbers] for name, numbers in value.lists().items()}
    return _finite(value)


def _finite(number: float) -> float | int | None:
    if not math.isfinite(number):
        return None
    return number if isinstance(number, int) else float(number)
