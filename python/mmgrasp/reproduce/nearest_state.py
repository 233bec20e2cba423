"""P1 figure 4.13's common formulation, solved: the task is kept by the state of the way that is nearest to it, between two waypoints.

The plan's own nonlinear problem is taken as it is, but for the rows of the task: their values are those of the nearest interpolated state, and
their derivatives, first and second, go to the two waypoints around it, weighed as it lies between them. Which two may change from one iterate to the next.
"""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np

from .. import _core

SHARES = np.linspace(
    0.0, 1.0, 21
)  # states looked at between two waypoints; then the best share is sought around the nearest one
STEP, WIDE = 1e-6, 1e-3  # of the differences that first and second derivatives are taken from
COMMON, OWN = "common: the nearest state", "a waypoint of its own"


def pose_error(T_target: np.ndarray, T: np.ndarray) -> np.ndarray:
    """Translation [m] in the target's frame, then twice the vector part of the quaternion between them."""
    between = np.linalg.inv(T_target) @ T
    quat = np.asarray(_core.quat_xyzw_from_rotation(between[:3, :3]))
    return np.concatenate([between[:3, 3], 2 * np.sign(quat[3] or 1.0) * quat[:3]])


class NearestStateProblem(_core.NonlinearProblem):
    """The task is kept wherever the way comes nearest to it."""

    def __init__(self, program: _core.WholeBodyProgram, group: _core.JointGroup, T_target: np.ndarray) -> None:
        super().__init__(program.problem)
        self.own, self.group, self.T_target = program.problem, group, T_target
        self.columns = np.asarray(program.positions)
        count = len(self.own.constraint_bounds()[0])
        self.rows = np.array([i for i in range(count) if self.own.constraint_name(i).startswith("task ")])
        rows, columns = self.own.jacobian_pattern()
        self.kept = ~np.isin(rows, self.rows)
        grid = np.meshgrid(self.rows, self.columns.ravel(), indexing="ij")
        self.pattern = np.append(rows[self.kept], grid[0].ravel()), np.append(columns[self.kept], grid[1].ravel())
        pairs = np.hstack([self.columns[:-1], self.columns[1:]])
        self.lower = np.tril_indices(pairs.shape[1])
        low, high = (pairs[:, side].ravel() for side in self.lower)
        own_rows, own_columns = self.own.hessian_pattern()
        self.curved = np.append(own_rows, np.maximum(low, high)), np.append(own_columns, np.minimum(low, high))
        self.intervals: list[int] = []
        """Which one the task was in, at each iterate."""

    def nearest(self, x: np.ndarray) -> tuple[int, float]:
        """Interval and share of the state whose tool is nearest to the task."""
        q = x[self.columns]

        def distances(first: np.ndarray, last: np.ndarray, shares: np.ndarray) -> np.ndarray:
            states = (1 - shares)[:, None, None] * first + shares[:, None, None] * last
            tools = self.group.fk_batch(states.reshape(-1, q.shape[1]))[:, :3, 3]
            off = np.linalg.norm(tools - self.T_target[:3, 3], axis=1)
            return np.asarray(off.reshape(len(shares), -1))

        coarse = distances(q[:-1], q[1:], SHARES)
        k, i = np.unravel_index(int(coarse.argmin()), coarse.shape)
        share, width = float(SHARES[k]), float(SHARES[1])
        for _ in range(4):  # to 1e-6 of the interval
            shares = np.clip(share + width * np.linspace(-1, 1, 41), 0.0, 1.0)
            share = float(shares[int(distances(q[i : i + 1], q[i + 1 : i + 2], shares).argmin())])
            width /= 20
        return int(i), share

    def _state_error(self, q: np.ndarray) -> np.ndarray:
        return pose_error(self.T_target, self.group.fk(q))

    def constraints(self, x: np.ndarray) -> np.ndarray:
        """The task's rows by the nearest state."""
        out = np.array(self.own.constraints(x))
        i, share = self.nearest(x)
        q = x[self.columns]
        out[self.rows] = self._state_error((1 - share) * q[i] + share * q[i + 1])
        return out

    def jacobian_pattern(self) -> tuple[np.ndarray, np.ndarray]:
        """The task may depend on any waypoint."""
        return self.pattern

    def jacobian(self, x: np.ndarray) -> np.ndarray:
        """Zero for the task but at the two waypoints around the nearest state."""
        i, share = self.nearest(x)
        self.intervals.append(i)
        q = x[self.columns]
        state = (1 - share) * q[i] + share * q[i + 1]
        steps = STEP * np.eye(len(state))
        slopes = np.array([(self._state_error(state + s) - self._state_error(state - s)) / (2 * STEP) for s in steps]).T
        task = np.zeros((len(self.rows), *self.columns.shape))
        task[:, i], task[:, i + 1] = (1 - share) * slopes, share * slopes
        return np.append(np.asarray(self.own.jacobian(x))[self.kept], task.ravel())

    def hessian_pattern(self) -> tuple[np.ndarray, np.ndarray]:
        """Between any two waypoints in a row."""
        return self.curved

    def hessian(self, x: np.ndarray, factor: float, multipliers: np.ndarray) -> np.ndarray:
        """That of everything else, and the task's at the nearest state."""
        i, share = self.nearest(x)
        q = x[self.columns]
        state, task = (1 - share) * q[i] + share * q[i + 1], np.asarray(multipliers)[self.rows]
        steps = WIDE * np.eye(len(state))

        def value(at: np.ndarray) -> float:
            return float(task @ self._state_error(at))

        bent = np.zeros((len(state), len(state)))
        for a, b in itertools.combinations_with_replacement(range(len(state)), 2):
            ends = [value(state + u * steps[a] + v * steps[b]) for u, v in ((1, 1), (1, -1), (-1, 1), (-1, -1))]
            bent[a, b] = bent[b, a] = (ends[0] - ends[1] - ends[2] + ends[3]) / (4 * WIDE**2)
        blocks = np.zeros((len(self.columns) - 1, len(self.lower[0])))
        both = np.kron([[(1 - share) ** 2, (1 - share) * share], [(1 - share) * share, share**2]], bent)
        blocks[i] = both[self.lower]
        others = np.array(multipliers)
        others[self.rows] = 0.0
        return np.append(np.asarray(self.own.hessian(x, factor, others)), blocks.ravel())


