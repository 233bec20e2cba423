"""toppra's and Ruckig's durations for what bench_timing.py asks; runs in the baselines' environment.

Reads {"velocity": [...], "acceleration": [...], "jerk": [...], "paths": [[[...]]], "moves": [[from, to]]} and prints
{"toppra": [...], "ruckig": [...]} in seconds.
"""

from __future__ import annotations

import json
import sys

import numpy as np
import toppra
from ruckig import InputParameter, Result, Ruckig, Trajectory
from toppra import constraint


def toppra_duration(points: np.ndarray, velocity: np.ndarray, acceleration: np.ndarray) -> float:
    """TOPP-RA's duration of a cubic spline through dense points, by arc length; bounds on velocity and (interpolated) acceleration."""
    toppra.setup_logging("ERROR")
    s = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    path = toppra.SplineInterpolator(s, points)
    limits = [
        constraint.JointVelocityConstraint(np.stack([-velocity, velocity], axis=1)),
        constraint.JointAccelerationConstraint(
            np.stack([-acceleration, acceleration], axis=1),
            discretization_scheme=constraint.DiscretizationType.Interpolation,
        ),
    ]
    grid = np.unique(np.concatenate([s[::2], s[-1:]]))
    solver = toppra.algorithm.TOPPRA(limits, path, gridpoints=grid, parametrizer="ParametrizeConstAccel")
    trajectory = solver.compute_trajectory(0, 0)
    return float(trajectory.duration) if trajectory is not None else float("nan")


def ruckig_duration(move: list[list[float]], problem: dict) -> float:
    """From rest to rest, joints synchronised in time."""
    size = len(move[0])
    wanted = InputParameter(size)
    wanted.current_position, wanted.target_position = move
    wanted.current_velocity = wanted.current_acceleration = [0.0] * size
    wanted.target_velocity = wanted.target_acceleration = [0.0] * size
    wanted.max_velocity, wanted.max_acceleration = problem["velocity"], problem["acceleration"]
    wanted.max_jerk = problem["jerk"]
    trajectory = Trajectory(size)
    if Ruckig(size).calculate(wanted, trajectory) not in (Result.Working, Result.Finished):
        return float("nan")
    return float(trajectory.duration)


def main() -> None:
    problem = json.load(sys.stdin)
    velocity, acceleration = np.array(problem["velocity"]), np.array(problem["acceleration"])
    times = [toppra_duration(np.array(path), velocity, acceleration) for path in problem["paths"]]
    json.dump({"toppra": times, "ruckig": [ruckig_duration(move, problem) for move in problem["moves"]]}, sys.stdout)


if __name__ == "__main__":
    main()
