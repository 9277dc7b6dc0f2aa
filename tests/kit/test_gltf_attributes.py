"""What a glTF file can keep its numbers in: types, strides, sparse accessors, strips, files beside it, images."""

from __future__ import annotations

import base64
import io
import json
import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from tests.kit.gltf_samples import COMPONENTS, SQUARE, TWO_TRIANGLES, Sample, square
from viewer.kit.gltf import read_model
from viewer.kit.mesh import ico_sphere

WHOLE = [("int8", 127), ("uint8", 255), ("int16", 32767), ("uint16", 65535)]


@pytest.mark.parametrize(("dtype", "largest"), WHOLE)
@pytest.mark.parametrize("normalised", [True, False])
def test_quantised_positions(dtype: str, largest: int, normalised: bool, tmp_path: Path) -> None:
    """Whole numbers, as they are or as shares of the largest one (KHR_mesh_quantization)."""
    sample = Sample()
    values = np.array(SQUARE) * 100
    number = sample.accessor(values, dtype, **({"normalized": True} if normalised else {}))
    sample.add("nodes", mesh=sample.add("meshes", primitives=[{"attributes": {"POSITION": number}}]))
    sample.json["extensionsRequired"] = ["KHR_mesh_quantization"]
    read = read_model(sample.written(tmp_path)).mesh.positions
    assert np.allclose(read, values / largest if normalised else values, rtol=1e-6)


def test_signed_shares_end_at_minus_one(tmp_path: Path) -> None:
    """-128 and -127 of 127 are both -1."""
    sample = Sample()
    number = sample.accessor([[-128, 0, 0], [-127, 127, 0], [127, 0, 0]], "int8", normalized=True)
    sample.add("nodes", mesh=sample.add("meshes", primitives=[{"attributes": {"POSITION": number}}]))
    assert read_model(sample.written(tmp_path)).mesh.positions.tolist() == [[-1, 0, 0], [-1, 1, 0], [1, 0, 0]]


@pytest.mark.parametrize("dtype", ["uint8", "uint16", "uint32"])
def test_indices_of_each_size(dtype: str, tmp_path: Path) -> None:
    """One, two or four bytes."""
    sample = square()
    sample.json["meshes"][0]["primitives"][0]["indices"] = sample.accessor(TWO_TRIANGLES, dtype)
    assert read_model(sample.written(tmp_path)).mesh.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]


def test_attributes_that_lie_between_each_other(tmp_path: Path) -> None:
    """Position, normal and texture coordinates of each vertex together, 32 bytes apart, after something else."""
    table = np.zeros((4, 8), np.float32)
    table[:, :3], table[:, 3:6], table[:, 6:] = SQUARE, [0, 0, 2], np.array(SQUARE)[:, :2] * 0.5
    sample = Sample()
    view = sample.view(b"else" + table.tobytes(), byteStride=32)
    numbers = [sample.add("accessors", bufferView=view, byteOffset=start, componentType=5126, count=4, type=kind)
               for start, kind in ((4, "VEC3"), (16, "VEC3"), (28, "VEC2"))]
    attributes = dict(zip(("POSITION", "NORMAL", "TEXCOORD_0"), numbers, strict=True))
    sample.add("nodes", mesh=sample.add("meshes", primitives=[{"attributes": attributes, "mode": 6}]))
    mesh = read_model(sample.written(tmp_path)).mesh
    assert mesh.positions.tolist() == SQUARE and mesh.texcoords.tolist() == table[:, 6:].tolist()
    assert mesh.normals.tolist() == [[0, 0, 1]] * 4


@pytest.mark.parametrize("based", [True, False])
@pytest.mark.parametrize("dtype", ["uint8", "uint16", "uint32"])
def test_sparse_accessors(based: bool, dtype: str, tmp_path: Path) -> None:
    """Some vertices replaced, of those that are there or of zeros."""
    sample = square()
    values = np.array([[5, 6, 7], [8, 9, 10], [3, 0, 1]], np.float32)
    accessor = sample.json["accessors"][0]
    accessor["sparse"] = {
        "count": 3, "indices": {"bufferView": sample.view(np.array([1, 3, 2], dtype).tobytes()),
                                "componentType": COMPONENTS[dtype]},
        "values": {"bufferView": sample.view(values.tobytes())}}
    if not based:
        del accessor["bufferView"]
    expected = np.array(SQUARE if based else np.zeros((4, 3)), np.float32)
    expected[[1, 3, 2]] = values
    assert np.array_equal(read_model(sample.written(tmp_path)).mesh.positions, expected)


