"""Presets: named sets of parameter values, kept as TOML files beside a scene or in the user's folder.

    title = "As in the notes"
    description = "One sentence for the tooltip."
    [parameters]
    amplitude = 0.05
    [camera]                     # optional: yaw, pitch, distance, target
    yaw = 30
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from viewer.engine.camera import CameraError, Orbit
from viewer.engine.fields import ParameterError, nearest
from viewer.engine.params import Parameters
from viewer.errors import DemoscopeError
from viewer.whole_file import whole_file

if TYPE_CHECKING:
    from viewer.engine.catalog import SceneEntry
    from viewer.engine.stage import Stage


class PresetError(DemoscopeError):
    """A preset that is missing, is no TOML, or holds what a preset does not."""


@dataclass(frozen=True)
class Preset:
    """A look of a scene: values by parameter name, and perhaps where to stand."""

    name: str
    path: Path
    title: str
    description: str
    values: Mapping[str, Any]
    camera: Mapping[str, Any]

    def check(self, params: type[Parameters]) -> None:
        """Raise PresetError, naming the file, if a scene with these parameters does not take the values."""
        try:
            params(self.values)
        except ParameterError as error:
            raise PresetError(f"preset {self.path}: {error}") from error


def user_folder(scene: str) -> Path:
    """Where the presets that a user saves for ``scene`` live."""
    from platformdirs import user_data_path

    return user_data_path("demoscope", appauthor=False) / "presets" / scene


def presets_for(entry: SceneEntry) -> list[Preset]:
    """The presets of a scene, its pack's before the user's; files that cannot be read are left out."""
    found: dict[str, Preset] = {}
    for folder in _folders(entry):
        for path in sorted(folder.glob("*.toml")):
            try:
                found[path.stem] = read_preset(path)
            except PresetError:
                continue
    return list(found.values())


def load_preset(entry: SceneEntry, name: str | Path) -> Preset:
    """The preset called ``name``, or in the file ``name``; raises PresetError with the nearest name."""
    path = Path(name)
    if path.suffix == ".toml" or len(path.parts) > 1:
        return read_preset(path)
    files = {file.stem: file for folder in _folders(entry) for file in sorted(folder.glob("*.toml"))}
    if str(name) in files:
        return read_preset(files[str(name)])
    names = tuple(files)
    known = ", ".join(names) or "none"
    raise PresetError(f"{entry.name} has no preset {name}{nearest(str(name), names)}; known: {known}")


def read_preset(path: Path) -> Preset:
    """The preset in a file; raises PresetError naming the file and what is wrong with it."""
    import tomllib

    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise PresetError(f"preset {path} does not exist") from None
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError, RecursionError) as error:
        raise PresetError(f"preset {path} cannot be read: {' '.join(str(error).split())}") from error
    unknown = sorted(set(data) - {"title", "description", "parameters", "camera"})
    if unknown:
        raise PresetError(f"preset {path} has {unknown[0]}, which is none of title, description, parameters, camera")
    title, description = data.get("title", path.stem), data.get("description", "")
    return Preset(path.stem, path, str(title), str(description), _table(data, "parameters", path), _camera(data, path))


def save_preset(entry: SceneEntry, stage: Stage, name: str, description: str = "") -> Path:
    """Write what ``stage`` shows as the user's preset ``name``; returns the file, written whole."""
    import tomli_w

    if not name.strip() or len(name) > 60 or not all(letter.isalnum() or letter in " -_" for letter in name):
        raise PresetError(f"preset name {name[:60]!r} may hold letters, digits, spaces, - and _, at most 60")
    path = user_folder(entry.name) / f"{name.strip().replace(' ', '-').lower()}.toml"
    camera = {**{angle: getattr(stage.camera, angle) for angle in ("yaw", "pitch", "distance")},
              "target": [float(along) for along in stage.camera.target]}
    data = {"title": name, "description": description, "parameters": stage.params.stored(), "camera": camera}
    with whole_file(path) as temporary:
        temporary.write_text(tomli_w.dumps(data), encoding="utf-8")
    return path


def _folders(entry: SceneEntry) -> list[Path]:
    return [entry.pack / "assets" / "presets" / entry.name, user_folder(entry.name)]


def _table(data: Mapping[str, Any], key: str, path: Path) -> dict[str, Any]:
    table = data.get(key, {})
    if not isinstance(table, dict):
        raise PresetError(f"preset {path}: {key} is not a table")
    return table


def _camera(data: Mapping[str, Any], path: Path) -> dict[str, Any]:
    camera = _table(data, "camera", path)
    try:
        Orbit().moved(camera)
    except CameraError as error:
        raise PresetError(f"preset {path}: {error}") from error
    return camera
