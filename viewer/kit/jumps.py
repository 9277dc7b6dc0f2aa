"""Jumps of a function over a level: poles and steps, which samples alone cannot tell from crossings."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Numbers: TypeAlias = NDArray[np.floating[Any]]

HALVINGS = 20


def stay_apart(function: Callable[[Any], Any], starts: Numbers, ends: Numbers, A: Numbers, B: Numbers,
               level: float) -> NDArray[np.bool_]:
    """Whether ``function`` jumps over ``level`` on each edge from ``starts`` to ``ends`` (n, d).

    ``A`` and ``B`` (n,) are its values there, less the level, of different signs. The half without the change of
    sign is cut off again and again: where the function is continuous the values at both ends come together, at
    a pole or a step they stay apart, and so they count where one has no value. The edges' precision is kept.
    """
    kind = starts.dtype.type
    low, high = np.zeros(len(A), kind), np.ones(len(A), kind)
    at_low, at_high, steps, below = A, B, ends - starts, A < 0.0
    with np.errstate(all="ignore"):
        for _ in range(HALVINGS):
            middle = kind(0.5) * (low + high)
            value = function(starts + middle[:, None] * steps) - kind(level)
            lower = (value < 0.0) == below
            low, high = np.where(lower, middle, low), np.where(lower, high, middle)
            at_low, at_high = np.where(lower, value, at_low), np.where(lower, at_high, value)
        return np.asarray(~(np.abs(at_high - at_low) <= 0.25 * np.abs(B - A)))
