"""glTF files as one rigged mesh: nodes, skins, rigid parts, weights, materials."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from tests.kit.gltf_samples import SQUARE, Sample, flag, square
from viewer.kit.gltf import RiggedModel, read_model
from viewer.kit.rig import RiggedMesh
from viewer.kit.skinning import linear_blend, linear_blend_normals

MIRROR = [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]


def at_rest(mesh: RiggedMesh) -> NDArray[np.float64]:
    """Where the vertices are when nothing moves."""
    return linear_blend(mesh.positions, mesh.joints, mesh.weights, mesh.palette())


def read(sample: Sample, folder: Path) -> RiggedModel:
    """The model in a sample's file."""
    return read_model(sample.written(folder))


def test_nodes_become_joints_with_names_of_their_own(tmp_path: Path) -> None:
    """Each after its parent, however the file has them; those without a name are called by their number."""
    sample = square()
    for name, children in (("arm", [0]), ("arm", [1]), (None, []), ("arm (2)", [2, 3]), ("x" * 1000, []), ("a\nb", [])):
        sample.add("nodes", **({"name": name} if name else {}), **({"children": children} if children else {}))
    skeleton = read(sample, tmp_path).mesh.skeleton
    assert len(set(skeleton.names)) == 7 and {"square", "node 3", "a b"} < set(skeleton.names)
    assert all("\n" not in name and len(name) < 100 for name in skeleton.names)
    by_name = dict(zip(skeleton.names, skeleton.parents, strict=True))
    assert (skeleton.parents < np.arange(7)).all()
    assert skeleton.names[by_name["square"]].startswith("arm") and by_name["node 3"] == by_name["arm"]


def test_what_no_skin_moves_follows_its_node(tmp_path: Path) -> None:
    """And its node's parents: a square that is stretched, turned, moved, and moved again; a note says so."""
    sample = square()
    turn = Rotation.from_rotvec([0.3, -0.7, 0.2])
    sample.json["nodes"][0].update(translation=[1, 2, 3], rotation=turn.as_quat().tolist(), scale=[2, 3, 0.5])
    sample.add("nodes", children=[0], translation=[10, 0, 0])
    model = read(sample, tmp_path)
    expected = turn.apply(np.array(SQUARE) * [2, 3, 0.5]) + np.array([11, 2, 3])
    assert np.allclose(at_rest(model.mesh), expected, atol=1e-6)
    assert not model.has_skin and "no skin" in model.notes[0] and model.influences == 1
    assert model.mesh.skeleton.names[model.mesh.bones[0]] == "square"
    assert np.array_equal(model.mesh.inverse_bind, np.eye(4)[None])


def test_a_mesh_on_two_nodes_comes_twice(tmp_path: Path) -> None:
    """Each copy follows its own node."""
    sample = square()
    sample.add("nodes", mesh=0, translation=[0, 0, 5])
    mesh = read(sample, tmp_path).mesh
    assert np.allclose(at_rest(mesh)[:4], SQUARE) and np.allclose(at_rest(mesh)[4:], np.add(SQUARE, (0, 0, 5)))
    assert mesh.joints[:, 0].tolist() == [0] * 4 + [1] * 4 and mesh.triangles.max() == 7


@pytest.mark.parametrize("with_normals", [True, False])
def test_what_a_node_mirrors_still_faces_outwards(with_normals: bool, tmp_path: Path) -> None:
    """Triangles counter-clockwise as seen from where the normals point, on the mirrored and the plain copy."""
    sample = Sample()
    normals = {"NORMAL": sample.accessor([[0, 0, 1]] * 4)} if with_normals else {}
    mesh = sample.mesh(**normals)
    sample.add("nodes", mesh=mesh)
    sample.add("nodes", mesh=mesh, matrix=MIRROR)
    mesh_read = read(sample, tmp_path).mesh
    corners = at_rest(mesh_read)[mesh_read.triangles]
    faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    turned = linear_blend_normals(mesh_read.normals, mesh_read.joints, mesh_read.weights, mesh_read.palette())
    assert np.allclose(faces, [0, 0, 1]) and np.allclose(turned, [0, 0, 1], atol=1e-6)
    assert at_rest(mesh_read)[4:, 0].tolist() == [0, -1, -1, 0]


