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
from mmgrasp._files import ASSETS
from mmgrasp.documents.reading import Document
from mmgrasp.frames.sensors import read_sensors
from mmgrasp.grippers.assembly_file import load_assembly
from mmgrasp.pipes import load_pipe_problem
from mmgrasp.scenario.floor_map import read_floor_map
from mmgrasp.scenario.robot_section import read_arm_of, read_gripper

DROPPED, MISSPELT = object(), object()
WRONG: dict[str, Any] = {
    **{"null": None, "true": True, "no text": "", "a word": "x", "an escape": "\x1b[31m", "a long text": "a" * 300},
    **{"-1": -1, "0": 0, "0.5": 0.5, "1e7": 1e7, "-1e-9": -1e-9, "1e-300": 1e-300, "1e300": 1e300, "10**400": 10**400},
    **{"nan": float("nan"), "inf": float("inf"), "no entries": [], "two numbers": [1, 2]},
    **{"texts in a row": [[True, "1"]], "no keys": {}, "another key": {"a": 1}},
    **{"dropped": DROPPED, "misspelt": MISSPELT},
}  # fmt: skip
"""What a value becomes, by the name of the kind."""

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
ANY_SIGN = "-1, 0, -1e-9, 1e-300"
NO_AMOUNT = "0, 1e-300"
SIGNED = {
    "xyz",
    "rpy",
    "quat_xyzw",
    "start",
    "goal",
    "home",
    "joints",
    "closed",
    "open",
    "origin",
    "centre",
    "axis",
    "angle",
}
"""Coordinates, angles, and what joints stand at: of any sign, or 0. All other numbers are amounts."""
WHOLE = {
    "version",
    "grid",
    "targets",
    "seed",
    "samples",
    "max_evaluations",
    "nodes",
    "node",
    "section",
    "poses",
    "width",
    "height",
    "negate",
}
"""What is counted: there is no half of it."""
DEFAULT, SEVERAL, NONE, NAME = "has a default", "one of several", "there may be none", "any name will do"

