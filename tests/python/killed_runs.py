"""`mmgrasp plan` ended while it plans into a folder that holds a plan: what is there is one plan, whole, or none, and
what is somebody's stays.

As a script: `killed_runs.py [TRIES [SEED]]`. One half of the tries ends at a random moment, the other at one of the
steps by which files come to their places. Before them the folder alone is filled, with small files, and ended at each
of its steps (`ended_at`).
"""

from __future__ import annotations

import contextlib
import copy
import errno
import functools
import hashlib
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, NamedTuple

import yaml

import mmgrasp as mg
from mmgrasp._files import ASSETS, DRAFT, write_file
from mmgrasp.cli.output_folder import LIST, OutputFolder

HERE = Path(__file__).parent
ENTRY = "import sys, mmgrasp_command; sys.exit(mmgrasp_command.main())"  # the command; -m loads the package first
STEPWISE = "import sys, killed_runs; killed_runs.run_command(*sys.argv[1:3], sys.argv[3:])"
TOO_LONG = 120.0  # [s] that a run may take to end
SIGNALS = (signal.SIGKILL, signal.SIGINT, signal.SIGTERM)
WAYS: tuple[tuple[str, ...], ...] = ((), ("--no-pictures",), ("--drive-by",))
COUNTS = (2, 3)
PICTURES = ("*.png", "report.html")
STEPS = ("replace", "rename", "unlink", "remove", "rmdir", "link", "symlink", "mkdir")
"""What of `os` changes names in a folder."""
TEMPORARY = (DRAFT, ".draft.", ".trial.")
"""Pieces of names of what stands for a moment only: what is being written, and what is tried in a folder."""
MINE = "mine.txt"


# --- ended at each of its steps ---------------------------------------------------------------------------------------
def at_step(number: int, below: Path, act: Callable[[], object]) -> Callable[[], int]:
    """Has `act` called before the step of this number (from 0) that changes a name below the folder; returns what
    counts the steps."""
    counted = 0

    def wrapped(function: Callable[..., Any], *arguments: Any, **keywords: Any) -> Any:
        nonlocal counted
        if any(_is_below(argument, below) for argument in arguments):
            counted += 1
            if counted == number + 1:
                act()
        return function(*arguments, **keywords)

    for name in STEPS:
        setattr(os, name, functools.partial(wrapped, getattr(os, name)))
    return lambda: counted


def _is_below(argument: Any, folder: Path) -> bool:
    return isinstance(argument, str | os.PathLike) and os.path.realpath(argument).startswith(f"{folder.resolve()}/")


def run_command(number: str, out: str, arguments: list[str]) -> None:
    """The command in this process, ended by a signal (the first of the arguments) at a step."""
    ending = signal.Signals[arguments[0]]
    at_step(int(number), Path(out), lambda: os.kill(os.getpid(), ending))
    sys.argv = ["mmgrasp", *arguments[1:]]
    import mmgrasp_command

    sys.exit(mmgrasp_command.main())


WHOLE, CAME, BROKEN = 0, 1, 70


def ended_at(number: int, folder: Path, work: Callable[[], object], act: Callable[[], object]) -> int:
    """Does the work in a process of its own, which must not have threads: whether it came to the step at which `act`
    is called, was whole before, or raised what no command should."""
    child = os.fork()
    if child == 0:
        try:
            steps = at_step(number, folder, act)
            with contextlib.suppress(KeyboardInterrupt, mg.Error):
                work()
            os._exit(CAME if steps() > number else WHOLE)
        except BaseException:
            os._exit(BROKEN)
    _, status = os.waitpid(child, 0)
    return CAME if os.WIFSIGNALED(status) else os.WEXITSTATUS(status)


def fails() -> None:
    raise OSError(errno.EIO, "failed here")


Files = dict[str, str]
OLD: Files = {
    "plan.json": "1",
    "timings.json": "1",
    "trajectories/a.csv": "1",
    "trajectories/old.csv": "1",
    "top.png": "1",
}
NEW: Files = {"plan.json": "2", "timings.json": "2", "trajectories/a.csv": "2", "trajectories/b.csv": "2"}
OWN = ("plan.json", "timings.json", "*.png", LIST, "trajectories")


