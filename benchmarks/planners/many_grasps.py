"""Planning over many grasps at once beside what people do with one planner and a list of grasps.

    python benchmarks/planners/many_grasps.py [--cells 1 2 ...] [--grasps 500] [--runs 2] [--seconds 5] [--fcl PROGRAM]

Prints one JSON line with the settings, then one for each cell, run and program. Everything runs in this process on one
thread, over the same cells, grasps and edge step, and but for `today` with our collision checker; inverse kinematics counts for all, building
the roadmap does not. Times are processor time. Programs:

    ours, prm_star_mg   over the default roadmap, built beforehand, then refined until the time is over
    ours, rrt_star_mg   until the time is over
    prm_star_mg alone, rrt_star_mg alone    the same without `first_grasps`: all ends first, then the planner by itself
    today               one by one with FCL for collisions, as people put OMPL and FCL together; no cost of its own
    one by one          OMPL's RRT-Connect for each grasp in turn, `--each` seconds for it, until one succeeds
    one by one, ours    the same with our RRT-Connect
    all goals           OMPL's RRT-Connect from one start of every grasp to all its goals, budgets doubled from round to round
    informed            OMPL's Informed RRT* for each grasp in turn, the same total time shared out evenly
    restarts            our RRT-Connect for all grasps in turn, again and again from other seeds and starts, each path
                        shortened, until the time is over; a grasp whose ends are farther apart than the best path is
                        long is left out

All of them are given up to eight arm configurations of a grasp at each end. First paths are timed `--repeats` times, before
they are shortened, and the median counts. Costs are joint-space lengths of the best path after `--seconds`, for programs that
end with their first path of that one. All final paths are shortened, each by plan_motion's own shortening: `informed` one
of every grasp, `restarts` every path, those that end with their first path that one, ours the first and the roadmap's, and in refinement each round's. Our
planners say which stage found the first path and which the one that was shortened last.
"""

from __future__ import annotations

import argparse
import itertools
import json
import math
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np
from transfer_text import write_transfers

import mmgrasp as mg
from mmgrasp.problems.pipe_cells import ROBOTS, PipeCell, pipe_cell

UNLIMITED = 10_000_000
CONFIGURATIONS = 8  # of the arm, for a grasp at each end
FIRST_BUDGET, LARGEST_BUDGET = 100, 100_000  # iterations of RRT-Connect in `restarts`
NONE = {"first": None, "cost": None}


class Enough(Exception):  # noqa: N818 - it is no error
    """Ends a call with its first path."""


def ours(planner: str, **settings):
    def run(cell: PipeCell, grasps: list[mg.Grasp], seed: int, given: argparse.Namespace, only_first: bool) -> dict:
        options: dict = {"planner": planner, "seed": seed, "threads": 1, "time_limit": given.seconds, **settings}
        if planner == "prm_star_mg":
            options["roadmap"] = mg.planning.Roadmap.build(cell.arm, seed=seed)
            options["refinements"] = UNLIMITED
        else:
            options["max_iterations"] = UNLIMITED
        problem, reported = cell.problem(grasps), []

        def improved(_) -> None:
            reported.append(time.process_time() - begin)
            if only_first:
                raise Enough

        begin = time.process_time()
        try:
            result = mg.plan_manipulation(problem, on_solution=improved, **options)
        except Enough:
            return {**NONE, "first": reported[0]}
        if result.outcome != mg.Outcome.solved:
            return NONE
        stages = [better.stage for better in result.improvements]
        final = next((stage for stage in reversed(stages) if stage != "shortening"), stages[-1])
        return {"first": reported[0], "cost": result.cost, "stages": [stages[0], final]}

    return run


class Ends:
    """Arm configurations of each grasp, computed when first asked for."""

    def __init__(self, cell: PipeCell, grasps: list[mg.Grasp]) -> None:
        self.cell, self.grasps, self.kept = cell, grasps, {}

    def __getitem__(self, i: int):
        if i not in self.kept:
            self.kept[i] = self.cell.ends(self.grasps[i], CONFIGURATIONS)
        return self.kept[i]

    def usable(self):
        """Grasps within reach at both ends, in turn."""
        return (i for i in range(len(self.grasps)) if all(map(len, self[i])))


