"""The same poses in rooms with tables and walls, self-collision too; counted are those for which a sampling planner finds a path.

    python benchmarks/trajopt/bench_obstacles.py [--count 200] [--seeds 1 2 3] [--waypoints 35] [--time-limit 60] [--verbose]

The sampling planner is RRT-Connect for base and arm together, from the start to the grasp (any of its IK solutions) and on to the
goal, the base turning on the spot and driving straight; it is given --time-limit seconds for either part.
"""

from __future__ import annotations

import statistics
import sys

import numpy as np
from grasp_cases import GOAL, START, arguments, furnished, grasps, line, plan, timed, whole_body

import mmgrasp as mg


def sampled(robot: mg.Robot, group: mg.robot.JointGroup, world: mg.World, pose: np.ndarray, time_limit: float) -> bool:
    """A path through the grasp exists, as far as sampling tells."""
    options = {"time_limit": time_limit, "max_iterations": 200_000, "shorten": False}
    there = mg.plan_motion(robot, group, world, start=START, tool_poses=pose, ik_solutions=16, **options)
    if there.outcome != mg.Outcome.solved:
        return False
    back = mg.plan_motion(robot, group, world, start=there.path[-1], goal=GOAL, **options)
    return back.outcome == mg.Outcome.solved


def main() -> None:
    parser = arguments(__doc__, count=200, waypoints=35, time_limit=60)
    parser.add_argument("--verbose", action="store_true", help="say why a pose was not solved")
    given = parser.parse_args()
    for seed in given.seeds:
        runs = []
        for i, pose in enumerate(grasps(seed, given.count)):
            world = furnished(pose, 1000 * seed + i)
            seconds, found = timed(lambda: plan([mg.DriveByTask(pose)], world, waypoints=given.waypoints))  # noqa: B023
            solved = found.outcome == mg.Outcome.solved
            exists = solved or sampled(*whole_body(), world, pose, given.time_limit)
            runs.append((seconds, found, exists))
            if given.verbose and exists and not solved:
                print(f"seed {seed}, pose {i}:\n{found.report}", file=sys.stderr, flush=True)
        counted = [(t, r) for t, r, exists in runs if exists]
        solved = [(t, r) for t, r in counted if r.outcome == mg.Outcome.solved]
        line(
            "tables and walls", f"seed {seed}", "mmgrasp", [t for t, _ in counted],
            f"{given.count} poses, {given.waypoints} waypoints",
            paths_exist=len(counted),
            solved=len(solved) / len(counted),
            at_once=sum(r.solves == 1 for _, r in solved) / len(counted),
            base_above=sum(r.events[0]["base_speed"] > 0.1 for _, r in solved) / max(1, len(solved)),
            duration=statistics.median(r.duration for _, r in solved),
        )  # fmt: skip


if __name__ == "__main__":
    main()