@pytest.mark.parametrize("scale", [(1, 1, 1), (2, 3, 0.5), (-1, 2, 1), (-2, -3, -1), (1, 0, 2), (0, 0, 0), (-1, 1, 0)])
def test_a_matrix_is_taken_apart_and_comes_together_again(scale: tuple[float, float, float], tmp_path: Path) -> None:
    """Mirrored and flattened ones too."""
    matrix = np.eye(4)
    matrix[:3, :3] = Rotation.from_rotvec([1.0, 0.4, -2.0]).as_matrix() * scale
    matrix[:3, 3] = [3, 2, 1]
    sample = square()
    sample.add("nodes", matrix=matrix.T.ravel().tolist())
    skeleton = read(sample, tmp_path).mesh.skeleton
    assert np.allclose(skeleton.world()[1], matrix, atol=1e-12)
    assert np.allclose(np.linalg.norm(skeleton.rotations, axis=1), 1.0)


def test_a_matrix_that_shears_is_remarked_on(tmp_path: Path) -> None:
    """A skeleton has no place for it."""
    sample = square()
    sample.json["nodes"][0]["matrix"] = [1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
    assert any("shears" in note for note in read(sample, tmp_path).notes)


def test_a_skinned_mesh_ignores_the_node_on_which_it_hangs(tmp_path: Path) -> None:
    """Only the joints move it."""
    sample = flag()
    plain = at_rest(read(sample, tmp_path).mesh)
    sample.json["nodes"][0]["translation"] = [100, 0, 0]
    assert np.array_equal(at_rest(read(sample, tmp_path).mesh), plain)
    sample.json["nodes"][1]["translation"] = [0, 0, 7]
    assert np.allclose(at_rest(read(sample, tmp_path).mesh), np.add(plain, (0, 0, 7)))


def test_each_entry_of_the_palette_follows_a_joint_of_a_skin(tmp_path: Path) -> None:
    """With its inverse bind matrix; two skins and a rigid mesh stand one after another."""
    sample = flag()
    sample.add("skins", joints=[2])
    sample.add("nodes", mesh=sample.mesh(JOINTS_0=sample.accessor([[0] * 4] * 4, "uint16"),
                                         WEIGHTS_0=sample.accessor([[1, 0, 0, 0]] * 4)), skin=1, name="other")
    sample.add("nodes", mesh=sample.mesh(), name="rigid")
    mesh = read(sample, tmp_path).mesh
    assert [mesh.skeleton.names[bone] for bone in mesh.bones] == ["first", "second", "second", "rigid"]
    assert mesh.inverse_bind[1, 1, 3] == -0.5 and np.array_equal(mesh.inverse_bind[2], np.eye(4))
    followed = [set(mesh.joints[some][mesh.weights[some] > 0].tolist()) for some in
                (slice(0, 4), slice(4, 8), slice(8, 12))]
    assert followed == [{0, 1}, {2}, {3}]


def test_only_the_default_scene_is_shown(tmp_path: Path) -> None:
    """With the joints that its skins need, wherever they are."""
    sample = flag()
    sample.add("nodes", mesh=sample.mesh(), name="elsewhere")
    sample.json.update(scenes=[{"nodes": [3]}, {"nodes": [0]}], scene=1)
    model = read(sample, tmp_path)
    assert len(model.mesh.positions) == 4 and model.mesh.skeleton.names == ("flag", "first", "second")


def test_weights_that_do_not_sum_to_one_look_right(tmp_path: Path) -> None:
    """Sums of 0.18: counted, normalised, and nothing moves at rest; without that all would shrink to 0.18."""
    sums = np.array([[0.18, 0, 0, 0], [0.09, 0.09, 0, 0], [0.0, 0.18, 0, 0], [0.06, 0.12, 0, 0]])
    model = read(flag(sums), tmp_path)
    assert model.unnormalised_vertices == 4 and np.allclose(model.mesh.weights.sum(axis=1), 1.0, atol=1e-6)
    assert np.allclose(model.mesh.weights, sums / 0.18, atol=1e-6)
    assert np.allclose(at_rest(model.mesh), SQUARE, atol=1e-6)


@pytest.mark.parametrize(("dtype", "largest"), [("uint8", 255), ("uint16", 65535)])
def test_whole_numbers_are_shares_of_the_largest(dtype: str, largest: int, tmp_path: Path) -> None:
    """As weights that are exact, of which none is counted."""
    weights = np.array([[largest, 0, 0, 0], [largest // 5, largest - largest // 5, 0, 0]] * 2)
    model = read(flag(weights, dtype=dtype, normalized=True), tmp_path)
    assert model.unnormalised_vertices == 0 and model.influences == 2
    assert np.allclose(model.mesh.weights[1], [0.2, 0.8, 0, 0], atol=1e-6)


@pytest.mark.parametrize(("row", "expected", "note"), [
    ([0, 0, 0, 0], [1, 0, 0, 0], "without any weight"), ([np.nan, 1, 0, 0], [0, 1, 0, 0], "no numbers"),
    ([-1, 1, 0, 0], [0, 1, 0, 0], "negative"), ([np.inf, 1, 0, 0], [0, 1, 0, 0], "no numbers")])
def test_weights_that_mean_nothing_are_counted(row: list[float], expected: list[float], note: str,
                                               tmp_path: Path) -> None:
    """They count as 0; a vertex without any follows its first joint."""
    model = read(flag([row, [1, 0, 0, 0], [0, 1, 0, 0], [1, 0, 0, 0]]), tmp_path)
    assert model.mesh.weights[0].tolist() == expected and model.unnormalised_vertices == 1
    assert any(note in text for text in model.notes)


def test_joints_without_weights_and_weights_without_joints(tmp_path: Path) -> None:
    """The first joint moves the one, and nothing but the node the other."""
    sample = flag()
    attributes = sample.json["meshes"][0]["primitives"][0]["attributes"]
    weights = attributes.pop("WEIGHTS_0")
    model = read(sample, tmp_path)
    assert model.unnormalised_vertices == 4 and (model.mesh.weights[:, 0] == 1).all() and model.has_skin
    assert any("without weights" in note for note in model.notes)
    attributes.pop("JOINTS_0")
    attributes["WEIGHTS_0"] = weights
    model = read(sample, tmp_path)
    assert not model.has_skin and any("without joints" in note for note in model.notes)


@pytest.mark.parametrize(("count", "width"), [(3, 4), (5, 8), (8, 8), (12, 8)])
def test_as_many_influences_as_are_needed(count: int, width: int, tmp_path: Path) -> None:
    """Four or eight columns; of more than eight the heaviest are kept, and a note says so."""
    sample = flag()
    weights = np.zeros((4, 12))
    weights[:, :count] = np.arange(1, count + 1) / (count * (count + 1) / 2)
    order = np.random.default_rng(5).permutation(12)
    attributes = sample.json["meshes"][0]["primitives"][0]["attributes"]
    for number in range(3):
        columns = order[4 * number:4 * number + 4]
        attributes[f"JOINTS_{number}"] = sample.accessor(np.tile(columns, (4, 1)), "uint8")
        attributes[f"WEIGHTS_{number}"] = sample.accessor(weights[:, columns])
    sample.json["skins"] = [{"joints": list(range(1, 13))}]
    sample.json["nodes"] = [{"mesh": 0, "skin": 0}, *({} for _ in range(12))]
    model = read(sample, tmp_path)
    assert model.mesh.weights.shape == (4, width) and model.influences == min(count, 8)
    heaviest = np.arange(1, count + 1)[-8:]
    found = np.bincount(model.mesh.joints[2], model.mesh.weights[2], 12)
    assert np.allclose(found[count - len(heaviest):count], heaviest / heaviest.sum(), atol=1e-6)
    assert any("8 heaviest" in note for note in model.notes) == (count > 8)


def test_parts_have_the_colours_of_their_materials(tmp_path: Path) -> None:
    """Neighbours with the same material are one part; what has none is white metal, as the format has it."""
    sample = square()
    sample.add("materials", pbrMetallicRoughness={"baseColorFactor": [1, 0.5, 0, 0.25], "metallicFactor": 0.1,
                                                  "roughnessFactor": 0.2}, doubleSided=True)
    plain = sample.json["meshes"][0]["primitives"][0]
    sample.json["meshes"][0]["primitives"] = [{**plain, "material": 0}, {**plain, "material": 0}, plain]
    first, second = read(sample, tmp_path).parts
    assert (first.first, first.count, first.color) == (0, 4, (1.0, 0.5, 0.0, 0.25))
    assert (first.metallic, first.roughness, first.double_sided) == (0.1, 0.2, True)
    assert (second.first, second.count, second.color) == (4, 2, (1.0, 1.0, 1.0, 1.0))
    assert (second.metallic, second.roughness, second.double_sided, second.texture) == (1.0, 1.0, False, None)


def test_what_is_left_out_is_told(tmp_path: Path) -> None:
    """Morph targets, points and lines, extensions for looks."""
    sample = square()
    primitive = sample.json["meshes"][0]["primitives"][0]
    sample.json["meshes"][0]["primitives"] = [{**primitive, "targets": [{"POSITION": 0}]}, {**primitive, "mode": 1}]
    sample.json["extensionsRequired"] = ["KHR_materials_unlit", "KHR_mesh_quantization"]
    notes = " ".join(read(sample, tmp_path).notes)
    assert "morph targets" in notes and "no triangles" in notes and "KHR_materials_unlit" in notes
    assert "quantization" not in notes
