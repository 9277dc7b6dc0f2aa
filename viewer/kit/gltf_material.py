"""Materials of a glTF file: how its surfaces look, as far as base colour, metal and roughness go."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from viewer.kit.gltf_container import Container
from viewer.kit.gltf_document import Entry, ModelFileError
from viewer.kit.gltf_image import MOST_PIXELS, ImageError, Pixels, decoded
from viewer.kit.mesh_file import FARTHEST

TEXTURE_TRANSFORM = "KHR_texture_transform"
MOST_TEXCOORD_SETS = 16


@dataclass(frozen=True, eq=False)
class Look:
    """What a material says, and where on its texture a place is: ``texcoord_set`` turned by ``placing`` (2, 3)."""

    color: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0)
    texture: Pixels | None = None
    metallic: float = 1.0
    roughness: float = 1.0
    double_sided: bool = False
    texcoord_set: int = 0
    placing: NDArray[np.float64] | None = None


class Looks:
    """The materials of an opened file, each read once; ``notes`` says which of their images could not be."""

    def __init__(self, container: Container) -> None:
        self.notes: list[str] = []
        self._container = container
        self._looks: dict[int | None, Look] = {None: Look()}
        self._images: dict[int, Pixels | None] = {}
        self._pixels = 0

    def look(self, number: int | None) -> Look:
        """The material with a number; what the format gives to a surface without one."""
        if number not in self._looks:
            assert number is not None
            self._looks[number] = self._read(self._container.document.entry("materials", number))
        return self._looks[number]

    def _read(self, material: Entry) -> Look:
        surface = material.child("pbrMetallicRoughness")
        given = surface.numbers("baseColorFactor", 4)
        red, green, blue, alpha = np.ones(4) if given is None else np.clip(given, 0.0, 1.0)
        texture = surface.child("baseColorTexture")
        shown = self._texture(texture) if "baseColorTexture" in surface.values else None
        placing = texture.child("extensions").child(TEXTURE_TRANSFORM)
        texcoord_set = texture.whole("texCoord", 0, MOST_TEXCOORD_SETS, default=0)
        return Look((float(red), float(green), float(blue), float(alpha)), shown, _share(surface, "metallicFactor"),
                    _share(surface, "roughnessFactor"), material.flag("doubleSided"),
                    placing.whole("texCoord", 0, MOST_TEXCOORD_SETS, default=texcoord_set),
                    _placing(placing) if placing.values else None)

    def _texture(self, texture: Entry) -> Pixels | None:
        number = texture.needed_index("index", "textures")
        entry = self._container.document.entry("textures", number)
        image = entry.index("source", "images")
        if image is None:
            self.notes.append(f"{entry.place} has no image that can be shown.")
            return None
        if image not in self._images:
            self._images[image] = self._image(image)
        return self._images[image]

    def _image(self, number: int) -> Pixels | None:
        document = self._container.document
        try:
            pixels = decoded(self._container.image(number), MOST_PIXELS - self._pixels)
        except (ImageError, ModelFileError, OSError) as error:
            reason = str(error).removeprefix(f"model {document.path}: ")
            self.notes.append(f"{document.entry('images', number).place} is left out: {reason}.")
            return None
        self._pixels += pixels.shape[0] * pixels.shape[1]
        return pixels


def _share(surface: Entry, name: str) -> float:
    return min(max(surface.number(name, 1.0), 0.0), 1.0)


def _placing(transform: Entry) -> NDArray[np.float64]:
    """The matrix (2, 3) of KHR_texture_transform: scaled, then turned, then moved."""
    offset, scale = transform.numbers("offset", 2), transform.numbers("scale", 2)
    angle = transform.number("rotation", 0.0)
    sine, cosine = np.sin(angle), np.cos(angle)
    turn = np.array([[cosine, sine], [-sine, cosine]]) * (np.ones(2) if scale is None else scale)
    return np.clip(np.column_stack([turn, np.zeros(2) if offset is None else offset]), -FARTHEST, FARTHEST)
