"""Volumes in NRRD files: pynrrd reads the header; what the header asks for is checked before it is done.

The format: https://teem.sourceforge.net/nrrd/format.html
"""

from __future__ import annotations

import bz2
import gzip
import io
import struct
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from viewer.kit.volume_layout import LARGEST_AXIS, Layout, Stream, VolumeError, by_axis, bytes_left, shown

LONGEST_HEADER = 2**20          # bytes
TEXT_AT_ONCE = 2**16            # bytes
LONGEST_NUMBER = 100            # characters
DOUBLE = struct.Struct("d")
MOST_SKIPPED = 2**20            # lines, or unpacked bytes
REQUIRED = ("type", "dimension", "sizes", "encoding")
PLAIN_KINDS = frozenset({"domain", "space", "time", "none", "???"})     # kinds of an axis along which one may walk
ENCODINGS = {"raw": "raw", "gzip": "gzip", "gz": "gzip", "bzip2": "bzip2", "bz2": "bzip2",
             **dict.fromkeys(("text", "txt", "ascii"), "text")}


@contextmanager
def open_nrrd(path: Path, most_samples: int) -> Iterator[tuple[Layout, Stream]]:
    """What a ``.nrrd`` or ``.nhdr`` file promises, checked, and a stream of its samples.

    Raises VolumeError, naming the file, for a header that is damaged, asks for what is not allowed, or
    promises another number of bytes than there are; OSError where the data file cannot be read.
    """
    with path.open("rb") as file:
        header = _header(path, file)
        layout = _layout(path, header)
        layout.check(most_samples)
        _refuse_vectors(path, header)
        detached = header.get("datafile", header.get("data file"))
        if detached is None and path.suffix.lower() == ".nhdr":
            raise VolumeError(f"volume {path} names no data file; a .nhdr header needs one")
        if detached is None:
            yield layout, _samples(layout, header, file)
        else:
            with _beside(path, str(detached)).open("rb") as data:
                yield layout, _samples(layout, header, data)


def _header(path: Path, file: BinaryIO) -> Mapping[str, Any]:
    """The fields of a header; leaves ``file`` behind the empty line that ends it."""
    import nrrd

    lines = HeaderLines(path, file)
    try:
        with np.errstate(invalid="ignore"):             # a size that is no number becomes one that is refused
            header: Mapping[str, Any] = nrrd.read_header(lines)
    except (nrrd.NRRDError, ValueError, TypeError, IndexError, OverflowError) as error:
        raise lines.refuse(shown(error)) from None
    except StopIteration:
        raise VolumeError(f"volume {path} is empty") from None
    for name in REQUIRED:
        if name not in header:
            raise VolumeError(f"volume {path} has no field {name}; its header needs {', '.join(REQUIRED)}")
    encoding = str(header["encoding"])
    if encoding.lower() not in ENCODINGS:
        raise VolumeError(f"volume {path} has encoding {shown(encoding)}; {', '.join(ENCODINGS)} are allowed")
    return {**header, "encoding": ENCODINGS[encoding.lower()]}


@dataclass
class HeaderLines:
    """The lines of a header one after another, so that an error can name the one it stopped at."""

    path: Path
    file: BinaryIO
    number: int = 0
    line: bytes = b""

    def __iter__(self) -> Iterator[bytes]:
        while line := self.file.readline(LONGEST_HEADER):
            self.number, self.line = self.number + 1, line
            if self.file.tell() > LONGEST_HEADER:
                raise VolumeError(f"volume {self.path} has a header of more than {LONGEST_HEADER:,} bytes, "
                                  "which is all that is allowed; is it an NRRD file?")
            is_field = self.number > 1 and line.strip() and not line.startswith(b"#")
            if is_field and b":" not in line:
                raise self.refuse("it is not of the form field: value")
            yield line

    def refuse(self, reason: str) -> VolumeError:
        """The error for the line that was read last."""
        line = shown(self.line.decode("ascii", "replace"))
        return VolumeError(f"volume {self.path}: line {self.number} of its header, {line!r}, cannot be read: {reason}")


def _layout(path: Path, header: Mapping[str, Any]) -> Layout:
    """The samples that a header promises; raises VolumeError if its fields contradict each other."""
    shape = tuple(int(size) for size in header["sizes"])
    if header["dimension"] != len(shape):
        raise VolumeError(f"volume {path} has dimension {header['dimension']} but {len(shape)} sizes, "
                          f"{by_axis(shape)}; their number must be the dimension")
    if min(shape, default=0) < 0:
        raise VolumeError(f"volume {path} has sizes {by_axis(shape)}; each must be positive")
    layout = Layout(path, shape, _sample_type(path, header), x_fastest=True, must_fill=True)
    return replace(layout, spacing=_spacing(path, header)) if len(shape) == 3 else layout


def _sample_type(path: Path, header: Mapping[str, Any]) -> np.dtype[Any]:
    """The NumPy type of the samples, which pynrrd tells by reading a single one."""
    import nrrd

    is_text = header["encoding"] == "text"
    endian = "little" if is_text else header.get("endian", "missing")
    single = {"dimension": 1, "sizes": np.array([1]), "encoding": "raw", "type": header["type"], "endian": endian}
    try:
        samples = nrrd.read_data(single, io.BytesIO(bytes(16)))
    except (nrrd.NRRDError, ValueError, KeyError):
        raise VolumeError(f"volume {path} has type {shown(header['type'])} and endian {shown(endian)}; a type such as "
                          "uint8, short or float and endian little or big are allowed") from None
    if is_text:
        return np.dtype(np.float64)
    dtype: np.dtype[Any] = samples.dtype
    return dtype


