"""The blackboard on which one cell of marching squares is worked out: what is written and drawn where.

Places are in the picture, (across, up), each -1 to 1; sizes in standard letter heights.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from viewer.kit.card import INK, NARROW, QUIET, WARNING, Line, Place, Rectangle, covers, written
from viewer.kit.marching_squares import SADDLES
from viewer.kit.square_cell import CORNERS, SquareCell

MARGIN = 0.13                   # room around a drawn cell, in cells


@dataclass(frozen=True)
class Drawing:
    """The cell itself, drawn into ``rectangle`` with ``segments`` (n, 2, 2), darker with more ``emphasis``."""

    rectangle: Rectangle
    segments: NDArray[np.float32]
    emphasis: float

    @property
    def two_segments(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """From x, y to x, y, twice; zero where there are fewer."""
        first, second = np.concatenate([self.segments.reshape(-1, 4), np.zeros((2, 4))])[:2].tolist()
        return tuple(first), tuple(second)


@dataclass(frozen=True)
class Card:
    """Where the card lies, the cell drawn on it once or more, and its text."""

    rectangle: Rectangle
    drawings: tuple[Drawing, ...]
    lines: tuple[Line, ...]

    def covers(self, place: Place) -> bool:
        """Whether a place in the picture lies on the card."""
        return covers(self.rectangle, place)


def room_for_card(aspect: float) -> Place:
    """Where the middle of everything else goes to make room for a card."""
    return (0.0, 0.4) if aspect < NARROW else (-0.385, 0.0)


def card(cell: SquareCell, title: str, saddle: str, no_curve: str, aspect: float) -> Card:
    """The card for a cell; ``no_curve`` says why it yields nothing, where that is so."""
    return _Layout(cell, aspect).card(title, saddle, no_curve)


class _Layout:
    """Turns fractions of a full card, from its upper left corner, into places in the picture.

    Beside the board a card is as long as what stands on it; below the board it has two columns.
    """

    def __init__(self, cell: SquareCell, aspect: float) -> None:
        self.cell, self.aspect = cell, aspect
        self.narrow = aspect < NARROW
        self.full: Rectangle = (-0.97, -0.97, 0.97, -0.19) if self.narrow else (0.235, -0.94, 0.982, 0.94)
        self.letter = min(1.0, 1.15 * aspect)      # narrow pictures have less room across for the same height
        self.lines: list[Line] = []

    def card(self, title: str, saddle: str, no_curve: str) -> Card:
        cell, taken = self.cell, self.cell.answer(saddle)
        self.write(title, 0.05, self.at(0.055, 0.08), size=1.0, bold=True)
        drawings = []
        if cell.has_values:
            drawings.append(self.drawing(*self.main_square(), taken))
            self.write(f"case {cell.case} = {cell.case:04b} binary", 0.95, self.at(0.055, 0.08), size=0.85,
                       align=(1.0, 0.5))
            self.corner_values()
        end = self.reason(no_curve) if no_curve else self.table()
        if cell.ambiguous and not no_curve:
            drawings += self.both_answers(saddle, taken)
            end = 1.0
        bottom = self.full[1] if self.narrow else self.place(0.0, end)[1]
        return Card((self.full[0], bottom, *self.full[2:]), tuple(drawings), tuple(self.lines))

    def at(self, wide: float, narrow: float) -> float:
        return narrow if self.narrow else wide

    def place(self, right: float, down: float) -> Place:
        left, bottom, farthest, top = self.full
        return left + right * (farthest - left), top - down * (top - bottom)

    def write(self, text: str, right: float, down: float, *, size: float = 0.72, align: Place = (0.0, 0.5),
              color: str = INK, bold: bool = False) -> None:
        self.lines.append(Line(text, self.place(right, down), size * self.letter, align, color, bold))

    def main_square(self) -> tuple[float, float, float]:
        """The middle of the large drawing in the card, and its side in heights of the picture."""
        if self.narrow:
            return 0.205, 0.57, min(0.21, 0.21 * self.aspect)
        return 0.5, 0.33, min(0.31, 0.23 * self.aspect)

    def drawing(self, right: float, down: float, side: float, answer: str, emphasis: float = 1.0) -> Drawing:
        x, y = self.place(right, down)
        up = side * (1.0 + 2.0 * MARGIN)
        across = up / self.aspect
        return Drawing((x - across, y - up, x + across, y + up), self.cell.segments(answer), emphasis)

    def corner_values(self) -> None:
        """Each corner's value above or below it."""
        right, down, side = self.main_square()
        x, y = self.place(right, down)
        for (across, up), value in zip(CORNERS, self.cell.values, strict=True):
            away = (2.0 * up - 1.0) * (side * (1.0 + 2.0 * MARGIN) + 0.022)
            place = (x + (2.0 * across - 1.0) * side / self.aspect, y + away)
            self.lines.append(Line(written(value), place, 0.72 * self.letter, (0.5, 0.5), bold=True))

    def reason(self, no_curve: str) -> float:
        """Why the cell yields nothing; returns where that ends."""
        down = self.at(0.60 if self.cell.has_values else 0.12, 0.25)
        self.write(no_curve, self.at(0.05, 0.468), down, color=WARNING, bold=True)
        return down + 0.06

    def table(self) -> float:
        """The crossed edges, with A, B and t worked out; returns where they end."""
        columns = [self.at(x, 0.44 + 0.56 * x) for x in (0.05, 0.23, 0.43, 0.64)]
        top, step = self.at(0.60, 0.25), self.at(0.044, 0.095)
        if not self.cell.crossings:
            side = "below" if self.cell.case else "at or above"
            self.write(f"All corners {side} the level: no curve.", columns[0], top, color=QUIET)
            return top + 0.06
        for column, word in zip(columns, ("edge", "A", "B", "t = A / (A − B)"), strict=True):
            self.write(word, column, top, color=QUIET)
        for row, crossing in enumerate(self.cell.crossings, 1):
            words = (crossing.name, written(crossing.A), written(crossing.B), f"{crossing.t:.3f}")
            for column, word in zip(columns, words, strict=True):
                self.write(word, column, top + row * step, bold=column == columns[3])
        return top + len(self.cell.crossings) * step + 0.05

    def both_answers(self, saddle: str, taken: str) -> list[Drawing]:
        """The two ways to join the crossings, and what decides between them."""
        because = f"saddle value {written(self.cell.saddle_value)}" if saddle == "decider" else "as you chose"
        self.write(f"Ambiguous: {because}, so {taken}.", self.at(0.05, 0.468), self.at(0.825, 0.75), color=WARNING,
                   bold=True)
        side = self.at(min(0.08, 0.06 * self.aspect), 0.05 * min(1.0, self.aspect))
        made = []
        for answer, right in zip(SADDLES, (0.16, 0.64) if not self.narrow else (0.52, 0.77), strict=False):
            down, chosen = self.at(0.915, 0.88), answer == taken
            made.append(self.drawing(right, down, side, answer, 1.0 if chosen else 0.45))
            beside = right + side * (1.0 + 2.0 * MARGIN) / self.aspect / (self.full[2] - self.full[0]) + 0.015
            self.write(answer, beside, down, bold=chosen, color=INK if chosen else QUIET)
        return made
