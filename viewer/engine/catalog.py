"""Finding scenes: a pack is a folder with ``scenes/``, ``shaders/`` and ``assets/``."""

from __future__ import annotations

import importlib.util
import inspect
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

from viewer.engine.camera import Orbit
from viewer.engine.clock import LAST_FRAME
from viewer.engine.fields import nearest
from viewer.engine.params import Parameters
from viewer.engine.scene import Scene, SceneError, Studio
from viewer.engine.shaders import ShaderFolders

ENTRY_POINTS = "demoscope.packs"
PACKAGE = Path(__file__).resolve().parents[1]


@dataclass(frozen=True)
class SceneEntry:
    """A scene that could be loaded: its name, its file, and the folders where it looks things up."""

    name: str
    file: Path
    pack: Path
    shaders: ShaderFolders

    def load(self) -> type[Scene]:
        """Run the file and return its scene; raises SceneError with the file and the line at fault."""
        module = self._run()
        found = [thing for thing in vars(module).values()
                 if inspect.isclass(thing) and issubclass(thing, Scene) and thing.__module__ == module.__name__]
        if len(found) != 1:
            raise SceneError(f"{self.file}: one class derived from Scene is expected, not {len(found)}")
        scene = found[0]
        for name, kind, right in (("camera", "an Orbit", isinstance(scene.camera, Orbit)),
                                  ("studio", "a Studio", isinstance(scene.studio, Studio)),
                                  ("poster", f"a frame from 0 to {LAST_FRAME}", _is_frame(scene.poster)),
                                  ("Params", "a class derived from Parameters", _is_parameters(scene.Params))):
            if not right:
                raise SceneError(f"{self.file}: {name} has to be {kind}")
        return scene

    def describe(self) -> dict[str, Any]:
        """Name, one-line description, poster frame and parameters, ready for JSON."""
        scene = self.load()
        parameters = [field.describe() for field in scene.Params.declared.values()]
        return {"name": self.name, "description": summary(scene), "poster": scene.poster, "parameters": parameters}

    def _run(self) -> ModuleType:
        name = f"demoscope_scene_{self.name}"
        module = ModuleType(name)
        module.__file__ = str(self.file)
        sys.modules[name] = module
        try:
            exec(compile(self.file.read_bytes(), str(self.file), "exec"), module.__dict__)
        except (Exception, SystemExit) as error:
            raise scene_error(self, "cannot be loaded", error) from error
        return module


def _is_frame(thing: object) -> bool:
    return type(thing) is int and 0 <= thing <= LAST_FRAME


def _is_parameters(thing: object) -> bool:
    return inspect.isclass(thing) and issubclass(thing, Parameters)


def summary(scene: type[Scene]) -> str:
    """The first line of a scene's docstring."""
    return (inspect.getdoc(scene) or scene.__name__).splitlines()[0]


def scene_error(entry: SceneEntry, doing: str, error: BaseException) -> SceneError:
    """What a scene raised, in one line: where in its file, and what."""
    line = error.lineno if isinstance(error, SyntaxError) and error.filename == str(entry.file) else None
    trace = error.__traceback__
    while trace:
        if trace.tb_frame.f_code.co_filename == str(entry.file):
            line = trace.tb_lineno
        trace = trace.tb_next
    reason = error.msg if isinstance(error, SyntaxError) else str(error)
    place = f"{entry.file.name}:{line}" if line else str(entry.file)
    return SceneError(" ".join(f"{entry.name} {doing}: {place}: {type(error).__name__}: {reason}".split()))


def builtin_pack() -> Path:
    """The pack that comes along: inside an installed package, beside it in a checkout."""
    inside = PACKAGE / "pack"
    return inside if inside.is_dir() else PACKAGE.parent


class Catalog:
    """The scenes of the packs given, then the built-in one's, then those of installed packs."""

    def __init__(self, packs: str | Path | Iterable[str | Path] = ()) -> None:
        packs = [packs] if isinstance(packs, (str, Path)) else packs
        self.packs = [_checked(Path(pack)) for pack in packs] + [builtin_pack()]

    def find(self, name: str) -> SceneEntry:
        """The scene called ``name``; raises SceneError with the nearest name if there is none."""
        entries = self._scenes_in(self.packs)
        if name not in entries:
            entries = {entry.name: entry for entry in self.entries()}
        if name not in entries:
            raise SceneError(f"unknown scene {name}{nearest(name, tuple(entries))}; "
                             f"known: {', '.join(entries) or 'none'}")
        return entries[name]

    def entries(self) -> list[SceneEntry]:
        """Every scene, by name; of two with one name the earlier pack's."""
        found = self._scenes_in([*self.packs, *_installed_packs()])
        return [found[name] for name in sorted(found)]

    def _scenes_in(self, packs: Iterable[Path]) -> dict[str, SceneEntry]:
        found: dict[str, SceneEntry] = {}
        for pack in packs:
            for file in sorted((pack / "scenes").glob("*.py")):
                if not file.name.startswith("_"):
                    found.setdefault(file.stem, self._entry(file, pack))
        return found

    def _entry(self, file: Path, pack: Path) -> SceneEntry:
        folders: Sequence[Path] = dict.fromkeys([pack, *self.packs, builtin_pack()])  # type: ignore[assignment]
        return SceneEntry(file.stem, file, pack, ShaderFolders(folder / "shaders" for folder in folders))


def _checked(pack: Path) -> Path:
    try:
        if (pack / "scenes").is_dir():
            return pack.resolve()
    except (OSError, ValueError) as error:
        raise SceneError(f"pack {pack} cannot be read: {error}") from error
    raise SceneError(f"pack {pack} has no folder scenes")


def _installed_packs() -> list[Path]:
    from importlib.metadata import entry_points

    packs = []
    for point in entry_points(group=ENTRY_POINTS):
        try:
            module = importlib.util.find_spec(point.value.split(":")[0])
        except ImportError:     # what is left of a package that has gone
            continue
        if module and module.origin:
            packs.append(Path(module.origin).parent)
    return [pack for pack in packs if (pack / "scenes").is_dir()]
