"""Accessors of a glTF file: typed arrays over its bytes, checked before anything is allocated."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from viewer.kit.gltf_container import Container
from viewer.kit.gltf_document import Entry

WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
Types = Mapping[int, np.dtype[Any]]

FLOAT: Types = {5126: np.dtype("<f4")}
SMALL: Types = {5121: np.dtype("<u1"), 5123: np.dtype("<u2")}
UNSIGNED: Types = {**SMALL, 5125: np.dtype("<u4")}
SIGNED: Types = {5120: np.dtype("<i1"), 5122: np.dtype("<i2")}
NUMBER: Types = {**FLOAT, **UNSIGNED, **SIGNED}
NUMBERS_PER_BYTE = 2            # of the buffers that may be asked for: each read once, and gathered with others once
SPARE_NUMBERS = 2**22           # beyond that


class Accessors:
    """The accessors of an opened file, each decoded once.

    What all of them together may ask for is bounded by the size of the file, so that a small one that has many
    accessors over the same bytes, or over none at all, cannot fill the memory.
    """

    def __init__(self, container: Container) -> None:
        self._container = container
        self._raw: dict[int, NDArray[Any]] = {}
        self._floats: dict[int, NDArray[np.float32]] = {}
        self._finite: set[int] = set()
        self._numbers = 0

    def count(self, number: int) -> int:
        """How many elements an accessor says that it has."""
        return self._container.document.entry("accessors", number).whole("count", 1)

    def floats(self, number: int, kind: str, most: int, types: Types = NUMBER,
               finite: bool = True) -> NDArray[np.float32]:
        """An accessor of ``kind``, such as VEC3, and at most ``most`` elements: (count, width), not to be changed.

        Whole numbers that are normalised come as shares of the largest, others as they are. Raises
        ModelFileError for other kinds and ``types``, and unless ``finite`` is false for NaN and infinities.
        """
        raw = self._checked(number, kind, most, types)
        entry = self._container.document.entry("accessors", number)
        if number not in self._floats:
            self._floats[number] = _as_floats(entry, raw)
        if finite and raw.dtype.kind == "f" and number not in self._finite:
            _check_finite(entry, self._floats[number])
            self._finite.add(number)
        return self._floats[number]

    def unsigned(self, number: int, kind: str, most: int,
                 types: Types = UNSIGNED) -> NDArray[np.unsignedinteger[Any]]:
        """An accessor of whole numbers that are not negative: (count, width), not to be changed."""
        return self._checked(number, kind, most, types)

    def spend(self, entry: Entry, numbers: int) -> None:
        """Take ``numbers`` for what is read for ``entry``; raises ModelFileError if that is more than is left."""
        self._numbers += numbers
        allowed = NUMBERS_PER_BYTE * self._container.bytes_read + SPARE_NUMBERS
        if self._numbers > allowed:
            entry.document.refuse(f"with {entry.place} it asks for {self._numbers:,} numbers; "
                                  f"in a file of its size at most {allowed:,} are allowed")

    def _checked(self, number: int, kind: str, most: int, types: Types) -> NDArray[Any]:
        """The elements of an accessor as they are in the file."""
        entry = self._container.document.entry("accessors", number)
        if entry.values.get("type") != kind:
            entry.refuse("type", f"{kind} is needed here")
        dtype = _dtype(entry, types)
        count = entry.whole("count", 1, most)
        if number not in self._raw:
            self._raw[number] = self._filled(entry, dtype, count, WIDTHS[kind])
        return self._raw[number]

    def _filled(self, entry: Entry, dtype: np.dtype[Any], count: int, width: int) -> NDArray[Any]:
        """The elements of an accessor, with those that a sparse one puts in place of others."""
        values = self._elements(entry, dtype, count, width)
        self.spend(entry, count * width)
        if values is None:
            values = np.zeros((count, width), dtype)
        if "sparse" not in entry.values:
            return values
        sparse = entry.child("sparse")
        replaced = sparse.whole("count", 1, count)
        indices, others = sparse.child("indices"), sparse.child("values")
        places = self._needed_elements(indices, _dtype(indices, UNSIGNED), replaced, 1)[:, 0]
        if places.max() >= count:
            sparse.document.refuse(f"{indices.place} has {places.max():,}; 0 to {count - 1:,} are allowed")
        values = values.copy()
        values[places] = self._needed_elements(others, dtype, replaced, width)
        return values

    def _needed_elements(self, entry: Entry, dtype: np.dtype[Any], count: int, width: int) -> NDArray[Any]:
        entry.needed_index("bufferView", "bufferViews")
        elements = self._elements(entry, dtype, count, width)
        assert elements is not None
        return elements

    def _elements(self, entry: Entry, dtype: np.dtype[Any], count: int, width: int) -> NDArray[Any] | None:
        """``count`` rows over the bytes of an entry's buffer view, not copied; None if it has no view."""
        view = entry.index("bufferView", "bufferViews")
        if view is None:
            return None
        data, stride = self._container.view(view)
        offset, size = entry.whole("byteOffset", default=0), dtype.itemsize * width
        stride = size if stride is None else stride
        if stride < size:
            self._container.document.entry("bufferViews", view).refuse(
                "byteStride", f"the elements of {entry.place} have {size} bytes each")
        if offset + stride * (count - 1) + size > len(data):
            entry.document.refuse(f"{entry.place} has {count:,} elements of {size} bytes, {stride} apart, from byte "
                                  f"{offset:,}; its buffer view has {len(data):,} bytes")
        return np.ndarray((count, width), dtype, data, offset, (stride, dtype.itemsize))


def _dtype(entry: Entry, types: Types) -> np.dtype[Any]:
    code = entry.values.get("componentType")
    if type(code) is not int or code not in types:
        entry.refuse("componentType", f"{', '.join(map(str, sorted(types)))} are allowed here")
    return types[code]


def _as_floats(entry: Entry, raw: NDArray[Any]) -> NDArray[np.float32]:
    if raw.dtype.kind == "f":
        unclear = np.isnan(raw)                 # among them may be signalling ones, of which NumPy would warn later
        return np.where(unclear, np.float32(np.nan), raw) if unclear.any() else raw.astype(np.float32, copy=False)
    if not entry.flag("normalized"):
        return raw.astype(np.float32)
    return np.maximum(raw / np.float32(np.iinfo(raw.dtype).max), -1.0, dtype=np.float32)


def _check_finite(entry: Entry, values: NDArray[np.float32]) -> None:
    finite = np.isfinite(values)
    if not finite.all():
        wrong = int(np.argmin(finite.all(axis=1)))
        row = ", ".join(f"{value:g}" for value in values[wrong])
        entry.document.refuse(f"{entry.place} has ({row}) at {wrong:,}; finite numbers are needed")
