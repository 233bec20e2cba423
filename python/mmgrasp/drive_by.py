"""Parts taken in passing: the first pick at a stop merged with the drive to it (P1 chapter 4 in the main job).

A plan of `plan_part_supply` drives, stops and then picks. Here the leg to a stop and the first pick there, up to the lifted part,
become one motion of base and arm through the grasp; the base does not stop for it. Where no such motion is found, or a slower one,
stop-and-pick stays. Everything after the lift is carried out as planned before.
"""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from . import _core
from ._core import InvalidInput, JointGroup, Outcome, Pick, World
from ._files import write_file
from ._robot_section import Progress
from .part_supply import PartSupplyPlan

CLOSING_SPEED = 0.1  # of the gripper's opening [m/s] (P1 4.4.1)
SETTLING = 0.1  # fingers press before the part is lifted [s]
MERGED = ("reach", "approach", "lift")  # motions of a pick that the drive takes in


@dataclass
class DriveByPick:
    """One leg of the route with the pick at its end, both ways."""

    leg: int
    stop: int
    part: str
    stop_and_pick: float
    """Drive, reach, approach, close, lift, one after the other [s]."""
    result: _core.DriveByResult | None
    used: bool
    why: str
    """What speaks against the motion in passing, or how fast it is at the grasp."""

    @property
    def drive_by(self) -> float:
        """What it takes now [s]."""
        return self.result.duration if self.used and self.result is not None else self.stop_and_pick

    def to_dict(self) -> dict[str, Any]:
        out: dict[str, Any] = {
            "leg": self.leg,
            "stop": self.stop,
            "part": self.part,
            "stop_and_pick": self.stop_and_pick,
            "drive_by": self.drive_by,
            "used": self.used,
            "why": self.why,
        }
        if self.result is not None:
            out["report"] = self.result.report
        if self.used and self.result is not None:
            out["events"] = self.result.events
            out["violations"] = self.result.violations
        return out


@dataclass
class DriveByPlan:
    """A part-supply plan and what of it is done in passing."""

    plan: PartSupplyPlan
    problem: _core.PartSupplyProblem = field(repr=False)
    picks: list[DriveByPick] = field(default_factory=list)

    @property
    def stop_and_pick(self) -> float:
        """Driving and moving the arm, closing and opening included, as planned before [s]."""
        problem = self.problem
        seconds = sum(leg.duration(problem.robot) for leg in self.plan.route)
        for pick in self.plan.picks:
            opening, width = _openings(problem, pick)
            seconds += pick.duration + (opening - width) / CLOSING_SPEED * 2
        return seconds

    @property
    def saved(self) -> float:
        """[s]"""
        return sum(p.stop_and_pick - p.drive_by for p in self.picks)

    @property
    def drive_by(self) -> float:
        """The same with the parts taken in passing [s]."""
        return self.stop_and_pick - self.saved

    def to_dict(self) -> dict[str, Any]:
        """Plain values."""
        return {
            "format": "mmgrasp-drive-by",
            "version": 1,
            "stop_and_pick": self.stop_and_pick,
            "drive_by": self.drive_by,
            "saved": self.saved,
            "picks": [p.to_dict() for p in self.picks],
        }

    def save(self, folder: str | os.PathLike[str]) -> list[Path]:
        """drive_by.json, and one CSV for each motion in passing (x, y, theta first; wheel speeds last)."""
        written = [Path(folder) / "drive_by.json"]
        write_file(written[0], json.dumps(self.to_dict(), allow_nan=False) + "\n")
        for pick in self.picks:
            if pick.used and pick.result is not None:
                name = "".join(c if c.isalnum() or c in "_.-" else "_" for c in pick.part)
                written.append(Path(folder) / "trajectories" / f"drive_by_{pick.leg:02d}_{name}.csv")
                write_file(written[-1], pick.result.trajectory.to_csv(between=9))
        return written


