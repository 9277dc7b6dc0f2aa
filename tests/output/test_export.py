"""Exports read back by other programs: the displaced positions and those normals."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import plyfile
import pytest
import trimesh
from numpy.typing import NDArray

from viewer import cli
from viewer.output.export import ExportError, export

Points = NDArray[np.float64]
pytestmark = pytest.mark.usefixtures("context")
AMPLITUDE, FREQUENCY = 0.05, 10.0
WORDS = ["export", "rippling_sphere", "--set", "subdivision=4", "--set", "normals=exact"]


def written(tmp_path: Path, kind: str, *more: str) -> Path:
    """The sphere exported as ``kind``."""
    path = tmp_path / f"s.{kind}"
    assert cli.main([*WORDS, *more, "--out", str(path)]) == 0
    assert list(tmp_path.iterdir()) == [path]
    return path


def undisplaced(vertices: Points, direction: str) -> Points:
    """The points of the unit sphere that were moved to ``vertices``, found by going back step by step."""
    start = vertices / np.linalg.norm(vertices, axis=1, keepdims=True)
    for _ in range(200):
        ripple = AMPLITUDE * np.cos(FREQUENCY * start[:, :1])
        back = vertices / (1 + ripple) if direction == "normal" else vertices - ripple * [1.0, 0.0, 0.0]
        start = 0.5 * (start + back)
    return start


def expected_normals(points: Points, direction: str) -> Points:
    """n' ~ cof(I + grad d) n, written out for a ripple along x and along the normal."""
    slope = np.zeros_like(points)
    slope[:, 0] = -AMPLITUDE * FREQUENCY * np.sin(FREQUENCY * points[:, 0])
    if direction == "x":
        normals = points * (1 + slope[:, :1])
        normals[:, 0] = points[:, 0]
    else:
        ripple = AMPLITUDE * np.cos(FREQUENCY * points[:, :1])
        normals = points - (slope - np.sum(slope * points, axis=1, keepdims=True) * points) / (1 + ripple)
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def assert_rippled(vertices: Points, direction: str, normals: Points | None) -> None:
    """Positions are those of the displaced unit sphere, and normals those of it."""
    assert vertices.shape[1] == 3
    points = undisplaced(np.asarray(vertices, float), direction)
    assert np.abs(np.linalg.norm(points, axis=1) - 1).max() < 2e-6
    assert np.ptp(np.linalg.norm(vertices, axis=1)) > AMPLITUDE
    if normals is not None:
        off = np.linalg.norm(np.cross(normals, expected_normals(points, direction)), axis=1)
        assert np.degrees(off.max()) < 0.01
        assert np.sum(normals * points) > 0


@pytest.mark.parametrize("direction", ["x", "normal"])
def test_a_ply_opens_elsewhere(tmp_path: Path, direction: str) -> None:
    """In trimesh and in plyfile: positions, normals, triangles, closed."""
    path = written(tmp_path, "ply", "--set", f"direction={direction}")
    solid = trimesh.load(path, process=False)
    assert (len(solid.vertices), len(solid.faces)) == (2562, 5120)
    assert solid.is_watertight and solid.is_winding_consistent and solid.volume > 0
    assert_rippled(solid.vertices, direction, solid.vertex_normals)

    data = plyfile.PlyData.read(path)
    read = {name: np.stack([data["vertex"][axis] for axis in axes], axis=1)
            for name, axes in (("vertices", "xyz"), ("normals", ("nx", "ny", "nz")))}
    assert_rippled(read["vertices"], direction, read["normals"])
    assert np.array_equal(np.vstack(data["face"]["vertex_indices"]), solid.faces)


def test_an_obj_opens_elsewhere(tmp_path: Path) -> None:
    """With its normals, one for each vertex."""
    path = written(tmp_path, "obj", "--set", "direction=x")
    lines = [line.split() for line in path.read_text().splitlines()]
    vertices, normals = (np.array([line[1:4] for line in lines if line[:1] == [key]], float) for key in ("v", "vn"))
    assert_rippled(vertices, "x", normals)
    faces = [line[1:] for line in lines if line[:1] == ["f"]]
    assert len(faces) == 5120
    assert all(corner.split("/")[0] == corner.split("/")[2] for face in faces for corner in face)
    assert trimesh.load(path, process=False).is_watertight


def test_an_stl_opens_elsewhere(tmp_path: Path) -> None:
    """Triangles alone; joined up again they are closed."""
    solid = trimesh.load(written(tmp_path, "stl", "--set", "direction=x"))
    assert solid.is_watertight
    assert_rippled(solid.vertices, "x", None)


def test_an_npz_holds_the_stage_s_arrays(tmp_path: Path) -> None:
    """By the documented names and types."""
    arrays = np.load(written(tmp_path, "npz", "--set", "direction=x"))
    assert {name: (array.shape, array.dtype) for name, array in arrays.items()} == {
        "vertices": ((2562, 3), np.float32), "triangles": ((5120, 3), np.int32), "normals": ((2562, 3), np.float32)}
    assert_rippled(arrays["vertices"], "x", arrays["normals"])


def test_the_frame_counts(tmp_path: Path) -> None:
    """A formula of the time is exported as it stands at the frame."""
    path = written(tmp_path, "npz", "--set", "displacement=0.1*t", "--frame", "90")
    assert np.allclose(np.linalg.norm(np.load(path)["vertices"], axis=1), 1.15, atol=1e-6)


@pytest.mark.parametrize("kind", ["ply", "obj", "stl"])
def test_a_mesh_without_normals_is_no_mistake(tmp_path: Path, kind: str) -> None:
    """They are left out."""
    triangle = {"vertices": np.eye(3, dtype=np.float32), "triangles": np.array([[0, 1, 2]], np.int32)}
    export(triangle, tmp_path / f"a.{kind}")
    assert np.allclose(np.sort(trimesh.load(tmp_path / f"a.{kind}", process=False).vertices, axis=0), [
        [0, 0, 0], [0, 0, 0], [1, 1, 1]])


@pytest.mark.parametrize("name", ["mesh", "mesh.fbx", "mesh.ply.gz", ".ply"])
def test_other_kinds_are_refused(tmp_path: Path, name: str) -> None:
    """With those that there are."""
    with pytest.raises(ExportError, match=r"ends in none of \.ply, \.obj, \.stl, \.npz"):
        export({"vertices": np.eye(3)}, tmp_path / name)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("kind", ["ply", "obj", "stl"])
def test_an_empty_mesh_is_told_and_writes_no_file(tmp_path: Path, kind: str) -> None:
    """There are vertices and triangles by name, but none."""
    empty = {"vertices": np.empty((0, 3), "f4"), "triangles": np.empty((0, 3), "i4")}
    with pytest.raises(ExportError, match="has no triangles now"):
        export(empty, tmp_path / f"empty.{kind}")
    assert list(tmp_path.iterdir()) == []