@pytest.mark.parametrize("indexed", [True, False])
@pytest.mark.parametrize(("mode", "expected"), [
    (4, [[0, 1, 2]]), (5, [[0, 1, 2], [1, 3, 2], [2, 3, 4]]), (6, [[1, 2, 0], [2, 3, 0], [3, 4, 0]])])
def test_lists_strips_and_fans(mode: int, expected: list[list[int]], indexed: bool, tmp_path: Path) -> None:
    """Every other triangle of a strip is wound the other way; an unfinished triangle of a list is left out."""
    sample = Sample()
    points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.5], [0, 2, 1]]
    sample.add("nodes", mesh=sample.mesh(points, range(5) if indexed else None, mode))
    assert read_model(sample.written(tmp_path)).mesh.triangles.tolist() == expected


def test_missing_normals_are_smooth(tmp_path: Path) -> None:
    """On a sphere, to half a degree, and so where the file has zeros or no numbers."""
    vertices, triangles = ico_sphere(3)
    sample = Sample()
    sample.add("nodes", mesh=sample.mesh(vertices, triangles.ravel()))
    spoilt = vertices.copy()
    spoilt[::3], spoilt[1::3] = 0.0, np.nan
    plain = read_model(sample.written(tmp_path)).mesh.normals
    sample.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = sample.accessor(spoilt)
    for normals in (plain, read_model(sample.written(tmp_path)).mesh.normals):
        assert np.degrees(np.arccos(np.einsum("ij,ij->i", normals, vertices).clip(-1, 1))).max() < 0.5


@pytest.mark.parametrize(("uri", "name"), [("skin.bin", "skin.bin"), ("parts/skin%20one.bin", "parts/skin one.bin"),
                                           ("./skin.bin", "skin.bin"), ("%C3%A4.bin", "ä.bin")])
def test_buffers_in_files_beside_it(uri: str, name: str, tmp_path: Path) -> None:
    """Also in folders below, with spaces and other letters in their names."""
    sample = square()
    (tmp_path / name).parent.mkdir(exist_ok=True)
    (tmp_path / name).write_bytes(sample.data)
    sample.json["buffers"] = [{"uri": uri}]
    (tmp_path / "model.gltf").write_text(json.dumps(sample.whole()))
    assert read_model(tmp_path / "model.gltf").mesh.positions.tolist() == SQUARE


@pytest.mark.parametrize("data", [b"\xef\xbb\xbf" + square().gltf(), square().gltf(), square().glb()])
def test_the_container_is_known_by_its_bytes(data: bytes, tmp_path: Path) -> None:
    """Text, with a byte order mark or without, or GLB, whatever the suffix."""
    for suffix in (".gltf", ".glb", ".GLB"):
        (tmp_path / f"model{suffix}").write_bytes(data)
        assert read_model(tmp_path / f"model{suffix}").mesh.positions.tolist() == SQUARE


def textured(where: str, folder: Path, picture: bytes, **texture: Any) -> Path:
    """A square with a picture: in a buffer view, a data URI or a file."""
    sample = square()
    if where == "view":
        sample.add("images", bufferView=sample.view(picture), mimeType="image/png")
    else:
        (folder / "skin.png").write_bytes(picture)
        inline = f"data:image/png;base64,{base64.b64encode(picture).decode()}"
        sample.add("images", uri=inline if where == "inline" else "skin.png")
    sample.add("textures", source=0)
    sample.add("materials", pbrMetallicRoughness={"baseColorTexture": {"index": 0, **texture}})
    primitive = sample.json["meshes"][0]["primitives"][0]
    primitive["material"] = 0
    primitive["attributes"]["TEXCOORD_0"] = sample.accessor(np.array(SQUARE)[:, :2])
    primitive["attributes"]["TEXCOORD_1"] = sample.accessor(np.array(SQUARE)[:, :2] * 0.25)
    return sample.written(folder)


