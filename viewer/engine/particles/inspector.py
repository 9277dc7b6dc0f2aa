"""Looks at one particle: its way behind and before it, the forces on it as arrows, and its numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from viewer.engine.annotations import Click, Label, Table
from viewer.engine.color_field import Color, linear_light
from viewer.engine.declarations import text
from viewer.engine.gpu import Gpu
from viewer.engine.matrices import Matrix
from viewer.engine.params import Parameters
from viewer.engine.particles.lifeline import Lifeline, Reliving
from viewer.engine.particles.strokes import StrokeBrush, arrow, path
from viewer.engine.particles.system import ParticleSystem

NEAR_CLICK = 0.04       # of the picture's height
ARROW = 0.13            # of the distance to the eye, for an acceleration as large as the earth's
LONGEST_ARROW = 0.35
EARTH = 9.81
PAST, FUTURE, MARK = "#ffffff", "#8fb7e8", "#f0e442"
COLORS = {"velocity": "#f2f2f2", "gravity": "#e69f00", "air": "#56b4e9", "turbulence": "#cc79a7",
          "attraction": "#009e73", "vortex": "#d55e00"}
PLATE = "#10141ad0"


class InspectParameters(Parameters):
    """Which particle is looked at."""

    inspect: str = text("", "The number of a particle to look at: its way, and the forces on it; click on one to "
                        "choose it, or beside all to let go", longest=16, pattern=r"\d+", example="1234",
                        group="Teaching")


class ParticleInspector:
    """Finds the particle that ``inspect`` names, if it lives, and shows what there is to know of it."""

    def __init__(self, gpu: Gpu, system: ParticleSystem, params: InspectParameters) -> None:
        self.system, self.params = system, params
        self._brush = StrokeBrush(gpu)
        self._reliving = Reliving(gpu, system.motion)
        self._life: tuple[object, Lifeline] | None = None
        self._texels: dict[str, NDArray[np.float32]] | None = None

    def prepare(self) -> None:
        """Find the particle among the living."""
        self._texels = None
        number = self.params.inspect.strip()
        pool = self.system.pool
        if not number or not pool.used:
            return
        found = np.flatnonzero(pool.alive[:pool.used] & (pool.serial[:pool.used] == int(number)))
        if len(found):
            self._texels = pool.at(int(found[0]))

    def click(self, click: Click) -> Mapping[str, object]:
        """Choose the particle nearest to a click, or let go where none is near."""
        arrays = self.system.arrays()
        away = arrays["position"].astype(np.float64) - click.origin
        depth = away @ click.direction
        beside = np.linalg.norm(away - depth[:, None] * click.direction, axis=1)
        share = np.where(depth > 0.0, beside / np.maximum(depth, 1e-9), np.inf)
        if not len(share) or share.min() > NEAR_CLICK:
            return {"inspect": ""}
        return {"inspect": str(int(arrays["seed"][share.argmin()]))}

    def draw(self, view: Matrix) -> None:
        """Draw path, mark and arrows, in ``draw_sprites``."""
        if self._texels is None:
            return
        eye = _eye(view)
        place, life = self._place(self._texels), self._lifeline(self._texels)
        behind = life.ages <= self._age(self._texels) + 1e-4
        now = place[None].astype(np.float32)
        strokes = [path(np.concatenate([now, life.places[~behind]]), _paint(FUTURE, 0.8), 1.5),
                   path(np.concatenate([life.places[behind], now]), _paint(PAST, 0.9), 2.0),
                   path(_circle(place, eye), _paint(MARK, 1.0), 2.0)]
        for name, way in self._arrows(self._texels, eye).items():
            strokes.append(arrow(place, way, eye, _paint(COLORS[name], 1.0), 3.0))
        self._brush.draw(np.concatenate(strokes))

    def labels(self, view: Matrix) -> Sequence[Label]:
        """The forces' names at their arrows' tips, and what the particle is like."""
        if self._texels is None:
            return ()
        eye = _eye(view)
        place = self._place(self._texels)
        named = [Label(name, _anchor(place + 1.12 * way), size=0.85, color=COLORS[name], plate=PLATE)
                 for name, way in self._arrows(self._texels, eye).items()]
        lines = [f"{name} {value}" for name, value in self._rows(self._texels)]
        return [*named, Label("\n".join(lines), (-0.96, 0.94), size=0.85, color="#f2f4f7", align=(0.0, 1.0),
                              plate=PLATE)]

    def remarks(self) -> Sequence[str]:
        """Why nothing is shown, where a particle was asked for."""
        number = self.params.inspect.strip()
        if not number or self._texels is not None:
            return ()
        if int(number) >= self.system.nursery.born:
            return (f"Particle {number} is not born yet",)
        return (f"Particle {number} has died",)

    def table(self) -> Table | None:
        """The particle's numbers, for ``measure``."""
        if self._texels is None:
            return None
        forces = self._forces(self._texels)
        rows = [*self._rows(self._texels), *((f"{name} (N)", _vector(force)) for name, force in forces.items())]
        return Table(("quantity", "value"), rows)

    def _rows(self, texels: Mapping[str, NDArray[np.float32]]) -> list[tuple[str, str]]:
        lifetime, size, mass, drag = map(float, texels["nature"])
        velocity = texels["velocity"][:3].astype(np.float64)
        return [("particle", self.params.inspect.strip()), ("age", f"{self._age(texels):.2f} of {lifetime:.2f} s"),
                ("speed", f"{np.linalg.norm(velocity):.2f} m/s"), ("height", f"{self._place(texels)[1]:.2f} m"),
                ("mass", f"{mass:.3g} kg"), ("drag", f"{drag:.3g} kg/s"), ("size", f"{1e3 * size:.3g} mm"),
                ("generation", f"{int(texels['launch'][3])}")]

    def _forces(self, texels: Mapping[str, NDArray[np.float32]]) -> dict[str, NDArray[np.float64]]:
        velocity = texels["velocity"][:3].astype(np.float64)
        mass, drag = float(texels["nature"][2]), float(texels["nature"][3])
        return self.system.forces.on_particle(self._place(texels), velocity, mass, drag, self.system.seconds)

    def _arrows(self, texels: Mapping[str, NDArray[np.float32]], eye: NDArray[np.float64]) -> dict[str, Any]:
        """The way each arrow goes, (3,) in metres: forces for each kilogram, and the velocity."""
        far = float(np.linalg.norm(self._place(texels) - eye))
        mass = float(texels["nature"][2])
        ways = {name: force / mass / EARTH for name, force in self._forces(texels).items()}
        ways["velocity"] = texels["velocity"][:3].astype(np.float64) / 5.0
        shown = {}
        for name, way in ways.items():
            length = float(np.linalg.norm(way))
            if length > 0.02:
                shown[name] = far * way * min(ARROW, LONGEST_ARROW / length)
        return shown

    def _lifeline(self, texels: Mapping[str, NDArray[np.float32]]) -> Lifeline:
        """The particle's whole life, lived again only where something that counts has changed."""
        key = self.params.inspect, self.system.steered_by()
        if self._life is None or self._life[0] != key:
            born = self.system.seconds - self._age(texels)
            self._life = key, self._reliving.life(dict(texels), born)
        return self._life[1]

    @staticmethod
    def _place(texels: Mapping[str, NDArray[np.float32]]) -> NDArray[np.float64]:
        return texels["motion"][:3].astype(np.float64)

    @staticmethod
    def _age(texels: Mapping[str, NDArray[np.float32]]) -> float:
        return float(texels["nature"][0] - texels["motion"][3])


