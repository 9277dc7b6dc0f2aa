"""Cards in the picture on which cells are explained: the one under the microscope, and the sheet of all cases."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from viewer.kit import cell_words
from viewer.kit.card import INK, NARROW, QUIET, WARNING, Line, Place, Rectangle, covers
from viewer.kit.cell_model import case_triangles, microscope_model, sheet_frames, sheet_model, side_color
from viewer.kit.marching_cases import CORNERS
from viewer.kit.marching_cell import Cell, Crossing, edge_name, examine
from viewer.kit.models import Frame, Model, Rgb, in_picture, rgb

PAPER = "#f2f1edb8"             # behind words that may stand over the cell itself
ONE_COLUMN = 12                 # more lines than these stand in two columns
LINE_STEP = 0.0735              # from line to line at letter size 1, in half heights of the picture


@dataclass(frozen=True)
class Look:
    """How the picture is seen: the camera's rotation, the picture's aspect, and the surface's colour."""

    view: NDArray[np.float64]
    aspect: float
    surface: Rgb
    tetrahedra: bool

    @property
    def key(self) -> tuple[object, ...]:
        """All of it, to be compared."""
        return self.view.tobytes(), self.aspect, self.surface, self.tetrahedra

    @property
    def method(self) -> str:
        """``cubes`` or ``tetrahedra``."""
        return "tetrahedra" if self.tetrahedra else "cubes"


@dataclass(frozen=True)
class Room:
    """Where on a card there is room for text, in the picture's units; ``letters`` is their size."""

    start: Place
    width: float
    height: float
    letters: float
    narrow: bool


@dataclass(frozen=True)
class CellCard:
    """Where a card lies, the model on it and its text; ``frames`` tells where on a sheet each case is."""

    rectangle: Rectangle
    model: Model
    lines: tuple[Line, ...]
    frames: Mapping[int, Frame] | None = None

    def covers(self, place: Place) -> bool:
        """Whether a place in the picture lies on the card."""
        return covers(self.rectangle, place)


def room_for_card(aspect: float) -> Place:
    """Where the middle of everything else goes to make room for the microscope."""
    return (0.0, 0.45) if aspect < NARROW else (-0.46, 0.0)


def microscope_card(cell: Cell, name: str, look: Look) -> CellCard:
    """The cell with everything that is worked out about it."""
    narrow = look.aspect < NARROW
    rectangle = (-0.97, -0.97, 0.97, -0.06) if narrow else (0.11, -0.955, 0.982, 0.955)
    left, bottom, right, top = rectangle
    frame = ((left + right) / 2.0, 0.21, min(0.56, 0.43 * look.aspect))
    if narrow:
        frame = (-0.5, -0.60, min(0.38, 0.42 * look.aspect))
    letters = min(1.0, 0.72 * look.aspect if not narrow else 1.1 * look.aspect)
    head = list(_headline(cell, name, (left + 0.03, top - 0.065), letters))
    start = (0.02, -0.27) if narrow else (left + 0.03, -0.35)
    room = Room(start, right - start[0], start[1] - bottom - 0.03, letters, narrow)
    text = [] if cell.torn else list(_working(cell, room))
    model = microscope_model(cell, frame, look.surface, look.tetrahedra)
    return CellCard(rectangle, model, (*head, *_corner_labels(cell, frame, look, letters), *text))


def sheet_card(look: Look, counts: Mapping[int, int], chosen: int) -> CellCard:
    """All 256 cases, those the surface has in colour; the chosen one again at the side, larger."""
    aside = chosen >= 0 and look.aspect >= NARROW
    rectangle = (-0.985, -0.97, 0.985, 0.97)
    frames = sheet_frames(look.aspect, -0.965, 0.44 if aside else 0.965, -0.95, 0.83)
    present = {case for case, count in counts.items() if count}
    model = sheet_model(frames, look.method, present, look.surface)
    if chosen >= 0:
        model.box([-0.1] * 3, [1.1] * 3, 0.05, rgb(INK), frames[chosen])
    title = f"{look.method.capitalize()}: 256 cases, {len(present)} of them in this surface"
    if chosen >= 0 and not aside:       # no room but in the title
        title = f"Case {chosen} = {chosen:08b}: {counts.get(chosen, 0)} cells of this surface"
    lines = [Line(title, (-0.955, 0.905), 0.95 * min(1.0, 1.1 * look.aspect), bold=True)]
    lines += [Line(str(case), (frame[0] - 0.62 * frame[2] / look.aspect, frame[1] + 0.92 * frame[2]), 0.5, (0.0, 0.5),
                   INK if counts.get(case) else QUIET) for case, frame in frames.items()]
    if aside:
        lines += _chosen_case(model, look, chosen, counts.get(chosen, 0))
    return CellCard(rectangle, model, tuple(lines), frames)


