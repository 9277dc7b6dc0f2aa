"""What the signs at a cell's corners leave open: which corners a face joins, and whether there is a tunnel.

A value exactly at the level counts as outside, and so does a saddle: as if the level were a hair lower. The
hair makes every decision one about a level that no corner and no saddle sits at, so they agree with each other.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from viewer.kit.trilinear_cell import AMBIGUOUS, COLUMNS, FACES

Values = NDArray[np.float64]
Flags = NDArray[np.bool_]
Quadratic = tuple[Values, Values, Values]
Spell = tuple[Values, Values, Values, Values]


def joined_faces(corners: Values, case: NDArray[np.uint8]) -> NDArray[np.int64]:
    """For each cell six bits: the ambiguous faces that join their two outside corners.

    The asymptotic decider of Nielson and Hamann, 1991. A bilinear function with corner values a, b, c, d in
    turn has its saddle at (ac - bd) / (a + c - b - d). With a and c outside, b and d inside, the denominator
    is positive: the saddle is outside, and joins a with c, where ac >= bd. Both cells at the face multiply
    the same pairs of numbers, so that not even rounding can make them disagree.

    ``corners`` (n, 8) are the values minus the level.
    """
    bits = np.zeros(len(case), np.int64)
    for face, (a, b, c, d) in enumerate(FACES):
        cells = np.flatnonzero(AMBIGUOUS[case, face])
        value = corners[cells]
        excess = value[:, a] * value[:, c] - value[:, b] * value[:, d]
        a_outside = value[:, a] >= 0.0
        joined = np.where(a_outside, excess >= 0.0, excess <= 0.0)
        bits[cells] |= joined.astype(np.int64) << face
    return bits


def tunnels(corners: Values) -> NDArray[np.int64]:
    """For each cell 0, or where a tunnel runs through it 1 + 2 * pattern + sheets.

    Sweep the cell with a plane across the first axis. It meets the level set in a hyperbola: at most two arcs,
    and two only where the signs alternate around the plane's square. While they do, the two arcs part and meet
    anew where the saddle of the square passes the level, that is where ac = bd: a quadratic in the plane's
    place, with two roots at most. Take arcs for the edges of a graph, and for its nodes the places where arcs
    begin, end or meet. One meeting, or two that one arc joins, make a tree, and the piece of surface is a
    disc. Only if *both* arcs of one meeting run into the other the graph has a cycle, and the piece is a
    tube with two rims. As between two spells of alternating signs there is a plane with one arc at most, the
    two meetings belong to one spell. So: a tunnel where both roots lie in one spell, otherwise nothing but
    discs. (The cases of Chernyaev, "Marching cubes 33", 1995, without a table.)

    Pattern 0: columns 0 and 2 outside, 1 and 3 inside; pattern 1 the reverse. Sheets 0: the tube joins the
    sheets that wrap the outside columns, 1: the inside ones.
    """
    start, end = columns(corners, 0)
    found = np.zeros(len(corners), np.int64)
    for pattern in (0, 1):
        outside, inside = [pattern, pattern + 2], [1 - pattern, 3 - pattern]
        pairs = start[:, outside], end[:, outside], start[:, inside], end[:, inside]
        joined, parted = _meets_twice(_spell(*pairs), quadratic(*pairs), excess(*pairs[1::2]) >= 0.0)
        found[parted] = 1 + 2 * pattern
        found[joined] = 2 + 2 * pattern
    return found


def columns(corners: Values, axis: int) -> tuple[Values, Values]:
    """The values (n, 4) at the starts and at the ends of the four edges along ``axis``, in turn."""
    starts = np.array(COLUMNS[axis])
    return corners[:, starts], corners[:, starts + (1 << axis)]


def quadratic(start: Values, end: Values, other_start: Values, other_end: Values) -> Quadratic:
    """The coefficients of the product of one pair of columns minus that of the other, highest power first."""
    slope, other = end - start, other_end - other_start
    return (excess(slope, other),
            start[:, 0] * slope[:, 1] + start[:, 1] * slope[:, 0]
            - other_start[:, 0] * other[:, 1] - other_start[:, 1] * other[:, 0],
            excess(start, other_start))


def excess(pair: Values, other: Values) -> Values:
    """The product of one pair of columns minus that of the other."""
    return pair[:, 0] * pair[:, 1] - other[:, 0] * other[:, 1]


def _spell(out0: Values, out1: Values, in0: Values, in1: Values) -> Spell:
    """When the signs alternate as asked: since the outside, since the inside columns do, and until they do.

    Infinite where they always do. Where a column never does, "since" is plus infinity and the spell empty.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        out_place, in_place = out0 / (out0 - out1), in0 / (in0 - in1)
    out_since = np.where(out0 >= 0.0, -np.inf, np.where(out1 >= 0.0, out_place, np.inf)).max(axis=1)
    in_since = np.where(in0 < 0.0, -np.inf, np.where(in1 < 0.0, in_place, np.inf)).max(axis=1)
    out_until = np.where(out1 >= 0.0, np.inf, out_place).min(axis=1)
    in_until = np.where(in1 < 0.0, np.inf, in_place).min(axis=1)
    return out_since, in_since, out_until, in_until


def _meets_twice(spell: Spell, square: Quadratic, joined_at_end: NDArray[np.bool_]) -> tuple[Flags, Flags]:
    """Where arcs meet twice in the spell: with the outside joined at both ends of it, and with the inside joined.

    A spell ends at a face, which decides, or where a column's value passes the level: one of the inside columns
    leaves a product of the outside columns alone, so the outside is joined, and the other way round. Of two
    columns that pass together the hair below the level lets the inside one have the last word.
    """
    out_since, in_since, out_until, in_until = spell
    a, b, c = square
    joined_first = np.where(np.isinf(out_since) & np.isinf(in_since), c >= 0.0, in_since >= out_since)
    joined_last = np.where(np.isinf(out_until) & np.isinf(in_until), joined_at_end, in_until <= out_until)
    since = np.maximum(np.maximum(out_since, in_since), 0.0)
    until = np.minimum(np.minimum(out_until, in_until), 1.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        turn = -b / (2.0 * a)
    within = (since < turn) & (turn < until)
    discriminant = b * b - 4.0 * a * c
    joined = within & joined_first & joined_last & (a > 0.0) & (discriminant > 0.0)
    parted = within & ~joined_first & ~joined_last & (a < 0.0) & (discriminant >= 0.0)
    return joined, parted
