"""The JSON of a glTF 2.0 file, in which every index, number and list is checked where it is asked for.

    document = parsed(path, text)
    node = document.entry("nodes", 3)
    node.index("mesh", "meshes")        # None, or a number of a mesh that there is
    node.numbers("translation", 3)      # None, or three finite numbers

The format: https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from viewer.errors import DemoscopeError
from viewer.kit.volume_layout import shown

MOST_VALUES = 2**20             # in the JSON: as Python objects they take some hundred bytes each
LONGEST_SHOWN = 200             # letters of a text that are looked at for a message
LARGEST_WHOLE = 2**53           # the largest number that the format has room for
KINDS = ("accessors", "animations", "buffers", "bufferViews", "images", "materials", "meshes", "nodes", "scenes",
         "skins", "textures")


class ModelFileError(DemoscopeError):
    """A rigged model that is missing, damaged, too large, or asks for what cannot be shown."""


@dataclass(frozen=True)
class Entry:
    """An object in the JSON that knows where it stands, as in ``nodes[3]``, so that what is wrong can be named."""

    document: Document
    place: str
    values: Mapping[str, Any]

    def refuse(self, name: str, allowed: str) -> NoReturn:
        """Raise ModelFileError for the value called ``name``, saying what is ``allowed``."""
        given = f"is {told(self.values[name])}" if name in self.values else "is missing"
        self.document.refuse(f"{self.named(name)} {given}; {allowed}")

    def named(self, name: str) -> str:
        """Where the value called ``name`` stands in the file."""
        return f"{self.place}.{name}" if self.place else name

    def child(self, name: str) -> Entry:
        """The object called ``name``; an empty one if there is none."""
        values = self.values.get(name, {})
        if not isinstance(values, dict):
            self.refuse(name, "an object is needed")
        return Entry(self.document, self.named(name), values)

    def children(self, name: str) -> list[Entry]:
        """The objects in the list called ``name``."""
        found = []
        for number, values in enumerate(self._list(name)):
            if not isinstance(values, dict):
                self.document.refuse(f"{self.named(name)}[{number}] is {told(values)}; an object is needed")
            found.append(Entry(self.document, f"{self.named(name)}[{number}]", values))
        return found

    def whole(self, name: str, low: int = 0, high: int = LARGEST_WHOLE, default: int | None = None) -> int:
        """The whole number called ``name``, from ``low`` to ``high``."""
        value = self.values.get(name, default)
        if type(value) is not int or not low <= value <= high:
            self.refuse(name, f"a whole number from {low:,} to {high:,} is needed")
        return value

    def index(self, name: str, kind: str) -> int | None:
        """The number of one of the file's ``kind``, such as meshes; None if there is no value called ``name``."""
        if name not in self.values:
            return None
        value = self.values[name]
        if not self.document.has(kind, value):
            self.refuse(name, self.document.choice_of(kind))
        return int(value)

    def needed_index(self, name: str, kind: str) -> int:
        """The same, where there must be one."""
        value = self.index(name, kind)
        if value is None:
            self.refuse(name, f"the number of one of the {kind} is needed")
        return value

    def indices(self, name: str, kind: str) -> list[int]:
        """A list of numbers of the file's ``kind``; empty if there is no value called ``name``."""
        values = self._list(name)
        for number, value in enumerate(values):
            if not self.document.has(kind, value):
                self.document.refuse(f"{self.named(name)}[{number}] is {told(value)}; {self.document.choice_of(kind)}")
        return list(values)

    def number(self, name: str, default: float) -> float:
        """The finite number called ``name``."""
        value = self.values.get(name, default)
        if not _finite([value]):
            self.refuse(name, "a finite number is needed")
        return float(value)

    def numbers(self, name: str, count: int) -> NDArray[np.float64] | None:
        """The ``count`` finite numbers called ``name``, (count,); None if there are none."""
        if name not in self.values:
            return None
        values = self._list(name)
        if len(values) != count:
            self.document.refuse(f"{self.named(name)} has {len(values):,} numbers; {count} are needed")
        if not _finite(values):
            wrong = next(number for number, value in enumerate(values) if not _finite([value]))
            self.document.refuse(f"{self.named(name)}[{wrong}] is {told(values[wrong])}; a finite number is needed")
        return np.array(values, np.float64)

    def text(self, name: str) -> str | None:
        """The text called ``name``; None if there is none."""
        value = self.values.get(name)
        if name in self.values and not isinstance(value, str):
            self.refuse(name, "text is needed")
        return value

    def texts(self, name: str) -> list[str]:
        """The list of texts called ``name``; empty if there is none."""
        values = self._list(name)
        for number, value in enumerate(values):
            if not isinstance(value, str):
                self.document.refuse(f"{self.named(name)}[{number}] is {told(value)}; text is needed")
        return list(values)

    def label(self) -> str | None:
        """The entry's name, on one line and no longer than a picture has room for; None if it has none."""
        return shown((self.text("name") or "")[:LONGEST_SHOWN]) or None

    def flag(self, name: str) -> bool:
        """Whether ``name`` is true; false if it is not there."""
        value = self.values.get(name, False)
        if not isinstance(value, bool):
            self.refuse(name, "true or false is needed")
        return value

    def _list(self, name: str) -> list[Any]:
        values = self.values.get(name, [])
        if not isinstance(values, list):
            self.refuse(name, "a list is needed")
        return values


