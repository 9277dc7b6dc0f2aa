"""Primitives of a glTF file: a run of triangles with one material, and the attributes of its vertices."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from viewer.kit.gltf_accessor import Accessors
from viewer.kit.gltf_document import Entry
from viewer.kit.gltf_influences import Influences, attribute, read_influences
from viewer.kit.gltf_material import Look, Looks
from viewer.kit.mesh import normalized
from viewer.kit.mesh_file import FARTHEST
from viewer.kit.pseudonormal import vertex_normals
from viewer.kit.shapes import face_normals

MOST_VERTICES = 5_000_000
MOST_TRIANGLES = 10_000_000
TRIANGLES, STRIP, FAN = 4, 5, 6                 # modes; those before are points and lines
TRIANGLES_AT_ONCE = 2**19                       # of which normals are made together
UP = (0.0, 1.0, 0.0)                            # the normal of a vertex that no triangle has


@dataclass(frozen=True, eq=False)
class Primitive:
    """Vertices in the space of their mesh, triangles of their numbers, how they look and what they follow.

    ``positions`` and ``normals`` (n, 3), ``texcoords`` (n, 2) float32, ``triangles`` (m, 3) int32.
    """

    positions: NDArray[np.float32]
    normals: NDArray[np.float32]
    texcoords: NDArray[np.float32]
    triangles: NDArray[np.int32]
    look: Look
    influences: Influences | None


class Primitives:
    """The primitives of an opened file, each read once; ``notes`` says what was changed or left out."""

    def __init__(self, accessors: Accessors, looks: Looks) -> None:
        self.notes: list[str] = []
        self._accessors = accessors
        self._looks = looks
        self._read: dict[str, Primitive] = {}

    def size(self, entry: Entry) -> tuple[int, int]:
        """How many vertices and triangles a primitive says that it has, which is none for points and lines."""
        mode = entry.whole("mode", 0, FAN, default=TRIANGLES)
        vertices = self._accessors.count(entry.child("attributes").needed_index("POSITION", "accessors"))
        indices = entry.index("indices", "accessors")
        corners = vertices if indices is None else self._accessors.count(indices)
        if mode < TRIANGLES:
            return 0, 0
        return vertices, corners // 3 if mode == TRIANGLES else max(corners - 2, 0)

    def read(self, entry: Entry) -> Primitive:
        """A primitive of triangles. Raises ModelFileError for what does not fit together."""
        if entry.place not in self._read:
            self._read[entry.place] = self._decode(entry)
        return self._read[entry.place]

    def _decode(self, entry: Entry) -> Primitive:
        attributes = entry.child("attributes")
        positions = self._positions(attributes)
        count = len(positions)
        triangles = self._triangles(entry, count)
        look = self._looks.look(entry.index("material", "materials"))
        if entry.children("targets"):
            self.notes.append(f"{entry.place} has shapes to blend into (morph targets), which are left out.")
        return Primitive(positions, self._normals(attributes, positions, triangles),
                         self._texcoords(attributes, count, look), triangles, look,
                         read_influences(attributes, self._accessors, count, self.notes))

    def _positions(self, attributes: Entry) -> NDArray[np.float32]:
        number = attributes.needed_index("POSITION", "accessors")
        positions = self._accessors.floats(number, "VEC3", MOST_VERTICES)
        farthest = float(np.abs(positions).max())
        if farthest > FARTHEST:
            attributes.document.refuse(f"accessors[{number}] reaches {farthest:g} m from the origin; "
                                       f"at most {FARTHEST:g} m are allowed")
        return positions

    def _triangles(self, entry: Entry, count: int) -> NDArray[np.int32]:
        number = entry.index("indices", "accessors")
        corners: NDArray[Any]
        if number is None:
            corners = np.arange(count)
        else:
            corners = self._accessors.unsigned(number, "SCALAR", 3 * MOST_TRIANGLES)[:, 0]
            if corners.max() >= count:
                entry.document.refuse(f"accessors[{number}] has a triangle with vertex {corners.max():,}; "
                                      f"there are {count:,}")
        return triangles_of(corners, entry.whole("mode", default=TRIANGLES)).astype(np.int32)

    def _normals(self, attributes: Entry, positions: NDArray[np.float32],
                 triangles: NDArray[np.int32]) -> NDArray[np.float32]:
        """Those of the file, of length one; smooth ones where it has none."""
        number = attribute(attributes, "NORMAL", self._accessors, len(positions))
        if number is None:
            return smooth_normals(positions, triangles)
        given = self._accessors.floats(number, "VEC3", MOST_VERTICES, finite=False).astype(np.float64)
        normals = normalized(np.where(np.isfinite(given).all(axis=1, keepdims=True), given, 0.0))
        missing = ~normals.any(axis=1)
        if missing.any():
            normals[missing] = smooth_normals(positions, triangles)[missing]
        return normals.astype(np.float32)

    def _texcoords(self, attributes: Entry, count: int, look: Look) -> NDArray[np.float32]:
        number = attribute(attributes, f"TEXCOORD_{look.texcoord_set}", self._accessors, count)
        if number is None:
            return np.zeros((count, 2), np.float32)
        given = self._accessors.floats(number, "VEC2", MOST_VERTICES, finite=False)
        places = np.clip(np.where(np.isfinite(given), given, np.float32(0.0)), -FARTHEST, FARTHEST)
        if look.placing is not None:
            places = places @ look.placing[:, :2].T + look.placing[:, 2]
        return places.astype(np.float32)


def triangles_of(corners: NDArray[Any], mode: int) -> NDArray[Any]:
    """Triangles (m, 3) from the numbers of vertices (n,) in the order of a list, a strip or a fan of triangles."""
    if mode == TRIANGLES:
        return corners[:len(corners) // 3 * 3].reshape(-1, 3)
    first = np.arange(max(len(corners) - 2, 0))
    if mode == STRIP:
        odd = first % 2                         # every other triangle of a strip is wound the other way
        return np.stack([corners[first], corners[first + 1 + odd], corners[first + 2 - odd]], axis=1)
    return np.stack([corners[first + 1], corners[first + 2], corners[first * 0]], axis=1)


def smooth_normals(positions: NDArray[np.float32], triangles: NDArray[np.int32]) -> NDArray[np.float32]:
    """The mean of the normals around each vertex, weighted by the angles there, of length one: (n, 3)."""
    vertices, total = positions.astype(np.float64), np.zeros(positions.shape)
    for start in range(0, len(triangles), TRIANGLES_AT_ONCE):
        some = triangles[start:start + TRIANGLES_AT_ONCE]
        total += vertex_normals(vertices, some, face_normals(vertices, some))
    normals = normalized(total)
    return np.where(normals.any(axis=1, keepdims=True), normals, UP).astype(np.float32)
