"""Pictures on sprites: one from a file, or the noise that puffs of cloud are made of.

Each comes with smaller copies of itself, half as wide each time, averaged here and chosen by the shader, since
drivers differ in both.
"""

from __future__ import annotations

import warnings
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.fields import ParameterError
from viewer.engine.file_stamp import file_stamp
from viewer.engine.gpu import Gpu
from viewer.kit.noise import noise
from viewer.kit.srgb import linear_light

if TYPE_CHECKING:
    from PIL import Image

Texels = NDArray[np.floating[Any]]
IMAGE_SIZE = 256
LONGEST_SIDE = 4096     # of a file that is read; it is made smaller in any case
NOISE_SIZE = 256
NOISE_OCTAVES = 5
NOISE_CELLS = 4         # of the first octave, along a side


class SpriteImage:
    """The texture that the sprites now need, ``texture``; its lower levels are its smaller copies."""

    def __init__(self, gpu: Gpu, params: Any) -> None:
        self.gpu, self.params = gpu, params
        self.texture: Any = None
        self._shows: object = None

    def prepare(self) -> None:
        """Follow the parameters; raises ParameterError where the file is no picture, and keeps the last one then."""
        sprite, path = self.params.sprite, self.params.texture
        if sprite == "texture" and path is None:
            raise ParameterError("sprite = texture needs a picture: set texture")
        shows = file_stamp(path) if sprite == "texture" else sprite if sprite == "puff" else None
        if shows is None or shows == self._shows:
            return
        texels = image_texels(path) if sprite == "texture" else puff_noise()
        if self.texture is not None:
            self.gpu.discard(self.texture)
        self.texture = with_smaller_copies(self.gpu, texels, repeats=sprite == "puff")
        self._shows = shows


def with_smaller_copies(gpu: Gpu, texels: Texels, *, repeats: bool) -> Any:
    """A texture of (n, n, 4) texels, n a power of two, down to a single one."""
    size = len(texels)
    made = gpu.texture((size, size), 4, texels.astype(np.float16), dtype="f2", label="sprite's picture")
    made.build_mipmaps()
    made.filter = moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR
    made.repeat_x = made.repeat_y = repeats
    level = 0
    while size > 1:
        size, level = size // 2, level + 1
        texels = texels.reshape(size, 2, size, 2, 4).mean(axis=(1, 3))
        made.write(texels.astype(np.float16), level=level)
    return made


def image_texels(path: Path) -> Texels:
    """A picture in the middle of a square (n, n, 4), lowest row first: linear light, times its alpha, and alpha."""
    try:
        with _opened(path) as image:
            blocks = max(1, max(image.size) // (4 * IMAGE_SIZE))
            reduced = image.convert("RGBA").convert("RGBa").reduce(blocks).convert("RGBA")
            straight = np.asarray(reduced)
    except ParameterError:
        raise
    except Exception as error:
        raise ParameterError(f"texture = {path} is not a picture that can be read: {error}".splitlines()[0]) from error
    light = np.array([linear_light(level / 255.0) for level in range(256)], np.float32)[straight[..., :3]]
    alpha = straight[..., 3:].astype(np.float32) / 255.0
    return _in_a_square(np.concatenate([light * alpha, alpha], axis=-1))[::-1]


def _opened(path: Path) -> Image.Image:
    """A picture whose pixels are still to be read; raises ParameterError for one with too many of them."""
    from PIL import Image

    try:
        with warnings.catch_warnings():     # the limit here is lower than that of which Pillow warns
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            image = Image.open(path)
    except FileNotFoundError:
        raise ParameterError(f"texture = {path} is not a file that exists") from None
    except Image.DecompressionBombError:
        raise ParameterError(f"texture = {path} has more than {LONGEST_SIDE} pixels along a side") from None
    if max(image.size) > LONGEST_SIDE:
        image.close()
        raise ParameterError(f"texture = {path} is {image.width} x {image.height} pixels, which is more than "
                             f"{LONGEST_SIDE} along a side")
    return image


def _in_a_square(texels: Texels) -> Texels:
    """Scaled so that its longer side fits, each texel the mean of what it covers; nothing around it."""
    from PIL import Image

    height, width = texels.shape[:2]
    size = min(IMAGE_SIZE, 2 ** max(2, (max(width, height) - 1).bit_length()))
    scale = size / max(width, height)
    fitted = max(1, round(width * scale)), max(1, round(height * scale))
    square = np.zeros((size, size, 4), np.float32)
    left, top = (size - fitted[0]) // 2, (size - fitted[1]) // 2
    for channel in range(4):
        scaled = Image.fromarray(np.ascontiguousarray(texels[..., channel])).resize(fitted, Image.Resampling.BOX)
        square[top:top + fitted[1], left:left + fitted[0], channel] = np.asarray(scaled)
    return square


@cache
def puff_noise() -> Texels:
    """Billows (n, n, 4) without a seam: their height from 0 to 1, its slope across and up, and a wider height.

    Turbulence after Perlin, "An Image Synthesizer", SIGGRAPH 1985, each octave blended with itself moved by the
    width of the tile, so that opposite sides meet.
    """
    across = np.arange(NOISE_SIZE) / NOISE_SIZE
    x, y = np.meshgrid(across, across)
    height, wide = np.zeros_like(x), np.zeros_like(x)
    for octave in range(NOISE_OCTAVES):
        cells = NOISE_CELLS * 2 ** octave
        values = np.abs(_tiled_noise(x, y, cells, 17.3 * octave + 0.37)) / 2 ** octave
        height += values
        wide += values if octave < 2 else 0.0
    height, wide = (1.0 - each / np.quantile(each, 0.998) for each in (height, wide))
    slope = [(np.roll(height, -1, axis) - np.roll(height, 1, axis)) * (NOISE_SIZE / 2 / NOISE_CELLS / 4)
             for axis in (1, 0)]
    return np.stack([height.clip(0, 1), *slope, wide.clip(0, 1)], axis=-1)


def _tiled_noise(x: Texels, y: Texels, cells: int, layer: float) -> Texels:
    """Noise over the unit square that repeats itself; blending keeps its variance."""
    total, variance = np.zeros_like(x), np.zeros_like(x)
    for right, up in ((0, 0), (1, 0), (0, 1), (1, 1)):
        weight = (x if right else 1.0 - x) * (y if up else 1.0 - y)
        total += weight * noise((x - right) * cells + 0.5, (y - up) * cells + 0.5, layer)
        variance += weight**2
    return np.asarray(total / np.sqrt(variance))