def fill(out: Path, files: Files) -> None:
    with OutputFolder(out, OWN).filled() as draft:
        for name, text in files.items():
            write_file(draft / name, text)


def digests(files: Files) -> Files:
    return {name: hashlib.sha256(text.encode()).hexdigest() for name, text in files.items()}


ACTS: dict[str, tuple[Callable[[], object], bool]] = {
    "SIGKILL": (lambda: os.kill(os.getpid(), signal.SIGKILL), True),
    "SIGINT": (lambda: os.kill(os.getpid(), signal.SIGINT), False),
    "an error": (fails, False),
}
"""What happens at a step, and whether no plan at all may be left by it."""


def small_fills(folder: Path, what: str, refill: Callable[[Path, Files], None] = fill) -> Iterator[tuple[int, str]]:
    """Fills a folder that holds a plan, again and again, with `what` at each of its steps: the step, and what is wrong
    then ("": nothing)."""
    act, may_lack = ACTS[what]
    for number in range(1000):
        out = folder / f"{number}"
        out.mkdir(parents=True)
        fill(out, OLD)
        (out / MINE).write_text("mine")
        ended = ended_at(number, out, functools.partial(refill, out, NEW), act)
        yield number, small_fault(out, may_lack, ended)
        if ended == WHOLE:
            return
    yield number, "filling a folder has no end"


def small_fault(out: Path, may_lack: bool, ended: int) -> str:
    there = state(out)
    if ended not in (WHOLE, CAME):
        return f"ended with {ended}: neither an error of mmgrasp's nor Ctrl-C"
    if why := listing_fault(out, there) or mine_fault(out):
        return why
    if "plan.json" not in there:
        return lost_fault(out, digests(OLD)) if may_lack else "no plan"
    if there == digests(NEW) or (ended == CAME and there == digests(OLD)):
        fill(out, {"plan.json": "3"})  # a later run goes through
        return (
            "" if state(out) == digests({"plan.json": "3"}) and not drafts(out) else "a later run left something over"
        )
    return f"neither the old nor the new plan alone: {sorted(there)}"


# --- what a folder holds ----------------------------------------------------------------------------------------------
def drafts(out: Path) -> list[Path]:
    """What is half written, but for the empty file of a trial."""
    return [path for name in TEMPORARY[:2] for path in out.rglob(f"*{name}*")]


def state(out: Path) -> Files:
    """The checksum of each file of the folder but for the list of them, drafts, and what is not the command's."""
    files = [path for path in out.rglob("*") if path.is_file() and not any(name in str(path) for name in TEMPORARY)]
    names = {path.relative_to(out).as_posix(): path for path in files}
    return {
        name: hashlib.sha256(path.read_bytes()).hexdigest() for name, path in names.items() if name not in (MINE, LIST)
    }


def mine_fault(out: Path) -> str:
    return "" if (out / MINE).read_text() == "mine" else "a file of somebody's was changed"


def listing_fault(out: Path, there: Files) -> str:
    """What is wrong with the list of files: each that is there must be on it, with its checksum."""
    try:
        listed = json.loads((out / LIST).read_text())["files"]
    except (OSError, ValueError) as error:
        return f"no list of files: {error}"
    if stray := sorted(there.keys() - listed.keys()):
        return f"not listed: {stray}"
    other = sorted(name for name, digest in there.items() if listed[name] and digest not in listed[name])
    return f"not what the list says: {other}" if other else ""


def lost_fault(out: Path, before: Files) -> str:
    """Where no plan is in its place, the old one or the new one must lie beside."""
    kept = [path for path in out.parent.rglob("*plan.json*") if path.is_file()]
    is_old = any(hashlib.sha256(path.read_bytes()).hexdigest() == before.get("plan.json") for path in kept)
    return (
        "" if is_old or list(out.parent.rglob(f"*{DRAFT}*/plan.json")) else "neither the old nor the new plan is left"
    )


