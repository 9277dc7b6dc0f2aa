"""The command line: run | list | capture | export | measure | doctor."""

from __future__ import annotations

import argparse
import atexit
import gc
import json
import math
import os
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NoReturn

from viewer.engine.camera import Orbit
from viewer.engine.catalog import Catalog, summary
from viewer.engine.context import has_display
from viewer.engine.fields import nearest
from viewer.engine.scene import SceneError
from viewer.engine.shaders import ShaderError
from viewer.engine.stage import DEFAULT_SIZE
from viewer.errors import DemoscopeError

MISTAKE = 2
INTERRUPTED = 130    # as shells count: 128 and the signal's number
READER_GONE = 141
PICTURE_FOLDER = Path("captures")
WINDOW_SIZE = (1280, 800)


class Parser(argparse.ArgumentParser):
    """Says what is wrong in one line and ends with status 2."""

    def error(self, message: str) -> NoReturn:
        print(f"error: {' '.join(message.split())}; see {self.prog} --help", file=sys.stderr)
        sys.exit(MISTAKE)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit status."""
    atexit.register(gc.freeze)      # whatever is left goes with the process; no need to look through it for cycles
    words = list(sys.argv[1:] if arguments is None else arguments)
    options = _parser().parse_args(_with_command(words))
    run: Callable[[argparse.Namespace], int] = options.run
    try:
        status = run(options)
        sys.stdout.flush()
        return status
    except DemoscopeError as error:
        return _complain(error)
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        _say_no_more()
        return READER_GONE
    except OSError as error:
        _say_no_more()
        return _complain(f"cannot print: {error.strerror or error}")


# The commands

def run_window(options: argparse.Namespace) -> int:
    """The window; where there is no display, one picture of every scene."""
    catalog = Catalog(options.pack)
    if options.scene:
        catalog.find(options.scene)
    if not has_display():
        return _pictures_of_all(catalog, options)
    from viewer.ui import window

    window.run(catalog, options.scene, size=options.size, samples=options.samples, seed=options.seed,
               params=options.set, preset=options.preset, camera=options.camera)
    return 0


def run_list(options: argparse.Namespace) -> int:
    """Every scene with its description; as JSON with every parameter too."""
    described = []
    for entry in Catalog(options.pack).entries():
        try:
            described.append(entry.describe() if options.json
                             else {"name": entry.name, "description": summary(entry.load())})
        except SceneError as error:
            described.append({"name": entry.name, "error": str(error)})
    if options.json:
        print(json.dumps(described, indent=2))
    else:
        for scene in described:
            print(f"{scene['name']:20}  {scene.get('description') or scene['error']}")
    return 0


def run_capture(options: argparse.Namespace) -> int:
    """Pictures of frames."""
    from viewer.output.capture import capture_timed, parse_frames

    frames = parse_frames(options.frames)
    with _stage(options) as stage:
        if not options.panels:
            print(capture_timed(stage, frames, options.out))
            return 0
        from viewer.ui.headless import panels

        window = panels(stage, Catalog(options.pack))
        try:
            print(capture_timed(stage, frames, options.out, window.pixels))
        finally:
            window.release()
    return 0


def run_export(options: argparse.Namespace) -> int:
    """Geometry at a frame."""
    from viewer.output.export import check_suffix, export

    check_suffix(options.out)
    with _stage(options) as stage:
        stage.seek(options.frame)
        export(stage.geometry(), options.out)
    print(options.out)
    return 0


def run_measure(options: argparse.Namespace) -> int:
    """Measurements at a frame, as JSON."""
    from viewer.output.measure import as_json

    with _stage(options) as stage:
        stage.seek(options.frame)
        print(as_json(stage.measure()))
    return 0


def run_doctor(options: argparse.Namespace) -> int:
    """What works here, and what helps where it does not."""
    from viewer.output.doctor import examine

    lines, well = examine()
    print("\n".join(lines))
    if not well:
        raise DemoscopeError("OpenGL 3.3 is not to be had here; the remedy is above")
    return 0


def _pictures_of_all(catalog: Catalog, options: argparse.Namespace) -> int:
    from viewer.output.capture import capture
    from viewer.output.headless import headless

    status = 0
    chosen = [catalog.find(options.scene)] if options.scene else catalog.entries()
    print("No display: drawing one picture of every scene instead." if not options.scene
          else "No display: drawing a picture instead.")
    for entry in chosen:
        try:
            with headless(entry.name, size=options.size, samples=options.samples, params=options.set,
                          preset=options.preset, seed=options.seed, camera=options.camera, packs=options.pack) as stage:
                print(*capture(stage, [0], PICTURE_FOLDER.absolute()), sep="\n")
        except (SceneError, ShaderError) as error:
            status = _complain(error)
    return status


def _stage(options: argparse.Namespace) -> Any:
    from viewer.output.headless import headless

    return headless(options.scene, size=getattr(options, "size", (64, 64)), samples=getattr(options, "samples", 0),
                    params=options.set, preset=options.preset, seed=options.seed,
                    camera=getattr(options, "camera", None), packs=options.pack)


def _complain(error: object) -> int:
    print(f"error: {' '.join(str(error).split())}", file=sys.stderr)
    return MISTAKE


def _say_no_more() -> None:
    """Send what stdout still holds nowhere, lest Python tries to print it once more at exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