HAND: Harmless = {
    "gripper.approach[]": ("-1, -1e-9, 1e-300", "a direction: backwards, or a rounding beside it"),
    "gripper.closing[]": ("-1, -1e-9, 1e-300", "a direction, as approach"),
    "gripper.clearance": (f"{NO_AMOUNT}, dropped", NONE),
    "gripper.joints": ("no entries", "fingers that do not move"),
    "gripper.joints[]": ("dropped", SEVERAL),
}
SCENARIOS: Harmless = {
    **HAND,
    "name": ("a word", NAME),
    **{f"robot.base_limits{key}": ("no keys, dropped" if not key else "dropped", DEFAULT)
       for key in ("", ".linear_velocity", ".angular_velocity", ".linear_acceleration", ".angular_acceleration")},
    "robot.joints": ("no keys, dropped", "joints of which nothing is said stand at 0"),
    "robot.joints.head_pan_joint": ("dropped", "stands at 0"),
    "robot.joints.head_tilt_joint": ("dropped", "stands at 0"),
    "place_region.drop_height": (f"{NO_AMOUNT}, dropped", NONE),
    "positioning_uncertainty": (NO_AMOUNT, "a base that arrives exactly"),
    "obstacles": ("no entries, dropped", NONE),
    "obstacles[]": ("dropped", SEVERAL),
    "obstacles[].name": ("a word", NAME),
    "obstacles[].pose": ("dropped", "stands where the world begins"),
    "trays[]": ("dropped", SEVERAL),
    "trays[].name": ("a word", NAME),
    "trays[].parts.grid": ("two numbers", "another grid"),
    "trays[].targets": ("no entries, two numbers, dropped", "no part, others, or all"),
    "trays[].targets[]": ("dropped", SEVERAL),
    "trays[].scan.rendered.parts[]": ("dropped", SEVERAL),
    "trays[].scan.rendered.parts[].xyz": ("two numbers", "stands on the tray's floor"),
    "trays[].scan.rendered.parts[].rpy": ("dropped", "not turned"),
    "trays[].scan.rendered.noise": ("dropped", DEFAULT),
    "trays[].scan.rendered.seed": ("0, dropped", DEFAULT),
    "options": ("no keys, dropped", DEFAULT),
    "options.grid_resolution": ("dropped", DEFAULT),
    "options.seed": ("0, dropped", DEFAULT),
    "reach": ("no keys, dropped", DEFAULT),
    "reach.samples": ("dropped", DEFAULT),
}  # fmt: skip
PIPES: Harmless = {
    "name": ("a word", NAME),
    "structure.nodes[][]": (ANY_SIGN, "a coordinate"),
    "structure.sections[].nodes[]": ("0", "another node"),
    "structure.inner_diameter": (f"{NO_AMOUNT}, dropped", "a rod"),
    "structure.loads": ("no entries, dropped", NONE),
    "structure.loads[]": ("dropped", SEVERAL),
    "structure.loads[].node": ("0", "another node"),
    "structure.loads[].mass": (NO_AMOUNT, NONE),
    "start.rpy": ("dropped", "not turned"),
    "path.segments[]": ("dropped", SEVERAL),
    "path.segments[].line.to.rpy": ("dropped", "not turned"),
    "obstacles": ("no entries, dropped", NONE),
    "obstacles[]": ("dropped", SEVERAL),
    "obstacles[].name": ("a word", NAME),
    "obstacles[].pose": ("dropped", "stands where the world begins"),
    "preferences": ("no keys, dropped", DEFAULT),
    "preferences.comparison": ("dropped", DEFAULT),
    "limits": ("no keys, dropped", DEFAULT),
    "limits.stress": ("1e7, dropped", "a pressure [Pa] may be so large; has a default"),
    "limits.sag": ("dropped", DEFAULT),
    "timing": ("no keys, dropped", DEFAULT),
    "timing.speed": ("dropped", DEFAULT),
    "timing.acceleration": ("dropped", DEFAULT),
    "compare": ("no entries, dropped", NONE),
    "compare[]": ("dropped", SEVERAL),
    "compare[].section": ("0", "another section"),
    "compare[].length": (NO_AMOUNT, "where the section begins"),
    "options": ("no keys, dropped", DEFAULT),
    "options.max_evaluations": ("dropped", DEFAULT),
    "options.seed": ("0, dropped", DEFAULT),
}
ASSEMBLIES: Harmless = {
    "name": ("a word", NAME),
    "parts[].pose": ("dropped", "stands where the assembly begins"),
    "parts[].turned[]": ("two numbers, dropped", "another corner, or one less"),
    "parts[].turned[][0]": (NO_AMOUNT, "a corner on the axis"),
    "parts[].turned[][1]": (ANY_SIGN, "a height along the axis"),
    "order[]": ("dropped", SEVERAL),
    "order[].from": ("dropped", "stands there from the beginning"),
    "actuators[]": ("dropped", SEVERAL),
    "actuators[].name": ("a word", NAME),
    "fingers": ("no keys, dropped", DEFAULT),
    **{f"fingers.{key}": ("dropped", DEFAULT) for key in ("thickness", "shortest", "longest", "min_contact")},
    "fingers.width": ("0.5, dropped", "a length; has a default"),
    "fingers.clearance": (f"{NO_AMOUNT}, dropped", NONE),
}
CAMERAS: Harmless = {
    "sensors.left": ("no keys, dropped, misspelt", "cameras have names of their own, and all of one has a default"),
    "sensors.left.folder": (
        "a word, an escape, a long text, dropped",
        "a folder is looked for when its frames are read",
    ),
    "sensors.left.intrinsics.cx": (NO_AMOUNT, "the middle may lie at the border"),
    "sensors.left.intrinsics.cy": (NO_AMOUNT, "the middle may lie at the border"),
    "sensors.left.range": ("two numbers, dropped", "another range; has a default"),
    "sensors.left.depth_scale": ("dropped", DEFAULT),
    "sensors.left.noise": ("dropped", DEFAULT),
    "sensors.left.systematic": (f"{NO_AMOUNT}, dropped", NONE),
    "sensors.left.systematic_scale": (f"{NO_AMOUNT}, dropped", NONE),
    "sensors.left.mounted_on": ("dropped", "poses are the camera's"),
    "sensors.left.mounted_on.link": ("a word", "a link of a robot that is not known here"),
    "sensors.left.mounted_on.pose.quat_xyzw": ("dropped", "not turned"),
    "sensors.left.poses": ("dropped", DEFAULT),
    "sensors.left.pose_error": ("no keys, dropped", NONE),
    "sensors.left.pose_error.translation": (f"{NO_AMOUNT}, dropped", NONE),
    "sensors.left.pose_error.rotation": (f"{NO_AMOUNT}, dropped", NONE),
    "sensors.right": ("no keys, dropped, misspelt", "as sensors.left"),
    "sensors.right.noise": ("dropped", DEFAULT),
    "sensors.right.noise.constant": ("dropped", DEFAULT),
}
MAPS: Harmless = {"free_thresh": (NO_AMOUNT, "a cell is free when nothing speaks against it")}


