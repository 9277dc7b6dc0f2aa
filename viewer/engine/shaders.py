"""Shader files: includes flattened into one text, and driver messages mapped back to file and line.

Drivers disagree on ``#line``, so the flattened text carries none: a table says for each of its lines
which file and line it came from.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from viewer.errors import DemoscopeError

INCLUDE = re.compile(r'^\s*#\s*include\s+["<]([^">]+)[">]')
VERSION = "#version 330 core"
GENERATED = "generated/"
Generated = Mapping[str, Callable[[], str]]


class ShaderError(DemoscopeError):
    """A shader that is missing, that includes wrongly, or that the driver refuses.

    ``place`` is the file as one would name it, ``line`` counts from 1 (0: no particular line).
    """

    def __init__(self, place: str, line: int, text: str) -> None:
        self.place, self.line, self.text = place, line, text
        super().__init__(f"{place}:{line}: {text}" if line else f"{place}: {text}")

    @property
    def generated(self) -> bool:
        """Whether the fault lies in generated text, such as a compiled formula, rather than in a file."""
        return self.place.startswith(GENERATED)


@dataclass
class Source:
    """A flattened shader: its text, where each line came from, and the files it was read from."""

    place: str
    lines: list[str] = field(default_factory=list)
    origins: list[tuple[str, int]] = field(default_factory=list)
    files: set[Path] = field(default_factory=set)

    @property
    def text(self) -> str:
        """The GLSL to hand to the driver."""
        return "\n".join(self.lines) + "\n"


class ShaderFolders:
    """The ``shaders/`` folders in which names are looked up, the first that has one winning."""

    def __init__(self, folders: Iterable[Path]) -> None:
        self.folders = tuple(folders)

    def find(self, name: str) -> Path | None:
        """The file called ``name`` (relative, such as ``lib/noise.glsl``), or None."""
        return next((folder / name for folder in self.folders if (folder / name).is_file()), None)

    def flatten(self, name: str, generated: Generated | None = None) -> Source:
        """The file ``name`` with its includes, each once, in place.

        ``generated`` maps include names to functions that make their text, for what is not a file
        (a compiled formula). Raises ShaderError for a missing file or a first line other than
        ``#version 330 core``.
        """
        source = Source(name)
        self._append(source, name, generated or {}, set(), None)
        if not source.lines or source.lines[0].strip() != VERSION:
            raise ShaderError(name, 1, f"the first line has to be {VERSION}")
        return source

    def _append(self, source: Source, name: str, generated: Generated, seen: set[str],
                includer: tuple[str, int] | None) -> None:
        if name in seen:
            return
        seen.add(name)
        for number, line in enumerate(self._read(source, name, generated, includer).splitlines(), 1):
            include = INCLUDE.match(line)
            if include:
                self._append(source, include[1], generated, seen, (name, number))
            else:
                source.lines.append(line)
                source.origins.append((name, number))

    def _read(self, source: Source, name: str, generated: Generated, includer: tuple[str, int] | None) -> str:
        if name in generated:
            return generated[name]()
        path = self.find(name)
        if path is None:
            place, line = includer or (name, 0)
            raise ShaderError(place, line, f"no shader file {name} in {' or '.join(map(str, self.folders))}")
        source.files.add(path)
        try:
            return path.read_text(encoding="utf-8-sig")
        except (OSError, UnicodeDecodeError) as error:
            raise ShaderError(name, 0, f"cannot be read: {error}") from error


# One expression for each way in which drivers write "line N of the text you gave me".
MESSAGE_FORMS = (
    re.compile(r"^\d+:(?P<line>\d+)\(\d+\): (?P<text>.*)$"),                     # Mesa: 0:12(5): error: ...
    re.compile(r"^\d+\((?P<line>\d+)\) : (?P<text>.*)$"),                        # NVIDIA: 0(12) : error C1: ...
    re.compile(r"^(?:ERROR|error): \d+:(?P<line>\d+): (?P<text>.*)$"),           # Apple, Intel: ERROR: 0:12: ...
)
SEVERITY = re.compile(r"^(?:(?:preprocessor )?error|fatal error)\s*(?:[A-Z]?\d+)?:\s*")
WARNING = re.compile(r"\bwarning\b", re.IGNORECASE)
HEADING = re.compile(r"\w+_shader$|program$|\w+ info$|.*\bfailed\.?$", re.IGNORECASE)


def explain(message: str, sources: Mapping[str, Source], place: str) -> ShaderError:
    """The driver's ``message`` as an error at the file and line it means.

    ``sources`` holds the flattened text of each stage by moderngl's name for it (``vertex_shader``);
    ``place`` stands for the program where the message names no line, as link errors do.
    """
    stage = next(iter(sources))
    lines = [line.strip() for line in message.splitlines()]
    for line in lines:
        match = next(filter(None, (form.match(line) for form in MESSAGE_FORMS)), None)
        if not match:       # perhaps a heading: vertex_shader, or Fragment info as NVIDIA's linker writes
            stage = next((name for name in sources if line.lower().startswith(name.split("_")[0])), stage)
        if match and not WARNING.match(match["text"]):
            return _located(sources[stage], int(match["line"]), SEVERITY.sub("", match["text"]))
    plain = [line for line in lines if line and not set(line) <= set("=-") and not HEADING.match(line)
             and not WARNING.search(line)]
    return ShaderError(place, 0, SEVERITY.sub("", plain[0]) if plain else "the driver refused it without a reason")


def _located(source: Source, line: int, text: str) -> ShaderError:
    if not 1 <= line <= len(source.origins):
        return ShaderError(source.place, 0, text)
    return ShaderError(*source.origins[line - 1], text)
