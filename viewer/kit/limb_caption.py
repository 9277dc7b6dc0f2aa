"""What stands under a limb: how it is skinned, how thin it has become, and its cross section before and after."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from viewer.kit.card import INK, QUIET, Line, Rectangle
from viewer.kit.limb_measure import LimbNumbers
from viewer.kit.quaternion import Numbers

BEFORE = "#9aa0a8"
BOTTOM, TOP = -0.965, -0.635         # of the plates
WIDEST = 1.32                        # times as wide as high would a single plate be without its text
PAD = 0.035


@dataclass(frozen=True)
class Outline:
    """A cross section (s, 2, 2) around the limb's axis, in any unit, and a point (2,) of the skin to tell its turn."""

    segments: Numbers
    mark: Numbers


@dataclass(frozen=True)
class Caption:
    """A plate, its text, and the drawings on it: segments (s, 2, 2) in the picture, their width and colour."""

    rectangle: Rectangle
    lines: tuple[Line, ...]
    drawings: tuple[tuple[Numbers, float, str], ...]


def caption(column: int, columns: int, title: str, color: str, numbers: LimbNumbers | None,
            outlines: tuple[Outline, Outline] | None, aspect: float) -> Caption:
    """The caption in a ``column`` of so many, its cross section before and after in grey and in ``color``."""
    height = TOP - BOTTOM
    square = height / aspect
    width = min(2.0 / columns - 0.04, 0.86 * 2.0 / 3.0 if columns > 1 else 1.15 / min(1.4, aspect))
    middle = -1.0 + (2.0 * column + 1.0) / columns
    rectangle = (middle - 0.5 * width, BOTTOM, middle + 0.5 * width, TOP)
    shown = outlines if outlines and width > 2.4 * square else None
    text_left = rectangle[0] + (square + 0.3 * PAD if shown else PAD / aspect)
    size = min(0.92, 0.92 * (rectangle[2] - text_left) * aspect / 0.78)
    lines = [Line(title, (text_left, TOP - 0.26 * height), size, color=INK, bold=True)]
    lines += [Line(words, (text_left, TOP - part * height), 0.92 * size, color=QUIET)
              for words, part in zip(_words(numbers), (0.53, 0.77), strict=False)]
    drawings = _drawn(shown, (rectangle[0] + 0.5 * square, BOTTOM + 0.5 * height), 0.5 * height - 0.6 * PAD, aspect,
                      color) if shown else ()
    return Caption(rectangle, tuple(lines), drawings)


def _words(numbers: LimbNumbers | None) -> Sequence[str]:
    if numbers is None:
        return ()
    thinnest = f"thinnest {numbers.min_radius_ratio:.2f}" if math.isfinite(numbers.min_radius_ratio) else ""
    volume = f"volume {100.0 * numbers.volume_ratio:.0f} %" if math.isfinite(numbers.volume_ratio) else ""
    return [words for words in (thinnest, volume) if words]


def _drawn(outlines: tuple[Outline, Outline], middle: tuple[float, float], half: float, aspect: float,
           color: str) -> tuple[tuple[Numbers, float, str], ...]:
    """Both outlines, each with a line from the axis to its mark, as large as their square allows."""
    reach = max(float(np.abs(outline.segments).max(initial=1e-9)) for outline in outlines)
    scale = half / reach * np.array([1.0 / aspect, 1.0])
    drawn: list[tuple[Numbers, float, str]] = []
    for outline, width, ink in zip(outlines, (4.0, 7.0), (BEFORE, color), strict=True):
        spoke = np.stack([np.zeros(2), outline.mark])[None]
        drawn += [(middle + scale * segments, stroke, ink)
                  for segments, stroke in ((outline.segments, width), (spoke, 0.7 * width)) if len(segments)]
    return tuple(drawn)
