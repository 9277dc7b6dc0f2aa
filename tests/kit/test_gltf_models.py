"""Three models that others have made: what is in them, and where their vertices go by the format's own formula."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation, Slerp

from viewer.kit.gltf import read_model
from viewer.kit.mesh_file import read_mesh
from viewer.kit.skinning import linear_blend

MODELS = Path(__file__).parents[3] / "shared" / "models"
TYPES = {5121: "<u1", 5123: "<u2", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}

pytestmark = pytest.mark.skipif(not MODELS.is_dir(), reason="the models are not here")


class Reference:
    """A GLB file by the letter of the format: one matrix after another, one vertex after another, in float64."""

    def __init__(self, path: Path) -> None:
        data = path.read_bytes()
        length = struct.unpack_from("<I", data, 12)[0]
        self.json: dict[str, Any] = json.loads(data[20:20 + length])
        self.binary = data[28 + length:]

    def array(self, number: int) -> NDArray[Any]:
        accessor = self.json["accessors"][number]
        view = self.json["bufferViews"][accessor["bufferView"]]
        width, kind = WIDTHS[accessor["type"]], np.dtype(TYPES[accessor["componentType"]])
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        stride = view.get("byteStride", width * kind.itemsize)
        return np.stack([np.frombuffer(self.binary, kind, width, start + row * stride)
                         for row in range(accessor["count"])])

    def local(self, animation: int, time: float) -> list[NDArray[np.float64]]:
        """Each node's matrix, with what the animation says at ``time``."""
        nodes = [dict(node) for node in self.json["nodes"]]
        chosen = self.json["animations"][animation]
        for channel in chosen["channels"]:
            sampler = chosen["samplers"][channel["sampler"]]
            times, values = self.array(sampler["input"])[:, 0].astype(float), self.array(sampler["output"])
            now = np.clip(time, times[0], times[-1])
            path = channel["target"]["path"]
            if path == "rotation":
                value = Slerp(times, Rotation.from_quat(values.astype(float)))([now])[0].as_quat()
            else:
                value = np.array([np.interp(now, times, column) for column in values.T])
            nodes[channel["target"]["node"]][path] = value
        return [matrix_of(node) for node in nodes]

    def posed(self, animation: int, time: float) -> NDArray[np.float64]:
        """sum over w_i * world(joint_i) * inverseBind_i * position, for each vertex of the only primitive."""
        local = self.local(animation, time)
        parent = {child: node for node, entry in enumerate(self.json["nodes"]) for child in entry.get("children", [])}

        def world(node: int) -> NDArray[np.float64]:
            return world(parent[node]) @ local[node] if node in parent else local[node]

        skin = self.json["skins"][0]
        inverse = self.array(skin["inverseBindMatrices"]).astype(float).reshape(-1, 4, 4).transpose(0, 2, 1)
        bones = [world(joint) @ bind for joint, bind in zip(skin["joints"], inverse, strict=True)]
        attributes = self.json["meshes"][0]["primitives"][0]["attributes"]
        positions, joints, weights = (self.array(attributes[name]) for name in ("POSITION", "JOINTS_0", "WEIGHTS_0"))
        places = []
        for position, who, how_much in zip(positions, joints, weights.astype(float), strict=True):
            matrix = sum(weight * bones[joint] for joint, weight in zip(who, how_much / how_much.sum(), strict=True))
            places.append((matrix @ np.append(position.astype(float), 1.0))[:3])
        return np.array(places)


def matrix_of(node: dict[str, Any]) -> NDArray[np.float64]:
    """A node's matrix, given as such or as translation, rotation and scale."""
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    matrix = np.eye(4)
    turn = Rotation.from_quat(node.get("rotation", [0, 0, 0, 1])).as_matrix()
    matrix[:3, :3] = turn * np.asarray(node.get("scale", [1, 1, 1]), float)
    matrix[:3, 3] = node.get("translation", [0, 0, 0])
    return matrix


