"""What the vertex shader makes of a rig is what NumPy makes of it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import moderngl
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from viewer.engine.catalog import builtin_pack
from viewer.engine.gpu import Gpu, GpuError
from viewer.engine.shaders import ShaderFolders
from viewer.engine.skin import BonePalette, skin_attributes
from viewer.engine.skin_pass import SkinPass, texture_of
from viewer.kit import skinning
from viewer.kit.rig import composed

VERTICES = 1000
SHADER = """#version 330 core
#include "lib/skin_vertex.glsl"
in vec3 in_position;
in vec3 in_normal;
out vec3 v_position;
out vec3 v_normal;
out float v_weight;
void main() {
    v_position = in_position;
    v_normal = in_normal;
    skin_vertex(v_position, v_normal);
    v_weight = weight_of(3);
}
"""


def rig(bones: int, influences: int, *, scaled: bool) -> tuple[np.ndarray, ...]:
    """Positions, normals, joints, weights, some of them 0, and matrices."""
    chance = np.random.default_rng(bones + influences)
    joints = np.argsort(chance.random((VERTICES, bones)), axis=1)[:, :influences]
    weights = chance.random((VERTICES, influences)) * (chance.random((VERTICES, influences)) > 0.3)
    weights = skinning.normalise_weights(weights)[0]
    scales = np.exp(0.3 * chance.normal(size=(bones, 3))) if scaled else np.ones((bones, 3))
    turns = Rotation.from_rotvec(0.8 * chance.normal(size=(bones, 3))).as_quat()
    normals = chance.normal(size=(VERTICES, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return (chance.normal(size=(VERTICES, 3)).astype("f4"), normals.astype("f4"), joints, weights,
            composed(chance.normal(size=(bones, 3)), turns, scales))


@pytest.fixture
def gpu(context: moderngl.Context, tmp_path: Path) -> Iterator[Gpu]:
    """An arena with the shader above, freed by the test's end."""
    (tmp_path / "skin.vert").write_text(SHADER)
    arena = Gpu(context, ShaderFolders([tmp_path, builtin_pack() / "shaders"]))
    arena.framebuffer([arena.texture((4, 4), 4)]).use()
    yield arena
    arena.release()


@pytest.mark.parametrize("method", ["linear", "dual_quaternion"])
@pytest.mark.parametrize("influences", [4, 8])
@pytest.mark.parametrize(("bones", "scaled"), [(9, False), (256, False), (256, True)])
def test_the_vertex_shader_skins_as_numpy_does(gpu: Gpu, method: str, influences: int, bones: int,
                                               scaled: bool) -> None:
    """Places within 1e-5 of their size, normals too where the blended bones are not nearly flat."""
    positions, normals, joints, weights, matrices = rig(bones, influences, scaled=scaled)
    palette = BonePalette(gpu, bones, method, influences=influences, stretches=scaled)
    palette.send(matrices)
    program = gpu.program("skin.vert", generated=palette.generated)
    array = gpu.vertex_array(program, [
        (gpu.buffer(positions), "3f", "in_position"), (gpu.buffer(normals), "3f", "in_normal"),
        *skin_attributes(gpu, joints, weights)])
    palette.bind(program, 2)
    found = array.capture({"v_position": 3, "v_normal": 3, "v_weight": 1}, VERTICES)
    blend = {"linear": "linear_blend", "dual_quaternion": "dual_quaternion"}[method]
    expected = getattr(skinning, blend)(positions, joints, weights, matrices)
    assert np.abs(found["v_position"] - expected).max() < 1e-5
    turned = getattr(skinning, f"{blend}_normals")(normals, joints, weights, matrices)
    assert np.quantile(np.abs(found["v_normal"] - turned).max(axis=1), 0.99) < 1e-4
    assert np.allclose(found["v_weight"], np.where(joints == 3, weights, 0.0).sum(axis=1), atol=1e-6)


def test_more_bones_than_a_texture_holds_are_refused(gpu: Gpu) -> None:
    """With the number and what is allowed."""
    with pytest.raises(GpuError, match=r"^0 bones are outside 1 to \d+"):
        BonePalette(gpu, 0)


@pytest.mark.parametrize("method", ["linear", "dual_quaternion"])
@pytest.mark.parametrize(("influences", "scaled"), [(4, False), (8, True)])
def test_a_pass_skins_as_numpy_does(gpu: Gpu, method: str, influences: int, scaled: bool) -> None:
    """One fragment a vertex, also after the vertices were given to other bones."""
    positions, normals, joints, weights, matrices = rig(20, influences, scaled=scaled)
    palette = BonePalette(gpu, 20, method, influences=influences, stretches=scaled)
    palette.send(matrices)
    skin = SkinPass(gpu, [texture_of(gpu, positions), texture_of(gpu, normals)], joints, weights, palette)
    blend = {"linear": "linear_blend", "dual_quaternion": "dual_quaternion"}[method]
    for ways in (joints, (joints + 7) % 20):
        skin.follow(ways, weights)
        skin.run(0)
        places, turned = skin.read()
        assert np.abs(places - getattr(skinning, blend)(positions, ways, weights, matrices)).max() < 1e-5
        expected = getattr(skinning, f"{blend}_normals")(normals, ways, weights, matrices)
        assert np.quantile(np.abs(turned - expected).max(axis=1), 0.99) < 1e-4
