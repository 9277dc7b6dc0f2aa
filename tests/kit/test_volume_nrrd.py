"""Volumes from NRRD files: the same numbers as pynrrd wrote, and one clear line for every file that is bad."""

from __future__ import annotations

import bz2
import gzip
import re
import shutil
import tracemalloc
from pathlib import Path

import nrrd
import numpy as np
import pytest

from tests.kit.volume_samples import refusal, samples, write_nrrd
from viewer.kit.volume_file import VolumeError, read_volume

TYPES = ["i1", "u1", "<i2", ">u2", "<i4", ">u4", "<i8", "<u8", "<f4", ">f4", "<f8", ">f8"]


@pytest.mark.parametrize("encoding", ["raw", "gzip", "bzip2", "ascii"])
@pytest.mark.parametrize("dtype", TYPES)
@pytest.mark.parametrize("detached", [False, True])
def test_nrrd_comes_back(tmp_path: Path, dtype: str, encoding: str, detached: bool) -> None:
    """Every type that pynrrd writes, in each encoding, in one file and in two."""
    array = samples((7, 30, 11), dtype)
    path = tmp_path / ("field.nhdr" if detached else "field.nrrd")
    nrrd.write(str(path), array, {"encoding": encoding, "spacings": [0.5, 2.0, 3.5]}, detached_header=detached)
    volume = read_volume(path)
    assert volume.values.flags.c_contiguous and volume.values.shape == (7, 30, 11)
    assert np.allclose(volume.values, array.astype(np.float32), rtol=1e-6, atol=0.0)
    assert volume.spacing == (0.5, 2.0, 3.5)


@pytest.mark.parametrize("encoding", ["raw", "gzip", "bzip2", "ascii"])
def test_a_long_nrrd_comes_back(tmp_path: Path, encoding: str) -> None:
    """More samples than are converted at once."""
    array = samples((65, 64, 66), "<f4")
    nrrd.write(str(tmp_path / "field.nrrd"), array, {"encoding": encoding})
    assert np.allclose(read_volume(tmp_path / "field.nrrd").values, array, rtol=1e-6, atol=0.0)


@pytest.mark.parametrize(("fields", "spacing"), [
    ({}, (1.0, 1.0, 1.0)),
    ({"spacings": "nan 0 -2"}, (1.0, 1.0, 2.0)),
    ({"spacings": "1e400 1e-3 2"}, (1.0, 1e-3, 2.0)),
    ({"space_dimension": "3", "space_directions": "(3,4,0) (0,0,2) (0,0,0)"}, (5.0, 2.0, 1.0)),
    ({"space_dimension": "3", "space_directions": "none (0,0,2) (0,-7,0)"}, (1.0, 2.0, 7.0)),
    ({"kinds": "domain space ???", "labels": '"x" "a b" "z"', "anything:=": "goes"}, (1.0, 1.0, 1.0)),
])
def test_spacing(tmp_path: Path, fields: dict[str, str], spacing: tuple[float, float, float]) -> None:
    """The lengths of the steps along the axes; what is missing, zero or no number is 1."""
    path = write_nrrd(tmp_path / "field.nrrd", np.arange(60, dtype="<f4").tobytes(), **fields)
    assert read_volume(path).spacing == spacing


def test_skips(tmp_path: Path) -> None:
    """Lines and bytes before the samples, and samples at the end of a file, where the header says so."""
    data = np.arange(60, dtype="<f4")
    expected = data.reshape(5, 4, 3).T
    for name, before, fields in [("lines", b"a\nb\n", {"line_skip": "2"}), ("bytes", b"abc", {"byteskip": "3"}),
                                 ("both", b"a\nbc", {"line skip": "1", "byte skip": "2"}),
                                 ("end", b"anything", {"byte_skip": "-1"})]:
        path = write_nrrd(tmp_path / f"{name}.nrrd", before + data.tobytes(), **fields)
        assert np.array_equal(read_volume(path).values, expected), name
    packed = gzip.compress(b"abc" + data.tobytes())
    path = write_nrrd(tmp_path / "packed.nrrd", b"x\n" + packed, encoding="gz", line_skip="1", byte_skip="3")
    assert np.array_equal(read_volume(path).values, expected)


