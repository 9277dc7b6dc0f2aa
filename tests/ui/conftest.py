"""A workbench without a window, with a hand: mouse and keys go in as ImGui's own events."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pytest
from imgui_bundle import imgui
from numpy.typing import NDArray

from viewer.engine.catalog import Catalog
from viewer.engine.context import open_headless
from viewer.ui import parameter_panel, timeline
from viewer.ui.imgui_session import Surface
from viewer.ui.screenshot import surface_pixels
from viewer.ui.workbench import Workbench

SCENE = '''
from viewer import Parameters, Scene, Studio, choice, color, file, formula, integer, interval, slider, text, toggle
from viewer.engine.scene import Curve

class Tile(Scene):
    """A tile with every kind of parameter."""

    class Params(Parameters):
        height = formula("size*x", "Height of the tile")
        size: float = slider(0.5, 0.0, 1.0, "Size of the tile", unit="m")
        count: int = integer(3, 1, 9, "How many")
        shown: bool = toggle(True, "Whether it shows")
        way: str = choice("left", {"left": "To the left", "right": "To the right"}, "Which way")
        pattern: str = choice("plain", ["plain", "striped", "dotted", "checked", "marbled"], "What is on it")
        tint = color("#ff8800", "Colour of the tile")
        name: str = text("tile", "Its name")
        spread = interval((0.2, 0.6), 0.0, 1.0, "How far it spreads")
        picture = file(None, "What to show on it", suffixes=[".png"])

    studio = Studio(ground=None)

    def __init__(self, gpu, params):
        self.gpu, self.params = gpu, params
        self.program = gpu.program("tile/tile.vert", "tile/tile.frag")
        self.array = gpu.vertex_array(self.program)
        self.steps = 0

    def update(self, dt):
        self.steps += 1

    def draw(self):
        self.array.render(vertices=3)

    def measure(self):
        return {"steps": self.steps, "tilt_mean_deg": 6.4512,
                "area": Curve("size", [1, 10, 100], {"area": [1, 100, 10000]}, log_x=True, log_y=True)}
'''
VERTEX = """#version 330 core
uniform float u_size;
void main() {
    gl_Position = vec4(u_size * (vec2(gl_VertexID % 2, gl_VertexID / 2) * 2.0 - 1.0), 0.0, 1.0);
}
"""
FRAGMENT = """#version 330 core
uniform vec3 u_tint;
out vec4 out_color;
void main() {
    out_color = vec4(u_tint, 1.0);
}
"""


@pytest.fixture(scope="session")
def context() -> moderngl.Context:
    """One context for all tests of the panels."""
    opened = open_headless()
    opened.gc_mode = "context_gc"
    return opened


@pytest.fixture
def pack(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A pack with one tiny scene; presets and screenshots stay inside the test's folder."""
    (tmp_path / "scenes").mkdir()
    (tmp_path / "shaders" / "tile").mkdir(parents=True)
    (tmp_path / "scenes" / "tile.py").write_text(SCENE)
    (tmp_path / "shaders" / "tile" / "tile.vert").write_text(VERTEX)
    (tmp_path / "shaders" / "tile" / "tile.frag").write_text(FRAGMENT)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("viewer.engine.presets.user_folder", lambda scene: tmp_path / "mine" / scene)
    return tmp_path


