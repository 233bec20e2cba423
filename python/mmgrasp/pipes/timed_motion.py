"""The arm's motion with one grasp, timed, and checked against the pipe's path and for collisions."""

from __future__ import annotations

from itertools import pairwise

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
    """How far a motion through poses (n, 4, 4) and a path (m, 4, 4), both straight from pose to pose, get away from each other: largest distance [m] and angle [rad].

    Both are gone along from begin to end, never back: each pose is compared with the nearest place of a piece of the
    path, and each pose of the path with the nearest place of the motion where that goes from one piece on to the next.
    Of all such ways the one with the least sum of errors counts, in shares of `scales`.
    """
    limits = np.reshape(scales, (1, 2, 1))
    of_pose = np.array([_errors(a[None], b[None], poses, scales) for a, b in pairwise(path)])  # (m - 1, 2, n)
    of_node = np.array([_errors(poses[:-1], poses[1:], T[None], scales) for T in path[1:-1]]).reshape(
        -1, 2, len(poses) - 1
    )
    shares = np.max(of_pose / limits, axis=1)
    passing = np.max(of_node / limits, axis=1)
    least = np.concatenate(
        [[0.0], np.cumsum(np.max(_errors(poses[:1], poses[:1], path[1:-1], scales) / limits[0], axis=0))]
    )
    least = least + shares[:, 0]
    before = np.zeros(shares.shape, int)
    for k in range(1, shares.shape[1]):
        onward = np.concatenate([[0.0], np.cumsum(passing[:, k - 1])])  # what passing the nodes before a piece costs
        ahead = least - onward
        falls = np.concatenate([[True], ahead[1:] < np.minimum.accumulate(ahead)[:-1]])
        before[:, k] = np.maximum.accumulate(np.where(falls, np.arange(len(least)), 0))
        least = ahead[before[:, k]] + onward + shares[:, k]
    piece = len(least) - 1
    worst = np.zeros(2)
    for k in range(shares.shape[1] - 1, 0, -1):
        last = int(before[piece, k])
        worst = np.maximum(worst, of_pose[piece, :, k])
        worst = np.maximum(worst, of_node[last:piece, :, k - 1].max(axis=0, initial=0))
        piece = last
    begin = np.concatenate([of_pose[piece, :, :1], _errors(poses[:1], poses[:1], path[: piece + 1], scales)], axis=1)
    end = _errors(poses[-1:], poses[-1:], path[-1:], scales)
    worst = np.max(np.concatenate([worst[:, None], begin, end], axis=1), axis=1)
    return float(worst[0]), float(worst[1])


def _errors(a: np.ndarray, b: np.ndarray, poses: np.ndarray, scales: tuple[float, float]) -> np.ndarray:
    """Distances and angles (2, n) of poses (n, 4, 4) from the straight ways from a to b; one of the three may be several."""
    way, turn = b[:, :3, 3] - a[:, :3, 3], rotation_vectors(np.swapaxes(a[:, :3, :3], 1, 2) @ b[:, :3, :3])
    weight = (scales[0] / scales[1]) ** 2  # [m2/rad2] turns count where the pipe hardly moves
    turned = rotation_vectors(np.swapaxes(a[:, :3, :3], 1, 2) @ poses[:, :3, :3])
    along = np.sum((poses[:, :3, 3] - a[:, :3, 3]) * way + weight * turned * turn, axis=1)
    share = np.clip(along / np.maximum(np.sum(way * way + weight * turn * turn, axis=1), 1e-15), 0, 1)[:, None]
    off = poses[:, :3, 3] - (a[:, :3, 3] + share * way)
    at = a[:, :3, :3] @ rotations_about(share * turn)
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
