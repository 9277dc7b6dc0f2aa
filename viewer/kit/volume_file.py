"""Volumes in files: samples of a field on a box-shaped grid, as scanners, simulations and NumPy write them.

    volume = read_volume(Path("engine.nrrd"))
    volume.values.shape                     # (256, 256, 128): along x, y, z
    volume.lowest, volume.highest           # where a level makes sense

``.npy`` is NumPy's format, axes x, y, z; nothing in it is ever unpickled. ``.nrrd`` holds a header and the
samples, raw, compressed or as text; ``.nhdr`` is such a header with the samples in a file beside it.
"""

from __future__ import annotations

import io
import tokenize
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from viewer.kit.volume_layout import Layout, Stream, VolumeError, bytes_left, shown
from viewer.kit.volume_nrrd import open_nrrd

__all__ = ["SUFFIXES", "Volume", "VolumeError", "read_volume"]

SUFFIXES = (".npy", ".nrrd", ".nhdr")
MOST_SAMPLES = 2**27            # 512 in each direction
SAMPLES_AT_ONCE = 2**19         # read, converted and looked at together
LONGEST_NPY_HEADER = 2**16      # bytes


@dataclass(frozen=True)
class Volume:
    """Samples of a field on a grid.

    ``values`` is (nx, ny, nz), float32 and C-contiguous, and may hold NaN and infinities; ``spacing`` is the
    distance of neighbours along x, y and z in the file's unit; ``lowest`` and ``highest`` bound what is finite.
    """

    values: NDArray[np.float32]
    spacing: tuple[float, float, float]
    lowest: float
    highest: float


def read_volume(path: Path, most_samples: int = MOST_SAMPLES) -> Volume:
    """The volume in a file, whatever real numbers it holds, as float32.

    Takes little more memory than the result. Raises VolumeError, naming the file, for one that is missing,
    damaged, no volume of real numbers, nowhere finite, or of more than ``most_samples``; the latter is
    known from the header alone.
    """
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise VolumeError(f"volume {path} ends in {suffix or 'no suffix'}; {', '.join(SUFFIXES)} are allowed")
    if not path.is_file():
        raise VolumeError(f"volume {path} {'is not a file' if path.exists() else 'does not exist'}")
    opened = _open_npy if suffix == ".npy" else open_nrrd
    try:
        with opened(path, most_samples) as (layout, stream):
            return _read_samples(layout, stream)
    except (OSError, EOFError, zlib.error) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else error
        raise VolumeError(f"volume {path} cannot be read: {shown(reason)}") from error


@contextmanager
def _open_npy(path: Path, most_samples: int) -> Iterator[tuple[Layout, Stream]]:
    """What a ``.npy`` file promises, checked, and the file at its first sample."""
    with path.open("rb") as file:
        head = io.BytesIO(file.read(LONGEST_NPY_HEADER))
        if not head.getbuffer().nbytes:
            raise VolumeError(f"volume {path} is empty")
        try:
            shape, x_fastest, dtype = _npy_header(head)
        except (ValueError, SyntaxError, RecursionError, MemoryError, TypeError, tokenize.TokenError) as error:
            raise VolumeError(f"volume {path} is no NumPy array that can be read: {shown(error)}") from None
        layout = Layout(path, shape, dtype, x_fastest)
        layout.check(most_samples)
        file.seek(head.tell())
        layout.check_length(bytes_left(file))
        yield layout, file


def _npy_header(head: io.BytesIO) -> tuple[tuple[int, ...], bool, np.dtype[Any]]:
    """Shape, order and type in the header of a ``.npy`` file, which is read as a Python literal, never run."""
    version = np.lib.format.read_magic(head)
    if version == (1, 0):
        return np.lib.format.read_array_header_1_0(head)
    if version == (2, 0):
        return np.lib.format.read_array_header_2_0(head)
    raise ValueError(f"its version is {version[0]}.{version[1]}; 1.0 and 2.0 are allowed")


def _read_samples(layout: Layout, stream: Stream) -> Volume:
    """The samples that ``stream`` holds, converted a part at a time."""
    values = np.empty(layout.shape, np.float32)
    lowest, highest, first = np.inf, -np.inf, 0
    for part in _parts(values.T if layout.x_fastest else values):
        wanted = part.size * layout.dtype.itemsize
        read = stream.read(wanted)
        if len(read) < wanted:
            layout.check_length(first * layout.dtype.itemsize + len(read))
        with np.errstate(over="ignore"):
            part[...] = np.frombuffer(read, layout.dtype).reshape(part.shape)
        first += part.size
        finite = np.isfinite(part)
        lowest = min(lowest, float(part.min(initial=np.inf, where=finite)))
        highest = max(highest, float(part.max(initial=-np.inf, where=finite)))
    if layout.must_fill and stream.read(1):
        layout.check_length(layout.byte_count + 1)
    if lowest > highest:
        raise VolumeError(f"volume {layout.path} has no finite sample; at least one is needed")
    return Volume(values, layout.spacing, lowest, highest)


def _parts(values: NDArray[np.float32]) -> Iterator[NDArray[np.float32]]:
    """Views of at most SAMPLES_AT_ONCE samples that follow each other, the last axis running fastest."""
    inner = values[0].size if values.ndim > 1 else 1
    if inner > SAMPLES_AT_ONCE:
        for row in values:
            yield from _parts(row)
    else:
        step = SAMPLES_AT_ONCE // inner
        yield from (values[first:first + step] for first in range(0, len(values), step))