def each(patterns: str, kinds: str, reason: str) -> Harmless:
    """The same about several places."""
    return dict.fromkeys(patterns.split(), (kinds, reason))


RECORD = "-1, 0, 0.5, 1e7, -1e-9, 1e-300, 1e300, dropped, misspelt"
# What is read of a plan has its form; what it says is for the check (mutation_shares.py).
PLANS: Harmless = {
    **each(
        """
        scenario.name scenario.source scenario.robot.urdf scenario.robot.srdf scenario.robot.urdfs[].urdf
        scenario.arm.joints[] scenario.robot.links[].name scenario.robot.links[].parent_link scenario.arm.tip_link
        scenario.gripper.tool_link scenario.gripper.joints[].name scenario.obstacles[].name scenario.parts[].name
        regions[].explanations[].part picks[].tray
        """,
        "a word, an escape, a long text",
        "a text: what it names is looked for by the check",
    ),
    **each(
        """
        scenario.robot.urdfs[].origin scenario.robot.urdfs[].prefix scenario.robot.urdfs[].parent_link
        """,
        "no text, a word, an escape, a long text",
        "a text, or none for the first robot",
    ),
    "scenario.gripper.finger_links[]": ("a word, an escape, a long text, dropped", "a text; one of several"),
    **each("scenario.robot.urdfs[].mesh_files scenario.robot.base_limits premises.headings", "no keys", NONE),
    **each("scenario.other_joints scenario.reach premises.database", "no keys, another key", "names of their own"),
    **each(
        """
        scenario.robot.links scenario.robot.links[].shapes scenario.robot.meshes scenario.gripper.joints
        scenario.gripper.finger_links scenario.obstacles scenario.parts[].grasps regions[].explanations regions
        intersections[].trays too_small_intersections stops[].trays route picks[].motions obstructions
        drive_by.motions
        """,
        "no entries",
        NONE,
    ),
    **each(
        """
        scenario.robot.links[].shapes[] scenario.robot.links[] scenario.gripper.joints[] scenario.obstacles[]
        scenario.parts[].grasps[] scenario.parts[] regions[].cells.0[] regions[].cells.1[] regions[].explanations[]
        regions[] intersections[].trays[] stops[].trays[] route[].poses[] route[] picks[].motions[] drive_by.motions[]
        """,
        "dropped",
        SEVERAL,
    ),
    **each(
        """
        scenario.robot.base_limits.linear_velocity scenario.robot.base_limits.angular_velocity
        scenario.robot.base_limits.linear_acceleration scenario.robot.base_limits.angular_acceleration
        scenario.robot.base_limits.workspace scenario.robot.base_limits.wheel_separation scenario.arrival_covariance
        stops[].arrivals drive_by.motions[].begins drive_by.motions[].ends drive_by
        """,
        "dropped",
        DEFAULT,
    ),
    **each(
        """
        scenario.gripper.approach[] scenario.gripper.closing[] scenario.arrival_covariance[][]
        scenario.trays[].headings[] grid.headings[] stops[].pose[] picks[].motions[].positions[][]
        picks[].motions[].velocities[][] picks[].motions[].accelerations[][] drive_by.motions[].positions[][]
        drive_by.motions[].velocities[][] drive_by.motions[].accelerations[][]
        """,
        ANY_SIGN,
        "of any sign",
    ),
    "scenario.floor": (f"null, {ANY_SIGN}", "no floor, or one at any height"),
    **each(
        "scenario.other_joints.head_pan_joint scenario.other_joints.head_tilt_joint",
        f"{ANY_SIGN}, dropped, misspelt",
        "of any sign",
    ),
    "route[].poses[][]": (f"{ANY_SIGN}, 1e7, 1e300", "of any sign; the check follows the way"),
    **each(
        """
        scenario.gripper.max_opening scenario.gripper.clearance scenario.positioning_uncertainty
        scenario.place_region.drop_height scenario.parts[].grasps[].opening scenario.options.grid_max_distance
        intersections[].radius stops[].radius route[].length route[].turning route[].duration
        picks[].motions[].opening picks[].motions[].times[] robustness_rate drive_by.motions[].opening
        drive_by.motions[].close_at drive_by.motions[].closed_at drive_by.motions[].times[]
        """,
        NO_AMOUNT,
        "an amount, or none",
    ),
    **each(
        "scenario.gripper.finger_depth scenario.gripper.finger_width scenario.trays[].size[]",
        "1e-300",
        "an amount above 0",
    ),
    **each(
        """
        regions[].cells.0[][] regions[].cells.1[][] regions[].explanations[].grasps
        regions[].explanations[].base_poses_tried regions[].explanations[].base_poses_feasible
        regions[].explanations[].rejections.unreachable regions[].explanations[].rejections.limits
        regions[].explanations[].rejections.self_collision regions[].explanations[].rejections.scene
        regions[].explanations[].rejections.grasp_filter intersections[].heading intersections[].cells
        stops[].intersection stops[].arrivals.served lower_bound picks[].stop picks[].grasp premises.grasps
        drive_by.motions[].pick
        """,
        "0",
        "the first one, or none of them",
    ),
    **each("regions[].cells.0 regions[].cells.1", "no entries, dropped", "a heading without cells"),
    "regions[].cells": ("no keys", "a region without cells"),
    **each(
        """
        scenario.place_region.size scenario.trays[].headings grid.origin grid.headings intersections[].centre
        picks[].motions[].times drive_by.motions[].times
        """,
        "two numbers",
        "two others",
    ),
    "scenario.parts[].grasps[].quality": (f"{ANY_SIGN}, 1e7, 1e300", "a measure without bounds"),
    **each(
        """
        scenario.options.grid_resolution scenario.options.positioning_uncertainty scenario.options.motion_time_limit
        scenario.options.route_resolution scenario.reach.samples scenario.reach.position_cell
        scenario.reach.rotation_cell scenario.reach.max_per_cell scenario.reach.min_manipulability
        scenario.reach.thinning scenario.reach.seed premises.database.samples premises.database.position_cell
        premises.database.rotation_cell premises.database.max_per_cell premises.database.min_manipulability
        premises.database.thinning premises.database.seed
        """,
        RECORD,
        "a record of how it was planned, compared by the check",
    ),
    **each(
        "scenario.options.ik_seeds scenario.options.robustness_samples scenario.options.seed",
        "0, dropped, misspelt",
        "a record of how it was planned, compared by the check",
    ),
    **each(
        "premises.headings.A premises.headings.B premises.headings.D",
        "no entries, two numbers, dropped, misspelt",
        "headings that trays were tried with, compared by the check",
    ),
    **each(
        "premises.headings.A[] premises.headings.B[] premises.headings.D[]",
        f"{ANY_SIGN}, 1e7, 1e300, dropped",
        "a heading that a tray was tried with",
    ),
    **each(
        "premises.positioning_uncertainty premises.cell premises.max_distance premises.ik_seeds",
        f"{NO_AMOUNT}, 0.5, 1e7, 1e300",
        "a premise, compared by the check",
    ),
}

