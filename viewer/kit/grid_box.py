"""Where a box of samples stands in the world: in the middle, its longest side from minus to plus a given size."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class GridBox:
    """``samples`` along x, y and z, the first at ``corner`` of the field's own space, ``step`` apart."""

    samples: Sequence[int]
    corner: Sequence[float]
    step: Sequence[float]
    size: float = 1.0

    @property
    def reach(self) -> Vector:
        """Half the box's size in the field's own space, (3,)."""
        return np.asarray(0.5 * np.asarray(self.step) * (np.asarray(self.samples) - 1))

    @property
    def middle(self) -> Vector:
        """The box's middle in the field's own space, (3,)."""
        return np.asarray(self.corner) + self.reach

    @property
    def scale(self) -> float:
        """How large a unit of the field's space is in the world."""
        return self.size / float(self.reach.max())

    @property
    def cell_size(self) -> float:
        """The shortest side of a cell, in the world."""
        return self.scale * min(self.step)

    def in_world(self, places: ArrayLike) -> Vector:
        """Where places given in samples (n, 3) stand."""
        return np.asarray((np.asarray(places, np.float64) * np.asarray(self.step) - self.reach) * self.scale)

    def ray(self, origin: Vector, direction: Vector) -> tuple[Vector, Vector]:
        """A ray of the world, in samples."""
        step = np.asarray(self.step)
        return (origin / self.scale + self.reach) / step, direction / (self.scale * step)

    def holds_cell(self, cell: Sequence[int]) -> bool:
        """Whether there is a cell of this number along x, y and z."""
        return all(0 <= at < count - 1 for at, count in zip(cell, self.samples, strict=True))