def encoded(pixels: Any, kind: str = "PNG", **options: Any) -> bytes:
    """A picture as the bytes of its file."""
    file = io.BytesIO()
    Image.fromarray(np.asarray(pixels, np.uint8)).save(file, kind, **options)
    return file.getvalue()


@pytest.mark.parametrize("where", ["view", "inline", "file"])
@pytest.mark.parametrize(("kind", "options"), [("PNG", {}), ("WEBP", {"lossless": True})])
def test_textures_come_with_their_top_row_first(where: str, kind: str, options: dict[str, Any], tmp_path: Path) -> None:
    """Red above, green below; alpha is full where there is none."""
    picture = encoded([[[255, 0, 0]] * 3, [[0, 255, 0]] * 3], kind, **options)
    texture = read_model(textured(where, tmp_path, picture)).parts[0].texture
    assert texture is not None and texture.tolist() == [[[255, 0, 0, 255]] * 3, [[0, 255, 0, 255]] * 3]


def test_texture_coordinates_are_those_that_the_material_names(tmp_path: Path) -> None:
    """The second set; or turned, stretched and moved by KHR_texture_transform, here a quarter turn about (0, 0)."""
    picture = encoded([[[1, 2, 3]]])
    plain = np.array(SQUARE)[:, :2]
    assert np.allclose(read_model(textured("view", tmp_path, picture, texCoord=1)).mesh.texcoords, plain * 0.25)
    transform = {"KHR_texture_transform": {"offset": [10, 20], "rotation": np.pi / 2, "scale": [2, 3]}}
    turned = read_model(textured("view", tmp_path, picture, extensions=transform)).mesh.texcoords
    u, v = (plain * [2, 3]).T
    assert np.allclose(turned, np.stack([v + 10, 20 - u], axis=1), atol=1e-6)


def bomb(width: int, height: int) -> bytes:
    """The header of a grey PNG that is far larger than its file."""
    chunks = [b"IHDR" + struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0), b"IDAT"]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(chunk) - 4) + chunk + struct.pack(">I", zlib.crc32(chunk)) for chunk in chunks)


@pytest.mark.parametrize(("picture", "reason"), [
    (b"not a picture", "damaged, or not PNG"), (encoded(np.zeros((9, 9, 3)))[:40], "damaged"),
    (bomb(10_000, 10_000), "10000 x 10000 pixels"), (bomb(60_000, 60_000), "far too many pixels"),
    (encoded(np.zeros((9, 9, 3)), "BMP"), "damaged, or not PNG")], ids="text cut large huge bmp".split())
def test_a_texture_that_cannot_be_read_is_left_out(picture: bytes, reason: str, tmp_path: Path) -> None:
    """With a note, without a warning; the model is there."""
    model = read_model(textured("file", tmp_path, picture))
    assert model.parts[0].texture is None
    assert model.notes[-1].startswith("images[0] is left out: ")
    assert reason in model.notes[-1]


def test_more_pixels_than_are_allowed_are_not_unpacked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """All images of a model together, each counted once."""
    monkeypatch.setattr("viewer.kit.gltf_material.MOST_PIXELS", 100)
    assert read_model(textured("view", tmp_path, encoded(np.zeros((10, 10, 3))))).parts[0].texture is not None
    model = read_model(textured("view", tmp_path, encoded(np.zeros((10, 11, 3)))))
    assert model.parts[0].texture is None and "11 x 10 pixels" in model.notes[-1]


def test_a_texture_file_that_is_not_there_is_left_out(tmp_path: Path) -> None:
    """With a note that names it."""
    path = textured("file", tmp_path, b"")
    (tmp_path / "skin.png").unlink()
    model = read_model(path)
    assert model.parts[0].texture is None and "skin.png" in model.notes[-1]
