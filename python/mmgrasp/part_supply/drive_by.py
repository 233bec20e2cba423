"""Parts taken in passing (P1 chapter 4 in the main job): every pick is one motion with the way to it.

A plan of `plan_part_supply` drives, stops and then picks, each time from home and back. Here everything from where a part is let go to
where the next one is (retreat, drive, reach, approach, lift, transfer) becomes one motion of base and arm through the grasp; the base
does not stop for it, and the arm does not come home between picks. The motions as planned, one after the other, are where the search
begins (`shorten_drive_by`); only where that fails are others guessed (`plan_drive_by`). Where no such motion is found, or a slower
one, the planned ones stay. Places where parts are let go are those of the plan, so that each motion stands by itself.
"""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Unpack

import numpy as np

from .. import _core
from .._argument_errors import checked
from .._core import InvalidInput, Outcome, Pick
from .._files import write_files
from .._options import DriveByOptions
from .._progress import Progress
from ..scenario import Scenario
from .known_motion import SETTLING, KnownPick
from .planning import ScenarioPlan, file_name
from .round_motion import InPassing, RoundMotion

WAYPOINTS = (35, 45)  # tried one after the other
BETWEEN = 9  # samples written between waypoints
LONGEST_DWELL = 12.0  # the library holds the tool in 100 steps of at most 0.12 s; none of longer ones were solved [s]


@dataclass
class DriveByPick:
    """One pick with the way to it, both ways."""

    stop: int
    pick: int
    """Index into the plan's picks."""
    part: str
    stop_and_pick: float
    """What the motion stands for, one after the other [s]."""
    opening: float
    """Opening of the hand as it comes [m]."""
    dwell: float
    """The fingers close and press this long [s]."""
    base: np.ndarray
    """Where the base stands after it, (x, y, theta)."""
    result: _core.DriveByResult
    report: str
    """What was tried."""
    used: bool = False
    why: str = ""
    """What speaks against the motion, or how fast the base is at the grasp."""

    @property
    def from_release(self) -> bool:
        """It begins where the pick before lets its part go; else at home."""
        return self.pick > 0

    @property
    def drives(self) -> bool:
        """The base drives to the stop in it."""
        return self.result.trajectory is not None and self.result.trajectory.names[0] == "x"

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
            "pick": self.pick,
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
        stands = np.zeros((len(samples.times), 0 if self.drives else 3))
        return {
            "pick": self.pick,
            "begins": "release" if self.from_release else "home",
            "ends": "release",
            "opening": self.opening,
            "close_at": self.close_at,
            "closed_at": self.close_at + self.dwell,
            "times": samples.times.tolist(),
            "positions": np.hstack([stands + self.base[: stands.shape[1]], samples.positions]).tolist(),
            "velocities": np.hstack([stands, samples.velocities]).tolist(),
            "accelerations": np.hstack([stands, samples.accelerations]).tolist(),
        }


