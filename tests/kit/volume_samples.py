"""Volumes to write, and what is said about files that are none."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from viewer.kit.volume_file import VolumeError, read_volume

HEADER = {"type": "float", "dimension": "3", "sizes": "3 4 5", "encoding": "raw", "endian": "little"}


def samples(shape: tuple[int, ...], dtype: str) -> NDArray[np.generic]:
    """Numbers of every size that float32 can hold."""
    numbers = np.random.default_rng(3).normal(0.0, 60.0, shape)
    return (numbers % 100).astype(dtype) if np.dtype(dtype).kind in "u?" else numbers.astype(dtype)


def write_nrrd(path: Path, data: bytes = b"", **fields: str | None) -> Path:
    """An NRRD file with the fields of HEADER, changed by ``fields`` (None leaves one out), and ``data``."""
    given = {name: value for name, value in {**HEADER, **fields}.items() if value is not None}
    lines = ["NRRD0004", *(f"{name.replace('_', ' ')}: {value}" for name, value in given.items())]
    path.write_bytes("\n".join(lines).encode() + b"\n\n" + data)
    return path


def refusal(path: Path, most_samples: int = 2**27) -> str:
    """What is said about a file that cannot be read; checked to be one line that names the file."""
    with pytest.raises(VolumeError) as caught:
        read_volume(path, most_samples)
    message = str(caught.value)
    assert message.startswith(f"volume {path}") and "\n" not in message
    return message.removeprefix(f"volume {path}").lstrip(": ")