def _spacing(path: Path, header: Mapping[str, Any]) -> tuple[float, float, float]:
    """The distance of neighbours along each axis; 1 where the header gives none that is positive."""
    given = header.get("spacings", header.get("space directions", np.ones(3)))
    steps = np.asarray(given, np.float64)
    if len(steps) != 3:
        raise VolumeError(f"volume {path} gives the spacing of {len(steps)} axes; all three are needed")
    with np.errstate(over="ignore"):
        lengths = np.linalg.norm(steps.reshape(3, -1), axis=1)
    x, y, z = (float(length) if np.isfinite(length) and length > 0.0 else 1.0 for length in lengths)
    return x, y, z


def _refuse_vectors(path: Path, header: Mapping[str, Any]) -> None:
    """Raise VolumeError if an axis counts components, as of colours and vectors, instead of samples."""
    for kind in header.get("kinds", []):
        if kind.lower() not in PLAIN_KINDS:
            raise VolumeError(f"volume {path} has an axis of kind {shown(kind)}; one number at each sample is allowed, "
                              "so all three axes must be of kind domain or space")


def _beside(path: Path, name: str) -> Path:
    """The data file that a header names; raises VolumeError unless it lies in the header's folder or below."""
    if "://" in name or "%" in name or name.split()[:1] == ["LIST"]:
        raise VolumeError(f"volume {path} has its samples in {shown(name)}; a single file beside it is allowed")
    data = path.parent / name
    try:
        is_below = data.resolve().is_relative_to(path.parent.resolve())
        is_file = is_below and data.is_file()
    except (OSError, ValueError, RuntimeError):             # a NUL, too long, links that go in circles
        is_below, is_file = True, False
    if not is_below:
        raise VolumeError(f"volume {path} has its samples in {shown(name)}; "
                          "only files in its folder or below are allowed")
    if not is_file:
        raise VolumeError(f"volume {path} has its samples in {shown(name)}, which is not a file in {path.parent}")
    return data


def _samples(layout: Layout, header: Mapping[str, Any], file: BinaryIO) -> Stream:
    """A stream that begins with the first sample: past skipped lines, unpacked, past skipped bytes."""
    lines = _skip(layout, header, "line", 0, MOST_SKIPPED)
    for number in range(lines):
        if not file.readline(LONGEST_HEADER).endswith(b"\n"):
            raise VolumeError(f"volume {layout.path} has line skip {lines}, but only {number} lines before its samples")
    encoding = header["encoding"]
    if encoding == "raw":
        skipped = _skip(layout, header, "byte", -1, LARGEST_AXIS)
        left = bytes_left(file)
        file.seek(skipped if skipped >= 0 else max(left - layout.byte_count, 0), io.SEEK_CUR)
        layout.check_length(bytes_left(file))
        return file
    unpacked: Stream = (gzip.GzipFile(fileobj=file) if encoding == "gzip" else
                        bz2.BZ2File(file) if encoding == "bzip2" else TextSamples(layout.path, file))
    skipped = _skip(layout, header, "byte", 0, 0 if encoding == "text" else MOST_SKIPPED)
    unpacked.read(skipped)
    return unpacked


def _skip(layout: Layout, header: Mapping[str, Any], unit: str, least: int, most: int) -> int:
    """How many lines or bytes lie before the samples; raises VolumeError beyond ``least`` and ``most``."""
    skip = int(header.get(f"{unit}skip", header.get(f"{unit} skip", 0)))
    if not least <= skip <= most:
        raise VolumeError(f"volume {layout.path} has {unit} skip {shown(skip)}; {least} to {most:,} is allowed here")
    return skip


@dataclass
class TextSamples:
    """Numbers written as text, handed out as the bytes of float64."""

    path: Path
    file: BinaryIO
    unfinished: bytes = b""                             # the beginning of a number that goes on in the next part
    numbers: bytearray = field(default_factory=bytearray)

    def read(self, size: int, /) -> bytes:
        """The next ``size`` bytes; fewer at the end. Raises VolumeError for a word that is no number."""
        while len(self.numbers) < size and (part := self.file.read(TEXT_AT_ONCE)):
            words = (self.unfinished + part).split()
            self.unfinished = b"" if part[-1:].isspace() else words.pop()
            if len(self.unfinished) > LONGEST_NUMBER:
                raise self._refuse(self.unfinished)
            self._take(words)
        if len(self.numbers) < size:
            self._take(self.unfinished.split())
            self.unfinished = b""
        taken = bytes(self.numbers[:size])
        del self.numbers[:size]
        return taken

    def _take(self, words: Sequence[bytes]) -> None:
        for word in words:
            try:
                self.numbers += DOUBLE.pack(float(word))
            except ValueError:
                raise self._refuse(word) from None

    def _refuse(self, word: bytes) -> VolumeError:
        text = shown(word.decode("ascii", "replace"))
        return VolumeError(f"volume {self.path} has {text} among its samples; numbers are needed")
