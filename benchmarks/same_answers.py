"""Do the same seeds still give the same answers, bit for bit? Run this before and after a move or a rename.

    python benchmarks/same_answers.py --write before.json       # with the old build on the path
    python benchmarks/same_answers.py --against before.json     # with the new one
    python benchmarks/same_answers.py --compare before.json after.json

The calls are those of the folder answers: seeds are fixed, budgets are iterations, and time limits are so generous that no
clock decides. What is hashed is every number of an answer; names of fields and texts are not, so that renaming one changes
nothing. Processor kind and compiler do change last bits: compare builds of one machine.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import platform
import struct
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import suppress
from enum import Enum
from pathlib import Path
from typing import Any

import numpy as np

TIMES = {"seconds", "timings", "stats"}  # what to_dict() holds beside the answer


def pieces(thing: Any) -> Iterator[bytes]:
    """The exact bits of all numbers in a value, each after a letter for its kind; texts are left out."""
    if thing is None:
        yield b"n"
    elif isinstance(thing, str):
        return
    elif isinstance(thing, bool | np.bool_):
        yield b"b1" if thing else b"b0"
    elif isinstance(thing, Enum):
        yield b"e" + str(thing.value).encode()
    elif isinstance(thing, float | np.floating):
        yield b"f" + struct.pack("<d", thing)
    elif isinstance(thing, np.ndarray):
        kept = np.ascontiguousarray(thing, np.float64 if thing.dtype.kind == "f" else np.int64)
        yield f"a{kept.dtype.kind}{kept.shape}".encode() + kept.tobytes()
    elif isinstance(thing, list | tuple):
        yield f"[{len(thing)}".encode()
        for part in thing:
            yield from pieces(part)
    elif isinstance(thing, dict):
        # A new name may move a field: the values are put in an order of their own.
        values = [value for key, value in thing.items() if key not in TIMES and not isinstance(value, str)]
        yield b"{" + b"".join(sorted(digest(value).encode() for value in values))
    elif hasattr(thing, "__index__"):
        yield b"i" + str(int(thing)).encode()
    elif hasattr(thing, "to_dict"):
        yield from pieces(thing.to_dict())
    else:
        raise TypeError(f"{type(thing).__name__} is no number and has no to_dict(): hand over its fields")


def digest(thing: Any) -> str:
    """SHA-256 over the numbers of a value."""
    total = hashlib.sha256()
    for piece in pieces(thing):
        total.update(struct.pack("<q", len(piece)) + piece)
    return total.hexdigest()


def run(only: list[str], threads: int) -> dict[str, Any]:
    """Makes the calls; returns the content of the file."""
    with tempfile.TemporaryDirectory() as cache:
        os.environ["XDG_CACHE_HOME"] = cache  # nothing from an earlier build is read
        import answers as calls

        import mmgrasp

        print(f"calls of {Path(mmgrasp.__file__).parent}", file=sys.stderr)

        calls.SETTINGS["threads"] = threads
        unknown = sorted(set(only) - calls.CALLS.keys())
        if unknown:
            raise SystemExit(f"--only {' '.join(unknown)}: no such call; there are {' '.join(calls.CALLS)}")
        made = {}
        for name, call in calls.CALLS.items():
            if only and name not in only:
                continue
            begun = time.perf_counter()
            made[name] = answer_of(call, calls.Skipped)
            print(f"{name:28} {time.perf_counter() - begun:6.1f} s  {describe(made[name])}", file=sys.stderr)
        return {"format": "mmgrasp-answers", "version": 1, "machine": platform.platform(), "calls": made}


def answer_of(call: Any, skipped: type[Exception]) -> dict[str, Any]:
    try:
        parts, shown = call()
    except skipped as reason:
        return {"skipped": str(reason)}
    except Exception as error:
        return {"error": f"{type(error).__name__}: {error}"}
    digests = {label: digest(part) for label, part in parts.items()}
    return {"sha256": hashlib.sha256("".join(digests.values()).encode()).hexdigest(), "parts": digests, "shown": shown}


def describe(answer: dict[str, Any]) -> str:
    """One line for people."""
    for key in ("skipped", "error"):
        if key in answer:
            return f"{key}: {answer[key]}"
    values = (
        f"{key} {value:.9g}" if isinstance(value, float) else f"{key} {value}" for key, value in answer["shown"].items()
    )
    return ", ".join(values)


def verdict(name: str, a: dict[str, Any], b: dict[str, Any]) -> tuple[str, str]:
    """same, differs, failed, missing or skipped; and what to say about it."""
    if name not in a or name not in b:
        return "missing", f"only in {'the first' if name in a else 'the second'} file"
    a, b = a[name], b[name]
    if "error" in a or "error" in b:
        return "failed", " -> ".join(describe(x) for x in ([a] if a == b else [a, b]))
    if "skipped" in a or "skipped" in b:
        return "skipped", describe(a if "skipped" in a else b)
    if a["sha256"] == b["sha256"]:
        return "same", describe(a)
    changed = [label for label in a["parts"] | b["parts"] if a["parts"].get(label) != b["parts"].get(label)]
    return "differs", f"in {', '.join(changed)}: {describe(a)} -> {describe(b)}"


def compare(first: dict[str, Any], second: dict[str, Any], only: list[str]) -> int:
    """Prints the table; returns the exit code."""
    a, b = first["calls"], second["calls"]
    rows = {name: verdict(name, a, b) for name in a | b if not only or name in only}
    width = max((len(name) for name in rows), default=0)
    for name, (word, text) in rows.items():
        print(f"{name:{width}}  {word:7}  {text}")
    words = [word for word, _ in rows.values()]
    print(", ".join(f"{words.count(word)} {word}" for word in sorted(set(words))) or "no calls")
    return 0 if rows and set(words) <= {"same", "skipped"} and "same" in words else 1


def read(path: Path) -> dict[str, Any]:
    content = None
    with suppress(json.JSONDecodeError, OSError):
        content = json.loads(path.read_text())
    if not isinstance(content, dict) or content.get("format") != "mmgrasp-answers" or content.get("version") != 1:
        raise SystemExit(f"{path}: is no file that --write has written")
    return content


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--write", type=Path, metavar="FILE", help="run the calls, write the answers")
    parser.add_argument(
        "--against", type=Path, metavar="FILE", help="run the calls, compare with the answers of a file"
    )
    parser.add_argument("--compare", type=Path, nargs=2, metavar=("A", "B"), help="compare two files, run nothing")
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME", help="these calls alone")
    parser.add_argument("--threads", type=int, default=0, help="for calls that take a number of threads; 0: all")
    given = parser.parse_args()
    if given.compare:
        if given.write or given.against:
            parser.error("--compare runs nothing: leave out --write and --against")
        return compare(*(read(path) for path in given.compare), given.only)
    if not (given.write or given.against):
        parser.error("give --write, --against or --compare")
    expected = read(given.against) if given.against else None
    answers = run(given.only, given.threads)
    if given.write:
        given.write.write_text(json.dumps(answers, indent=1) + "\n")
    if expected:
        return compare(expected, answers, given.only)
    return 1 if any("error" in answer for answer in answers["calls"].values()) else 0


if __name__ == "__main__":
    sys.exit(main())