def plan(cell: PipeCell, grasp: mg.Grasp, start, goals, **options):
    group, world = cell.arm_holding(grasp), cell.world_holding(grasp)
    return mg.plan_motion(
        cell.robot, group, world, start=start, goal=goals, joint_step=0.02, workspace_step=0.005, **options
    )


def first_of(cell: PipeCell, grasp: mg.Grasp, begin: float, only_first: bool, *ends, **options) -> dict | None:
    """Time until a path is found, and its length once shortened; None without one."""
    if plan(cell, grasp, *ends, shorten=False, **options).outcome != mg.Outcome.solved:
        return None
    first = time.process_time() - begin
    if only_first:
        return {**NONE, "first": first}
    shortened = plan(cell, grasp, *ends, **options)
    return {"first": first, "cost": shortened.cost if shortened.outcome == mg.Outcome.solved else None}


def one_by_one(planner: str):
    def run(cell: PipeCell, grasps: list[mg.Grasp], seed: int, given: argparse.Namespace, only_first: bool) -> dict:
        begin, ends = time.process_time(), Ends(cell, grasps)
        for i in ends.usable():
            starts, goals = ends[i]
            options = {
                "planner": planner,
                "seed": seed,
                "time_limit": given.each / len(starts),
                "max_iterations": UNLIMITED,
            }
            for start in starts:
                found = first_of(cell, grasps[i], begin, only_first, start, goals, **options)
                if found:
                    return found
            if time.process_time() - begin > given.cap:
                break
        return NONE

    return run


def today(cell: PipeCell, grasps: list[mg.Grasp], seed: int, given: argparse.Namespace, only_first: bool) -> dict:
    begin, ends = time.process_time(), Ends(cell, grasps)
    planning, apart = 0.0, 0.0  # [s] in the other program; on what it is given
    for i in ends.usable():
        before = time.process_time()
        starts, goals = ends[i]
        with tempfile.TemporaryDirectory() as folder:
            text = Path(folder) / "transfers.txt"
            write_transfers(cell, [(grasps[i], start, goals) for start in starts], text)
            command = [given.fcl, text, str(seed), str(given.each / len(starts))]
            answer = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
        apart += time.process_time() - before
        planning += answer["seconds"]
        spent = time.process_time() - begin - apart + planning
        if answer["solved"]:
            return {**NONE, "first": spent}
        if spent > given.cap:
            break
    return NONE


def all_goals(cell: PipeCell, grasps: list[mg.Grasp], seed: int, given: argparse.Namespace, only_first: bool) -> dict:
    begin, ends, budget = time.process_time(), Ends(cell, grasps), 100
    while time.process_time() - begin < given.cap:
        for i in ends.usable():
            starts, goals = ends[i]
            options = {"planner": "ompl_rrt_connect", "seed": seed, "time_limit": given.cap, "max_iterations": budget}
            found = first_of(cell, grasps[i], begin, only_first, starts[0], goals, **options)
            if found:
                return found
            if time.process_time() - begin > given.cap:
                break
        budget *= 2
    return NONE


def informed(cell: PipeCell, grasps: list[mg.Grasp], seed: int, given: argparse.Namespace, only_first: bool) -> dict:
    begin, ends, reported = time.process_time(), Ends(cell, grasps), []
    usable = list(ends.usable())
    best = math.inf
    for turn, i in enumerate(usable):
        left = given.seconds - (time.process_time() - begin)
        if left <= 0 or (only_first and reported):
            break
        starts, goals = ends[i]
        found = plan(
            cell, grasps[i], starts[0], goals, planner="informed_rrt_star", time_limit=max(left / (len(usable) - turn), 1e-3),
            max_iterations=UNLIMITED, seed=seed,
        )  # fmt: skip
        if found.outcome == mg.Outcome.solved:
            reported.append(time.process_time() - begin)
            best = min(best, found.cost)
    return {"first": reported[0], "cost": best} if best < math.inf else NONE


