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
BOTTOM, HEIGHT = -0.965, 0.33       # of the plates, where picture and text stand side by side
LONGEST, LETTER = 16, 0.55          # letters of a title, as a rule at most, and how wide one is in ems
LARGEST, SMALLEST = 1.08, 0.72      # of the text, in standard letter heights; below that it goes under the picture
ROW = 1.42                          # from one line to the next, in ems
PAD = 0.035
CRAMPED = 0.09                      # letters larger than that leave room for two lines alone


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


def caption(middle: float, room: float, title: str, color: str, numbers: LimbNumbers | None,
            outlines: tuple[Outline, Outline] | None, aspect: float, em: float) -> Caption:
    """The caption around ``middle`` across, at most ``room`` wide, in half heights of a picture of that ``aspect``.

    ``em`` is a standard letter height, in the same unit. The cross section is drawn before and after, in grey and
    in ``color``. The text stands beside it, or where there is no room for it under it; in a low picture it stands
    alone, and where it could not be read there is none.
    """
    cramped = em > CRAMPED
    outlines, words = (None, _words(numbers)[:1]) if cramped else (outlines, _words(numbers))
    longest = max(LONGEST, len(title)) * LETTER
    width = min(room - 0.05, HEIGHT + 2.0 * PAD + LARGEST * longest * em)
    beside = min(LARGEST, (width - (HEIGHT if outlines else 0.0) - 2.0 * PAD) / (longest * em),
                 math.inf if cramped else HEIGHT / (3.7 * ROW * em))
    stacked = beside < SMALLEST and outlines is not None
    square = min(width, 0.38) if stacked else HEIGHT if outlines else 0.0
    size = min(LARGEST, (width - 2.0 * PAD) / (longest * em)) if stacked else beside
    legible = size > 0.35
    row = ROW * em * max(size, 0.0)
    text_height = (len(words) + 1.0) * row + 0.5 * PAD
    height = square + text_height * legible if stacked else text_height if cramped else HEIGHT
    top, left = BOTTOM + height, middle - 0.5 * width / aspect
    text_left = left + (PAD if stacked or not square else square + 0.3 * PAD) / aspect
    spacing = row if stacked or cramped else 1.12 * row
    first = top - square - 0.4 * row if stacked else top - 0.5 * height + 0.5 * len(words) * spacing
    lines = [Line(title, (text_left, first), size, color=INK, bold=True)]
    lines += [Line(each, (text_left, first - place * spacing), 0.92 * size, color=QUIET)
              for place, each in enumerate(words, 1)]
    center = (middle if stacked else left + 0.5 * square / aspect, top - 0.5 * square)
    drawings = _drawn(outlines, center, 0.5 * square - 0.9 * PAD, aspect, color) if outlines else ()
    return Caption((left, BOTTOM, left + width / aspect, top), tuple(lines) if legible else (), drawings)


def _words(numbers: LimbNumbers | None) -> Sequence[str]:
    if numbers is None:
        return ()
    thinnest = f"thinnest {numbers.thinnest:.2f}" if math.isfinite(numbers.thinnest) else ""
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
