"""Parts taken in passing: the first pick at a stop merged with the drive to it (P1 chapter 4 in the main job).

A plan of `plan_part_supply` drives, stops and then picks. Here the leg to a stop and the first pick there, up to the lifted part,
become one motion of base and arm through the grasp; the base does not stop for it. The motions as planned, one after the other, are
where the search begins (`shorten_drive_by`); only where that fails are others guessed (`plan_drive_by`). Where no such motion is found, or
a slower one, stop-and-pick stays. Everything after the lift is carried out as planned before.
"""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Unpack

import numpy as np

from .. import _core
from .._core import InvalidInput, JointGroup, Outcome, Pick, World
from .._files import write_files
from .._options import DriveByOptions
from .._progress import Progress
from ..scenario import Scenario
from .planning import ScenarioPlan, file_name
from .round_motion import RoundMotion

SETTLING = 0.1  # fingers press before the part is lifted [s]
APPROACH_SPEED = (
    0.25  # of the tool as it comes to the part [m/s]; arms that brake from more in so short a way overshoot
)
PLANNED_SHARE = 5 / 6  # of the base's speed; what is left corrects its way
WAYPOINTS = (35, 45)  # tried one after the other
WITHIN = 1e-7  # of the goal [rad]
BETWEEN = 9  # samples written between waypoints
MERGED = ("transit", "approach", "lift")  # motions of a pick that the drive takes in


@dataclass
class DriveByPick:
    """One leg of the route with the pick at its end, both ways."""

    leg: int
    stop: int
    pick: int
    """Index into the plan's picks."""
    part: str
    stop_and_pick: float
    """Drive, reach, approach, close, lift, one after the other [s]."""
    opening: float
    """Opening of the hand as it comes [m]."""
    dwell: float
    """The fingers close and press this long [s]."""
    result: _core.DriveByResult
    report: str
    """What was tried."""
    used: bool = False
    why: str = ""
    """What speaks against the motion in passing, or how fast it is at the grasp."""

    @property
    def drive_by(self) -> float:
        """What it takes now [s]."""
        return self.result.duration if self.used else self.stop_and_pick

    @property
    def close_at(self) -> float:
        """When the fingers begin to close [s]."""
        return float(self.result.events[-1]["close_time"])

    def to_dict(self) -> dict[str, Any]:
        """Times of stop-and-pick and in passing, and what came of it, as plain values."""
        out: dict[str, Any] = {
            "leg": self.leg,
            "stop": self.stop,
            "part": self.part,
            "stop_and_pick": self.stop_and_pick,
            "drive_by": self.drive_by,
            "used": self.used,
            "why": self.why,
            "report": self.report,
        }
        if self.used:
            out["events"] = self.result.events
            out["violations"] = self.result.violations
        return out

    def motion(self) -> dict[str, Any]:
        """What plan.json says of a motion that is used (docs/plan_format.md)."""
        samples = self.result.trajectory.sampled(between=BETWEEN)
        return {
            "pick": self.pick,
            "opening": self.opening,
            "close_at": self.close_at,
            "closed_at": self.close_at + self.dwell,
            "times": samples.times.tolist(),
            "positions": samples.positions.tolist(),
            "velocities": samples.velocities.tolist(),
            "accelerations": samples.accelerations.tolist(),
        }


@dataclass
class DriveByPlan:
    """A part-supply plan and what of it is done in passing."""

    plan: ScenarioPlan
    problem: _core.PartSupplyProblem = field(repr=False)
    picks: list[DriveByPick] = field(default_factory=list)

    @property
    def stop_and_pick(self) -> float:
        """Driving and moving the arm, closing and opening included, as planned before [s]."""
        problem = self.problem
        seconds = sum(leg.duration(problem.robot) for leg in self.plan.route)
        for pick in self.plan.picks:
            opening, width = _openings(problem, pick)
            seconds += pick.duration + (opening - width) / self.plan.scenario.setup.closing_speed * 2
        return seconds

    @property
    def saved(self) -> float:
        """[s]"""
        return sum(p.stop_and_pick - p.drive_by for p in self.picks)

    @property
    def drive_by(self) -> float:
        """The same with the parts taken in passing [s]."""
        return self.stop_and_pick - self.saved

    def motion(self) -> _core.RobotMotion:
        """The whole round with what is done in passing, as a robot carries it out: arm, base and gripper on one clock."""
        return RoundMotion(self.plan.scenario, self.plan.plan).make(
            {p.pick: (p.result, MERGED) for p in self.picks if p.used}
        )

    def plan_to_dict(self) -> dict[str, Any]:
        """The content of plan.json with what is done in passing, so that `mmgrasp verify` checks it as well."""
        motions = [pick.motion() for pick in self.picks if pick.used]
        return self.plan.to_dict() | {"drive_by": {"motions": motions}}

    def to_dict(self) -> dict[str, Any]:
        """Times and reports, as in drive_by.json."""
        return {
            "format": "mmgrasp-drive-by",
            "version": 1,
            "stop_and_pick": self.stop_and_pick,
            "drive_by": self.drive_by,
            "saved": self.saved,
            "picks": [p.to_dict() for p in self.picks],
        }

    def save(self, folder: str | os.PathLike[str]) -> list[Path]:
        """drive_by.json, plan.json, a CSV of the whole round, and one for each motion in passing (x, y, theta first; then wheel speeds, tasks and what is held)."""
        motions = {"round.csv": self.motion().to_csv()}
        for pick in self.picks:
            if pick.used:
                motions[f"drive_by_{pick.leg:02d}_{file_name(pick.part)}.csv"] = pick.result.to_csv(between=BETWEEN)
        written = write_files(Path(folder) / "trajectories", motions, "drive_by_*.csv")
        answers = {"drive_by.json": self.to_dict(), "plan.json": self.plan_to_dict()}
        texts = {name: json.dumps(content, allow_nan=False) + "\n" for name, content in answers.items()}
        return [*write_files(Path(folder), texts), *written]


