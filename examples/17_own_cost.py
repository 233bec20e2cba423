"""A cost of one's own in a motion of base and arm: the arm's work, traded against time.

The nonlinear problem that `plan_drive_by` solves is taken as it is; a class adds the mean square of the arm's accelerations, with its
derivatives, and the same solver takes both together.
"""

from pathlib import Path

import numpy as np

import mmgrasp as mg

robots = Path(mg.__file__).parent / "assets" / "robots" / "fetchlike"
robot = mg.Robot.load(robots / "fetchlike.urdf", robots / "fetchlike.srdf", base="diff_drive")
group = robot.group("arm", tip="gripper_link", with_base=True).with_reference({"torso_lift_joint": 0.2})
program = mg.planning.drive_by_program(
    group,
    start=[0.0] * 10,
    tasks=[mg.DriveByTask(mg.pose([5.5, 2.0, 0.5], rpy=[1.0, 1.0, 0.0]))],
    goal=[10, 0, -1, 1.13, 0.3, 1.9, 1.1, 2.1, 0.5, 2.5],
)
assert program is not None, "the task is out of reach"


class WithEnergy(mg.optim.NonlinearProblem):
    """Adds `weight` [s] times the mean square of the arm's accelerations [rad^2/s^4]; all other methods are the plan's own."""

    def __init__(self, program: mg.planning.WholeBodyProgram, weight: float) -> None:
        super().__init__(program.problem)
        self.own = program.problem
        self.arm = program.accelerations[:, 2:].ravel()  # v and omega of the base come first
        self.factor = weight / self.arm.size

    def energy(self, x: np.ndarray) -> float:
        return float((x[self.arm] ** 2).mean())

    def objective(self, x: np.ndarray) -> float:
        return self.own.objective(x) + self.factor * float((x[self.arm] ** 2).sum())

    def gradient(self, x: np.ndarray) -> np.ndarray:
        out = self.own.gradient(x)
        out[self.arm] += 2 * self.factor * x[self.arm]
        return out

    def hessian_pattern(self) -> tuple[np.ndarray, np.ndarray]:
        rows, columns = self.own.hessian_pattern()
        return np.append(rows, self.arm), np.append(columns, self.arm)  # entries that repeat add up

    def hessian(self, x: np.ndarray, factor: float, multipliers: np.ndarray) -> np.ndarray:
        return np.append(self.own.hessian(x, factor, multipliers), np.full(self.arm.size, 2 * factor * self.factor))


guess = program.guess
for weight in (0.0, 1.0, 100.0):
    problem = WithEnergy(program, weight)
    found = mg.optim.solve_nonlinear(
        problem, guess, tolerance=1e-4, barrier=1e-2, warm_start=0.0 if weight == 0 else 1e-2
    )
    kept = all(v["kept"] for v in program.violations(found.x).values())
    duration = program.trajectory(found.x).duration
    print(
        f"weight {weight:5.1f} s: {duration:.3f} s, mean square of the arm's accelerations {problem.energy(found.x):.3f} rad^2/s^4,"
    )
    print(f"  {found.outcome.name} in {found.iterations} iterations, {'all limits kept' if kept else 'limits broken'}")
    guess = found.x
