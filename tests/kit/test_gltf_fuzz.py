"""Hundreds of damaged models: each is read, whole and sound, or refused in one line."""

from __future__ import annotations

import copy
import json
import random
import struct
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.kit.gltf_samples import SQUARE, Sample, flag, packed
from viewer.kit.gltf import ModelFileError, RiggedModel, read_model

MODELS = Path(__file__).parents[3] / "shared" / "models"
CASES, LARGE, CASES_OF_LARGE = 100, 100_000, 25
ODD: list[Any] = [
    -1, 0, 1, 3, 7, 1000, 65535, 2**31, 2**32, 2**53, 10**30, 1.0, 0.5, -1e308, 1e38, True, None, "", "../x", "http://a/b",
    "data:,", "data:;base64,AAAA", "VEC3", "VEC4", "SCALAR", "MAT4", "STEP", "CUBICSPLINE", [], {}, [0], [0, 0],
    [1e30] * 3, [1, 2, 3], [0, 0, 0, 1], [1] * 16, [[]], [{}], {"a": 1}, 5120, 5121, 5123, 5125, 5126]


def everything() -> Sample:
    """A model with some of all that is read."""
    sample = flag()
    sample.animate(2, "rotation", [0, 1, 2], [[0, 0, 0, 1], [0, 0, 1, 0], [0, 1, 0, 0]])
    sample.animate(1, "translation", [0, 1], np.ones((6, 3)), "CUBICSPLINE")
    sample.animate(1, "scale", [0, 1], np.ones((2, 3)), "STEP")
    sample.add("images", uri="data:image/png;base64,AAAA")
    sample.add("textures", source=0)
    transform = {"offset": [0.1, 0.2], "rotation": 1, "scale": [2, 2]}
    place = {"index": 0, "extensions": {"KHR_texture_transform": transform}}
    sample.add("materials", pbrMetallicRoughness={"baseColorTexture": place, "baseColorFactor": [1, 0.5, 0, 1]})
    primitive = sample.json["meshes"][0]["primitives"][0]
    primitive["material"] = 0
    primitive["attributes"].update(TEXCOORD_0=sample.accessor(np.zeros((4, 2))), NORMAL=sample.accessor(SQUARE))
    positions = sample.accessor(SQUARE)
    sample.json["accessors"][positions]["sparse"] = {
        "count": 1, "indices": {"bufferView": sample.view(b"\1"), "componentType": 5121},
        "values": {"bufferView": sample.view(np.array([2, 0, 0], np.float32).tobytes())}}
    mesh = sample.add("meshes", primitives=[{"attributes": {"POSITION": positions}, "mode": mode}
                                            for mode in (4, 5, 6)])
    sample.json["nodes"][2]["mesh"] = mesh
    sample.add("nodes", mesh=mesh, matrix=[-1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 3, 0, 1, 1, 1, 1])
    sample.json.update(scenes=[{"nodes": [0, 1, 3]}], scene=0, extensionsRequired=["KHR_mesh_quantization"])
    return sample


def originals() -> dict[str, bytes]:
    """What is damaged: models that others made, where they are at hand, and one of all that there is."""
    found = {path.name: path.read_bytes() for path in sorted(MODELS.glob("*.gl*"))}
    return {**found, "everything.glb": everything().glb(), "everything.gltf": everything().gltf()}


def damaged(data: bytes, chance: random.Random) -> bytes:
    """Bytes changed or cut off, or values of the JSON put out of place."""
    kind = chance.random()
    if kind < 0.2:
        return scattered(data, chance)
    if kind < 0.3:
        return data[:chance.randrange(len(data))]
    if data[:4] != b"glTF":
        return misplaced(data, chance)
    length = struct.unpack_from("<I", data, 12)[0]
    text, binary = data[20:20 + length], data[28 + length:]
    if kind < 0.45:
        return packed(text, scattered(binary, chance))
    if kind < 0.5:
        return packed(text, binary[:chance.randrange(len(binary))])
    return packed(misplaced(text, chance), binary)


def scattered(data: bytes, chance: random.Random) -> bytes:
    """A few bytes, or many, are others."""
    changed = bytearray(data)
    for _ in range(chance.choice([1, 4, 64, 512])):
        changed[chance.randrange(len(changed))] = chance.choice([0, 127, 128, 255, chance.randrange(256)])
    return bytes(changed)


def misplaced(text: bytes, chance: random.Random) -> bytes:
    """Up to three values are odd ones, or gone, or those from elsewhere, or there twice."""
    whole = json.loads(text)
    for _ in range(chance.choice([1, 1, 2, 3])):
        *above, last = chance.choice(list(places(whole)))
        holder = at(whole, above)
        if chance.random() < 0.6:
            holder[last] = copy.deepcopy(chance.choice(ODD))
        elif chance.random() < 0.5:
            holder[last] = copy.deepcopy(at(whole, chance.choice(list(places(whole)))))
        elif isinstance(holder, list):
            holder.append(copy.deepcopy(holder[last]))
        else:
            del holder[last]
        if not whole:
            break
    return json.dumps(whole).encode()


def places(value: Any, above: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    """The way to each value in the JSON; of long lists to their first."""
    steps = value if isinstance(value, dict) else range(min(len(value), 30)) if isinstance(value, list) else ()
    for step in steps:
        yield (*above, step)
        yield from places(value[step], (*above, step))


def at(value: Any, way: Any) -> Any:
    for step in way:
        value = value[step]
    return value


def check(model: RiggedModel) -> None:
    """Everything in range, finite and normalised, at rest and in motion."""
    mesh = model.mesh
    for values in (mesh.positions, mesh.normals, mesh.texcoords, mesh.weights, mesh.palette()):
        assert np.isfinite(values).all()
    assert np.allclose(mesh.weights.sum(axis=1), 1.0, atol=1e-5) and mesh.weights.min() >= 0.0
    assert np.allclose(np.linalg.norm(mesh.normals, axis=1), 1.0, atol=1e-5)
    for numbers, count in ((mesh.joints, len(mesh.bones)), (mesh.triangles, len(mesh.positions)),
                           (mesh.bones, len(mesh.skeleton.names))):
        assert numbers.min() >= 0 and numbers.max() < count
    assert sum(part.count for part in model.parts) == len(mesh.triangles)
    for clip in model.clips:
        assert all(np.isfinite(values).all() for values in clip.pose(mesh.skeleton, 0.3))


@pytest.mark.parametrize("name", originals())
def test_damage_is_found_or_does_no_harm(name: str, tmp_path: Path) -> None:
    """No other exception, no warning, no numbers that are none; some of both kinds."""
    data, chance, refused = originals()[name], random.Random(f"damage {name}"), 0
    path, cases = tmp_path / name, CASES if len(data) < LARGE else CASES_OF_LARGE
    for _ in range(cases):
        path.write_bytes(damaged(data, chance))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            try:
                check(read_model(path))
            except ModelFileError as error:
                refused += 1
                assert str(error).startswith(f"model {path}") and "\n" not in str(error)
    assert cases // 3 < refused < cases
