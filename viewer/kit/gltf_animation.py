"""The animations of a glTF file, read as clips."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from viewer.kit.gltf_accessor import FLOAT, Accessors
from viewer.kit.gltf_clip import Clip, Numbers, Track
from viewer.kit.gltf_document import Document, Entry
from viewer.kit.mesh_file import FARTHEST

MOST_KEYS = 2**20               # of one channel
LONGEST = 1e5                   # seconds
PATHS = ("translation", "rotation", "scale")
ELSEWHERE = ("weights", "pointer")              # paths that move no joint
VALUES_PER_KEY = {"LINEAR": 1, "STEP": 1, "CUBICSPLINE": 3}


class Channel(NamedTuple):
    """What moves one property of one joint: keys at ``times`` (k,), and their values as Track has them."""

    joint: int
    times: Numbers
    values: NDArray[np.float32]


def read_clips(document: Document, accessors: Accessors, joint_of: NDArray[np.int32]) -> tuple[Clip, ...]:
    """The animations of a file that move any joint of its skeleton; ``joint_of`` gives each node's joint, or -1.

    Raises ModelFileError for times that do not rise, values that do not fit them, and what is not in glTF 2.
    """
    samplers = Samplers(accessors)
    clips = []
    for number, animation in enumerate(document.entries("animations")):
        channels = _channels(animation, samplers, joint_of)
        if channels:
            clips.append(_clip(animation.label() or f"animation {number}", channels, animation, accessors))
    return tuple(clips)


class Samplers:
    """Keys and values that samplers refer to, each accessor checked once however often it is used."""

    def __init__(self, accessors: Accessors) -> None:
        self._accessors = accessors
        self._times: dict[int, Numbers] = {}
        self._same_times: dict[bytes, Numbers] = {}
        self._values: dict[tuple[int, str, int], NDArray[np.float32]] = {}

    def times(self, sampler: Entry) -> Numbers:
        """The times of a sampler's keys in seconds, rising; the same array for those that are equal."""
        number = sampler.needed_index("input", "accessors")
        if number not in self._times:
            times = self._accessors.floats(number, "SCALAR", MOST_KEYS, FLOAT)[:, 0].astype(np.float64)
            wrong = np.nonzero((np.diff(times, prepend=0.0) < 0.0) | (times > LONGEST))[0]
            if len(wrong):
                sampler.document.refuse(f"accessors[{number}] has the time {times[wrong[0]]:g} as number "
                                        f"{wrong[0]:,}; times must rise, from 0 to {LONGEST:g} seconds")
            self._times[number] = self._same_times.setdefault(times.tobytes(), times)
        return self._times[number]

    def values(self, sampler: Entry, path: str, keys: int) -> NDArray[np.float32]:
        """The values at a sampler's ``keys``, as Track has them."""
        number, per_key = sampler.needed_index("output", "accessors"), VALUES_PER_KEY[interpolation(sampler)]
        count = self._accessors.count(number)
        if count != keys * per_key:
            sampler.document.refuse(f"{sampler.place} has {keys:,} keys and {count:,} values; "
                                    f"{keys * per_key:,} are needed")
        if (number, path, per_key) not in self._values:
            kind = "VEC4" if path == "rotation" else "VEC3"
            values = self._accessors.floats(number, kind, MOST_KEYS * per_key)
            shaped = values.reshape(keys, per_key, -1) if per_key > 1 else values
            _check_values(sampler.document, number, path, shaped)
            self._values[number, path, per_key] = shaped
        return self._values[number, path, per_key]


def interpolation(sampler: Entry) -> str:
    """What a sampler does between keys; one of VALUES_PER_KEY."""
    given = sampler.values.get("interpolation", "LINEAR")
    if not isinstance(given, str) or given not in VALUES_PER_KEY:
        sampler.refuse("interpolation", f"{', '.join(VALUES_PER_KEY)} are allowed")
    return given


def _check_values(document: Document, number: int, path: str, values: NDArray[np.float32]) -> None:
    largest = float(np.abs(values).max())
    if largest > FARTHEST:
        document.refuse(f"accessors[{number}] has the value {largest:g}; at most {FARTHEST:g} is allowed")
    at_keys = values if values.ndim == 2 else values[:, 1]
    if path == "rotation" and not at_keys.any(axis=1).all():
        document.refuse(f"accessors[{number}] has a rotation of zeros; quaternions of length one are needed")


def _channels(animation: Entry, samplers: Samplers,
              joint_of: NDArray[np.int32]) -> dict[tuple[str, str], dict[int, Channel]]:
    """The channels of an animation by path and interpolation, for each joint; of two for the same the latter."""
    entries = animation.children("samplers")
    found: dict[tuple[str, str], dict[int, Channel]] = {}
    for channel, joint, path in _moving(animation, joint_of):
        if not entries:
            channel.refuse("sampler", f"{animation.place} has no samplers")
        sampler = entries[channel.whole("sampler", 0, len(entries) - 1)]
        times = samplers.times(sampler)
        values = samplers.values(sampler, path, len(times))
        found.setdefault((path, interpolation(sampler)), {})[joint] = Channel(joint, times, values)
    return found


def _moving(animation: Entry, joint_of: NDArray[np.int32]) -> Iterator[tuple[Entry, int, str]]:
    """The channels that move a joint, with the joint and which of PATHS."""
    for channel in animation.children("channels"):
        target = channel.child("target")
        node, path = target.index("node", "nodes"), target.text("path")
        if path not in PATHS + ELSEWHERE:
            target.refuse("path", f"{', '.join(PATHS)} and weights are allowed")
        if path in PATHS and node is not None and joint_of[node] >= 0:
            yield channel, int(joint_of[node]), path


def _clip(name: str, channels: dict[tuple[str, str], dict[int, Channel]], animation: Entry,
          accessors: Accessors) -> Clip:
    """Channels with the same path and interpolation as one track, and the timelines of them all."""
    timelines: dict[int, tuple[int, Numbers]] = {}              # by the identity of their arrays
    tracks = []
    for (path, between), by_joint in channels.items():
        found = list(by_joint.values())
        numbers = [timelines.setdefault(id(one.times), (len(timelines), one.times))[0] for one in found]
        pieces = {id(one.values): one.values for one in found}
        accessors.spend(animation, sum(piece.size for piece in pieces.values()))
        starts = dict(zip(pieces, np.cumsum([0, *(len(piece) for piece in pieces.values())]), strict=False))
        tracks.append(Track(path, between, np.array(list(by_joint), np.int32), np.array(numbers, np.intp),
                            np.array([starts[id(one.values)] for one in found], np.intp),
                            np.concatenate(list(pieces.values()))))
    every = tuple(times for _, times in timelines.values())
    return Clip(name, max(float(times[-1]) for times in every), every, tuple(tracks))
