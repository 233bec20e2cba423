"""How hard the pipe cells are: which single grasps admit a motion within a time, one JSON line a cell.

    python benchmarks/planners/single_grasps.py [--cells 1 2 ...] [--seeds 1 2 3] [--grasps 500] [--seconds 10] [--write]

A grasp fails when the arm does not reach both ends with it, or when RRT-Connect, restarted with a doubled budget until
the time is over, finds no motion between any of its arm configurations. Processor time, one thread. --write puts the
table into benchmarks/README.md.
"""

from __future__ import annotations

import argparse
import itertools
import json
import sys
import time
from pathlib import Path

import mmgrasp as mg
from mmgrasp.problems.pipe_cells import ROBOTS, PipeCell, pipe_cell

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from tables import markdown, show


def transfers(cell: PipeCell, grasp: mg.Grasp, seconds: float) -> str:
    """ "out of reach", "solved" or "failed"."""
    starts, goals = cell.ends(grasp, 8)
    if len(starts) == 0 or len(goals) == 0:
        return "out of reach"
    arm, world = cell.arm_holding(grasp), cell.world_holding(grasp)
    begun, budget = time.process_time(), 2000
    while time.process_time() - begun < seconds - 0.01:
        for start in starts:
            left = seconds - (time.process_time() - begun)
            if left <= 0.01:
                break
            found = mg.plan_motion(
                cell.robot, arm, world, start=start, goal=goals, max_iterations=budget, time_limit=left, shorten=False,
                seed=budget,
            )  # fmt: skip
            if found.outcome == mg.Outcome.solved:
                return "solved"
        budget = min(2 * budget, 10_000_000)
    return "failed"


def table(lines: list[dict]) -> str:
    """One row a cell."""
    rows = [
        [
            str(line["cell"]),
            str(line["seed"]),
            line["robot"],
            str(line["grasps"]),
            f"{line['within reach']:.1%}",
            f"{line['admit a motion']:.1%}",
            line["first within reach"] or "",
            ", ".join(f"{cause}: {count}" for cause, count in line["cells rejected"].items()),
        ]
        for line in lines
    ]
    head = ["cell", "seed", "arm", "grasps", "within reach", f"admit a motion in {lines[0]['seconds']:g} s"]
    return markdown([*head, "the first within reach", "cells rejected"], rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", type=int, nargs="+", default=list(range(1, 9)))
    parser.add_argument("--seeds", type=int, nargs="+", default=[1])
    parser.add_argument("--robots", nargs="+", choices=ROBOTS, default=list(ROBOTS))
    parser.add_argument("--grasps", type=int, default=500)
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--write", action="store_true", help="update benchmarks/README.md")
    given = parser.parse_args()
    lines = []
    for robot, seed, number in itertools.product(given.robots, given.seeds, given.cells):
        cell = pipe_cell(number, seed=seed, robot=robot)
        outcomes = [transfers(cell, grasp, given.seconds) for grasp in cell.grasps(given.grasps)]
        reached = [o for o in outcomes if o != "out of reach"]
        line = {
            "cell": number,
            "seed": seed,
            "robot": robot,
            "grasps": len(outcomes),
            "within reach": len(reached) / len(outcomes),
            "admit a motion": outcomes.count("solved") / len(outcomes),
            "first within reach": reached[0] if reached else None,
            "seconds": given.seconds,
            "cells rejected": cell.rejected,
        }
        lines.append(line)
        print(json.dumps(line), flush=True)
    show("single grasps", table(lines), given.write)


if __name__ == "__main__":
    main()
