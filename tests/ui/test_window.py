"""The real window, on a virtual screen."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PROGRAM = """
import pathlib, sys
from viewer.engine.catalog import Catalog
from viewer.ui.window import glfw, run
from viewer.ui.workbench import Workbench

def draw(bench, *arguments, original=Workbench.draw):
    original(bench, *arguments)
    if pathlib.Path("close").exists():
        glfw.set_window_should_close(glfw.get_current_context(), True)

Workbench.draw = draw
run(Catalog([sys.argv[1]]), "tile", size=(800, 600))
print("closed")
"""

pytestmark = pytest.mark.skipif(not shutil.which("Xvfb"), reason="no Xvfb on this machine")


@pytest.fixture
def display() -> Iterator[str]:
    """A virtual screen that lives as long as the test."""
    read, write = os.pipe()
    command = ["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x800x24", "-nolisten", "tcp"]
    server = subprocess.Popen(command, pass_fds=[write], stderr=subprocess.DEVNULL)
    os.close(write)
    with os.fdopen(read) as pipe:
        number = pipe.readline().strip()
    yield f":{number}"
    server.terminate()
    server.wait(10)


def test_the_window_opens_listens_and_closes(display: str, pack: Path) -> None:
    environment = {**os.environ, "DISPLAY": display, "PYTHONPATH": str(ROOT)}
    window = subprocess.Popen([sys.executable, "-c", PROGRAM, str(pack)], cwd=pack, env=environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    try:
        if shutil.which("xdotool"):
            _drive(environment, pack)
        else:
            time.sleep(5)
        assert window.poll() is None, window.communicate()[0]
        (pack / "close").touch()
        output = window.communicate(timeout=20)[0]
    finally:
        window.kill()
    assert output == "closed\n"


def _drive(environment: dict[str, str], pack: Path) -> None:
    def xdotool(*arguments: str) -> str:
        return subprocess.run(["xdotool", *arguments], env=environment, capture_output=True, text=True,
                              timeout=20).stdout.strip()

    window = xdotool("search", "--sync", "--name", "Demoscope").splitlines()[-1]
    xdotool("windowfocus", window)
    xdotool("mousemove", "400", "300")
    deadline = time.monotonic() + 15.0
    while not list(pack.glob("tile-*.png")) and time.monotonic() < deadline:
        xdotool("key", "--delay", "60", "F12")
        time.sleep(0.3)
    assert list(pack.glob("tile-*.png")), "F12 writes the picture"
    xdotool("key", "h", "F1", "Escape", "F11")
    time.sleep(0.5)
    xdotool("key", "F11")
    xdotool("windowsize", window, "1", "1")
    time.sleep(0.3)
    xdotool("windowsize", window, "700", "500")
    time.sleep(0.3)


def test_a_window_larger_than_the_screen_is_made_to_fit(display: str) -> None:
    """On a small projector without a window manager too, where nothing else would see to it."""
    program = ("import time; from viewer.ui.window import _opened; window = _opened((2000, 1500)); import glfw\n"
               "for _ in range(20): glfw.poll_events(); time.sleep(0.02)\n"
               "print(*glfw.get_window_size(window._window)); window.destroy()")
    done = subprocess.run([sys.executable, "-c", program], cwd=ROOT, env={**os.environ, "DISPLAY": display},
                          capture_output=True, text=True, timeout=60)
    assert done.stdout.split() == ["1280", "800"], done.stderr
