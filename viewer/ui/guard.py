"""Panels that may fail without taking the others along."""

from __future__ import annotations

from collections.abc import Callable

from imgui_bundle import imgui

from viewer.errors import DemoscopeError
from viewer.ui import theme


def guarded(title: str, draw: Callable[[], None]) -> None:
    """Run ``draw``; if it raises, put ImGui's stacks back in order and show the message in its place."""
    state = imgui.internal.ErrorRecoveryState()
    imgui.internal.error_recovery_store_state(state)
    try:
        draw()
    except Exception as error:
        imgui.internal.error_recovery_try_to_recover_state(state)
        show_failure(f"{title}: {one_line(error)}")


def show_failure(text: str) -> None:
    """A wrapped message in the warning colour."""
    imgui.push_style_color(imgui.Col_.text, theme.WARNING)
    imgui.text_wrapped(f"{theme.Icon.WARNING}  {text}")
    imgui.pop_style_color()


def one_line(error: BaseException) -> str:
    """What to say about ``error``: the message of our own kinds, with the type's name for others."""
    text = " ".join(str(error).split())
    return text if isinstance(error, DemoscopeError) else f"{type(error).__name__}: {text}"
