"""Ball-and-rod models for teaching: what is drawn of a cell, a lattice or a skeleton, as plain arrays.

Every part stands in a frame (across, up, size): a place in the picture, each -1 to 1, and how large a
unit cell is there, in half heights of the picture; it turns with the camera. Size 0 means the world itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Frame: TypeAlias = tuple[float, float, float]
Rgb: TypeAlias = tuple[float, float, float]

WORLD: Frame = (0.0, 0.0, 0.0)
RODS, BALLS, FACES = 13, 10, 12         # numbers of a rod, of a ball, of a corner of a face


def rgb(code: str) -> Rgb:
    """``#rrggbb`` as three numbers, 0 to 1."""
    red, green, blue = bytes.fromhex(code.removeprefix("#"))
    return red / 255.0, green / 255.0, blue / 255.0


class Model:
    """Rods (from, to, radius), balls (centre, radius) and two-sided triangles, each with a frame and a colour."""

    def __init__(self) -> None:
        self._rods: list[NDArray[np.float32]] = []
        self._balls: list[NDArray[np.float32]] = []
        self._faces: list[NDArray[np.float32]] = []

    def rods(self, starts: ArrayLike, ends: ArrayLike, radius: float, color: Rgb, frame: Frame = WORLD) -> None:
        """Add rods from ``starts`` (n, 3) to ``ends`` (n, 3)."""
        starts = np.asarray(starts, np.float32).reshape(-1, 3)
        rest = np.broadcast_to(np.array([radius, *frame, *color], np.float32), (len(starts), 7))
        self._rods.append(np.hstack([starts, np.asarray(ends, np.float32).reshape(-1, 3), rest]))

    def balls(self, centers: ArrayLike, radius: float, color: Rgb, frame: Frame = WORLD) -> None:
        """Add balls around ``centers`` (n, 3)."""
        centers = np.asarray(centers, np.float32).reshape(-1, 3)
        rest = np.broadcast_to(np.array([radius, *frame, *color], np.float32), (len(centers), 7))
        self._balls.append(np.hstack([centers, rest]))

    def faces(self, corners: ArrayLike, color: Rgb, frame: Frame = WORLD) -> None:
        """Add triangles with ``corners`` (m, 3, 3), counter-clockwise as seen from their outside."""
        corners = np.asarray(corners, np.float32).reshape(-1, 3, 3)
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
        rest = np.broadcast_to(np.array([*frame, *color], np.float32), (3 * len(corners), 6))
        self._faces.append(np.hstack([corners.reshape(-1, 3), np.repeat(normals, 3, axis=0), rest]))

    def box(self, low: ArrayLike, high: ArrayLike, radius: float, color: Rgb, frame: Frame = WORLD) -> None:
        """Add the twelve edges of a box."""
        starts, ends = box_edges()
        low, high = np.asarray(low, np.float32), np.asarray(high, np.float32)
        self.rods(low + starts * (high - low), low + ends * (high - low), radius, color, frame)

    def extend(self, other: Model) -> None:
        """Add all parts of another model."""
        self._rods += other._rods
        self._balls += other._balls
        self._faces += other._faces

    def arrays(self) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float32]]:
        """Rods (n, 13), balls (n, 10) and the corners of faces (n, 12)."""
        return _joined(self._rods, RODS), _joined(self._balls, BALLS), _joined(self._faces, FACES)


def box_edges() -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Where the twelve edges of the unit box start and end, (12, 3) each."""
    corners = np.array([[c & 1, c >> 1 & 1, c >> 2 & 1] for c in range(8)], np.float32)
    pairs = [(c, c | 1 << axis) for axis in range(3) for c in range(8) if not c >> axis & 1]
    starts, ends = zip(*pairs, strict=True)
    return corners[list(starts)], corners[list(ends)]


def in_picture(points: ArrayLike, frame: Frame, view: NDArray[np.float64], aspect: float) -> NDArray[np.float64]:
    """Where points (n, 3) of a frame's unit cell appear in the picture, (n, 2), as insets/placing.glsl has it."""
    turned = (np.asarray(points, np.float64).reshape(-1, 3) - 0.5) @ view[:3, :3]
    return np.asarray(np.array([frame[0], frame[1]]) + frame[2] * turned[:, :2] / np.array([aspect, 1.0]))


def _joined(parts: Sequence[NDArray[np.float32]], width: int) -> NDArray[np.float32]:
    return np.concatenate(parts) if parts else np.empty((0, width), np.float32)