def guess_of(program: _core.WholeBodyProgram, knows_the_task: bool) -> np.ndarray:
    """Where plan_drive_by begins, through the task; or straight from start to goal, at the same times, at rest."""
    guess = np.array(program.guess)
    if not knows_the_task:
        places = np.asarray(program.positions)
        shares = np.linspace(0, 1, len(places))[:, None]
        guess[places] = (1 - shares) * guess[places[0]] + shares * guess[places[-1]]
        for index in (program.velocities, program.accelerations):
            guess[np.asarray(index)] = 0.0
    return guess


def solved_both_ways(
    program: _core.WholeBodyProgram,
    group: _core.JointGroup,
    T_target: np.ndarray,
    solver: str,
    knows_the_task: bool,
    iterations: int,
) -> dict[str, dict[str, Any]]:
    """The program's one task from one guess by both formulations: solved or not, iterations, duration, intervals that the task was in."""
    found = {}
    problems = {COMMON: NearestStateProblem(program, group, T_target), OWN: program.problem}
    for name, problem in problems.items():
        answer = _core.solve_nonlinear(
            problem, guess_of(program, knows_the_task), solver=solver, tolerance=1e-4, constraint_tolerance=1e-6, barrier=1e-2,
            max_iterations=iterations, time_limit=1e5,
        )  # fmt: skip
        seen = problem.intervals if isinstance(problem, NearestStateProblem) else []
        found[name] = {
            "solved": answer.outcome == _core.Outcome.solved,
            "iterations": answer.iterations,
            "duration": program.trajectory(answer.x).duration,
            "intervals": seen,
        }
    return found
