"""What is no glTF, lies about itself, asks for too much or for what is not its own: one line for each."""

from __future__ import annotations

import json
import os
import struct
import time
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.kit.gltf_samples import Sample, flag, packed, square
from viewer.kit.gltf import ModelFileError, read_model

Change = Callable[[dict[str, Any]], object]


def refusal(path: Path) -> str:
    """What is said about a file; checked to be one line that names it."""
    with pytest.raises(ModelFileError) as caught:
        read_model(path)
    message = str(caught.value)
    assert message.startswith(f"model {path}") and "\n" not in message and len(message) < 300 + len(str(path))
    return message.removeprefix(f"model {path}").lstrip(": ")


def changed(sample: Sample, change: Change, folder: Path) -> str:
    """What is said about a sample whose JSON is changed."""
    whole = sample.whole()
    change(whole)
    path = folder / "model.glb"
    path.write_bytes(packed(json.dumps(whole).encode(), bytes(sample.data)))
    return refusal(path)


def put(*where: str | int, value: Any) -> Change:
    """The change that puts ``value`` at a place in the JSON."""

    def change(whole: Any) -> None:
        for step in where[:-1]:
            whole = whole[step]
        whole[where[-1]] = value

    return change


GLB = square().glb()
TEXT = square().gltf()


@pytest.mark.parametrize(("name", "data", "reason"), [
    ("a.glb", b"", "is empty"), ("a.gltf", b"", "is empty"), ("a.png", GLB, "ends in .png; .gltf, .glb are allowed"),
    ("a.glb", b"to be or not to be", "is no glTF, or damaged"), ("a.gltf", b"\xff\xfe{\0}\0", "it is not UTF-8"),
    ("a.gltf", TEXT[:200], "is no glTF, or damaged"), ("a.gltf", b"[]", "its JSON is a list; an object is needed"),
    ("a.gltf", b"{}", "asset.version is missing; 2.0 is needed"), ("a.gltf", b"3", "its JSON is 3; an object"),
    ("a.gltf", b'{"asset": {"version": "1.0"}}', 'asset.version is "1.0"; 2.0 is needed'),
    ("a.gltf", b'{"asset": {"version": "2.1", "minVersion": "2.1"}}', 'asset.minVersion is "2.1"; 2.0 is allowed'),
    ("a.gltf", b'{"asset": {"version": "2.0"}}', "has no nodes"),
    ("a.gltf", b"[" * 100_000, "nested too deeply"), ("a.gltf", b'{"a":' * 5000 + b"1" + b"}" * 5000, "too deeply"),
    ("a.gltf", b'{"a": NaN}', "NaN is no JSON number"),
    ("a.gltf", b'{"a": %s}' % (b"9" * 5000), "is no glTF, or damaged"),
    ("a.gltf", b'{"a": 1, "b": {"c": 1, "c": 2}}', 'the key "c" stands twice'),
    ("a.gltf", b"[" + b"0," * 2**20 + b"0]", "1,048,577 values; at most 1,048,576"),
    ("a.glb", GLB[:8], "is cut short: a GLB header has 12 bytes"),
    ("a.glb", GLB[:12], "is cut short: it says that it has"),
    ("a.glb", GLB[:-4], "is cut short: it says that it has"), ("a.glb", GLB + bytes(4), "is damaged: it says"),
    ("a.glb", struct.pack("<4sII", b"glTF", 1, len(GLB)) + GLB[12:], "is GLB version 1; 2 is allowed"),
    ("a.glb", GLB[:12] + struct.pack("<I", 2**32 - 1) + GLB[16:], "a chunk says that it has 4,294,967,295 bytes"),
    ("a.glb", GLB[:16] + b"NOSJ" + GLB[20:], "its first chunk is not JSON"),
    ("a.glb", struct.pack("<4sII", b"glTF", 2, 16) + bytes(4), "ends within the header of a chunk"),
    ("a.glb", packed(b"{", b""), "is no glTF, or damaged"),
], ids=lambda value: value[:30] if isinstance(value, str) else "")
def test_what_is_no_gltf(name: str, data: bytes, reason: str, tmp_path: Path) -> None:
    """Empty, of another kind, cut short, with wrong lengths, nested, doubled."""
    (tmp_path / name).write_bytes(data)
    assert reason in refusal(tmp_path / name)


