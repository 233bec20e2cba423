"""A first scenario for a robot that nobody described to mmgrasp: what its URDF tells is read, the rest is chosen and said in comments.

`first_scenario` is what `mmgrasp init` calls.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ... import _core
from ..._core import InvalidInput, LinkShape, Robot
from ..._files import LARGEST_FILE, printable, read_text, shipped
from ..._progress import Progress
from ...documents.reading import Document
from ..closed_fingers import fingers_may_meet
from ..floor_map import read_floor_map
from ..robot_section import compose
from .arm import Arm, Tool, find_arm, find_tool, flange
from .drive import Drive, read_drive, wheel_speed
from .room import COUNTER, TRAY, counter_height, fitting_part, place_room, tray_poses
from .standing import BIN_SIZE, DROP_HEIGHT, Bin, Home, Outline, find_bin, find_home, outline_of
from .text import flow, section

GRIPPER = "asset:grippers/parallel/parallel.urdf"
_MAP_HEIGHT = 1.2  # of a map's walls [m]


@dataclass
class FirstScenario:
    """The scenario's text, what was found and why, and what a person should look at."""

    text: str
    found: list[str]
    doubts: list[str]


@dataclass
class _Findings:
    """What is known of the robot so far, and its section as it will be written."""

    section: dict[str, Any]
    robot: Robot
    drive: Drive
    arm: Arm
    tool: Tool
    found: list[str]
    doubts: list[str]


def first_scenario(
    urdf: str | os.PathLike[str],
    floor_map: str | os.PathLike[str] | None = None,
    *,
    folder: str | os.PathLike[str] = ".",
    srdf: str | os.PathLike[str] | None = None,
    package_dirs: Mapping[str, str] | None = None,
    xacro_args: Mapping[str, str] | None = None,
    mounts: Sequence[tuple[str, str]] = (),
    base: str | None = None,
    group: str | None = None,
    tool_link: str | None = None,
    progress: Progress = None,
) -> FirstScenario:
    """A scenario to begin with: the robot as its files tell, a bin on it, and a counter with two trays that it reaches.

    `urdf`: a URDF or .xacro file, `asset:...` for a shipped one. `floor_map`: the YAML file of a map (map_server, SLAM) in
    whose free space the counter is put. `folder`: where the scenario will lie; paths in it are relative to that. `srdf`: without it one of the
    same name beside the URDF or in ../srdf is taken. `mounts`: (file, link) of robots put on a link, as an arm on a base.
    `base`: diff_drive or omni; None: told from the wheels. `group`, `tool_link`: the arm and the tool frame; None: the longest arm, and a frame between
    its finger tips. A robot without fingers gets the shipped parallel gripper. InvalidInput, IoError: one message with what was looked for and what would help.
    """
    findings = _read_robot(
        urdf, Path(folder), srdf, dict(package_dirs or {}), dict(xacro_args or {}), mounts, base, group, tool_link
    )
    robot = _core.with_sampled_pairs(findings.robot, progress=progress)
    arm, tool = findings.arm, findings.tool
    joints = robot.group(base_link=arm.base_link, tip=tool.link)
    robot = fingers_may_meet(robot, joints, tool.hand)
    joints = robot.group(base_link=arm.base_link, tip=tool.link)
    outline = outline_of(robot, findings.drive.wheels)
    home = find_home(robot, arm, joints, tool.hand, findings.drive.wheels, outline, progress)
    q = np.array([home.arm[name] for name in joints.names])
    joints = joints.with_reference({**home.others, **tool.hand.joint_values(0.0)})
    place = find_bin(robot, joints, q, tool.hand, outline, progress)
    if place is None:
        findings.doubts.append(
            "no place for a bin was found that the hand reaches from above: put one where it does (place_region)"
        )
        place = Bin(robot.links[0], np.array([outline.low[0] - BIN_SIZE[0], 0.0, outline.low[2] + 0.5]), 0.0)
    robot = robot.with_link(
        "place_bin",
        place.parent,
        _core.pose(place.xyz),
        [LinkShape(_core.Box(BIN_SIZE), _core.pose([0, 0, -BIN_SIZE[2] / 2]))],
    )
    joints = robot.group(base_link=arm.base_link, tip=tool.link)
    joints = joints.with_reference({**home.others, **tool.hand.joint_values(0.0)})
    part = fitting_part(tool.hand)
    height, reached = counter_height(joints, tool.hand, q, outline, part, progress)
    if reached < 0.5:
        findings.doubts.append(
            f"of grasps from above the arm reaches {reached:.0%} on the best counter that was tried ({height:g} m high): move the trays to where it works"
        )
    walls = _read_walls(floor_map, Path(folder)) if floor_map is not None else None
    _say_what_was_found(findings, home, place, height, reached)
    text = _write(findings, home, place, outline, part.size, height, floor_map, Path(folder), walls)
    return FirstScenario(text, findings.found, findings.doubts)


