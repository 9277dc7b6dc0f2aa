"""glTF files to read: put together piece by piece, so that each test says what is odd about its own."""

from __future__ import annotations

import base64
import json
import struct
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

COMPONENTS = {"int8": 5120, "uint8": 5121, "int16": 5122, "uint16": 5123, "uint32": 5125, "float32": 5126}
TYPES = {(): "SCALAR", (2,): "VEC2", (3,): "VEC3", (4,): "VEC4", (4, 4): "MAT4"}
SQUARE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
TWO_TRIANGLES = [0, 1, 2, 0, 2, 3]


@dataclass
class Sample:
    """A glTF document and the bytes of its only buffer; the methods add to both and return what they added."""

    json: dict[str, Any] = field(default_factory=lambda: {"asset": {"version": "2.0"}, "buffers": [{}]})
    data: bytearray = field(default_factory=bytearray)

    def add(self, kind: str, **values: Any) -> int:
        """One more of ``kind``, such as nodes; returns its number."""
        entries = self.json.setdefault(kind, [])
        entries.append(values)
        return len(entries) - 1

    def view(self, data: bytes, **values: Any) -> int:
        """A buffer view of ``data``."""
        self.data.extend(bytes(-len(self.data) % 4))
        start = len(self.data)
        self.data.extend(data)
        return self.add("bufferViews", buffer=0, byteOffset=start, byteLength=len(data), **values)

    def accessor(self, values: ArrayLike, dtype: str = "float32", **more: Any) -> int:
        """An accessor of its own view; rows of matrices become columns, as the format has them."""
        array = np.asarray(values, dtype)
        stored = np.swapaxes(array, 1, 2) if array.ndim == 3 else array
        view = self.view(np.ascontiguousarray(stored).tobytes())
        return self.add("accessors", bufferView=view, componentType=COMPONENTS[dtype], count=len(array),
                        type=TYPES[array.shape[1:]], **more)

    def mesh(self, positions: ArrayLike = SQUARE, indices: ArrayLike | None = TWO_TRIANGLES, mode: int | None = None,
             **attributes: Any) -> int:
        """A mesh of one primitive; ``attributes`` are numbers of accessors by their names in the format."""
        primitive: dict[str, Any] = {"attributes": {"POSITION": self.accessor(positions), **attributes}}
        if indices is not None:
            primitive["indices"] = self.accessor(indices, "uint16")
        if mode is not None:
            primitive["mode"] = mode
        return self.add("meshes", primitives=[primitive])

    def animate(self, node: int, path: str, times: ArrayLike, values: ArrayLike, between: str = "LINEAR",
                name: str = "moving") -> None:
        """An animation of one channel."""
        sampler = {"input": self.accessor(times), "output": self.accessor(values), "interpolation": between}
        self.add("animations", name=name, samplers=[sampler],
                 channels=[{"sampler": 0, "target": {"node": node, "path": path}}])

    def glb(self) -> bytes:
        """The file as ``.glb``."""
        return packed(json.dumps(self.whole()).encode(), bytes(self.data))

    def gltf(self) -> bytes:
        """The file as ``.gltf``, its buffer in a data URI."""
        whole = self.whole()
        encoded = base64.b64encode(self.data).decode()
        whole["buffers"] = [{**whole["buffers"][0], "uri": f"data:application/octet-stream;base64,{encoded}"}]
        return json.dumps(whole).encode()

    def whole(self) -> dict[str, Any]:
        """The document, with the length of its buffer."""
        buffers = self.json["buffers"]
        return {**self.json, "buffers": [{"byteLength": len(self.data), **buffers[0]}, *buffers[1:]]}

    def written(self, folder: Path, name: str = "model.glb") -> Path:
        """The file, in ``folder``."""
        path = folder / name
        path.write_bytes(self.glb() if path.suffix == ".glb" else self.gltf())
        return path


def packed(text: bytes, binary: bytes) -> bytes:
    """A GLB file of its two chunks."""
    text, binary = text + b" " * (-len(text) % 4), binary + bytes(-len(binary) % 4)
    return b"".join([struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)),
                     struct.pack("<I4s", len(text), b"JSON"), text, struct.pack("<I4s", len(binary), b"BIN\0"), binary])


def square(**attributes: Any) -> Sample:
    """A square of two triangles on node 0, which no skin moves."""
    sample = Sample()
    sample.add("nodes", mesh=sample.mesh(**attributes), name="square")
    return sample


