"""A stage of particles that the tests of their motion and of their birth share: set up, played, and followed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import numpy as np
from numpy.typing import NDArray

import viewer
from viewer.engine.clock import FRAME_SECONDS
from viewer.engine.scene import Geometry
from viewer.engine.stage import Stage

Numbers = NDArray[np.float64]
# Nothing but what a test asks for: nobody is emitted, nothing is in the way, and there are no children.
QUIET: dict[str, Any] = {
    "count": 4096, "rate": 0.0, "lifetime": (100.0, 100.0), "speed": (0.0, 0.0), "spread": 0.0, "ground": False,
    "children_when": "never"}
Play = Callable[..., Stage]


@contextmanager
def stage_of_particles(seed: int = 0, **values: object) -> Iterator[Stage]:
    """A stage of its own, with QUIET's values where none are given."""
    with viewer.headless("particle_fountain", size=(32, 18), samples=0, seed=seed,
                         params={**QUIET, **values}) as stage:
        yield stage


def set_anew(stage: Stage, values: Mapping[str, object]) -> None:
    """Let ``stage`` stand at frame 0 with these values, QUIET's where none are given, and else the defaults."""
    stage.seek(0)
    stage.update_params(stage.params.completed({**QUIET, **values}))


def played(stage: Stage, frame: int) -> Geometry:
    """What lives at ``frame``."""
    stage.seek(frame)
    return stage.geometry()


def followed(stage: Stage, frames: int, start: int = 0) -> dict[str, Numbers]:
    """The same particles, all of whom live, frame by frame: (frames + 1, n, 3) or (frames + 1, n), by ``seed``."""
    moments = []
    for frame in range(start, start + frames + 1):
        geometry = played(stage, frame)
        order = np.argsort(geometry["seed"])
        moments.append({name: values[order] for name, values in geometry.items()})
    assert all((moment["seed"] == moments[0]["seed"]).all() for moment in moments)
    return {name: np.stack([moment[name] for moment in moments]).astype(np.float64) for name in moments[0]}


def energy(track: Mapping[str, Numbers], gravity: float = 0.0) -> Numbers:
    """Kinetic energy and that of gravity, (frames, n), of particles of mass 1 per kilogram."""
    return 0.5 * (track["velocity"]**2).sum(axis=-1) + gravity * track["position"][..., 1]


def seconds(frames: int) -> Numbers:
    """The time at each of the frames from 0 on."""
    return np.arange(frames + 1) * FRAME_SECONDS
