"""Mesh files of all kinds: read whole and in place, or refused in one line."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest
import trimesh

from viewer.kit.mesh_file import SUFFIXES, MeshFileError, read_mesh

MODELS = Path(__file__).parents[3] / "shared" / "models"
BALL = trimesh.creation.icosphere(2)


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_every_kind_is_read(suffix: str, tmp_path: Path) -> None:
    """The same surface, however it is written."""
    path = tmp_path / f"ball{suffix}"
    if suffix == ".gltf":
        for name, data in trimesh.Scene(BALL).export(file_type="gltf").items():
            (tmp_path / (name if name != "model.gltf" else path.name)).write_bytes(data)
    else:
        BALL.export(path)
    mesh = read_mesh(path)
    assert mesh.vertices.dtype == np.float64 and mesh.triangles.dtype == np.int32
    corners = mesh.vertices[mesh.triangles].reshape(len(BALL.faces), -1)
    assert np.allclose(corners, BALL.triangles.reshape(len(BALL.faces), -1), atol=1e-6)


def test_normals_are_those_of_the_file(tmp_path: Path) -> None:
    """Where it has any."""
    BALL.export(tmp_path / "plain.ply", vertex_normal=False)
    assert read_mesh(tmp_path / "plain.ply").normals is None
    BALL.export(tmp_path / "smooth.ply", vertex_normal=True)
    normals = read_mesh(tmp_path / "smooth.ply").normals
    assert normals is not None and np.allclose(normals, BALL.vertex_normals, atol=1e-6)


def test_the_parts_of_a_scene_stand_where_the_scene_has_them(tmp_path: Path) -> None:
    """Moved, stretched, mirrored; the normals with them, outwards still."""
    scene = trimesh.Scene()
    mirror = trimesh.transformations.compose_matrix(scale=[-1, 2, 1], translate=[5, 0, 0])
    BALL.vertex_normals  # noqa: B018
    scene.add_geometry(BALL, node_name="mirrored", geom_name="ball", transform=mirror)
    scene.add_geometry(BALL, node_name="lifted", geom_name="ball",
                       transform=trimesh.transformations.translation_matrix([0, 3, 0]))
    scene.export(tmp_path / "two.glb", include_normals=True)
    mesh = read_mesh(tmp_path / "two.glb")
    assert len(mesh.triangles) == 2 * len(BALL.faces)
    solid = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
    assert solid.volume == pytest.approx(3 * BALL.volume, rel=1e-4)
    assert np.allclose(solid.bounds, [[-1, -2, -1], [6, 4, 1]], atol=0.02)
    assert mesh.normals is not None
    facing = np.einsum("tci,ti->tc", mesh.normals[mesh.triangles], solid.face_normals)
    assert facing.min() > 0.8


def test_polygons_become_triangles(tmp_path: Path) -> None:
    """And points beside them are left out."""
    text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"
    (tmp_path / "square.obj").write_text(text)
    assert len(read_mesh(tmp_path / "square.obj").triangles) == 2


@pytest.mark.skipif(not MODELS.is_dir(), reason="the models are not here")
@pytest.mark.parametrize(("name", "triangles"), [("Fox.glb", 576), ("RiggedSimple.glb", 188), ("SimpleSkin.gltf", 8)])
def test_models_made_elsewhere_are_read(name: str, triangles: int) -> None:
    """With skins and animations, which do not matter here."""
    assert len(read_mesh(MODELS / name).triangles) == triangles


HEADER = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
FACES = "element face 1\nproperty list uchar int vertex_indices\nend_header\n"


@pytest.mark.parametrize(("name", "content", "reason"), [
    ("empty.obj", b"", r"is empty$"),
    ("words.obj", b"to be or not to be\n", r"holds no triangles|damaged or no mesh"),
    ("words.stl", b"solid of nothing much\n", r"holds no triangles|cut short, damaged or no mesh|has no area"),
    ("words.ply", b"this is not a ply\n", r"damaged or no mesh"),
    ("words.glb", b"this is not a glb file at all", r"damaged or no mesh"),
    ("words.gltf", b"{\"asset\": ", r"cut short, damaged or no mesh|holds no triangles"),
    ("nothing.gltf", b"{\"asset\": {\"version\": \"2.0\"}}", r"holds no triangles|damaged or no mesh"),
    ("short.stl", b"\0" * 80 + struct.pack("<I", 1000) + b"\0" * 100, r"damaged or no mesh|holds no triangles"),
    ("huge.stl", b"\0" * 80 + struct.pack("<I", 2**32 - 1) + b"\0" * 100, r"damaged or no mesh|holds no triangles"),
    ("nan.ply", (HEADER + FACES + "0 0 0\n1 0 0\n0 nan 0\n3 0 1 2\n").encode(), r"vertex 2 at \(0, nan, 0\); finite"),
    ("inf.obj", b"v 0 0 0\nv inf 0 0\nv 0 1 0\nf 1 2 3\n", r"vertex 1 at \(inf, 0, 0\); finite"),
    ("far.obj", b"v 0 0 0\nv 1e20 0 0\nv 0 1 0\nf 1 2 3\n", r"reaches 1e\+20 m from the origin; at most 1e\+06 m"),
    ("line.obj", b"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", r"has no area"),
    ("wild.ply", (HEADER + FACES + "0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n").encode(), r"vertex 9; there are 3|damaged"),
    ("points.ply", (HEADER + "end_header\n0 0 0\n1 0 0\n0 1 0\n").encode(), r"holds only points or lines; triangles"),
    ("curve.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3\n", r"holds only points or lines; triangles"),
    ("range.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", r"cannot be read: it is cut short, damaged or no mesh$"),
    ("ball.png", b"png", r"ends in \.png; \.obj, "),
])
def test_what_is_no_mesh_is_refused_in_one_line(name: str, content: bytes, reason: str, tmp_path: Path) -> None:
    """Naming the file and the reason."""
    (tmp_path / name).write_bytes(content)
    with pytest.raises(MeshFileError, match=reason) as refused:
        read_mesh(tmp_path / name)
    assert str(refused.value).startswith(f"mesh {tmp_path / name} ") and "\n" not in str(refused.value)


@pytest.mark.parametrize("suffix", [".ply", ".glb", ".stl"])
def test_a_file_cut_short_is_refused(suffix: str, tmp_path: Path) -> None:
    """Wherever it ends."""
    BALL.export(tmp_path / f"whole{suffix}")
    content = (tmp_path / f"whole{suffix}").read_bytes()
    for part in (0.01, 0.3, 0.6, 0.99):
        (tmp_path / f"cut{suffix}").write_bytes(content[:int(len(content) * part)])
        with pytest.raises(MeshFileError) as refused:
            read_mesh(tmp_path / f"cut{suffix}")
        assert "Error" not in str(refused.value) and "unpack" not in str(refused.value)


def test_missing_files_and_folders_are_named(tmp_path: Path) -> None:
    """Before anything is read."""
    with pytest.raises(MeshFileError, match=r"gone\.obj does not exist$"):
        read_mesh(tmp_path / "gone.obj")
    (tmp_path / "folder.obj").mkdir()
    with pytest.raises(MeshFileError, match=r"folder\.obj is not a file$"):
        read_mesh(tmp_path / "folder.obj")