def check_in_passing(scenario: Scenario) -> None:
    """Raises InvalidInput for a round of which no part can be taken in passing."""
    if scenario.setup.gripper.suction is not None:
        raise InvalidInput("drive-by: needs a hand with fingers, which close in passing; this one has suction cups")
    if scenario.setup.place_region.capacity:
        raise InvalidInput("drive-by: parts are not taken in passing with a place_region.capacity, of several trips")


def plan_drive_by_picks(
    plan: ScenarioPlan, *, progress: Progress = None, **options: Unpack[DriveByOptions]
) -> DriveByPlan:
    """Tries to take the first part at each stop in passing. Keywords are those of `plan_drive_by`.

    Raises InvalidInput for a plan that is not solved and for a robot that does not drive.
    """
    if plan.outcome != Outcome.solved:
        raise InvalidInput(f"plan: is not solved ({plan.outcome.name})")
    problem = plan.scenario.problem()
    if problem.robot.base == "fixed":
        raise InvalidInput("plan: the robot has a fixed base")
    check_in_passing(plan.scenario)
    out = DriveByPlan(plan, problem)
    removed: set[tuple[int, int]] = set()
    here = np.asarray(problem.start, float)
    for leg, stop in enumerate(plan.stops):
        picks = [i for i, pick in enumerate(plan.picks) if pick.stop == leg]
        if picks:
            out.picks.append(_in_passing(plan, problem, leg, here, picks[0], removed, progress, options))
        removed.update((plan.picks[i].tray, plan.picks[i].part) for i in picks)
        here = np.asarray(stop.pose, float)
    return out


def _in_passing(
    plan: ScenarioPlan,
    problem: _core.PartSupplyProblem,
    leg: int,
    here: np.ndarray,
    index: int,
    removed: set[tuple[int, int]],
    progress: Progress,
    options: DriveByOptions,
) -> DriveByPick:
    pick = plan.picks[index]
    part = problem.trays[pick.tray].parts[pick.part]
    opening, width = _openings(problem, pick)
    merged = [m for m in pick.motions if m.kind in MERGED]
    closing = (opening - width) / plan.scenario.setup.closing_speed
    before = plan.route[leg].duration(problem.robot) + sum(m.trajectory.duration for m in merged) + closing
    T_grasp = part.T_world_part @ part.grasps[pick.grasp].T_object_hand
    T_before = T_grasp.copy()
    T_before[:3, 3] -= (
        float(problem.options["approach_distance"]) * T_grasp[:3, :3] @ np.asarray(problem.gripper.approach)
    )
    dwell = closing + SETTLING
    tasks = [
        _core.DriveByTask(T_before, tolerance=[0.003] * 3 + [0.02] * 3, max_tool_speed=APPROACH_SPEED),
        _core.DriveByTask(T_grasp, dwell=dwell, object=part.name),
    ]
    # The arm's numbers as the pick before left them: continuous joints may be whole turns from home.
    start = np.array([*here, *merged[0].trajectory.positions[0]])
    stage = f"drive-by {leg + 1} of {len(plan.stops)}: {part.name}"
    group, world = _moving_group(plan, problem, opening), _world(problem, removed)
    forward = progress and (lambda _, fraction: progress(stage, fraction))
    known = _one_after_the_other(plan.route[leg].poses, plan.route[leg].duration(problem.robot), merged, dwell)
    reports = []
    for waypoints in [options["waypoints"]] if "waypoints" in options else WAYPOINTS:
        keywords: DriveByOptions = {**options, "waypoints": waypoints}
        result = _core.shorten_drive_by(group, world, tasks=tasks, **known, progress=forward, **keywords)
        reports.append(result.report)
        if result.outcome == Outcome.solved:
            break
    else:
        goal = _exactly(start, [*plan.stops[leg].pose, *merged[-1].trajectory.positions[-1]])
        keywords = {"iterations": 600, **keywords}
        result = _core.plan_drive_by(
            group.robot, group, world, start=start, tasks=tasks, goal=goal, progress=forward, **keywords
        )
        reports.append(result.report)
    made = DriveByPick(leg, leg, index, part.name, before, opening, dwell, result, "".join(reports))
    if result.outcome != Outcome.solved:
        made.why = f"{result.solves} solves, {result.outcome.name}: {_broken(result)}"
    elif result.duration >= before:
        made.why = f"in passing it would take {result.duration:.1f} s"
    else:
        made.used = True
        made.why = f"base at {result.events[-1]['base_speed']:.2f} m/s as the hand closes"
    return made


