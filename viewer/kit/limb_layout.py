"""Where limbs stand: how large, how far from each other, above their captions, and all seen alike."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from viewer.kit.quaternion import Numbers

GROUND = -1.06
TALLEST, WIDEST, LONGEST = 2.16, 2.5, 2.5       # how large a model stands in the studio, also away from the eye
APART = 0.88                            # from one limb to the next in a square picture; in wider ones more
FARTHEST_APART = 1.6
LEAST_SEEN = 0.6                        # of a long model's length, for which there is room however it is turned
ABOVE_CAPTIONS, HEADS = 0.07, 0.95      # how low above its caption a limb may stand, and how high it may reach
RAISED = 0.4                            # of the height that a low model leaves free, how much is below it


@dataclass(frozen=True)
class Stand:
    """Where a limb stands: ``aside`` in the world, and ``turned`` around the vertical, in radians."""

    aside: tuple[float, float, float] = (0.0, 0.0, 0.0)
    turned: float = 0.0

    def placed(self, places: Numbers) -> Numbers:
        """Places (n, 3) around the origin, turned and moved aside."""
        cosine, sine = math.cos(self.turned), math.sin(self.turned)
        turn = np.array([[cosine, 0.0, sine], [0.0, 1.0, 0.0], [-sine, 0.0, cosine]])
        return np.asarray(places @ turn.T + self.aside)


@dataclass(frozen=True)
class View:
    """How the camera starts: ``yaw`` and ``field_of_view`` in degrees, its distance, and the picture's aspect."""

    yaw: float
    distance: float
    field_of_view: float
    aspect: float

    @property
    def half_height(self) -> float:
        """How much of the world the picture shows from its middle up."""
        return self.distance * math.tan(math.radians(0.5 * self.field_of_view)) / min(1.0, self.aspect)

    @property
    def apart(self) -> float:
        """How far one limb stands from the next."""
        return min(FARTHEST_APART, APART * max(1.0, self.aspect))


@dataclass(frozen=True, eq=False)
class LimbLayout:
    """``count`` limbs, each between the corners ``low`` and ``high`` (3,), above captions up to ``top``, -1 to 1."""

    view: View
    count: int
    low: Numbers
    high: Numbers
    top: float

    @property
    def lowest(self) -> float:
        """How low in the picture limbs may stand."""
        return self.top + ABOVE_CAPTIONS

    @property
    def scale(self) -> float:
        """How many times larger than it is the model stands."""
        width, height, depth = (float(length) for length in self.high - self.low)
        start = math.radians(self.view.yaw)
        seen = abs(width * math.cos(start)) + abs(depth * math.sin(start))
        long = max(math.hypot(width, depth), 1e-9)
        tall = min(TALLEST, (HEADS - self.lowest) * self.view.half_height)
        room = 0.95 * self.view.apart if self.count > 1 else WIDEST
        return min(tall / max(height, 1e-9), room / max(seen, LEAST_SEEN * long), LONGEST / long)

    @property
    def origin(self) -> tuple[float, float, float]:
        """What of the model comes to the origin of the world, so that it stands on the floor."""
        x, _, z = (float(place) for place in 0.5 * (self.low + self.high))
        return x, float(self.low[1]) - GROUND / self.scale, z

    @property
    def raised(self) -> float:
        """How high in the picture, -1 to 1, the origin of the world appears."""
        height = self.scale * float(self.high[1] - self.low[1]) / self.view.half_height
        return self.lowest + RAISED * (HEADS - self.lowest - height) - GROUND / self.view.half_height

    def in_studio(self, places: Numbers) -> Numbers:
        """Places (n, 3) of the model's own space in the world, around the origin."""
        return np.asarray(self.scale * (places - np.array(self.origin)))

    def stands(self, eye: Numbers, right: Numbers) -> list[Stand]:
        """Beside each other to the ``right`` (3,), each turned so that ``eye`` (3,) sees all from the same side."""
        found = []
        for column in range(self.count):
            aside = self.view.apart * (column - 0.5 * (self.count - 1)) * right
            turned = math.atan2(*(eye - aside)[[0, 2]]) - math.atan2(*eye[[0, 2]])
            found.append(Stand((float(aside[0]), float(aside[1]), float(aside[2])), turned))
        return found
