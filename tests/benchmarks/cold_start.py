"""From nothing to a picture on disk, as a whole process, and without any module of the window."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from tests.benchmarks.contest import ROOT, Run, whole_processes
from tests.benchmarks.report import Row, Section, at_most

OURS = "Demoscope: capture rippling_sphere"
PEERS = {"bare moderngl": "bare_moderngl", "Polyscope": "polyscope", "PyVista": "pyvista"}
MOST_SECONDS = 0.40
MOST_MEMORY = 250.0
WINDOW_LIBRARIES = ("imgui_bundle", "moderngl_window", "glfw", "pyglet", "viewer.ui")


def sections(rounds: int) -> list[Section]:
    """Ours and the peers'."""
    with tempfile.TemporaryDirectory() as folder:
        outcome = whole_processes(commands(Path(folder)), rounds)
        stowaways = window_modules(Path(folder))
    rows = [_row(name, runs) for name, runs in outcome.items()]
    ours = rows[0]
    ours.ours = True
    if ours.times:
        memory = max(run.peak for run in outcome[OURS] if isinstance(run, Run))
        ours.target = at_most(ours, MOST_SECONDS) + f", {MOST_MEMORY:.0f} MiB: {_met(memory <= MOST_MEMORY)}"
        none = f"no window module imported: {_met(not stowaways)} {' '.join(stowaways)}".rstrip()
        rows.insert(1, Row("  the same without multisampling", *_figures(outcome["plain"]), target=none))
    return [Section("Cold start to a picture on disk, 640x360, whole process; memory at its peak",
                    [row for row in rows if row.name != "plain"])]


def commands(folder: Path) -> dict[str, Sequence[str]]:
    """What to start, by contender."""
    capture = [sys.executable, "-m", "viewer", "capture", "rippling_sphere", "--out", str(folder)]
    peers = {name: [sys.executable, "-m", f"tests.benchmarks.peers.{module}", str(folder / f"{module}.png")]
             for name, module in PEERS.items()}
    return {OURS: capture, "plain": [*capture, "--samples", "0"], **peers}


def window_modules(folder: Path) -> list[str]:
    """Modules of the window that a capture imports, which should be none."""
    script = ("import sys; from viewer.cli import main; main(sys.argv[1:]); "
              "print(*sys.modules, sep='\\n', file=sys.stderr)")
    words = ["capture", "rippling_sphere", "--out", str(folder)]
    done = subprocess.run([sys.executable, "-c", script, *words], cwd=ROOT, capture_output=True, text=True)
    loaded = done.stderr.split()
    if "viewer.cli" not in loaded:
        return ["(the capture did not run)"]
    return [name for name in WINDOW_LIBRARIES if name in loaded]


def _row(name: str, runs: list[Run] | str) -> Row:
    return Row(name, failure=runs) if isinstance(runs, str) else Row(name, *_figures(runs))


def _figures(runs: list[Run] | str) -> tuple[list[float], str]:
    if isinstance(runs, str):
        return [], ""
    return [run.seconds for run in runs], f"{max(run.peak for run in runs):.0f} MiB"


def _met(well: bool) -> str:
    return "met" if well else "MISSED"
