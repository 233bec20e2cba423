"""What calls of the binary module need to be short, and which of their numbers may be infinite (number_walk.py)."""

from __future__ import annotations

import functools
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import mmgrasp as mg
from argument_objects import ARM, PASSED, WHOLE_BODY, occupancy_map, sdf_map
from mmgrasp.reproduce.drive_by import GOAL, START, whole_body

# Numbers that may be infinite: no limit, no bound, nothing farther away.
UNBOUNDED = {
    "time_limit",
    "max_range",
    "truncation",
    "online_limit",
    "tie_time_limit",
    "farthest",
    "payload",
}


@functools.cache
def folder() -> Path:
    return Path(tempfile.mkdtemp())


def saved(name: str, save: Callable[[Path], Any]) -> Path:
    path = folder() / name
    if not path.exists():
        save(path)
    return path


def drive() -> dict[str, Any]:
    robot, group = whole_body()
    return {
        "robot": robot, "group": group, "world": mg.World(), "start": START, "tasks": [mg.DriveByTask(PASSED)],
        "goal": GOAL, "waypoints": 8, "iterations": 20, "collisions": False,
    }  # fmt: skip


def known_drive() -> dict[str, Any]:
    given = drive()
    del given["robot"], given["start"], given["goal"]
    return {**given, "times": [0.0, 1.0, 2.0], "positions": [START, START, GOAL], "task_times": [1.0]}


SMALL_DATABASE = {"samples": 1000, "threads": 1}
SMALL_MAP = {"upper": (1, 1, 2), "voxel": 1.0, "poses": 2, "threads": 1}
SHORT_MOTION = {"time_limit": 0.5}

# Keywords that make a call short, or that its numbers mean nothing without.
QUICK: dict[str, Callable[[], dict[str, Any]]] = {
    "CapabilityMap.build": lambda: dict(SMALL_MAP),
    "CapabilityMap.slice": lambda: {"axis": "z"},
    "ReachDatabase.build": lambda: dict(SMALL_DATABASE),
    "ReachDatabase.build_to": lambda: {**SMALL_DATABASE, "path": folder() / "built"},
    "ReachDatabase.build_parts": lambda: {**SMALL_DATABASE, "folder": folder() / "parts", "parts": [0]},
    "ReachDatabase.load_or_build": lambda: {**SMALL_DATABASE, "cache_dir": folder() / "cache"},
    "Roadmap.build": lambda: {"vertices": 20},
    "IkSeedDatabase.load": lambda: {
        "group": WHOLE_BODY, "path": saved("seeds.npz", lambda path: mg.base.IkSeedDatabase(WHOLE_BODY).save(path))
    },
    "ProbabilisticSdf.load": lambda: {"path": saved("map.sdf", lambda path: sdf_map().save(path))},
    "OccupancyMap.load": lambda: {"path": saved("map.ot", lambda path: occupancy_map().save(path))},
    "plan_drive_by": drive,
    "shorten_drive_by": known_drive,
    "plan_manipulation": lambda: {"time_limit": 0.5, "vertices": 50},
    "plan_motion": lambda: {"group": ARM, "world": mg.World(), "goal": ARM.lower, **SHORT_MOTION},
    "plan_platform_locations": lambda: {"time_limit": 0.5, "samples": 2},
    "solve_set_cover": lambda: {"elements": 1, "sets": [[0]], "time_limit": 1.0},
    "optimize_grasp": lambda: {"max_evaluations": 20},
    "segment_mesh": lambda: {"faces": 500},
    "next_view": lambda: {"candidates": 2, "draws": 1, "max_width": 16, "samples": 5},
}  # fmt: skip