def _one_after_the_other(
    poses: np.ndarray, driving: float, motions: list[_core.PickMotion], dwell: float
) -> dict[str, Any]:
    """Drive, reach, approach, closing and lift as times and rows of base and arm; the tasks are at the ends of reach and approach."""
    poses = np.asarray(poses, float)
    steps = np.abs(np.diff(poses, axis=0))
    shares = np.concatenate([[0.0], np.cumsum(np.hypot(steps[:, 0], steps[:, 1]) + 0.5 * steps[:, 2])])
    home = motions[0].trajectory.positions[0]
    moves = np.concatenate([[True], np.diff(shares) > 0])
    times = list(driving * shares[moves] / shares[-1])
    rows = [np.concatenate([pose, home]) for pose in poses[moves]]
    reached = []
    for motion in motions:
        trajectory = motion.trajectory
        begin = times[-1]
        times += [begin + t for t in trajectory.times[1:]]
        rows += [np.concatenate([poses[-1], q]) for q in trajectory.positions[1:]]
        if motion.kind in ("transit", "approach"):
            reached.append(times[-1])
        if motion.kind == "approach":
            times.append(times[-1] + dwell)
            rows.append(rows[-1])
    return {"times": times, "positions": np.array(rows), "task_times": reached}


def _broken(result: _core.DriveByResult) -> str:
    """What stands against the best iterate, in one line."""
    broken = [
        f"{kind} {v['value']:.2g} {v['unit']} ({v['what']}, {v['time']:.1f} s)"
        for kind, v in result.violations.items()
        if not v["kept"]
    ]
    return "; ".join(broken) or result.report.strip()


def _exactly(start: np.ndarray, goal: list[float]) -> np.ndarray:
    """The goal as a box (2, n), so that joints more than half a turn away are reached as they stand: the next motion begins there."""
    box = np.array([goal, goal], float)
    far = np.abs(box[0] - start) > np.pi
    far[:3] = False
    box[:, far] += np.array([[-WITHIN], [WITHIN]])
    return box


def _openings(problem: _core.PartSupplyProblem, pick: Pick) -> tuple[float, float]:
    """Openings of the open hand and of the hand around the part [m]."""
    width = problem.trays[pick.tray].parts[pick.part].grasps[pick.grasp].opening
    return pick.motions[0].opening, width


def _slower(robot: _core.Robot) -> _core.Robot:
    """The robot whose base is planned slower than it can drive: a tracker that has nothing in hand stays behind for ever."""
    limits = {key: value for key, value in robot.base_limits.items() if np.isfinite(value)}
    for key in ("linear_velocity", "angular_velocity", "wheel_velocity"):
        if key in limits:
            limits[key] *= PLANNED_SHARE
    return _core.Robot.from_strings(robot.to_urdf(), robot.to_srdf(), base=robot.base, base_limits=limits)


def _moving_group(plan: ScenarioPlan, problem: _core.PartSupplyProblem, opening: float) -> JointGroup:
    joints = {**plan.scenario.setup.other_joints, **problem.gripper.joint_values(opening)}
    group = _slower(problem.robot).group(problem.arm.name, tip=problem.gripper.tool_link, with_base=True)
    return group.with_reference(joints)


def _world(problem: _core.PartSupplyProblem, removed: set[tuple[int, int]]) -> World:
    """Scene and the parts still in place."""
    world = problem.world.copy()
    for t, tray in enumerate(problem.trays):
        for p, part in enumerate(tray.parts):
            if (t, p) in removed:
                world.forget(part.name)
            else:
                world.add(part.name, part.shapes, part.T_world_part)
    return world
