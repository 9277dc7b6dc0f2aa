"""Poses as text: which bones a hand has turned, and by how much.

    hand: 0 0 35; forearm: -20 0 0          degrees about each bone's own axes, as one rotation vector
"""

from __future__ import annotations

import difflib
from collections.abc import Mapping, Sequence

import numpy as np

from viewer.errors import DemoscopeError
from viewer.kit import quaternion
from viewer.kit.gltf_clip import Clip
from viewer.kit.quaternion import Numbers
from viewer.kit.rig import composed

LONGEST_NAME = 100


class PoseError(DemoscopeError):
    """A bone that a model does not have, or a pose that cannot be read."""


def bone_named(name: str, names: Sequence[str], what: str = "bone", kind: str = "bones") -> int:
    """The number of the one called ``name``, or with that number; raises PoseError with the nearest name."""
    word = name.strip()
    if word in names:
        return list(names).index(word)
    lowered = [known.lower() for known in names]
    if word.lower() in lowered:
        return lowered.index(word.lower())
    if word.isascii() and word.isdigit() and int(word) < len(names):
        return int(word)
    close = difflib.get_close_matches(word.lower(), lowered, n=1, cutoff=0.5)
    hint = f"; did you mean {names[lowered.index(close[0])]}?" if close else ""
    some = ", ".join(names[:8]) + (f" and {len(names) - 8} more" if len(names) > 8 else "")
    raise PoseError(f"{what} = {word[:60]} is none of the model's {kind} {some}{hint}")


def clip_named(name: str, clips: Sequence[Clip]) -> int:
    """The number of the animation called ``name``, or with that number; raises PoseError."""
    if not clips:
        raise PoseError(f"animation = {name[:60]} is not there: the model has no animations")
    return bone_named(name, [clip.name for clip in clips], "animation", "animations")


def read_pose(text: str, names: Sequence[str]) -> dict[int, Numbers]:
    """Rotation vectors (3,) in degrees by bone number; raises PoseError for what is not written as above."""
    pose: dict[int, Numbers] = {}
    for entry in filter(str.strip, text.split(";")):
        name, _, numbers = entry.rpartition(":")
        try:
            vector = np.array([float(number) for number in numbers.split()])
        except ValueError:
            vector = np.empty(0)
        if vector.shape != (3,) or not np.isfinite(vector).all() or not name.strip():
            raise PoseError(f"pose = {entry.strip()[:60]} is not written like hand: 0 0 35")
        pose[bone_named(name, names, "pose")] = vector
    return pose


def written_name(bone: int, names: Sequence[str]) -> str:
    """The name of a bone, or its number where the name would not be read back."""
    name = names[bone]
    readable = name.isprintable() and not set(name) & set(":;") and name.strip() == name and len(name) <= LONGEST_NAME
    return name if readable and bone_named(name, names) == bone else str(bone)


def written_pose(pose: Mapping[int, Numbers], names: Sequence[str]) -> str:
    """The text of a pose; bones that are hardly turned are left out."""
    turned = {bone: vector for bone, vector in sorted(pose.items()) if np.abs(vector).max() >= 0.005}
    return "; ".join(f"{written_name(bone, names)}: " + " ".join(f"{angle:.2f}" for angle in vector)
                     for bone, vector in turned.items())


def turning(vector: Numbers) -> Numbers:
    """The matrix (4, 4) of a rotation vector in degrees."""
    return composed(np.zeros(3), quaternion.from_rotation_vector(np.radians(vector)), np.ones(3))
