"""The line along a fish's middle that its wave bends: drawn over the fish, and measured all through a beat."""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.fish.swimming import Swimming
from viewer.engine.gpu import Gpu
from viewer.engine.program import Program
from viewer.engine.scene import Curve
from viewer.kit.gait import Gait, gait

PLACES = 65         # along the line
MOMENTS = 48        # of a beat, where it is measured
GHOSTS = 5          # earlier moments that are drawn
SHOWN_MOMENTS = 8   # in the curve of the middle line
WIDTH = 5.0         # of the line, in pixels of a picture 360 high


class Spine:
    """Draws the middle line of the hero, and captures what the shader makes of it."""

    def __init__(self, gpu: Gpu) -> None:
        self.gpu = gpu
        self._line = gpu.vertex_array(gpu.program("fish/spine.vert", "fish/spine.frag"), mode=moderngl.TRIANGLE_STRIP)
        self._beat = gpu.vertex_array(gpu.program("fish/spine_beat.vert"))
        self._line.program["u_places"], self._line.program["u_ghosts"] = PLACES, GHOSTS
        self._beat.program["u_places"], self._beat.program["u_moments"] = PLACES, MOMENTS

    @property
    def program(self) -> Program:
        """What draws the line, to be given the pose of the fish before ``draw``."""
        return self._line.program

    def draw(self) -> None:
        """Draw the line now, earlier ones and the envelope over everything, in ``Scene.draw_over``."""
        context = self.gpu.context
        self._line.program["u_width"] = WIDTH * context.fbo.height / 360.0
        context.disable(moderngl.DEPTH_TEST)
        context.enable(moderngl.BLEND)
        self._line.render(vertices=2 * PLACES, instances=3 + GHOSTS)
        context.disable(moderngl.BLEND)
        context.enable(moderngl.DEPTH_TEST)

    def beat(self, swimming: Swimming) -> NDArray[np.float32]:
        """Where the shader puts the line at all moments of a beat, (MOMENTS, PLACES, 3), from nose to tail."""
        swimming.tell(self._beat.program)
        captured = self._beat.capture({"v_place": 3}, PLACES * MOMENTS)["v_place"]
        return captured.reshape(MOMENTS, PLACES, 3)

    def measure(self, swimming: Swimming) -> dict[str, float | Curve]:
        """The numbers and curves of the beat; frequencies are per second, lengths in body lengths."""
        params: Any = swimming.params
        spines = self.beat(swimming)
        found: Gait = gait(spines)
        along = np.linspace(0.0, 1.0, PLACES)
        moments = {f"{part}/{SHOWN_MOMENTS} of a beat": spines[part * MOMENTS // SHOWN_MOMENTS, :, 2]
                   for part in range(SHOWN_MOMENTS)}
        runs = {"wave_speed": found.wavelength * params.tail_beat_hz} if np.isfinite(found.wavelength) else {}
        return {
            "body_length_ratio": found.body_length_ratio, **runs, "head_amplitude": found.head_amplitude,
            "tail_amplitude": found.tail_amplitude, "strouhal": found.strouhal,
            "amplitude_along_body": Curve("along", along, {"amplitude": found.amplitude},
                                          x_label="from nose to tail",
                                          y_label="swing (body lengths)"),
            "midline": Curve("along", along, moments, x_label="from nose to tail",
                             y_label="to the right")}
