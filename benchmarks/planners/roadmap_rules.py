"""What the rule by which a roadmap joins its vertices costs and gains: plan_manipulation at its defaults over each, in the narrow cells.

    python benchmarks/planners/roadmap_rules.py [--robot tm14like] [--repeats 3] [--write]

500 grasps, one thread, processor time; the least of the repeats, medians and means over the eight cells of seed 1. --write
puts the table into benchmarks/README.md.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import time
from pathlib import Path

import mmgrasp as mg
from mmgrasp.problems.pipe_cells import ROBOTS, pipe_cell, pipe_robot

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from tables import markdown, show

RULES: dict[str, dict] = {"gamma 4 (P2)": {"gamma": 4.0}, "12 nearest": {"neighbours": 12}, "default": {}}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--robot", choices=ROBOTS, default=ROBOTS[0])
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--write", action="store_true", help="update benchmarks/README.md")
    given = parser.parse_args()
    cells = [pipe_cell(number, robot=given.robot) for number in range(1, 9)]
    problems = [cell.problem(cell.grasps(500, seed=1000)) for cell in cells]
    rows = []
    for name, rule in RULES.items():
        begun = time.process_time()
        roadmap = mg.planning.Roadmap.build(pipe_robot(given.robot)[1], **rule)
        building = time.process_time() - begun
        firsts, calls, costs = [], [], []
        for problem in problems:
            times = []
            for _ in range(given.repeats):
                begun = time.process_time()
                found = mg.plan_manipulation(problem, roadmap=roadmap, threads=1, time_limit=60.0)
                times.append((time.process_time() - begun, found.improvements[0].seconds))
            calls.append(1e3 * min(call for call, _ in times))
            firsts.append(1e3 * min(first for _, first in times))
            costs.append(found.cost)
        rows.append(
            [
                name,
                f"{roadmap.statistics['largest_component']}",
                f"{1e3 * building:.0f}",
                f"{statistics.median(firsts):.2f}",
                f"{statistics.mean(calls):.1f}",
                f"{statistics.mean(costs):.3f}",
            ]
        )
    head = ["joined", "largest component of 5000", "building [ms]", "first path, median [ms]", "whole call, mean [ms]"]
    show("roadmap rules", markdown([*head, "cost, mean"], rows), given.write)


if __name__ == "__main__":
    main()
