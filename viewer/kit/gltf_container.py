"""The bytes of a glTF model: the file itself, as text or as GLB, and what it keeps in files beside it.

Nothing is opened that lies outside the model's folder, and nothing is read that is larger than is allowed.
"""

from __future__ import annotations

import binascii
import re
import struct
from pathlib import Path
from typing import NoReturn
from urllib.parse import unquote, unquote_to_bytes

from viewer.kit.gltf_document import Document, Entry, ModelFileError, parsed, told
from viewer.kit.volume_layout import shown

MOST_BYTES = 2**29              # of the file and all that it keeps beside it
MOST_RESOURCES = 2**12          # buffers, and images
MAGIC = b"glTF"
JSON_CHUNK, BINARY_CHUNK = b"JSON", b"BIN\0"
HEADER, CHUNK_HEADER = struct.Struct("<4sII"), struct.Struct("<I4s")
SCHEME = re.compile(r"[A-Za-z][A-Za-z0-9+.-]*:")        # of a URL, and the letter of a drive


class Container:
    """A glTF file that has been opened: its ``document``, and the bytes that it speaks of.

    Raises ModelFileError for a file that is no glTF, is cut short, or refers to files that it must not.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.bytes_read = 0
        data = self._read(path)
        text, self._binary = _chunks(path, data) if data[:4] == MAGIC else (data, None)
        self.document: Document = parsed(path, text)
        self._buffers: dict[int, memoryview] = {}
        for kind in ("buffers", "images"):
            if len(self.document.entries(kind)) > MOST_RESOURCES:
                self.document.refuse(f"it has {len(self.document.entries(kind)):,} {kind}; "
                                     f"at most {MOST_RESOURCES:,} are allowed")
        self._beside = {entry.place: self._place(entry) for kind in ("buffers", "images")
                        for entry in self.document.entries(kind)}

    def buffer(self, number: int) -> memoryview:
        """The bytes of a buffer, as many as it says that it has."""
        if number not in self._buffers:
            entry = self.document.entry("buffers", number)
            data = self._binary if number == 0 and "uri" not in entry.values else self._resource(entry)
            if data is None:
                entry.refuse("uri", "only the first buffer of a .glb file has its bytes in the file itself")
            length = entry.whole("byteLength", 1)
            if length > len(data):
                entry.refuse("byteLength", f"only {len(data):,} bytes are there")
            self._buffers[number] = memoryview(data)[:length]
        return self._buffers[number]

    def view(self, number: int) -> tuple[memoryview, int | None]:
        """The bytes of a buffer view, and how far apart its elements are, where it says so."""
        entry = self.document.entry("bufferViews", number)
        data = self.buffer(entry.needed_index("buffer", "buffers"))
        offset, length = entry.whole("byteOffset", default=0), entry.whole("byteLength", 1)
        if offset + length > len(data):
            entry.refuse("byteLength", f"from {offset:,} on it must end within the {len(data):,} bytes of its buffer")
        stride = entry.whole("byteStride", 1, 252) if "byteStride" in entry.values else None
        return data[offset:offset + length], stride

    def image(self, number: int) -> memoryview:
        """The bytes of an image, as they are in its file."""
        entry = self.document.entry("images", number)
        view = entry.index("bufferView", "bufferViews")
        if view is not None:
            return self.view(view)[0]
        data = self._resource(entry)
        if data is None:
            entry.refuse("uri", "a file, or a buffer view, is needed")
        return memoryview(data)

    def _resource(self, entry: Entry) -> bytes | None:
        """What an entry's URI leads to; None if it has none."""
        uri = entry.text("uri")
        if uri is None:
            return None
        if uri.startswith("data:"):
            return _inline(entry, uri)
        place = self._beside[entry.place]
        if place is None or not place.is_file():
            entry.refuse("uri", f"there is no such file in {self.path.parent}")
        return self._read(place)

    def _read(self, place: Path) -> bytes:
        size = place.stat().st_size
        self.bytes_read += size
        if self.bytes_read > MOST_BYTES:
            raise ModelFileError(f"model {self.path} has {self.bytes_read:,} bytes or more; "
                                 f"at most {MOST_BYTES:,} are allowed")
        with place.open("rb") as file:
            return file.read(size)

    def _place(self, entry: Entry) -> Path | None:
        """The file beside the model that an entry names; raises ModelFileError if it must not be opened."""
        uri = entry.text("uri")
        if uri is None or uri.startswith("data:"):
            return None
        name = unquote(uri)
        if SCHEME.match(name) or name.startswith("/") or "\\" in name or not name.isprintable():
            _refuse_uri(entry, uri)
        place = self.path.parent / name
        try:
            inside = place.resolve().is_relative_to(self.path.parent.resolve())
        except (OSError, ValueError, RuntimeError):             # too long, links that go in circles
            inside = False
        return place if inside else _refuse_uri(entry, uri)


def _refuse_uri(entry: Entry, uri: str) -> NoReturn:
    entry.document.refuse(f"{entry.named('uri')} is {told(uri)}; "
                          "only files in the model's folder or below are allowed")


def _inline(entry: Entry, uri: str) -> bytes:
    """The bytes that stand in a ``data:`` URI itself."""
    head, comma, payload = uri.partition(",")
    if not comma:
        entry.document.refuse(f"{entry.named('uri')} is {told(uri)}; data:, a type, a comma and the data are needed")
    if not head.endswith(";base64"):
        return unquote_to_bytes(payload)
    try:
        return binascii.a2b_base64(unquote(payload) if "%" in payload else payload)
    except ValueError as error:
        entry.document.refuse(f"{entry.named('uri')} holds damaged base64: {shown(error)}")


def _chunks(path: Path, data: bytes) -> tuple[bytes, bytes | None]:
    """The JSON and the bytes of the first buffer, if it has any, in a GLB file."""
    if len(data) < HEADER.size:
        raise ModelFileError(f"model {path} is cut short: a GLB header has {HEADER.size} bytes, it has {len(data)}")
    _, version, length = HEADER.unpack_from(data)
    if version != 2:
        raise ModelFileError(f"model {path} is GLB version {version}; 2 is allowed")
    if length != len(data):
        raise ModelFileError(f"model {path} is {'cut short' if length > len(data) else 'damaged'}: "
                             f"it says that it has {length:,} bytes and has {len(data):,}")
    text, start = _chunk(path, data, HEADER.size, JSON_CHUNK)
    if text is None:
        raise ModelFileError(f"model {path} is damaged: its first chunk is not JSON")
    binary = _chunk(path, data, start, BINARY_CHUNK)[0] if start < len(data) else None
    return text.rstrip(b"\0"), binary                           # which some writers fill up with


def _chunk(path: Path, data: bytes, start: int, wanted: bytes) -> tuple[bytes | None, int]:
    """The bytes of the chunk at ``start``, if it is of the kind that is ``wanted``, and where it ends."""
    if start + CHUNK_HEADER.size > len(data):
        raise ModelFileError(f"model {path} is damaged: it ends within the header of a chunk")
    size, kind = CHUNK_HEADER.unpack_from(data, start)
    start += CHUNK_HEADER.size
    if size > len(data) - start:
        raise ModelFileError(f"model {path} is damaged: a chunk says that it has {size:,} bytes, "
                             f"and {len(data) - start:,} are left")
    return data[start:start + size] if kind == wanted else None, start + size