@pytest.mark.parametrize(("fields", "message"), [
    ({"sizes": "3 4"}, "has dimension 3 but 2 sizes, 3 × 4; their number must be the dimension"),
    ({"sizes": "3 4 -5"}, "has sizes 3 × 4 × -5; each must be positive"),
    ({"sizes": "3 4 0"}, "has 3 × 4 × 0 samples; each axis needs at least 2"),
    ({"sizes": "3 4 1"}, "has 3 × 4 × 1 samples; each axis needs at least 2"),
    ({"sizes": "3 4 x"}, "line 4 of its header, 'sizes: 3 4 x', cannot be read: "),
    ({"sizes": ""}, "has dimension 3 but 0 sizes"),
    ({"sizes": "9999999 9999999 9999999"}, "has 9,999,999 × 9,999,999 × 9,999,999 samples, far too many GiB as float"),
    ({"sizes": "99999999999999999999999999 2 2"}, "has "), ({"sizes": "nan 2 2"}, "has "),
    ({"sizes": "3 4 6"}, "is cut off: it holds 240 of the 288 bytes that 3 × 4 × 6 float32 samples need"),
    ({"sizes": "3 4 4"}, "holds more than the 192 bytes that 3 × 4 × 4 float32 samples need; its sizes or its type"),
    ({"type": "short"}, "holds more than the 120 bytes that 3 × 4 × 5 int16 samples need; "),
    ({"dimension": "three"}, "line 3 of its header, 'dimension: three', cannot be read: "),
    ({"dimension": "2", "sizes": "6 10"}, "has 2 axes (6 × 10); three are needed, x, y and z"),
    ({"dimension": "4", "sizes": "3 2 2 5", "kinds": "vector domain domain domain"},
     "has 4 axes (3 × 2 × 2 × 5); three are needed"),
    ({"kinds": "RGB-color domain domain"}, "has an axis of kind RGB-color; one number at each sample is allowed, "),
    ({"type": None}, "has no field type; its header needs type, dimension, sizes, encoding"),
    ({"dimension": None}, "has no field dimension; "), ({"sizes": None}, "has no field sizes; "),
    ({"encoding": None}, "has no field encoding; "),
    ({"endian": None}, "has type float and endian missing; a type such as uint8, short or float and "),
    ({"endian": "middle"}, "has type float and endian middle; "),
    ({"type": "block"}, "has type block and endian little; "),
    ({"type": "quaternion"}, "has type quaternion and endian little; "),
    ({"encoding": "zip"}, "has encoding zip; raw, gzip, gz, bzip2, bz2, text, txt, ascii are allowed"),
    ({"encoding": "gzip"}, "cannot be read: Not a gzipped file"),
    ({"encoding": "bzip2"}, "cannot be read: Invalid data"),
    ({"encoding": "text"}, "has ???"),
    ({"byte_skip": "-2"}, "has byte skip -2; -1 to "),
    ({"byte_skip": "100"}, "is cut off: it holds 140 of the 240 bytes"),
    ({"byte_skip": "99999999999999999999"}, "has byte skip 99999999999999999999; -1 to "),
    ({"byte_skip": "-1", "encoding": "gzip"}, "has byte skip -1; 0 to 1,048,576 is allowed here"),
    ({"line_skip": "-1"}, "has line skip -1; 0 to 1,048,576 is allowed here"),
    ({"line_skip": "7"}, "has line skip 7, but only "),
    ({"spacings": "1 2"}, "gives the spacing of 2 axes; all three are needed"),
    ({"space_directions": "(1,0,0) (0,1"}, "line 7 of its header, 'space directions: (1,0,0) (0,1', cannot be read: "),
    ({"labels": '"x'}, "line 7 of its header, 'labels: \"x', cannot be read: No closing quotation"),
    ({"content": "long" * 300000}, "has a header of more than 1,048,576 bytes, which is all that is allowed; is it"),
    ({"content": "a\nsizes: 3 4 5"}, "line 8 of its header, 'sizes: 3 4 5', cannot be read: Duplicate header field"),
    ({"content": "a\nnonsense"}, "line 8 of its header, 'nonsense', cannot be read: it is not of the form field"),
])
def test_damaged_nrrd(tmp_path: Path, fields: dict[str, str | None], message: str) -> None:
    """Every field that contradicts the file, the other fields or the format is named."""
    path = write_nrrd(tmp_path / "bad.nrrd", np.arange(60, dtype="<f4").tobytes(), **fields)
    assert refusal(path).startswith(message)


def test_no_nrrd_at_all(tmp_path: Path) -> None:
    """Files that begin like something else."""
    path = tmp_path / "bad.nrrd"
    path.touch()
    assert refusal(path) == "is empty"
    for start in (b"PNG", b"NRRD0009\n", b"NRRDx\n", bytes(1000), bytes(2**21), b"\xff" * 50):
        path.write_bytes(start)
        refusal(path)


