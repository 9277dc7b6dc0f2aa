"""A camera that orbits a point: where a scene starts it, and how a hand moves it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

from viewer.engine.matrices import Matrix, look_at, perspective
from viewer.errors import DemoscopeError

DEGREES_PER_HEIGHT = 180.0
STEEPEST_PITCH = 89.0
POSE_LIMITS = {"yaw": (-1e6, 1e6), "pitch": (-STEEPEST_PITCH, STEEPEST_PITCH), "distance": (1e-3, 1e4),
               "target": (-1e4, 1e4)}
LIMITS = {**POSE_LIMITS, "field_of_view": (1.0, 170.0)}


class CameraError(DemoscopeError):
    """A place where the camera cannot stand."""


@dataclass(frozen=True)
class Orbit:
    """A pose: turned by ``yaw`` about the vertical, raised by ``pitch``, ``distance`` from ``target``.

    Angles and the vertical field of view in degrees. Yaw 0 looks along -z, yaw 90 along -x. Raises
    CameraError for a place where no camera can stand.
    """

    yaw: float = 30.0
    pitch: float = 20.0
    distance: float = 4.0
    target: tuple[float, float, float] = (0.0, 0.0, 0.0)
    field_of_view: float = 35.0

    def __post_init__(self) -> None:
        for name, (low, high) in LIMITS.items():
            value = getattr(self, name)
            count = 3 if name == "target" else 1
            numbers = value if name == "target" else [value]
            if not _are_numbers(numbers, count) or not all(low <= number <= high for number in numbers):
                wanted = "three numbers" if name == "target" else "a number"
                raise CameraError(f"camera {name} = {value} is not {wanted} from {low:g} to {high:g}")

    def moved(self, changes: Mapping[str, Any]) -> Orbit:
        """This pose with other ``yaw``, ``pitch``, ``distance`` or ``target``; raises CameraError for anything else."""
        for name in changes:
            if name not in POSE_LIMITS:
                raise CameraError(f"camera has {name}, which is none of {', '.join(POSE_LIMITS)}")
        return replace(self, **changes)


def _are_numbers(values: Any, count: int) -> bool:
    return (isinstance(values, (list, tuple, np.ndarray)) and len(values) == count
            and all(isinstance(value, Real) and not isinstance(value, bool) for value in values))


class OrbitCamera:
    """A pose that drags, pans and zooms, and goes back to where it started."""

    def __init__(self, start: Orbit) -> None:
        self.start = start
        self.reset()

    def reset(self) -> None:
        """Back to the starting pose."""
        self.pose(self.start)

    def pose(self, pose: Orbit) -> None:
        """Take ``pose`` over."""
        self.yaw, self.pitch, self.distance = float(pose.yaw), float(pose.pitch), float(pose.distance)
        self.target = np.asarray(pose.target, dtype=float)
        self.field_of_view = float(pose.field_of_view)

    def stand(self, place: Orbit | Mapping[str, Any]) -> None:
        """Take a pose over, or the start with some of its ``yaw``, ``pitch``, ``distance``, ``target`` changed."""
        self.pose(place if isinstance(place, Orbit) else self.start.moved(place))

    def drag(self, right: float, down: float) -> None:
        """Turn by a drag given in heights of the picture."""
        self.yaw = (self.yaw - right * DEGREES_PER_HEIGHT) % 360.0
        self.pitch = float(np.clip(self.pitch + down * DEGREES_PER_HEIGHT, -STEEPEST_PITCH, STEEPEST_PITCH))

    def pan(self, right: float, down: float, aspect: float = 1.0) -> None:
        """Move the target so that it follows a drag given in heights of a picture of that ``aspect``."""
        height = 2.0 * self.distance * self._half_height(aspect)
        across, up = self.view()[:3, 0], self.view()[:3, 1]
        self.target = self.target + height * (down * up - right * across)

    def zoom(self, notches: float) -> None:
        """Come closer by ``notches`` of a wheel; fractions, as touchpads send them, are welcome."""
        nearest, farthest = self.start.distance / 20.0, self.start.distance * 20.0
        self.distance = float(np.clip(self.distance * 0.9 ** notches, nearest, farthest))

    @property
    def look(self) -> tuple[float, ...]:
        """All that a picture depends on of the camera, to tell whether it moved."""
        return (self.yaw, self.pitch, self.distance, self.field_of_view, *map(float, self.target))

    @property
    def eye(self) -> NDArray[np.float64]:
        """Where the camera is, (3,)."""
        yaw, pitch = math.radians(self.yaw), math.radians(self.pitch)
        away = (math.sin(yaw) * math.cos(pitch), math.sin(pitch), math.cos(yaw) * math.cos(pitch))
        return np.asarray(self.target + self.distance * np.array(away))

    def view(self) -> Matrix:
        """World to camera, (4, 4), in the row order that GL reads as columns."""
        return look_at(self.eye, self.target)

    def projection(self, aspect: float, middle: tuple[float, float] = (0.0, 0.0)) -> Matrix:
        """Camera to clip space, (4, 4), for a picture ``aspect`` times as wide as high.

        A picture narrower than a square keeps its horizontal field of view, so nothing is cut off. The
        target appears at ``middle``, each -1 to 1, as through a lens that is shifted, not turned.
        """
        field_of_view = math.degrees(2.0 * math.atan(self._half_height(aspect)))
        matrix = perspective(field_of_view, aspect, self.distance / 50.0, self.distance * 50.0)
        matrix[2, :2] -= middle
        return matrix

    def ray(self, place: tuple[float, float], aspect: float,
            middle: tuple[float, float] = (0.0, 0.0)) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The eye, and the direction of length one in which it sees ``place`` of the picture, each -1 to 1."""
        half = self._half_height(aspect)
        across, up = half * aspect * (place[0] - middle[0]), half * (place[1] - middle[1])
        direction = self.view()[:3, :3] @ np.array([across, up, -1.0])
        return self.eye, direction / np.linalg.norm(direction)

    def _half_height(self, aspect: float) -> float:
        """Half of what the picture shows from bottom to top at distance 1."""
        return math.tan(math.radians(self.field_of_view) / 2.0) / min(1.0, aspect)
