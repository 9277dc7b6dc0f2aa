"""A formula as a field in space, evaluated in NumPy: for few places that is sooner done than compiled for the GPU."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from viewer.kit.formula import Formula
from viewer.kit.jumps import stay_apart

Places = NDArray[np.float32]
Values = NDArray[np.float32]

QUICK_SAMPLES, QUICK_NODES = 75**3, 80      # up to which NumPy is quicker than a driver's compiler


@dataclass(frozen=True)
class FieldFunction:
    """``formula`` in x, y and z with ``numbers`` (name, value) for its other names; float32 throughout."""

    formula: Formula
    numbers: tuple[tuple[str, float], ...] = ()

    def is_quick(self, samples: int) -> bool:
        """Whether that many samples are evaluated here sooner than a shader for them is compiled."""
        operations = [node.operation for node in self.formula.nodes]
        slow = "turbulence" in operations or operations.count("noise") > 1
        return samples <= QUICK_SAMPLES and len(operations) <= QUICK_NODES and not slow

    def on_grid(self, samples: Sequence[int], corner: Sequence[float], step: Sequence[float]) -> Values:
        """The values at the points of a lattice, (nz, ny, nx)."""
        along = [np.float32(first) + np.arange(count, dtype=np.float32) * np.float32(each)
                 for count, first, each in zip(samples, corner, step, strict=True)]
        return self._evaluated(self.formula, along[0], along[1][:, None], along[2][:, None, None])

    def at(self, places: Places) -> Values:
        """The values at ``places`` (n, 3)."""
        return self._evaluated(self.formula, *np.ascontiguousarray(places.T))

    def normals(self, places: Places) -> Places:
        """The gradient at ``places`` (n, 3), of length one; zero where there is none."""
        x, y, z = np.ascontiguousarray(places.T)
        slope = np.stack([self._evaluated(part, x, y, z) for part in gradient(self.formula)], axis=1)
        with np.errstate(all="ignore"):
            size = np.sqrt((slope * slope).sum(axis=1, keepdims=True))
            slope /= size
        slope[~((size > 0.0) & (size < np.inf))[:, 0]] = 0.0
        return slope

    def doubtful(self, crossings: Places, A: Values, B: Values, level: float) -> NDArray[np.intp]:
        """Which edges, crossed at ``crossings`` (n, 3), may have a jump there: not near the level as one would expect.

        ``A`` and ``B`` (n,) are the values at their ends, less the level; an end without a value is no jump.
        """
        with np.errstate(all="ignore"):
            near = np.abs(self.at(crossings) - np.float32(level)) <= 0.25 * np.minimum(np.abs(A), np.abs(B))
        return np.flatnonzero(~near & np.isfinite(A) & np.isfinite(B))

    def jumps(self, starts: Places, ends: Places, A: Values, B: Values, level: float) -> NDArray[np.bool_]:
        """Which edges, from ``starts`` to ``ends`` (n, 3), the field jumps over the level: poles and steps.

        As in isosurface/crossing.frag.
        """
        return stay_apart(self.at, starts, ends, A, B, level)

    def _evaluated(self, formula: Formula, x: Values, y: Values, z: Values) -> Values:
        found: Values = formula.evaluate(x=x, y=y, z=z, **dict(self.numbers)).astype(np.float32, copy=False)
        return found


@lru_cache(maxsize=8)
def gradient(formula: Formula) -> tuple[Formula, Formula, Formula]:
    """The derivatives by x, y and z."""
    slopes = formula.gradient()
    return slopes["x"], slopes["y"], slopes["z"]
