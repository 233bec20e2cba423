"""What every kind of task asks of a motion in passing, kept on every kind of base, judged by forward kinematics alone."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp.reproduce.drive_by import whole_body

BASES = ("diff_drive", "omni", "fixed")
PLACE = np.array(
    [0.75, 0.35, 0.85]
)  # of the tool: before the base that stands, or 1.5 m along the way of one that drives
ANGLES = [0.2, 0.3, 0.4]
PUSH: dict[str, Any] = {
    "tool_speed": 0.2, "finger_length": 0.12, "object_width": 0.05, "planned_depth": 0.045, "max_push": 0.3, "along_error": 0.02,
}  # fmt: skip


def setting(base: str) -> tuple[mg.robot.JointGroup, np.ndarray, np.ndarray, np.ndarray]:
    """Group, pose of the task, start and goal."""
    robot, group = whole_body(base="diff_drive" if base == "fixed" else base)
    arm = [0.3, 0.2, 0.1, 0.6, 0.1, 0.5, 0.0]
    if base == "fixed":
        group = robot.group("arm", tip="gripper_link").with_reference({"torso_lift_joint": 0.2})
        return group, mg.pose(PLACE, ANGLES), np.array(arm), np.array([-0.6, 0.5, 0.0, 0.8, 0.0, 0.4, 0.5])
    goal = np.array([3.0, -0.3, 0.2, *arm])
    return group, mg.pose(PLACE + [1.5, 0, 0], ANGLES), np.array([0, 0, 0, *arm]), goal


def plan(base: str, tasks: list[mg.DriveByTask]) -> tuple[mg.planning.DriveByResult, mg.robot.JointGroup]:
    group, _, start, goal = setting(base)
    found = mg.plan_drive_by(
        group.robot, group, mg.World(), start=start, tasks=tasks, goal=goal, collisions=False, seed=2, time_limit=600.0
    )
    assert found.outcome == mg.Outcome.solved, found.report
    return found, group


def error(group: mg.robot.JointGroup, found: mg.planning.DriveByResult, T: np.ndarray, waypoint: int) -> np.ndarray:
    """Where the tool is in the task's frame: x, y, z [m], then the rotation vector [rad]."""
    between = np.linalg.inv(T) @ group.fk(found.trajectory.positions[waypoint])
    turn = between[:3, :3]
    angle = np.arccos(np.clip((np.trace(turn) - 1) / 2, -1, 1))
    axis = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    return np.concatenate([between[:3, 3], axis / 2 * (angle / np.sin(angle) if angle > 1e-9 else 1.0)])


def tool_speed(group: mg.robot.JointGroup, found: mg.planning.DriveByResult, time: float) -> float:
    """Speed of the tool by differences of its places [m/s]."""
    h = 1e-5
    ends = [group.fk(found.trajectory.at(time + s * h))[:3, 3] for s in (-1, 1)]
    return float(np.linalg.norm(ends[1] - ends[0]) / (2 * h))


Given = tuple[mg.robot.JointGroup, np.ndarray, mg.planning.DriveByResult]


def kept_pose(given: Given) -> None:
    group, T, found = given
    assert np.abs(error(group, found, T, found.events[0]["waypoint"])).max() < 1e-5


def kept_tolerance(given: Given) -> None:
    group, T, found = given
    off = np.abs(error(group, found, T, found.events[0]["waypoint"]))
    assert (off <= np.array([0.05, 0.0, 0.02, 0.0, 0.1, 0.0]) + 1e-5).all()
    assert off.max() > 1e-3  # and it is used


def kept_free(given: Given) -> None:
    group, T, found = given
    off = error(group, found, T, found.events[0]["waypoint"])
    assert np.abs(off[:3]).max() < 1e-5
    between = np.linalg.inv(T) @ group.fk(found.trajectory.positions[found.events[0]["waypoint"]])
    assert between[2, 2] == pytest.approx(1.0, abs=1e-5)  # turned about its own z alone


