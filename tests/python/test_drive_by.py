"""mg.plan_drive_by: grasping while driving (P1 chapter 4)."""

from __future__ import annotations

import io
import threading
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp.reproduce.drive_by import GOAL, START, whole_body

TASK = mg.pose([5.5, -2, 0.5], [1, 1, 0])
PATIENT: dict[str, Any] = {"time_limit": 600.0}  # how busy the machine is must not decide


@pytest.fixture(scope="module")
def robot() -> mg.Robot:
    return whole_body()[0]


@pytest.fixture(scope="module")
def group() -> mg.robot.JointGroup:
    return whole_body()[1]


@pytest.fixture(scope="module")
def plan(robot: mg.Robot, group: mg.robot.JointGroup) -> mg.planning.DriveByResult:
    return mg.plan_drive_by(robot, group, mg.World(), start=START, tasks=[mg.DriveByTask(TASK)], goal=GOAL, **PATIENT)


def test_the_example_of_the_paper(plan: mg.planning.DriveByResult, group: mg.robot.JointGroup) -> None:
    assert plan.outcome == mg.Outcome.solved, plan.report
    assert all(v["kept"] for v in plan.violations.values())
    assert {"dynamics", "nonholonomic", "velocity", "acceleration", "task position", "collision"} <= set(
        plan.violations
    )
    (event,) = plan.events
    t = plan.trajectory
    assert np.allclose(group.fk(t.positions[event["waypoint"]]), TASK, atol=1e-6)
    assert event["base_speed"] > 0.1
    assert np.allclose(t.positions[0], START)
    assert np.allclose(np.cos(t.positions[-1] - GOAL), 1)
    assert t.duration == plan.duration == t.times[-1]
    assert len(t) == 35


def read_csv(text: str) -> np.ndarray:
    return np.genfromtxt(io.StringIO(text), delimiter=",", names=True, deletechars="")


def test_a_stranger_can_recompute_the_motion_from_the_csv(plan: mg.planning.DriveByResult, robot: mg.Robot) -> None:
    """Wheel speeds, linear between waypoints, lead the base along the plan: integrated here with small straight steps."""
    table = read_csv(plan.trajectory.to_csv())
    separation = robot.base_limits["wheel_separation"]
    x, y, theta = table["x"][0], table["y"][0], table["theta"][0]
    for i in range(len(table) - 1):
        h, steps = table["time"][i + 1] - table["time"][i], 4000
        s = (np.arange(steps) + 0.5) / steps
        left = table["wheel.left"][i] + s * (table["wheel.left"][i + 1] - table["wheel.left"][i])
        right = table["wheel.right"][i] + s * (table["wheel.right"][i + 1] - table["wheel.right"][i])
        v, omega = (left + right) / 2, (right - left) / separation
        turned = theta + h / steps * (np.cumsum(omega) - omega / 2)
        x, y = x + h / steps * np.sum(v * np.cos(turned)), y + h / steps * np.sum(v * np.sin(turned))
        theta += h / steps * omega.sum()
        assert np.hypot(x - table["x"][i + 1], y - table["y"][i + 1]) < 1e-4
        assert abs(theta - table["theta"][i + 1]) < 1e-4
    joint = "shoulder_lift_joint"
    h = np.diff(table["time"])
    assert np.allclose(
        table[joint][1:],
        table[joint][:-1] + h / 2 * (table[f"{joint}.velocity"][1:] + table[f"{joint}.velocity"][:-1]),
        atol=1e-8,
    )


