"""A scene's table, ready to draw: every cell a text, every column as wide as it needs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from viewer.engine.annotations import Cell, Table
from viewer.ui.number_text import number_text

MOST_ROWS = 1000
LONGEST_CELLS = 8       # of which one is the widest of its column


@dataclass(frozen=True)
class Column:
    """A heading over cells; ``numbers`` says which of them are numbers, to stand at the right."""

    title: str
    cells: list[str]
    numbers: list[bool]
    longest: list[str]

    @property
    def is_numbers(self) -> bool:
        """Whether there are no words in it."""
        return all(self.numbers)

    def needs(self, wide: Callable[[str], float]) -> float:
        """The width at which every cell fits, and each word of the heading."""
        return max(wide(text) for text in ("", *self.longest, *self.title.split()))


@dataclass(frozen=True)
class TextTable:
    """Columns under a title; ``left_out`` counts the rows beyond those that one can read."""

    title: str
    columns: list[Column]
    rows: int
    left_out: int

    def widths(self, room: float, wide: Callable[[str], float], narrowest_words: float) -> list[float]:
        """Each column's width: what it needs, more where its heading asks for it, and a share of what is left.

        Where the needs exceed ``room``, columns of words give way down to ``narrowest_words``; numbers never do.
        """
        needs = [column.needs(wide) for column in self.columns]
        spare = room - sum(needs)
        if spare < 0.0:
            return [need if column.is_numbers else min(need, max(narrowest_words, need + spare))
                    for need, column in zip(needs, self.columns, strict=True)]
        lacks = [max(0.0, wide(column.title) - need) for need, column in zip(needs, self.columns, strict=True)]
        granted = min(1.0, spare / sum(lacks)) if any(lacks) else 0.0
        left = (spare - granted * sum(lacks)) / len(needs)
        return [need + granted * lack + left for need, lack in zip(needs, lacks, strict=True)]


def text_table(name: str, table: Table) -> TextTable:
    """``table`` as texts, as many rows as one can read."""
    rows = [list(row) for row in table.rows[:MOST_ROWS]]
    columns = [_column(title, [row[index] for row in rows]) for index, title in enumerate(table.columns)]
    return TextTable(name.replace("_", " "), columns, len(rows), len(table.rows) - len(rows))


def _column(title: str, cells: Sequence[Cell]) -> Column:
    texts = [cell if isinstance(cell, str) else number_text(cell) for cell in cells]
    longest = sorted(texts, key=len)[-LONGEST_CELLS:]
    return Column(title.replace("_", " "), texts, [not isinstance(cell, str) for cell in cells], longest)
