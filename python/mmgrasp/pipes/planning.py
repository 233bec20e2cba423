"""The best grasp of a pipe problem, the arm's timed motion with it, and how the pipe bends on the way."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from .._argument_errors import checked
from .._core import (
    Error,
    Grasp,
    GraspOptimum,
    JointTrajectory,
    ObjectPathResult,
    Outcome,
    SupportedFrame,
    default_grasp_search,
    follow_object_path,
    optimize_grasp,
)
from .._progress import Progress
from .problem import PipeProblem
from .timed_motion import UntimedError, passing_times, timed_motion

TIMED_GRASPS = 20  # the cheapest grasps, of which one must have a timed motion


@dataclass(frozen=True)
class WaypointSag:
    """How the pipe bends at one pose of its path."""

    time: float
    """[s] of the arm's motion."""
    sag: float
    """Largest displacement [m]."""
    section: int
    distance: float
    """Where that is: from the section's first node [m]."""
    stress: float | None
    """Largest von Mises stress [Pa]."""
    over_limit: float | None
    """Largest stress over its limit; None without one."""


@dataclass
class PipePlan:
    """What `plan_pipe` found."""

    problem: PipeProblem
    optimum: GraspOptimum
    grasp: Grasp | None = None
    """The best grasp with which the motion can be timed, or None."""
    path: ObjectPathResult | None = None
    """Its configurations at the poses and its costs."""
    untimed: int = 0
    """Cheaper grasps whose timed motion leaves the path or collides."""
    trajectory: JointTrajectory | None = None
    """Along the path, checked for collisions at 0.005 rad."""
    waypoint_times: np.ndarray = field(default_factory=lambda: np.zeros(0))
    """When the motion passes each pose [s]."""
    path_error: tuple[float, float] = (0.0, 0.0)
    """How far the pipe gets from its path while the motion is timed: largest distance [m] and angle [rad]."""
    sags: list[WaypointSag] = field(default_factory=list)
    compared: list[ObjectPathResult] = field(default_factory=list)
    """What the grasps of the file's `compare` cost."""

    @property
    def outcome(self) -> Outcome:
        """The search's outcome, or why there is no motion; no more than approximate where a cheaper grasp could not be timed."""
        found = self.optimum.outcome
        return Outcome.approximate if self.untimed > 0 and found == Outcome.solved else found

    @property
    def gap(self) -> float:
        """How much cheaper another grasp could be at most, as a share of the cost."""
        if self.path is None or self.path.cost <= 0:
            return self.optimum.gap
        return max(0.0, 1 - self.optimum.lower_bound / self.path.cost)

    @property
    def proof(self) -> str:
        """What is proven of the grasp, in words."""
        if self.grasp is None:
            return "proven: no grasp can do it" if self.outcome == Outcome.infeasible else "no proof that there is none"
        if self.optimum.lower_bound <= 0:
            return "the best of the search, not proven"
        return f"no grasp is more than {100 * self.gap:.2g} % cheaper, which is proven"

    @property
    def obstruction(self) -> str:
        """Why there is no grasp: the pose where most of the grasps tried fell, and how many; empty when there is one."""
        if self.grasp is not None:
            return ""
        found, tried = self.optimum, self.optimum.evaluations
        if tried == 0:
            return "no grasp was tried"
        causes = [
            (found.unreachable, "no arm configuration reaches pose {} with {} of the {} grasps tried"),
            (found.colliding, "at pose {} every arm configuration collides with {} of the {} grasps tried"),
            (found.overloaded, f"at pose {{}} the pipe {self.problem.overload} with {{}} of the {{}} grasps tried"),
            (
                found.jumping_after,
                "from pose {} to the next every motion jumps to another arm posture with {} of the {} grasps tried: give poses between, or raise max_joint_step",
            ),
            (
                found.colliding_after,
                "from pose {} to the next every motion without a jump collides or leaves the path with {} of the {} grasps tried: give poses between, or raise position_tolerance or rotation_tolerance",
            ),
        ]
        lines = []
        for counts, text in causes:
            worst = int(np.argmax(counts))
            if counts[worst] > 0:
                lines.append((counts[worst], text.format(worst, counts[worst], tried)))
        lines.sort(key=lambda line: -line[0])
        return "; ".join(text for _, text in lines)


@checked
def plan_pipe(problem: PipeProblem, progress: Progress = None) -> PipePlan:
    """Searches the best grasp, times the arm's motion with it (or with the next best, where it cannot be), checks that motion again, and says how the pipe bends at every pose."""
    task = problem.object_path_problem()
    optimum = optimize_grasp(
        task,
        problem.pipe,
        **{"algorithm": default_grasp_search(problem.arm), "max_evaluations": 2000, **problem.search_options},
        **problem.all_path_options,
        progress=progress,
    )
    plan = PipePlan(problem, optimum)
    plan.compared = [follow_object_path(task, grasp, **problem.all_path_options) for grasp in problem.compare]
    if optimum.grasp is None:
        return plan
    reason: Error = UntimedError("no grasp passes the finer check")
    for i, candidate in enumerate(optimum.feasible[:TIMED_GRASPS]):
        path = optimum.path if i == 0 else follow_object_path(task, candidate.grasp, **problem.all_path_options)
        if path.path is None:  # refused by the finer check
            continue
        try:
            plan.trajectory, plan.path_error = timed_motion(problem, candidate.grasp, path.path, progress)
        except UntimedError as error:
            plan.untimed += 1
            reason = error
            continue
        plan.grasp, plan.path = candidate.grasp, path
        break
    if plan.grasp is None or plan.trajectory is None or plan.path is None:
        raise UntimedError(f"{reason} ({plan.untimed} grasps tried)")
    plan.waypoint_times = passing_times(plan.trajectory, plan.path.path)
    held = SupportedFrame(problem.frame, [plan.grasp])
    for T, time in zip(problem.T_world_pipe, plan.waypoint_times, strict=True):
        state = held.state(problem.gravity_in_pipe(T))
        plan.sags.append(
            WaypointSag(
                float(time),
                state.displacement.value,
                state.displacement.member,
                state.displacement.distance,
                state.stress.value if state.stress else None,
                state.over_limit.value if state.over_limit else None,
            )
        )
    return plan
