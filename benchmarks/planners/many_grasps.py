"""Planning over many grasps at once beside what people do with one planner and a list of grasps.

    python benchmarks/planners/many_grasps.py [--cells 1 2 ...] [--grasps 500] [--runs 3] [--seconds 5]

Prints one JSON line a cell, run and program, then a table. Everything runs in this process on one thread, over the same
cells, grasps, checker and edge step; inverse kinematics counts for all. Programs:

    ours, prm_star_mg   over a roadmap of 5000 vertices built beforehand
    ours, rrt_star_mg   until the time is over
    one by one          RRT-Connect for each grasp in turn, `--each` seconds for it, until one succeeds
    in rounds           RRT-Connect from one start of every grasp to all its goals, budgets doubled from round to round
    informed            Informed RRT* for each grasp in turn, the same total time shared out evenly

The first three stop the clock at their first path; costs are those of the best path after `--seconds` (`one by one` and
`in rounds`: of the first, shortened as plan_motion does).
"""

from __future__ import annotations

import argparse
import json
import math
import statistics
import time

import numpy as np

import mmgrasp as mg
from mmgrasp.pipe_cells import PipeCell, pipe_cell


def ours(planner: str):
    def run(cell: PipeCell, grasps: list[mg.PipeGrasp], seed: int, given: argparse.Namespace) -> dict:
        options: dict = {"planner": planner, "seed": seed, "threads": 1, "time_limit": given.seconds}
        if planner == "prm_star_mg":
            options["roadmap"] = mg.Roadmap.build(cell.arm, vertices=5000, seed=seed)
        else:
            options["max_samples"] = 10_000_000
        result = mg.plan_manipulation(cell.problem(grasps), **options)
        if result.outcome != mg.Outcome.solved:
            return {"first": None, "cost": None}
        return {
            "first": result.improvements[0].seconds,
            "cost": result.cost,
        }

    return run


class Ends:
    """Arm configurations of each grasp, computed when first asked for."""

    def __init__(self, cell: PipeCell, grasps: list[mg.PipeGrasp]) -> None:
        self.cell, self.grasps, self.kept = cell, grasps, {}

    def __getitem__(self, i: int):
        if i not in self.kept:
            self.kept[i] = self.cell.ends(self.grasps[i], 4)
        return self.kept[i]


def plan(cell: PipeCell, grasp: mg.PipeGrasp, start, goals, **options):
    return mg.plan_motion(
        cell.robot,
        cell.arm_holding(grasp),
        cell.world_holding(grasp),
        start=start,
        goal=goals,
        edge_step=0.02,
        **options,
    )


def one_by_one(cell: PipeCell, grasps: list[mg.PipeGrasp], seed: int, given: argparse.Namespace) -> dict:
    begun, ends = time.perf_counter(), Ends(cell, grasps)
    for i, grasp in enumerate(grasps):
        starts, goals = ends[i]
        if len(starts) == 0 or len(goals) == 0:
            continue
        for start in starts:
            found = plan(
                cell, grasp, start, goals, time_limit=given.each / len(starts), max_iterations=10_000_000, seed=seed
            )
            if found.outcome == mg.Outcome.solved:
                return {"first": time.perf_counter() - begun, "cost": found.cost}
        if time.perf_counter() - begun > given.cap:
            break
    return {"first": None, "cost": None}


def in_rounds(cell: PipeCell, grasps: list[mg.PipeGrasp], seed: int, given: argparse.Namespace) -> dict:
    begun, ends, budget = time.perf_counter(), Ends(cell, grasps), 100
    while time.perf_counter() - begun < given.cap:
        for i, grasp in enumerate(grasps):
            starts, goals = ends[i]
            if len(starts) == 0 or len(goals) == 0:
                continue
            found = plan(cell, grasp, starts[0], goals, max_iterations=budget, time_limit=given.cap, seed=seed)
            if found.outcome == mg.Outcome.solved:
                return {"first": time.perf_counter() - begun, "cost": found.cost}
            if time.perf_counter() - begun > given.cap:
                break
        budget *= 2
    return {"first": None, "cost": None}


