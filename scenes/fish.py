"""A fish whose swimming is a wave in the vertex shader, whose fins are skinned, and which may have a school."""

from __future__ import annotations

import math
from collections.abc import Hashable, Sequence
from typing import Any, NamedTuple

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer import (
    WATERS,
    ColorScale,
    FinParameters,
    FishLookParameters,
    FishModel,
    Flock,
    Geometry,
    Gpu,
    Label,
    Measurements,
    Orbit,
    Program,
    Scene,
    SchoolParameters,
    Spine,
    Studio,
    Swimming,
    SwimParameters,
    Underwater,
    VertexArray,
    WaterParameters,
    detail_of,
)
from viewer.kit.fish import SPECIES
from viewer.kit.nearest import nearest_distances
from viewer.kit.needle import needle_corners
from viewer.kit.swim_school import PLACE, polarisation

SCHOOL_UNIT = 11
LOOKED_AT = 500.0               # pixels: how long a fish is that is exported and measured
SHADOW_PIXELS = 256.0           # half of the shadow map across
SIGHT, FLOOR = 0.8, -0.40       # of the set for one fish: its radius, and how far below the fish its floor is, metres
FINE_FROM = 70.0                # pixels of length from which scales, rays and irises show
PARTS = ("body", "tail fin", "dorsal fin", "anal fin", "pectoral fins", "pelvic fins", "eyes")
PART_COLORS = ("#e69f00", "#56b4e9", "#009e73", "#f0e442", "#0072b2", "#d55e00", "#cc79a7")     # okabe_ito 1 to 7

STEERING = (*SwimParameters.declared, *FinParameters.declared, *SchoolParameters.declared)      # what moves the fish


class Moment(NamedTuple):
    """What the frames to come follow from."""

    swimming: Any
    flock: Any

    @property
    def nbytes(self) -> int:
        """How much memory it takes."""
        return int(self.swimming.nbytes + self.flock.nbytes)