def test_printed_errata_would_fail(plan: mg.planning.DriveByResult, robot: mg.Robot) -> None:
    """(4.1) printed with m instead of m + 1 segments misses the last one; (4.11) needs the wheel separation."""
    t = plan.trajectory
    steps = np.diff(t.times)
    k = plan.events[0]["waypoint"]
    assert np.allclose(steps[:k], steps[0])
    assert np.allclose(steps[k:], steps[-1])
    assert steps.sum() == pytest.approx(plan.duration)
    assert steps[:k].sum() < 0.9 * plan.duration
    table = read_csv(t.to_csv())
    omega = (table["wheel.right"] - table["wheel.left"]) / robot.base_limits["wheel_separation"]
    assert np.allclose(omega, table["base.omega"])
    assert np.allclose(omega, t.drive[:, t.drive_names.index("omega")])


def test_fine_samples_keep_the_limits(plan: mg.planning.DriveByResult, group: mg.robot.JointGroup) -> None:
    fine = plan.trajectory.sampled(9)
    assert len(fine) == 34 * 10 + 1
    joints = slice(3, None)
    assert (np.abs(fine.velocities[:, joints]) <= np.asarray(group.velocity_limits)[joints] + 1e-6).all()
    assert (np.abs(fine.accelerations[:, joints]) <= np.asarray(group.acceleration_limits)[joints] + 1e-5).all()
    rolled = plan.trajectory.rolled_out(100)
    assert np.abs(rolled - plan.trajectory.positions).max() < 1e-6
    assert np.allclose(plan.trajectory.at(fine.times[17]), fine.positions[17])


def test_same_seed_same_answer(plan: mg.planning.DriveByResult, robot: mg.Robot, group: mg.robot.JointGroup) -> None:
    again = mg.plan_drive_by(
        robot, group, mg.World(), start=START, tasks=[mg.DriveByTask(TASK)], goal=GOAL, threads=2, **PATIENT
    )
    assert again.trajectory.to_csv() == plan.trajectory.to_csv()


def test_a_prepared_checker_gives_the_same_answer(robot: mg.Robot, group: mg.robot.JointGroup) -> None:
    world = mg.World()
    world.add_box("table", size=(1, 1, 0.3), pose=mg.pose([5.5, -2.2, 0.15]))
    arguments: dict[str, Any] = {"start": START, "tasks": [mg.DriveByTask(TASK)], "goal": GOAL, **PATIENT}
    made = mg.plan_drive_by(robot, group, world, **arguments)
    checker = mg.CollisionChecker(robot, world, group=group)
    prepared = mg.plan_drive_by(checker, **arguments)
    assert made.outcome == mg.Outcome.solved, made.report
    assert prepared.trajectory.to_csv() == made.trajectory.to_csv()
    assert prepared.report == made.report
    with pytest.raises(mg.InvalidInput, match="which has its own group, world and padding: leave those out"):
        mg.plan_drive_by(checker, group, **arguments)
    with pytest.raises(mg.InvalidInput, match="group"):
        mg.plan_drive_by(robot, **arguments)
    with pytest.raises(mg.InvalidInput, match="attached_only"):
        mg.plan_drive_by(mg.CollisionChecker(robot, world, group=group, attached_only=True), **arguments)


def test_results_print_and_convert(plan: mg.planning.DriveByResult) -> None:
    assert repr(plan).startswith("DriveByResult(solved, ")
    assert "waypoints" in repr(plan.trajectory)
    plain = plan.to_dict()
    assert plain["outcome"] == "solved"
    assert len(plain["trajectory"]["positions"]) == 35
    assert plain["violations"]["dynamics"]["kept"] is True
    assert "solve 1" in plan.report


def test_goal_as_a_box(robot: mg.Robot, group: mg.robot.JointGroup) -> None:
    lower, upper = np.full(10, -np.inf), np.full(10, np.inf)
    lower[:3] = upper[:3] = [8, 1, 0.5]
    found = mg.plan_drive_by(
        robot, group, mg.World(), start=START, tasks=[mg.DriveByTask(mg.pose([4, 1, 0.8], [0, 0.3, 1]))],
        goal=np.stack([lower, upper]), **PATIENT,
    )  # fmt: skip
    assert found.outcome == mg.Outcome.solved, found.report
    assert np.allclose(found.trajectory.positions[-1, :3], [8, 1, 0.5])


