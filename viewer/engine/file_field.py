"""Parameters that are files to read."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from viewer.engine.fields import Field, ParameterError


class File(Field[Path | None]):
    """A file to read, or none; ``suffixes`` says which kinds."""

    kind = "file"

    def __init__(self, default: str | None, help: str, *, suffixes: Sequence[str] = (),
                 rebuild: bool = True) -> None:
        self.suffixes = tuple(suffixes)
        super().__init__(default, help, rebuild=rebuild)

    def parse(self, value: object) -> Path | None:
        if value is None:
            return None
        if not isinstance(value, (str, Path)):
            raise self.refuse(value, "is not a file's path")
        if value == "":
            return None
        if self.suffixes and Path(value).suffix.lower() not in self.suffixes:
            raise self.refuse(value, f"does not end in {', '.join(self.suffixes)}")
        try:
            path = Path(value).expanduser()
            found = path.is_file()
        except (OSError, ValueError, RuntimeError):     # too long, a NUL, a user without a home
            found = False
        if not found:
            raise self.refuse(value, "is not a file that exists")
        return path

    def refuse(self, value: object, why: str) -> ParameterError:
        """The error for a path; of a long one its end, where the file's name is."""
        shown = str(value)
        return super().refuse(shown if len(shown) <= 60 else f"...{shown[-57:]}", why)

    def text(self, value: Path | None) -> str:
        return "" if value is None else str(value)

    def stored(self, value: Path | None) -> str:
        return self.text(value)

    def limits(self) -> dict[str, Any]:
        return {"suffixes": list(self.suffixes)}