def _read_robot(
    urdf: str | os.PathLike[str],
    folder: Path,
    srdf: str | os.PathLike[str] | None,
    packages: dict[str, str],
    xacro_args: dict[str, str],
    mounts: Sequence[tuple[str, str]],
    base: str | None,
    group: str | None,
    tool_link: str | None,
) -> _Findings:
    found, doubts = [], []
    rows: dict[str, Any] = {"urdf": _relative(urdf, folder)}
    srdf = srdf if srdf is not None else _srdf_beside(shipped(urdf))
    if srdf is not None:
        rows["srdf"] = _relative(srdf, folder)
        found.append(f"SRDF       {srdf}")
    if packages:
        rows["packages"] = {name: _relative(path, folder) for name, path in packages.items()}
    if xacro_args:
        rows["xacro_args"] = xacro_args
    rows["mount"] = [_mount_row(file, link, folder) for file, link in mounts]
    robot = _composed(rows, folder)
    drive = read_drive(robot, read_text(shipped(urdf), LARGEST_FILE), base)
    found.append(f"base       {drive.base}: {drive.reason}")
    if not drive.sure:
        doubts.append(f"base: {drive.base}, since there are {drive.reason}")
    arm = find_arm(robot, drive.wheels, group, tool_link)
    tool = find_tool(robot, arm, tool_link)
    if tool is None:
        link, T = flange(robot, arm)
        xyz, rpy = _core.pose_to_xyz_rpy(T)
        row = {
            "urdf": GRIPPER,
            "parent_link": link,
            "pose": {"xyz": _rounded(xyz), "rpy": _rounded(rpy)},
            "prefix": "gripper_",
        }
        rows["mount"].append(row)
        robot = _composed(rows, folder)
        end = link
        arm = find_arm(robot, drive.wheels, None, end)
        tool = find_tool(robot, arm, None)
        doubts.append(
            f"no fingers were found: the shipped parallel gripper is mounted on {link}, where the last joint's axis leaves it; put your own there"
        )
    if tool is None:
        raise InvalidInput(f"{robot.name}: no fingers were found at {arm.hand_link}")
    if not rows["mount"]:
        del rows["mount"]
    if tool.frame is not None:
        rows["frames"] = [tool.frame]
    rows["group"] = arm.group if arm.group is not None else {"base_link": arm.base_link}
    rows["tool_link"] = tool.link
    return _Findings(rows, _composed(rows, folder), drive, arm, tool, found, doubts)


def _composed(rows: dict[str, Any], folder: Path) -> Robot:
    """The robot that a section describes, as scenarios are read."""
    keys = ("urdf", "srdf", "packages", "xacro_args", "mount", "frames")
    raw = {"robot": {key: rows[key] for key in keys if key in rows}}
    return compose(Document(str(folder / "the scenario"), raw, {}).root["robot"])


def _mount_row(file: str, link: str, folder: Path) -> dict[str, Any]:
    row: dict[str, Any] = {"urdf": _relative(file, folder), "parent_link": link}
    srdf = _srdf_beside(shipped(file))
    if srdf is not None:
        row["srdf"] = _relative(srdf, folder)
    return row


def _srdf_beside(urdf: Path) -> Path | None:
    """An SRDF of the URDF's name in its folder, or in the folder srdf beside that."""
    name = urdf.name.split(".")[0] + ".srdf"
    return next((p for p in (urdf.parent / name, urdf.parent.parent / "srdf" / name) if p.is_file()), None)


def _relative(path: str | os.PathLike[str], folder: Path) -> str:
    text = os.fspath(path)
    if text.startswith(("asset:", "robot-data:")):
        return text
    return os.path.relpath(os.path.abspath(text), os.path.abspath(folder))


def _read_walls(floor_map: str | os.PathLike[str], folder: Path) -> list[LinkShape]:
    raw = {"map": _relative(floor_map, folder), "height": _MAP_HEIGHT}
    return read_floor_map(Document(str(folder / "the scenario"), raw, {}).root)


def _rounded(values: Sequence[float] | np.ndarray, digits: int = 4) -> list[float]:
    return [round(float(x), digits) + 0.0 for x in values]


def _say_what_was_found(findings: _Findings, home: Home, place: Bin, height: float, reached: float) -> None:
    arm, hand = findings.arm, findings.tool.hand
    findings.found += [
        f"arm        {len(arm.joints)} joints from {arm.base_link} to {arm.hand_link}"
        + (f"; others end at {', '.join(arm.others)}" if arm.others else ""),
        f"hand       opens {hand.min_opening * 1000:.0f} to {hand.max_opening * 1000:.0f} mm, tool frame {findings.tool.link}"
        + (" (made here, between the finger tips)" if findings.tool.frame else ""),
        f"home       {home.reason}; sticks out at most {home.overhang * 1000:.0f} mm of the base's outline",
        f"bin        on {place.parent}, reached in {place.reached:.0%} of the tried hand poses",
        f"counter    {height:g} m high: {reached:.0%} of the tried grasps are reached from one place of the base",
    ]


