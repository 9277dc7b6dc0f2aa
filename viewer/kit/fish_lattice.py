"""Where a fish's body has its vertices: closest where its skin bends most, in rows along the gill covers' edge."""

from __future__ import annotations

import numpy as np

from viewer.kit.fish_body import BodySurface, gill_edge, mouth_line
from viewer.kit.fish_curve import Numbers, smoothstep
from viewer.kit.fish_species import NOSE

FINE = 512          # places over which density is summed up
SETTLED = 8         # steps to find the gill cover's edge, each of which leaves half of the error or less
BEHIND = 0.2        # how far behind the gill cover's edge, and
CHEEK = 0.12        # behind the corner of the mouth, the lattice still follows them, metres
MOST = 0.35         # by how much it follows the mouth at most, radians: more would fold it


def even_lattice(bands: int, sectors: int) -> tuple[Numbers, Numbers]:
    """Turns and angles (bands + 1, sectors + 1), evenly."""
    turn, angle = np.linspace(0.0, np.pi, bands + 1), np.linspace(0.0, 2.0 * np.pi, sectors + 1)
    first, second = np.meshgrid(turn, angle, indexing="ij")
    return first, second


def fitted_lattice(surface: BodySurface, bands: int, sectors: int) -> tuple[Numbers, Numbers]:
    """Turns and angles (bands + 1, sectors + 1), alike on both sides, that follow the mouth and the gill covers.

    ``sectors`` is even.
    """
    turn, left = np.meshgrid(_turns(surface, bands), _angles(surface, sectors // 2), indexing="ij")
    left = _along_mouth(surface, surface.x(turn), left)
    turn = _along_gill(surface, turn, left)
    right = slice(-2, None, -1)
    return np.hstack([turn, turn[:, right]]), np.hstack([left, 2.0 * np.pi - left[:, right]])


def _along_gill(surface: BodySurface, turn: Numbers, angle: Numbers) -> Numbers:
    """The turns moved so that those at the gill cover's x lie on its edge."""
    gill, x = surface.species.gill, surface.x(turn)
    behind, ahead = (x - gill.x + BEHIND) / BEHIND, (NOSE - x) / (NOSE - gill.x)
    follows = np.where(x < gill.x, smoothstep(behind), smoothstep(ahead))
    moved = surface.turn(x + follows * (_gill_edge(surface, angle) - gill.x))
    moved[[0, -1]] = turn[[0, -1]]
    return moved


def _gill_edge(surface: BodySurface, angle: Numbers) -> Numbers:
    """The x of the gill cover's edge at each angle (...): where x = edge(y(x)), going half the way again and again."""
    gill = surface.species.gill
    x = np.full(angle.shape, gill.x)
    for _ in range(SETTLED):
        height, _, middle = surface.section(x)
        y = middle + height * np.cos(angle)
        x = 0.5 * (x + gill_edge(gill, np.clip(y, gill.y - gill.reach, gill.y + gill.reach)))
    return x


def _along_mouth(surface: BodySurface, x: Numbers, angle: Numbers) -> Numbers:
    """The angles moved, in the head, so that those at the mouth's middle lie on the line of the mouth."""
    mouth, middle = surface.species.mouth, _mouth_angle(surface)
    line = surface.angle(x, mouth_line(mouth, x))
    moved = np.clip(line - middle, -MOST, MOST)
    follows = smoothstep(np.where(angle < middle, angle / middle, (np.pi - angle) / (np.pi - middle)))
    return np.asarray(angle + moved * follows * smoothstep((x - mouth.corner[0] + CHEEK) / CHEEK))


def _mouth_angle(surface: BodySurface) -> float:
    """The angle of the middle of the mouth."""
    mouth = surface.species.mouth
    x = 0.5 * (mouth.tip[0] + mouth.corner[0])
    return float(surface.angle(x, mouth_line(mouth, np.asarray(x))))


def _turns(surface: BodySurface, bands: int) -> Numbers:
    """Cross sections (bands + 1,), closer at the gill cover's edge and in the snout."""
    turn = np.linspace(0.0, np.pi, FINE)
    x, gill, corner = surface.x(turn), surface.species.gill.x, surface.species.mouth.corner[0]
    snout = smoothstep((x - corner) / (NOSE - corner))
    return _spread(turn, 1.0 + 2.5 * np.exp(-((x - gill) / 0.01) ** 2) + 2.0 * snout, bands)


def _angles(surface: BodySurface, sectors: int) -> Numbers:
    """Angles (sectors + 1,) down one side, closer at the mouth."""
    angle = np.linspace(0.0, np.pi, FINE)
    from_mouth = (angle - _mouth_angle(surface)) / 0.12
    return _spread(angle, 1.0 + 4.0 * np.exp(-from_mouth * from_mouth), sectors)


def _spread(places: Numbers, density: Numbers, count: int) -> Numbers:
    """``count`` + 1 places from the first to the last, spaced by one over the density."""
    steps = 0.5 * (density[1:] + density[:-1]) * np.diff(places)
    reached = np.concatenate([[0.0], np.cumsum(steps)])
    return np.asarray(np.interp(np.linspace(0.0, reached[-1], count + 1), reached, places))
