"""MotionBenchMaker's problems solved and checked again: what `mmgrasp bench mbm` prints."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Unpack

import numpy as np

from .._core import IoError, Robot, plan_motion, planner_names
from .._core.verify import CheckedBody, check_path
from .._options import MotionOptions
from ..documents.reading import check_name
from .motion_bench import MBM_SETS, MotionProblem, read_motion_problems

ROBOTS = ("panda", "ur5")
LEAST_SOLVED = 0.995
"""Share of the problems that is to be solved, with every path free at the verification's step."""


@dataclass
class SetResult:
    """The runs of one set of problems."""

    robot: str
    name: str
    seconds: list[float] = field(default_factory=list)
    """Planning, the checker being ready [s]; of every run, solved or not."""
    calls: list[float] = field(default_factory=list)
    """The whole call, which builds the checker, too [s]."""
    lengths: list[float] = field(default_factory=list)
    solved: int = 0
    verified: int = 0
    faults: list[str] = field(default_factory=list)
    """What was not solved, and what is wrong with paths that do not hold."""

    def to_dict(self) -> dict[str, Any]:
        """Times in milliseconds."""
        times, calls = 1e3 * np.array(self.seconds), 1e3 * np.array(self.calls)
        return {
            "robot": self.robot,
            "set": self.name,
            "runs": len(times),
            "solved": self.solved,
            "verified": self.verified,
            "median [ms]": float(np.median(times)),
            "p95 [ms]": float(np.quantile(times, 0.95)),
            "call median [ms]": float(np.median(calls)),
            "mean length [rad]": float(np.mean(self.lengths)) if self.lengths else None,
            "faults": self.faults,
        }


def verify_motion(problem: MotionProblem, robot: Robot, path: np.ndarray, joint_step: float = 0.005) -> str:
    """What is wrong with a path for the problem, by KDL and FCL called directly; empty when nothing is."""
    robot, group = problem.setting(robot)
    bodies = [
        CheckedBody(name, shapes, np.eye(4) if at is None else at) for name, (shapes, at) in problem.bodies.items()
    ]
    movable = set(robot.joints) - set(group.names)
    others = {name: value for name, value in problem.start.items() if name in movable}
    for what, wanted, q in (("start", problem.start, path[0]), ("goal", problem.goal, path[-1])):
        if any(abs(wanted[name] - value) > 1e-9 for name, value in zip(group.names, q, strict=True)):
            return f"the path does not have the problem's {what}"
    allowed = problem.world_of(robot).allowed
    return check_path(
        robot, group.names, path, bodies, other_joints=others, allowed_collisions=allowed, joint_step=joint_step
    ).where


def run_set(
    robot: Robot,
    result: SetResult,
    problems: Iterable[MotionProblem],
    seeds: Sequence[int] = (1,),
    verify_step: float = 0.005,
    **options: Unpack[MotionOptions],
) -> SetResult:
    """Solves each problem with each seed; options as plan_motion's."""
    for problem, seed in itertools.product(problems, seeds):
        of_problem, group = problem.setting(robot)
        start, goal = problem.start_of(group), problem.goal_of(group)
        begin = time.perf_counter()
        found = plan_motion(of_problem, group, problem.world_of(robot), start=start, goal=goal, seed=seed, **options)
        result.calls.append(time.perf_counter() - begin)
        result.seconds.append(found.stats.seconds)
        if found.path is None:
            result.faults.append(f"{problem.name}, seed {seed}: {found.outcome.name}")
            continue
        result.solved += 1
        result.lengths.append(found.cost)
        wrong = verify_motion(problem, robot, found.path, verify_step)
        result.verified += not wrong
        if wrong:
            result.faults.append(f"{problem.name}, seed {seed}: {wrong}")
    return result


def run_motion_bench(
    data: Path,
    robots: Sequence[str] = ROBOTS,
    sets: Sequence[str] = MBM_SETS,
    limit: int = 50,
    seeds: Sequence[int] = (1,),
    progress: Callable[[str, float], None] | None = None,
    **options: Unpack[MotionOptions],
) -> list[SetResult]:
    """Every set of every robot; `data` holds robots/<name>_vamp and planning/vamp_<name>."""
    for name in sets:
        check_name("set", name, MBM_SETS)
    for name in robots:
        check_name("robot", name, ROBOTS)
    if "planner" in options:
        check_name("planner", options["planner"], planner_names())
    options = {"time_limit": 10.0, "max_iterations": 2_000_000_000, "workspace_step": 0.005} | options
    results = []
    for done, (robot_name, name) in enumerate(itertools.product(robots, sets)):
        folder = data / f"robots/{robot_name}_vamp/{robot_name}"
        if not folder.is_dir():
            raise IoError(f"{folder}: is not there; --data names the folder with robots/ and planning/")
        robot = Robot.load(folder / f"{robot_name}.urdf", folder / f"{robot_name}.srdf")
        if progress:
            progress(f"{robot_name} {name}", done / (len(robots) * len(sets)))
        problems = list(
            itertools.islice(
                read_motion_problems(data / f"planning/vamp_{robot_name}/problems/{name}_{robot_name}"), limit
            )
        )
        results.append(run_set(robot, SetResult(robot_name, name), problems, seeds, **options))
    return results


def holds(results: Sequence[SetResult]) -> bool:
    """Whether enough is solved and every path is free."""
    runs = sum(len(r.seconds) for r in results)
    solved = sum(r.solved for r in results)
    return solved >= LEAST_SOLVED * runs and all(r.verified == r.solved for r in results)