class Document:
    """The whole JSON: lists of nodes, meshes, accessors and so on that refer to each other by number."""

    def __init__(self, path: Path, values: Mapping[str, Any]) -> None:
        self.path = path
        self.root = Entry(self, "", values)
        self._entries = {kind: self.root.children(kind) for kind in KINDS}

    def refuse(self, reason: str) -> NoReturn:
        """Raise ModelFileError, naming the file."""
        raise ModelFileError(f"model {self.path}: {reason}")

    def entry(self, kind: str, number: int) -> Entry:
        """One of the file's ``kind``, whose number was checked when it was read."""
        return self._entries[kind][number]

    def entries(self, kind: str) -> Sequence[Entry]:
        """All of one kind."""
        return self._entries[kind]

    def has(self, kind: str, value: object) -> bool:
        """Whether ``value``, of whatever type, is the number of one of the file's ``kind``."""
        return type(value) is int and 0 <= value < len(self._entries[kind])

    def choice_of(self, kind: str) -> str:
        """Which numbers of ``kind`` may be given, as a message says it."""
        count = len(self._entries[kind])
        return f"0 to {count - 1:,} are allowed" if count else f"there are no {kind}"


def parsed(path: Path, text: bytes) -> Document:
    """The document that ``text`` holds; raises ModelFileError unless it is JSON for glTF 2."""
    values_at_most = text.count(b",") + text.count(b"[") + text.count(b"{")
    if values_at_most > MOST_VALUES:
        raise ModelFileError(f"model {path} has a description of {values_at_most:,} values; "
                             f"at most {MOST_VALUES:,} are allowed")
    try:
        values = json.loads(text.decode("utf-8-sig"), object_pairs_hook=_without_doubles, parse_constant=_no_constant)
    except RecursionError:
        raise ModelFileError(f"model {path} is no glTF: its JSON is nested too deeply") from None
    except ValueError as error:
        reason = shown(str(error).replace("'utf-8' codec can't decode", "it is not UTF-8:"))
        raise ModelFileError(f"model {path} is no glTF, or damaged: {reason}") from None
    if not isinstance(values, dict):
        raise ModelFileError(f"model {path} is no glTF: its JSON is {told(values)}; an object is needed")
    document = Document(path, values)
    _check_version(document.root.child("asset"))
    return document


def told(value: object) -> str:
    """A value of the JSON as a message shows it."""
    if isinstance(value, dict | list):
        return "an object" if isinstance(value, dict) else "a list"
    return shown(json.dumps(value[:LONGEST_SHOWN] if isinstance(value, str) else value, ensure_ascii=False))


def _check_version(asset: Entry) -> None:
    version, least = asset.text("version"), asset.text("minVersion")
    if version is None or version.split(".")[0] != "2":
        asset.refuse("version", "2.0 is needed")
    if least not in (None, "2.0"):
        asset.refuse("minVersion", "2.0 is allowed")


def _finite(values: Sequence[object]) -> bool:
    """Whether all of them are numbers that a float32 can hold."""
    largest = float(np.finfo(np.float32).max)
    return all(type(value) in (int, float) and -largest <= value <= largest     # type: ignore[operator]
               for value in values)


def _without_doubles(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    values = dict(pairs)
    if len(values) < len(pairs):
        raise ValueError(f"the key {told(_first_double(name for name, _ in pairs))} stands twice in one object")
    return values


def _first_double(names: Iterator[str]) -> str:
    seen: set[str] = set()
    return next(name for name in names if name in seen or seen.add(name))   # type: ignore[func-returns-value]


def _no_constant(name: str) -> NoReturn:
    raise ValueError(f"{name} is no JSON number")
