"""200 random grasp poses taken in passing: ours, and casadi + Ipopt on the same problem from the same guess.

    python benchmarks/trajopt/random_grasps.py [--count 200] [--seeds 1 2 3] [--casadi] [--collisions] [--waypoints 35]

x 2 to 8, |y| 0.5 to 2.5, z 0.3 to 1.1 m, approach within 60 degrees of horizontal, roll free; a pose is kept if some base
pose has IK. Prints one JSON line per program and seed. --casadi needs casadi (peers.txt); its runs alternate with ours.
"""

from __future__ import annotations

import argparse
import json
import statistics
import time

import numpy as np

import mmgrasp as mg
from mmgrasp.reproduce.drive_by import GOAL, START, whole_body


def grasps(seed: int, count: int) -> list[np.ndarray]:
    _, group = whole_body()
    rng = np.random.default_rng(seed)
    kept: list[np.ndarray] = []
    while len(kept) < count:
        place = [rng.uniform(2, 8), rng.choice([-1, 1]) * rng.uniform(0.5, 2.5), rng.uniform(0.3, 1.1)]
        pose = mg.pose(
            place, [rng.uniform(-np.pi, np.pi), rng.uniform(-np.pi / 3, np.pi / 3), rng.uniform(-np.pi, np.pi)]
        )
        for trial in range(8):
            at = np.zeros(10)
            at[:2] = np.array(place[:2]) + rng.uniform(-0.8, 0.8, 2)
            at[2] = rng.uniform(-np.pi, np.pi)
            if group.ik(pose, seed=at, restarts=10, rng_seed=trial + 1).outcome == mg.Outcome.solved:
                kept.append(pose)
                break
    return kept


def line(who: str, seed: int, seconds: list[float], solved: int, count: int, extra: dict) -> None:
    print(
        json.dumps(
            {
                "row": "random grasps", "who": who, "seed": seed, "poses": count, "solved": solved / count,
                "median [s]": statistics.median(seconds), "95 % [s]": float(np.percentile(seconds, 95)), **extra,
            }
        ),
        flush=True,
    )  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3])
    parser.add_argument("--waypoints", type=int, default=35)
    parser.add_argument("--casadi", action="store_true")
    parser.add_argument("--collisions", action="store_true", help="self-collisions are looked at too")
    given = parser.parse_args()
    robot, group = whole_body()
    if given.casadi:
        from casadi_peer import Peer

        peer = Peer(group)
    for seed in given.seeds:
        ours: list[mg.DriveByResult] = []
        theirs: list[tuple[bool, float, float]] = []
        for pose in grasps(seed, given.count):
            tasks = [mg.DriveByTask(pose)]
            ours.append(
                mg.plan_drive_by(
                    robot, group, mg.World(), start=START, tasks=tasks, goal=GOAL, waypoints=given.waypoints,
                    collisions=given.collisions,
                )
            )  # fmt: skip
            if given.casadi:
                guess = mg._core._first_drive_by_guess(
                    group, start=START, tasks=tasks, goal=GOAL, waypoints=given.waypoints
                )
                peer.prepare(guess["intervals"])
                begun = time.perf_counter()
                solved, duration = peer.solve(guess, pose)
                theirs.append((solved, time.perf_counter() - begun, duration))
        solved = [r for r in ours if r.outcome.name in ("solved", "approximate")]
        line(
            "mmgrasp", seed, [r.seconds for r in ours], len(solved), len(ours),
            {
                "first attempt": sum(r.attempts == 1 for r in solved) / len(ours),
                "base above 0.1 m/s": sum(r.events[0]["base_speed"] > 0.1 for r in solved) / max(1, len(solved)),
                "duration [s]": statistics.median(r.duration for r in solved),
            },
        )  # fmt: skip
        if given.casadi:
            line(
                "casadi + Ipopt", seed, [t[1] for t in theirs], sum(t[0] for t in theirs), len(theirs),
                {"duration [s]": statistics.median([t[2] for t in theirs if t[0]])},
            )  # fmt: skip


if __name__ == "__main__":
    main()
