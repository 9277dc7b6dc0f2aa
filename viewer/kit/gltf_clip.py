"""Animation clips: keys in time for the places, turns and sizes of joints, and what lies between them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from viewer.kit import quaternion
from viewer.kit.rig import Skeleton

Numbers = NDArray[np.float64]


class Place(NamedTuple):
    """Where a time lies among keys: between numbers ``key`` and ``following``, a ``share`` of the ``step`` in seconds.

    Each (t,), one for each timeline of a clip.
    """

    key: NDArray[np.intp]
    following: NDArray[np.intp]
    share: Numbers
    step: Numbers


@dataclass(frozen=True, eq=False)
class Track:
    """Channels (c,) that move the same property in the same way: ``path`` is one of PATHS.

    Channel c moves joint ``joints[c]`` by the keys of timeline ``timelines[c]``, whose values begin at row
    ``first[c]`` of ``values`` (v, width); of cubic splines (v, 3, width): incoming tangent, value, outgoing tangent.
    """

    path: str
    interpolation: str
    joints: NDArray[np.int32]
    timelines: NDArray[np.intp]
    first: NDArray[np.intp]
    values: NDArray[np.float32]

    def at(self, place: Place) -> Numbers:
        """The channels' values (c, width) where the timelines are at ``place``."""
        share, step = (part[self.timelines, None] for part in (place.share, place.step))
        before = self.values[self.first + place.key[self.timelines]].astype(np.float64)
        after = self.values[self.first + place.following[self.timelines]].astype(np.float64)
        if self.interpolation == "CUBICSPLINE":
            return self._unit(_cubic(before, after, share, step))
        if self.interpolation == "STEP":
            return self._unit(before)
        if self.path == "rotation":
            return quaternion.slerp(quaternion.normalised(before), quaternion.normalised(after), share[:, 0])
        return np.asarray(before + share * (after - before))

    def _unit(self, values: Numbers) -> Numbers:
        return quaternion.normalised(values) if self.path == "rotation" else values


@dataclass(frozen=True, eq=False)
class Clip:
    """An animation: how the joints of a skeleton move for some ``seconds``."""

    name: str
    seconds: float
    timelines: tuple[Numbers, ...] = field(default=(), repr=False)      # the times of keys, each of them rising
    tracks: tuple[Track, ...] = field(default=(), repr=False)

    def pose(self, skeleton: Skeleton, time: float) -> tuple[Numbers, Numbers, Numbers]:
        """Translations (j, 3), rotations (j, 4) and scales (j, 3) at ``time`` in seconds, each in its parent's frame.

        Before its first key and after its last a channel stands still; what no channel moves is at rest.
        """
        posed = {"translation": skeleton.translations.copy(), "rotation": skeleton.rotations.copy(),
                 "scale": skeleton.scales.copy()}
        place = self._place(time)
        for track in self.tracks:
            posed[track.path][track.joints] = track.at(place)
        return posed["translation"], posed["rotation"], posed["scale"]

    def _place(self, time: float) -> Place:
        last = np.array([len(times) - 1 for times in self.timelines], np.intp)
        key = np.array([times.searchsorted(time, "right") - 1 for times in self.timelines], np.intp).clip(0, last)
        following = np.minimum(key + 1, last)
        start, end = (np.array([times[number] for times, number in zip(self.timelines, numbers, strict=True)])
                      for numbers in (key, following))
        step = end - start
        share = np.divide(time - start, step, out=np.zeros(len(step)), where=step > 0.0).clip(0.0, 1.0)
        return Place(key, following, share, step)


def _cubic(before: Numbers, after: Numbers, share: Numbers, step: Numbers) -> Numbers:
    """Hermite's spline between keys (c, 3, width), as appendix C of glTF 2.0 has it; tangents are per second."""
    square, cube = share**2, share**3
    return np.asarray((2 * cube - 3 * square + 1) * before[:, 1] + step * (cube - 2 * square + share) * before[:, 2]
                      + (3 * square - 2 * cube) * after[:, 1] + step * (cube - square) * after[:, 0])
