"""Colours as screens take them, sRGB in 0 to 1, and the linear light that they stand for (IEC 61966-2-1)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray


def linear_light(encoded: float) -> float:
    """One sRGB channel in 0 to 1 as linear light (IEC 61966-2-1)."""
    return encoded / 12.92 if encoded <= 0.04045 else ((encoded + 0.055) / 1.055) ** 2.4


def encoded(linear: NDArray[np.float64]) -> NDArray[np.float64]:
    """Linear light in 0 to 1, of any shape, as sRGB: the inverse of ``linear_light``."""
    return np.where(linear <= 0.04045 / 12.92, 12.92 * linear, 1.055 * np.maximum(linear, 0.0) ** (1 / 2.4) - 0.055)


def color_of(code: str) -> tuple[float, float, float]:
    """The sRGB colour with a code such as ``#ff8800``; raises ValueError for anything else."""
    if len(code) != 7 or not code.startswith("#"):
        raise ValueError(f"{code} is not a colour such as #ff8800")
    red, green, blue = bytes.fromhex(code[1:])
    return red / 255.0, green / 255.0, blue / 255.0


def code_of(color: Sequence[float]) -> str:
    """The code of an sRGB colour in 0 to 1, rounded to eight bits."""
    return "#" + "".join(f"{round(channel * 255):02x}" for channel in color)
