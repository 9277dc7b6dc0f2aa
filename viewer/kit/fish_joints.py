"""The skeleton of a fish's fins, the same joints in the same order for every species, and how the skin follows them.

The spine is no part of it: swimming bends the fish as a whole. Each joint's x axis points along its fin to the tip,
y across it to the leading edge. A pose and its mirror image have opposite turns about x and y and the same about z.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from viewer.kit import quaternion
from viewer.kit.fish_body import body_surface
from viewer.kit.fish_curve import Numbers, smoothstep
from viewer.kit.fish_fins import Frame, median_fin, paired_frame
from viewer.kit.fish_species import MedianFin, PairedFin, Part, Species
from viewer.kit.rig import Skeleton

JOINTS = ("body", "left pectoral", "left pectoral tip", "right pectoral", "right pectoral tip",
          "left pelvic", "right pelvic", "tail upper", "tail lower")
PARENTS = (-1, 0, 1, 0, 3, 0, 0, 0, 0)
INFLUENCES = 4
ROOTED = 0.25       # over which part of its length a fin comes to follow its own joint


def skeleton(species: Species) -> Skeleton:
    """The joints at rest. A species without a fin has its joints none the less, on the body."""
    frames = [Frame(np.zeros(3), np.eye(3)), *_pectoral_frames(species), *_pelvic_frames(species),
              *_tail_frames(species)]
    translations, rotations = [], []
    for frame, parent in zip(frames, PARENTS, strict=True):
        base = frames[max(parent, 0)]
        translations.append(base.axes.T @ (frame.origin - base.origin))
        rotations.append(quaternion.from_matrix(base.axes.T @ frame.axes))
    return Skeleton(JOINTS, np.array(PARENTS, np.int32), np.array(translations), np.array(rotations),
                    np.ones((len(JOINTS), 3)))


def paired_weights(fin: PairedFin, sign: float, v: Numbers) -> tuple[NDArray[np.int32], Numbers]:
    """Joints and weights (n, 4) at ``v`` (n,) out from the root: linear along a pectoral from joint to joint."""
    side = "left" if sign < 0.0 else "right"
    own = np.asarray(smoothstep(v / ROOTED))
    beyond = v if fin.part == Part.PECTORAL else np.zeros_like(v)
    name = "pectoral" if fin.part == Part.PECTORAL else "pelvic"
    last = f"{side} pectoral tip" if fin.part == Part.PECTORAL else "body"
    names = ("body", f"{side} {name}", last, "body")
    return _rows(names, len(v)), np.stack([1.0 - own, own * (1.0 - beyond), own * beyond, np.zeros_like(v)], axis=1)


def median_weights(fin: MedianFin, u: Numbers, v: Numbers) -> tuple[NDArray[np.int32], Numbers]:
    """Joints and weights (n, 4): all to the body but for the tail, whose lobes part in the middle."""
    own, lower = np.zeros_like(u), np.zeros_like(u)
    breadth = tail_breadth(fin)
    if breadth is not None:
        place = (u - breadth[0]) / (breadth[1] - breadth[0])
        lower = np.asarray(smoothstep((place - 0.25) / 0.5))
        own = np.asarray(smoothstep(v / ROOTED))
        if fin.tail is not None:
            own = own * np.asarray(smoothstep(place / 0.4) * smoothstep((1.0 - place) / 0.4))
    names = ("body", "tail upper", "tail lower", "body")
    return _rows(names, len(u)), np.stack([1.0 - own, own * (1.0 - lower), own * lower, np.zeros_like(u)], axis=1)


def tail_breadth(fin: MedianFin) -> tuple[float, float] | None:
    """Over which of its breadth u a fin is the tail: all, a part, or None."""
    return fin.tail if fin.tail is not None else ((0.0, 1.0) if fin.part == Part.TAIL else None)


def _rows(names: tuple[str, ...], count: int) -> NDArray[np.int32]:
    return np.tile(np.array([JOINTS.index(name) for name in names], np.int32), (count, 1))


def _pectoral_frames(species: Species) -> list[Frame]:
    fin = next(fin for fin in species.paired_fins if fin.part == Part.PECTORAL)
    frame = paired_frame(fin, body_surface(species))
    half = 0.5 * max(point[0] for point in fin.tip)
    along = [frame, Frame(frame.origin + half * frame.axes[:, 0], frame.axes)]
    return [*(_left(each) for each in along), *along]


def _pelvic_frames(species: Species) -> list[Frame]:
    body = body_surface(species)
    fins = [fin for fin in species.paired_fins if fin.part == Part.PELVIC]
    frame = paired_frame(fins[0], body) if fins else Frame(np.zeros(3), _along(np.array([-1.0, -0.5, 0.0])))
    return [_left(frame) if fins else frame, frame]


def _tail_frames(species: Species) -> list[Frame]:
    fin = next(fin for fin in species.median_fins if tail_breadth(fin) is not None)
    breadth = tail_breadth(fin)
    assert breadth is not None
    surface = median_fin(fin, body_surface(species))
    places = breadth[0] + (breadth[1] - breadth[0]) * np.array([0.25, 0.75])
    origins, tips = surface.root(places).real, surface.tip(places).real
    return [Frame(origin, _along(tip - origin)) for origin, tip in zip(origins, tips, strict=True)]


def _along(way: Numbers) -> Numbers:
    """Axes (3, 3) of a joint in the middle plane whose x points along ``way``, its z to the left."""
    x = way / np.linalg.norm(way)
    z = np.array([0.0, 0.0, -1.0])
    return np.stack([x, np.cross(z, x), z], axis=1)


def _left(frame: Frame) -> Frame:
    """The mirror image of a right fin's frame, its third axis turned so that it stays right-handed."""
    mirror = np.array([1.0, 1.0, -1.0])
    return Frame(frame.origin * mirror, frame.axes * mirror[:, None] * np.array([1.0, 1.0, -1.0]))
