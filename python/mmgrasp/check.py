"""`mmgrasp check`: what mmgrasp understands of a robot, and whether it can be planned for."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from . import _core
from ._core import Robot
from ._robot_section import Progress


@dataclass
class RobotCheck:
    """Findings about one robot. `problems` are what keeps it from being planned for."""

    robot: Robot
    problems: list[str]
    doubts: list[str]
    always: list[tuple[str, str]]
    never: int
    pairs: int

    @property
    def ok(self) -> bool:
        return not self.problems

    def to_dict(self) -> dict[str, Any]:
        robot = self.robot
        return {
            "ok": self.ok,
            "name": robot.name,
            "links": len(robot.links),
            "joints": robot.joint_table,
            "groups": robot.groups,
            "end_effectors": robot.end_effectors,
            "base": robot.base,
            "report": robot.report,
            "problems": self.problems,
            "doubts": self.doubts,
            "pairs": {"all": self.pairs, "never": self.never, "always": self.always},
        }


def check_robot(
    urdf: str | os.PathLike[str],
    srdf: str | os.PathLike[str] | None = None,
    package_dirs: Mapping[str, str] | None = None,
    base: str = "fixed",
    progress: Progress = None,
) -> RobotCheck:
    """Reads a robot as far as possible: missing meshes are listed, not refused."""
    robot = Robot.load(urdf, srdf, dict(package_dirs or {}), base, allow_missing_meshes=True)
    problems = [f"mesh not found: {uri}" for uri in robot.report["missing"]]
    if not robot.joints:
        problems.append("no movable joint")
    if not any(robot.collisions(link) for link in robot.links):
        problems.append("no link has a collision shape: collisions cannot be checked")
    for joint in robot.joint_table:
        if (
            joint["type"] in ("revolute", "prismatic")
            and not joint["upper"] > joint["lower"]
            and joint["mimic"] is None
        ):
            problems.append(f"joint {joint['name']}: limits [{joint['lower']:g}, {joint['upper']:g}] leave no room")
        if joint["type"] in ("planar", "floating"):
            problems.append(f"joint {joint['name']} is {joint['type']}: cannot be part of an arm")
    sampled = robot if robot.report["missing"] else _core.with_sampled_pairs(robot, progress=progress)
    reasons = sampled.disabled_pairs
    shaped = sum(1 for link in robot.links if robot.collisions(link))
    always = [(a, b) for a, b, reason in reasons if reason == "always"]
    never = sum(1 for *_, reason in reasons if reason == "never")
    return RobotCheck(
        robot, problems, [*robot.report["warnings"], *_doubts(robot)], always, never, shaped * (shaped - 1) // 2
    )


def _doubts(robot: Robot) -> list[str]:
    """Sizes and limits that hint at millimetres or degrees."""
    doubts = []
    for link in robot.links:
        sizes = [high - low for low, high in (shape.bounds for shape in robot.collisions(link))]
        largest = max((float(np.max(size)) for size in sizes), default=0.0)
        if largest > 5 and not any(link in warning for warning in robot.report["warnings"]):
            doubts.append(f"link {link} is {largest:g} m large: are its shapes in millimetres?")
        elif sizes and largest < 5e-4:
            doubts.append(f"link {link} is {largest:g} m large: are its shapes scaled twice?")
    for joint in robot.joint_table:
        if joint["type"] == "revolute" and max(abs(joint["lower"]), abs(joint["upper"])) > 8 * math.pi:
            doubts.append(
                f"joint {joint['name']}: limits [{joint['lower']:g}, {joint['upper']:g}] rad look like degrees"
            )
        if (
            joint["type"] in ("revolute", "prismatic", "continuous")
            and joint["mimic"] is None
            and not joint["velocity"] > 0
        ):
            doubts.append(f"joint {joint['name']}: velocity limit {joint['velocity']:g} lets it not move")
    return doubts


def describe(check: RobotCheck) -> str:
    """The findings as lines for people."""
    robot, lines = check.robot, []
    movable = robot.joints
    lines.append(f"robot      {robot.name}: {len(robot.links)} links, {len(movable)} movable joints, base {robot.base}")
    for name, group in robot.groups.items():
        chain = f"{group['base_link']} -> {group['tip_link']}" if group["tip_link"] else "no chain"
        lines.append(f"group      {name}: {len(group['joints'])} joints, {chain}")
    if not robot.groups:
        lines.append("group      none (no SRDF): name a base_link and a tip_link")
    for effector in robot.end_effectors:
        lines.append(f"effector   {effector['name']} on {effector['parent_link']}")
    for joint in robot.joint_table:
        if joint["type"] == "fixed":
            continue
        follows = f", follows {joint['mimic']}" if joint["mimic"] else ""
        unit = "m" if joint["type"] == "prismatic" else "rad"
        lines.append(
            f"joint      {joint['name']}: {joint['type']}, [{joint['lower']:g}, {joint['upper']:g}] {unit}, "
            f"at most {joint['velocity']:g} {unit}/s{follows}"
        )
    for mesh in robot.report["meshes"]:
        kind = ("convex solid" if mesh["convex"] else "solid") if mesh["closed"] else "open surface"
        repaired = mesh["vertices_merged"] + mesh["degenerate_triangles"]
        note = f", {mesh['degenerate_triangles']} degenerate triangles dropped" if mesh["degenerate_triangles"] else ""
        lines.append(
            f"mesh       {Path(mesh['path']).name}: {mesh['triangles']} triangles, {kind}{note if repaired else ''}"
        )
    lines.append(f"pairs      {check.never} of {check.pairs} link pairs never touch, {len(check.always)} always touch")
    lines += [f"always     {a} and {b} touch in every configuration" for a, b in check.always]
    lines += [f"doubt      {doubt}" for doubt in check.doubts]
    lines += [f"problem    {problem}" for problem in check.problems]
    lines.append("can be planned for" if check.ok else "cannot be planned for")
    return "\n".join(lines)
