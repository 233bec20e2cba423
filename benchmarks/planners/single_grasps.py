"""How hard the pipe cells are: which single grasps admit a motion within a time, one JSON line a cell.

    python benchmarks/planners/single_grasps.py [--cells 1 2 ...] [--seeds 1 2 3] [--grasps 100] [--seconds 10]

A grasp fails when the arm does not reach both ends with it, or when RRT-Connect, restarted with a doubled budget until
the time is over, finds no motion between any of its arm configurations. Processor time, one thread.
"""

from __future__ import annotations

import argparse
import json
import time

import mmgrasp as mg
from mmgrasp.pipe_cells import ROBOTS, PipeCell, pipe_cell


def carries(cell: PipeCell, grasp: mg.PipeGrasp, seconds: float) -> str:
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


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", type=int, nargs="+", default=list(range(1, 9)))
    parser.add_argument("--seeds", type=int, nargs="+", default=[1])
    parser.add_argument("--robot", choices=ROBOTS, default=ROBOTS[0])
    parser.add_argument("--grasps", type=int, default=100)
    parser.add_argument("--seconds", type=float, default=10.0)
    given = parser.parse_args()
    for seed in given.seeds:
        for number in given.cells:
            cell = pipe_cell(number, seed=seed, robot=given.robot)
            outcomes = [carries(cell, grasp, given.seconds) for grasp in cell.grasps(given.grasps)]
            reached = [o for o in outcomes if o != "out of reach"]
            line = {
                "cell": number,
                "seed": seed,
                "robot": given.robot,
                "grasps": len(outcomes),
                "within reach": len(reached) / len(outcomes),
                "admit a motion": outcomes.count("solved") / len(outcomes),
                "first within reach": reached[0] if reached else None,
                "seconds": given.seconds,
                "cells turned down": cell.rejected,
            }
            print(json.dumps(line), flush=True)


if __name__ == "__main__":
    main()
