"""Rows of figures and the table they make."""

from __future__ import annotations

import statistics
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

HEADINGS = ("", "median", "best", "of ours", "", "target")
LONGEST_FAILURE = 90


@dataclass
class Row:
    """One contender: its times in seconds, or why there are none.

    ``extra`` is any other figure worth a column, ``target`` what was asked for and whether it is met.
    """

    name: str
    times: Sequence[float] = ()
    extra: str = ""
    target: str = ""
    failure: str = ""
    ours: bool = False

    @property
    def median(self) -> float:
        """The middle one of the times, in seconds."""
        return statistics.median(self.times)

    @property
    def best(self) -> float:
        """The shortest of the times, in seconds."""
        return min(self.times)


@dataclass
class Section:
    """A subject's rows. Times are compared with the nearest row of ours above them."""

    title: str
    rows: list[Row] = field(default_factory=list)


def at_most(row: Row, seconds: float, what: str = "") -> str:
    """The target of taking at most ``seconds``, and whether ``row`` meets it."""
    return f"{what or f'at most {duration(seconds)}'}: {_verdict(row.median <= seconds, row.best <= seconds)}"


def faster_than(row: Row, peer: Row, name: str, *, as_good: bool = False) -> str:
    """The target of beating ``peer``, and whether ``row`` meets it."""
    wish = f"as fast as {name}" if as_good else f"faster than {name}"
    if not peer.times:
        return f"{wish}: it did not run"
    return f"{wish}: {_verdict(row.median <= peer.median, row.best <= peer.best)}"


def in_time_of(row: Row, peer: Row, times: float, name: str) -> str:
    """The target of taking at most ``times`` as long as ``peer``, and whether ``row`` meets it."""
    wish = f"at most {times:g} of {name}"
    if not peer.times:
        return f"{wish}: it did not run"
    return f"{wish}: {_verdict(row.median <= times * peer.median, row.best <= times * peer.best)}"


def duration(seconds: float) -> str:
    """Seconds or milliseconds, whichever suits."""
    if seconds >= 1.0:
        return f"{seconds:.2f} s"
    return f"{1e3 * seconds:.2f} ms" if seconds < 0.01 else f"{1e3 * seconds:.0f} ms"


def table(sections: Iterable[Section]) -> str:
    """All sections under one heading, in aligned columns."""
    sections = list(sections)
    lines = [HEADINGS, *(line for section in sections for line in _lines(section))]
    widths = [max(len(line[column]) for line in lines if len(line) > 1) for column in range(len(HEADINGS))]
    rule = "-" * (sum(widths) + 2 * len(widths) - 2)
    shown = [_aligned(HEADINGS, widths), rule]
    for section in sections:
        shown += [section.title.upper(), *(_aligned(line, widths) for line in _lines(section)), rule]
    return "\n".join(shown)


def _verdict(usually: bool, at_best: bool) -> str:
    return "met" if usually else "met at best" if at_best else "MISSED"


def _lines(section: Section) -> list[tuple[str, ...]]:
    lines: list[tuple[str, ...]] = []
    ours: Row | None = None
    for row in section.rows:
        if row.failure:
            lines.append((f"  {row.name}", *[""] * 4, f"did not run: {row.failure}"[:LONGEST_FAILURE]))
            continue
        ours = row if row.ours else ours
        ratio = f"{row.median / ours.median:.2f}" if ours and row is not ours else ""
        lines.append((f"  {row.name}", duration(row.median), duration(row.best), ratio, row.extra, row.target))
    return lines


def _aligned(line: Sequence[str], widths: Sequence[int]) -> str:
    first, *numbers, last = line
    cells = [first.ljust(widths[0]), *(cell.rjust(width) for cell, width in zip(numbers, widths[1:], strict=False))]
    return "  ".join([*cells, last]).rstrip()
