"""libmmgrasp without one step of its work: for tables of what each step is worth."""

from __future__ import annotations

import json
import re
import subprocess
from collections.abc import Callable
from pathlib import Path


def library_without(name: str, definition: str, concerned: Callable[[Path], bool], build: Path) -> Path:
    """The library with the sources for which `concerned` holds compiled again under a definition; the rest is the build's."""
    folder = build / "left_out" / name
    folder.mkdir(parents=True, exist_ok=True)
    replaced = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        source = Path(entry["file"])
        if not concerned(source):
            continue
        old = entry["command"].split(" -o ")[1].split()[0]
        replaced[old] = str(folder / (source.name + ".o"))
        command = entry["command"].replace(old, replaced[old]) + f" -D{definition}"
        subprocess.run(command, shell=True, cwd=build, check=True)
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
