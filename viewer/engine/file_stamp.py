"""What tells whether a file changed since it was read."""

from __future__ import annotations

from pathlib import Path

MISSING = 0, -1


def file_stamp(path: Path) -> tuple[str, int, int]:
    """A file's path, when it was last written, in nanoseconds, and its size in bytes; 0 and -1 where there is none."""
    try:
        status = path.stat()
    except (OSError, ValueError):
        return str(path), *MISSING
    return str(path), status.st_mtime_ns, status.st_size
