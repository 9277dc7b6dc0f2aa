"""A sphere of 179,400 triangles at 640x360, read back as an array: frames one after the other."""

from __future__ import annotations

from tests.benchmarks.contest import Worker, frames_in_turn
from tests.benchmarks.report import Row, Section, faster_than
from viewer.engine.context import ContextError
from viewer.output.headless import shared_context

FRAMES = 12
WHAT = "179,400 triangles in the full studio, 640x360, read back"


def sections(rounds: int) -> list[Section]:
    """Without and with multisampling; everybody takes turns over both."""
    camera, mesh = "Demoscope, camera turning", "Demoscope, mesh moving, new shadow each frame"
    plain = {
        camera: ("demoscope", "0", "camera"), mesh: ("demoscope", "0", "mesh"), "bare moderngl": ("bare_moderngl", "0"),
        "Polyscope, its own floor": ("polyscope", "tile_reflection"), "Polyscope, no floor": ("polyscope", "none"),
        "PyVista, no floor or shadow": ("pyvista", "0")}
    smooth = {
        camera: ("demoscope", "4", "camera"), mesh: ("demoscope", "4", "mesh"), "bare moderngl": ("bare_moderngl", "4"),
        "PyVista, no floor or shadow": ("pyvista", "4")}
    workers = [[Worker(Row(name, ours=name == camera), *words) for name, words in group.items()]
               for group in (plain, smooth)]
    frames_in_turn([*workers[0], *workers[1]], rounds, FRAMES)
    first, second = ([worker.row for worker in group] for group in workers)
    _aim(first, first[3], "Polyscope")
    _aim(second, second[3], "PyVista")
    return [Section(f"{WHAT}, one sample", first), Section(f"{WHAT}, four samples", second)]


def renderer() -> str:
    """The GL driver's name for what it draws with."""
    try:
        return str(shared_context().info["GL_RENDERER"])
    except ContextError:
        return "no OpenGL"


def _aim(rows: list[Row], peer: Row, name: str) -> None:
    for row in rows:
        if row.times:
            row.extra = f"{1.0 / row.median:.0f} fps"
    for row in rows[:2]:
        if row.times:
            row.target = faster_than(row, peer, name, as_good=name == "Polyscope")
