"""Tables of measurements: as texts, in the width of a panel, and on screen."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from viewer import Table
from viewer.ui import guard, table_view
from viewer.ui.measurer import prepared
from viewer.ui.text_table import MOST_ROWS, TextTable, text_table

if TYPE_CHECKING:
    from tests.ui.conftest import Hand

SCENE = """
from viewer import Parameters, Scene, Studio, Table, integer

class Sums(Scene):
    \"\"\"Measures tables.\"\"\"

    class Params(Parameters):
        rows: int = integer(6, 0, 5000, "How many rows")

    studio = Studio(ground=None)

    def draw(self):
        pass

    def measure(self):
        rows = [(f"step {n}", 2 * n * n, 1.0 / (n + 1) ** 2, 0.03 * n) for n in range(self.params.rows)]
        return {"mean_error_by_step": Table(("step", "triangles", "mean_error", "time_ms"), rows), "area": 2.5}
"""


@pytest.fixture
def sums(make_hand: Callable[..., Hand], pack: Path) -> Hand:
    """A bench of 1024x768 that shows a table of four columns."""
    (pack / "scenes" / "sums.py").write_text(SCENE)
    return make_hand(scene="sums")


def shown(hand: Hand) -> table_view.Arrangement:
    return hand.bench.panels.measurements._tables._arrangements["mean error by step"]


def letters(text: str) -> float:
    return float(len(text))


def test_cells_are_texts_before_they_are_drawn() -> None:
    """Numbers as in readouts, whatever their type; words as they are; a column of both is one of words."""
    table = Table(("case_number", "share", "note"), [(np.int64(12345), 0.123456, "all"), (2, float("nan"), 3)])
    report = prepared({"cell_cases": table, "area": 1.0})
    assert report.readouts == [("area", "1")]
    (texts,) = report.tables
    assert (texts.title, texts.rows, texts.left_out) == ("cell cases", 2, 0)
    assert [column.title for column in texts.columns] == ["case number", "share", "note"]
    assert [column.cells for column in texts.columns] == [["12\u2009345", "2"], ["0.1235", "nan"], ["all", "3"]]
    assert [column.is_numbers for column in texts.columns] == [True, True, False]
    assert texts.columns[2].numbers == [False, True]


def test_a_long_table_is_cut_where_nobody_reads_on() -> None:
    texts = text_table("long", Table(("n",), [(n,) for n in range(MOST_ROWS + 7)]))
    assert (texts.rows, texts.left_out, len(texts.columns[0].cells)) == (MOST_ROWS, 7, MOST_ROWS)


@pytest.mark.parametrize(("room", "expected"), [
    (40.0, [14.0, 12.0, 14.0]),     # each what its heading asks for, and a third of what is left
    (31.0, [11.0, 9.0, 11.0]),
    (27.0, [9.0, 9.0, 9.0]),
    (23.0, [7.0, 9.0, 7.0]),        # headings in two lines
    (18.0, [7.0, 4.0, 7.0]),        # words give way, numbers do not
    (5.0, [7.0, 4.0, 7.0]),
])
def test_columns_share_the_room(room: float, expected: list[float]) -> None:
    table = text_table("t", Table(("all numbers", "words", "big numbers"), [(1234, "any words", 7), (1, "so", 2)]))
    assert table.widths(room, letters, 4.0) == expected


def test_no_rows_and_no_columns_are_drawn_too(sums: Hand, monkeypatch: pytest.MonkeyPatch) -> None:
    failures: list[str] = []
    monkeypatch.setattr(guard, "show_failure", failures.append)
    for rows in (0, 1, 14, 15, 5000):
        sums.bench.change("rows", {"rows": rows})
        sums.frames(40)
        assert shown(sums).table.rows == min(rows, MOST_ROWS)
    sums.bench.panels.measurements._tables._arrangements.clear()
    monkeypatch.setattr(sums.bench.stage, "measure", lambda: {"none": Table((), [])})
    sums.bench.change("rows", {"rows": 3})
    sums.frames(40)
    assert sums.bench.measurer.report.tables == [TextTable("none", [], 0, 0)]
    assert failures == []


def test_four_columns_fit_the_panel(sums: Hand) -> None:
    """In a window of 1024x768, without sideways scrolling, and legibly; arranged once and not in each frame."""
    arrangement = shown(sums)
    assert arrangement.fits
    assert arrangement.size >= 12.5
    sums.frames(30)
    assert shown(sums) is arrangement
    sums.drag((sums.bench.layout.right.x, 300.0), (-60.0, 0.0))
    sums.frames(2)
    assert shown(sums) is not arrangement


def test_a_long_table_scrolls_in_a_bounded_height(sums: Hand) -> None:
    """So that plots below it stay within reach."""
    sums.bench.change("rows", {"rows": 300})
    sums.frames(40)
    right = sums.bench.layout.right
    before = sums.pixels()
    sums.point((right.x + 60, right.y + 200))
    sums.bench.session.io.add_mouse_wheel_event(0.0, -5.0)
    sums.frames(30)
    column = np.s_[int(right.y):int(right.y + right.height), int(right.x):]
    changed = np.flatnonzero((sums.pixels()[column] != before[column]).any(axis=(1, 2)))
    assert changed.size
    assert changed.max() < 25 * 16