def flag(weights: ArrayLike | None = None, joints: ArrayLike | None = None, dtype: str = "float32",
         **more: Any) -> Sample:
    """A square bound to two joints, nodes 1 and 2, the second half a metre above the first, in a skin.

    Its left edge follows the first and its right edge the second joint, unless ``weights`` (4, 4) or ``joints``
    (4, 4) say something else.
    """
    sample = Sample()
    joints = np.array([[0, 1, 0, 0]] * 4) if joints is None else joints
    weights = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 1, 0, 0], [1, 0, 0, 0]] if weights is None else weights
    mesh = sample.mesh(JOINTS_0=sample.accessor(joints, "uint8"), WEIGHTS_0=sample.accessor(weights, dtype, **more))
    lowered = np.eye(4)
    lowered[1, 3] = -0.5
    sample.add("skins", joints=[1, 2], inverseBindMatrices=sample.accessor([np.eye(4), lowered]))
    sample.add("nodes", mesh=mesh, skin=0, name="flag")
    sample.add("nodes", children=[2], name="first")
    sample.add("nodes", translation=[0, 0.5, 0], name="second")
    return sample


def big_model(path: Path, vertices: int = 60_000, bones: int = 64, keys: int = 30) -> Path:
    """A skinned tube with about ``vertices``, twice as many triangles, and one clip that moves every bone in all ways.

    With 60,000 it has about 5 MB.
    """
    around = 60
    rings = max(vertices // around, 2)
    angle, height = np.meshgrid(2.0 * np.pi * np.arange(around) / around, np.linspace(0.0, 10.0, rings))
    normals = np.stack([np.cos(angle), np.zeros_like(angle), np.sin(angle)], axis=-1).reshape(-1, 3)
    positions = normals * 0.5 + np.stack([0.0 * height, height, 0.0 * height], axis=-1).reshape(-1, 3)
    sample = Sample()
    along = np.repeat(np.linspace(0.0, bones - 1.0, rings), around)
    joints, weights = _weights(along, bones)
    mesh = sample.mesh(
        positions, None, NORMAL=sample.accessor(normals),
        TEXCOORD_0=sample.accessor(np.stack([angle.ravel(), height.ravel()], axis=1)),
        JOINTS_0=sample.accessor(joints, "uint16"), WEIGHTS_0=sample.accessor(weights))
    sample.json["meshes"][mesh]["primitives"][0]["indices"] = sample.accessor(_tube(rings, around).ravel(), "uint32")
    bind = np.tile(np.eye(4), (bones, 1, 1))
    bind[:, 1, 3] = -np.linspace(0.0, 10.0, bones)
    sample.add("skins", joints=list(range(1, bones + 1)), inverseBindMatrices=sample.accessor(bind))
    sample.add("nodes", mesh=mesh, skin=0, name="tube")
    for bone in range(bones):
        below = {"children": [bone + 2]} if bone + 1 < bones else {}
        sample.add("nodes", name=f"bone {bone}", translation=[0.0, 10.0 / (bones - 1) if bone else 0.0, 0.0], **below)
    _wave(sample, bones, keys)
    path.write_bytes(sample.glb())
    return path


def _weights(along: NDArray[np.float64], bones: int) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Four bones around each place ``along`` (n,) a chain, counted in bones, and their weights."""
    joints = np.clip(np.floor(along)[:, None] + np.arange(-1, 3), 0, bones - 1)
    weights = np.maximum(2.0 - np.abs(along[:, None] - np.floor(along)[:, None] - np.arange(-1, 3)), 0.0)
    return joints.astype(np.int64), weights / weights.sum(axis=1, keepdims=True)


def _tube(rings: int, around: int) -> NDArray[np.int64]:
    index = np.arange(rings * around).reshape(rings, around)
    a, b, c, d = index[:-1], index[1:], np.roll(index[1:], -1, axis=1), np.roll(index[:-1], -1, axis=1)
    return np.stack([np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)], axis=-2).reshape(-1, 3)


def _wave(sample: Sample, bones: int, keys: int) -> None:
    """One animation with a channel for the place, the turn and the size of each bone."""
    times = sample.accessor(np.linspace(0.0, 2.0, keys))
    samplers: list[dict[str, int]] = []
    channels: list[dict[str, Any]] = []
    for bone in range(bones):
        half = 0.05 * np.sin(np.linspace(0.0, 2.0 * np.pi, keys) + bone)
        turns = np.stack([0 * half, 0 * half, np.sin(half), np.cos(half)], axis=1)
        places = np.tile(sample.json["nodes"][bone + 1]["translation"], (keys, 1))
        sizes = 1.0 + np.stack([half, 0 * half, half], axis=1)
        for path, values in (("rotation", turns), ("translation", places), ("scale", sizes)):
            channels.append({"sampler": len(samplers), "target": {"node": bone + 1, "path": path}})
            samplers.append({"input": times, "output": sample.accessor(values)})
    sample.add("animations", name="wave", samplers=samplers, channels=channels)
