"""Command lines put together at random: a wrong one is refused in a line, with an exit code of its own, and replaces
nothing.

As a script: `command_fuzz.py [TRIES [SEED]]`.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import random
import shutil
import stat
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from mmgrasp._files import ASSETS, PNG
from mmgrasp.cli.arguments import build_parser
from plan_by_hand import plan_by_hand

TOO_LONG = 90  # [s]
LEFT_OUT = ("reproduce", "bench")  # they take hours, or data that is not there
OUTPUTS = ("out", "png", "film", "write_srdf", "trajectories")
"""What a command writes to."""
WORDS = [
    *("", "x", "-1", "0", "1", "1e3", "nan", "inf", "-inf", "1e999", "0x10", "1_0", "\u0663", "'; rm", "a" * 5000),
    *("\u202e", "\U0001f600", "=", "a=b", "--", "-", "..", "/", "~nobody", "asset:", "asset:../../x", "tcp://a:1"),
    *("[bold]", "%s", "{}", "\n", "kr6like", "fetchlike", "tiago", "storeroom", "pulley", "pipe1"),
]
NEVER_WRITTEN_TO = ("/",)  # where a command would do as it is told


# --- where it runs ----------------------------------------------------------------------------------------------------
def odd_files(folder: Path) -> list[Path]:
    """Files and folders that no command can read, or should; and a few that it can."""
    (folder / "empty").write_text("")
    (folder / "folder").mkdir()
    (folder / "folder" / "plan.json").write_text("somebody's")
    (folder / "bytes").write_bytes(bytes(range(256)) * 20)
    (folder / "link").symlink_to(folder / "nowhere")
    (folder / "link to bytes").symlink_to(folder / "bytes")
    os.mkfifo(folder / "pipe")
    (folder / "deep").write_text("[" * 5000)
    (folder / "some.yaml").write_text("a: &a [1, 2]\nb: *a\n")
    (folder / "some.json").write_text('{"format": "mmgrasp-plan", "version": 4}')
    (folder / "plan.json").write_text(json.dumps(plan_by_hand()))
    (folder / "picture.png").write_bytes(PNG + b"an earlier one")
    (folder / "film.gif").write_bytes(b"GIF89a an earlier one")
    return [*folder.iterdir(), folder / "nowhere"]


class Place(NamedTuple):
    """A folder with all that a command may touch."""

    root: Path

    @property
    def work(self) -> Path:
        """Where commands run."""
        return self.root / "work"

    def make(self) -> list[str]:
        """Fills the folder; paths that command lines may name. Shipped files lie there as copies."""
        for name in ("work", "tmp", "cache"):
            (self.root / name).mkdir()
        shutil.copytree(ASSETS, self.root / "assets")
        shipped = sorted((self.root / "assets").rglob("*.yaml")) + sorted((self.root / "assets").rglob("*.urdf"))
        return [str(path) for path in [*odd_files(self.work), *shipped]]

    def environment(self) -> dict[str, str]:
        cache = {"XDG_CACHE_HOME": str(self.root / "cache"), **os.environ}["XDG_CACHE_HOME"]
        return {**os.environ, "TMPDIR": str(self.root / "tmp"), "XDG_CACHE_HOME": cache}

    def files(self) -> dict[str, str]:
        """All that lies there, but for the cache, and in the shipped assets: the kind of each, and of files size and
        SHA-256."""
        roots = [self.root / name for name in ("work", "tmp", "assets")]
        return {str(path): _what(path) for root in [*roots, ASSETS] for path in sorted(root.rglob("*"))}


def _what(path: Path) -> str:
    found = os.lstat(path)
    if stat.S_ISLNK(found.st_mode):
        return f"a link to {os.readlink(path)}"
    if not stat.S_ISREG(found.st_mode):
        return "a folder" if stat.S_ISDIR(found.st_mode) else "something else"
    return f"{found.st_size} bytes, {hashlib.sha256(path.read_bytes()).hexdigest()}"


# --- command lines ----------------------------------------------------------------------------------------------------
class Line(NamedTuple):
    words: list[str]
    outputs: list[str]
    """Where it is told to write."""


def command_line(name: str, parser: argparse.ArgumentParser, draw: random.Random, words: list[str]) -> Line:
    """One command with its needed arguments and some of the others, each a word of the list."""
    line = Line([name], [])
    for action in parser._actions:
        if isinstance(action, argparse._HelpAction):
            continue
        is_asked = action.required or draw.random() < 0.25 or (name, action.dest) == ("view", "png")  # no browser
        if action.option_strings and not is_asked:
            continue
        if action.option_strings:
            line.words.append(draw.choice(list(action.option_strings)))
        many = action.nargs if isinstance(action.nargs, int) else 1 if action.nargs is None else draw.randint(0, 3)
        line.words.extend(_value(action, draw, words) for _ in range(many))
        if action.dest in OUTPUTS:
            line.outputs.extend(line.words[len(line.words) - many :])
    if name == "init" and not line.outputs:
        line.outputs.append("scenario.yaml")
    return line


def _value(action: argparse.Action, draw: random.Random, words: list[str]) -> str:
    if action.dest in OUTPUTS:
        fresh = draw.random() < 0.5
        return f"out_{draw.randrange(10**9)}" if fresh else draw.choice([w for w in words if w not in NEVER_WRITTEN_TO])
    known = list(action.choices or ())
    return str(draw.choice(known if known and draw.random() < 0.7 else words))


# --- what is wrong ----------------------------------------------------------------------------------------------------
def complaint(line: Line, place: Place, own: set[str]) -> str:
    """What is wrong with how the command ended, or with what it wrote; nothing: ''. `own`: files that commands wrote
    before, which later ones may replace."""
    before = place.files()
    command = [sys.executable, "-m", "mmgrasp", *line.words]
    try:
        done = subprocess.run(
            command,
            capture_output=True,
            timeout=TOO_LONG,
            cwd=place.work,
            stdin=subprocess.DEVNULL,
            env=place.environment(),
        )
    except subprocess.TimeoutExpired:
        return f"took more than {TOO_LONG} s"
    said = done.stderr.decode(errors="replace")
    if "Traceback" in said or done.returncode not in (0, 1, 2, 3, 4):
        return f"exit code {done.returncode}: {said[-500:]}"
    if done.returncode and not said.strip() and not done.stdout:
        return f"exit code {done.returncode} without a word"
    return touched(line.outputs, place, before, place.files(), own, is_refused=done.returncode == 2)


def touched(
    outputs: Iterable[str],
    place: Place,
    before: dict[str, str],
    after: dict[str, str],
    own: set[str],
    *,
    is_refused: bool,
) -> str:
    """What was changed that is not the command's own, or was left by one that was refused."""
    targets = [
        os.path.realpath(place.work / word) for word in outputs if word and "\0" not in word and len(word) < 4000
    ]
    changes = sorted(path for path in before.keys() | after.keys() if before.get(path) != after.get(path))
    for path in changes:
        what = "removed" if path not in after else "made" if path not in before else "replaced"
        shown = os.path.relpath(path, place.root)
        if is_refused:
            return f"was refused, and {what} {shown}"
        if not any(path == target or path.startswith(f"{target}/") or _leads_to(target, path) for target in targets):
            return f"{what} {shown}, which is not where it was told to write"
        if what != "made" and path not in own and not _may_be_replaced(path, before[path], place):
            return f"{what} {shown}, which is somebody's"
    own.update(path for path in changes if path in after)
    return ""


