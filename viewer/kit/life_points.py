"""Values at positions along a life, from 0, its birth, to 1, its death, as one writes them.

    0:VALUE, 0.4:VALUE, 1:VALUE

is the text of such a list; a VALUE alone holds for the whole life.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TypeAlias

import numpy as np

from viewer.errors import DemoscopeError

Pair: TypeAlias = tuple[float, object]

LEAST_GAP = 1e-6    # between neighbours: a steeper slope would leave single precision
LONGEST_SHOWN = 60


class LifeError(DemoscopeError, ValueError):
    """A list of values over a life that cannot be; ``why`` is what its message says after the list itself."""

    def __init__(self, noun: str, value: object, why: str) -> None:
        super().__init__(" ".join(f"{noun} {shown(value)} {why}".split()))
        self.why = why


def number_text(number: float) -> str:
    """The shortest text of a number that reads back as the same number."""
    short = f"{number:g}"
    return short if float(short) == number else repr(number)


def shown(value: object) -> str:
    """``value`` as a message quotes it, cut to a length that one can read."""
    text = str(value)
    return text if len(text) <= LONGEST_SHOWN else text[:LONGEST_SHOWN - 3] + "..."


def life_pairs(noun: str, value: object, most: int, example: str) -> list[Pair]:
    """The (position, value) pairs meant by a text or by a sequence of pairs, in order; the values stay as they are.

    Raises LifeError where there is none or more than ``most``, where one is no pair as in ``example``, and where
    positions leave 0 to 1 or do not rise.
    """
    pairs = _from_text(value) if isinstance(value, str) else _from_sequence(noun, value, example)
    if not pairs:
        raise LifeError(noun, value, f"is empty; allowed: 1 to {most} such as {example}")
    if len(pairs) > most:
        raise LifeError(noun, value, f"has {len(pairs)} entries; at most {most} are allowed")
    found: list[Pair] = []
    for position, along in pairs:
        here = _position(noun, value, position, example)
        if found and here - found[-1][0] < LEAST_GAP:
            raise LifeError(noun, value, f"has the position {number_text(here)} after {number_text(found[-1][0])}; "
                                         f"each lies at least {LEAST_GAP:g} beyond the one before")
        found.append((here, along))
    return found


def _from_text(text: str) -> list[tuple[object, object]]:
    """Each part of ``text`` as texts of position and value; a single part may lack the position."""
    parts = [part.strip() for part in text.split(",")]
    if parts == [""]:
        return []
    if len(parts) == 1 and ":" not in parts[0]:
        return [(0.0, parts[0])]
    return [(position.strip() if colon else part, along.strip())
            for part in parts for position, colon, along in [part.partition(":")]]


def _from_sequence(noun: str, value: object, example: str) -> list[tuple[object, object]]:
    if not isinstance(value, (Sequence, np.ndarray)) or isinstance(value, bytes):
        raise LifeError(noun, value, f"is not a list such as {example}")
    pairs = []
    for pair in value:
        if not isinstance(pair, Iterable) or isinstance(pair, (str, bytes)) or len(members := list(pair)) != 2:
            raise LifeError(noun, value, f"has {shown(pair)}, which is not a position with its value")
        pairs.append((members[0], members[1]))
    return pairs


def number_in(noun: str, value: object, part: str, number: object, example: str) -> float:
    """``number``, the position or value that ``part`` says of ``value``; raises LifeError for what is no number."""
    try:
        if isinstance(number, bool):
            raise TypeError
        return float(number) + 0.0      # type: ignore[arg-type]    # makes -0 a plain 0
    except (TypeError, ValueError, OverflowError):
        raise LifeError(noun, value, f"has the {part} {shown(number) or 'nothing'}, which is not a number; "
                                     f"write it like {example}") from None


def _position(noun: str, value: object, position: object, example: str) -> float:
    here = number_in(noun, value, "position", position, example)
    if not 0.0 <= here <= 1.0:
        raise LifeError(noun, value, f"has the position {number_text(here)}, which is outside 0 to 1")
    return here
