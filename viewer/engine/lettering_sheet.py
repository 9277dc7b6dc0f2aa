"""The sheet: every letter in use, drawn once, side by side in one picture of coverages."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from viewer.engine.lettering_faces import Faces, Raster

EXTENT = 1024
LARGEST_EXTENT = 4096


class SheetFullError(Exception):
    """There is no room for another letter."""


class Glyph(NamedTuple):
    """A letter on the sheet, at ``x``, ``y``; ``left`` and ``bottom`` are where it lies from the pen."""

    left: int
    bottom: int
    width: int
    height: int
    x: int
    y: int
    advance: int


class Sheet:
    """Letters in rows, from the bottom up, each row as high as its highest letter so far.

    ``coverage`` (extent, extent) is what the GPU needs of it; ``revision`` grows with it.
    """

    def __init__(self, extent: int = EXTENT) -> None:
        self.extent = extent
        self.coverage: NDArray[np.uint8] = np.zeros((extent, extent), np.uint8)
        self.revision = 0
        self._glyphs: dict[tuple[str, int, bool], tuple[Glyph, ...]] = {}
        self._x = self._y = self._row_height = 0

    @property
    def used(self) -> int:
        """How many rows of pixels hold letters."""
        return self._y + self._row_height

    def glyphs(self, character: str, em: int, bold: bool, faces: Faces) -> tuple[Glyph, ...]:
        """What shows ``character``: mostly one glyph. Raises SheetFullError."""
        known = self._glyphs.get((character, em, bold))
        if known is None:
            rasters = [face.raster(one, em) for face, one in faces.spelled(character)]
            known = tuple(self._placed(raster) for raster in rasters)
            self._glyphs[character, em, bold] = known
        return known

    def _placed(self, raster: Raster) -> Glyph:
        height, width = raster.coverage.shape
        if self._x + width > self.extent:
            self._x, self._y, self._row_height = 0, self._y + self._row_height, 0
        if self._y + height > self.extent or width > self.extent:
            raise SheetFullError
        x, y = self._x, self._y
        self.coverage[y:y + height, x:x + width] = raster.coverage
        self._x, self._row_height = x + width, max(self._row_height, height)
        self.revision += 1
        return Glyph(raster.left, raster.bottom, width, height, x, y, raster.advance)
