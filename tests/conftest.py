"""What the tests share: a GL context that must come back clean, and small packs of scenes to break."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import moderngl
import pytest

from tests import packs
from viewer.engine import labels
from viewer.engine.catalog import Catalog
from viewer.engine.context import ContextError
from viewer.engine.stage import Stage
from viewer.output.headless import shared_context

ScenePack = Callable[..., Path]
MakeStage = Callable[..., Stage]


def pytest_addoption(parser: pytest.Parser) -> None:
    """``pytest tests/scenes --record`` writes the reference pictures instead of comparing with them."""
    parser.addoption("--record", action="store_true", help="record the scenes' reference pictures anew")


@pytest.fixture(autouse=True)
def home_of_its_own(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The user's folder for presets, empty, wherever the system would have it."""
    home = tmp_path_factory.getbasetemp() / "home"
    for name in ("XDG_DATA_HOME", "HOME", "LOCALAPPDATA"):
        monkeypatch.setenv(name, str(home))
    return home


@pytest.fixture(scope="session")
def only_context() -> moderngl.Context:
    """The context that ``viewer.headless`` uses too; it keeps what is dropped without being freed, to be counted."""
    try:
        context = shared_context()
    except ContextError as error:
        pytest.skip(str(error))
    context.gc_mode = "context_gc"
    gc.collect()
    gc.freeze()             # what is there already need not be searched after each test
    return context


@pytest.fixture(autouse=True)
def labels_complain(monkeypatch: pytest.MonkeyPatch) -> None:
    """Naming an object asks the driver for errors; in tests none that it finds is passed over."""

    def label(thing: Any, text: str) -> None:
        thing.label = text[:labels.LONGEST_LABEL]

    for home in ("viewer.engine.gpu.name_object", "viewer.engine.frame.label", "viewer.engine.program.label"):
        monkeypatch.setattr(home, label)


@pytest.fixture
def context(only_context: moderngl.Context) -> Iterator[moderngl.Context]:
    """A current GL context. After the test nothing made in it may be left, nor an error be pending."""
    assert shared_context().error == "GL_NO_ERROR"
    yield only_context
    assert shared_context().error == "GL_NO_ERROR"
    gc.collect()
    left = [thing for thing in only_context.objects if hasattr(thing, "release")]   # what was freed has none
    only_context.objects.clear()
    for thing in left:
        thing.release()
    assert not left, f"never freed: {[type(thing).__name__ for thing in left]}"


@pytest.fixture
def scene_pack(tmp_path: Path) -> ScenePack:
    """Writes a pack: ``scene_pack(tile=..., files={"shaders/tile/draw.vert": ...})`` returns its folder.

    Each keyword is a scene's name and its source; shaders that ``packs`` knows come along by themselves.
    """
    folder = tmp_path / "pack"

    def write(files: Mapping[str, str] | None = None, **scenes: str) -> Path:
        sources = {f"scenes/{name}.py": source for name, source in scenes.items()}
        for name, content in {**packs.SHADERS, **sources, **(files or {})}.items():
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(content, encoding="utf-8")
        return folder

    return write


@pytest.fixture
def make_stage(context: moderngl.Context, scene_pack: ScenePack) -> Iterator[MakeStage]:
    """Makes stages of scenes given by their source, or by the name of a built-in one; frees them after the test."""
    stages: list[Stage] = []

    def make(source: str = packs.TILE, *, name: str = "tile", files: Mapping[str, str] | None = None,
             size: tuple[int, int] = (32, 18), samples: int = 0, params: Mapping[str, object] | None = None,
             seed: int = 0) -> Stage:
        catalog = Catalog([scene_pack(files, **{name: source})] if source else [])
        stages.append(Stage(context, catalog.find(name), size=size, samples=samples, params=params, seed=seed))
        return stages[-1]

    yield make
    for stage in stages:
        stage.release()
    stages.clear()
