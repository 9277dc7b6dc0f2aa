"""The whole life of one particle, from birth to death, found by living it again.

Particles do not feel each other, so that one alone goes exactly the way that it goes among all.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from viewer.engine.clock import FRAME_SECONDS
from viewer.engine.gpu import Gpu
from viewer.engine.particles.motion import Motion
from viewer.engine.particles.pool import LASTING, MOVING

MOST_STEPS = 2400       # what is lived again: 40 seconds


@dataclass(frozen=True)
class Lifeline:
    """Where a particle is at the end of each frame of its life: ``places`` and ``velocities`` (n, 3).

    The first row is its birth; ``ages`` (n,) are in seconds.
    """

    ages: NDArray[np.float64]
    places: NDArray[np.float32]
    velocities: NDArray[np.float32]


class Reliving:
    """Lives one particle's life again, in textures of one texel."""

    def __init__(self, gpu: Gpu, motion: Motion) -> None:
        self.motion = motion
        self._lasting = {name: gpu.texture((1, 1), 4, dtype="f4", label=f"one particle's {name}") for name in LASTING}
        self._sides = [{name: gpu.texture((1, 1), 4, dtype="f4", label=f"one particle's {name}") for name in MOVING}
                       for _ in range(2)]
        status = gpu.texture((1, 1), 1, dtype="u2", label="one particle's status")
        self._targets = [gpu.framebuffer([*side.values(), status], label="one particle") for side in self._sides]

    def life(self, texels: dict[str, NDArray[np.float32]], born: float) -> Lifeline:
        """The life of the particle with ``texels`` (4,) by texture; ``born`` is the scene time of its birth."""
        lifetime, lived = float(texels["nature"][0]), float(texels["origin"][3])
        self._put(texels, lifetime)
        rows = [np.concatenate([texels["origin"][:3], texels["launch"][:3]])]
        ages, age, present = [0.0], 0.0, self.motion.seconds
        try:
            while age < lifetime and len(ages) < MOST_STEPS:
                step = lived if len(ages) == 1 and lived > 0.0 else FRAME_SECONDS
                self._lasting["origin"].write(np.array([*texels["origin"][:3], step], np.float32))
                self.motion.seconds = born + age + step
                motion, velocity = self._step()
                rows.append(np.concatenate([motion[:3], velocity[:3]]))
                age = lifetime if motion[3] <= 0.0 else age + step
                ages.append(age)
        finally:
            self.motion.seconds = present
        found = np.array(rows, np.float32)
        return Lifeline(np.array(ages), found[:, :3], found[:, 3:])

    def _put(self, texels: dict[str, NDArray[np.float32]], lifetime: float) -> None:
        for name in LASTING:
            self._lasting[name].write(texels[name].astype(np.float32))
        identity = abs(float(texels["velocity"][3]))
        self._sides[0]["motion"].write(np.array([*texels["origin"][:3], lifetime], np.float32))
        self._sides[0]["velocity"].write(np.array([*texels["launch"][:3], identity], np.float32))

    def _step(self) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        self.motion.step_newborns({**self._sides[0], **self._lasting}, self._targets[1], (1, 1))
        self._sides.reverse()
        self._targets.reverse()
        motion, velocity = (np.frombuffer(self._sides[0][name].read(), np.float32) for name in MOVING)
        return motion, velocity