# --- the command ------------------------------------------------------------------------------------------------------
class Run(NamedTuple):
    """One call of the command."""

    parts: int
    """How many parts it picks."""
    way: tuple[str, ...]
    ending: signal.Signals
    moment: float
    """When it is ended [s]; below 0: at a step."""
    step: int = -1

    def __str__(self) -> str:
        when = f"at step {self.step}" if self.moment < 0 else f"after {self.moment:.2f} s"
        return f"{self.ending.name} {when} of {self.parts} parts {' '.join(self.way)}"


def scenario(folder: Path, count: int, name: str) -> Path:
    """The storeroom's first tray, so many of its parts, and a name that tells the plan from all others."""
    values: dict[str, Any] = yaml.safe_load((ASSETS / "scenarios" / "storeroom.yaml").read_text())
    tray = copy.deepcopy(values["trays"][0])
    tray["targets"] = tray["targets"][:count]
    path = folder / "scenario.yaml"
    path.write_text(yaml.safe_dump({**values, "name": name, "trays": [tray], "reach": {"samples": 500_000}}))
    return path


def plan_line(path: Path, out: Path, way: tuple[str, ...]) -> list[str]:
    return ["plan", str(path), "-o", str(out), *way]


def command(one: Run, path: Path, out: Path) -> list[str]:
    line = plan_line(path, out, one.way)
    if one.moment >= 0:
        return [sys.executable, "-c", ENTRY, *line]
    return [sys.executable, "-c", STEPWISE, str(one.step), str(out), one.ending.name, *line]


