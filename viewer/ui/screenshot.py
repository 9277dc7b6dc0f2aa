"""Pictures of the stage or of the whole window, as PNG files written whole."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from viewer.engine.stage import Stage
from viewer.errors import DemoscopeError
from viewer.ui.imgui_session import Surface
from viewer.whole_file import OutputError, whole_file

if TYPE_CHECKING:
    from viewer.ui.workbench import Workbench


def picture_pixels(stage: Stage) -> NDArray[np.uint8]:
    """The stage's picture, (height, width, 4), top row first."""
    return stage.picture.pixels()


def surface_pixels(surface: Surface) -> NDArray[np.uint8]:
    """Everything on ``surface``, (height, width, 4), top row first."""
    width, height = (round(extent * ratio) for extent, ratio in zip(surface.size, surface.pixel_ratio, strict=True))
    data = surface.target.read(viewport=(0, 0, width, height), components=4, alignment=1)
    rows = np.frombuffer(data, np.uint8).reshape(height, width, 4)
    pixels = rows[::-1].copy()
    pixels[..., 3] = 255
    return pixels


def save(bench: Workbench, pixels: NDArray[np.uint8]) -> None:
    """Write ``pixels`` into the current folder, or else among the user's pictures, and tell where."""
    assert bench.stage
    stem = f"{bench.stage.entry.name}-{bench.stage.frame:06d}"
    try:
        path = _write_somewhere(stem, pixels)
        bench.say(f"Saved {path}")
    except DemoscopeError as error:
        bench.tell(error)


def _write_somewhere(stem: str, pixels: NDArray[np.uint8]) -> Path:
    from platformdirs import user_pictures_path

    try:
        return _write(_free_name(Path.cwd(), stem), pixels)
    except (OutputError, OSError):   # a current folder that is read-only, or gone
        return _write(_free_name(user_pictures_path(), stem), pixels)


def _free_name(folder: Path, stem: str) -> Path:
    path, number = folder / f"{stem}.png", 2
    while path.exists():
        path, number = folder / f"{stem}-{number}.png", number + 1
    return path


def _write(path: Path, pixels: NDArray[np.uint8]) -> Path:
    from PIL import Image

    with whole_file(path) as temporary:
        Image.fromarray(pixels[..., :3]).save(temporary, format="PNG")
    return path
