"""Volumes from NumPy's files: the same numbers as were written, and one clear line for every file that is bad."""

from __future__ import annotations

import os
import pickle
import time
import tracemalloc
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.lib import format as npy
from numpy.typing import NDArray

from tests.kit.volume_samples import refusal, samples, write_nrrd
from viewer.kit.volume_file import read_volume

SHAPES = [(2, 2, 2), (3, 4, 5), (2, 70, 3), (64, 2, 9), (2, 2, 70000), (70000, 2, 2), (65, 64, 66)]
DTYPES = ["?", "i1", "u1", "<i2", ">i2", "<u2", ">u2", "<i4", ">u4", "<i8", ">i8", "<u8", "<f2", ">f2", "<f4", ">f4",
          "<f8", ">f8"]


def write_npy_header(path: Path, shape: tuple[int, ...], descr: object = "<f4", length: int | None = None) -> Path:
    """A ``.npy`` file that is all header, and then perhaps a hole up to ``length`` bytes."""
    with path.open("wb") as file:
        npy.write_array_header_1_0(file, {"descr": descr, "fortran_order": False, "shape": shape})
    if length is not None:
        os.truncate(path, length)
    return path


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("dtype", DTYPES)
def test_npy_comes_back(tmp_path: Path, dtype: str, shape: tuple[int, int, int], order: str) -> None:
    """Every real type, byte order, index order and aspect."""
    array = np.asarray(samples(shape, dtype), order=order)      # type: ignore[call-overload]
    np.save(tmp_path / "field.npy", array)
    volume = read_volume(tmp_path / "field.npy")
    assert volume.values.dtype == np.float32 and volume.values.flags.c_contiguous
    assert np.array_equal(volume.values, array.astype(np.float32))
    assert volume.spacing == (1.0, 1.0, 1.0)
    assert (volume.lowest, volume.highest) == (volume.values.min(), volume.values.max())


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("at_once", [1, 5, 12, 30, 1000])
def test_parts_follow_each_other(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, order: str, at_once: int) -> None:
    """However few samples are read together: a part of a row, of a plane, a few planes, all of them."""
    monkeypatch.setattr("viewer.kit.volume_file.SAMPLES_AT_ONCE", at_once)
    array = np.asarray(samples((3, 4, 7), "<f8"), order=order)      # type: ignore[call-overload]
    np.save(tmp_path / "field.npy", array)
    assert np.array_equal(read_volume(tmp_path / "field.npy").values, array.astype(np.float32))


def test_only_finite_samples_bound_the_level(tmp_path: Path) -> None:
    """NaN and infinities stay where they are; what float32 cannot hold is infinite."""
    array = np.zeros((3, 3, 3))
    array[0, 0, :3], array[1, 1, 1], array[2, 2, :2] = (np.nan, np.inf, -np.inf), 1e300, (-4.0, 7.0)
    np.save(tmp_path / "field.npy", array)
    volume = read_volume(tmp_path / "field.npy")
    assert (volume.lowest, volume.highest) == (-4.0, 7.0)
    assert np.isnan(volume.values[0, 0, 0]) and volume.values[1, 1, 1] == np.inf


@pytest.mark.parametrize("order", ["C", "F"])
def test_memory_is_that_of_the_result(tmp_path: Path, order: str) -> None:
    """Twelve million doubles take little more than twelve million floats."""
    np.save(tmp_path / "field.npy", np.zeros((200, 300, 200), order=order))     # type: ignore[call-overload]
    tracemalloc.start()
    volume = read_volume(tmp_path / "field.npy")
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 1.25 * volume.values.nbytes


@pytest.mark.parametrize(("array", "message"), [
    (np.zeros(()), "has 0 axes (a single number); three are needed"),
    (np.zeros(8), "has 1 axis (8); three are needed"),
    (np.zeros((20, 30)), "has 2 axes (20 × 30); three are needed"),
    (np.zeros((4, 4, 4, 3)), "has 4 axes (4 × 4 × 4 × 3); three are needed"),
    (np.zeros((4, 0, 4)), "has 4 × 0 × 4 samples; each axis needs at least 2"),
    (np.zeros((4, 1, 4)), "has 4 × 1 × 4 samples; each axis needs at least 2"),
    (np.zeros((4, 4, 4), complex), "holds complex128; booleans, whole numbers and real numbers are allowed"),
    (np.zeros((4, 4, 4), "U3"), "holds str96; "), (np.zeros((4, 4, 4), "S3"), "holds bytes24; "),
    (np.zeros((4, 4, 4), "M8[s]"), "holds datetime64[s]; "), (np.zeros((4, 4, 4), "V5"), "holds void40; "),
    (np.zeros((4, 4, 4), [("red", "f4"), ("green", "f4")]), "holds void64; "),
    (np.full((4, 4, 4), {}), "holds object; booleans, "),
    (np.full((4, 4, 4), np.nan), "has no finite sample; at least one is needed"),
    (np.full((4, 4, 4), -1e300), "has no finite sample; "),
    (np.zeros((40, 50, 60)), "has 40 × 50 × 60 samples, 0.5 MiB as float32; at most 100,000 samples are "
     "allowed, 0.4 MiB"),
])
def test_no_volume_of_real_numbers(tmp_path: Path, array: NDArray[np.generic], message: str) -> None:
    """Other shapes and other things than real numbers are named."""
    np.save(tmp_path / "bad.npy", array, allow_pickle=True)
    assert refusal(tmp_path / "bad.npy", 100_000).startswith(message)


