"""What the commands share on a terminal: progress of long calls (bars, elsewhere one line a stage) and the answer at the end."""

from __future__ import annotations

import argparse
import io
import json
import os
import sys
import time
from collections.abc import Callable, Mapping
from types import TracebackType
from typing import Any, NoReturn

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeElapsedColumn

from .._files import printable


def open_streams() -> None:
    """Standard streams that were closed lead nowhere, and characters that one cannot show are written as escapes."""
    for number, name, mode in ((0, "stdin", "r"), (1, "stdout", "w"), (2, "stderr", "w")):
        try:
            os.fstat(number)
        except OSError:
            while os.open(os.devnull, os.O_RDWR) < number:  # or the next file that is opened would be the stream
                pass
        if getattr(sys, name) is None:
            setattr(sys, name, open(number, mode, closefd=False))
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def leave_streams() -> None:
    """Output and errors lead nowhere from here: what is still in their buffers cannot be written, not even when the interpreter ends."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for number in (1, 2):
        os.dup2(nowhere, number)


_NARROWEST, _USUAL_WIDTH = 20, 80  # columns of a terminal


class CommandConsole(Console):
    """A console that leaves it to the command what becomes of output that nobody reads."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        if self.width < _NARROWEST:  # COLUMNS=0, say: tables would be empty
            self.width = _USUAL_WIDTH

    def on_broken_pipe(self) -> NoReturn:
        """Called where writing failed; rich would end the process with the code of a plan with faults."""
        raise BrokenPipeError


_QUIET = 10.0  # [s] after which a stage says again how far it is, where no bars are shown


class Reporter:
    """Called with (stage, fraction); shows each stage in the order they begin: as a bar, or as lines where standard error is no terminal."""

    def __init__(self, console: Console) -> None:
        self._bars: Progress | None = None
        self._tasks: dict[str, TaskID] = {}
        self._seen: set[str] = set()
        self._begun = self._told = time.monotonic()
        if sys.stderr.isatty():
            columns = (
                TextColumn("{task.description:<24}", markup=False),
                BarColumn(),
                TextColumn("{task.percentage:>3.0f} %"),
                TimeElapsedColumn(),
            )
            self._bars = Progress(*columns, console=CommandConsole(stderr=True, highlight=False))

    def __enter__(self) -> Reporter:
        if self._bars:
            self._bars.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bars:
            if kind is None:
                for task in self._tasks.values():
                    self._bars.update(task, completed=1.0)
            self._bars.stop()

    def __call__(self, stage: str, fraction: float) -> None:
        if not stage:
            return
        if self._bars is None:
            self._tell_in_lines(stage, fraction)
            return
        if stage not in self._tasks:
            for task in self._tasks.values():
                self._bars.update(task, completed=1.0)
            self._tasks[stage] = self._bars.add_task(stage, total=1.0)
        self._bars.update(self._tasks[stage], completed=fraction)

    def _tell_in_lines(self, stage: str, fraction: float) -> None:
        now = time.monotonic()
        if stage not in self._seen:
            print(f"[{now - self._begun:6.1f} s] {stage}", file=sys.stderr, flush=True)
        elif now - self._told >= _QUIET:
            print(f"[{now - self._begun:6.1f} s] {stage}, {100 * fraction:.0f} %", file=sys.stderr, flush=True)
        else:
            return
        self._seen.add(stage)
        self._told = now


def print_answer(
    arguments: argparse.Namespace, console: Console, content: Mapping[str, Any], in_words: Callable[[], None]
) -> None:
    """The content as JSON where --json asks for it; else the answer in words, and where the report is."""
    if arguments.json:
        print(json.dumps(content, indent=1, allow_nan=False))
        return
    in_words()
    console.print(f"report: {printable(str(arguments.out / 'report.html'))}", markup=False, soft_wrap=True)