@dataclass
class Hand:
    """Moves the mouse, presses keys and lets frames pass."""

    bench: Workbench
    surface: Surface
    places: dict[str, tuple[float, float, float, float]] = field(default_factory=dict)

    def frames(self, count: int = 1, seconds: float = 1.0 / 60.0) -> None:
        for _ in range(count):
            self.bench.draw(seconds, self.surface)

    def pixels(self) -> NDArray[np.uint8]:
        return surface_pixels(self.surface)

    def point(self, place: str | tuple[float, float], across: float = 0.5) -> None:
        """Move the mouse to a place, or to a widget that was drawn in the last frame."""
        if isinstance(place, str):
            low_x, low_y, high_x, high_y = self.places[place]
            place = low_x + across * (high_x - low_x), (low_y + high_y) / 2
        self.bench.session.io.add_mouse_pos_event(*place)
        self.frames()

    def button(self, down: bool, number: int = 0) -> None:
        self.bench.session.io.add_mouse_button_event(number, down)
        self.frames()

    def click(self, place: str | tuple[float, float], across: float = 0.5) -> None:
        self.point(place, across)
        self.button(True)
        self.button(False)
        self.frames(2)

    def drag(self, place: str | tuple[float, float], by: tuple[float, float], number: int = 0) -> None:
        self.point(place)
        io = self.bench.session.io
        start = io.mouse_pos.x, io.mouse_pos.y
        self.button(True, number)
        for part in (0.25, 0.5, 0.75, 1.0):
            self.point((start[0] + part * by[0], start[1] + part * by[1]))
        self.button(False, number)
        self.frames()

    def key(self, *keys: imgui.Key) -> None:
        """Press keys together, modifiers first."""
        for down in (True, False):
            for key in keys if down else reversed(keys):
                self.bench.session.io.add_key_event(key, down)
            self.frames()

    def type(self, text: str) -> None:
        for letter in text:
            self.bench.session.io.add_input_character(ord(letter))
            self.frames()

    def value(self, name: str) -> Any:
        assert self.bench.stage
        return self.bench.stage.params.get(name)


@pytest.fixture
def make_hand(context: moderngl.Context, pack: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., Hand]]:
    """Opens benches of any size over the pack; afterwards nothing may be left on the GPU."""
    left_over(context)
    made: list[Hand] = []

    def make(size: tuple[int, int] = (1024, 768), scene: str = "tile", **options: Any) -> Hand:
        bench = Workbench(context, Catalog([pack]), **options)
        target = context.framebuffer([context.renderbuffer(size, 4)])
        hand = Hand(bench, Surface(target, size))
        made.append(hand)
        _note_places(hand, monkeypatch)
        if bench.open(scene):
            bench.stage.clock.playing = False
        hand.frames(3)
        return hand

    yield make
    for hand in made:
        hand.bench.release()
        free(hand.surface.target)
    assert left_over(context) == []
    assert context.error == "GL_NO_ERROR"


def free(target: moderngl.Framebuffer) -> None:
    """Release a framebuffer and what it draws into; it may not stay bound then."""
    target.ctx.detect_framebuffer(0).use()
    for buffer in target.color_attachments:
        buffer.release()
    target.release()


def left_over(context: moderngl.Context) -> list[str]:
    """Kinds of the GL objects that Python has forgotten but nobody released, since the last call."""
    gc.collect()
    left = [thing for thing in context._objects if not isinstance(thing, moderngl.mgl.InvalidObject)]
    names = [type(thing).__name__ for thing in left]
    for thing in left:
        thing.release()
    context._objects.clear()
    return names


@pytest.fixture
def hand(make_hand: Callable[..., Hand]) -> Hand:
    """A bench of 1024x768 that shows the tile, paused."""
    return make_hand()


def _note_places(hand: Hand, monkeypatch: pytest.MonkeyPatch) -> None:
    """Remember where widgets were drawn: parameters by name, everything else by label."""

    def note(name: str) -> None:
        low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
        hand.places[name] = low.x, low.y, high.x, high.y

    def noting(module: Any, function: str, name_of: Callable[..., str]) -> None:
        original = getattr(module, function)

        def wrapper(*arguments: Any, **options: Any) -> Any:
            result = original(*arguments, **options)
            note(name_of(*arguments))
            return result

        monkeypatch.setattr(module, function, wrapper)

    noting(parameter_panel, "draw_value", lambda field, *_: field.name)
    noting(imgui, "input_text_multiline", lambda *_: "formula")
    for function in ("button", "small_button", "selectable", "tree_node_ex", "begin_tab_item", "menu_item",
                     "begin_menu", "slider_int", "begin_combo", "input_text", "input_text_with_hint"):
        noting(imgui, function, lambda label, *_: label)
    for module in (parameter_panel, timeline):
        noting(module, "icon_button", lambda icon, name, *_: name)
