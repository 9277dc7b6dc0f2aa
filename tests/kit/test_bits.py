"""Bits in words, against plain arrays of flags."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from viewer.kit.bits import WORD, moved_down, packed, places_of_ones

SIZES = [0, 1, 7, 8, 63, 64, 65, 127, 128, 129, 500]
SHIFTS = [0, 1, 7, 8, 63, 64, 65, 100, 127, 128, 129, 499, 500, 5000]


def random_flags(size: int, share: float = 0.3) -> NDArray[np.bool_]:
    """Some of them set."""
    return np.random.default_rng(size).random(size) < share


def unpacked(words: NDArray[np.uint64]) -> NDArray[np.bool_]:
    """All bits of some words, each taken out by arithmetic."""
    return np.array([bool(int(word) >> place & 1) for word in words for place in range(WORD)], np.bool_)


@pytest.mark.parametrize("size", SIZES)
def test_flags_keep_their_places(size: int) -> None:
    """Flag n is bit n % 64 of word n // 64, and what is beyond the last flag is 0."""
    flags = random_flags(size)
    words = packed(flags)
    assert words.dtype == np.uint64 and len(words) == -(-size // WORD)
    assert np.array_equal(unpacked(words)[:size], flags) and not unpacked(words)[size:].any()


def test_any_byte_but_zero_counts() -> None:
    """Of arrays of any shape, in the order of the flat array."""
    values = np.random.default_rng(1).integers(0, 3, (5, 6, 7), np.uint8)
    assert np.array_equal(packed(values), packed((values > 0).ravel()))
    assert np.array_equal(packed(values.T), packed((values.T > 0).ravel()))
    assert np.array_equal(packed(values[::2, ::-1]), packed((values[::2, ::-1] > 0).ravel()))


@pytest.mark.parametrize("size", SIZES)
def test_bits_move_down(size: int) -> None:
    """By any number of places, across words; zeros follow, and the words given stay as they are."""
    flags = random_flags(size, 0.5)
    words = packed(flags)
    for places in SHIFTS:
        expected = np.zeros(len(words) * WORD, np.bool_)
        expected[:max(0, size - places)] = flags[places:]
        assert np.array_equal(unpacked(moved_down(words, places)), expected), places
    assert np.array_equal(words, packed(flags))


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("share", [0.0, 0.01, 0.5, 1.0])
def test_places_of_ones_ascend(size: int, share: float) -> None:
    """All of them, whether few or many."""
    flags = random_flags(size, share)
    found = places_of_ones(packed(flags))
    assert found.dtype == np.intp and np.array_equal(found, np.flatnonzero(flags))
