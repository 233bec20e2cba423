"""`mmgrasp check`: what mmgrasp understands of a robot, and whether it can be planned for."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .. import _core
from .._core import InvalidInput, Robot
from .._progress import Progress
from .planning_needs import base_by_wheels, planning_needs


@dataclass
class RobotCheck:
    """Findings about one robot. `problems` are what keeps any motion of it from being planned, `missing` a whole round of part supply."""

    robot: Robot
    sampled: Robot  # the same with its disabled pairs computed
    found: list[str]
    problems: list[str]
    missing: list[str]
    doubts: list[str]
    always: list[tuple[str, str]]
    never: int
    pairs: int

    @property
    def ok(self) -> bool:
        """Motions of the arm can be planned, where the base is fixed, and whole rounds, where it drives; doubts and what a scenario can add (a
        hand) do not count."""
        return not self.problems

    @property
    def verdict(self) -> str:
        """What can be planned for it, in one line."""
        if self.problems:
            return "cannot be planned for"
        if self.missing:
            return "can be planned for: motions of its joints; a whole round needs what is missing above"
        return "can be planned for: motions of its joints and whole rounds"

    def to_dict(self) -> dict[str, Any]:
        """Plain values, as `mmgrasp check --json` prints them."""
        robot = self.robot
        return {
            "ok": self.ok,
            "verdict": self.verdict,
            "name": robot.name,
            "links": len(robot.links),
            "joints": robot.joint_table,
            "groups": robot.groups,
            "end_effectors": robot.end_effectors,
            "base": robot.base,
            "report": robot.report,
            "found": self.found,
            "problems": self.problems,
            "missing": self.missing,
            "doubts": self.doubts,
            "pairs": {"all": self.pairs, "never": self.never, "always": self.always},
        }

    def srdf(self) -> str:
        """An SRDF of what is known: that of the file, if any, and the computed pairs with their reasons."""
        if self.robot.report["missing"]:
            raise InvalidInput(
                f"{self.robot.name}: an SRDF needs every collision mesh; not found: {self.robot.report['missing'][0]}"
            )
        return self.sampled.to_srdf()


def check_robot(
    urdf: str | os.PathLike[str],
    srdf: str | os.PathLike[str] | None = None,
    package_dirs: Mapping[str, str] | None = None,
    base: str | None = None,
    progress: Progress = None,
    mesh_tolerance: float = 0.0,
    xacro_args: Mapping[str, Any] | None = None,
) -> RobotCheck:
    """Reads a robot as far as possible: missing meshes are listed, not refused. `base` None: as its wheels tell, else fixed."""

    def read(kind: str) -> Robot:
        return Robot.load(
            urdf,
            srdf,
            dict(package_dirs or {}),
            kind,
            allow_missing_meshes=True,
            mesh_tolerance=mesh_tolerance,
            xacro_args=xacro_args,
        )

    robot = read(base or "fixed")
    if base is None and (told := base_by_wheels(robot)) is not None:
        robot = read(told)
    problems = [f"mesh not found: {uri}" for uri in robot.report["missing"]]
    if not robot.joints:
        problems.append("no movable joint")
    if not any(robot.collisions(link) for link in robot.links):
        problems.append("no link has a collision shape: collisions cannot be checked")
    needs = planning_needs(robot)
    sampled = robot if robot.report["missing"] else _core.with_sampled_pairs(robot, progress=progress)
    reasons = sampled.disabled_pairs
    shaped = sum(1 for link in robot.links if robot.collisions(link))
    always = [(a, b) for a, b, reason in reasons if reason == "always"]
    never = sum(1 for *_, reason in reasons if reason == "never")
    return RobotCheck(
        robot,
        sampled,
        needs.found,
        [*problems, *needs.problems],
        needs.missing,
        [*robot.report["warnings"], *_doubts(robot), *needs.doubts],
        always,
        never,
        shaped * (shaped - 1) // 2,
    )


def _doubts(robot: Robot) -> list[str]:
    """Limits that hint at degrees or stand still. (Loading warns of odd sizes.)"""
    doubts = []
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


def _mesh_line(mesh: Mapping[str, Any]) -> str:
    """What was read of a mesh, what stands in for it in collision checks, and what that saves."""
    kind = ("convex solid" if mesh["convex"] else "solid") if mesh["closed"] else "open surface"
    line = f"mesh       {Path(mesh['path']).name}: {mesh['triangles']} triangles, {kind}"
    if mesh["vertices_merged"]:
        line += f", {mesh['vertices_merged']} of {mesh['vertices_read']} vertices merged"
    if mesh["degenerate_triangles"]:
        line += f", {mesh['degenerate_triangles']} degenerate triangles dropped"
    if mesh["chosen"] == "mesh":
        return line + "; kept as it is"
    line += f"; checked as {mesh['chosen']}"
    if mesh["triangles_saved"]:
        line += f", saves {mesh['triangles_saved']} triangles"
    return line + (
        f", sticks out at most {mesh['deviation'] * 1000:.3g} mm" if mesh["deviation"] else ", the same solid"
    )


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
    lines += [f"passive    {joint}" for joint in robot.passive_joints]
    lines += [_mesh_line(mesh) for mesh in robot.report["meshes"]]
    lines.append(f"pairs      {check.never} of {check.pairs} link pairs never touch, {len(check.always)} always touch")
    lines += [f"always     {a} and {b} touch in every configuration" for a, b in check.always]
    lines[1:1] = check.found
    lines += [f"doubt      {doubt}" for doubt in check.doubts]
    lines += [f"missing    for a whole round: {need}" for need in check.missing]
    lines += [f"problem    {problem}" for problem in check.problems]
    lines.append(check.verdict)
    return "\n".join(lines)
