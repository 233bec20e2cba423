"""What each stage of the planners over many grasps is worth, on the transfers of many_grasps.py.

    python benchmarks/planners/stages.py [--cells 1 2 ...] [--grasps 500] [--runs 2] [--seeds 3] [--planner NAME]

Default options, then one stage left out at a time, on the same transfers with the same seeds and one thread. Prints a
Markdown table: by how many percent paths cost more than with all stages, on average over all pairs of runs, with half of
the 95 % confidence interval, and processor time of the calls (inverse kinematics counts, the roadmap is built beforehand)
by that with all stages. Budgets are counted, not timed, so costs repeat on any machine.
"""

from __future__ import annotations

import argparse
import itertools
import json
import math
import time
from pathlib import Path

import numpy as np

import mmgrasp as mg
from mmgrasp.problems.pipe_cells import ROBOTS, pipe_cell

# What is left out, by planner. A roadmap of two vertices joins nothing.
VARIANTS: dict[str, dict[str, dict]] = {
    "prm_star_mg": {
        "all stages": {},
        "without first grasps": {"first_grasps": 0},
        "without straight lines and first grasps": {"straight": False},
        "without the roadmap": {"vertices": 2},
        "without refinement": {"refinements": 0},
        "8 rounds of refinement, not 4": {"refinements": 8},
        "without shortening and refinement": {"shorten": False},
    },
    "rrt_star_mg": {
        "all stages": {},
        "without first grasps": {"first_grasps": 0},
        "the trees' first path": {"first_grasps": 0, "goal_cost": 1e9, "max_iterations": 20000},
        "without straight lines": {"straight": False},
        "without informed draws": {"informed": False},
        "without exploration": {"exploration": 0},
        "from the start only": {"bidirectional": False},
    },
}


def run(
    problem: mg.ManipulationProblem, roadmaps: dict[int, mg.planning.Roadmap], planner: str, seed: int, change: dict
):
    """Cost (infinite without a path) and processor time [s]."""
    options = dict(change)
    if planner == "prm_star_mg":
        options["roadmap"] = roadmaps[options.pop("vertices", 5000)]
    begin = time.process_time()
    found = mg.plan_manipulation(problem, planner=planner, seed=seed, threads=1, time_limit=1000, **options)
    seconds = time.process_time() - begin
    return found.cost if found.outcome == mg.Outcome.solved else math.inf, seconds


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", type=int, nargs="+", default=list(range(1, 9)))
    parser.add_argument("--robots", nargs="+", choices=ROBOTS, default=list(ROBOTS))
    parser.add_argument("--seed", type=int, default=1, help="of the cells")
    parser.add_argument("--grasps", type=int, default=500)
    parser.add_argument("--runs", type=int, default=2, help="lists of grasps for each cell")
    parser.add_argument("--seeds", type=int, default=3, help="of the planner, for each list")
    parser.add_argument("--planner", nargs="+", choices=list(VARIANTS), default=list(VARIANTS))
    parser.add_argument("--keep", type=Path, help="JSON file that runs are added to: takes the table in pieces")
    given = parser.parse_args()
    costs: dict[tuple[str, str], list[float]] = {}
    seconds: dict[tuple[str, str], float] = {}
    if given.keep and given.keep.exists():
        for planner, name, own, took in json.loads(given.keep.read_text()):
            costs[planner, name], seconds[planner, name] = own, took
    for robot, number in itertools.product(given.robots, given.cells):
        cell = pipe_cell(number, seed=given.seed, robot=robot)
        roadmaps = {n: mg.planning.Roadmap.build(cell.arm, vertices=n) for n in (2, 5000)}
        for of_list in range(given.runs):
            problem = cell.problem(cell.grasps(given.grasps, seed=1000 + of_list))
            for seed, planner in itertools.product(range(1, given.seeds + 1), given.planner):
                for name, change in VARIANTS[planner].items():
                    cost, took = run(problem, roadmaps, planner, seed, change)
                    costs.setdefault((planner, name), []).append(cost)
                    seconds[planner, name] = seconds.get((planner, name), 0.0) + took
    if given.keep:
        given.keep.write_text(json.dumps([[*key, own, seconds[key]] for key, own in costs.items()]))
    print("| planner | stages | runs | cost [%] | time | lost |\n|---|---|---|---|---|---|")
    for (planner, name), own in costs.items():
        base, of_base = np.array(costs[planner, "all stages"]), seconds[planner, "all stages"]
        both = np.isfinite(base) & np.isfinite(own)
        lost = int((np.isfinite(base) & ~np.isfinite(own)).sum())
        if name == "all stages":
            told = f"{np.mean(base[both]):.4f} rad | {1e3 * of_base / len(own):.0f} ms"
        else:
            change = 100 * np.log(np.array(own)[both] / base[both])
            half = 1.98 * change.std(ddof=1) / math.sqrt(len(change))
            told = f"{change.mean():+.2f} +- {half:.2f} | {seconds[planner, name] / of_base:.2f}"
        print(f"| {planner} | {name} | {both.sum()} | {told} | {lost} |")


if __name__ == "__main__":
    main()
