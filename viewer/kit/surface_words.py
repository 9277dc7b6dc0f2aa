"""Sentences about a surface that is not as one might expect: empty, torn, or full of holes."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray


def number(value: float) -> str:
    """A number in a sentence."""
    return f"{value + 0.0:.4g}".replace("-", "\u2212")


def about_emptiness(values: NDArray[np.float32], level: float, what: str) -> str:
    """Why samples have no surface at ``level``."""
    finite = values[np.isfinite(values)]
    if not finite.size:
        return f"{what} has no value at any sample: there is no surface."
    low, high = float(finite.min()), float(finite.max())
    if low == high:
        return f"{what} is {number(low)} everywhere: there is no surface."
    if low < level <= high:
        return f"{what} crosses the level only where it jumps or has no value: there is no surface."
    name = what[0].lower() + what[1:]
    return f"No surface at level {number(level)}: {name} lies between {number(low)} and {number(high)}."


def about_gaps(jumps: int, without_value: int, samples: int) -> Iterator[str]:
    """What was left out of a surface."""
    if jumps:
        edges = "one edge" if jumps == 1 else f"{jumps:,} edges".replace(",", "\u2009")
        yield f"The function jumps over the level on {edges}; the cells there yield nothing."
    if without_value:
        share = 100.0 * without_value / samples
        part = f"{int(share)} %" if share >= 1.0 else "less than 1 %"
        yield f"{part} of the samples have no value; the cells that touch them yield nothing."