def kept_candidates(given: Given) -> None:
    group, T, found = given
    event = found.events[0]
    chosen = [T, T @ mg.pose([0.0, 0.1, 0.0])][event["candidate"]]
    assert np.abs(error(group, found, chosen, event["waypoint"])).max() < 1e-5


def kept_speed(given: Given) -> None:
    kept_pose(given)
    group, _, found = given
    assert tool_speed(group, found, found.events[0]["time"]) <= 0.05 + 1e-3


def kept_dwell(given: Given) -> None:
    group, T, found = given
    begin = found.events[0]["time"]
    for time in np.linspace(begin, begin + 0.5, 26):
        between = np.linalg.inv(T) @ group.fk(found.trajectory.at(float(time)))
        assert np.linalg.norm(between[:3, 3]) < 2.1e-3
        assert np.trace(between[:3, :3]) > 1 + 2 * np.cos(0.021)


def kept_push(given: Given) -> None:
    """Along one straight line, never back, no faster than the push, for as long as the fingers need."""
    group, T, found = given
    event, push = found.events[0], mg.grasping.push_grasp(**PUSH)
    begin, end = event["close_time"], event["time"]
    assert push.closing_time - 1e-6 <= end - begin <= 1.1 * push.closing_time + 1e-6
    places = [np.linalg.inv(T) @ group.fk(found.trajectory.at(float(t))) for t in np.linspace(begin, end, 41)]
    assert max(np.hypot(p[1, 3], p[2, 3]) for p in places) < 5e-3
    assert (np.diff([p[0, 3] for p in places]) > -1e-4).all()
    assert tool_speed(group, found, end) < 1.06 * PUSH["tool_speed"]


KINDS: dict[str, tuple[Callable[[np.ndarray], mg.DriveByTask], Callable[[Given], None]]] = {
    "pose": (mg.DriveByTask, kept_pose),
    "tolerance": (lambda T: mg.DriveByTask(T, tolerance=[0.05, 0, 0.02, 0, 0.1, 0]), kept_tolerance),
    "free axes": (lambda T: mg.DriveByTask(T, free_axes=["yaw"]), kept_free),
    "candidates": (lambda T: mg.DriveByTask(np.stack([T, T @ mg.pose([0.0, 0.1, 0.0])])), kept_candidates),
    "tool speed": (lambda T: mg.DriveByTask(T, max_tool_speed=0.05), kept_speed),
    "dwell": (lambda T: mg.DriveByTask(T, dwell=0.5), kept_dwell),
    "push": (lambda T: mg.DriveByTask(T, push={**PUSH, "free_length": 0.05}), kept_push),
}


@pytest.mark.parametrize("base", BASES)
@pytest.mark.parametrize("kind", KINDS)
def test_a_task_is_kept(base: str, kind: str) -> None:
    make, kept = KINDS[kind]
    _, T, _, _ = setting(base)
    found, group = plan(base, [make(T)])
    assert all(v["kept"] for v in found.violations.values())
    assert len(found.events) == 1
    kept((group, T, found))


@pytest.mark.parametrize("base", BASES)
def test_tasks_come_in_their_order(base: str) -> None:
    _, T, _, _ = setting(base)
    second = T @ mg.pose([0.05, 0.05, 0.05])
    found, group = plan(base, [mg.DriveByTask(T), mg.DriveByTask(second)])
    first, then = found.events
    assert 0 < first["time"] < then["time"] < found.duration
    for event, pose in ((first, T), (then, second)):
        assert np.abs(error(group, found, pose, event["waypoint"])).max() < 1e-5


@pytest.mark.parametrize("base", ["diff_drive", "omni"])
def test_a_base_that_drives_does_not_stop_for_a_pose(base: str) -> None:
    _, T, _, _ = setting(base)
    found, _ = plan(base, [mg.DriveByTask(T)])
    assert found.events[0]["base_speed"] > 0.1