def test_out_of_reach_is_told(robot: mg.Robot, group: mg.robot.JointGroup) -> None:
    found = mg.plan_drive_by(
        robot, group, mg.World(), start=START, tasks=[mg.DriveByTask(mg.pose([5, 0, 4]))], goal=GOAL
    )
    assert found.outcome == mg.Outcome.not_found
    assert "task 0" in found.report
    assert found.trajectory is None
    assert found.duration == 0


def test_start_in_collision(robot: mg.Robot, group: mg.robot.JointGroup) -> None:
    world = mg.World()
    world.add_box("pillar", size=(0.3, 0.3, 1), pose=mg.pose([0, 0, 0.5]))
    found = mg.plan_drive_by(robot, group, world, start=START, tasks=[mg.DriveByTask(TASK)], goal=GOAL)
    assert found.outcome == mg.Outcome.invalid_start
    assert "pillar" in found.report


def test_best_iterate_when_time_ends(robot: mg.Robot, group: mg.robot.JointGroup) -> None:
    found = mg.plan_drive_by(
        robot,
        group,
        mg.World(),
        start=START,
        tasks=[mg.DriveByTask(TASK)],
        goal=GOAL,
        max_iterations=2,
        seeds=1,
        **PATIENT,
    )
    assert found.outcome == mg.Outcome.timeout
    assert found.trajectory is not None
    assert not all(v["kept"] for v in found.violations.values())
    assert "broken by" in found.report


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"start": [0.0] * 9}, "start"),
        ({"start": [np.nan] + [0.0] * 9}, "nan"),
        ({"start": [0, 0, 0, 0, 3, 0, 0, 0, 0, 0]}, "limits of shoulder_lift_joint"),
        ({"goal": np.stack([np.ones(10), np.zeros(10)])}, "goal"),
        ({"waypoints": 3}, "waypoints"),
        ({"solver": "snopt"}, "ipopt, slsqp"),
        ({"smooting": 1}, "smoothing"),
        ({"look_out": 0.2}, "it is called constraint_distance now"),
        ({"tolerance": 0}, "tolerance"),
        ({"iterations": 0}, "iterations"),
        ({"grasp_assignments": 0}, "grasp_assignments"),
        ({"tasks": [mg.DriveByTask(np.eye(4), object="ghost")]}, "ghost"),
    ],
)
def test_bad_input(robot: mg.Robot, group: mg.robot.JointGroup, change: dict[str, Any], message: str) -> None:
    arguments = {"start": START, "tasks": [mg.DriveByTask(TASK)], "goal": GOAL, **change}
    with pytest.raises(mg.InvalidInput, match=message):
        mg.plan_drive_by(robot, group, mg.World(), **arguments)


def test_bad_tasks() -> None:
    with pytest.raises(mg.InvalidInput, match="roll"):
        mg.DriveByTask(TASK, free_axes=["rol"])
    with pytest.raises(mg.InvalidInput, match="free_axes now"):
        mg.DriveByTask(TASK, free=["roll"])  # type: ignore[call-arg]
    with pytest.raises(mg.InvalidInput, match="max_tool_speed"):
        mg.DriveByTask(TASK, max_tool_speed=0)
    with pytest.raises(mg.InvalidInput, match="dwell"):
        mg.DriveByTask(TASK, dwell=-1)
    with pytest.raises(mg.InvalidInput, match="tolerance"):
        mg.DriveByTask(TASK, tolerance=[0, 0, 0, 0, 0, -1])