GRIPPERS: Harmless = {
    **HAND,
    "robot.srdf": ("dropped", DEFAULT),
    "robot.group": (", ".join(kind for kind in WRONG if kind != "misspelt"), "the arm's, for which nobody asks here"),
}
PROFILE = ASSETS / "robots" / "kr6like" / "kr6like.yaml"
DOORS: dict[str, Door] = {
    "scenario": Door(ASSETS / "scenarios" / "storeroom.yaml", mg.load_scenario, SCENARIOS),
    "scanned": Door(ASSETS / "scenarios" / "scanned_tray.yaml", mg.load_scenario, SCENARIOS),
    "pipe": Door(ASSETS / "pipes" / "pipe1.yaml", load_pipe_problem, PIPES),
    "assembly": Door(ASSETS / "assemblies" / "pulley.yaml", load_assembly, ASSEMBLIES),
    "profile": Door(PROFILE, lambda path: read_arm_of(str(path)), HAND),
    "gripper": Door(PROFILE, lambda path: read_gripper(str(path)), GRIPPERS),
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
        needed.update(known if is_read and not by_rule else [])
        if why:
            complaints.append(f"{door}: {pattern(place)} {place[-1]!r}: {kind}: {why}")
    return Result(taken, len(chosen) - taken, complaints, needed)


def unneeded(door: str, needed: set[tuple[str, str]]) -> list[str]:
    """Entries of the list that no change of the document needed; those of places that it does not have are left out."""
    sound = DOORS[door].sound
    there = {entry for place in places(document_of(door)) for entry in listed(place, sound)}
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
