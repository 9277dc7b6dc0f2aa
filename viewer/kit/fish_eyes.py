"""The eyes: flattened balls that stand in the skin and look out along its normal."""

from __future__ import annotations

import numpy as np

from viewer.kit.fish_body import BodySurface
from viewer.kit.fish_curve import Numbers, normals_between_poles
from viewer.kit.fish_species import Eye

FLATNESS = 0.62     # an eyeball's depth, as a part of its radius


def eye_frame(eye: Eye, body: BodySurface, sign: float) -> tuple[Numbers, Numbers]:
    """The middle (3,) of the left (``sign`` -1) or right eye, and axes (3, 3): columns ahead, up and outward."""
    turn, angle = body.turn(eye.x), body.angle(eye.x, eye.y)
    skin, outward = body(turn, angle).real, normals_between_poles(body, turn, angle)
    ahead = np.array([1.0, 0.0, 0.0]) - outward[0] * outward
    ahead /= np.linalg.norm(ahead)
    up = np.cross(ahead, outward)
    up *= np.sign(up[1])
    middle = skin + (eye.bulge - FLATNESS) * eye.radius * outward
    mirror = np.array([1.0, 1.0, -sign])
    return middle * mirror, np.stack([ahead, up, outward], axis=1) * mirror[:, None]


def eye_points(eye: Eye, body: BodySurface, sign: float, unit: Numbers) -> tuple[Numbers, Numbers]:
    """Points and normals (n, 3) of an eyeball for the points ``unit`` (n, 3) of the unit sphere."""
    middle, axes = eye_frame(eye, body, sign)
    radii = eye.radius * np.array([1.0, 1.0, FLATNESS])
    normals = unit / radii
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return middle + (unit * radii) @ axes.T, normals @ axes.T
