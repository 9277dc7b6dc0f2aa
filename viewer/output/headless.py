"""Stages without a window, for scripts: one picture, or a stage to play with."""

from __future__ import annotations

import threading
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.camera import Orbit
from viewer.engine.catalog import Catalog
from viewer.engine.context import open_headless
from viewer.engine.fields import ParameterError
from viewer.engine.presets import load_preset
from viewer.engine.stage import DEFAULT_SIZE, Stage

_contexts = threading.local()


def shared_context() -> moderngl.Context:
    """The thread's headless GL context, opened when first asked for and made current; raises ContextError."""
    if not hasattr(_contexts, "context"):
        _contexts.context = open_headless()
    context: moderngl.Context = _contexts.context
    # A script may have used one of its own since; to leave it again would leave none current.
    context.__enter__()  # type: ignore[no-untyped-call]
    return context


@contextmanager
def headless(scene: str, *, size: tuple[int, int] = DEFAULT_SIZE, samples: int = 4,
             params: Mapping[str, object] | None = None, preset: str | Path | None = None, seed: int = 0,
             camera: Orbit | Mapping[str, Any] | None = None,
             packs: str | Path | Iterable[str | Path] = ()) -> Iterator[Stage]:
    """A stage with no window: set, seek, then take pixels, geometry or measurements.

    ``preset`` comes first, then ``params``, whose values are Python values or text. ``camera`` is a
    pose, or some of ``yaw``, ``pitch``, ``distance`` and ``target`` by name. Everything on the GPU is
    freed at the end of the block. Raises a DemoscopeError for whatever cannot be.
    """
    entry = Catalog(packs).find(scene)
    chosen = load_preset(entry, preset) if preset else None
    values = {**(chosen.values if chosen else {}), **(params or {})}
    try:
        stage = Stage(shared_context(), entry, size=size, samples=samples, params=values, seed=seed)
    except ParameterError:
        if chosen:
            chosen.check(entry.load().Params)
        raise
    try:
        place = camera or (chosen.camera if chosen else None)
        if place:
            stage.camera.stand(place)
        yield stage
    finally:
        stage.release()


def render(scene: str, frame: int = 0, *, size: tuple[int, int] = DEFAULT_SIZE, samples: int = 4,
           params: Mapping[str, object] | None = None, preset: str | Path | None = None, seed: int = 0,
           camera: Orbit | Mapping[str, Any] | None = None,
           packs: str | Path | Iterable[str | Path] = ()) -> NDArray[np.uint8]:
    """One picture of a scene: uint8 (height, width, 4), top row first."""
    with headless(scene, size=size, samples=samples, params=params, preset=preset, seed=seed, camera=camera,
                  packs=packs) as stage:
        stage.seek(frame)
        return stage.pixels()
