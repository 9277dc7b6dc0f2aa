"""Pictures on disk: which frames, their files, and how fast it went."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from viewer.engine.clock import LAST_FRAME
from viewer.engine.fields import ParameterError
from viewer.engine.stage import Stage
from viewer.whole_file import whole_file

Pixels = NDArray[np.uint8]
MOST_FRAMES = 1_000_000
FRAMES_WORTH_A_BAR = 10


def parse_frames(text: str) -> list[int]:
    """The frames that ``0,30,60``, ``0:120`` (the end left out) or ``0:120:4`` mean, in rising order.

    Raises ParameterError for anything else.
    """
    frames: set[int] = set()
    for piece in text.split(","):
        try:
            ends = [int(part) for part in piece.split(":", 2)]
            chosen: Sequence[int] = ends if len(ends) == 1 else range(*ends)
            if not 0 < len(chosen) <= MOST_FRAMES or not all(0 <= end <= LAST_FRAME for end in (chosen[0], chosen[-1])):
                raise ValueError
        except (ValueError, OverflowError):
            raise ParameterError(f"frames = {text[:60]} is not a list such as 0,30,60 or a range such as "
                                 f"0:120 or 0:120:4") from None
        frames.update(chosen)
    return sorted(frames)


def write_png(pixels: Pixels, path: Path) -> None:
    """Write a picture, whole or not at all; raises OutputError."""
    with whole_file(path) as temporary:
        Image.fromarray(pixels).save(temporary, compress_level=4)


def capture(stage: Stage, frames: Sequence[int], folder: Path,
            pixels: Callable[[], Pixels] | None = None) -> list[Path]:
    """Write ``folder/SCENE-000030.png`` for each of ``frames``; returns the files.

    ``pixels`` gives a frame's picture; by default the stage's own. Long captures show a progress bar.
    """
    take = pixels or stage.pixels
    files = []
    for frame in _with_progress(frames, stage.entry.name):
        stage.seek(frame)
        files.append(folder / f"{stage.entry.name}-{frame:06d}.png")
        write_png(take(), files[-1])
    return files


def capture_timed(stage: Stage, frames: Sequence[int], folder: Path,
                  pixels: Callable[[], Pixels] | None = None) -> str:
    """Like ``capture``; returns what to tell the user: each file, or for many the folder and the speed."""
    start = time.perf_counter()
    files = capture(stage, frames, folder, pixels)
    seconds = max(time.perf_counter() - start, 1e-9)
    if len(files) < FRAMES_WORTH_A_BAR:
        return "\n".join(map(str, files))
    width, height = stage.size
    return (f"{len(files)} pictures of {width}x{height}, {files[0]} to {files[-1].name}, "
            f"in {seconds:.1f} s ({len(files) / seconds:.1f} frames/s)")


def _with_progress(frames: Sequence[int], name: str) -> Iterable[int]:
    if len(frames) < FRAMES_WORTH_A_BAR:
        return frames
    from tqdm import tqdm

    interval = 0.2 if sys.stderr.isatty() else 10.0
    bar: Iterable[int] = tqdm(frames, desc=name, unit=" frames", mininterval=interval, file=sys.stderr)
    return bar
