"""How the samples of a volume lie in a file, and what is refused before any of them is read."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from viewer.errors import DemoscopeError

REAL_KINDS = "biuf"             # NumPy's letters for booleans, signed and unsigned whole numbers, real numbers
FEWEST_ALONG_AXIS = 2           # less is no cell
LARGEST_AXIS = 2**63 - 1        # the largest size a file format has room for


class VolumeError(DemoscopeError):
    """A volume that is missing, damaged, too large, or no volume of real numbers."""


class Stream(Protocol):
    """What samples are read from: a file, a file that unpacks itself, numbers written as text."""

    def read(self, size: int, /) -> bytes:
        """The next ``size`` bytes; fewer at the end."""


@dataclass(frozen=True)
class Layout:
    """The samples that a file promises: their number along x, y, z, their type, and in which order they come."""

    path: Path
    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    x_fastest: bool                                         # Fortran's order, and NRRD's; else z is fastest
    spacing: tuple[float, float, float] = (1.0, 1.0, 1.0)
    must_fill: bool = False                                 # whether the file may hold nothing after the samples

    @property
    def count(self) -> int:
        """How many samples there are."""
        return math.prod(self.shape)

    @property
    def byte_count(self) -> int:
        """How many bytes they take in the file, unpacked."""
        return self.count * self.dtype.itemsize

    def check(self, most_samples: int) -> None:
        """Raise VolumeError unless these are real numbers along three axes, and no more than ``most_samples``."""
        if self.dtype.kind not in REAL_KINDS:
            raise VolumeError(f"volume {self.path} holds {shown(self.dtype.name)}; "
                              "booleans, whole numbers and real numbers are allowed")
        if len(self.shape) != 3:
            axes = "1 axis" if len(self.shape) == 1 else f"{len(self.shape)} axes"
            raise VolumeError(f"volume {self.path} has {axes} ({by_axis(self.shape) or 'a single number'}); "
                              "three are needed, x, y and z")
        if min(self.shape) < FEWEST_ALONG_AXIS:
            raise VolumeError(f"volume {self.path} has {by_axis(self.shape)} samples; "
                              f"each axis needs at least {FEWEST_ALONG_AXIS}")
        if self.count > most_samples:
            raise VolumeError(f"volume {self.path} has {by_axis(self.shape)} samples, {gibibytes(self.count)} "
                              f"as float32; at most {most_samples:,} samples are allowed, {gibibytes(most_samples)}")

    def check_length(self, byte_count: int) -> None:
        """Raise VolumeError if ``byte_count``, what the file holds after its header, is too short or too long."""
        if byte_count < self.byte_count:
            raise VolumeError(f"volume {self.path} is cut off: it holds {max(byte_count, 0):,} of the "
                              f"{self.byte_count:,} bytes that {by_axis(self.shape)} {self.dtype.name} samples need")
        if self.must_fill and byte_count > self.byte_count:
            raise VolumeError(f"volume {self.path} holds more than the {self.byte_count:,} bytes that "
                              f"{by_axis(self.shape)} {self.dtype.name} samples need; its sizes or its type are wrong")


def bytes_left(stream: Any) -> int:
    """How many bytes an open file holds after the place where it is read; negative beyond its end."""
    return os.fstat(stream.fileno()).st_size - int(stream.tell())


def by_axis(shape: tuple[int, ...]) -> str:
    """A shape as a person would say it: 64 × 64 × 32."""
    return " × ".join(f"{size:,}" if abs(size) <= LARGEST_AXIS else "far too many" for size in shape[:8])


def gibibytes(count: int) -> str:
    """The memory that ``count`` samples take as float32."""
    if count > LARGEST_AXIS:
        return "far too many GiB"
    return f"{count * 4 / 2**30:,.1f} GiB" if count >= 2**26 else f"{count * 4 / 2**20:,.1f} MiB"


def shown(text: object) -> str:
    """``text`` on one line and no longer than fits into a message."""
    line = " ".join(str(text).split())
    line = "".join(letter if letter.isprintable() and letter != "\ufffd" else "?" for letter in line)
    return line if len(line) <= 80 else f"{line[:60]}..."
