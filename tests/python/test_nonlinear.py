"""Nonlinear problems from Python: Hock and Schittkowski's 71 by callbacks, the exported problem of a drive-by, a cost added to it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp.optim import NonlinearProblem, solve_nonlinear
from mmgrasp.planning import WholeBodyProgram, drive_by_program
from mmgrasp.reproduce.drive_by import ANGLES, GOAL, GRASPS, START, whole_body

SOLVERS = mg.planning.nlp_solver_names()
OPTIONS: dict[str, Any] = {"tolerance": 1e-4, "constraint_tolerance": 5e-9, "barrier": 1e-2, "max_iterations": 150}


class Hs71(NonlinearProblem):
    """min x0 x3 (x0 + x1 + x2) + x2, product at least 25, squares sum to 40, 1 <= x <= 5."""

    calls = 0

    def variable_bounds(self) -> Any:
        return np.ones(4), np.full(4, 5.0)

    def constraint_bounds(self) -> Any:
        return [25.0, 40.0], [np.inf, 40.0]

    def objective(self, x: np.ndarray) -> float:
        type(self).calls += 1
        return float(x[0] * x[3] * x[:3].sum() + x[2])

    def gradient(self, x: np.ndarray) -> Any:
        return [x[3] * (2 * x[0] + x[1] + x[2]), x[0] * x[3], x[0] * x[3] + 1, x[0] * x[:3].sum()]

    def constraints(self, x: np.ndarray) -> Any:
        return [x.prod(), (x**2).sum()]

    def jacobian_pattern(self) -> Any:
        return [0, 0, 0, 0, 1, 1, 1, 1], [0, 1, 2, 3] * 2

    def jacobian(self, x: np.ndarray) -> Any:
        return [*(x.prod() / x), *(2 * x)]

    def hessian_pattern(self) -> Any:
        return np.tril_indices(4)

    def hessian(self, x: np.ndarray, factor: float, multipliers: np.ndarray) -> Any:
        H = np.zeros((4, 4))
        H[0, :] = [x[3], x[3] / 2, x[3] / 2, x[:3].sum()]  # with its transpose the second derivatives of f
        H[0, 0] = x[3]
        H[0, 1] = H[0, 2] = x[3]
        H[0, 3] = 2 * x[0] + x[1] + x[2]
        H[1, 3] = H[2, 3] = x[0]
        H = factor * (H + H.T)
        p = x.prod()
        H += multipliers[0] * (p / np.outer(x, x) - np.diag(p / x**2)) + 2 * multipliers[1] * np.eye(4)
        return H[np.tril_indices(4)]


@pytest.mark.parametrize("solver", SOLVERS)
def test_callbacks_reach_the_published_optimum(solver: str) -> None:
    Hs71.calls = 0
    found = solve_nonlinear(Hs71(), [1, 5, 5, 1], solver=solver)
    assert found.outcome == mg.Outcome.solved
    assert found.objective == pytest.approx(17.0140173, abs=1e-6)  # Hock and Schittkowski 1981
    assert found.x == pytest.approx([1, 4.7429994, 3.8211503, 1.3794082], abs=1e-5)
    assert found.violation <= 1e-8
    assert Hs71.calls > 3


def test_a_warm_start_needs_fewer_iterations() -> None:
    first = solve_nonlinear(Hs71(), [1, 5, 5, 1])
    again = solve_nonlinear(Hs71(), first.x, warm_start=1e-7)
    assert again.objective == pytest.approx(first.objective, abs=1e-7)
    assert again.iterations < first.iterations


def test_what_a_method_raises_or_gives_wrongly_is_raised() -> None:
    class Fails(Hs71):
        def gradient(self, x: np.ndarray) -> Any:
            raise KeyError("mine")

    class Short(Hs71):
        def jacobian(self, x: np.ndarray) -> Any:
            return [0.0]

    class Fractions(Hs71):
        def jacobian_pattern(self) -> Any:
            return [0.5], [0]

    class Nothing(NonlinearProblem):
        pass

    with pytest.raises(KeyError, match="mine"):
        solve_nonlinear(Fails(), [1, 5, 5, 1])
    for problem, message in ((Short(), r"jacobian\(x\) has shape \(1,\)"), (Fractions(), "whole numbers"), (Nothing(), "variable_bounds")):  # fmt: skip
        with pytest.raises(mg.InvalidInput, match=message):
            solve_nonlinear(problem, [1, 5, 5, 1])
    with pytest.raises(mg.InvalidInput, match="guess"):
        solve_nonlinear(Hs71(), [1.0])
    with pytest.raises(mg.InvalidInput, match="simplex"):
        solve_nonlinear(Hs71(), [1, 5, 5, 1], solver="simplex")


@pytest.fixture(scope="module")
def program() -> WholeBodyProgram:
    task = mg.DriveByTask(mg.pose(GRASPS["G1 (y = 2)"], ANGLES))
    made = drive_by_program(whole_body()[1], start=START, tasks=[task], goal=GOAL)
    assert made is not None
    return made


def test_the_exported_problem_is_the_one_that_is_planned(program: WholeBodyProgram) -> None:
    robot, group = whole_body()
    task = mg.DriveByTask(mg.pose(GRASPS["G1 (y = 2)"], ANGLES))
    planned = mg.plan_drive_by(robot, group, mg.World(), start=START, tasks=[task], goal=GOAL, collisions=False)
    found = solve_nonlinear(program.problem, program.guess, **OPTIONS)
    assert found.outcome == mg.Outcome.solved
    motion = program.trajectory(found.x)
    assert motion.duration == pytest.approx(planned.duration, abs=1e-9)
    assert all(v["kept"] for v in program.violations(found.x).values())
    assert np.array_equal(motion.positions, found.x[program.positions])
    assert np.array_equal(motion.drive, found.x[program.velocities])
    steps = np.diff(motion.times)
    assert np.diff(motion.drive, axis=0) / steps[:, None] == pytest.approx(found.x[program.accelerations], abs=1e-6)
    assert set(np.round(steps, 9)) == set(np.round(found.x[program.steps], 9))
    assert program.problem.variable_name(int(program.positions[3, 0])) == "x at waypoint 3"


def dense(pattern: Any, values: np.ndarray, shape: tuple[int, int]) -> np.ndarray:
    out = np.zeros(shape)
    np.add.at(out, pattern, values)
    return out


def test_exported_derivatives_are_those_of_the_values(program: WholeBodyProgram) -> None:
    problem, rng = program.problem, np.random.default_rng(1)
    x = program.guess + rng.uniform(-0.05, 0.05, program.guess.size)
    m, n = problem.constraint_bounds()[0].size, x.size
    multipliers = rng.uniform(-1, 1, m)
    along = rng.uniform(-1, 1, n)
    step = 1e-6

    def lagrangian_gradient(at: np.ndarray) -> np.ndarray:
        J = dense(problem.jacobian_pattern(), problem.jacobian(at), (m, n))
        return 0.7 * problem.gradient(at) + J.T @ multipliers

    ahead, behind = x + step * along, x - step * along
    slope = (problem.objective(ahead) - problem.objective(behind)) / (2 * step)
    assert problem.gradient(x) @ along == pytest.approx(slope, rel=1e-6)
    change = (problem.constraints(ahead) - problem.constraints(behind)) / (2 * step)
    J = dense(problem.jacobian_pattern(), problem.jacobian(x), (m, n))
    assert J @ along == pytest.approx(change, abs=1e-6)
    H = dense(problem.hessian_pattern(), problem.hessian(x, 0.7, multipliers), (n, n))
    H = H + H.T - np.diag(np.diag(H))
    bend = (lagrangian_gradient(ahead) - lagrangian_gradient(behind)) / (2 * step)
    assert H @ along == pytest.approx(bend, abs=1e-5)


def test_a_cost_of_ones_own_trades_time_for_energy(program: WholeBodyProgram) -> None:
    arm = program.accelerations[:, 2:].ravel()

    class WithEnergy(NonlinearProblem):
        def __init__(self, weight: float) -> None:
            super().__init__(program.problem)
            self.weight = weight

        def objective(self, x: np.ndarray) -> float:
            assert self.base is not None
            return self.base.objective(x) + self.weight * float((x[arm] ** 2).mean())

        def gradient(self, x: np.ndarray) -> np.ndarray:
            assert self.base is not None
            out = self.base.gradient(x)
            out[arm] += 2 * self.weight / arm.size * x[arm]
            return out

        def hessian_pattern(self) -> tuple[np.ndarray, np.ndarray]:
            assert self.base is not None
            rows, columns = self.base.hessian_pattern()
            return np.append(rows, arm), np.append(columns, arm)

        def hessian(self, x: np.ndarray, factor: float, multipliers: np.ndarray) -> np.ndarray:
            assert self.base is not None
            own = np.full(arm.size, 2 * factor * self.weight / arm.size)
            return np.append(self.base.hessian(x, factor, multipliers), own)

    durations, energies = [], []
    guess = program.guess
    for weight in (0.0, 2.0, 20.0):
        found = solve_nonlinear(WithEnergy(weight), guess, **OPTIONS)
        assert found.outcome == mg.Outcome.solved, found.message
        assert all(v["kept"] for v in program.violations(found.x).values())
        durations.append(program.trajectory(found.x).duration)
        energies.append(float((found.x[arm] ** 2).mean()))
        guess = found.x
    # A larger weight never gives more of what it weighs, nor a shorter motion.
    assert energies[0] > 1.01 * energies[1] > 1.01 * energies[2]
    assert durations[0] < durations[1] < durations[2]


def test_an_added_constraint_is_kept(program: WholeBodyProgram) -> None:
    """The base no faster than 0.4 m/s at the task, as one row more."""
    at = int(program.velocities[len(program.velocities) // 2, 0])
    plain = solve_nonlinear(program.problem, program.guess, **OPTIONS)

    class Slower(NonlinearProblem):
        def constraint_bounds(self) -> Any:
            lower, upper = program.problem.constraint_bounds()
            return np.append(lower, -0.4), np.append(upper, 0.4)

        def constraints(self, x: np.ndarray) -> Any:
            return np.append(program.problem.constraints(x), x[at])

        def jacobian_pattern(self) -> Any:
            rows, columns = program.problem.jacobian_pattern()
            return np.append(rows, program.problem.constraint_bounds()[0].size), np.append(columns, at)

        def jacobian(self, x: np.ndarray) -> Any:
            return np.append(program.problem.jacobian(x), 1.0)

        def hessian(self, x: np.ndarray, factor: float, multipliers: np.ndarray) -> Any:
            return program.problem.hessian(x, factor, multipliers[:-1])

    found = solve_nonlinear(Slower(program.problem), program.guess, **OPTIONS)
    assert found.outcome == mg.Outcome.solved
    assert plain.x[at] > 0.5
    assert found.x[at] <= 0.4 + 1e-8
    assert program.trajectory(found.x).duration > program.trajectory(plain.x).duration + 0.05
