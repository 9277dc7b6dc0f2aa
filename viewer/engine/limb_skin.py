"""A rigged model on the GPU, skinned in several ways at once that share its mesh and its materials."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine import skin_pass
from viewer.engine.gpu import Gpu
from viewer.engine.program import Program, VertexArray
from viewer.engine.skin import BonePalette, skin_attributes
from viewer.engine.skin_pass import SkinPass, texture_of
from viewer.kit.limb import Limb
from viewer.kit.limb_layout import Stand
from viewer.kit.limb_measure import LimbGauge, LimbNumbers
from viewer.kit.quaternion import Numbers, nearest_rotation, swing_twist
from viewer.kit.skinning import RIGID_WITHIN, linear_blend, rigid_parts
from viewer.kit.twist_bones import twisted_palette, with_twist_bones

if TYPE_CHECKING:
    from viewer.kit.gltf import Part, RiggedModel

MOST_TWIST_BONES = 8
MOST_PROBES = 1500
MOST_SWING = math.radians(8.0)      # of a limb that still counts as straight
LARGE = 100_000         # vertices, from which on they are posed once, not whenever they are drawn
BONES_UNIT, TEXTURE_UNIT = 0, 1
Rows = NDArray[np.float32]


class LimbModel:
    """What all ways of skinning a model share: its mesh, its materials, the programs, and the limb that twists."""

    def __init__(self, gpu: Gpu, model: RiggedModel, limb: Limb | None) -> None:
        self.gpu, self.model, self.limb = gpu, model, limb
        self.mesh = limb.mesh if limb else model.mesh       # with the limb's own weights
        self.gauge = LimbGauge(limb) if limb else None
        self.everywhere = np.arange(len(self.mesh.positions))
        self.probed = _spread(limb, MOST_PROBES) if limb else np.zeros(0, np.intp)
        self.is_large = len(self.mesh.positions) >= LARGE
        self.index = gpu.buffer(self.mesh.triangles, label="triangles")
        self._textures = [self._texture(part) for part in model.parts]
        self._programs: dict[tuple[str, bool], Program] = {}

    @cached_property
    def extent(self) -> tuple[Numbers, Numbers]:
        """The lowest and the highest corner of the box around the model at rest, (3,) each."""
        mesh = self.mesh
        places = linear_blend(mesh.positions, mesh.joints, mesh.weights, mesh.palette())
        return places.min(axis=0), places.max(axis=0)

    @cached_property
    def is_rigid(self) -> bool:
        """Whether no bone ever scales: as bound, at rest, or in an animation."""
        even = np.ptp(self.mesh.skeleton.scales, axis=1).max(initial=0.0) <= RIGID_WITHIN
        moved = any(track.path == "scale" for clip in self.model.clips for track in clip.tracks)
        return bool(even and not moved and rigid_parts(self.mesh.palette())[2] is None)

    @cached_property
    def whole(self) -> list[tuple[Any, ...]]:
        """Buffers of all vertices, as they were bound."""
        return self._content(self.everywhere)

    @cached_property
    def probes(self) -> list[tuple[Any, ...]]:
        """Buffers of those that are measured for many twists."""
        return self._content(self.probed)

    @cached_property
    def bound(self) -> list[moderngl.Texture]:
        """Places and normals as they were bound, for a ``SkinPass``."""
        return [texture_of(self.gpu, rows) for rows in (self.mesh.positions, self.mesh.normals)]

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
        """Set a uniform for every way of skinning that there is by now."""
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

    def _content(self, rows: NDArray[np.intp]) -> list[tuple[Any, ...]]:
        mesh = self.mesh
        return [(self.gpu.buffer(mesh.positions[rows], label="bound places"), "3f", "in_position"),
                (self.gpu.buffer(mesh.normals[rows], label="bound normals"), "3f", "in_normal"),
                (self.gpu.buffer(mesh.texcoords[rows], label="texture places"), "2f", "in_texcoord")]

    def _texture(self, part: Part) -> moderngl.Texture | None:
        if part.texture is None:
            return None
        height, width = part.texture.shape[:2]
        made = self.gpu.texture((width, height), 4, part.texture, label="base colour")
        made.filter = moderngl.LINEAR, moderngl.LINEAR
        return made


class FollowingVertices:
    """Some of a model's vertices, and which bones each of them follows."""

    def __init__(self, shared: LimbModel, program: Program, rows: NDArray[np.intp], content: list[tuple[Any, ...]],
                 index: moderngl.Buffer | None = None) -> None:
        self.rows = rows
        (self._ways, *_), (self._shares, *_) = attributes = skin_attributes(
            shared.gpu, shared.mesh.joints[rows], shared.mesh.weights[rows])
        self.array = shared.gpu.vertex_array(program, [*content, *attributes], index)

    def follow(self, joints: NDArray[np.int32], weights: Rows) -> None:
        """Let them follow other bones; ``joints`` and ``weights`` are those of all vertices."""
        self._ways.write(np.ascontiguousarray(joints[self.rows], "u2"))
        self._shares.write(np.ascontiguousarray(weights[self.rows], "f4"))


