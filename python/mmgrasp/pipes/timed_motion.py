"""The arm's motion with one grasp, timed, and checked against the pipe's path and for collisions."""

from __future__ import annotations

import numpy as np

from .._core import CollisionChecker, Error, Grasp, JointTrajectory, time_parameterize
from .._progress import Progress
from .._turns import between, rotation_vector, rotation_vectors, rotations_about
from .problem import PipeProblem

POSITION_STEP, ROTATION_STEP = 0.01, 0.05  # of the pipe between two poses that the arm is computed for [m], [rad]
CORNER = 0.002  # the timed motion passes this near to each of them, in every joint [rad or m]
STOP = 1e-4  # or, where that leaves the path, this near [rad or m]
CHECK_STEP = 0.005  # no joint moves more between two checks of the timed motion [rad or m]


class UntimedError(Error):
    """A grasp's motion through its poses cannot be timed."""


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
        poses = arm.fk_batch(trajectory.positions) @ np.linalg.inv(grasp.T_object_hand)
        error = path_error(problem.T_world_pipe, poses, allowed)
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


def path_error(path: np.ndarray, poses: np.ndarray, scales: tuple[float, float]) -> tuple[float, float]:
    """How far poses (n, 4, 4) that follow a path (m, 4, 4) in its order, from its first pose to its last, get away from it: largest distance [m] and angle [rad].

    Each is compared with the nearest place of one of the path's straight pieces, never of an earlier piece than the pose
    before: of all such ways to go along, the one with the least sum of errors, in shares of `scales`.
    """
    errors = np.array([_errors(path[j], path[j + 1], poses, scales) for j in range(len(path) - 1)])  # (m - 1, 2, n)
    shares = np.max(errors / np.reshape(scales, (1, 2, 1)), axis=1)
    least = np.full(len(path) - 1, np.inf)
    least[0] = shares[0, 0]
    before = np.zeros(shares.shape, int)
    for k in range(1, shares.shape[1]):
        so_far = np.minimum.accumulate(least)
        falls = np.concatenate([[True], least[1:] < so_far[:-1]])
        before[:, k] = np.maximum.accumulate(np.where(falls, np.arange(len(least)), 0))
        least = so_far + shares[:, k]
    piece = len(least) - 1
    worst = np.zeros(2)
    for k in range(shares.shape[1] - 1, -1, -1):
        worst = np.maximum(worst, errors[piece, :, k])
        piece = before[piece, k]
    return float(worst[0]), float(worst[1])


def _errors(a: np.ndarray, b: np.ndarray, poses: np.ndarray, scales: tuple[float, float]) -> np.ndarray:
    """Distances and angles (2, n) of poses from the straight way between two."""
    way, turn = b[:3, 3] - a[:3, 3], rotation_vector(a[:3, :3].T @ b[:3, :3])
    weight = (scales[0] / scales[1]) ** 2  # [m2/rad2] turns count where the pipe hardly moves
    turned = rotation_vectors(a[:3, :3].T @ poses[:, :3, :3])
    along = (poses[:, :3, 3] - a[:3, 3]) @ way + weight * (turned @ turn)
    share = np.clip(along / max(way @ way + weight * (turn @ turn), 1e-15), 0, 1)
    off = poses[:, :3, 3] - (a[:3, 3] + share[:, None] * way)
    at = a[:3, :3] @ rotations_about(share[:, None] * turn)
    angles = np.linalg.norm(rotation_vectors(np.swapaxes(at, 1, 2) @ poses[:, :3, :3]), axis=1)
    return np.array([np.linalg.norm(off, axis=1), angles])


def passing_times(trajectory: JointTrajectory, waypoints: np.ndarray) -> np.ndarray:
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
