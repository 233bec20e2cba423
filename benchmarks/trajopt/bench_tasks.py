"""One to five grasps in one motion, beside stopping for them.

    python benchmarks/trajopt/bench_tasks.py [--count 40] [--seeds 1 2 3]

Stop-and-go drives through the same configurations and stops at each, every piece planned time-optimally by itself. Stop-and-pick
drives with the arm at rest from stand to stand, then moves the arm into the grasp and back with the base standing, all from rest to
rest at full speed; the gripper's own time is left out everywhere. Poses are spread along the way, one in each m-th of it.
"""

from __future__ import annotations

import itertools
import statistics

import numpy as np
from grasp_cases import START, arguments, drawn_pose, line, plan, reachable, timed, whole_body

import mmgrasp as mg

COUNTS = (1, 2, 3, 5)


def poses_along(rng: np.random.Generator, m: int) -> list[np.ndarray]:
    out = []
    for k in range(m):
        while not reachable(pose := drawn_pose(rng, (2 + 6 * (k + 0.15) / m, 2 + 6 * (k + 0.85) / m)), rng):
            pass
        out.append(pose)
    return out


def piece(start: np.ndarray, goal: np.ndarray) -> float:
    """From rest to rest, time-optimal; infinite when not solved."""
    found = plan([], start=start, goal=goal, waypoints=35, collisions=False)
    return found.duration if found.outcome == mg.Outcome.solved else np.inf


def arm_time(start: np.ndarray, goal: np.ndarray) -> float:
    """Every joint from rest to rest on its own."""
    _, group = whole_body()
    way = np.abs(np.asarray(goal)[3:] - np.asarray(start)[3:])
    v, a = np.asarray(group.velocity_limits)[3:], np.asarray(group.acceleration_limits)[3:]
    return float(np.where(way >= v * v / a, way / v + v / a, 2 * np.sqrt(way / a)).max())


def stopping(stands: list[np.ndarray]) -> tuple[float, float]:
    """Durations of stop-and-go and of stop-and-pick through the stands."""
    goal = np.asarray(stands[-1], float)
    ends = [np.asarray(START, float), *stands]
    go = sum(piece(a, b) for a, b in itertools.pairwise(ends))
    pick, home = 0.0, np.asarray(START, float)
    for stand in stands[:-1]:
        rest = np.concatenate([stand[:3], START[3:]])
        pick += piece(home, rest) + 2 * arm_time(rest, stand)
        home = rest
    return go, pick + piece(home, goal)


def main() -> None:
    given = arguments(__doc__, count=40).parse_args()
    for m in COUNTS:
        runs, speeds, tools, ratios, picks = [], [], [], [], []
        for seed in given.seeds:
            rng = np.random.default_rng([seed, m])
            for _ in range(given.count):
                tasks = [mg.DriveByTask(pose) for pose in poses_along(rng, m)]
                runs.append(timed(lambda: plan(tasks, waypoints=17 * (m + 1) + 1, collisions=False)))  # noqa: B023
                found = runs[-1][1]
                if found.outcome != mg.Outcome.solved:
                    continue
                speeds += [e["base_speed"] for e in found.events]
                tools += [e["tool_speed"] for e in found.events]
                positions = np.asarray(found.trajectory.positions)
                stands = [positions[e["waypoint"]] for e in found.events]
                go, pick = stopping([*stands, positions[-1]])
                ratios.append(found.duration / go)
                picks.append(found.duration / pick)
        line(
            "several tasks", f"m = {m}", "mmgrasp", [t for t, _ in runs], f"{len(runs)} draws, {17 * (m + 1) + 1} waypoints",
            solved=sum(r.outcome == mg.Outcome.solved for _, r in runs) / len(runs),
            duration=statistics.median(r.duration for _, r in runs),
            over_stop_and_go=statistics.median(ratios), largest_over_stop_and_go=max(ratios),
            over_stop_and_pick=statistics.median(picks),
            base_above=float(np.mean(np.array(speeds) > 0.1)),
            base_speed=statistics.median(speeds), tool_speed=statistics.median(tools),
        )  # fmt: skip


if __name__ == "__main__":
    main()
