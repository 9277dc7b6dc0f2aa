"""Everything a key does, declared once: the keys, the menus and the help overlay come from this table."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from imgui_bundle import imgui

if TYPE_CHECKING:
    from viewer.ui.workbench import Workbench

Key = imgui.Key
# ImGui swaps Ctrl and Cmd on a Mac by itself.
CTRL, SHIFT, MODIFIERS = int(Key.mod_ctrl), int(Key.mod_shift), int(Key.mod_mask_)
KEY_NAMES = {
    Key.space: "Space", Key.period: "Period .", Key.comma: "Comma ,", Key.equal: "+", Key.minus: "-", Key._0: "0",
    Key.escape: "Esc", Key.home: "Home", Key.keypad_add: "+", Key.keypad_subtract: "-",
}
TYPED_HELP = "?"    # a different key on every keyboard, so it is taken as a letter


@dataclass(frozen=True)
class Action:
    """One thing to do, the chords that do it (the first is the one shown) and where its menu entry stands."""

    menu: str
    title: str
    chords: tuple[int, ...]
    run: Callable[[Workbench], object]
    repeats: bool = False
    while_typing: bool = False
    checked: Callable[[Workbench], bool] | None = None

    @property
    def keys(self) -> str:
        """The chord as people write it."""
        return chord_text(self.chords[0]) if self.chords else ""


ACTIONS: tuple[Action, ...] = (
    Action("Play", "Play or pause", (Key.space,), lambda bench: bench.toggle_playing()),
    Action("Play", "One frame forward", (Key.period,), lambda bench: bench.step(1), repeats=True),
    Action("Play", "One frame back", (Key.comma,), lambda bench: bench.step(-1), repeats=True),
    Action("Play", "Back to frame 0", (Key.home,), lambda bench: bench.seek(0)),
    Action("Edit", "Undo", (CTRL | Key.z,), lambda bench: bench.undo(), repeats=True),
    Action("Edit", "Redo", (CTRL | SHIFT | Key.z, CTRL | Key.y), lambda bench: bench.redo(), repeats=True),
    Action("Edit", "Reset all parameters", (), lambda bench: bench.reset()),
    Action("View", "Reset the camera", (Key.r,), lambda bench: bench.reset_camera()),
    Action("View", "All panels", (Key.h,), lambda bench: bench.toggle("panels"),
           checked=lambda bench: bench.view.panels),
    Action("View", "Scenes and parameters", (Key.f2,), lambda bench: bench.toggle("left"), while_typing=True,
           checked=lambda bench: bench.view.left),
    Action("View", "Measurements, lesson, code", (Key.f3,), lambda bench: bench.toggle("right"), while_typing=True,
           checked=lambda bench: bench.view.right),
    Action("View", "Timeline and performance", (Key.f4,), lambda bench: bench.toggle("bottom"), while_typing=True,
           checked=lambda bench: bench.view.bottom),
    Action("View", "Larger text", (CTRL | Key.equal, CTRL | SHIFT | Key.equal, CTRL | Key.keypad_add),
           lambda bench: bench.view.rescale(1), while_typing=True),
    Action("View", "Smaller text", (CTRL | Key.minus, CTRL | Key.keypad_subtract),
           lambda bench: bench.view.rescale(-1), while_typing=True),
    Action("View", "Text at 100 %", (CTRL | Key._0, CTRL | Key.keypad0), lambda bench: bench.view.rescale(0),
           while_typing=True),
    Action("View", "Full screen", (Key.f11,), lambda bench: bench.on_fullscreen(), while_typing=True),
    Action("Picture", "Save the picture", (Key.f12,), lambda bench: bench.screenshot(panels=False), while_typing=True),
    Action("Picture", "Save the window with its panels", (SHIFT | Key.f12,),
           lambda bench: bench.screenshot(panels=True), while_typing=True),
    Action("Help", "Keys and mouse", (Key.f1,), lambda bench: bench.toggle("help"), while_typing=True,
           checked=lambda bench: bench.view.help),
    Action("Help", "Close what lies on top", (Key.escape,), lambda bench: bench.close_overlays(), while_typing=True),
)

MOUSE = (
    ("Click", "Choose what is under the mouse, where a scene lets you"),
    ("Drag a ring", "Turn what it stands around, where a scene has one"),
    ("Left drag", "Turn the camera"),
    ("Right, Shift+drag", "Move the camera"),
    ("Wheel, two fingers", "Come closer, go back"),
    ("Double click", "Reset the camera"),
    (f"{'Cmd' if sys.platform == 'darwin' else 'Ctrl'}+click", "Type the value of a slider"),
)


# (modifiers, key, action) of every chord: looked through in each frame
CHORDS = tuple((chord & MODIFIERS, Key(chord & ~MODIFIERS), action) for action in ACTIONS for chord in action.chords)


def run_pressed(bench: Workbench) -> None:
    """Do what the keys pressed in this frame ask for; plain letters go to a text that is being typed."""
    io = imgui.get_io()
    typing, modifiers = io.want_text_input, int(io.key_mods)
    for wanted, key, action in CHORDS:
        if wanted == modifiers and imgui.is_key_pressed(key, action.repeats) and (action.while_typing or not typing):
            action.run(bench)
    if not typing and any(chr(code) == TYPED_HELP for code in io.input_queue_characters):
        bench.toggle("help")


def chord_text(chord: int) -> str:
    """``Ctrl+Shift+Z``; ``Cmd`` on a Mac."""
    key = Key(chord & ~MODIFIERS)
    names = ["Cmd" if sys.platform == "darwin" else "Ctrl"] * bool(chord & CTRL) + ["Shift"] * bool(chord & SHIFT)
    return "+".join([*names, KEY_NAMES.get(key, imgui.get_key_name(key))])
