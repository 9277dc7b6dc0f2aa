"""Runs the subjects asked for and prints one table."""

from __future__ import annotations

import argparse
import os
import platform
import sys
from collections.abc import Callable

from tests.benchmarks import big_mesh, cold_start, fish, formulas, isosurfaces, panels, particles, skinning
from tests.benchmarks.report import Row, Section, table

SUBJECTS: dict[str, Callable[[int], list[Section]]] = {
    "cold_start": cold_start.sections,
    "big_mesh": big_mesh.sections,
    "panels": panels.sections,
    "formulas": formulas.sections,
    "isosurfaces": isosurfaces.sections,
    "particles": particles.sections,
    "skinning": skinning.sections,
    "fish": fish.sections,
}


def main() -> int:
    """Exit status 0, or 1 where a measurement of our own could not run."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks", description="How fast Demoscope is.")
    parser.add_argument("subjects", nargs="*", metavar="SUBJECT", help=f"from {', '.join(SUBJECTS)} (default: all)")
    parser.add_argument("--rounds", type=int, default=7, help="how often each contender takes its turn (default 7)")
    options = parser.parse_args()
    unknown = set(options.subjects) - set(SUBJECTS)
    if unknown or options.rounds < 1:
        parser.error(f"unknown subject {', '.join(sorted(unknown))}" if unknown else "--rounds is 1 or more")
    done: list[Section] = []
    for name in options.subjects or SUBJECTS:
        print(f"measuring {name} ...", file=sys.stderr, flush=True)
        done += _attempt(name, options.rounds)
    print(table(done))
    print(f"\n{machine()}")
    return int(any(row.failure and row.ours for section in done for row in section.rows))


def machine() -> str:
    """Where the figures come from."""
    load = f"load {os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "load unknown"
    return (f"On {os.cpu_count()} cores, {load}, with {big_mesh.renderer()} and Python {platform.python_version()}. "
            f"All take turns in every round. Median and best of\nall figures; 'of ours': the median, divided by that "
            f"of the nearest row of Demoscope's above it.")


def _attempt(name: str, rounds: int) -> list[Section]:
    try:
        return SUBJECTS[name](rounds)
    except Exception as error:
        return [Section(name, [Row("Demoscope", failure=f"{type(error).__name__}: {error}", ours=True)])]


if __name__ == "__main__":
    sys.exit(main())
