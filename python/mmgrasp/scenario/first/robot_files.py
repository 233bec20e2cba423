"""A robot from its files: what its section in a first scenario says."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ... import _core
from ..._core import InvalidInput, Robot
from ..._files import ASSETS, LARGEST_FILE, read_text, shipped
from ...documents.reading import Document
from ..robot_section import compose
from .arm import Arm, find_arm
from .drive import Drive, read_drive
from .tool import Tool, find_tool, flange
from .yaml_lines import rounded

GRIPPER = "asset:grippers/parallel/parallel.urdf"


@dataclass
class FirstRobot:
    """What is known of the robot, and its section as it will be written."""

    section: dict[str, Any]
    robot: Robot
    drive: Drive
    arm: Arm
    tool: Tool
    found: list[str]
    doubts: list[str]


def read_robot(
    urdf: str | os.PathLike[str],
    folder: Path,
    srdf: str | os.PathLike[str] | None,
    packages: dict[str, str],
    xacro_args: dict[str, str],
    mounts: Sequence[tuple[str, str]],
    base: str | None,
    group: str | None,
    tool_link: str | None,
) -> FirstRobot:
    """Reads the files as scenarios do and finds base, arm, hand and tool frame; see first_scenario for the arguments."""
    found, doubts = [], []
    rows: dict[str, Any] = {"urdf": relative(urdf, folder)}
    srdf = srdf if srdf is not None else _srdf_beside(urdf)
    if srdf is not None:
        rows["srdf"] = relative(srdf, folder)
        found.append(f"SRDF       {srdf}")
    if packages:
        rows["packages"] = {name: relative(path, folder) for name, path in packages.items()}
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
        pose = {"xyz": rounded(xyz), "rpy": rounded(rpy)}
        rows["mount"].append({"urdf": GRIPPER, "parent_link": link, "pose": pose, "prefix": "gripper_"})
        robot = _composed(rows, folder)
        arm = find_arm(robot, drive.wheels, None, link)
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
    return FirstRobot(rows, _composed(rows, folder), drive, arm, tool, found, doubts)


def _composed(rows: dict[str, Any], folder: Path) -> Robot:
    """The robot that a section describes, as scenarios are read."""
    keys = ("urdf", "srdf", "packages", "xacro_args", "mount", "frames")
    raw = {"robot": {key: rows[key] for key in keys if key in rows}}
    return compose(Document(str(folder / "the scenario"), raw, {}).root["robot"])


def _mount_row(file: str, link: str, folder: Path) -> dict[str, Any]:
    row: dict[str, Any] = {"urdf": relative(file, folder), "parent_link": link}
    srdf = _srdf_beside(file)
    if srdf is not None:
        row["srdf"] = relative(srdf, folder)
    return row


def _srdf_beside(urdf: str | os.PathLike[str]) -> str | None:
    """An SRDF of the URDF's name in its folder, or in the folder srdf beside that; of a shipped one by its shipped name."""
    path = shipped(urdf)
    name = path.name.split(".")[0] + ".srdf"
    found = next((p for p in (path.parent / name, path.parent.parent / "srdf" / name) if p.is_file()), None)
    if found is None or not os.fspath(urdf).startswith("asset:"):
        return None if found is None else str(found)
    return f"asset:{found.relative_to(ASSETS).as_posix()}"


def relative(path: str | os.PathLike[str], folder: Path) -> str:
    """A path as it is written into a scenario that lies in a folder."""
    text = os.fspath(path)
    if text.startswith(("asset:", "robot-data:")):
        return text
    return os.path.relpath(os.path.abspath(text), os.path.abspath(folder))