def _eye(view: Matrix) -> NDArray[np.float64]:
    """Where the camera is, (3,)."""
    return np.asarray(np.linalg.inv(view)[3, :3], np.float64)


def _paint(code: str, opacity: float) -> tuple[float, ...]:
    """A colour as strokes take it: linear, with its opacity."""
    return (*map(linear_light, Color(code, "").default), opacity)


def _anchor(place: NDArray[np.float64]) -> tuple[float, float, float]:
    return float(place[0]), float(place[1]), float(place[2])


def _vector(vector: NDArray[np.float64]) -> str:
    return ", ".join(f"{along:.3g}" for along in vector)


def _circle(place: NDArray[np.float64], eye: NDArray[np.float64]) -> NDArray[np.float64]:
    """A ring around ``place`` that faces ``eye``, of the same size on the screen however far away: (33, 3)."""
    back = eye - place
    far = np.linalg.norm(back)
    across = np.cross([0.0, 1.0, 0.0], back)
    across = across / max(np.linalg.norm(across), 1e-9)
    up = np.cross(back, across) / max(far, 1e-9)
    turn = np.linspace(0.0, 2.0 * np.pi, 33)[:, None]
    return np.asarray(place + 0.018 * far * (np.cos(turn) * across + np.sin(turn) * up))