def case_at(card: CellCard, place: Place, aspect: float) -> int | None:
    """The case of a sheet that a place in the picture belongs to."""
    if not card.frames:
        return None
    offsets = {case: max(abs(place[0] - frame[0]) * aspect, abs(place[1] - frame[1])) / frame[2]
               for case, frame in card.frames.items()}
    nearest = min(offsets, key=lambda case: offsets[case])
    return nearest if offsets[nearest] < 1.2 else None


def _headline(cell: Cell, name: str, place: Place, letters: float) -> Iterator[Line]:
    title, what = cell_words.headline(cell, name).split("\n")
    yield Line(title, place, 1.1 * letters, bold=True)
    yield Line(what, (place[0], place[1] - 1.15 * LINE_STEP * letters), 0.85 * letters)


def _corner_labels(cell: Cell, frame: Frame, look: Look, letters: float) -> Iterator[Line]:
    """Each corner's number and value, written just outside of the cell."""
    outwards = 0.5 + 1.2 * (CORNERS - 0.5)
    for corner, place in enumerate(in_picture(outwards, frame, look.view, look.aspect)):
        value = cell.values[corner]
        written = cell_words.signed(value) if np.isfinite(value) else "no value"
        color = side_color(value)
        at = float(place[0]), float(place[1])
        yield Line(f"{corner}:  {written}", at, 0.72 * letters, (0.5, 0.5), color, bold=True, plate=PAPER)


def _working(cell: Cell, room: Room) -> Iterator[Line]:
    """Each crossing worked out, in two columns, and then what is ambiguous."""
    if not cell.crossings:
        return
    start, column = room.start, room.width / 2.0
    columns = 1 if len(cell.crossings) + len(cell.ambiguous) <= ONE_COLUMN else 2
    rows, faces = -(-len(cell.crossings) // columns), list(cell_words.face_lines(cell))
    beside = 1 if len(faces) <= 3 or room.narrow else 2
    step = min(LINE_STEP * room.letters, room.height / (rows + -(-len(faces) // beside) + 1.5))
    size = 0.92 * step / LINE_STEP
    tables = [cell.crossings[first:first + rows] for first in range(0, len(cell.crossings), rows)]
    for index, crossings in enumerate(tables):
        corner = (start[0] + index * column, start[1])
        yield from _table(crossings, corner, 1.9 * column / columns, step, size, brief=columns > 1,
                          digits=2 if room.narrow else 3)
    for index, line in enumerate(faces):
        down, across = divmod(index, beside)
        place = (start[0] + across * column, start[1] - (rows + 1.4 + down) * step)
        yield Line(line, place, size, color=WARNING, bold=True)


def _table(crossings: tuple[Crossing, ...], corner: Place, width: float, step: float, size: float, *,
           brief: bool, digits: int) -> Iterator[Line]:
    """Edges and how far along each the surface crosses; not ``brief``, with the values that say so."""
    heads = ("edge", "t") if brief else ("edge", "A", "B", "t = A / (A \u2212 B)")
    places = (0.0, 0.4) if brief else (0.0, 0.2, 0.42, 0.64)
    rows: list[tuple[str, ...]] = [
        (edge_name(each.edge), cell_words.signed(each.A, digits), cell_words.signed(each.B, digits), f"{each.t:.3f}")
        for each in crossings]
    if brief:
        rows = [(row[0], row[-1]) for row in rows]
    for down, row in enumerate([heads, *rows]):
        for place, word in zip(places, row, strict=True):
            at = (corner[0] + place * width, corner[1] - (down + 0.15 * (down > 0)) * step)
            yield Line(word, at, size, color=INK if down else QUIET, bold=down > 0 and place == places[-1])


def _chosen_case(model: Model, look: Look, case: int, count: int) -> list[Line]:
    """Draw a case at the side of the sheet, and say what there is to say of it."""
    values = np.array([-1.0 if case >> corner & 1 else 1.0 for corner in range(8)])
    cell, frame = examine(values, look.method), (0.715, 0.22, min(0.5, 0.2 * look.aspect))
    large = microscope_model(cell, frame, look.surface, look.tetrahedra, case_triangles(look.method, case))
    model.extend(large)
    colors = [side_color(value) for value in values]
    numbers = [Line(str(corner), (float(x), float(y)), 0.72, (0.5, 0.5), colors[corner], True)
               for corner, (x, y) in enumerate(in_picture(0.5 + 1.22 * (CORNERS - 0.5), frame, look.view, look.aspect))]
    ambiguous = len(cell.ambiguous)
    words = [f"Case {case}", f"{cell.binary} in binary, corner 7 first", f"triangles: {len(cell.triangles)}",
             f"ambiguous faces: {ambiguous}", f"cells of this surface: {count}"]
    return numbers + [Line(text, (0.48, -0.32 - 0.085 * index), 1.0 if index == 0 else 0.78, bold=index == 0)
                      for index, text in enumerate(words)]
