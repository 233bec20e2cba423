"""Time against the number of waypoints, and how far durations agree.

    python benchmarks/trajopt/bench_waypoints.py [--count 20] [--seeds 1] [--most 300]

More than 150 waypoints start from the solution with 35. `slope` is that of log time over log waypoints, from 35 up; `spread` the
largest difference of a pose's durations from 50 waypoints up, over the least of them.
"""

from __future__ import annotations

import statistics

import numpy as np
from grasp_cases import arguments, grasps, line, plan, timed

import mmgrasp as mg

SIZES = (10, 15, 20, 35, 50, 75, 100, 150, 200, 300)


def main() -> None:
    given = arguments(__doc__, count=20, most=300).parse_args()
    sizes = [n for n in SIZES if n <= given.most]
    poses = [(seed, pose) for seed in given.seeds for pose in grasps(seed, given.count)]
    medians: dict[int, float] = {}
    durations: dict[int, list[float]] = {i: [] for i in range(len(poses))}
    for n in sizes:
        runs = [timed(lambda: plan([mg.DriveByTask(pose)], waypoints=n, collisions=False)) for _, pose in poses]  # noqa: B023
        solved = [r.outcome == mg.Outcome.solved for _, r in runs]
        for i, (_, found) in enumerate(runs):
            if n >= 50 and solved[i]:
                durations[i].append(found.duration)
        medians[n] = statistics.median(t for t, _ in runs)
        line(
            "waypoints", str(n), "mmgrasp", [t for t, _ in runs], f"{len(poses)} poses",
            solved=sum(solved) / len(solved),
            ms_per_waypoint=1000 * medians[n] / n,
            duration=statistics.median(r.duration for (_, r), ok in zip(runs, solved, strict=True) if ok),
        )  # fmt: skip
    fine = [n for n in sizes if n >= 35]
    slope = float(np.polyfit(np.log(fine), np.log([medians[n] for n in fine]), 1)[0])
    spreads = [max(d) / min(d) - 1 for d in durations.values() if len(d) > 1]
    line(
        "waypoints", f"{fine[0]} to {fine[-1]}", "mmgrasp", list(medians.values()), f"{len(poses)} poses",
        slope=slope, spread=max(spreads, default=0.0),
    )  # fmt: skip


if __name__ == "__main__":
    main()
