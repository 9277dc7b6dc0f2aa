"""A sphere of 179,400 triangles at 640x360, read back as an array: frames one after the other."""

from __future__ import annotations

from tests.benchmarks.contest import Worker, frames_in_turn
from tests.benchmarks.report import Row, Section, faster_than
from viewer.engine.context import ContextError
from viewer.output.headless import shared_context

FRAMES = 12
OURS = "Demoscope: studio, shadow, tones"
MOTIONS = {"camera": "camera turning", "mesh": "mesh moving, hence a new shadow in each frame"}
CONTENDERS: dict[str, tuple[str, ...]] = {     # the module and what it is told before the motion
    OURS: ("demoscope", "0"),
    "bare moderngl": ("bare_moderngl", "0"),
    "Polyscope, its own floor": ("polyscope", "tile_reflection"),
    "Polyscope, no floor": ("polyscope", "none"),
    "PyVista, no floor": ("pyvista", "0"),
    f"{OURS}, 4 samples": ("demoscope", "4"),
    "bare moderngl, 4 samples": ("bare_moderngl", "4"),
    "PyVista, no floor, 4 samples": ("pyvista", "4"),
}


def sections(rounds: int) -> list[Section]:
    """With the camera turning, where the shadow stays, and with the mesh moving; everybody takes turns over both."""
    workers = {moving: _workers(moving) for moving in MOTIONS}
    frames_in_turn([worker for group in workers.values() for worker in group], rounds, FRAMES)
    done = []
    for moving, title in MOTIONS.items():
        rows = [worker.row for worker in workers[moving]]
        _aim(rows)
        done.append(Section(f"179,400 triangles, 640x360, read back: {title}", rows))
    return done


def renderer() -> str:
    """The GL driver's name for what it draws with."""
    try:
        return str(shared_context().info["GL_RENDERER"])
    except ContextError:
        return "no OpenGL"


def _workers(moving: str) -> list[Worker]:
    return [Worker(Row(name, ours=name.startswith(OURS)), *words, moving) for name, words in CONTENDERS.items()]


def _aim(rows: list[Row]) -> None:
    for row in rows:
        row.extra = f"{1.0 / row.median:.0f} fps" if row.times else ""
    ours, _, polyscope, _, _, ours_smooth, _, pyvista = rows
    if ours.times:
        ours.target = faster_than(ours, polyscope, "Polyscope", as_good=True)
    if ours_smooth.times:
        ours_smooth.target = faster_than(ours_smooth, pyvista, "PyVista")