def plan_drive_by_picks(plan: PartSupplyPlan, *, progress: Progress = None, **options: Any) -> DriveByPlan:
    """Tries to take the first part at each stop in passing. Keywords are those of `plan_drive_by`, here with 45 waypoints and 600 iterations a stop.

    Raises InvalidInput for a plan that is not solved and for a robot that does not drive.
    """
    if plan.outcome != Outcome.solved:
        raise InvalidInput(f"plan: is not solved ({plan.outcome.name})")
    problem = plan.scenario.problem()
    if problem.robot.base == "fixed":
        raise InvalidInput("plan: the robot has a fixed base")
    out = DriveByPlan(plan, problem)
    gone: set[tuple[int, int]] = set()
    here = np.asarray(problem.start, float)
    for leg, stop in enumerate(plan.stops):
        if progress is not None:
            progress("drive-by", leg / len(plan.stops))
        picks = [pick for pick in plan.picks if pick.stop == leg]
        if picks:
            out.picks.append(_in_passing(plan, problem, leg, here, picks[0], gone, options))
        gone.update((pick.tray, pick.part) for pick in picks)
        here = np.asarray(stop.pose, float)
    if progress is not None:
        progress("drive-by", 1.0)
    return out


def _in_passing(
    plan: PartSupplyPlan,
    problem: _core.PartSupplyProblem,
    leg: int,
    here: np.ndarray,
    pick: Pick,
    gone: set[tuple[int, int]],
    options: dict[str, Any],
) -> DriveByPick:
    part = problem.trays[pick.tray].parts[pick.part]
    opening, width = _openings(problem, pick)
    merged = [m for m in pick.motions if m.kind in MERGED]
    closing = (opening - width) / CLOSING_SPEED
    before = plan.route[leg].duration(problem.robot) + sum(m.trajectory.duration for m in merged) + closing
    T_grasp = part.T_world_part @ part.grasps[pick.grasp].T_object_tcp
    T_before = T_grasp.copy()
    T_before[:3, 3] -= problem.options["approach_distance"] * T_grasp[:3, :3] @ np.asarray(problem.gripper.approach)
    tasks = [
        _core.DriveByTask(T_before, tolerance=[0.003] * 3 + [0.02] * 3),
        _core.DriveByTask(T_grasp, dwell=closing + SETTLING, object=part.name),
    ]
    stop = plan.stops[leg]
    lifted = merged[-1].trajectory.positions[-1]
    group = _moving_group(plan, problem, opening)
    result = _core.plan_drive_by(
        problem.robot,
        group,
        _world(problem, gone),
        start=[*here, *problem.home],
        tasks=tasks,
        goal=[*stop.pose, *lifted],
        **{"waypoints": 45, "iterations": 600, **options},
    )
    made = DriveByPick(leg, leg, part.name, before, result, False, "")
    if result.outcome != Outcome.solved:
        made.why = f"no motion in passing found in {result.attempts} attempts ({result.outcome.name})"
    elif result.duration >= before:
        made.why = f"in passing it would take {result.duration:.1f} s"
    else:
        made.used = True
        made.why = f"base at {result.events[1]['base_speed']:.2f} m/s as the hand closes"
    return made


def _openings(problem: _core.PartSupplyProblem, pick: Pick) -> tuple[float, float]:
    """Of the open hand and of the hand around the part [m]."""
    width = problem.trays[pick.tray].parts[pick.part].grasps[pick.grasp].width
    return pick.motions[0].opening, width


def _moving_group(plan: PartSupplyPlan, problem: _core.PartSupplyProblem, opening: float) -> JointGroup:
    joints = {**plan.scenario.setup.other_joints, **problem.gripper.joint_values(opening)}
    group = problem.robot.group(problem.arm.name, tip=problem.gripper.tcp_link, with_base=True)
    return group.with_reference(joints)


def _world(problem: _core.PartSupplyProblem, gone: set[tuple[int, int]]) -> World:
    """Scene and the parts still in place."""
    world = problem.scene.copy()
    for t, tray in enumerate(problem.trays):
        for p, part in enumerate(tray.parts):
            if (t, p) not in gone:
                world.add(part.name, part.shapes, part.T_world_part)
    return world
