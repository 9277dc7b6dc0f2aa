"""What may stand on the command line, and what it says when something else does."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NoReturn

from viewer.engine.camera import CameraError, Orbit
from viewer.engine.fields import nearest
from viewer.engine.stage import DEFAULT_SIZE

MISTAKE = 2
LARGEST = 10**18 - 1     # of whole numbers; GL and NumPy take no more than 64 bits
WINDOW_SIZE = (1280, 800)
NAMES = ("run", "list", "capture", "export", "measure", "doctor")


class Parser(argparse.ArgumentParser):
    """Says what is wrong in one line and ends with status 2."""

    def error(self, message: str) -> NoReturn:
        print(f"error: {' '.join(message.split())}; see {self.prog} --help", file=sys.stderr)
        sys.exit(MISTAKE)


def parse(words: Sequence[str]) -> argparse.Namespace:
    """The options that ``words`` mean, ``command`` among them; ends the program over a mistake."""
    return _parser().parse_args(_with_command(_with_camera(list(words))))


def _parser() -> Parser:
    parser = Parser(prog="demoscope", description="Computer graphics, live: a viewer for teaching.", allow_abbrev=False)
    from viewer import __version__

    parser.add_argument("--version", action="version", version=f"demoscope {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND", parser_class=Parser)

    window = _command(commands, "run", "open the window (what demoscope does by itself)")
    window.add_argument("scene", nargs="?", help="the scene to start with")
    _scene_options(window)
    _picture_options(window, WINDOW_SIZE)

    listing = _command(commands, "list", "the scenes")
    listing.add_argument("--json", action="store_true", help="with every parameter and its limits")

    pictures = _command(commands, "capture", "pictures of a scene, no display needed")
    pictures.add_argument("scene")
    pictures.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder for the pictures")
    pictures.add_argument("--frames", help="0,30,60 or 0:120 or 0:120:4 (default: the scene's poster)")
    pictures.add_argument("--panels", action="store_true", help="draw the window's panels too")
    _scene_options(pictures)
    _picture_options(pictures, DEFAULT_SIZE)

    for name, text in (("export", "a scene's geometry as .ply, .obj, .stl or .npz"),
                       ("measure", "a scene's measurements as JSON")):
        command = _command(commands, name, text)
        command.add_argument("scene")
        if name == "export":
            command.add_argument("--out", type=Path, required=True, metavar="FILE", help="the file to write")
        command.add_argument("--frame", type=_whole_number, default=0, help="which frame (default 0)")
        _scene_options(command)

    _command(commands, "doctor", "what works on this machine, and what helps where it does not")
    return parser


def _command(commands: Any, name: str, text: str) -> argparse.ArgumentParser:
    parser: argparse.ArgumentParser = commands.add_parser(name, help=text, description=text, allow_abbrev=False)
    parser.set_defaults(command=name)
    parser.add_argument("--pack", action="append", default=[], metavar="DIR", help="a folder with more scenes")
    return parser


def _scene_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--set", action=Assignment, default={}, metavar="NAME=VALUE", help="set a parameter")
    parser.add_argument("--preset", metavar="NAME|FILE", help="start from a preset")
    parser.add_argument("--seed", type=_whole_number, default=0, help="what randomness grows from (default 0)")


def _picture_options(parser: argparse.ArgumentParser, size: tuple[int, int]) -> None:
    parser.add_argument("--size", type=_size, default=size, metavar="WxH", help=f"pixels (default {size[0]}x{size[1]})")
    parser.add_argument("--samples", type=_whole_number, default=4, help="samples for each pixel (default 4)")
    parser.add_argument("--camera", type=_pose, metavar="YAW,PITCH,DISTANCE", help="where to stand")


class Assignment(argparse.Action):
    """Collects ``NAME=VALUE`` into a dictionary."""

    def __call__(self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, values: Any,
                 option: str | None = None) -> None:
        name, equals, value = values.partition("=")
        if not equals or not name.strip():
            parser.error(f"--set {values} is not of the form NAME=VALUE")
        namespace.set = {**namespace.set, name.strip(): value}


def _whole_number(text: str) -> int:
    if not text.isascii() or not text.isdigit():
        raise argparse.ArgumentTypeError(f"{text[:40]} is not a whole number from 0 up")
    digits = text.lstrip("0")[:len(str(LARGEST)) + 1]       # Python refuses to read thousands of them
    if int(digits or "0") > LARGEST:
        raise argparse.ArgumentTypeError(f"{text[:40]} is more than {LARGEST}, the largest number allowed")
    return int(digits or "0")


def _size(text: str) -> tuple[int, int]:
    parts = text.lower().split("x")
    if len(parts) != 2 or not all(part.isascii() and part.isdigit() and len(part) < 10 for part in parts):
        raise argparse.ArgumentTypeError(f"{text[:40]} is not a size such as 640x360")
    return int(parts[0]), int(parts[1])


def _pose(text: str) -> dict[str, float]:
    try:
        yaw, pitch, distance = (float(part) for part in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text[:40]} is not YAW,PITCH,DISTANCE such as 30,20,4") from None
    pose = {"yaw": yaw, "pitch": pitch, "distance": distance}
    try:
        Orbit().moved(pose)
    except CameraError as error:
        raise argparse.ArgumentTypeError(str(error)) from None
    return pose


def _with_camera(words: list[str]) -> list[str]:
    """``words`` with ``--camera -30,20,4`` as one, lest its minus looks like an option's."""
    joined: list[str] = []
    for word in words:
        if joined and joined[-1] == "--camera":
            joined[-1] += f"={word}"
        else:
            joined.append(word)
    return joined


def _with_command(words: list[str]) -> list[str]:
    """``words`` with ``run`` put first where they name no command, so that ``demoscope SCENE`` works."""
    first = words[0] if words else ""
    if first in NAMES or first in ("-h", "--help", "--version"):
        return words
    if first and not first.startswith("-") and len(words) > 1 and nearest(first, NAMES):
        raise SystemExit(_unknown_command(first))
    return ["run", *words]


def _unknown_command(word: str) -> int:
    print(f"error: unknown command {word}{nearest(word, NAMES)}", file=sys.stderr)
    return MISTAKE