def test_missing_files_folders_and_pipes_are_named(tmp_path: Path) -> None:
    """Before anything is read."""
    (tmp_path / "folder.glb").mkdir()
    os.mkfifo(tmp_path / "pipe.glb")
    assert refusal(tmp_path / "gone.glb") == "does not exist"
    assert refusal(tmp_path / "folder.glb") == refusal(tmp_path / "pipe.glb") == "is not a file"


@pytest.mark.parametrize(("where", "kind", "count"), [
    (("nodes", 1, "children", 0), "nodes", 3), (("nodes", 0, "mesh"), "meshes", 1), (("nodes", 0, "skin"), "skins", 1),
    (("skins", 0, "joints", 1), "nodes", 3), (("skins", 0, "inverseBindMatrices"), "accessors", 5),
    (("meshes", 0, "primitives", 0, "indices"), "accessors", 5),
    (("meshes", 0, "primitives", 0, "material"), "materials", 0),
    (("meshes", 0, "primitives", 0, "attributes", "POSITION"), "accessors", 5),
    (("meshes", 0, "primitives", 0, "attributes", "JOINTS_0"), "accessors", 5),
    (("meshes", 0, "primitives", 0, "attributes", "WEIGHTS_0"), "accessors", 5),
    (("accessors", 0, "bufferView"), "bufferViews", 5), (("bufferViews", 0, "buffer"), "buffers", 1),
    (("scene",), "scenes", 0)], ids=lambda value: ".".join(map(str, value)) if isinstance(value, tuple) else "")
@pytest.mark.parametrize(("value", "told"), [
    (99, "99"), (-1, "-1"), (2**70, str(2**70)), (1.0, "1.0"), (True, "true"), ("0", '"0"'), (None, "null"),
    ([], "a list")], ids=lambda value: str(value)[:5])
def test_numbers_of_what_is_not_there(where: tuple[str | int, ...], kind: str, count: int, value: Any, told: str,
                                      tmp_path: Path) -> None:
    """Too large, negative, and no whole numbers at all."""
    allowed = f"0 to {count - 1} are allowed" if count else f"there are no {kind}"
    place = "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in where).lstrip(".")
    assert changed(flag(), put(*where, value=value), tmp_path) == f"{place} is {told}; {allowed}"


