"""libmmgrasp without one step of its work: for tables of what each step is worth."""

from __future__ import annotations

import json
import re
import subprocess
from collections.abc import Callable
from pathlib import Path


def library_without(name: str, definition: str, concerned: Callable[[Path], bool], build: Path) -> Path:
    """The library with the sources for which `concerned` holds compiled again under a definition; the rest is the build's."""
    return rebuilt(name, build, lambda source, command, _: f"{command} -D{definition}" if concerned(source) else None)


def library_edited(name: str, source: Path, edits: dict[str, str], build: Path) -> Path:
    """The library with pieces of one source replaced, each of which must stand there once."""

    def edited(file: Path, command: str, folder: Path) -> str | None:
        if file != source:
            return None
        text = source.read_text()
        for old, new in edits.items():
            if text.count(old) != 1:
                raise ValueError(f"{source.name} has {text.count(old)} times, instead of once: {old}")
            text = text.replace(old, new)
        copy = folder / source.name
        copy.write_text(text)
        return command.replace(f" -c {source}", f" -c {copy}")

    return rebuilt(name, build, edited)


def rebuilt(name: str, build: Path, changed: Callable[[Path, str, Path], str | None]) -> Path:
    """The library with each source compiled by the command that `changed` makes of its own; None: the build's object."""
    folder = build / "left_out" / name
    folder.mkdir(parents=True, exist_ok=True)
    replaced = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        source = Path(entry["file"])
        command = changed(source, entry["command"], folder)
        if command is None:
            continue
        old = command.split(" -o ")[1].split()[0]
        replaced[old] = str(folder / (source.name + ".o"))
        subprocess.run(command.replace(old, replaced[old]), shell=True, cwd=build, check=True)
    link = subprocess.run(["ninja", "-t", "commands", "mmgrasp"], cwd=build, check=True, capture_output=True, text=True)
    command = next(
        line for line in reversed(link.stdout.splitlines()) if " -shared " in line and "libmmgrasp.so" in line
    )
    library = re.search(r"-o (\S*libmmgrasp\.so\S*)", command)
    assert library is not None
    out = folder / Path(library[1]).name
    command = command.replace(library[0], f"-o {out}").split(" && ")
    command = next(part for part in command if " -shared " in part)
    for old, new in replaced.items():
        command = command.replace(f" {old} ", f" {new} ")
    subprocess.run(command, shell=True, cwd=build, check=True)
    return out