@dataclass
class DriveByPlan:
    """A part-supply plan and what of it is done in passing."""

    plan: ScenarioPlan
    problem: _core.PartSupplyProblem = field(repr=False)
    picks: list[DriveByPick] = field(default_factory=list)

    @property
    def stop_and_pick(self) -> float:
        """Driving and moving the arm, the gripper's times included, as planned before [s]."""
        seconds = sum(leg.duration(self.problem.robot) for leg in self.plan.route)
        seconds += sum(pick.duration for pick in self.plan.picks)
        return seconds + self._gripper_time(set())

    @property
    def drive_by(self) -> float:
        """The same with the parts taken in passing [s]."""
        used = {pick.pick for pick in self.picks if pick.used}
        closing = sum(self._closing(self.plan.picks[i]) for i in used)  # is in the motions, both ways
        saved = sum(pick.stop_and_pick - pick.drive_by for pick in self.picks)
        gripper = self._gripper_time(set()) - self._gripper_time(used) - closing
        return self.stop_and_pick - saved - gripper

    @property
    def saved(self) -> float:
        """[s]"""
        return self.stop_and_pick - self.drive_by

    def _closing(self, pick: Pick) -> float:
        """What the fingers need to close on the part [s]."""
        width = self.problem.trays[pick.tray].parts[pick.part].grasps[pick.grasp].opening
        return (pick.motions[0].opening - width) / self.plan.scenario.setup.closing_speed

    def _gripper_time(self, in_passing: set[int]) -> float:
        """While everything else stands and the fingers open or close [s]; they stand open for the first part when the round begins."""
        openings, closing = [], 0.0
        for i, pick in enumerate(self.plan.picks):
            width = self.problem.trays[pick.tray].parts[pick.part].grasps[pick.grasp].opening
            openings += [pick.motions[0].opening, width]
            if i in in_passing:
                closing += pick.motions[0].opening - width
            if i + 1 not in in_passing:
                openings.append(pick.motions[-1].opening)
        moved = np.abs(np.diff(openings)).sum() if openings else 0.0
        return float(moved - closing) / self.plan.scenario.setup.closing_speed

    def motion(self) -> _core.RobotMotion:
        """The whole round with what is done in passing, as a robot carries it out: arm, base and gripper on one clock."""
        return RoundMotion(self.plan.scenario, self.plan.plan).make(
            {p.pick: InPassing(p.result, p.from_release) for p in self.picks if p.used}
        )

    def plan_to_dict(self) -> dict[str, Any]:
        """The content of plan.json with what is done in passing, so that `mmgrasp verify` checks it as well."""
        motions = [pick.motion() for pick in self.picks if pick.used]
        return self.plan.to_dict() | {"drive_by": {"motions": motions}}

    def to_dict(self) -> dict[str, Any]:
        """Times and reports, as in drive_by.json."""
        return {
            "format": "mmgrasp-drive-by",
            "version": 2,
            "stop_and_pick": self.stop_and_pick,
            "drive_by": self.drive_by,
            "saved": self.saved,
            "picks": [p.to_dict() for p in self.picks],
        }

    def save(self, folder: str | os.PathLike[str]) -> list[Path]:
        """drive_by.json, plan.json, a CSV of the whole round, and one for each motion in passing (x, y, theta first where the base moves; then
        wheel speeds, tasks and what is held)."""
        motions = {"round.csv": self.motion().to_csv()}
        for pick in self.picks:
            if pick.used:
                motions[f"drive_by_{pick.pick:02d}_{file_name(pick.part)}.csv"] = pick.result.to_csv(between=BETWEEN)
        written = write_files(Path(folder) / "trajectories", motions, "drive_by_*.csv")
        answers = {"drive_by.json": self.to_dict(), "plan.json": self.plan_to_dict()}
        texts = {name: json.dumps(content, allow_nan=False) + "\n" for name, content in answers.items()}
        return [*write_files(Path(folder), texts), *written]


def check_in_passing(scenario: Scenario) -> None:
    """Raises InvalidInput for a round of which no part can be taken in passing."""
    sections = scenario.setup.sections
    if scenario.setup.gripper.suction is not None:
        sections.gripper["suction"].fail("drive-by needs a hand with fingers, which close in passing")
    if scenario.unload_region is not None:
        raise InvalidInput(
            f"{scenario.source}: unload_region: --drive-by takes no parts in passing that are carried to the goal in the hand, "
            "since the hand is full until then: give the robot a bin (place_region) for it"
        )
    if sections.place_region is not None and "capacity" in sections.place_region:
        sections.place_region["capacity"].fail("drive-by takes no parts of several trips in passing: leave it out")
    if scenario.drive_clearance:
        raise InvalidInput(
            f"{scenario.source}: drive_clearance = {scenario.drive_clearance:g}: motions of a drive-by do not keep it: "
            "leave it out for them"
        )
    _check_closing(scenario)