@pytest.mark.parametrize(("change", "reason"), [
    (put("nodes", 2, "children", value=[1]), "nodes[1] is below itself"),
    (put("nodes", 0, "children", value=[0]), "nodes[0] is below itself"),
    (put("nodes", 0, "children", value=[2]), "nodes[2] is a child of nodes[0] and of nodes[1]; one parent"),
    (put("nodes", 1, "children", value=[2, 2]), "nodes[2] is a child of nodes[1] and of nodes[1]"),
    (put("scenes", value=[{}]), "scenes[0] has no nodes"),
    (put("scenes", value=[{"nodes": [2]}]), "scenes[0] begins with nodes[2], a child of nodes[1]"),
    (put("scenes", value=[{"nodes": [1]}]), "holds no mesh"), (put("nodes", value=[]), "has no nodes"),
    (put("nodes", value=[{}] * 20_000), "20,000 nodes; at most 16,384"),
    (put("nodes", value={}), "nodes is an object; a list is needed"),
    (put("nodes", 1, value=[]), "nodes[1] is a list; an object is needed"),
    (put("nodes", 1, "translation", value=[1, 2]), "nodes[1].translation has 2 numbers; 3 are needed"),
    (put("nodes", 1, "translation", value=[1, 2, "x"]), 'nodes[1].translation[2] is "x"; a finite number'),
    (put("nodes", 1, "scale", value=[1, 1, 1e39]), "nodes[1].scale[2] is 1e+39; a finite number"),
    (put("nodes", 1, "rotation", value=[0, 0, 0, 0]), "nodes[1].rotation is a list; a quaternion of length one"),
    (put("nodes", 1, "matrix", value=[1] * 16), "nodes[1].matrix has the last row [1.0, 1.0, 1.0, 1.0]"),
    (put("nodes", 1, "translation", value=[0, 2e6, 0]), "has a joint 2e+06 m from the origin"),
    (put("nodes", 1, "scale", value=[1e9, 1, 1]), "has a vertex"),
    (put("nodes", 1, "name", value=7), "nodes[1].name is 7; text is needed"),
    (put("skins", 0, "joints", value=[]), "skins[0] has no joints"),
    (put("skins", 0, "joints", value=[1]), "has joint 1 at vertex 1; skins[0] has 1 joints, so 0 to 0 are allowed"),
    (put("skins", 0, "joints", value=[1, 2, 1]), "skins[0] has 3 joints and 2 inverse bind matrices"),
    (put("meshes", 0, "primitives", 0, "mode", value=7), "mode is 7; a whole number from 0 to 6"),
    (put("meshes", 0, "primitives", 0, "mode", value=0), "only points or lines; triangles are needed"),
    (put("meshes", 0, "primitives", value=[]), "holds no mesh"),
    (put("meshes", 0, "primitives", 0, "attributes", value={}), "attributes.POSITION is missing"),
    (put("meshes", 0, "primitives", 0, "attributes", "WEIGHTS_0", value=2), "type is \"VEC3\"; VEC4 is needed"),
    (put("meshes", 0, "primitives", 0, "attributes", "NORMAL", value=4), "has 2 elements; 4 are needed"),
    (put("accessors", 2, "count", value=5), "has 5 elements of 12 bytes, 12 apart, from byte 0; its buffer view has"),
    (put("accessors", 2, "count", value=0), "accessors[2].count is 0; a whole number from 1"),
    (put("accessors", 2, "count", value=5_000_001), "has 5,000,001 vertices or more; at most 5,000,000 are allowed"),
    (put("accessors", 2, "count", value=2**60), "accessors[2].count is 1152921504606846976; a whole number"),
    (put("accessors", 3, "count", value=30_000_003), "10,000,001 triangles or more; at most 10,000,000"),
    (put("accessors", 2, "byteOffset", value=-4), "accessors[2].byteOffset is -4; a whole number from 0"),
    (put("accessors", 2, "byteOffset", value=2**53), "its buffer view has 48 bytes"),
    (put("accessors", 2, "componentType", value=5130), "accessors[2].componentType is 5130; 5120, 5121"),
    (put("accessors", 2, "type", value="MAT3"), 'accessors[2].type is "MAT3"; VEC3 is needed here'),
    (put("accessors", 2, "sparse", value={"count": 5}), "accessors[2].sparse.count is 5; a whole number from 1 to 4"),
    (put("accessors", 2, "sparse", value={"count": 1}), "sparse.indices.componentType is missing"),
    (put("bufferViews", 2, "byteLength", value=10_000), "byteLength is 10000; from 80 on it must end within"),
    (put("bufferViews", 2, "byteLength", value=-1), "bufferViews[2].byteLength is -1; a whole number from 1"),
    (put("bufferViews", 2, "byteOffset", value=2**53), "it must end within"),
    (put("bufferViews", 2, "byteStride", value=8), "byteStride is 8; the elements of accessors[2] have 12 bytes each"),
    (put("bufferViews", 2, "byteStride", value=16), "has 4 elements of 12 bytes, 16 apart"),
    (put("buffers", 0, "byteLength", value=10**9), "buffers[0].byteLength is 1000000000; only"),
    (put("buffers", 0, value={"byteLength": 0}), "buffers[0].byteLength is 0; a whole number from 1"),
    (put("buffers", 0, "uri", value="data:,"), "byteLength is"),
    (put("buffers", 0, "uri", value="data:;base64,A"), "buffers[0].uri holds damaged base64"),
    (put("buffers", 0, "uri", value="gone.bin"), 'buffers[0].uri is "gone.bin"; there is no such file in'),
    (put("images", value=[{}] * 5000), "5,000 images; at most 4,096"),
    (put("extensionsRequired", value=["KHR_draco_mesh_compression"]), 'extension "KHR_draco_mesh_compression"; KHR_'),
    (put("extensionsRequired", value=[7]), "extensionsRequired[0] is 7; text is needed"),
], ids=lambda value: value[:40] if isinstance(value, str) else "")
def test_what_does_not_fit_together(change: Change, reason: str, tmp_path: Path) -> None:
    """Trees, numbers, counts and lengths."""
    assert reason in changed(flag(), change, tmp_path)


def test_a_buffer_without_bytes_is_named(tmp_path: Path) -> None:
    """Only the first of a GLB file may do without a URI."""
    (tmp_path / "a.gltf").write_text(json.dumps(square().whole()))
    assert "buffers[0].uri is missing; only the first buffer of a .glb file" in refusal(tmp_path / "a.gltf")


