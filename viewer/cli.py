"""The command line: run | list | capture | export | measure | doctor."""

from __future__ import annotations

import argparse
import atexit
import gc
import io
import json
import os
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from viewer.engine.catalog import Catalog, summary
from viewer.engine.context import has_display
from viewer.engine.scene import SceneError
from viewer.engine.shaders import ShaderError
from viewer.errors import DemoscopeError
from viewer.options import MISTAKE, parse

if TYPE_CHECKING:
    from viewer.engine.stage import Stage

INTERRUPTED = 130    # as shells count: 128 and the signal's number
READER_GONE = 141
LONGEST_LINE = 600
PICTURE_FOLDER = Path("captures")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit status."""
    atexit.register(gc.freeze)      # whatever is left goes with the process; no need to look through it for cycles
    _make_streams_sure()
    options = parse(sys.argv[1:] if arguments is None else arguments)
    try:
        status = COMMANDS[options.command](options)
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


# The commands, by the names in viewer/options.py

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
    described, status = [], 0
    for entry in Catalog(options.pack).entries():
        try:
            described.append(entry.describe() if options.json
                             else {"name": entry.name, "description": summary(entry.load())})
        except SceneError as error:
            status = _complain(error)
    if options.json:
        print(json.dumps(described, indent=2))
    else:
        for scene in described:
            print(f"{scene['name']:20}  {scene['description']}")
    return status


def run_capture(options: argparse.Namespace) -> int:
    """Pictures of frames, or of the poster frame."""
    from viewer.output.capture import capture_timed, parse_frames

    chosen = None if options.frames is None else parse_frames(options.frames)
    with _stage(options) as stage:
        frames = [stage.scene_class.poster] if chosen is None else chosen
        if not options.panels:
            _tell(stage, capture_timed(stage, frames, options.out))
            return 0
        from viewer.ui.headless import panels

        window = panels(stage, Catalog(options.pack))
        try:
            _tell(stage, capture_timed(stage, frames, options.out, window.pixels))
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
        _tell(stage, str(options.out))
    return 0


def run_measure(options: argparse.Namespace) -> int:
    """Measurements at a frame, as JSON."""
    from viewer.output.measure import as_json

    with _stage(options) as stage:
        stage.seek(options.frame)
        _tell(stage, as_json(stage.measure()))
    return 0


def run_doctor(options: argparse.Namespace) -> int:
    """What works here, and what helps where it does not."""
    from viewer.output.doctor import examine

    lines, well = examine()
    print("\n".join(lines))
    if not well:
        raise DemoscopeError("OpenGL 3.3 is not to be had here; the remedy is above")
    return 0


COMMANDS: dict[str, Callable[[argparse.Namespace], int]] = {
    "run": run_window, "list": run_list, "capture": run_capture, "export": run_export, "measure": run_measure,
    "doctor": run_doctor,
}


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
                print(*capture(stage, [stage.scene_class.poster], PICTURE_FOLDER.absolute()), sep="\n")
        except (SceneError, ShaderError) as error:
            status = _complain(error)
    return status


def _stage(options: argparse.Namespace) -> Any:
    from viewer.output.headless import headless

    return headless(options.scene, size=getattr(options, "size", (64, 64)), samples=getattr(options, "samples", 0),
                    params=options.set, preset=options.preset, seed=options.seed,
                    camera=getattr(options, "camera", None), packs=options.pack)


def _tell(stage: Stage, result: str) -> None:
    """Print what was asked for, and on stderr what the scene finds unusual about the frame it stands at."""
    remarks = dict.fromkeys(stage.remarks())
    print(result)
    for remark in remarks:
        print(f"note: {_one_line(remark)}", file=sys.stderr)


def _complain(error: object) -> int:
    print(f"error: {_one_line(error)}", file=sys.stderr)
    return MISTAKE


def _one_line(said: object) -> str:
    line = " ".join(str(said).split())
    return line if len(line) <= LONGEST_LINE else line[:LONGEST_LINE - 3] + "..."


def _make_streams_sure() -> None:
    """Let nothing that is printed fail over a stream that the caller closed or over a letter that it lacks."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:
            setattr(sys, name, Path(os.devnull).open("w", encoding="utf-8"))     # noqa: SIM115  until the end
        elif isinstance(stream, io.TextIOWrapper) and stream.errors == "strict":
            stream.reconfigure(errors="backslashreplace")


def _say_no_more() -> None:
    """Send what stdout still holds nowhere, lest Python tries to print it once more at exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
