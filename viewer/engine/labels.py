"""Names for GL objects, as graphics debuggers show them."""

from __future__ import annotations

from contextlib import suppress
from typing import Any

import moderngl

LONGEST_LABEL = 100


def label(thing: Any, text: str) -> None:
    """Name a GL object. A driver that refuses, or an error left over from before, does not matter for a name."""
    with suppress(moderngl.Error):
        thing.label = text[:LONGEST_LABEL]
