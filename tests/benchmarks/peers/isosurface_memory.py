"""How much memory a surface takes: ``python -m tests.benchmarks.peers.isosurface_memory mesh|scene CELLS``.

Prints the seconds it took and the MiB at the peak above those before.
"""

from __future__ import annotations

import re
import sys
import time
from pathlib import Path

import viewer
from tests.benchmarks.tangle import Ours
from viewer.output.headless import shared_context


def mebibytes(what: str) -> float:
    """``VmRSS``, the memory now, or ``VmHWM``, at its peak. Unlike getrusage, nothing of the process before exec."""
    status = Path("/proc/self/status")
    if not status.exists():
        raise OSError("memory is measured on Linux only")
    found = re.search(rf"{what}:\s*(\d+) kB", status.read_text())
    assert found
    return int(found[1]) / 1024.0


def mesh(cells: int) -> object:
    """Evaluated, extracted and kept."""
    return Ours(cells, "cubes")()


def scene(cells: int) -> object:
    """The whole scene, with its picture drawn once."""
    with viewer.headless("marching_cubes", params={"resolution": cells}) as stage:
        return stage.pixels()


if __name__ == "__main__":
    shared_context()
    before, start = mebibytes("VmRSS"), time.perf_counter()
    kept = {"mesh": mesh, "scene": scene}[sys.argv[1]](int(sys.argv[2]))
    seconds = time.perf_counter() - start
    print(seconds, mebibytes("VmHWM") - before)
