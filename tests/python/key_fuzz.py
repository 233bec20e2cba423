"""Every value of a file replaced by wrong ones, every key dropped or misspelt: what is wrong must be refused, with
file and line.

As a script: `key_fuzz.py DOOR [TRIES [SEED]]`, all of them unless TRIES says fewer.
"""

from __future__ import annotations

import copy
import json
import random
import re
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import yaml

import mmgrasp as mg
from field_changes import Harmless, Place, at, pattern
from file_fuzz import made_plan, read_plan_whole
from key_fuzz_tables import (
    ANY_SIGN,
    ASSEMBLIES,
    CAMERAS,
    DROPPED,
    GRIPPERS,
    HAND,
    HAND_TYPES,
    MAPS,
    MISSPELT,
    PIPES,
    PLANS,
    SCENARIOS,
    SIGNED,
    WHOLE,
    WRONG,
)
from mmgrasp._files import ASSETS
from mmgrasp.documents.reading import Document
from mmgrasp.frames.sensors import read_sensors
from mmgrasp.grippers.assembly_file import load_assembly
from mmgrasp.pipes import load_pipe_problem
from mmgrasp.scenario.floor_map import read_floor_map
from mmgrasp.scenario.robot_section import read_arm_of, read_gripper, read_hand_types

SENSORS = {
    "version": 1,
    "sensors": {
        "left": {
            "folder": "left",
            "intrinsics": {"width": 160, "height": 120, "fx": 180.0, "fy": 180.0, "cx": 79.5, "cy": 59.5},
            "range": [0.2, 2.0],
            "depth_scale": 1000,
            "noise": {"model": "stereo", "baseline": 0.05, "disparity_sigma": 0.1},
            "systematic": 0.001,
            "systematic_scale": 0.002,
            "mounted_on": {"link": "tool", "pose": {"xyz": [0.1, 0.0, 0.0], "quat_xyzw": [0, 0, 0, 1]}},
            "poses": "world_to_camera",
            "pose_error": {"translation": 0.001, "rotation": 0.002},
        },
        "right": {"noise": {"model": "polynomial", "constant": 0.001}},
    },
}
"""A sensors file with all that may stand in one."""


def read_map(path: Path) -> object:
    """A map beside its header."""
    (path.parent / "room.pgm").write_bytes(b"P5 8 6 255 " + bytes(8 * 6))
    document = Document(str(path), {"map": str(path), "height": 1.0}, {(): 1})
    return read_floor_map(document.root)


class Door(NamedTuple):
    source: Path | dict[str, Any]
    """A sound file of the kind, or its values."""
    load: Callable[[Path], object]
    sound: Harmless
    """Kinds of changes that leave the file sound, by the pattern of the place, and why; all others must be refused."""


HEADER = {
    "image": "room.pgm",
    "resolution": 0.05,
    "origin": [0.0, 0.0, 0.0],
    "negate": 0,
    "occupied_thresh": 0.65,
    "free_thresh": 0.2,
}
PROFILE = ASSETS / "robots" / "kr6like" / "kr6like.yaml"
JOINTED = ASSETS / "grippers" / "sdhlike" / "sdhlike.yaml"
DOORS: dict[str, Door] = {
    "scenario": Door(ASSETS / "scenarios" / "storeroom.yaml", mg.load_scenario, SCENARIOS),
    "scanned": Door(ASSETS / "scenarios" / "scanned_tray.yaml", mg.load_scenario, SCENARIOS),
    "pipe": Door(ASSETS / "pipes" / "pipe1.yaml", load_pipe_problem, PIPES),
    "assembly": Door(ASSETS / "assemblies" / "pulley.yaml", load_assembly, ASSEMBLIES),
    "profile": Door(PROFILE, lambda path: read_arm_of(str(path)), HAND),
    "gripper": Door(PROFILE, lambda path: read_gripper(str(path)), GRIPPERS),
    "hand": Door(JOINTED, lambda path: read_hand_types(str(path)), HAND_TYPES),
    "sensors": Door(SENSORS, read_sensors, CAMERAS),
    "map": Door(HEADER, read_map, MAPS),
    "plan": Door({}, read_plan_whole, PLANS),
}
"""What reads a kind of file. (The plan is made first.)"""


def places(value: Any, at: Place = ()) -> Iterator[Place]:
    """The place of every value in a document; of long lists the first three."""
    entries = value.items() if isinstance(value, dict) else enumerate(value[:3]) if isinstance(value, list) else ()
    for key, entry in entries:
        yield from places(entry, (*at, key))
    if at:
        yield at


def changed(document: Any, place: Place, value: Any) -> Any:
    out = copy.deepcopy(document)
    inner = at(out, place[:-1])
    if value is DROPPED:
        del inner[place[-1]]
    elif value is MISSPELT:
        inner[f"{place[-1]}x"] = inner.pop(place[-1])
    else:
        inner[place[-1]] = value
    return out


