"""Typesetting: labels become rectangles of whole pixels, each a letter or the plate beneath a label's letters."""

from __future__ import annotations

import unicodedata
from array import array
from collections.abc import Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from viewer.engine.inscriptions import Inscription
from viewer.engine.lettering_faces import Faces
from viewer.engine.lettering_sheet import LARGEST_EXTENT, Glyph, Sheet, SheetFullError

SMALLEST_STANDARD_EM = 12.0     # in pixels
EMS_PER_HEIGHT = 36.0
EM_LIMITS = (9, 320)
LINE_SPACING = 1.25             # in ems, as the following
DESCENT = 0.21
PLATE_MARGIN = (0.40, 0.18)
PLATE_RADIUS = 0.25
MOST_LAYOUTS = 4096
MOST_RECTANGLES = 100_000

# As ``studio/label.vert`` reads them: the place of the label, then a rectangle from its pixel, where on the
# sheet its letter is, the radius of a plate's corners (-1 for a letter), and its colour.
RECTANGLE = np.dtype([("anchor", "f4", 4), ("rectangle", "f4", 4), ("sheet", "f4", 2), ("radius", "f4"),
                      ("color", "u1", 4)])
PLACE = "i"
PLACE_BYTES = 7 * array(PLACE).itemsize
FARTHEST = 1e30                 # a single-precision number, far beyond any picture


class Layout(NamedTuple):
    """A text's rectangles from its lower left corner, the plate's first: 7 of ``PLACE`` each, as in ``RECTANGLE``."""

    rectangles: bytes
    width: int
    height: int


class Typesetter:
    """Sets labels with the glyphs of a sheet, which it starts anew when it is full."""

    def __init__(self) -> None:
        self.sheet = Sheet()
        self._faces = cache(Faces)
        self._layouts: dict[tuple[str, int, bool, float], Layout] = {}

    def set(self, inscriptions: Sequence[Inscription], picture_height: int) -> NDArray[Any]:
        """The rectangles of all ``inscriptions`` in a picture of that height, as ``RECTANGLE``, in drawing order."""
        for extent in (self.sheet.extent, LARGEST_EXTENT):
            try:
                return self._rectangles(inscriptions, picture_height)
            except SheetFullError:
                self.sheet = Sheet(extent)
                self._layouts.clear()
        return self._as_many_as_fit(inscriptions, picture_height)

    def _as_many_as_fit(self, inscriptions: Sequence[Inscription], picture_height: int) -> NDArray[Any]:
        """The first of ``inscriptions``, as far as the largest sheet has room for them."""
        while inscriptions:
            try:
                return self._rectangles(inscriptions, picture_height)
            except SheetFullError:
                inscriptions = inscriptions[:len(inscriptions) // 2]
        return np.zeros(0, RECTANGLE)

    def _rectangles(self, inscriptions: Sequence[Inscription], picture_height: int) -> NDArray[Any]:
        standard = max(SMALLEST_STANDARD_EM, picture_height / EMS_PER_HEIGHT)
        layouts = [self._layout(one, round(min(max(one.size * standard, EM_LIMITS[0]), EM_LIMITS[1])))
                   for one in inscriptions]
        parts = [layout.rectangles if one.plate else layout.rectangles[PLACE_BYTES:]
                 for one, layout in zip(inscriptions, layouts, strict=True)]
        counts = np.array([len(part) // PLACE_BYTES for part in parts], np.intp)
        each = np.zeros(len(parts), RECTANGLE)
        each["anchor"] = np.clip([one.anchor for one in inscriptions], -FARTHEST, FARTHEST)
        each["color"] = [one.color for one in inscriptions]
        shifts = [_shift(one, layout) for one, layout in zip(inscriptions, layouts, strict=True)]
        each["rectangle"][:, :2] = np.clip(shifts, -FARTHEST, FARTHEST)
        found = np.repeat(each, counts)
        _place(found, np.frombuffer(b"".join(parts), PLACE).reshape(-1, 7))
        plated = np.array([one.plate is not None for one in inscriptions])
        plates = np.array([one.plate or one.color for one in inscriptions], np.uint8)
        found["color"][(np.cumsum(counts) - counts)[plated]] = plates[plated]
        return found[:MOST_RECTANGLES]

    def _layout(self, one: Inscription, em: int) -> Layout:
        side = one.align[0] if "\n" in one.text else 0.0
        key = (one.text, em, one.bold, side)
        known = self._layouts.get(key)
        if known is None:
            if len(self._layouts) >= MOST_LAYOUTS:
                self._layouts.clear()
            known = self._layouts[key] = self._laid_out(*key)
        return known

    def _laid_out(self, text: str, em: int, bold: bool, side: float) -> Layout:
        """The lines of ``text`` beneath each other, the shorter ones at ``side`` from left (0) to right (1)."""
        lines = [self._line(line, em, bold) for line in text.split("\n")]
        widths = [sum(glyph.advance for glyph in line) for line in lines]
        capital = self.sheet.glyphs("H", em, bold, self._faces(bold))[0].height
        width, spacing, descent = max(widths), round(LINE_SPACING * em), round(DESCENT * em)
        height = capital + 2 * descent + (len(lines) - 1) * spacing
        places = array(PLACE, _plate(width, height, em))
        for number, line in enumerate(lines):
            pen = round(side * (width - widths[number]))
            baseline = descent + (len(lines) - 1 - number) * spacing
            for glyph in line:
                if glyph.width:
                    places.extend((pen + glyph.left, baseline + glyph.bottom, *glyph[2:6], -1))
                pen += glyph.advance
        return Layout(places.tobytes(), width, height)

    def _line(self, line: str, em: int, bold: bool) -> list[Glyph]:
        faces, line = self._faces(bold), unicodedata.normalize("NFC", line.expandtabs(4).rstrip("\r"))
        return [glyph for character in line for glyph in self.sheet.glyphs(character, em, bold, faces)]


def _shift(one: Inscription, layout: Layout) -> tuple[float, float]:
    """From the pixel of the anchor to the lower left corner of the text, in whole pixels."""
    return -((one.align[0] * layout.width + 0.5) // 1.0), -((one.align[1] * layout.height + 0.5) // 1.0)


def _plate(width: int, height: int, em: int) -> tuple[int, ...]:
    across, up = (round(margin * em) for margin in PLATE_MARGIN)
    return -across, -up, width + 2 * across, height + 2 * up, 0, 0, round(PLATE_RADIUS * em)


def _place(found: NDArray[Any], rectangles: NDArray[np.int32]) -> None:
    found["rectangle"][:, :2] += rectangles[:, :2]
    found["rectangle"][:, 2:] = rectangles[:, 2:4]
    found["sheet"], found["radius"] = rectangles[:, 4:6], rectangles[:, 6]
