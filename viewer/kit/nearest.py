"""How far the next one is away, in a crowd."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray


def nearest_distances(places: ArrayLike) -> NDArray[np.float64]:
    """How far from each of ``places`` (n, 3) the nearest other one is, (n,); infinite where there is no other."""
    from scipy.spatial import cKDTree

    places = np.asarray(places, np.float64)
    distances, _ = cKDTree(places).query(places, k=2)
    return np.asarray(distances[:, 1])