def test_damaged_npy(tmp_path: Path) -> None:
    """Files that are missing, empty, cut off or something else."""
    path = tmp_path / "bad.npy"
    assert refusal(path) == "does not exist"
    assert refusal(tmp_path / "bad\0.npy") == "does not exist"
    path.touch()
    assert refusal(path) == "is empty"
    for text in (b"\x89PNG\r\n\x1a\n....", b"\x93NUM", b"\x93NUMPY\x01\x00\xff\xff{",
                 b"\x93NUMPY\x02\x00\xff\xff\xff\xff{",
                 b"\x93NUMPY\x07\x00" + 99 * b"x", b"\x93NUMPY\x01\x00\x09\x00" + 9 * b"(", b"x" * 100000,
                 b"\x93NUMPY\x01\x00\x10\x27" + 10000 * b"[", b"\x93NUMPY\x01\x00\x06\x00\n {\n  "):
        path.write_bytes(text)
        assert refusal(path).startswith("is no NumPy array that can be read: ")
    for shape in ("(2, 2, -2)", "(2, 2, 'x')", "(2, 2, " + 4000 * "9" + ")", "(" + 9 * "2, " + ")", "[2, 2, 2]"):
        for kind in ("'<f4'", "'zz'", "(1, 2)", "'O'", "[('a', 'O')]", "('f4', (3,))"):
            header = f"{{'descr': {kind}, 'fortran_order': False, 'shape': {shape}}}".encode()
            path.write_bytes(b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header + bytes(100))
            assert len(refusal(path)) < 200
    np.save(path, np.zeros((10, 10, 10)))
    os.truncate(path, path.stat().st_size - 1000)
    assert refusal(path) == "is cut off: it holds 7,000 of the 8,000 bytes that 10 × 10 × 10 float64 samples need"


def test_other_files(tmp_path: Path) -> None:
    """A wrong suffix, and folders."""
    assert refusal(tmp_path / "head.dcm") == "ends in .dcm; .npy, .nrrd, .nhdr are allowed"
    assert refusal(tmp_path / "head") == "ends in no suffix; .npy, .nrrd, .nhdr are allowed"
    (tmp_path / "folder.npy").mkdir()
    assert refusal(tmp_path / "folder.npy") == "is not a file"
    np.save(tmp_path / "big.npy", np.zeros((3, 3, 3)))
    assert read_volume((tmp_path / "big.npy").rename(tmp_path / "BIG.NPY")).highest == 0.0


def test_nothing_is_unpickled(tmp_path: Path) -> None:
    """An array of objects would run code when unpickled; it does not."""
    marker = tmp_path / "it ran"

    class Bomb:
        def __reduce__(self) -> tuple[Callable[..., object], tuple[str]]:
            return os.mkdir, (str(marker),)

    np.save(tmp_path / "bomb.npy", np.full((2, 2, 2), Bomb(), object), allow_pickle=True)
    assert refusal(tmp_path / "bomb.npy").startswith("holds object; ")
    (tmp_path / "bare.npy").write_bytes(pickle.dumps(Bomb()))
    refusal(tmp_path / "bare.npy")
    assert not marker.exists()
    with (tmp_path / "bare.npy").open("rb") as file:
        pickle.load(file)
    assert marker.exists()


@pytest.mark.parametrize("suffix", [".npy", ".nrrd"])
def test_a_huge_file_is_refused_from_its_header(tmp_path: Path, suffix: str) -> None:
    """Ten gigabytes are neither read nor asked for."""
    path = tmp_path / f"huge{suffix}"
    if suffix == ".npy":
        write_npy_header(path, (1360, 1360, 1360))
    else:
        write_nrrd(path, sizes="1360 1360 1360")
    os.truncate(path, 1360**3 * 4 + path.stat().st_size)
    tracemalloc.start()
    start = time.perf_counter()
    message = refusal(path)
    duration = time.perf_counter() - start
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert message == ("has 1,360 × 1,360 × 1,360 samples, 9.4 GiB as float32; "
                       "at most 134,217,728 samples are allowed, 0.5 GiB")
    assert duration < 0.1 and peak < 4e6


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="the superuser may read everything")
def test_a_file_that_may_not_be_read(tmp_path: Path) -> None:
    """The system's reason is told."""
    np.save(tmp_path / "secret.npy", np.zeros((3, 3, 3)))
    (tmp_path / "secret.npy").chmod(0)
    assert refusal(tmp_path / "secret.npy") == "cannot be read: Permission denied"
