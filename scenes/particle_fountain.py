"""Particles from the surface of an emitter: forces shape their way, colliders turn it, others come from them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import moderngl

from viewer import (
    Click,
    ColorScale,
    Curve,
    DrawTimer,
    Geometry,
    Gpu,
    InspectParameters,
    Label,
    LookParameters,
    Measurements,
    Orbit,
    ParticleInspector,
    ParticleParameters,
    ParticleSystem,
    Scene,
    Solid,
    Sprites,
    Strands,
    Studio,
    Table,
    TrailParameters,
    Trails,
    choice,
    slider,
    trail_bytes,
)

GROUND_COLOR = (0.42, 0.46, 0.52)
BACKDROPS = {
    "studio": ("#c9ced6", "#7f8b9c"), "dusk": ("#3d4d63", "#131b29"), "night": ("#0d1017", "#020306"),
    "sky": ("#dfe9f1", "#6f9cc9"), "meadow": ("#cfd8c4", "#8fb3cf")}


class ParticleFountain(Scene):
    """A laboratory for particles: fountains, fire, fog, fireworks, fur."""

    class Params(ParticleParameters, LookParameters, TrailParameters, InspectParameters):
        backdrop: str = choice("dusk", {
            "studio": "Light grey", "dusk": "Dark blue, for what shines", "night": "Almost black",
            "sky": "A bright sky", "meadow": "Green below, blue above"}, "What lies behind", group="Look")
        set_radius: float = slider(2.6, 0.2, 60.0, "How large the set is that light and shadow reach", unit="m",
                                   logarithmic=True, group="Look")

    camera = Orbit(yaw=24, pitch=7, distance=6.9, target=(0.0, 1.25, 0.0))
    studio = Studio(center=(0.0, 1.2, 0.0), radius=2.6, ground=0.0, backdrop=BACKDROPS["dusk"])
    poster = 240

    def __init__(self, gpu: Gpu, params: Params) -> None:
        self.gpu = gpu
        self.params = params
        self.system = ParticleSystem(gpu, params, trail_bytes(params) + Sprites.bytes_per_particle)
        self.system.holds_still = params.strands
        self.trails = Trails(gpu, self.system, params)
        self.system.companions.append(self.trails)
        self.strands = Strands(gpu, self.system, params) if params.strands else None
        self.sprites = Sprites(gpu, self.system, params)
        self.inspector = ParticleInspector(gpu, self.system, params)
        self.obstacle, self.emitter, self.slope = Solid(gpu), Solid(gpu), Solid(gpu)
        self.timer = DrawTimer(gpu)
        self._solids_of: tuple[object, ...] = (None, None, None)
        self.system.begin()

    def update(self, dt: float) -> None:
        self.system.update()

    def prepare(self) -> None:
        self.system.prepare()
        if self.system.at_beginning:
            self.system.begin()
        self.sprites.prepare()
        if self.strands:
            self.strands.prepare(self.view)
        self.inspector.prepare()
        self._show_solids()

    def steered_by(self) -> Any:
        return self.system.steered_by(), self.trails.noting

    def snapshot(self) -> Any:
        return self.system.snapshot()

    def restore(self, snapshot: Any) -> None:
        self.system.restore(snapshot)
        self.inspector.prepare()

    def draw(self) -> None:
        if not self.params.hollow:
            self.obstacle.draw(self.params.obstacle_color)
        self.emitter.draw(self.params.emitter_color)
        self.slope.draw(GROUND_COLOR)
        if self.strands:
            self.strands.draw()
        elif self.gpu.casting_shadows:
            self.sprites.cast_shadows()

    def draw_over(self) -> None:
        if self.params.hollow:
            self.obstacle.draw_far_glass(self.params.obstacle_color)

    def draw_sprites(self, scene_depth: moderngl.Texture) -> None:
        self._draw_particles(scene_depth)
        if self.params.hollow:
            self.obstacle.draw_near_glass(self.params.obstacle_color)
        self.inspector.draw(self.view)

    def labels(self) -> Sequence[Label]:
        return [*self.sprites.labels(), *self.inspector.labels(self.view)]

    def remarks(self) -> Sequence[str]:
        tally, found = self.system.tally, []
        if tally.refused:
            found.append(f"No room for {tally.refused} births so far: count is {self.params.count}")
        if tally.stillborn and not self.system.pool.alive_count:
            found.append("All are born inside the obstacle or the ground, where there is no room for them")
        return [*found, *self.inspector.remarks()]

    def click(self, click: Click) -> Mapping[str, object]:
        return self.inspector.click(click)

    def color_scale(self) -> ColorScale | None:
        return self.sprites.color_scale()

    def setting(self) -> Studio:
        p = self.params
        level = p.ground and not p.ground_tilt
        height = p.ground_height if p.ground else 0.0
        return Studio(center=(0.0, height + 0.46 * p.set_radius, 0.0), radius=p.set_radius,
                      ground=p.ground_height if level else None, backdrop=BACKDROPS[p.backdrop])

    def geometry(self) -> Geometry:
        return self.system.arrays()

    def measure(self) -> Measurements:
        tally, arrays = self.system.tally, self.system.arrays()
        kinetic, potential, fastest = self.system.energies(arrays)
        numbers: dict[str, float | Curve | Table] = {
            "alive": len(arrays["seed"]), "emitted": tally.emitted, "died": tally.died,
            "collisions": tally.collisions, "children": tally.children, "kinetic_energy": kinetic,
            "potential_energy": potential, "fastest": fastest, "step_ms": self.system.step_ms,
            "draw_ms": self.draw_ms()}
        inspected = self.inspector.table()
        return numbers | {"live": self.system.live_count()} | ({"inspected": inspected} if inspected else {})

    def draw_ms(self) -> float:
        """How long particles, trails or strands take to draw, in a picture as large as the present one."""
        looks, strands = (self.params.revision, self.gpu.generation), self.strands
        draw = (lambda _: strands.draw()) if strands else self._draw_particles
        return self.timer.milliseconds(self.gpu.context.fbo.size, draw, looks)

    def _draw_particles(self, scene_depth: moderngl.Texture) -> None:
        if not self.strands:
            self.trails.draw()
            self.sprites.draw(scene_depth)

    def _show_solids(self) -> None:
        """Give the obstacle, the emitter and a tilted ground the meshes that the parameters ask for."""
        p, colliders = self.params, self.system.colliders
        if colliders.generation != self._solids_of[0]:
            self.obstacle.show(colliders.surface())
        emitter = self.system.emitter.surface() if p.show_emitter else None
        if emitter is not self._solids_of[1]:
            self.emitter.show(emitter)
        slope = (p.ground, p.ground_tilt, p.ground_height, p.set_radius)
        if slope != self._solids_of[2]:
            self.slope.show(colliders.ground_surface(1.5 * p.set_radius) if p.ground and p.ground_tilt else None)
        self._solids_of = colliders.generation, emitter, slope