def _check_closing(scenario: Scenario) -> None:
    """Raises InvalidInput where fingers close for so long that a motion in passing would only be sought in vain, for minutes."""
    hand, speed, most = scenario.setup.gripper, scenario.setup.closing_speed, LONGEST_DWELL - SETTLING
    for tray in scenario.trays:
        for part in tray.tray.parts:
            if part.name not in tray.targets or not part.grasps:
                continue
            way = min(hand.pregrasp_opening(grasp.opening) - grasp.opening for grasp in part.grasps)
            if way / speed > most:
                section = scenario.setup.sections.gripper
                (section["closing_speed"] if "closing_speed" in section else section).fail(
                    f"fingers close for {way / speed:.4g} s on {part.name}, and drive-by takes nothing in passing that needs more than "
                    f"{most:g} s: must be at least {way / most:.4g} m/s for it"
                )


@checked
def plan_drive_by_picks(
    plan: ScenarioPlan, *, progress: Progress = None, **options: Unpack[DriveByOptions]
) -> DriveByPlan:
    """Tries to make one motion of every pick and the way to it, from where the part before is let go to where this one is. Keywords are
    those of `plan_drive_by`.

    Raises InvalidInput for a plan that is not solved and for a robot that does not drive.
    """
    if plan.outcome != Outcome.solved:
        raise InvalidInput(f"plan: is not solved ({plan.outcome.name})")
    problem = plan.scenario.problem()
    if problem.robot.base == "fixed":
        raise InvalidInput("plan: the robot has a fixed base")
    check_in_passing(plan.scenario)
    out = DriveByPlan(plan, problem)
    for index in range(len(plan.picks)):
        out.picks.append(_in_passing(KnownPick(plan, problem, index), progress, options))
    return out


def _in_passing(known: KnownPick, progress: Progress, options: DriveByOptions) -> DriveByPick:
    stage = f"drive-by {known.index + 1} of {len(known.plan.picks)}: {known.part.name}"
    forward = progress and (lambda _, fraction: progress(stage, fraction))
    group, world, tasks, motion = known.group(), known.world(), known.tasks(), known.motion()
    reports = []
    for waypoints in [options["waypoints"]] if "waypoints" in options else WAYPOINTS:
        keywords: DriveByOptions = {**options, "waypoints": waypoints}
        result = _core.shorten_drive_by(group, world, tasks=tasks, **motion, progress=forward, **keywords)
        reports.append(result.report)
        if result.outcome == Outcome.solved:
            break
    else:
        keywords = {"iterations": 600, **keywords}
        result = _core.plan_drive_by(
            group.robot,
            group,
            world,
            start=motion["positions"][0],
            tasks=tasks,
            goal=known.goal(motion["positions"][-1]),
            progress=forward,
            **keywords,
        )
        reports.append(result.report)
    before = known.duration
    stop = known.pick.stop
    base = np.asarray(known.plan.stops[stop].pose, float)
    made = DriveByPick(
        stop, known.index, known.part.name, before, known.opening, known.dwell, base, result, "".join(reports)
    )
    if result.outcome != Outcome.solved:
        made.why = f"{result.solves} solves, {result.outcome.name}: {_broken(result)}"
    elif result.duration >= before:
        made.why = f"in passing it would take {result.duration:.1f} s"
    else:
        made.used = True
        speed = f"base at {result.events[-1]['base_speed']:.2f} m/s as the hand closes"
        made.why = speed if known.drives else "the base stands"
    return made


def _broken(result: _core.DriveByResult) -> str:
    """What stands against the best iterate, in one line."""
    broken = [
        f"{kind} {v['value']:.2g} {v['unit']} ({v['what']}, {v['time']:.1f} s)"
        for kind, v in result.violations.items()
        if not v["kept"]
    ]
    return "; ".join(broken) or result.report.strip()
