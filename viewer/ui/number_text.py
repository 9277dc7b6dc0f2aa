"""Numbers as the panels write them."""

from __future__ import annotations

import math


def number_text(value: float, least: float = 0.0) -> str:
    """A number short enough to read aloud: whole ones in groups of three, others to four digits.

    What is smaller than ``least`` says only that.
    """
    number = float(value)
    if 0.0 < abs(number) < least:
        return f"< {least:g}"
    if not math.isfinite(number):
        return str(number)
    if number == round(number) and abs(number) < 1e12:
        return f"{round(number):,}".replace(",", "\u2009") if abs(number) >= 10_000 else f"{round(number)}"
    return f"{number:.4g}".replace("e-0", "e-").replace("e+0", "e+")