def end(one: Run, line: list[str]) -> tuple[int | None, str]:
    """The exit code as a shell tells it (None: it did not end) and what it said on stderr."""
    with subprocess.Popen(line, cwd=HERE, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as running:
        try:
            if one.moment >= 0:
                with contextlib.suppress(subprocess.TimeoutExpired):
                    running.wait(one.moment)
                if running.poll() is None:
                    running.send_signal(one.ending)
            _, said = running.communicate(timeout=TOO_LONG)
        except subprocess.TimeoutExpired:
            running.kill()
            return None, running.communicate()[1]
    code = running.returncode
    return (128 - code if code < 0 else code), said


def ending_fault(one: Run, code: int | None, said: str) -> str:
    if code is None:
        return f"did not end within {TOO_LONG:.0f} s"
    if "Traceback" in said:
        return said[-500:]
    return "" if code in (0, 128 + one.ending) else f"exit code {code}: {said[-300:]}"


Written = Callable[[int, tuple[str, ...]], Files]
"""The files that a whole run writes."""


def folder_fault(out: Path, before: Files, one: Run, name: str, code: int | None, written: Written) -> str:
    """What is wrong with the folder after a run of a scenario of this name; nothing: ''."""
    there = state(out)
    if why := listing_fault(out, there) or mine_fault(out):
        return why
    if there == before:
        return "exit code 0, and the old plan" if code == 0 else ""
    if "plan.json" not in there:
        return "exit code 0, and no plan" if code == 0 else lost_fault(out, before)
    if json.loads((out / "plan.json").read_text())["scenario"]["name"] != name:
        return "the old plan beside files of another run, or without its own"
    return mixed_fault(out, there, before, one, written) or names_fault(one, set(there), code, written)


def mixed_fault(out: Path, there: Files, before: Files, one: Run, written: Written) -> str:
    """Files of the run before beside the new plan: those of which the list knows another checksum, too, unless the new
    run writes the same bytes. (It does where a run of as many parts was ended before.)"""
    listed = json.loads((out / LIST).read_text())["files"]
    own = [written(one.parts, way) for way in (("--no-pictures",), one.way)]
    old = sorted(
        name
        for name in there.keys() & before.keys()
        if there[name] == before[name]
        and len(listed[name]) > 1
        and there[name] not in [files.get(name) for files in own]
    )
    return f"old files beside the new plan: {old}" if old else ""


def names_fault(one: Run, there: set[str], code: int | None, written: Written) -> str:
    """The new plan has all its files and no others. Pictures come after it, and what is taken in passing after
    these."""
    least, most = set(written(one.parts, ("--no-pictures",))), set(written(one.parts, one.way))
    passing = "--drive-by" in one.way
    if passing and "drive_by.json" in there:
        least = {name for name in most if not any(fnmatchcase(name, picture) for picture in PICTURES)}
    if code == 0:
        least = most
    if missing := sorted(least - there):
        return f"the new plan without {missing[:5]}"
    other = sorted(there - most - (set(written(one.parts, ())) if passing else set()))
    return f"beside the new plan: {other[:5]}" if other else ""


def plan_into(out: Path, path: Path, way: tuple[str, ...]) -> None:
    line = [sys.executable, "-c", ENTRY, *plan_line(path, out, way)]
    subprocess.run(line, check=True, capture_output=True, timeout=TOO_LONG)


def try_one(one: Run, folder: Path, out: Path, name: str, written: Written) -> str:
    before = state(out)
    code, said = end(one, command(one, scenario(folder, one.parts, name), out))
    return ending_fault(one, code, said) or folder_fault(out, before, one, name, code, written)


class Whole(NamedTuple):
    """A run that nothing ended."""

    files: Files
    """What it wrote."""
    seconds: float


STEPS_OF_A_FILE = 9  # about


def drawn(draw: random.Random, stepwise: bool, whole_run: Callable[[int, tuple[str, ...]], Whole]) -> Run:
    count, way, ending = draw.choice(COUNTS), draw.choice(WAYS), draw.choice(SIGNALS)
    known = whole_run(count, way)
    if stepwise:
        return Run(count, way, ending, -1.0, draw.randrange(STEPS_OF_A_FILE * len(known.files)))
    return Run(count, way, ending, draw.uniform(0.2, 1.1 * known.seconds))


def whole_runs(folder: Path) -> Callable[[int, tuple[str, ...]], Whole]:
    """Whole runs into folders of their own, each made when it is first asked for."""

    @functools.cache
    def whole_run(count: int, way: tuple[str, ...]) -> Whole:
        place = folder / f"whole_{count}{''.join(way)}"
        begun = time.monotonic()
        plan_into(place, scenario(folder, count, "whole"), way)
        return Whole(state(place), time.monotonic() - begun)

    return whole_run


def sound_folder(folder: Path, name: str) -> Path:
    """A new folder with a plan and a file of somebody's."""
    out = folder / name
    plan_into(out, scenario(folder, COUNTS[0], "first"), ())
    (out / MINE).write_text("mine")
    return out


def after_all(folder: Path, out: Path) -> str:
    """A whole run into the folder of those that were ended leaves a plan that holds, and nothing half written."""
    last = scenario(folder, COUNTS[0], "last")
    plan_into(out, last, ())
    verdict = mg.verify_plan(out / "plan.json", scenario=last)
    left = [str(path.relative_to(folder)) for path in drafts(out)]
    return "" if verdict.ok and not left else f"the run after all of them: {verdict.faults}, left over: {left}"


def runs(folder: Path, tries: int, seed: int) -> Iterator[str]:
    """What is wrong after each run ("": nothing), and after a whole one at the end."""
    draw = random.Random(seed)
    whole_run = whole_runs(folder)
    out = sound_folder(folder, "out")
    for number in range(tries):
        one = drawn(draw, number % 2 == 0, whole_run)
        why = try_one(one, folder, out, f"try {number}", lambda count, way: whole_run(count, way).files)
        yield f"{one}: {why}" if why else ""
        if why:  # the next one begins with a sound folder
            out = sound_folder(folder, f"out_{number}")
    yield after_all(folder, out)


def main() -> int:
    tries = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    made = found = 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for what in ACTS:
            for number, why in small_fills(folder / what, what):
                made += 1
                found += bool(why)
                if why:
                    print(f"{what} at step {number} of a small folder: {why}", flush=True)
        for why in runs(folder, tries, seed) if tries else ():
            made += 1
            found += bool(why)
            if why:
                print(why, flush=True)
    print(f"{made} tries: {found} complaints")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