def tries(document: Any) -> list[tuple[Place, str]]:
    """Places and kinds of changes; entries of lists have no key that could be misspelt."""
    return [(p, kind) for p in places(document) for kind in WRONG if kind != "misspelt" or isinstance(p[-1], str)]


def document_of(door: str) -> Any:
    source = DOORS[door].source
    if door == "plan":
        return json.loads(json.dumps(made_plan()))
    return source if isinstance(source, dict) else yaml.safe_load(source.read_text())


def is_sound(document: Any, place: Place, kind: str) -> bool:
    """Whether the change makes another sound value of a sound one by the rules: the same again, another number, or one
    of another sign."""
    was, new = at(document, place), WRONG[kind]
    if was == new and type(was) is type(new):
        return True
    if isinstance(was, bool):
        return kind == "true"
    if not isinstance(was, int | float):
        return False
    names = [key for key in place if isinstance(key, str)][-2:]
    is_whole = isinstance(was, int) and names[-1] in WHOLE
    return not is_whole and (kind == "0.5" or (kind in ANY_SIGN.split(", ") and bool(SIGNED & {*names})))


def listed(place: Place, sound: Harmless) -> list[tuple[str, str]]:
    """Kinds of changes and patterns under which they are listed; the pattern may have the last index
    (`turned[][0]`)."""
    exact = f"{pattern(place[:-1])}[{place[-1]}]"
    return [
        (kind, name) for name in (pattern(place), exact) for kind in sound.get(name, ("", ""))[0].split(", ") if kind
    ]


class Result(NamedTuple):
    taken: int
    refused: int
    complaints: list[str]
    needed: set[tuple[str, str]]
    """Kinds and patterns of those that are listed as sound and were read."""

    def __str__(self) -> str:
        wrong = len(self.complaints)
        return f"{self.taken + self.refused} tries: {self.taken} read, {self.refused} refused, {wrong} complaints"


def message_fault(error: mg.Error, file: Path) -> str:
    """What a message lacks: file and line (JSON has no lines, but names), and no more than a terminal shows."""
    line = "" if file.suffix == ".json" else r"\d+: "
    if not re.search(rf"{re.escape(file.name)}:{line or ' '}", str(error)):
        return f"refused without file and line: {error}"
    return "refused with an escape for the terminal" if "\x1b" in str(error) else ""


def write(file: Path, document: Any) -> None:
    is_json = file.suffix == ".json"
    file.write_text(json.dumps(document) if is_json else yaml.safe_dump(document, sort_keys=False, allow_unicode=True))


def judge(door: str, file: Path, is_listed: bool) -> tuple[bool, str]:
    """Whether the file was read, and what is wrong about it."""
    try:
        DOORS[door].load(file)
    except mg.Error as error:
        return False, message_fault(error, file)
    except Exception as error:
        return False, f"{type(error).__name__}: {error}"
    return True, "" if is_listed else "was read"


def fuzz(door: str, folder: Path, most: int | None = None, seed: int = 1) -> Result:
    """What became of files with one change each."""
    document = document_of(door)
    file = folder / ("changed.json" if door == "plan" else "changed.yaml")
    write(file, document)
    DOORS[door].load(file)  # what is changed is sound
    chosen = tries(document)
    if most is not None:
        chosen = random.Random(seed).sample(chosen, most)
    taken = 0
    complaints, needed = [], set()
    for place, kind in chosen:
        write(file, changed(document, place, WRONG[kind]))
        known = [entry for entry in listed(place, DOORS[door].sound) if entry[0] == kind]
        by_rule = is_sound(document, place, kind)
        is_read, why = judge(door, file, bool(known) or by_rule)
        taken += is_read
        needed.update(known if is_read else [])
        if why:
            complaints.append(f"{door}: {pattern(place)} {place[-1]!r}: {kind}: {why}")
    return Result(taken, len(chosen) - taken, complaints, needed)


def unneeded(door: str, needed: set[tuple[str, str]]) -> list[str]:
    """Entries of the list of which no change of the document was read; those of places that it does not have are left out, and
    those that are judged where a door before this one has the same list and such a place."""
    sound = DOORS[door].sound
    there = {entry for place in places(document_of(door)) for entry in listed(place, sound)}
    for other in DOORS:
        if other == door:
            break
        if DOORS[other].sound is sound:
            there -= {entry for place in places(document_of(other)) for entry in listed(place, sound)}
    return [f"{door}: {name}: {kind}: listed as sound, but refused" for kind, name in sorted(there - needed)]


def main() -> int:
    door, *numbers = sys.argv[1:]
    most, seed = [*map(int, numbers), None, None][:2]
    with tempfile.TemporaryDirectory() as folder:
        result = fuzz(door, Path(folder), most, seed or 1)
    wrong = result.complaints + (unneeded(door, result.needed) if most is None else [])
    print("\n".join([*wrong, str(result)]))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