@pytest.mark.parametrize(("name", "vertices", "triangles", "bones", "influences", "clips"), [
    ("SimpleSkin.gltf", 10, 8, 2, 2, [("animation 0", 5.5)]),
    ("RiggedSimple.glb", 96, 188, 2, 2, [("animation 0", 2.0833330154418945)]),
    ("Fox.glb", 1728, 576, 24, 4,
     [("Survey", 3.4166667461395264), ("Walk", 0.7083333134651184), ("Run", 1.1583333015441895)]),
])
def test_what_is_in_them(name: str, vertices: int, triangles: int, bones: int, influences: int,
                         clips: list[tuple[str, float]]) -> None:
    """Counts, and the names and lengths of the animations."""
    model = read_model(MODELS / name)
    mesh = model.mesh
    assert (mesh.positions.shape, mesh.triangles.shape) == ((vertices, 3), (triangles, 3))
    assert (len(mesh.bones), model.influences, mesh.joints.shape[1]) == (bones, influences, 4)
    assert [(clip.name, clip.seconds) for clip in model.clips] == clips
    assert (model.name, model.has_skin, model.unnormalised_vertices, model.notes) == (name.split(".")[0], True, 0, ())


@pytest.mark.parametrize(("name", "animation", "time"), [
    ("RiggedSimple.glb", 0, 0.7), ("RiggedSimple.glb", 0, 1.9), ("Fox.glb", 0, 1.234), ("Fox.glb", 1, 0.5),
    ("Fox.glb", 2, 0.03), ("Fox.glb", 2, 99.0)])
def test_a_posed_frame_agrees_with_the_formula(name: str, animation: int, time: float) -> None:
    """Vertex by vertex, to a millionth of the model's size."""
    model = read_model(MODELS / name)
    mesh = model.mesh
    local = mesh.skeleton.local(*model.clips[animation].pose(mesh.skeleton, time))
    posed = linear_blend(mesh.positions, mesh.joints, mesh.weights, mesh.palette(local))
    expected = Reference(MODELS / name).posed(animation, time)
    assert np.abs(posed - expected).max() < 1e-6 * np.ptp(expected)
    at_rest = linear_blend(mesh.positions, mesh.joints, mesh.weights, mesh.palette())
    assert np.abs(posed - at_rest).max() > 0.01 * np.ptp(expected)


@pytest.mark.parametrize("name", ["RiggedSimple.glb", "Fox.glb"])
def test_at_rest_they_have_the_shape_that_trimesh_reads(name: str) -> None:
    """Both files stand at rest as they were bound."""
    mesh = read_model(MODELS / name).mesh
    ours = linear_blend(mesh.positions, mesh.joints, mesh.weights, mesh.palette())[mesh.triangles]
    other = read_mesh(MODELS / name)
    theirs = other.vertices[other.triangles]
    assert np.abs(ours - theirs).max() < 1e-4 * np.ptp(theirs)


def test_the_simple_skin_bends_as_its_tutorial_shows() -> None:
    """Its upper joint, a metre up, turns by a quarter to the left and back: the strip's top comes to lie level."""
    model = read_model(MODELS / "SimpleSkin.gltf")
    mesh = model.mesh
    corners = [[x, y, 0.0] for y in (0.0, 0.5, 1.0, 1.5, 2.0) for x in (0.0, 1.0)]
    assert np.array_equal(mesh.positions, corners)
    assert np.array_equal(mesh.weights[:, 1], np.repeat([0.0, 0.25, 0.5, 0.75, 1.0], 2).astype(np.float32))
    top = {}
    for time in (0.0, 1.5, 4.0):
        local = mesh.skeleton.local(*model.clips[0].pose(mesh.skeleton, time))
        top[time] = linear_blend(mesh.positions, mesh.joints, mesh.weights, mesh.palette(local))[-2:]
    assert np.allclose(top[0.0], [[-0.5, 2, 0], [0.5, 2, 0]], atol=1e-6)
    assert np.allclose(top[1.5], [[-1, 0.5, 0], [-1, 1.5, 0]], atol=1e-6)
    assert np.allclose(top[4.0], [[1, 1.5, 0], [1, 0.5, 0]], atol=1e-6)


def test_the_fox_wears_its_texture() -> None:
    """One part, one picture, of which its texture coordinates lie inside."""
    model = read_model(MODELS / "Fox.glb")
    part, = model.parts
    assert (part.first, part.count, part.metallic, part.roughness) == (0, 576, 0.0, 0.58)
    assert part.texture is not None and part.texture.shape == (1024, 1024, 4)
    places = (model.mesh.texcoords * 1024).astype(int).clip(0, 1023)
    orange = part.texture[places[:, 1], places[:, 0], :3].astype(int).mean(axis=0)
    assert orange[0] > orange[1] > orange[2]
