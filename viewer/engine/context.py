"""Opening OpenGL without a window, and saying in plain words why it cannot be opened."""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass
from typing import Any

import moderngl

from viewer.errors import DemoscopeError

GL_VERSION = 330
DEBIAN = "apt-get install --no-install-recommends libegl1 libgl1 libgl1-mesa-dri"


class ContextError(DemoscopeError):
    """OpenGL 3.3 is not to be had here; the message says what would help."""


@dataclass(frozen=True)
class Remedy:
    """A phrase in a driver's complaint, what it means and what helps."""

    phrase: str
    meaning: str
    help: str


REMEDIES = (
    Remedy("libEGL", "the library libEGL is missing", f"on Debian or Ubuntu: {DEBIAN}"),
    Remedy("libGL", "the library libGL is missing", f"on Debian or Ubuntu: {DEBIAN}"),
    Remedy("found 0 devices", "EGL finds no driver", f"install Mesa or the GPU's driver; on Debian: {DEBIAN}"),
    Remedy("eglInitialize", "EGL has no driver that starts", f"install Mesa's drivers; on Debian: {DEBIAN}"),
    Remedy("eglCreateContext", "the driver's OpenGL is older than 3.3", "update the graphics driver"),
    Remedy("open display", "no display", "leave DISPLAY unset to draw without one, or start an X server"),
    Remedy("X11", "the X server refuses a context", "update the graphics driver, or unset DISPLAY to draw without one"),
    Remedy("requested version", "the driver's OpenGL is older than 3.3",
           "update the graphics driver; a remote desktop may offer only OpenGL 1.1"),
)


def plain_words(complaint: object) -> ContextError:
    """The error that tells a user what a driver's ``complaint`` means and what to do."""
    text = " ".join(str(complaint).split())
    for remedy in REMEDIES:
        if remedy.phrase.lower() in text.lower():
            return ContextError(f"no OpenGL 3.3: {remedy.meaning} ({text}); {remedy.help}")
    return ContextError(f"no OpenGL 3.3: {text or 'the driver gave no reason'}; run demoscope doctor")


def open_headless() -> moderngl.Context:
    """A context with no window: through EGL on Linux, the system's own way elsewhere.

    Raises ContextError. With EGL no framebuffer exists until one is made and bound.
    """
    try:
        backend: dict[str, Any] = {"backend": "egl"} if sys.platform.startswith("linux") else {}
        return moderngl.create_context(standalone=True, require=GL_VERSION, **backend)
    except Exception as error:
        raise plain_words(error) from error


def has_display() -> bool:
    """Whether a window could be opened: always on Windows and macOS, elsewhere by the environment."""
    if not sys.platform.startswith("linux"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