def _write(
    findings: _Findings,
    home: Home,
    place: Bin,
    outline: Outline,
    part: np.ndarray,
    height: float,
    floor_map: str | os.PathLike[str] | None,
    folder: Path,
    walls: list[LinkShape] | None,
) -> str:
    counter, start, goal, doubts = place_room(outline, walls)
    findings.doubts += doubts
    ground = float(outline.low[2])
    name = findings.robot.name
    lines = [
        f"# A first scenario for {printable(name)}, written by `mmgrasp init`. Keys and units: docs/scenario_format.md. Try it: mmgrasp plan THIS -o out/",
        *(f"# LOOK: {printable(doubt)}" for doubt in findings.doubts),
        "format: mmgrasp-scenario",
        "version: 3",
        f"name: {flow(printable(name) + ' first')}",
        "",
    ]
    rows = dict(findings.section)
    tail = {key: rows.pop(key) for key in ("group", "tool_link")}
    rows |= {"base": findings.drive.base, "base_limits": _base_limits(findings)} | tail
    if home.others:
        rows["joints"] = home.others
    rows["home"] = home.arm
    arm = findings.arm
    notes = {
        "base": findings.drive.reason,
        "base_limits": "guesses but for what the wheels' joints say: put your base's own here",
        "group": f"{len(arm.joints)} joints, to {arm.hand_link}",
        "frames": "between the finger tips",
        "joints": "what neither arm nor hand moves",
        "home": home.reason,
    }
    lines += section("robot", rows, notes) + [""]
    lines += section(
        "gripper",
        findings.tool.gripper,
        {"from_robot": f"measured: opens {findings.tool.hand.max_opening * 1000:.0f} mm"},
    ) + [""]
    lines.append(
        f"# An open bin, reached by the hand from above in {place.reached:.0%} of the tried poses. The pose is the middle of its top face."
    )
    bin_row = {
        "parent": place.parent,
        "pose": {"xyz": _rounded(place.xyz, 3)},
        "size": _rounded(BIN_SIZE, 3),
        "drop_height": DROP_HEIGHT,
    }
    lines += [f"place_region: {flow(bin_row)}", ""]
    lines += [f"start: {flow(_rounded(start, 3))}  # x, y, heading of the base", f"goal: {flow(_rounded(goal, 3))}"]
    lines += ["positioning_uncertainty: 0.03  # how far beside a stop the base may come to stand [m]"]
    if ground != 0:
        lines.append(f"floor: {ground:.4g}  # the robot's root frame does not lie on the ground")
    lines += ["", "obstacles:"]
    c = counter
    if floor_map is not None:
        lines.append(f"  - {flow({'name': 'walls', 'map': _relative(floor_map, folder), 'height': _MAP_HEIGHT})}")
    counter_row = {
        "name": "counter",
        "box": [float(COUNTER[0]), float(COUNTER[1]), height],
        "pose": {"xyz": _rounded([c[0], c[1], ground + height / 2]), "rpy": [0.0, 0.0, round(float(c[2]), 6)]},
    }
    lines += [
        f"  - {flow(counter_row)}",
        "",
        "part_types:",
        f"  block: {flow({'box': _rounded(part, 3)})}",
        "",
        "trays:",
    ]
    for letter, pose in zip("AB", tray_poses(counter, ground + height), strict=True):
        xyz = _rounded(pose[:3])
        lines += [
            f"  - name: {letter}",
            f"    pose: {flow({'xyz': xyz, 'rpy': [0.0, 0.0, round(float(pose[3]), 6)]})}",
            f"    size: {flow(_rounded(TRAY))}",
            f"    parts: {flow({'type': 'block', 'grid': [2, 3], 'spacing': [0.14, 0.12]})}",
        ]
    return "\n".join([*lines, "", "options: {seed: 1}", ""])


def _base_limits(findings: _Findings) -> dict[str, float]:
    limits = {"linear_velocity": 0.6, "angular_velocity": 1.0, "linear_acceleration": 0.5, "angular_acceleration": 1.0}
    drive = findings.drive
    speed = wheel_speed(findings.robot, drive.wheels)
    if speed is not None:
        limits["linear_velocity"] = min(limits["linear_velocity"], round(speed, 3))
    if drive.base == "diff_drive" and drive.separation is not None and speed is not None:
        limits |= {"wheel_velocity": round(speed, 3), "wheel_separation": round(drive.separation, 4)}
    return limits