@pytest.mark.parametrize(("positions", "reason"), [
    ([[0, 0, 0], [1, np.nan, 0], [0, 1, 0]], "accessors[0] has (1, nan, 0) at 1; finite numbers are needed"),
    ([[0, 0, 0], [1, 0, 0], [0, np.inf, 0]], "accessors[0] has (0, inf, 0) at 2; finite numbers are needed"),
    ([[0, 0, 0], [2e6, 0, 0], [0, 1, 0]], "accessors[0] reaches 2e+06 m from the origin; at most 1e+06 m are allowed"),
    ([[0, 0, 0], [1, 0, 0], [2, 0, 0]], "has no area")])
def test_places_that_are_none(positions: list[list[float]], reason: str, tmp_path: Path) -> None:
    """NaN, infinities, too far, all on one line."""
    sample = Sample()
    sample.add("nodes", mesh=sample.mesh(positions, None))
    assert reason in refusal(sample.written(tmp_path))


def test_joints_out_of_range_matter_only_with_a_weight(tmp_path: Path) -> None:
    """The square's left edge follows joint 0 alone."""
    spare = np.array([[0, 1, 200, 7]] * 4)
    assert read_model(flag(joints=spare).written(tmp_path)).influences == 1
    used = np.where(spare == 1, 2, spare)
    assert "has joint 2 at vertex 1; skins[0] has 2 joints, so 0 to 1 are allowed" in refusal(
        flag(joints=used).written(tmp_path))


def test_a_triangle_out_of_range_is_named(tmp_path: Path) -> None:
    """With the number that is too large, also the one that restarts strips elsewhere."""
    sample = square(indices=[0, 1, 4])
    assert "accessors[1] has a triangle with vertex 4; there are 4" in refusal(sample.written(tmp_path))
    sample = square(indices=[0, 1, 65535], mode=5)
    assert "vertex 65,535; there are 4" in refusal(sample.written(tmp_path))


@pytest.mark.parametrize("kind", ["buffers", "images"])
@pytest.mark.parametrize("uri", [
    "/etc/passwd", "../secret.bin", "a/../../secret.bin", "%2e%2e/secret.bin", "..%2Fsecret.bin", "%2Fetc%2Fpasswd",
    "..\\secret.bin", "%5C%5Chost%5Cshare", "C:/secret.bin", "C:secret.bin", "http://example.com/a.bin",
    "file:secret.bin", "file:///etc/passwd", "ftp:a", "//host/a.bin", "link.bin", "folder/secret.bin", "a\0b",
    "a%00b", "a\nb"])
def test_files_that_are_not_its_own_are_refused(kind: str, uri: str, tmp_path: Path) -> None:
    """Absolute, outside its folder in whatever writing or through links, or elsewhere; even if nothing uses them."""
    (tmp_path / "secret.bin").write_bytes(bytes(1000))
    inside = tmp_path / "inside"
    inside.mkdir()
    (inside / "link.bin").symlink_to(tmp_path / "secret.bin")
    (inside / "folder").symlink_to(tmp_path)
    message = changed(square(), lambda whole: whole.setdefault(kind, []).append({"uri": uri, "byteLength": 9}), inside)
    assert message.startswith(f"{kind}[{kind == 'buffers':d}].uri is ")
    assert message.endswith("; only files in the model's folder or below are allowed")


