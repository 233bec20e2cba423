"""Every value of a YAML file replaced by wrong ones, every key dropped or misspelt. As a script: `key_fuzz.py DOOR [TRIES [SEED]]`, all of them unless TRIES says fewer."""

from __future__ import annotations

import copy
import random
import re
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import yaml

import mmgrasp as mg
from mmgrasp._files import ASSETS
from mmgrasp.documents.reading import Document
from mmgrasp.frames.sensors import read_sensors
from mmgrasp.grippers.assembly_file import load_assembly
from mmgrasp.pipes import load_pipe_problem
from mmgrasp.scenario.floor_map import read_floor_map
from mmgrasp.scenario.robot_section import read_gripper

WRONG: list[Any] = [
    *(None, True, "", "x", "\x1b[31m", "a" * 300, -1, 0, 0.5, 1e7, -1e-9, 1e-300, 1e300, float("nan"), float("inf"), 10**400),
    *([], [1, 2], [[True, "1"]], {}, {"a": 1}),
]  # fmt: skip
DROPPED, MISSPELT = object(), object()

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


DOORS: dict[str, tuple[Path | dict[str, Any], Callable[[Path], object]]] = {
    "scenario": (ASSETS / "scenarios" / "storeroom.yaml", mg.load_scenario),
    "scanned": (ASSETS / "scenarios" / "scanned_tray.yaml", mg.load_scenario),
    "pipe": (ASSETS / "pipes" / "pipe1.yaml", load_pipe_problem),
    "assembly": (ASSETS / "assemblies" / "pulley.yaml", load_assembly),
    "profile": (ASSETS / "robots" / "kr6like" / "kr6like.yaml", lambda path: read_gripper(str(path))),
    "sensors": (SENSORS, read_sensors),
    "map": (
        {
            "image": "room.pgm",
            "resolution": 0.05,
            "origin": [0.0, 0.0, 0.0],
            "negate": 0,
            "occupied_thresh": 0.65,
            "free_thresh": 0.2,
        },
        read_map,
    ),
}
"""What reads a kind of YAML file, and a sound file of the kind, or its values."""

Place = tuple[str | int, ...]


def places(value: Any, at: Place = ()) -> Iterator[Place]:
    """The place of every value in a document; of long lists the first three."""
    entries = value.items() if isinstance(value, dict) else enumerate(value[:3]) if isinstance(value, list) else ()
    for key, entry in entries:
        yield from places(entry, (*at, key))
    if at:
        yield at


def changed(document: Any, place: Place, value: Any) -> Any:
    out = copy.deepcopy(document)
    inner = out
    for key in place[:-1]:
        inner = inner[key]
    if value is DROPPED:
        del inner[place[-1]]
    elif value is MISSPELT:
        inner[f"{place[-1]}x"] = inner.pop(place[-1])
    else:
        inner[place[-1]] = value
    return out


def tries(document: Any) -> list[tuple[Place, Any]]:
    kinds = [DROPPED, *WRONG]
    return [(p, v) for p in places(document) for v in ([*kinds, MISSPELT] if isinstance(p[-1], str) else kinds)]


def fuzz(door: str, folder: Path, most: int | None = None, seed: int = 1) -> tuple[int, int]:
    """How many changed files were read, and how many refused with a message that names file and line and has nothing for a terminal in it. Anything else is raised."""
    source, load = DOORS[door]
    document = source if isinstance(source, dict) else yaml.safe_load(source.read_text())
    chosen = tries(document)
    if most is not None:
        chosen = random.Random(seed).sample(chosen, most)
    file = folder / "changed.yaml"
    taken = refused = 0
    for place, value in chosen:
        file.write_text(yaml.safe_dump(changed(document, place, value), sort_keys=False, allow_unicode=True))
        try:
            load(file)
            taken += 1
        except mg.Error as error:
            assert re.search(rf"{re.escape(file.name)}:\d+: ", str(error)), (place, value, str(error))
            assert "\x1b" not in str(error), (place, value)
            refused += 1
        except Exception as error:
            raise AssertionError(f"{door}: {place} = {value!r}") from error
    return taken, refused


def main() -> int:
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        most = int(sys.argv[2]) if len(sys.argv) > 2 else None
        taken, refused = fuzz(sys.argv[1], Path(folder), most, int(sys.argv[3]) if len(sys.argv) > 3 else 1)
    print(f"{taken + refused} tries: {taken} read, {refused} refused")
    return 0


if __name__ == "__main__":
    sys.exit(main())