class LimbSkin:
    """One way of skinning a model: ``linear`` or ``dual_quaternion``, with or without extra bones that share the twist.

    ``pose`` it, then ``draw`` it or ask for what the vertex shader made of it.
    """

    def __init__(self, shared: LimbModel, method: str) -> None:
        self.shared, self.method, self.twist_bones = shared, method, 0
        mesh, gpu = shared.mesh, shared.gpu
        self.matrices: Numbers = np.zeros((0, 4, 4))
        self.joints, self.weights = mesh.joints, mesh.weights
        self.palette = BonePalette(gpu, len(mesh.bones) + MOST_TWIST_BONES, method, influences=mesh.joints.shape[1],
                                   stretches=not shared.is_rigid)
        self._pass = SkinPass(gpu, shared.bound, mesh.joints, mesh.weights, self.palette) if shared.is_large else None
        drawing = shared.program(self.palette, posed_before=shared.is_large)
        self._whole = FollowingVertices(shared, drawing, shared.everywhere, shared.whole, shared.index)
        self._probes = FollowingVertices(shared, shared.program(self.palette), shared.probed, shared.probes) if len(
            shared.probed) else None
        self._posed: tuple[Rows, Rows] | None = None

    @property
    def upper(self) -> Numbers:
        """What moved the limb as a whole, (4, 4)."""
        return np.asarray(self.matrices[self.shared.limb.upper]) if self.shared.limb else np.eye(4)

    @property
    def is_bent(self) -> bool:
        """Whether the limb's lower bone is not only twisted against the upper: then it has no one axis."""
        limb = self.shared.limb
        if limb is None:
            return False
        between = nearest_rotation(np.linalg.pinv(self.upper[:3, :3]) @ self.matrices[limb.lower][:3, :3])
        swing, _ = swing_twist(between, limb.axis)
        return bool(abs(swing[3]) < math.cos(0.5 * MOST_SWING))

    def pose(self, local: Numbers, degrees: float, twist_bones: int = 0, *, probes_only: bool = False) -> None:
        """Stand as ``local`` (j, 4, 4) says, the limb twisted by ``degrees``, which extra bones share.

        With ``probes_only`` nothing but ``thinnest`` may be asked for until it is posed again.
        """
        limb, mesh = self.shared.limb, self.shared.mesh
        if limb and twist_bones != self.twist_bones:
            self.twist_bones = twist_bones
            self._follow(*with_twist_bones(limb, twist_bones))
        self.matrices = twisted_palette(limb, local, degrees, twist_bones) if limb else mesh.palette(local)
        self.palette.send(self.matrices)
        self._posed = None
        if self._pass and not probes_only:
            self._pass.run(BONES_UNIT)

    def draw(self, stand: Stand) -> None:
        """Draw it where it stands."""
        program = self._whole.array.program
        self.palette.bind(program, BONES_UNIT)
        if self._pass:
            self._pass.bind(program)
        program["u_aside"] = stand.aside
        program["u_turned"] = math.cos(stand.turned), math.sin(stand.turned)
        self.shared.draw_parts(self._whole.array)

    def posed(self) -> tuple[Rows, Rows]:
        """Where the GPU puts the vertices, (n, 3), in the model's own space, and the normals it gives them, (n, 3)."""
        if self._posed is None:
            self._posed = self._pass.read() if self._pass else self._captured()
        return self._posed

    def joint_places(self) -> Numbers:
        """Where the joints of the palette are, (b, 3), in the model's own space."""
        mesh = self.shared.mesh
        return np.asarray((self.matrices[:len(mesh.bones)] @ mesh.bound_frames)[:, :3, 3])

    def numbers(self) -> LimbNumbers | None:
        """How thin the limb has become, and what is left of it."""
        gauge = self.shared.gauge
        return gauge.numbers(self.posed()[0].astype(np.float64), self.upper) if gauge else None

    def radius_ratios(self) -> Numbers:
        """By how much the radius of each measured vertex of the limb has changed."""
        assert self.shared.limb and self.shared.gauge
        rows = self.shared.limb.measured
        return self.shared.gauge.radius_ratios(self.posed()[0][rows].astype(np.float64), self.upper, rows)

    def thinnest(self) -> float:
        """The smallest radius ratio among the probes; quicker than ``numbers``."""
        gauge, rows = self.shared.gauge, self.shared.probed
        if gauge is None or self._probes is None:
            return math.nan
        self.palette.bind(self._probes.array.program, BONES_UNIT)
        places = self._probes.array.capture({"v_posed": 3}, len(rows))["v_posed"]
        return float(gauge.radius_ratios(places.astype(np.float64), self.upper, rows).min())

    def _captured(self) -> tuple[Rows, Rows]:
        array = self._whole.array
        self.palette.bind(array.program, BONES_UNIT)
        found = array.capture({"v_posed": 3, "v_posed_normal": 3}, len(self._whole.rows))
        return found["v_posed"], found["v_posed_normal"]

    def _follow(self, joints: NDArray[np.int32], weights: Rows) -> None:
        """Let the vertices follow other bones."""
        self.joints, self.weights = joints, weights
        for each in (self._whole, self._probes, self._pass):
            if each:
                each.follow(joints, weights)


def _spread(limb: Limb, most: int) -> NDArray[np.intp]:
    """Vertices that are measured, one for each place on the limb, or where these are too many, evenly chosen."""
    measured = limb.measured
    _, first = np.unique(np.round(limb.along[measured], 6), return_index=True)
    return np.asarray(measured[first][::1 + len(first) // most])
