"""Durations beside toppra on the same paths, and with jerk limits beside Ruckig on moves from rest to rest.

    python benchmarks/planners/bench_timing.py --baseline PYTHON [--paths N] [--no-jerk]

The path that toppra gets is the one our trajectory takes (corners blended), as 2,000 points by arc length. Prints one JSON
line per program, value: our duration over the baseline's, its median; with the least and the greatest beside it.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import time
from pathlib import Path

import numpy as np

import mmgrasp as mg

HERE = Path(__file__).resolve().parent
# The Panda's, from its data sheet.
VELOCITY = np.array([2.175, 2.175, 2.175, 2.175, 2.61, 2.61, 2.61])
ACCELERATION = np.array([15, 7.5, 10, 12.5, 15, 20, 20.0])
JERK = np.array([7500, 3750, 5000, 6250, 7500, 10000, 10000.0]) / 10
POINTS = 2000


def dense(trajectory) -> np.ndarray:
    """Points of the trajectory's path, evenly spread over its arc length."""
    fine = np.array([trajectory.at(t) for t in np.linspace(0, trajectory.duration, 20 * POINTS)])
    s = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(fine, axis=0), axis=1))])
    kept = np.concatenate([[True], np.diff(s) > 0])
    at = np.linspace(0, s[-1], POINTS)
    return np.stack([np.interp(at, s[kept], column) for column in fine[kept].T], axis=1)


def row(who: str, on: str, ours: list[float], baseline: list[float], seconds: float) -> str:
    ratios = np.array(ours) / np.array(baseline)
    ratios = ratios[np.isfinite(ratios)]
    return json.dumps(
        {
            "row": "timing",
            "on": on,
            "who": who,
            "value": float(np.median(ratios)),
            "unit": "of the baseline's duration",
            "least": float(ratios.min()),
            "greatest": float(ratios.max()),
            "paths": len(ratios),
            "ms": 1e3 * seconds,
            "settings": "limits of the Panda, corners blended within 0.05 rad",
        }
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--baseline", required=True, help="python of an environment with baselines.txt")
    parser.add_argument("--paths", type=int, default=50)
    parser.add_argument("--no-jerk", action="store_true")
    arguments = parser.parse_args()
    rng = np.random.default_rng(5)
    paths = [np.cumsum(rng.uniform(-1, 1, (rng.integers(3, 8), 7)), axis=0) for _ in range(arguments.paths)]
    begin = time.perf_counter()
    timed = [mg.time_parameterize(path, VELOCITY, ACCELERATION, max_deviation=0.05) for path in paths]
    seconds = (time.perf_counter() - begin) / len(paths)
    moves = [] if arguments.no_jerk else [[path[0], path[-1]] for path in paths]
    begin = time.perf_counter()
    jerky = [mg.time_parameterize(move, VELOCITY, ACCELERATION, jerk_limits=JERK) for move in moves]
    jerk_seconds = (time.perf_counter() - begin) / max(len(moves), 1)
    problem = {
        "velocity": VELOCITY.tolist(),
        "acceleration": ACCELERATION.tolist(),
        "jerk": JERK.tolist(),
        "paths": [dense(trajectory).tolist() for trajectory in timed],
        "moves": [[q.tolist() for q in move] for move in moves],
    }
    answer = subprocess.run(
        [arguments.baseline, HERE / "timing_baseline.py"],
        input=json.dumps(problem),
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    found = json.loads(answer.stdout)
    print(row("mmgrasp beside toppra", "blended paths", [t.duration for t in timed], found["toppra"], seconds))
    if moves:
        durations = [t.duration for t in jerky]
        print(row("mmgrasp beside Ruckig", "rest to rest, jerk", durations, found["ruckig"], jerk_seconds))


if __name__ == "__main__":
    main()