# The options

def _parser() -> Parser:
    parser = Parser(prog="demoscope", description="Computer graphics, live: a viewer for teaching.", allow_abbrev=False)
    from viewer import __version__

    parser.add_argument("--version", action="version", version=f"demoscope {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND", parser_class=Parser)

    window = _command(commands, "run", run_window, "open the window (what demoscope does by itself)")
    window.add_argument("scene", nargs="?", help="the scene to start with")
    _scene_options(window)
    _picture_options(window, WINDOW_SIZE)

    listing = _command(commands, "list", run_list, "the scenes")
    listing.add_argument("--json", action="store_true", help="with every parameter and its limits")

    pictures = _command(commands, "capture", run_capture, "pictures of a scene, no display needed")
    pictures.add_argument("scene")
    pictures.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder for the pictures")
    pictures.add_argument("--frames", default="0", help="0,30,60 or 0:120 or 0:120:4 (default 0)")
    pictures.add_argument("--panels", action="store_true", help="draw the window's panels too")
    _scene_options(pictures)
    _picture_options(pictures, DEFAULT_SIZE)

    for name, run, text in (("export", run_export, "a scene's geometry as .ply, .obj, .stl or .npz"),
                            ("measure", run_measure, "a scene's measurements as JSON")):
        command = _command(commands, name, run, text)
        command.add_argument("scene")
        if name == "export":
            command.add_argument("--out", type=Path, required=True, metavar="FILE", help="the file to write")
        command.add_argument("--frame", type=_whole_number, default=0, help="which frame (default 0)")
        _scene_options(command)

    _command(commands, "doctor", run_doctor, "what works on this machine, and what helps where it does not")
    return parser


def _command(commands: Any, name: str, run: Callable[[argparse.Namespace], int], text: str) -> argparse.ArgumentParser:
    parser: argparse.ArgumentParser = commands.add_parser(name, help=text, description=text, allow_abbrev=False)
    parser.set_defaults(run=run)
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
    if not text.isascii() or not text.isdigit() or len(text) > 18:
        raise argparse.ArgumentTypeError(f"{text[:40]} is not a whole number from 0 up")
    return int(text)


def _size(text: str) -> tuple[int, int]:
    parts = text.lower().split("x")
    if len(parts) != 2 or not all(part.isascii() and part.isdigit() and len(part) < 10 for part in parts):
        raise argparse.ArgumentTypeError(f"{text[:40]} is not a size such as 640x360")
    return int(parts[0]), int(parts[1])


def _pose(text: str) -> Orbit:
    try:
        yaw, pitch, distance = (float(part) for part in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text[:40]} is not YAW,PITCH,DISTANCE such as 30,20,4") from None
    if not all(map(math.isfinite, (yaw, pitch, distance))) or abs(pitch) > 89 or not 1e-3 <= distance <= 1e4:
        raise argparse.ArgumentTypeError(f"{text[:40]}: pitch goes from -89 to 89, distance from 0.001 to 10000")
    return Orbit(yaw, pitch, distance)


def _with_command(words: list[str]) -> list[str]:
    """``words`` with ``run`` put first where they name no command, so that ``demoscope SCENE`` works."""
    commands = ("run", "list", "capture", "export", "measure", "doctor")
    first = words[0] if words else ""
    if first in commands or first in ("-h", "--help", "--version"):
        return words
    if first and not first.startswith("-") and len(words) > 1 and nearest(first, commands):
        raise SystemExit(_unknown_command(first, commands))
    return ["run", *words]


def _unknown_command(word: str, commands: Sequence[str]) -> int:
    print(f"error: unknown command {word}{nearest(word, commands)}", file=sys.stderr)
    return MISTAKE
