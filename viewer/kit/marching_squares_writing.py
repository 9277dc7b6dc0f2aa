"""The words that go with marching squares: on the board, on the sheet of cases, and beside the picture."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from viewer.kit.card import INK, NARROW, QUIET, Line
from viewer.kit.marching_squares_board import REACH, tile_corner
from viewer.kit.sampled_square import SampledSquare

LONGEST_FORMULA = 72
RIM = 0.5 * (1.0 + REACH)       # the middle of the board's margin
IN_FRONT = 0.01


def on_board(formula: str, square: SampledSquare, with_error: bool, aspect: float) -> Iterator[Line]:
    """The axes, the ``formula`` below unless it is empty, and above how fine the grid is and what that costs."""
    for text, x, y in (("0", -1.0, -RIM), ("x", 0.0, -RIM), ("1", 1.0, -RIM),
                       ("0", -RIM, -1.0), ("y", -RIM, 0.0), ("1", -RIM, 1.0)):
        yield Line(text, (x, y, IN_FRONT), 0.75, (0.5, 0.5), QUIET)
    longest = int(LONGEST_FORMULA * min(1.0, aspect))
    short = formula if len(formula) <= longest else formula[:longest - 1] + "…"
    if formula:
        equation = f"{short} = {square.level:g}".replace("-", "−")
        yield Line(equation, (0.0, -REACH - 0.1, IN_FRONT), 0.85, (0.5, 0.5), INK)
    if with_error:
        n, off = square.resolution, square.max_distance
        error = f"at most {off:.2g} off the true curve" if off == off else "no curve found"
        yield Line(f"{n} × {n} cells, {error}", (0.0, RIM, IN_FRONT), 0.85, (0.5, 0.5),
                   INK, bold=True)


def on_sheet(cases: NDArray[np.uint8], aspect: float) -> Iterator[Line]:
    """Under each case its number, in binary too where there is room, and how many cells of the board have it."""
    counts = np.bincount(cases.ravel(), minlength=17)
    for case in range(16):
        x, y = tile_corner(case)
        left, right, height = 2.0 * x - 1.0 + 0.05, 2.0 * x - 0.5 - 0.05, 2.0 * y - 1.0 + 0.085
        number = f"{case} = {case:04b}" if aspect >= NARROW else str(case)
        yield Line(number, (left, height, IN_FRONT), 0.62, (0.0, 0.5), INK if counts[case] else QUIET)
        if counts[case]:
            yield Line(f"× {counts[case]}", (right, height, IN_FRONT), 0.62, (1.0, 0.5), INK, bold=True)


def why_barren(square: SampledSquare, i: int, j: int) -> str:
    """Why a cell yields nothing although it might; empty where it does not."""
    if not square.barren[i, j]:
        return ""
    if square.without_value[i, j]:
        return "A corner has no value: no curve here."
    return "The function jumps here: no curve."


def remarks(square: SampledSquare, keeps_jumps: bool, asked_for: str, chosen: tuple[int, int] | None) -> Iterator[str]:
    """What is unusual."""
    known = square.values[np.isfinite(square.values)]
    last = square.resolution - 1
    if not known.size:
        yield "The function has no value at any sample."
    elif known.min() == known.max() and known.size == square.values.size:
        yield f"The function is {known[0]:.6g} everywhere: there is no curve."
    elif not square.crossed.any():
        yield f"The samples go from {known.min():.6g} to {known.max():.6g}, all on one side of {square.level:g}."
    if square.without_value.any():
        yield f"{_cells(int(square.without_value.sum()))} touch a sample without a value and yield nothing."
    if square.jumps.any():
        what = "drawn as a crossing all the same" if keeps_jumps else "no curve is drawn there"
        yield f"The function jumps through the level in {_cells(int(square.jumps.sum()))}: {what}."
    if asked_for.strip() and chosen is None:
        yield f"cell = {asked_for.strip()} is outside 0,0 to {last},{last}."


def _cells(count: int) -> str:
    return "1 cell" if count == 1 else f"{count} cells"
