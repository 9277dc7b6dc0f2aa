"""One bit for each sample of a grid, 64 to a word: yes and no for millions of samples at once."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Words: TypeAlias = NDArray[np.uint64]
Flags: TypeAlias = NDArray[np.uint8] | NDArray[np.bool_]

WORD = 64


def packed(flags: Flags) -> Words:
    """Bytes that are 0 or not, as bits; what the last word has beyond them is 0."""
    flat = flags.reshape(-1)
    words = np.zeros(-(-flat.size // WORD), np.uint64)
    words.view(np.uint8)[:-(-flat.size // 8)] = np.packbits(flat, bitorder="little")
    return words if np.little_endian else words.byteswap()


def moved_down(words: Words, places: int) -> Words:
    """Each bit at the place where its ``places``-th successor was; 0 follows from the end."""
    whole, part = divmod(places, WORD)
    found = np.zeros_like(words)
    length = len(words) - whole
    if length <= 0:
        return found
    np.right_shift(words[whole:], np.uint64(part), out=found[:length])
    if part:
        found[:length - 1] |= words[whole + 1:] << np.uint64(WORD - part)
    return found


def places_of_ones(words: Words) -> NDArray[np.intp]:
    """Where the ones are, ascending. Made for words of which most are 0."""
    parts = (words if np.little_endian else words.byteswap()).view(np.uint8)
    some = np.flatnonzero(parts != 0)
    within = np.flatnonzero(np.unpackbits(parts[some], bitorder="little").view(np.bool_))
    found: NDArray[np.intp] = (some[within >> 3] << 3) | (within & 7)
    return found


def at(words: Words, place: int) -> bool:
    """Whether one bit is set."""
    return bool(int(words[place // WORD]) >> place % WORD & 1)
