"""Contenders that take turns: whole processes that start and end, and workers that stay and draw frames."""

from __future__ import annotations

import importlib
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from tests.benchmarks.report import Row

ROOT = Path(__file__).parents[2]
WARM_UP_FRAMES = 4


@dataclass
class Run:
    """A whole process: wall seconds, its memory at the peak in MiB."""

    seconds: float
    peak: float


class DidNotRunError(Exception):
    """A contender that failed; the message is its last word."""


def run_whole(command: Sequence[str], environment: Mapping[str, str]) -> Run:
    """Start ``command``, wait for its end and say what it took; raises DidNotRunError."""
    with tempfile.TemporaryFile("w+") as complaints:
        start = time.perf_counter()
        process = subprocess.Popen(command, cwd=ROOT, env=environment, stdout=subprocess.DEVNULL, stderr=complaints)
        _, status, usage = os.wait4(process.pid, 0)
        seconds = time.perf_counter() - start
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode:
            raise DidNotRunError(_last_word(complaints, process.returncode))
    return Run(seconds, usage.ru_maxrss / (1024.0 if sys.platform.startswith("linux") else 1024.0**2))


def whole_processes(commands: Mapping[str, Sequence[str]], rounds: int) -> dict[str, list[Run] | str]:
    """Each command once to fill caches, then ``rounds`` times in turn: its runs, or why there are none."""
    outcome: dict[str, list[Run] | str] = {name: [] for name in commands}
    with tempfile.TemporaryDirectory() as bytecode:
        environment = {**os.environ, "PYTHONPYCACHEPREFIX": bytecode}   # compiled once, as after any first start
        environment.pop("PYTHONDONTWRITEBYTECODE", None)
        for turn in range(rounds + 1):
            for name, command in commands.items():
                runs = outcome[name]
                if isinstance(runs, str):
                    continue
                try:
                    run = run_whole(command, environment)
                except (DidNotRunError, OSError) as error:
                    outcome[name] = str(error)
                else:
                    runs += [run] if turn else []
    return outcome


class Worker:
    """A process that draws frames when told to: a module under ``peers`` and what it is to draw."""

    def __init__(self, row: Row, module: str, *arguments: str) -> None:
        self.row = row
        self._complaints = tempfile.TemporaryFile("w+")  # noqa: SIM115 - it lives as long as the process
        self._process = subprocess.Popen(
            [sys.executable, "-m", "tests.benchmarks.contest", module, *arguments], cwd=ROOT, text=True,
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._complaints)

    def draw(self, frames: int) -> list[float]:
        """Seconds for each of ``frames`` frames; on failure none, and the row says why."""
        if self.row.failure:
            return []
        assert self._process.stdin and self._process.stdout
        try:
            print(frames, file=self._process.stdin, flush=True)
            answer = self._process.stdout.readline()
        except BrokenPipeError:
            answer = ""
        if not answer:
            self.row.failure = _last_word(self._complaints, self._process.wait())
            return []
        times: list[float] = json.loads(answer)
        return times

    def close(self) -> None:
        """Let the process end."""
        assert self._process.stdin and self._process.stdout
        with suppress(BrokenPipeError):
            self._process.stdin.close()
        try:
            self._process.wait(10)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._process.stdout.close()
        self._complaints.close()


def frames_in_turn(workers: Sequence[Worker], rounds: int, frames: int) -> None:
    """Let each worker warm up, then draw ``frames`` frames in each round; fills the workers' rows."""
    try:
        for worker in workers:
            worker.draw(WARM_UP_FRAMES)
        for _ in range(rounds):
            for worker in workers:
                worker.row.times = [*worker.row.times, *worker.draw(frames)]
    finally:
        for worker in workers:
            worker.close()


def serve(frame: Callable[[int], object], answers: IO[str]) -> None:
    """The worker's side: for each number read, time that many calls of ``frame`` and answer with the seconds."""
    number = 0
    for line in sys.stdin:
        times = []
        for _ in range(int(line)):
            number += 1
            start = time.perf_counter()
            frame(number)
            times.append(time.perf_counter() - start)
        print(json.dumps(times), file=answers, flush=True)


def _last_word(complaints: IO[str], status: int) -> str:
    complaints.seek(0)
    lines = [line.strip() for line in complaints.read().splitlines() if line.strip()]
    return lines[-1] if lines else f"exit status {status}"


if __name__ == "__main__":
    # Libraries write to standard output as they please: the answers get a channel of their own.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    drawing = importlib.import_module(f"tests.benchmarks.peers.{sys.argv[1]}")
    serve(drawing.frames(*sys.argv[2:]), answers)
