"""Images of a glTF file: PNG and JPEG, as the format has them, and WebP."""

from __future__ import annotations

import io
import warnings

import numpy as np
from numpy.typing import NDArray

MOST_PIXELS = 2**26             # of all images of a model: 8192 x 8192
FORMATS = ("PNG", "JPEG", "WEBP")

Pixels = NDArray[np.uint8]


class ImageError(Exception):
    """An image that cannot be shown, and why."""


def decoded(data: memoryview, most_pixels: int) -> Pixels:
    """The pixels of an image, (height, width, 4), sRGB and alpha, the top row first.

    Raises ImageError for what is damaged or of another format, and, before any pixel of it is unpacked, for
    an image of more than ``most_pixels``.
    """
    from PIL import Image

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")                 # Pillow's own, for images that are refused here
        try:
            with Image.open(io.BytesIO(data), formats=FORMATS) as image:
                if image.width * image.height > most_pixels:
                    raise ImageError(f"it has {image.width} x {image.height} pixels; "
                                     f"at most {most_pixels:,} are left of {MOST_PIXELS:,} for all images")
                return np.array(image.convert("RGBA"), np.uint8)
        except ImageError:
            raise
        except Image.DecompressionBombError:
            raise ImageError(f"it has far too many pixels; {MOST_PIXELS:,} are allowed for all images") from None
        except Exception as error:                      # decoders raise whatever their parsing runs into
            raise ImageError("it is damaged, or not PNG, JPEG or WebP") from error
