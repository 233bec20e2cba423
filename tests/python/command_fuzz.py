"""Command lines put together at random: a wrong one is refused in a line, with an exit code of its own, and replaces nothing. As a script: `command_fuzz.py [TRIES [SEED]]`."""

from __future__ import annotations

import argparse
import os
import random
import subprocess
import sys
import tempfile
from pathlib import Path

from mmgrasp._files import ASSETS
from mmgrasp.cli.arguments import build_parser

TOO_LONG = 90  # [s]
LEFT_OUT = ("reproduce", "bench")  # they take hours, or data that is not there
WORDS = [
    *("", "x", "-1", "0", "1", "1e3", "nan", "inf", "-inf", "1e999", "0x10", "1_0", "\u0663", "'; rm", "a" * 5000),
    *("\u202e", "\U0001f600", "=", "a=b", "--", "-", "..", "/", "~nobody", "asset:", "asset:../../x", "tcp://a:1"),
    *("[bold]", "%s", "{}", "\n", "kr6like", "fetchlike", "tiago", "storeroom", "pulley", "pipe1"),
    *(str(path) for path in sorted((ASSETS / "scenarios").glob("*.yaml"))),
]


def odd_files(folder: Path) -> list[Path]:
    """Files and folders that no command can read, or should."""
    (folder / "empty").write_text("")
    (folder / "folder").mkdir()
    (folder / "bytes").write_bytes(bytes(range(256)) * 20)
    (folder / "link").symlink_to(folder / "nowhere")
    os.mkfifo(folder / "pipe")
    (folder / "deep").write_text("[" * 5000)
    (folder / "some.yaml").write_text("a: &a [1, 2]\nb: *a\n")
    (folder / "some.json").write_text('{"format": "mmgrasp-plan", "version": 4}')
    return [*folder.iterdir(), folder / "nowhere"]


def command_line(name: str, parser: argparse.ArgumentParser, draw: random.Random, words: list[str]) -> list[str]:
    """One command with its needed arguments and some of the others, each a word of the list; what it writes goes to a place of its own."""
    line = [name]
    for action in parser._actions:
        if isinstance(action, argparse._HelpAction):
            continue
        if action.option_strings and (action.required or draw.random() < 0.25):
            line.append(draw.choice(list(action.option_strings)))
        elif action.option_strings:
            continue
        many = action.nargs if isinstance(action.nargs, int) else 1 if action.nargs is None else draw.randint(0, 3)
        for _ in range(many):
            known = list(action.choices or ())
            line.append(str(draw.choice(known if known and draw.random() < 0.7 else words)))
        if action.dest == "out" and many:
            line[-1] = f"out_{draw.randrange(10**9)}"
    return line


def complaint(line: list[str], folder: Path) -> str:
    """What is wrong with how the command ended; nothing: ''."""
    command = [sys.executable, "-m", "mmgrasp", *line]
    try:
        done = subprocess.run(command, capture_output=True, timeout=TOO_LONG, cwd=folder, stdin=subprocess.DEVNULL)
    except subprocess.TimeoutExpired:
        return f"took more than {TOO_LONG} s"
    said = done.stderr.decode(errors="replace")
    if "Traceback" in said or done.returncode not in (0, 1, 2, 3):
        return f"exit code {done.returncode}: {said[-500:]}"
    if done.returncode and not said.strip() and not done.stdout:
        return f"exit code {done.returncode} without a word"
    if (folder / "empty").read_bytes() or (folder / "bytes").stat().st_size != 256 * 20:
        return "replaced a file"
    return ""


def fuzz(folder: Path, tries: int, seed: int) -> list[tuple[list[str], str]]:
    """Command lines that somebody would complain of, and why."""
    groups = [a for a in build_parser()._actions if isinstance(a, argparse._SubParsersAction)]
    commands = {name: parser for name, parser in groups[0].choices.items() if name not in LEFT_OUT}
    words = [*WORDS, *(str(path) for path in odd_files(folder))]
    draw = random.Random(seed)
    found = []
    for _ in range(tries):
        name = draw.choice(sorted(commands))
        line = command_line(name, commands[name], draw, words)
        if why := complaint(line, folder):
            found.append((line, why))
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
