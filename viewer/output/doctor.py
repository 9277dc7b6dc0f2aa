"""What this machine offers: versions, OpenGL, a display, and the remedy for what is missing."""

from __future__ import annotations

import platform
from collections.abc import Iterator
from importlib import metadata

from viewer.engine.context import ContextError, has_display, open_headless

PACKAGES = ("numpy", "moderngl", "moderngl-window", "imgui-bundle", "glfw", "pyrr", "pillow", "trimesh")


def examine() -> tuple[list[str], bool]:
    """What to print, line by line, and whether everything that is needed works."""
    lines = [_line("python", f"{platform.python_version()} on {platform.system()} {platform.machine()}"), *_versions()]
    try:
        lines += [_line("drawing without a window", "works"), *_opengl()]
        well = True
    except ContextError as error:
        lines.append(_line("drawing without a window", f"fails: {error}"))
        well = False
    shown = "yes" if has_display() else "none, so pictures are drawn to files; set DISPLAY to have a window"
    return [*lines, _line("display", shown)], well


def _versions() -> Iterator[str]:
    for package in PACKAGES:
        try:
            yield _line(package, metadata.version(package))
        except metadata.PackageNotFoundError:
            yield _line(package, f"missing; pip install {package}")


def _opengl() -> Iterator[str]:
    context = open_headless()
    try:
        info = context.info
        yield _line("renderer", info["GL_RENDERER"])
        yield _line("OpenGL", f"{info['GL_VERSION']} (3.3 is needed)")
        yield _line("largest picture", f"{info['GL_MAX_TEXTURE_SIZE']} pixels a side")
        yield _line("samples for each pixel", f"up to {context.max_samples}")
    finally:
        context.release()


def _line(name: str, text: object) -> str:
    return f"{name:24}  {text}"
