"""A first scenario as YAML with comments."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..._files import printable
from .bin import BIN_SIZE, DROP_HEIGHT, Bin
from .drive import wheel_speed
from .robot_files import FirstRobot
from .room import COUNTER, TRAY, Layout, tray_poses
from .standing import Home
from .yaml_lines import flow, rounded, section

MAP_HEIGHT = 1.2  # of a map's walls [m]


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
    if drive.separation is not None and speed is not None:
        limits |= {"wheel_velocity": round(speed, 3), "wheel_separation": round(drive.separation, 4)}
        if drive.wheelbase is not None:
            limits["wheelbase"] = round(drive.wheelbase, 4)
    return limits
