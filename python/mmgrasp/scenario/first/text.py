"""A first scenario as YAML with comments."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..._files import printable
from .bin import BIN_SIZE, DROP_HEIGHT, Bin
from .drive import wheel_speed
from .room import COUNTER, TRAY, Layout, tray_poses
from .standing import Home

if TYPE_CHECKING:  # which takes `rounded` from here
    from .robot_files import FirstRobot

_PLAIN = re.compile(r"[A-Za-z_./][A-Za-z0-9_./+ -]*\Z")
_WORDS = ("true", "false", "null", "yes", "no", "none", "on", "off", "~")
_WIDTH = 140
MAP_HEIGHT = 1.2  # of a map's walls [m]


def flow(value: Any) -> str:
    """A value on one line."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{flow(key)}: {flow(item)}" for key, item in value.items()) + "}"
    if isinstance(value, str):
        plain = _PLAIN.match(value) and value.lower() not in _WORDS and value == value.strip()
        return value if plain else json.dumps(value, ensure_ascii=False)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, Sequence):
        return "[" + ", ".join(flow(item) for item in value) + "]"
    return _number(float(value)) if isinstance(value, float) else str(value)


def _number(value: float) -> str:
    text = f"{value + 0.0:.8g}"
    text = text if float(text) == value else repr(value)
    return text if any(c in text for c in ".e") else text + ".0"


def section(name: str, rows: Mapping[str, Any], notes: Mapping[str, str] | None = None) -> list[str]:
    """A key with a mapping below it, a row a line, and what is said of a row behind it or, where that is too long, before it."""
    lines = [f"{name}:"]
    for key, value in rows.items():
        line = f"  {flow(key)}: {flow(value)}"
        note = printable((notes or {}).get(key, ""))
        if len(line) > _WIDTH and isinstance(value, Mapping):
            lines += [f"  # {note}"] if note else []
            lines.append(f"  {flow(key)}:")
            lines += [f"    {flow(k)}: {flow(v)}" for k, v in value.items()]
        elif note and len(line) + len(note) + 4 > _WIDTH:
            lines += [f"  # {note}", line]
        else:
            lines.append(line + (f"  # {note}" if note else ""))
    return lines


def rounded(values: Sequence[float] | np.ndarray, digits: int = 4) -> list[float]:
    """Plain numbers, without a minus before zero."""
    return [round(float(x), digits) + 0.0 for x in values]


@dataclass
class Choices:
    """What was chosen for a robot."""

    home: Home
    bin: Bin
    part: np.ndarray  # sizes of a box [m]
    height: float  # of the counter [m]
    ground: float  # height of the floor in the robot's root frame [m]
    layout: Layout
    map_file: str | None


def scenario_text(given: FirstRobot, chosen: Choices) -> str:
    """The scenario, ready to be planned; what is doubtful comes first."""
    name = printable(given.robot.name)
    doubts = [f"# LOOK: {printable(doubt)}" for doubt in given.doubts]
    lines = [
        f"# A first scenario for {name}, written by `mmgrasp init`. Keys and units: docs/scenario_format.md. Try it: mmgrasp plan THIS -o out/",
        *doubts,
        "format: mmgrasp-scenario",
        "version: 3",
        f"name: {flow(name + ' first')}",
        "",
        *_robot_lines(given, chosen),
        "",
        *_room_lines(chosen),
        "",
        "options: {seed: 1}",
        "",
    ]
    return "\n".join(lines)


def _robot_lines(given: FirstRobot, chosen: Choices) -> list[str]:
    """The sections robot, gripper and place_region."""
    home, arm, place = chosen.home, given.arm, chosen.bin
    rows = {key: value for key, value in given.section.items() if key not in ("group", "tool_link")}
    rows |= {"base": given.drive.base, "base_limits": _base_limits(given)}
    rows |= {key: given.section[key] for key in ("group", "tool_link")}
    rows |= ({"joints": home.others} if home.others else {}) | {"home": home.arm}
    notes = {
        "base": given.drive.reason,
        "base_limits": "guesses but for what the wheels' joints say: put your base's own here",
        "group": f"{len(arm.joints)} joints, to {arm.hand_link}",
        "frames": "between the finger tips",
        "joints": "what neither arm nor hand moves",
        "home": home.reason,
    }
    measured = {"from_robot": f"measured: opens {given.tool.hand.max_opening * 1000:.0f} mm"}
    bin_row = {
        "parent": place.parent,
        "pose": {"xyz": rounded(place.xyz, 3)},
        "size": rounded(BIN_SIZE, 3),
        "drop_height": DROP_HEIGHT,
    }
    return [
        *section("robot", rows, notes),
        "",
        *section("gripper", given.tool.gripper, measured),
        "",
        f"# An open bin, reached by the hand from above in {place.reached:.0%} of the tried poses. The pose is the middle of its top face.",
        f"place_region: {flow(bin_row)}",
    ]


def _room_lines(chosen: Choices) -> list[str]:
    """Start, goal, floor, obstacles, parts and trays."""
    layout, ground, height = chosen.layout, chosen.ground, chosen.height
    x, y, heading = (float(v) for v in layout.counter)
    lines = [
        f"start: {flow(rounded(layout.start, 3))}  # x, y, heading of the base",
        f"goal: {flow(rounded(layout.goal, 3))}",
        "positioning_uncertainty: 0.03  # how far beside a stop the base may come to stand [m]",
    ]
    if ground != 0:
        lines.append(f"floor: {ground:.4g}  # the robot's root frame does not lie on the ground")
    lines += ["", "obstacles:"]
    if chosen.map_file is not None:
        lines.append(f"  - {flow({'name': 'walls', 'map': chosen.map_file, 'height': MAP_HEIGHT})}")
    rpy = [0.0, 0.0, round(heading, 6)]
    pose = {"xyz": rounded([x, y, ground + height / 2]), "rpy": rpy}
    lines.append(f"  - {flow({'name': 'counter', 'box': [*rounded(COUNTER), height], 'pose': pose})}")
    lines += ["", "part_types:", f"  block: {flow({'box': rounded(chosen.part, 3)})}", "", "trays:"]
    for letter, place in zip("AB", tray_poses(layout.counter, ground + height), strict=True):
        lines += [
            f"  - name: {letter}",
            f"    pose: {flow({'xyz': rounded(place[:3]), 'rpy': rpy})}",
            f"    size: {flow(rounded(TRAY))}",
            f"    parts: {flow({'type': 'block', 'grid': [2, 3], 'spacing': [0.14, 0.12]})}",
        ]
    return lines


def _base_limits(given: FirstRobot) -> dict[str, float]:
    limits = {"linear_velocity": 0.6, "angular_velocity": 1.0, "linear_acceleration": 0.5, "angular_acceleration": 1.0}
    drive = given.drive
    speed = wheel_speed(given.robot, drive.wheels)
    if speed is not None:
        limits["linear_velocity"] = min(limits["linear_velocity"], round(speed, 3))
    if drive.base == "diff_drive" and drive.separation is not None and speed is not None:
        limits |= {"wheel_velocity": round(speed, 3), "wheel_separation": round(drive.separation, 4)}
    return limits