class Fish(Scene):
    """A fish that swims by a wave in the vertex shader, alone or in a school."""

    class Params(FishLookParameters, SwimParameters, FinParameters, SchoolParameters, WaterParameters):
        pass

    camera = Orbit(yaw=27, pitch=10, distance=1.65, target=(0.05, -0.03, 0.0))
    studio = Studio(radius=SIGHT, ground=FLOOR, backdrop=WATERS["lagoon"], furnished=False)
    poster = 90

    def __init__(self, gpu: Gpu, params: Params) -> None:
        self.gpu, self.params = gpu, params
        self.swimming, self.flock = Swimming(params), Flock(gpu, params)
        self.water, self.spine = Underwater(gpu, params), Spine(gpu)
        kinds = tuple(SPECIES) if params.mixed and params.school > 1 else (params.species,)
        self.models = [FishModel(gpu, params, kind) for kind in kinds]
        self.needles: VertexArray | None = None

    @property
    def alone(self) -> bool:
        """Whether there is but one fish, the hero."""
        return bool(self.params.school == 1)

    # Time

    def update(self, dt: float) -> None:
        self.swimming.advance(dt)
        self.flock.step(dt)

    def steered_by(self) -> Hashable:
        return tuple(self.params.get(name) for name in STEERING)

    def snapshot(self) -> Moment:
        return Moment(self.swimming.snapshot(), self.flock.snapshot())

    def restore(self, snapshot: Moment) -> None:
        self.swimming.restore(snapshot.swimming)
        self.flock.restore(snapshot.flock)

    def prepare(self) -> None:
        self.water.prepare(self.time)
        for model in self.models:
            model.prepare(self.swimming)
        if self.params.show_normals and self.needles is None:
            self.needles = self.models[0].needles(needle_corners(), self.params.needles)

    # Drawing

    def setting(self) -> Studio:
        p = self.params
        across, high, _ = (0.0, 0.0, 0.0) if self.alone else self.flock.half_axes
        floor = min(FLOOR, -1.1 * high)
        return Studio(radius=max(SIGHT, across), ground=floor if p.seabed else None, backdrop=WATERS[p.water],
                      furnished=False)

    def draw(self) -> None:
        self.water.draw()
        pixels = self.pixels_of_nearest()
        detail = detail_of(self.params, pixels)
        fine = self.alone or (pixels > FINE_FROM and detail > 0)
        translucent = fine and not self.gpu.casting_shadows
        if translucent:
            self.gpu.context.enable(moderngl.BLEND)     # fins let light through
        for number, model in enumerate(self.models):
            program = model.program(fine)
            self.water.light_up(program)
            model.draw(detail, fine, self.tell(program, number))
        if translucent:
            self.gpu.context.disable(moderngl.BLEND)
        if self.params.show_normals and self.needles:
            self.draw_needles(self.needles)

    def draw_needles(self, needles: VertexArray) -> None:
        """Draw needles along the exact normals, and along those that a body would have that is not bent but turned."""
        self.tell(needles.program)
        for exact in (True, False):
            needles.program["u_exact"] = exact
            self.models[0].draw_needles(needles, self.params.needles)

    def draw_over(self) -> None:
        self.water.draw_motes()
        if self.params.show_midline:
            self.tell(self.spine.program)
            self.spine.draw()

    def tell(self, program: Program, number: int = 0) -> int:
        """Give a program the pose of the fish of a species, by its ``number``; returns how many they are."""
        self.swimming.tell(program)
        program["u_swing_scale"] = self.swing_scale
        return 1 if self.alone else self.flock.bind(program, SCHOOL_UNIT, number, len(self.models))

    def pixels_of_nearest(self) -> float:
        """How long the fish that is nearest to the eye, or in the shadow map any fish, would be seen from the side."""
        if self.gpu.casting_shadows:
            return SHADOW_PIXELS / self.setting().radius
        places = np.zeros((1, 3)) if self.alone else self.flock.state[:, PLACE]
        nearest = max(float(np.linalg.norm(places - self.eye, axis=1).min()), 0.1)
        shown = 2.0 * nearest * math.tan(math.radians(0.5 * self.camera.field_of_view))    # of the shorter side, metres
        return float(self.gpu.context.fbo.height * min(1.0, self.aspect) / shown)

    @property
    def eye(self) -> NDArray[np.float64]:
        """Where the camera is, (3,)."""
        return np.asarray(-self.view[3, :3] @ self.view[:3, :3].T)

    @property
    def swing_scale(self) -> float:
        """The swing at the bright end of the colours, in body lengths: that of the tail."""
        swim = self.swimming.swim
        return max(swim.reach + swim.sway + 0.5 * swim.yaw, 0.01)

    def color_scale(self) -> ColorScale | None:
        if self.params.colouring != "swing":
            return None
        return ColorScale("Swing", 0.0, round(self.swing_scale, 3), "body lengths")

    def labels(self) -> Sequence[Label]:
        if self.params.colouring != "parts":
            return ()
        corner, size = (-0.95, -0.92), 0.85
        squares = ["\n".join("■" if other == part else " " for other in PARTS) for part in PARTS]
        names = "\n".join(f"     {part}" for part in PARTS)
        return [Label(names, corner, size, "#ffffff", (0.0, 0.0)),
                *(Label(square, corner, size, color, (0.0, 0.0))
                  for square, color in zip(squares, PART_COLORS, strict=True))]

    # What it tells

    def geometry(self) -> Geometry:
        self.tell(self.models[0].program(True))
        school = {} if self.alone else {f"school_{name}": values for name, values in self.flock.arrays().items()}
        return {**self.models[0].capture(detail_of(self.params, LOOKED_AT)), **school}

    def measure(self) -> Measurements:
        vertices, triangles = self.models[0].size(detail_of(self.params, LOOKED_AT))
        numbers = {"vertices": vertices, "triangles": triangles, "fish": self.params.school}
        if not self.alone:
            school = self.flock.arrays()
            numbers |= {"polarisation": polarisation(school["velocity"]),
                        "nearest_distance": float(nearest_distances(school["position"]).mean())}
        return {**self.spine.measure(self.swimming), **numbers}

    def remarks(self) -> Sequence[str]:
        found = list(self.swimming.remarks())
        if self.params.mixed and self.alone:
            found.append("A single fish is of one species: mixed has no effect")
        if not self.alone and np.linalg.norm(self.eye / self.flock.half_axes) < 1.0:
            found.append("The camera is within the school: scroll to see it from outside")
        return found