def test_push_grasp_as_data() -> None:
    push = {"opening": 0.08, "tool_speed": 0.3, "along_error": 0.01, "approach": [1, 0, 0], "free_length": 0.08}
    task = mg.DriveByTask(TASK, push=push)
    expected = mg.grasping.push_grasp(opening=0.08, tool_speed=0.3, along_error=0.01)
    assert task.push.to_dict() == expected.to_dict()
    assert mg.DriveByTask(TASK).push is None
    with pytest.raises(mg.InvalidInput, match="tool_speed"):
        mg.DriveByTask(TASK, push={"tol_speed": 0.3})
    with pytest.raises(mg.InvalidInput, match="approach"):
        mg.DriveByTask(TASK, push={"approach": [1, 0]})


def test_push_grasp_has_its_own_limits(robot: mg.Robot, group: mg.robot.JointGroup) -> None:
    task = mg.DriveByTask(TASK, push={}, dwell=0.2)
    with pytest.raises(mg.InvalidInput, match=r"tasks\[0\].push with dwell"):
        mg.plan_drive_by(robot, group, mg.World(), start=START, tasks=[task], goal=GOAL)


def test_contradictory_base_limits(group: mg.robot.JointGroup) -> None:
    with pytest.raises(mg.InvalidInput, match="linear_velocity"):
        mg.Robot.from_strings(
            "<robot name='r'><link name='a'/></robot>", base="diff_drive", base_limits={"linear_velocity": 0}
        )


def test_arm_alone(robot: mg.Robot) -> None:
    """A task for an arm on the spot is the special case without a base."""
    arm = robot.group("arm", tip="gripper_link")
    start = np.array([0.3, -0.5, 0, 1.2, 0, 0.8, 0])
    middle = arm.fk(start + [0.4, 0.2, 0.1, 0.1, 0.2, 0.1, 0.3])
    found = mg.plan_drive_by(
        robot, arm, mg.World(), start=start, tasks=[mg.DriveByTask(middle)], goal=start, collisions=False, **PATIENT
    )
    assert found.outcome == mg.Outcome.solved, found.report
    assert np.allclose(arm.fk(found.trajectory.positions[found.events[0]["waypoint"]]), middle, atol=1e-6)


def test_threads_run_side_by_side(robot: mg.Robot, group: mg.robot.JointGroup, plan: mg.planning.DriveByResult) -> None:
    found: list[mg.planning.DriveByResult] = []

    def work() -> None:
        found.append(
            mg.plan_drive_by(robot, group, mg.World(), start=START, tasks=[mg.DriveByTask(TASK)], goal=GOAL, **PATIENT)
        )

    threads = [threading.Thread(target=work) for _ in range(3)]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    assert {r.trajectory.to_csv() for r in found} == {plan.trajectory.to_csv()}


def test_interrupt_ends_it(robot: mg.Robot, group: mg.robot.JointGroup) -> None:
    class StopError(Exception):
        pass

    def progress(stage: str, fraction: float) -> None:
        raise StopError

    with pytest.raises(StopError):
        mg.plan_drive_by(
            robot, group, mg.World(), start=START, tasks=[mg.DriveByTask(TASK)], goal=GOAL, waypoints=400,
            progress=progress, time_limit=300.0,
        )  # fmt: skip


def test_both_solvers_drive_the_same_way(robot: mg.Robot, group: mg.robot.JointGroup) -> None:
    """Dense and sparse, first and second derivatives: nothing in common but the problem."""
    found = {
        solver: mg.plan_drive_by(
            robot, group, mg.World(), start=START, tasks=[mg.DriveByTask(TASK)], goal=GOAL, waypoints=8, solver=solver,
            collisions=False, seeds=1, max_iterations=1000, **PATIENT,
        )
        for solver in ("ipopt", "slsqp")
    }  # fmt: skip
    assert all(result.outcome == mg.Outcome.solved for result in found.values())
    assert found["slsqp"].duration == pytest.approx(found["ipopt"].duration, rel=1e-2)
    # The base takes all the time; joints that have time to spare may go several ways.
    bases = [result.trajectory.positions[:, :3] for result in found.values()]
    assert bases[0] == pytest.approx(bases[1], abs=0.05)
