"""The best grasp of a pipe problem, the arm's timed motion with it, and how the pipe bends on the way."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from .._core import (
    CollisionChecker,
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
    time_parameterize,
)
from .._progress import Progress
from .._turns import between, rotation_vector
from .problem import PipeProblem

POSITION_STEP, ROTATION_STEP = 0.01, 0.05  # of the pipe between two poses that the arm is computed for [m], [rad]
CORNER = 0.002  # the timed motion passes this near to each of them, in every joint [rad or m]
STOP = 1e-4  # or, where that leaves the path, this near [rad or m]
TIMED_GRASPS = 20  # the cheapest grasps, of which one must have a timed motion
CHECK_STEP = 0.005  # no joint moves more between two checks of the timed motion [rad or m]


class UntimedError(Error):
    """A grasp's motion through its poses cannot be timed."""


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
            (
                found.overloaded,
                "at pose {} the pipe bends or bears more than its limits with {} of the {} grasps tried",
            ),
        ]
        lines = []
        for counts, text in causes:
            worst = int(np.argmax(counts))
            if counts[worst] > 0:
                lines.append((counts[worst], text.format(worst, counts[worst], tried)))
        lines.sort(key=lambda line: -line[0])
        if not lines:
            return "every pose is reached, but no allowed motion joins the poses: give poses between, or raise max_joint_step"
        return "; ".join(text for _, text in lines)


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
    plan.waypoint_times = _passing_times(plan.trajectory, plan.path.path)
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


def timed_motion(
    problem: PipeProblem, grasp: Grasp, waypoints: np.ndarray, progress: Progress = None
) -> tuple[JointTrajectory, tuple[float, float]]:
    """The motion through the waypoints, along the pipe's path between them where the arm can, else straight in joint space.

    Checked for collisions and against the path's tolerances; raises UntimedError when neither passes.
    """
    arm, world = problem.holding(grasp)
    checker = CollisionChecker(problem.robot, world, group=arm)
    allowed = (
        float(problem.path_options.get("position_tolerance", 0.01)),
        float(problem.path_options.get("rotation_tolerance", 0.05)),
    )
    dense = _dense(problem, grasp, waypoints)
    tries = [(dense, CORNER)] if dense is not None else []
    for path, corner in (*tries, (waypoints, CORNER), (waypoints, STOP)):
        trajectory = time_parameterize(
            path,
            problem.speed * np.asarray(arm.velocity_limits),
            problem.acceleration * np.asarray(arm.acceleration_limits),
            names=arm.names,
            max_deviation=corner,
            progress=progress,
        )
        error = _path_error(problem, grasp, trajectory, waypoints)
        if error[0] <= allowed[0] and error[1] <= allowed[1] and _is_free(checker, trajectory):
            return trajectory, error
    raise UntimedError(
        "the timed motion leaves the pipe's path or collides, which the motion through its poses does not: give more poses"
    )


def _dense(problem: PipeProblem, grasp: Grasp, waypoints: np.ndarray) -> np.ndarray | None:
    """Configurations at poses between the waypoints; None when the arm's posture cannot be kept there."""
    out = [waypoints[0]]
    for i in range(len(waypoints) - 1):
        a, b = problem.T_world_pipe[i], problem.T_world_pipe[i + 1]
        length = np.linalg.norm(b[:3, 3] - a[:3, 3])
        angle = np.linalg.norm(rotation_vector(a[:3, :3].T @ b[:3, :3]))
        pieces = max(1, int(np.ceil(max(length / POSITION_STEP, angle / ROTATION_STEP))))
        for k in range(1, pieces):
            near = waypoints[i] + (waypoints[i + 1] - waypoints[i]) * (k / pieces)
            found = problem.arm.ik(between(a, b, k / pieces) @ grasp.T_object_hand, seed=near, restarts=0)
            if found.q is None or np.abs(found.q - near).max() > 0.1:
                return None
            out.append(found.q)
        out.append(waypoints[i + 1])
    return np.array(out)


def _samples(trajectory: JointTrajectory) -> np.ndarray:
    """Configurations so close that no joint moves more than CHECK_STEP between two of them."""
    rows = [trajectory.positions[:1]]
    for a, b in zip(trajectory.positions[:-1], trajectory.positions[1:], strict=True):
        pieces = max(1, int(np.ceil(np.abs(b - a).max() / CHECK_STEP)))
        rows.append(a + (b - a) * (np.arange(1, pieces + 1) / pieces)[:, None])
    return np.concatenate(rows)


def _is_free(checker: CollisionChecker, trajectory: JointTrajectory) -> bool:
    return bool(np.all(checker.are_free(_samples(trajectory))))


def _path_error(
    problem: PipeProblem, grasp: Grasp, trajectory: JointTrajectory, waypoints: np.ndarray
) -> tuple[float, float]:
    """The largest distance and angle of the pipe, at any sample of the motion, from the nearest place of its path's straight pieces."""
    T_hand_pipe = np.linalg.inv(grasp.T_object_hand)
    times = _passing_times(trajectory, waypoints)
    hands = problem.arm.fk_batch(trajectory.positions)
    worst = np.zeros(2)
    for time, T_world_hand in zip(trajectory.times, hands, strict=True):
        T = T_world_hand @ T_hand_pipe
        i = int(np.clip(np.searchsorted(times, time, side="right") - 1, 0, len(times) - 2))
        near = [_distance(problem.T_world_pipe, j, T) for j in (i - 1, i, i + 1) if 0 <= j < len(times) - 1]
        worst = np.maximum(worst, min(near, key=lambda e: e[0] + 0.1 * e[1]))
    return float(worst[0]), float(worst[1])


def _distance(poses: np.ndarray, i: int, T: np.ndarray) -> tuple[float, float]:
    """From the piece between poses i and i + 1."""
    a, b = poses[i], poses[i + 1]
    way = b[:3, 3] - a[:3, 3]
    turn = rotation_vector(a[:3, :3].T @ b[:3, :3])
    weight = 0.01  # [m2/rad2] turns count where the pipe hardly moves
    along = way @ (T[:3, 3] - a[:3, 3]) + weight * (turn @ rotation_vector(a[:3, :3].T @ T[:3, :3]))
    share = float(np.clip(along / max(way @ way + weight * (turn @ turn), 1e-15), 0, 1))
    at = between(a, b, share)
    return (
        float(np.linalg.norm(T[:3, 3] - at[:3, 3])),
        float(np.linalg.norm(rotation_vector(at[:3, :3].T @ T[:3, :3]))),
    )


def _passing_times(trajectory: JointTrajectory, waypoints: np.ndarray) -> np.ndarray:
    """When the motion is nearest to each waypoint, in their order: the first at its begin, the last at its end."""
    lengths = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(waypoints, axis=0), axis=1))])
    done = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(trajectory.positions, axis=0), axis=1))])
    shares = lengths / lengths[-1] * done[-1] if lengths[-1] > 0 else lengths
    times = [trajectory.times[0]]
    window = 0.1 * done[-1] + 1e-9
    for waypoint, share in zip(waypoints[1:-1], shares[1:-1], strict=True):
        near = np.flatnonzero((np.abs(done - share) <= window) & (trajectory.times >= times[-1]))
        if len(near) == 0:
            near = np.flatnonzero(trajectory.times >= times[-1])
        best = near[np.argmin(np.linalg.norm(trajectory.positions[near] - waypoint, axis=1))]
        times.append(trajectory.times[best])
    return np.array([*times, trajectory.times[-1]])
