"""A rigged model on the GPU, skinned in several ways at once that share its mesh and its materials."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine import skin_pass
from viewer.engine.gpu import Gpu
from viewer.engine.program import Program, VertexArray
from viewer.engine.skin import BonePalette, skin_attributes
from viewer.engine.skin_pass import SkinPass
from viewer.kit.limb import Limb, twisted_palette, with_twist_bones
from viewer.kit.limb_measure import LimbGauge, LimbNumbers
from viewer.kit.quaternion import Numbers
from viewer.kit.skinning import RIGID_WITHIN, linear_blend, rigid_parts

if TYPE_CHECKING:
    from viewer.kit.gltf import Part, RiggedModel

MOST_TWIST_BONES = 8
MOST_PROBES = 1500
LARGE = 100_000         # vertices, from which on they are posed once, not whenever they are drawn
BONES_UNIT, TEXTURE_UNIT = 0, 1
Rows = NDArray[np.float32]


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


class LimbModel:
    """What all ways of skinning a model share: its mesh, its materials, the programs, and the limb that twists."""

    def __init__(self, gpu: Gpu, model: RiggedModel, limb: Limb | None) -> None:
        self.gpu, self.model, self.limb = gpu, model, limb
        self.gauge = LimbGauge(limb) if limb else None
        mesh = model.mesh
        self.everywhere = np.arange(len(mesh.positions))
        self.probed = _spread(limb, MOST_PROBES) if limb else np.zeros(0, np.intp)
        self.index = gpu.buffer(mesh.triangles, label="triangles")
        self._textures = [self._texture(part) for part in model.parts]
        self._programs: dict[tuple[str, bool], Program] = {}

    @property
    def generation(self) -> int:
        """Grows whenever a shader is replaced by an edited one."""
        return sum(program.generation for program in self._programs.values())

    @cached_property
    def extent(self) -> tuple[Numbers, Numbers]:
        """The lowest and the highest corner of the box around the model at rest, (3,) each."""
        mesh = self.model.mesh
        places = linear_blend(mesh.positions, mesh.joints, mesh.weights, mesh.palette())
        return places.min(axis=0), places.max(axis=0)

    @cached_property
    def is_rigid(self) -> bool:
        """Whether no bone ever scales: as bound, at rest, or in an animation."""
        mesh, clips = self.model.mesh, self.model.clips
        even = np.ptp(mesh.skeleton.scales, axis=1).max(initial=0.0) <= RIGID_WITHIN
        moved = any(track.path == "scale" for clip in clips for track in clip.tracks)
        return bool(even and not moved and rigid_parts(mesh.palette())[2] is None)

    def radius_ratios(self, skin: LimbSkin) -> Numbers:
        """By how much the radius of each measured vertex of a skin has changed."""
        assert self.limb and self.gauge
        rows = self.limb.measured
        return self.gauge.radius_ratios(skin.posed_places()[rows].astype(np.float64), skin.upper, rows)

    def content(self, rows: NDArray[np.intp]) -> list[tuple[Any, ...]]:
        """Buffers of some of the vertices, as they were bound."""
        mesh = self.model.mesh
        return [(self.gpu.buffer(mesh.positions[rows], label="bound places"), "3f", "in_position"),
                (self.gpu.buffer(mesh.normals[rows], label="bound normals"), "3f", "in_normal"),
                (self.gpu.buffer(mesh.texcoords[rows], label="texture places"), "2f", "in_texcoord")]

    def program(self, palette: BonePalette, *, posed_before: bool = False) -> Program:
        """The program that blends as a palette asks for, or draws what a pass has ``posed_before``."""
        key = palette.method, posed_before
        if key not in self._programs:
            said = (f"const bool POSED_BEFORE = {str(posed_before).lower()};\n"
                    f"const int POSED_WIDTH = {skin_pass.WIDTH};\n")
            made = self.gpu.program("limb/limb.vert", "limb/limb.frag", generated={
                **palette.generated, "generated/posed_before.glsl": lambda: said})
            made["u_texture"] = TEXTURE_UNIT
            self._programs[key] = made
        return self._programs[key]

    def tell(self, name: str, value: Any) -> None:
        """Set a uniform for every way of skinning."""
        for program in self._programs.values():
            program[name] = value

    def draw_parts(self, array: VertexArray) -> None:
        """Draw the mesh, each part with its material."""
        for part, texture in zip(self.model.parts, self._textures, strict=True):
            array.program["u_base_color"] = part.color
            array.program["u_roughness"] = float(np.clip(part.roughness, 0.25, 0.9))
            array.program["u_has_texture"] = texture is not None
            if texture:
                texture.use(TEXTURE_UNIT)
            array.render(vertices=3 * part.count, first=3 * part.first)

    def _texture(self, part: Part) -> moderngl.Texture | None:
        if part.texture is None:
            return None
        height, width = part.texture.shape[:2]
        made = self.gpu.texture((width, height), 4, part.texture, label="base colour")
        made.filter = moderngl.LINEAR, moderngl.LINEAR
        return made


class LimbSkin:
    """One way of skinning a model: ``linear`` or ``dual_quaternion``, with or without extra bones that share the twist.

    ``pose`` it, then ``draw`` it or ask for what the vertex shader made of it.
    """

    def __init__(self, shared: LimbModel, method: str) -> None:
        self.shared, self.method, self.twist_bones = shared, method, 0
        mesh, gpu = shared.model.mesh, shared.gpu
        self.palette = BonePalette(gpu, len(mesh.bones) + MOST_TWIST_BONES, method, influences=mesh.joints.shape[1],
                                   stretches=not shared.is_rigid)
        self.matrices: Numbers = np.zeros((0, 4, 4))
        self.joints, self.weights = mesh.joints, mesh.weights
        self._pass = SkinPass(gpu, mesh.positions, mesh.normals, mesh.joints, mesh.weights, self.palette) if len(
            mesh.positions) >= LARGE else None
        self._attributes = {name: self._bound(rows) for name, rows in (("all", shared.everywhere),
                                                                      ("probes", shared.probed)) if len(rows)}
        self._arrays = {name: gpu.vertex_array(
            shared.program(self.palette, posed_before=bool(self._pass) and name == "all"),
            [*shared.content(rows), *self._attributes[name]], shared.index if name == "all" else None)
            for name, rows in (("all", shared.everywhere), ("probes", shared.probed)) if len(rows)}
        self._posed: dict[str, Rows] | None = None

    @property
    def upper(self) -> Numbers:
        """What moved the limb as a whole, (4, 4)."""
        return np.asarray(self.matrices[self.shared.limb.upper]) if self.shared.limb else np.eye(4)

    def pose(self, local: Numbers, degrees: float, twist_bones: int = 0) -> None:
        """Stand as ``local`` (j, 4, 4) says, the limb twisted by ``degrees``, which extra bones share."""
        limb, mesh = self.shared.limb, self.shared.model.mesh
        if limb and twist_bones != self.twist_bones:
            self.twist_bones = twist_bones
            self._follow(*with_twist_bones(limb, twist_bones))
        self.matrices = twisted_palette(limb, local, degrees, twist_bones) if limb else mesh.palette(local)
        self.palette.send(self.matrices)
        self._posed = None
        if self._pass:
            self._pass.run(BONES_UNIT)

    def draw(self, stand: Stand) -> None:
        """Draw it where it stands."""
        array = self._arrays["all"]
        self.palette.bind(array.program, BONES_UNIT)
        if self._pass:
            self._pass.bind(array.program)
        array.program["u_aside"] = stand.aside
        array.program["u_turned"] = math.cos(stand.turned), math.sin(stand.turned)
        self.shared.draw_parts(array)

    def posed_places(self) -> Rows:
        """Where the vertex shader puts the vertices, (n, 3), in the model's own space."""
        return self._computed()["v_posed"]

    def posed_normals(self) -> Rows:
        """Which normals it gives them, (n, 3)."""
        return self._computed()["v_posed_normal"]

    def joint_places(self) -> Numbers:
        """Where the joints of the palette are, (b, 3), in the model's own space."""
        mesh = self.shared.model.mesh
        return np.asarray((self.matrices[:len(mesh.bones)] @ np.linalg.inv(mesh.inverse_bind))[:, :3, 3])

    def numbers(self) -> LimbNumbers | None:
        """How thin the limb has become, and what is left of it."""
        gauge = self.shared.gauge
        return gauge.numbers(self.posed_places().astype(np.float64), self.upper) if gauge else None

    def thinnest(self) -> float:
        """The smallest radius ratio among the probes; quicker than ``numbers``."""
        probed, gauge = self.shared.probed, self.shared.gauge
        if gauge is None or not len(probed):
            return float("nan")
        places = self._captured("probes", {"v_posed": 3}, len(probed))["v_posed"]
        return float(gauge.radius_ratios(places.astype(np.float64), self.upper, probed).min())

    def _computed(self) -> dict[str, Rows]:
        if self._posed is None and self._pass:
            self._posed = dict(zip(("v_posed", "v_posed_normal"), self._pass.read(), strict=True))
        if self._posed is None:
            self._posed = self._captured("all", {"v_posed": 3, "v_posed_normal": 3}, len(self.shared.everywhere))
        return self._posed

    def _captured(self, which: str, varyings: dict[str, int], count: int) -> dict[str, Rows]:
        self.palette.bind(self._arrays[which].program, BONES_UNIT)
        return self._arrays[which].capture(varyings, count)

    def _bound(self, rows: NDArray[np.intp]) -> list[tuple[Any, ...]]:
        return skin_attributes(self.shared.gpu, self.joints[rows], self.weights[rows])

    def _follow(self, joints: NDArray[np.int32], weights: NDArray[np.float32]) -> None:
        """Let the vertices follow other bones."""
        self.joints, self.weights = joints, weights
        if self._pass:
            self._pass.follow(joints, weights)
        for name, rows in (("all", self.shared.everywhere), ("probes", self.shared.probed)):
            if name in self._attributes:
                (ways, *_), (shares, *_) = self._attributes[name]
                ways.write(np.ascontiguousarray(joints[rows], "u2"))
                shares.write(np.ascontiguousarray(weights[rows], "f4"))


def _spread(limb: Limb, most: int) -> NDArray[np.intp]:
    """Vertices that are measured, one for each place on the limb, or where these are too many, evenly chosen."""
    measured = limb.measured
    _, first = np.unique(np.round(limb.along[measured], 6), return_index=True)
    return np.asarray(measured[first][::1 + len(first) // most])
