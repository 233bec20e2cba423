"""A can taken from a table in passing, with a wall behind the table and a cupboard beside it; counted are the cans to which a sampling
planner finds a path.

    python benchmarks/trajopt/bench_at_grasp.py [--count 100] [--seeds 1 2 3] [--waypoints 35] [--time-limit 20] [--verbose]

The can is an obstacle until the hand stands over it for 0.35 s, in which fingers close, then it is carried. Sampling is as in
bench_obstacles.py; of its way on, the can counts as taken away.
"""

from __future__ import annotations

import statistics
import sys

import numpy as np
from bench_obstacles import sampled
from grasp_cases import GOAL, START, arguments, can_on_a_table, line, timed, whole_body

import mmgrasp as mg
from mmgrasp.reproduce.drive_by import LIFT

OPENING = 0.08  # of the hand as it comes [m]
DWELL = 0.35  # [s]


def main() -> None:
    parser = arguments(__doc__, count=100, waypoints=35, time_limit=20)
    parser.add_argument("--verbose", action="store_true", help="say why a can was not taken")
    given = parser.parse_args()
    robot, _ = whole_body()
    fingers = {f"{side}_gripper_finger_joint": OPENING / 2 for side in ("left", "right")}
    group = robot.group("arm", tip="gripper_tcp", with_base=True).with_reference({"torso_lift_joint": LIFT, **fingers})
    for seed in given.seeds:
        rng = np.random.default_rng(seed)
        runs = []
        for i in range(given.count):
            world, pose = can_on_a_table(rng)
            task = mg.DriveByTask(pose, dwell=DWELL, object="can")
            options = {"start": START, "goal": GOAL, "waypoints": given.waypoints}
            seconds, found = timed(lambda: mg.plan_drive_by(robot, group, world, tasks=[task], **options))  # noqa: B023
            exists = found.outcome == mg.Outcome.solved or sampled(robot, group, world, pose, given.time_limit)
            runs.append((seconds, found, exists))
            if given.verbose and found.outcome != mg.Outcome.solved:
                print(f"seed {seed}, can {i}, {exists=}, {seconds:.1f} s:\n{found.report}", file=sys.stderr, flush=True)
        counted = [(t, r) for t, r, exists in runs if exists]
        solved = [(t, r) for t, r in counted if r.outcome == mg.Outcome.solved]
        line(
            "furniture at the grasp", f"seed {seed}", "mmgrasp", [t for t, _ in counted],
            f"{given.count} cans, {given.waypoints} waypoints",
            paths_exist=len(counted),
            solved=len(solved) / len(counted),
            at_once=sum(r.solves == 1 for _, r in solved) / len(counted),
            base_above=sum(r.events[0]["base_speed"] > 0.1 for _, r in solved) / max(1, len(solved)),
            duration=statistics.median(r.duration for _, r in solved),
        )  # fmt: skip


if __name__ == "__main__":
    main()