def test_random_damage_never_escapes(tmp_path: Path) -> None:
    """Whatever bytes are changed, there is a volume or a VolumeError."""
    random = np.random.default_rng(8)
    fields = {"encoding": "gzip", "spacings": [1.0, 2.0, 3.0]}
    nrrd.write(str(tmp_path / "good.nrrd"), samples((3, 4, 5), "<f4"), fields)
    np.save(tmp_path / "good.npy", samples((3, 4, 5), "<f4"))
    for good in (tmp_path / "good.nrrd", tmp_path / "good.npy"):
        whole = good.read_bytes()
        for _ in range(300):
            damaged = bytearray(whole)
            for place in random.integers(0, len(whole), random.integers(1, 6)):
                damaged[place] = random.integers(0, 256)
            bad = good.with_stem("bad")
            bad.write_bytes(damaged[:random.integers(0, len(whole) + 1)] if random.random() < 0.2 else damaged)
            try:
                assert read_volume(bad).values.size <= 2**27
            except VolumeError as error:
                assert "\n" not in str(error)


@pytest.mark.parametrize("packed", ["gzip", "bzip2"])
def test_a_bomb_is_not_unpacked(tmp_path: Path, packed: str) -> None:
    """A little file that would unpack to far more than its header says is left packed."""
    zeros = bytes(2**26)
    data = gzip.compress(zeros) if packed == "gzip" else bz2.compress(zeros)
    path = write_nrrd(tmp_path / "bomb.nrrd", data, encoding=packed)
    tracemalloc.start()
    message = refusal(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert message.startswith("holds more than the 240 bytes that 3 × 4 × 5 float32 samples need; ")
    assert peak < 8e6


@pytest.mark.parametrize("packed", ["gzip", "bzip2"])
def test_cut_off_nrrd(tmp_path: Path, packed: str) -> None:
    """Packed samples that end too early, at any byte."""
    nrrd.write(str(tmp_path / "good.nrrd"), samples((3, 4, 5), "<f4"), {"encoding": packed})
    whole = (tmp_path / "good.nrrd").read_bytes()
    for missing in range(1, len(whole) - whole.index(b"\n\n") - 2, 7):
        (tmp_path / "bad.nrrd").write_bytes(whole[:-missing - 5])
        refusal(tmp_path / "bad.nrrd")


def test_text_that_is_no_number(tmp_path: Path) -> None:
    """The word is quoted; a number too many or too few is told."""
    numbers = b" ".join(b"%d" % number for number in range(60))
    for data, message in [
        (numbers.replace(b"33", b"thirty"), "has thirty among its samples; numbers are needed"),
        (b"7" * 2**18, "has 7777777777"), (numbers + b"\n60", "holds more than the 480 bytes"),
        (numbers[:-3], "is cut off: it holds 472 of the 480 bytes that 3 × 4 × 5 float64 samples need"),
        (b"", "is cut off: it holds 0 of the 480 bytes"), (b"\xff\x00 " * 60, "has ?? among its samples; "),
    ]:
        path = write_nrrd(tmp_path / "bad.nrrd", data, encoding="ascii")
        assert refusal(path).startswith(message)


@pytest.mark.parametrize("name", [
    "../away/field.raw", "https://example.org/field.raw", "file:///etc/passwd", "/etc/passwd", "link.raw",
    "LIST", "slice%03d.raw 1 9 1", "missing.raw", "folder", "a" * 999, "x\0y",
])
def test_samples_elsewhere(tmp_path: Path, name: str) -> None:
    """A header reads only files in its folder or below."""
    for folder in ("away", "here/folder"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / "away/field.raw").write_bytes(bytes(240))
    (tmp_path / "here/link.raw").symlink_to(tmp_path / "away/field.raw")
    message = refusal(write_nrrd(tmp_path / "here/field.nhdr", data_file=name))
    assert message.startswith("has its samples in ") and re.search("allowed|is not a file in", message)


def test_samples_beside_and_below(tmp_path: Path) -> None:
    """A header finds its samples relative to itself, and needs them."""
    data = np.arange(60, dtype="<f4")
    (tmp_path / "below").mkdir()
    for name in ("field.raw", "below/field.raw", "./below/../field.raw", str(tmp_path / "field.raw")):
        (tmp_path / name).write_bytes(data.tobytes())
        for field in ("data_file", "datafile"):
            path = write_nrrd(tmp_path / "field.nhdr", **{field: name})
            assert np.array_equal(read_volume(path).values, data.reshape(5, 4, 3).T)
    assert refusal(write_nrrd(tmp_path / "field.nhdr")) == "names no data file; a .nhdr header needs one"
    shutil.rmtree(tmp_path / "below")
    path = write_nrrd(tmp_path / "field.nhdr", data_file="below/field.raw")
    assert refusal(path) == f"has its samples in below/field.raw, which is not a file in {tmp_path}"
