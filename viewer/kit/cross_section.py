"""Cross sections: where a plane cuts a mesh at rest, and where the same points of the skin are once it is posed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from viewer.kit.limb import Limb, size_of
from viewer.kit.mesh import Triangles, Vertices
from viewer.kit.quaternion import Numbers

MOSTLY = 0.5            # of a vertex's weight that a limb's two bones hold where the limb is cut


@dataclass(frozen=True, eq=False)
class CrossSection:
    """Segments between points of a mesh's edges: ``ends`` (s, 2, 2) their vertices, ``parts`` (s, 2) how far along."""

    ends: NDArray[np.int64]
    parts: Numbers

    def points(self, vertices: NDArray[np.floating[Any]]) -> Numbers:
        """Where the segments start and end, (s, 2, 3), with the vertices (n, 3) of any pose."""
        first, second = (vertices[self.ends[..., end]].astype(np.float64) for end in range(2))
        return np.asarray(first + self.parts[..., None] * (second - first))


def cut(vertices: Vertices, triangles: Triangles, origin: Numbers, normal: Numbers) -> CrossSection:
    """Where the plane through ``origin`` (3,) at right angles to ``normal`` (3,) cuts triangles (m, 3)."""
    height = (vertices - origin) @ normal
    above = height[triangles] >= 0.0
    crossed = triangles[above.any(axis=1) & ~above.all(axis=1)].astype(np.int64)
    side = height[crossed] >= 0.0
    alone = np.argmax(side == (side.sum(axis=1) == 1)[:, None], axis=1)     # the corner that the plane parts from two
    rows = np.arange(len(crossed))
    corner = crossed[rows, alone]
    others = np.stack([crossed[rows, (alone + 1) % 3], crossed[rows, (alone + 2) % 3]], axis=1)
    ends = np.stack([np.broadcast_to(corner[:, None], others.shape), others], axis=2)
    parts = height[ends[..., 0]] / (height[ends[..., 0]] - height[ends[..., 1]])
    return CrossSection(ends, parts)


def limb_section(limb: Limb, along: float) -> CrossSection:
    """The cross section of a limb at a place from 0, its upper joint, to 1, the lower."""
    triangles = limb.mesh.triangles[(limb.held > MOSTLY)[limb.mesh.triangles].any(axis=1)]
    origin = limb.start + along * (limb.end - limb.start)
    return cut(limb.mesh.positions.astype(np.float64), triangles, origin, limb.axis)


def flattened(limb: Limb, points: Numbers, along: float, upper: Numbers | None = None) -> Numbers:
    """``points`` (..., 3) as seen along the axis, (..., 2), in lengths of the limb, from where the axis runs.

    ``upper`` (4, 4) has moved the limb as a whole since it was bound, and with it the axis and its two directions.
    """
    moved = np.eye(4) if upper is None else upper
    size = size_of(moved)
    origin = moved[:3, :3] @ (limb.start + along * (limb.end - limb.start)) + moved[:3, 3]
    frame = np.stack([moved[:3, :3] @ direction for direction in limb.across]) / size
    return np.asarray((points - origin) @ frame.T / (size * limb.length))
