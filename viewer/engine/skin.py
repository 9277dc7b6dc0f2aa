"""Bones on the GPU, and the meshes that follow them."""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.gpu import Gpu, GpuError
from viewer.engine.program import Program
from viewer.kit.quaternion import Numbers, nearest_rotation
from viewer.kit.skinning import rigid_parts

METHODS = {"linear": "LINEAR_BLEND", "dual_quaternion": "DUAL_QUATERNION"}
TEXELS = 8          # of a bone: its matrix, its motion, its stretch, as shaders/lib/skinning.glsl reads them


class BonePalette:
    """What moves a mesh's vertices: matrices in a float texture, one row a bone, for shaders/lib/skinning.glsl.

    A program that includes it is made with ``generated=palette.generated`` and given to ``bind`` before it runs.
    ``method`` is ``linear`` or ``dual_quaternion``; ``influences`` is 4 or 8 for ``lib/skin_vertex.glsl``;
    ``stretches`` says that bones may also scale, which costs time. Raises GpuError for more bones than a texture
    has rows.
    """

    def __init__(self, gpu: Gpu, bones: int, method: str = "linear", *, influences: int = 4,
                 stretches: bool = False) -> None:
        if not 1 <= bones <= gpu.largest_texture:
            raise GpuError(f"{bones} bones are outside 1 to {gpu.largest_texture}, what this GPU takes")
        self.method, self.influences, self.stretches = method, influences, stretches
        self.generated = {"generated/skinning.glsl": self.constants}
        self._texels = np.zeros((bones, TEXELS, 4), np.float32)
        self._texture = gpu.texture((TEXELS, bones), 4, dtype="f4", label="bones")
        self._texture.filter = moderngl.NEAREST, moderngl.NEAREST

    def constants(self) -> str:
        """GLSL that says how bones are blended."""
        return (f"#define INFLUENCES {self.influences}\nconst int SKINNING_METHOD = {METHODS[self.method]};\n"
                f"const bool BONES_STRETCH = {str(self.stretches).lower()};\n")

    def send(self, matrices: Numbers) -> None:
        """Let the first bones move by ``matrices`` (b, 4, 4), for columns, from now on; rigid unless ``stretches``."""
        moved = self._texels[:len(matrices)]
        moved[:, :3] = matrices[:, :3]
        if self.method == "dual_quaternion":
            moved[:, 3], moved[:, 4], stretch = rigid_parts(matrices)
            moved[:, 5:8] = np.eye(4)[:3] if stretch is None else stretch[:, :3]
        elif not self.stretches:
            moved[:, 3], moved[:, 4, :3] = nearest_rotation(matrices[:, :3, :3]), matrices[:, :3, 3]
        self._texture.write(self._texels)

    def bind(self, program: Program, unit: int) -> None:
        """Give the bones to a program, in a texture unit."""
        program["u_bones"] = unit
        self._texture.use(unit)


def skin_attributes(gpu: Gpu, joints: NDArray[Any], weights: NDArray[Any]) -> list[tuple[Any, ...]]:
    """What a vertex array needs for skinning: ``joints`` and ``weights`` (n, 4) or (n, 8).

    The attributes are ``in_joints`` and ``in_weights``, beyond four influences ``in_more_joints`` and
    ``in_more_weights`` too. Raises ValueError for any other number of columns.
    """
    if joints.shape[1] not in (4, 8) or joints.shape != weights.shape:
        raise ValueError(f"joints {joints.shape} and weights {weights.shape} are not four or eight for each vertex")
    ways = gpu.buffer(np.ascontiguousarray(joints, "u2"), label="joints")
    shares = gpu.buffer(np.ascontiguousarray(weights, "f4"), label="weights")
    groups = joints.shape[1] // 4
    names = [("in_joints", "in_weights"), ("in_more_joints", "in_more_weights")][:groups]
    return [(ways, " ".join(["4u2"] * groups), *(joint for joint, _ in names)),
            (shares, " ".join(["4f"] * groups), *(weight for _, weight in names))]
