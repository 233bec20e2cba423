"""Several robots in one room: when each may go so that they never meet, the first of them as it likes, the others around those before."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

from .. import _core
from .._argument_errors import checked
from .._core import InvalidInput, Outcome
from .._files import check_file, printable, sha256_of, write_file, write_files
from .._progress import Progress, growing
from ..documents.reading import read_json
from .carried_out import check_carried_out
from .course import Course
from .plan_file import check_form, check_names
from .plan_reader import plan_to_check
from .schedule_rules import FORMAT, LEAST_CLEARANCE, MOST_CLEARANCE, MOST_ROBOTS, VERSION, check_same_room
from .schedule_search import ScheduleSearch
from .scheduled_robot import ScheduledRobot
from .shared_areas import SharedArea, area_to_dict, shared_areas


@dataclass(frozen=True)
class Schedule:
    """What `schedule_plans` found."""

    outcome: Outcome
    """solved; infeasible: it is proven that waiting does not help; not_found: it is not proven that robots can pass each other, nor that they cannot."""
    clearance: float
    robots: list[ScheduledRobot]
    """The robots in the order of their priority; those before the one that finds no way where there is no schedule."""
    areas: list[SharedArea] = field(default_factory=list)
    obstruction: str = ""
    """Who is in whose way, where there is no schedule."""

    def to_dict(self) -> dict[str, Any]:
        """The content of schedule.json (docs/plan_format.md)."""
        return {
            "format": FORMAT,
            "version": VERSION,
            "mmgrasp": _core.__version__,
            "outcome": self.outcome.name,
            "clearance": self.clearance,
            "robots": [_robot_to_dict(robot) for robot in self.robots],
            "areas": [area_to_dict(area) for area in self.areas],
            "obstruction": self.obstruction,
        }

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Writes schedule.json. Raises IoError where a file is that is no schedule."""
        target = Path(path)
        check_file(target, b'{"format": "mmgrasp-schedule"')
        write_file(target, json.dumps(self.to_dict(), allow_nan=False) + "\n")
        return target

    def save_trajectories(self, folder: str | os.PathLike[str]) -> list[Path]:
        """One CSV and one ROS message (JSON) for the round of each robot, waits included, all on one clock."""
        contents = {}
        for i, robot in enumerate(self.robots if self.outcome == Outcome.solved else []):
            motion = robot.motion()
            contents[f"robot_{i + 1}.csv"] = motion.to_csv()
            contents[f"robot_{i + 1}.json"] = json.dumps(motion.to_joint_trajectory(), allow_nan=False) + "\n"
        return write_files(Path(folder), contents, "robot_*.csv", "robot_*.json")

    def __repr__(self) -> str:
        if self.outcome != Outcome.solved:
            return f"Schedule({self.outcome.name}: {self.obstruction})"
        ends = ", ".join(f"{robot.end:.1f} s after {robot.waited:.1f} s of waiting" for robot in self.robots)
        return f"Schedule(solved, done at {ends})"


def _robot_to_dict(robot: ScheduledRobot) -> dict[str, Any]:
    rows = zip(robot.course.pieces, robot.starts, robot.waits(), strict=True)
    return {
        "plan": str(robot.plan),
        "sha256": robot.sha256,
        "end": robot.end,
        "waited": robot.waited,
        "earliest_end": robot.earliest_end,
        "pieces": [
            {"name": piece.name, "wait": wait, "start": start, "duration": piece.duration}
            for piece, start, wait in rows
        ],
    }


@checked
def schedule_plans(
    plans: Sequence[str | os.PathLike[str]], *, clearance: float = 0.1, progress: Progress = None
) -> Schedule:
    """Finds when each of several robots may begin each piece of its plan, so that they never come closer to each other than `clearance` [m].

    `plans`: a plan.json each, of one room, in the order of their priority. The first robot goes as planned; each other one goes as early as those before it
    allow, and waits where it stands still: at its start, after each straight section of a drive and after each motion of its arm. All of the robots counts,
    with arms and parts in their hands, at every moment: before they start and after they have reached their goals, too. Parts in bins do not. That no
    schedule is found is said by `outcome` and `obstruction`. Raises InvalidInput or IoError for plans that cannot be read, are not solved, are of different
    rooms or pick the same part.
    """
    if not LEAST_CLEARANCE <= clearance <= MOST_CLEARANCE:
        raise InvalidInput(f"clearance = {clearance:g}: must be in [{LEAST_CLEARANCE:g}, {MOST_CLEARANCE:g}] [m]")
    plans = list(plans)
    if not 2 <= len(plans) <= MOST_ROBOTS:
        raise InvalidInput(f"plans: {len(plans)} are given: must be 2 to {MOST_ROBOTS}, one a robot")
    labels = [f"robot {i + 1} ({printable(os.fspath(plan))})" for i, plan in enumerate(plans)]
    with growing(progress, labels) as progress:
        tell = progress or (lambda stage, fraction: None)
        given = []
        for i, (plan, label) in enumerate(zip(plans, labels, strict=True)):
            tell("reading plans", i / len(plans))
            given.append(_read(Path(plan), label))
        check_same_room([one.content for one in given], [os.fspath(plan) for plan in plans])
        return _schedule(given, clearance, tell)


@dataclass(frozen=True)
class _GivenPlan:
    """A plan as it was read."""

    path: Path
    label: str
    content: dict[str, Any]
    sha256: str


def _read(path: Path, label: str) -> _GivenPlan:
    """Raises InvalidInput for a plan that is damaged: the check reads every value."""
    sha256 = sha256_of(path)
    root = read_json(path).root
    check_form(root)
    check_names(root)
    if root["outcome"].raw == "solved":
        check_carried_out(root)
        with root["scenario"].blamed():
            plan_to_check(root)
    return _GivenPlan(Path(os.path.abspath(path)), label, root.raw, sha256)


def _schedule(given: Sequence[_GivenPlan], clearance: float, tell: Callable[[str, float], None]) -> Schedule:
    robots: list[ScheduledRobot] = []
    areas: list[SharedArea] = []
    for i, plan in enumerate(given):
        tell(plan.label, 0.0)
        course = _course_of(plan)
        search = ScheduleSearch(course, robots, clearance, partial(tell, plan.label))
        found, bound = search.find(), search.find(only_sure=True)
        if found.starts is None:
            outcome = Outcome.infeasible if bound.starts is None else Outcome.not_found
            return Schedule(outcome, clearance, robots, areas, search.obstruction())
        robot = ScheduledRobot(plan.path, plan.sha256, course, found.starts, bound.arrival)
        for k, other in enumerate(robots):
            areas += shared_areas(k, i, (other, robot), search.meetings[k])
        robots.append(robot)
    return Schedule(Outcome.solved, clearance, robots, areas)


def _course_of(plan: _GivenPlan) -> Course:
    try:
        course = Course(plan.content, plan.label)
    except InvalidInput as error:
        raise InvalidInput(f"{plan.label}: {error}") from None
    if not course.pieces:
        raise InvalidInput(f"{plan.label}: does not move in its plan: put it among the obstacles")
    return course
