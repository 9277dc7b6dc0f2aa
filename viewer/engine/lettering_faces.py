"""Typefaces: which has a character, what stands in for one that none has, and letters as pixels.

The fonts are those of the panels, which come with imgui-bundle; should they be missing, the one inside Pillow.
Neither library is imported before there is something to letter.
"""

from __future__ import annotations

import io
import unicodedata
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from viewer.errors import DemoscopeError

if TYPE_CHECKING:
    from PIL.ImageFont import FreeTypeFont

# The face that has the letters, for each weight; then those with arrows, what mathematics needs, and indices.
LETTERS = {False: "Roboto/Roboto-Regular.ttf", True: "Roboto/Roboto-Bold.ttf"}
SIGNS = ("latex/latinmodern-math.otf", "Inconsolata-Medium.ttf")
THIN = {"latex/latinmodern-math.otf": 1.5}    # how much darker a thin face has to be, to suit the letters
STAND_INS = {
    "−": "-", "–": "-", "—": "-", "‐": "-", "‑": "-", "×": "x", "⋅": "·", "∗": "*", "•": "*", "÷": "/", "⁄": "/",
    "→": "->", "←": "<-", "↔": "<->", "⇒": "=>", "≥": ">=", "≤": "<=", "≠": "!=", "≈": "~", "∼": "~", "∞": "inf",
    "√": "sqrt", "∇": "grad", "∂": "d", "∑": "sum", "∏": "product", "∫": "integral", "∈": "in", "∥": "||", "‖": "||",
    "⟨": "<", "⟩": ">", "′": "'", "″": '"', "‘": "'", "’": "'", "“": '"', "”": '"', "µ": "u", "ß": "ss",
}
PROBE_EM = 24
NOWHERE = "\U0010fffe"          # no font has it, so it shows what a font draws for a character that it lacks


class Raster(NamedTuple):
    """A character in pixels: coverage 0 to 255, bottom row first, and where from the pen on the baseline it lies."""

    coverage: NDArray[np.uint8]
    left: int
    bottom: int
    advance: int


class Face:
    """One typeface, at any size; ``embolden`` thickens one that has no bold cut, ``darker`` strengthens a thin one."""

    def __init__(self, file: bytes | None, embolden: bool, darker: float = 1.0) -> None:
        self.file = file
        self.embolden = embolden
        self.darker = darker
        self._missing = self.raster(NOWHERE, PROBE_EM).coverage
        self._known: dict[str, bool] = {}

    def has(self, character: str) -> bool:
        """Whether the face draws ``character``, rather than a box or nothing."""
        if character not in self._known:
            coverage = self.raster(character, PROBE_EM).coverage
            self._known[character] = bool(coverage.size) and not np.array_equal(coverage, self._missing)
        return self._known[character]

    def raster(self, character: str, em: int) -> Raster:
        """``character`` with an em of that many pixels, standing on whole ones."""
        from PIL import Image, ImageDraw

        font = _font(self.file, em)
        advance = round(font.getlength(character))
        left, top, right, bottom = (round(edge) for edge in font.getbbox(character, anchor="ls"))
        image = Image.new("L", (max(1, right - left), max(1, bottom - top)))
        ImageDraw.Draw(image).text((-left, -top), character, fill=255, font=font, anchor="ls")
        coverage = np.minimum(np.asarray(image) * self.darker, 255.0).astype(np.uint8)
        if self.embolden:
            stroke = max(1, round(em / 24))
            coverage, advance = _thickened(coverage, stroke), advance + stroke
        return _trimmed(coverage, left, bottom, advance)


class Faces:
    """The typefaces of one weight, tried in turn."""

    def __init__(self, bold: bool) -> None:
        folder = font_folder()
        names = (LETTERS[bold], *SIGNS) if folder else ()
        files = {name: Path(folder or "", name) for name in names}
        self.faces = [Face(file.read_bytes(), bold and name in SIGNS, THIN.get(name, 1.0))
                      for name, file in files.items() if file.is_file()]
        self.faces.append(Face(None, bold))
        self._spelled: dict[str, tuple[tuple[Face, str], ...]] = {}

    def spelled(self, character: str) -> tuple[tuple[Face, str], ...]:
        """The faces and characters that show ``character``: itself, what stands in for it, or a question mark."""
        if character not in self._spelled:
            self._spelled[character] = tuple((self._home(one), one) for one in self._shown(character))
        return self._spelled[character]

    def _shown(self, character: str) -> str:
        if character.isspace():
            return " "
        if unicodedata.category(character) in ("Cc", "Cf"):
            return ""
        if self._has(character):
            return character
        return "".join(one if self._has(one) else STAND_INS.get(one, "?") for one in stand_in(character))

    def _has(self, character: str) -> bool:
        return unicodedata.category(character) != "Cs" and any(face.has(character) for face in self.faces)

    def _home(self, character: str) -> Face:
        return next((face for face in self.faces if face.has(character)), self.faces[0])


def stand_in(character: str) -> str:
    """Simpler characters that say the same: a table's, a letter without its accent, a Greek letter's name."""
    if character in STAND_INS:
        return STAND_INS[character]
    apart = unicodedata.decomposition(character)
    simple = "".join(one for one in unicodedata.normalize("NFKD", character) if not unicodedata.combining(one))
    if simple not in ("", character):
        return {"<super>": "^", "<sub>": "_"}.get(apart.split()[0], "") + simple
    name = unicodedata.name(character, "").split()
    if name[:1] == ["GREEK"]:
        return name[-1].capitalize() if "CAPITAL" in name else name[-1].lower()
    return "?"


def font_folder() -> Path | None:
    """Where imgui-bundle keeps its fonts, found without importing it."""
    spec = find_spec("imgui_bundle")
    places = spec.submodule_search_locations if spec else None
    return Path(places[0]) / "assets" / "fonts" if places else None


@lru_cache(maxsize=64)
def _font(file: bytes | None, em: int) -> FreeTypeFont:
    """A font at a size, always with Pillow's own layout: the other is not there on every system."""
    try:
        from PIL import ImageFont

        if file is None:
            return ImageFont.load_default(em)  # type: ignore[return-value]
        return ImageFont.truetype(io.BytesIO(file), em, layout_engine=ImageFont.Layout.BASIC)
    except (ImportError, OSError) as error:
        raise DemoscopeError(f"labels need Pillow with FreeType: {error}") from error


def _thickened(coverage: NDArray[np.uint8], stroke: int) -> NDArray[np.uint8]:
    """Strokes wider by that many pixels."""
    width = coverage.shape[1]
    thick = np.zeros((len(coverage), width + stroke), np.uint8)
    for step in range(stroke + 1):
        np.maximum(thick[:, step:step + width], coverage, out=thick[:, step:step + width])
    return thick


def _trimmed(coverage: NDArray[np.uint8], left: int, bottom: int, advance: int) -> Raster:
    """``coverage``, its top row first and ``bottom`` measured downwards, without its empty rim."""
    rows, columns = np.flatnonzero(coverage.any(1)), np.flatnonzero(coverage.any(0))
    if not rows.size:
        return Raster(np.zeros((0, 0), np.uint8), 0, 0, advance)
    inked = coverage[rows[0]:rows[-1] + 1, columns[0]:columns[-1] + 1]
    return Raster(inked[::-1], left + int(columns[0]), int(len(coverage) - 1 - rows[-1]) - bottom, advance)