@pytest.mark.parametrize(("path", "times", "values", "between", "reason"), [
    ("scale", [0, 1], [[1, 1, 1]], "LINEAR", "animations[0].samplers[0] has 2 keys and 1 values; 2 are needed"),
    ("scale", [0, 1], [[1, 1, 1]] * 2, "CUBICSPLINE", "has 2 keys and 2 values; 6 are needed"),
    ("scale", [0, 1], [[1, 1, 1]] * 2, "BEZIER", 'interpolation is "BEZIER"; LINEAR, STEP, CUBICSPLINE are allowed'),
    ("scale", [1, 0], [[1, 1, 1]] * 2, "LINEAR", "has the time 0 as number 1; times must rise"),
    ("scale", [-1, 0], [[1, 1, 1]] * 2, "LINEAR", "has the time -1 as number 0; times must rise"),
    ("scale", [0, 1e30], [[1, 1, 1]] * 2, "LINEAR", "times must rise, from 0 to 100000 seconds"),
    ("scale", [0, np.nan], [[1, 1, 1]] * 2, "LINEAR", "has (nan) at 1; finite numbers are needed"),
    ("scale", [0, 1], [[1, 1, np.inf]] * 2, "LINEAR", "has (1, 1, inf) at 0; finite numbers are needed"),
    ("translation", [0], [[1e9, 0, 0]], "LINEAR", "has the value 1e+09; at most 1e+06 is allowed"),
    ("rotation", [0], [[0, 0, 0, 0]], "LINEAR", "has a rotation of zeros"),
    ("rotation", [0], [[0, 0, 0]], "LINEAR", 'type is "VEC3"; VEC4 is needed here'),
    ("colour", [0], [[0, 0, 0]], "LINEAR", 'path is "colour"; translation, rotation, scale and weights are allowed'),
], ids=lambda value: "")
def test_animations_that_make_no_sense(path: str, times: list[float], values: list[list[float]], between: str,
                                       reason: str, tmp_path: Path) -> None:
    """Numbers of keys, times that fall, values that are none."""
    sample = flag()
    sample.animate(1, path, times, values, between)
    assert reason in refusal(sample.written(tmp_path))


def zeros(count: int) -> Sample:
    """A square whose positions are nowhere in the file, so that they are all zero."""
    sample = square()
    sample.json["accessors"][0] = {"componentType": 5126, "type": "VEC3", "count": count}
    return sample


def overlapping() -> Sample:
    """Thousands of accessors over the same half million bytes."""
    sample = flag()
    times, number = sample.accessor(np.arange(170_000) * 1e-3), len(sample.json["accessors"])
    view = sample.view(bytes([1]) * 510_000)
    values = {"bufferView": view, "componentType": 5121, "count": 170_000, "type": "VEC3"}
    sample.json["accessors"] += [values] * 2000
    sample.add("animations", samplers=[{"input": times, "output": number + each} for each in range(2000)],
               channels=[{"sampler": each, "target": {"node": 1, "path": "scale"}} for each in range(2000)])
    return sample


def shared_weights() -> Sample:
    """A hundred sets of joints and weights, all of them the same."""
    sample = flag()
    attributes = sample.json["meshes"][0]["primitives"][0]["attributes"]
    for number in range(1, 100):
        attributes.update({f"JOINTS_{number}": attributes["JOINTS_0"], f"WEIGHTS_{number}": attributes["WEIGHTS_0"]})
    return sample


@pytest.mark.parametrize(("sample", "reason"), [
    (zeros(2**52), "vertices or more"), (zeros(300_000), "has no area"),
    (overlapping(), "numbers; in a file of its size"), (shared_weights(), None)],
    ids="enormous zeros overlapping sets".split())
def test_small_files_cannot_fill_the_memory(sample: Sample, reason: str | None, tmp_path: Path) -> None:
    """Nor take long, whatever they count."""
    path = sample.written(tmp_path)
    tracemalloc.start()
    start = time.perf_counter()
    if reason is None:
        read_model(path)
    else:
        assert reason in refusal(path)
    seconds, peak = time.perf_counter() - start, tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert seconds < 5.0 and peak < 400 * 2**20


def test_a_file_that_is_too_large_is_not_read(tmp_path: Path) -> None:
    """Nor is one beside it: a hole of 8 GiB."""
    with (tmp_path / "huge.glb").open("wb") as file:
        file.truncate(2**33)
    assert "8,589,934,592 bytes or more; at most 536,870,912" in refusal(tmp_path / "huge.glb")
    message = changed(square(), put("buffers", 0, "uri", value="huge.glb"), tmp_path)
    assert "bytes or more; at most 536,870,912 are allowed" in message


def test_thousands_of_parts_are_refused(tmp_path: Path) -> None:
    """A hundred copies of a mesh of a hundred primitives, also of points, which are left out."""
    for mode in (4, 0):
        sample = square()
        primitive = sample.json["meshes"][0]["primitives"][0]
        sample.json["meshes"][0]["primitives"] = [{**primitive, "mode": mode}] * 100
        sample.json["nodes"] = [{"mesh": 0}] * 100
        assert "4,097 parts or more; at most 4,096 are allowed" in refusal(sample.written(tmp_path))
