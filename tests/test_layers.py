"""Who may import whom: the arrows between the layers, read from the source without running it.

scenes -> viewer's public names and kit;   ui, output -> engine -> kit
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
WINDOW_LIBRARIES = ("imgui_bundle", "moderngl_window", "glfw")
SCENE_LIBRARIES = (
    "__future__", "collections", "dataclasses", "functools", "math", "pathlib", "typing", "moderngl", "numpy",
)  # fmt: skip


def imports(source: str, package: str) -> Iterator[str]:
    """The dotted name of each module or module member that a file of `package` imports, wherever in the file."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = package.split(".")[: len(package.split(".")) + 1 - node.level] if node.level else []
            module = ".".join([*above, *([node.module] if node.module else [])])
            yield from (f"{module}.{alias.name}" for alias in node.names)


def belongs(name: str, *modules: str) -> bool:
    """Whether a dotted name is one of the modules or lies within one."""
    return any(name == module or name.startswith(f"{module}.") for module in modules)


def imported(folder: str) -> list[tuple[str, str]]:
    """Each (file, dotted name) that the Python files under a folder import."""
    found = []
    for path in sorted((ROOT / folder).rglob("*.py")):
        file = path.relative_to(ROOT)
        found += [(file.as_posix(), name) for name in imports(path.read_text("utf-8"), ".".join(file.parent.parts))]
    return found


def is_private_to_viewer(name: str) -> bool:
    """Whether a name lies in a module of `viewer`, rather than being one of the names that `viewer` itself offers."""
    module = name.split(".")[1:2]
    return bool(module) and ((ROOT / "viewer" / module[0]).is_dir() or (ROOT / "viewer" / f"{module[0]}.py").is_file())


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("import numpy.linalg as la", ["numpy.linalg"]),
        ("from viewer import kit, Scene", ["viewer.kit", "viewer.Scene"]),
        ("from . import mesh", ["viewer.kit.mesh"]),
        ("from ..errors import DemoscopeError", ["viewer.errors.DemoscopeError"]),
        ("def later():\n    import glfw", ["glfw"]),
    ],
)
def test_imports_are_found(source: str, expected: list[str]) -> None:
    """Plain, aliased, relative and late imports all count."""
    assert list(imports(source, "viewer.kit")) == expected


def test_kit_stands_alone() -> None:
    """The kit is pure NumPy: it knows nothing above it, and no GL."""
    names = imported("viewer/kit")
    allowed = ("viewer.kit", "viewer.errors")
    assert not [use for use in names if belongs(use[1], "viewer") and not belongs(use[1], *allowed)]
    assert not [use for use in names if belongs(use[1], "moderngl", "glcontext", "pyglet", *WINDOW_LIBRARIES)]


def test_engine_knows_only_the_kit() -> None:
    """The engine draws without a window, and without knowing who looks."""
    allowed = ("viewer.kit", "viewer.engine", "viewer.errors", "viewer.whole_file")
    assert not [use for use in imported("viewer/engine") if belongs(use[1], "viewer") and not belongs(use[1], *allowed)]


def test_output_and_window_stand_side_by_side() -> None:
    """Capture works where no window can open, and the window needs nothing of capture."""
    assert not [use for use in imported("viewer/output") if belongs(use[1], "viewer.ui")]
    assert not [use for use in imported("viewer/ui") if belongs(use[1], "viewer.output")]


def test_window_libraries_stay_in_the_window() -> None:
    """Everything else starts fast and runs without a display."""
    everywhere = [*imported("viewer"), *imported("scenes")]
    window = [use for use in everywhere if belongs(use[1], *WINDOW_LIBRARIES)]
    assert not [use for use in window if not use[0].startswith("viewer/ui/")]


def test_scenes_use_only_the_public_names() -> None:
    """A scene needs `viewer`, the kit, NumPy and constants of moderngl; time and chance come from its stage."""
    allowed = ("viewer", *SCENE_LIBRARIES)
    names = imported("scenes")
    assert not [use for use in names if not belongs(use[1], *allowed)]
    assert not [use for use in names if is_private_to_viewer(use[1]) and not belongs(use[1], "viewer.kit")]


def test_scenes_draw_no_global_random_numbers() -> None:
    """`np.random.rand` and its kin would make two runs of a scene differ; a generator with a seed does not."""
    seeded = ("numpy.random.default_rng", "numpy.random.Generator")
    names = imported("scenes")
    assert not [use for use in names if belongs(use[1], "numpy.random") and not belongs(use[1], *seeded)]
    for path in sorted((ROOT / "scenes").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Attribute) and ast.unparse(node.value) in ("np.random", "numpy.random"):
                assert f"numpy.random.{node.attr}" in seeded, f"{path.name}:{node.lineno} uses {ast.unparse(node)}"
