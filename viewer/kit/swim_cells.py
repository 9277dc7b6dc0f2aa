"""A grid of cells by which fish find their neighbours without looking at everybody."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Axes: TypeAlias = tuple[float, float, float]
MOST_CELLS = 2**18
PARTS = 2       # of a cell along x: rows of cells are looked along from there to there, and no farther than need be


@dataclass(frozen=True)
class CellGrid:
    """Cubes of side ``cell_size`` over a box around the origin, each cut into ``PARTS`` along x, and a border of such.

    ``size`` counts the cells along x, y and z, the border's too. The cell (i, j, k) has the number
    i + size_x (j + size_y k). Whoever sees no farther than ``cell_size`` sees nobody but in nine rows: the own one
    and those beside it, from ``PARTS`` cells before to ``PARTS`` cells behind.
    """

    half_axes: Axes
    cell_size: float
    size: tuple[int, int, int]

    @property
    def count(self) -> int:
        """How many cells there are."""
        return self.size[0] * self.size[1] * self.size[2]

    def sort(self, places: NDArray[np.float32]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """The order (n,) of the cells that at most 65,535 ``places`` (n, 3) lie in, and the cell of each in that order.

        Who lies in the same cell keeps its order; who lies outside the box counts to the nearest cell within.
        """
        x, y, z = (self._along(axis, places[:, axis]) for axis in range(3))
        # Numbers are sorted several times faster than it is found out how: so each carries its index along.
        keys = np.sort((x + self.size[0] * (y + self.size[1] * z)) << 16 | np.arange(len(places)))
        return keys & 0xffff, keys >> 16

    def runs(self, cells: NDArray[np.int64]) -> NDArray[np.uint16]:
        """Of fish that lie in ``cells`` (n,), in order, those near each cell in its row: (count, 2).

        The first of them and the first beyond them. Cells at the ends of the rows, where nobody is, have none.
        """
        beyond = np.cumsum(np.bincount(cells, minlength=self.count)).astype(np.uint16)
        runs = np.zeros((self.count, 2), np.uint16)
        runs[PARTS + 1:, 0] = beyond[:-PARTS - 1]
        runs[:-PARTS, 1] = beyond[PARTS:]
        return runs

    def _along(self, axis: int, places: NDArray[np.float32]) -> NDArray[np.int64]:
        """The cells along an axis, (n,)."""
        parts = PARTS if axis == 0 else 1
        cells = ((places + np.float32(self.half_axes[axis])) * np.float32(parts / self.cell_size)).astype(np.int64)
        return np.asarray(np.minimum(np.maximum(cells, 0) + parts, self.size[axis] - parts - 1), np.int64)


@lru_cache(maxsize=8)
def cell_grid(half_axes: Axes, sight: float) -> CellGrid:
    """The grid for fish that stay within ``half_axes`` of the origin and see as far as ``sight``.

    Its cells are as small as that, or as small as ``MOST_CELLS`` of them can be.
    """
    cell = sight
    while True:
        x, y, z = (int(2.0 * half / cell) + 1 for half in half_axes)
        size = PARTS * (x + 2), y + 2, z + 2
        if size[0] * size[1] * size[2] <= MOST_CELLS:
            return CellGrid(half_axes, cell, size)
        cell *= 1.05
