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


# Particles

SOME = {
    "velocity": np.array([[0.1, -9.81, 1e-30], [3.0, 2.0, 1.0]], np.float32),
    "age": np.array([0.25, 1 / 3], np.float32),
    "mass": np.array([1 / 3, 1e300]),
    "size": np.array([0.5, 65504.0], np.float16),
    "generation": np.array([0, -3], np.int32),
    "bounces": np.array([255, 7], np.uint8),
    "alive": np.array([True, False]),
    "identity": np.array([2**32 - 1, 0], np.uint32),
    "seed": np.array([2**53, 12345678901], np.int64),
    "position": np.array([[1.5, 1e-7, -3.0], [np.pi, np.nan, np.inf]], np.float32),
}
IN_PLY = {"x": "f4", "y": "f4", "z": "f4", "vx": "f4", "vy": "f4", "vz": "f4", "age": "f4", "mass": "f8", "size": "f4",
          "generation": "i4", "bounces": "u1", "alive": "u1", "identity": "u4", "seed": "f8"}


def test_particles_as_ply_come_back_exactly(tmp_path: Path) -> None:
    """In another program: each number of each particle under its name, none of them rounded."""
    export(SOME, tmp_path / "a.ply")
    data = plyfile.PlyData.read(tmp_path / "a.ply")
    assert not data.text and data.byte_order == "<" and [element.name for element in data] == ["vertex"]
    rows = data["vertex"].data
    assert {name: rows.dtype[name].str[1:] for name in rows.dtype.names} == IN_PLY
    split = {f"{kind}{axis}": SOME[name][:, place] for kind, name in (("", "position"), ("v", "velocity"))
             for place, axis in enumerate("xyz")}
    for name, values in {**{name: SOME[name] for name in SOME if name in IN_PLY}, **split}.items():
        assert np.array_equal(rows[name], values, equal_nan=name in "xyz"), name
    assert list(tmp_path.iterdir()) == [tmp_path / "a.ply"]


def test_particles_open_in_trimesh(tmp_path: Path) -> None:
    """As a cloud of points."""
    points = {"position": np.random.default_rng(1).normal(size=(1000, 3)).astype(np.float32)}
    export(points, tmp_path / "a.ply")
    assert np.array_equal(trimesh.load(tmp_path / "a.ply").vertices, points["position"])


@pytest.mark.parametrize("kind", ["ply", "npz"])
def test_no_particles_are_a_file_too(tmp_path: Path, kind: str) -> None:
    """With no rows, but with every name."""
    export({name: array[:0] for name, array in SOME.items()}, tmp_path / f"a.{kind}")
    if kind == "npz":
        assert {name: (len(array), array.dtype) for name, array in np.load(tmp_path / "a.npz").items()} == {
            name: (0, array.dtype) for name, array in SOME.items()}
        return
    rows = plyfile.PlyData.read(tmp_path / "a.ply")["vertex"].data
    assert len(rows) == 0 and set(rows.dtype.names) == set(IN_PLY)


@pytest.mark.parametrize("kind", ["obj", "stl"])
def test_a_mesh_file_holds_no_particles(tmp_path: Path, kind: str) -> None:
    """It says which kinds do."""
    with pytest.raises(ExportError, match=rf"a\.{kind}: \.{kind} holds no particles; export them as \.ply or \.npz$"):
        export(SOME, tmp_path / f"a.{kind}")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("name", "values", "message"), [
    ("seed", np.array([1, 2**53 + 1]), r"seed has numbers beyond 2\^53, which PLY cannot hold; export it as \.npz"),
    ("seed", np.array([1, -2**63]), r"seed has numbers beyond 2\^53"),
    ("seed", np.array([1, 2**64 - 1], np.uint64), r"seed has numbers beyond 2\^53"),
    ("springs", np.zeros((5, 2), np.int32), r"springs is an array of 5 by 2, not of 2 numbers, one row for each"),
    ("velocity", np.zeros((1, 3)), r"velocity is an array of 1 by 3, not of 2 numbers by 3, one row for each"),
    ("count", np.array(2), r"count is an array of one number, not of 2 numbers"),
    ("vx", np.zeros(2), r"two properties would be named vx; export it as \.npz"),
    ("two words", np.zeros(2), r"PLY has no property two words of type float64; export it as \.npz"),
    ("mass", np.zeros(2, np.longdouble), r"PLY has no property mass of type (longdouble|float\d+)"),
])
def test_what_ply_cannot_hold_is_refused(tmp_path: Path, name: str, values: NDArray[np.generic],
                                         message: str) -> None:
    """With the array's name, and nothing written; NPZ takes it as it is."""
    with pytest.raises(ExportError, match=message):
        export({**SOME, name: values}, tmp_path / "a.ply")
    assert list(tmp_path.iterdir()) == []
    export({**SOME, name: values}, tmp_path / "a.npz")
    assert np.array_equal(np.load(tmp_path / "a.npz")[name], values)