def _leads_to(target: str, path: str) -> bool:
    """Whether the path is a folder that was made on the way to the target."""
    return target.startswith(f"{path}/") and os.path.isdir(path)


def _may_be_replaced(path: str, was: str, place: Place) -> bool:
    """An empty file, or an earlier picture, which a new one takes the place of."""
    earlier = (place.work / "picture.png", place.work / "film.gif")
    return was.startswith("0 bytes") or Path(path) in earlier


def fuzz(folder: Path, tries: int, seed: int) -> list[tuple[list[str], str]]:
    """Command lines that somebody would complain of, and why."""
    groups = [a for a in build_parser()._actions if isinstance(a, argparse._SubParsersAction)]
    commands = {name: parser for name, parser in groups[0].choices.items() if name not in LEFT_OUT}
    place = Place(Path(os.path.realpath(folder)))
    words = [*WORDS, *place.make()]
    draw = random.Random(seed)
    own: set[str] = set()
    found = []
    for _ in range(tries):
        name = draw.choice(sorted(commands))
        line = command_line(name, commands[name], draw, words)
        if why := complaint(line, place, own):
            found.append((line.words, why))
    return found


def main() -> int:
    tries = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    with tempfile.TemporaryDirectory() as folder:
        found = fuzz(Path(folder), tries, int(sys.argv[2]) if len(sys.argv) > 2 else 1)
    for line, why in found:
        print(line, why)
    print(f"{tries} tries: {len(found)} complaints")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