def restarts(cell: PipeCell, grasps: list[mg.Grasp], seed: int, given: argparse.Namespace, only_first: bool) -> dict:
    begin, ends, held = time.process_time(), Ends(cell, grasps), {}
    best, first = math.inf, None
    for round_ in itertools.count():
        budget, planned = min(FIRST_BUDGET * 2**round_, LARGEST_BUDGET), 0
        for i in ends.usable():
            left = given.seconds - (time.process_time() - begin)
            if left <= 0:
                return {"first": first, "cost": best} if first is not None else NONE
            starts, goals = ends[i]
            start = starts[round_ % len(starts)]
            if np.linalg.norm(goals - start, axis=1).min() >= best:
                continue
            if i not in held:
                held[i] = cell.arm_holding(grasps[i]), cell.world_holding(grasps[i])
            planned += 1
            found = mg.plan_motion(
                cell.robot, *held[i], start=start, goal=goals, joint_step=0.02, workspace_step=0.005, seed=seed + 7919 * round_ + i,
                time_limit=left, max_iterations=budget, shorten=first is not None,
            )  # fmt: skip
            if found.outcome != mg.Outcome.solved:
                continue
            best = min(best, found.cost)
            if first is None:
                first = time.process_time() - begin
                if only_first:
                    return {**NONE, "first": first}
        if not planned:  # Nothing can be cheaper, or no grasp is within reach.
            return {"first": first, "cost": best} if first is not None else NONE


PROGRAMS = {
    "ours, prm_star_mg": ours("prm_star_mg"),
    "ours, rrt_star_mg": ours("rrt_star_mg"),
    "prm_star_mg alone": ours("prm_star_mg", first_grasps=0),
    "rrt_star_mg alone": ours("rrt_star_mg", first_grasps=0),
    "today": today,
    "one by one": one_by_one("ompl_rrt_connect"),
    "one by one, ours": one_by_one("rrt_connect"),
    "all goals": all_goals,
    "informed": informed,
    "restarts": restarts,
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", type=int, nargs="+", default=list(range(1, 9)))
    parser.add_argument("--robots", nargs="+", choices=ROBOTS, default=list(ROBOTS))
    parser.add_argument("--seed", type=int, default=1, help="of the cells")
    parser.add_argument("--grasps", type=int, default=500)
    parser.add_argument("--runs", type=int, default=2, help="lists of grasps for each cell")
    parser.add_argument("--repeats", type=int, default=5, help="of first paths")
    parser.add_argument("--seconds", type=float, default=5.0, help="total time of the anytime programs [s]")
    parser.add_argument("--each", type=float, default=1.0, help="time for one grasp of `one by one` [s]")
    parser.add_argument("--cap", type=float, default=60.0, help="after which a program without a path gives up [s]")
    parser.add_argument("--fcl", help="the program bench_transfer_fcl")
    parser.add_argument("--programs", nargs="+", choices=list(PROGRAMS), default=list(PROGRAMS))
    given = parser.parse_args()
    if given.fcl is None and "today" in given.programs:
        given.programs.remove("today")
    print(json.dumps({"settings": {**vars(given), "configurations": CONFIGURATIONS}}), flush=True)
    for robot, number in itertools.product(given.robots, given.cells):
        cell = pipe_cell(number, seed=given.seed, robot=robot)
        for run in range(given.runs):
            grasps = cell.grasps(given.grasps, seed=1000 + run)
            reachable = sum(1 for _ in Ends(cell, grasps).usable())
            for name in given.programs:
                line = {"robot": robot, "cell": number, "run": run, "reachable": reachable, "program": name}
                found = PROGRAMS[name](cell, grasps, run + 1, given, False)
                if found["first"] is not None:
                    again = [PROGRAMS[name](cell, grasps, run + 1, given, True) for _ in range(given.repeats)]
                    found["first"] = statistics.median(a["first"] for a in again if a["first"] is not None)
                print(json.dumps({**line, **found}), flush=True)


if __name__ == "__main__":
    main()