def informed(cell: PipeCell, grasps: list[mg.PipeGrasp], seed: int, given: argparse.Namespace) -> dict:
    begun, ends = time.perf_counter(), Ends(cell, grasps)
    usable = [i for i in range(len(grasps)) if len(ends[i][0]) and len(ends[i][1])]
    first, best = None, math.inf
    for turn, i in enumerate(usable):
        left = given.seconds - (time.perf_counter() - begun)
        if left <= 0:
            break
        starts, goals = ends[i]
        found = plan(
            cell, grasps[i], starts[0], goals, planner="informed_rrt_star", time_limit=max(left / (len(usable) - turn), 1e-3),
            max_iterations=10_000_000, seed=seed,
        )  # fmt: skip
        if found.outcome == mg.Outcome.solved:
            first = time.perf_counter() - begun if first is None else first
            best = min(best, found.cost)
    return {"first": first, "cost": best if first is not None else None}


PROGRAMS = {
    "ours, prm_star_mg": ours("prm_star_mg"),
    "ours, rrt_star_mg": ours("rrt_star_mg"),
    "one by one": one_by_one,
    "in rounds": in_rounds,
    "informed": informed,
}


def table(lines: list[dict]) -> str:
    peers = ("one by one", "in rounds", "informed")
    names = [n for n in PROGRAMS if any(line["program"] == n for line in lines)]
    out = [
        "| program | solved | first solution, median [s] | cost, mean over what all solved |",
        "|---|---:|---:|---:|",
    ]
    keys = sorted({(line["cell"], line["run"]) for line in lines})
    by = {(line["program"], line["cell"], line["run"]): line for line in lines}
    solved_by_all = [k for k in keys if all(by[n, *k]["cost"] is not None for n in names)]
    for name in names:
        mine = [by[name, *k] for k in keys]
        first = [line["first"] for line in mine if line["first"] is not None]
        costs = [by[name, *k]["cost"] for k in solved_by_all]
        out.append(
            f"| {name} | {len(first)} of {len(mine)} | {statistics.median(first) if first else math.nan:.4f} |"
            f" {np.mean(costs) if costs else math.nan:.3f} |"
        )
    for name in names[:2]:
        ratios, cheaper, compared = [], 0, 0
        for key in keys:
            mine, others = by[name, *key], [by[p, *key] for p in peers if (p, *key) in by]
            firsts = [o["first"] for o in others if o["first"] is not None]
            if mine["first"] is not None and firsts:
                ratios.append(min(firsts) / mine["first"])
            costs = [o["cost"] for o in others if o["cost"] is not None]
            compared += 1
            cheaper += mine["cost"] is not None and (not costs or mine["cost"] < min(costs))
        if ratios:
            out.append(
                f"\n{name}: first solution {statistics.median(ratios):.1f} times sooner than the best of the others (median of"
                f" {len(ratios)}); cheaper than all of them in {cheaper} of {compared}"
            )
    return "\n".join(out)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", type=int, nargs="+", default=list(range(1, 9)))
    parser.add_argument("--seed", type=int, default=1, help="of the cells")
    parser.add_argument("--grasps", type=int, default=500)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=5.0, help="total time of the anytime programs [s]")
    parser.add_argument("--each", type=float, default=1.0, help="time for one grasp of `one by one` [s]")
    parser.add_argument("--cap", type=float, default=60.0, help="after which a program without a path gives up [s]")
    parser.add_argument("--programs", nargs="+", choices=list(PROGRAMS), default=list(PROGRAMS))
    given = parser.parse_args()
    print(json.dumps({"settings": vars(given)}), flush=True)
    lines = []
    for number in given.cells:
        cell = pipe_cell(number, seed=given.seed)
        for run in range(given.runs):
            grasps = cell.grasps(given.grasps, seed=1000 + run)
            for name in given.programs:
                line = {"cell": number, "run": run, "program": name, **PROGRAMS[name](cell, grasps, run + 1, given)}
                lines.append(line)
                print(json.dumps(line), flush=True)
    print(table(lines))


if __name__ == "__main__":
    main()
