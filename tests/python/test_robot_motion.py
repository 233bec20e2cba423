"""RobotMotion: what a robot carries out. Its clock, velocities and twists, integrated here by other means, give the plan back."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import mmgrasp as mg
from conftest import ASSETS
from mmgrasp.planning import RobotMotion
from mmgrasp.records import MotionMessage
from mmgrasp.reproduce.drive_by import GOAL, START, whole_body


def integrated(message: MotionMessage) -> tuple[np.ndarray, np.ndarray]:
    """Base poses and joints at the points, from the first one and what the message says of velocities alone.

    Twists are linear between points and followed in the platform's own frame in small steps (midpoint rule); joints by the
    trapezoidal rule, or Simpson's with the cubic's middle where accelerations are given.
    """
    points = message["points"]
    times = [p["time_from_start"]["sec"] + 1e-9 * p["time_from_start"]["nanosec"] for p in points]
    assert (np.diff(times) > 0).all()
    x, y, theta = points[0]["base_pose"]
    q = np.array(points[0]["positions"])
    poses, joints = [np.array([x, y, theta])], [q]
    for i in range(len(points) - 1):
        a, b, h = points[i], points[i + 1], times[i + 1] - times[i]
        steps = max(4, int(h / 1e-3))
        for k in range(steps):
            s = (k + 0.5) / steps
            vx, vy, omega = (1 - s) * np.array(a["base_twist"]) + s * np.array(b["base_twist"])
            middle = theta + 0.5 * h / steps * omega
            x += h / steps * (vx * np.cos(middle) - vy * np.sin(middle))
            y += h / steps * (vx * np.sin(middle) + vy * np.cos(middle))
            theta += h / steps * omega
        poses.append(np.array([x, y, theta]))
        q = q + h / 2 * (np.array(a["velocities"]) + np.array(b["velocities"]))
        joints.append(q)
    return np.array(poses), np.array(joints)


def check(motion: RobotMotion, shift: float = 2e-4, joint: float = 2e-3) -> MotionMessage:
    message = motion.to_joint_trajectory()
    json.dumps(message, allow_nan=False)
    poses, joints = integrated(message)
    assert np.abs(poses - motion.base_poses).max() < shift
    assert np.abs(joints - motion.positions).max() < joint
    return message


@pytest.mark.parametrize("base", ["diff_drive", "omni"])
def test_a_drive_by_integrates_to_its_plan(base: str) -> None:
    _, group = whole_body(base=base)
    world = mg.World()
    T_tip = mg.pose([3.0, -1.0, 0.7], [0.2, 0.3, 0.5])
    world.add("part", mg.Box([0.02, 0.02, 0.1]), mg.pose([3.0, -1.0, 0.7]) @ mg.pose([0, 0, 5.0]))
    goal = np.array(GOAL, float)
    goal[:3] = [6, 0.5, 0.7]
    task = mg.DriveByTask(T_tip, dwell=0.4, object="part", max_tool_speed=0.3)
    plan = mg.plan_drive_by(group.robot, group, world, start=START, tasks=[task], goal=goal, time_limit=600.0)
    assert plan.outcome == mg.Outcome.solved, plan.report
    motion = RobotMotion.of_drive_by(plan, openings=[0.03])
    message = check(motion, shift=1e-5 if base == "diff_drive" else 1e-4)  # an omni base's twist turns between points
    assert message["joint_names"] == group.names[3:]
    assert motion.duration == pytest.approx(plan.duration)
    end = plan.trajectory.positions[-1]
    assert np.allclose(integrated(message)[0][-1], end[:3], atol=1e-5)
    speeds = np.linalg.norm(motion.base_twists[:, :2], axis=1)
    assert speeds.max() > 0.3  # it does drive
    if base == "diff_drive":
        assert np.abs(motion.base_twists[:, 1]).max() < 1e-12
    else:
        assert np.abs(motion.base_twists[:, 1]).max() > 0.05
    (closing,) = motion.gripper
    event = plan.events[0]
    assert closing == {
        "time": event["close_time"], "duration": event["attach_time"] - event["close_time"], "command": "close", "opening": 0.03,
        "object": "part",
    }  # fmt: skip
    assert closing["duration"] >= 0.4
    # The message of the trajectory itself says the same of the base.
    points = plan.trajectory.sampled().to_joint_trajectory()["points"]
    assert max(np.hypot(*p["base_twist"][:2]) for p in points) > 0.3
    assert np.allclose(points[-1]["base_pose"], end[:3])
    with pytest.raises(mg.InvalidInput, match="openings"):
        RobotMotion.of_drive_by(plan, openings=[0.01, 0.02])
    with pytest.raises(mg.InvalidInput, match="base_pose"):
        plan.trajectory.sampled().to_joint_trajectory(base_pose=[0, 0, 0])


@pytest.mark.parametrize(("kind", "scenario"), [("diff_drive", "storeroom"), ("omni", "omni_cell")])
def test_a_drive_integrates_to_its_poses_within_the_limits(kind: str, scenario: str) -> None:
    setup = mg.load_scenario(ASSETS / "scenarios" / f"{scenario}.yaml").setup
    robot, arm = setup.robot, setup.arm
    assert robot.base == kind
    path = mg.base.plan_base_route(arm, mg.World(), home=setup.home, start=[0, 0, 0], goal=[3, 2, -1.2])
    motion = RobotMotion.of_drive(path, robot, arm, setup.home)
    assert motion.duration == pytest.approx(path.duration(robot), abs=1e-9)
    check(motion, shift=1e-3)
    assert np.allclose(motion.base_poses[-1], path.poses[-1])
    twists, h = motion.base_twists, np.diff(motion.times)[:, None]
    limits = robot.base_limits
    world = np.array([mg.base.joint_velocity(t, v) for t, v in zip(motion.base_poses[:, 2], twists, strict=True)])
    change = np.abs(np.diff(world, axis=0) / h)
    assert np.linalg.norm(twists[:, :2], axis=1).max() <= limits["linear_velocity"] + 1e-9
    assert np.abs(twists[:, 2]).max() <= limits["angular_velocity"] + 1e-9
    assert np.linalg.norm(change[:, :2], axis=1).max() <= limits["linear_acceleration"] + 1e-6
    assert change[:, 2].max() <= limits["angular_acceleration"] + 1e-6
    for pose in path.poses:  # every pose of the path is on the clock
        assert np.abs(motion.base_poses - pose).max(axis=1).min() < 1e-9


def test_a_transfer_of_base_and_arm_integrates_to_its_path() -> None:
    _, group = whole_body(base="omni")
    start, goal = np.zeros(group.size), np.linspace(0.3, 0.9, group.size)
    limits = np.minimum(group.velocity_limits, 1.0)
    timed = mg.time_parameterize([start, 0.6 * goal, goal], limits, group.acceleration_limits, names=group.names)
    motion = RobotMotion(timed)
    assert motion.joints == group.names[3:]
    check(motion, shift=2e-3)
    assert np.allclose(motion.base_poses[-1], goal[:3])


def test_a_round_is_one_motion(small_plan: mg.part_supply.ScenarioPlan, tmp_path: Path) -> None:
    """Drives, picks and gripper one after the other, as long as the plan says, and every part is taken and left."""
    setup, problem = small_plan.scenario.setup, small_plan.scenario.problem()
    motion = small_plan.motion()
    check(motion, shift=2e-3, joint=5e-3)
    closing = sum(2 * (p.motions[0].opening - p.motions[2].opening) / setup.closing_speed for p in small_plan.picks)
    changes = sum(
        abs(b.motions[0].opening - a.motions[-1].opening) / setup.closing_speed
        for a, b in zip(small_plan.picks, small_plan.picks[1:], strict=False)
    )
    driving = sum(leg.duration(setup.robot) for leg in small_plan.route)
    arm = sum(p.duration for p in small_plan.picks)
    assert motion.duration == pytest.approx(driving + arm + closing + changes, abs=1e-6)
    taken = [e["object"] for e in motion.gripper if e["command"] == "close" and e["object"]]
    assert taken == [problem.trays[p.tray].parts[p.part].name for p in small_plan.picks]
    for event in motion.gripper:  # everything stands while the fingers move
        inside = (motion.times > event["time"] + 1e-9) & (motion.times < event["time"] + event["duration"] - 1e-9)
        assert not inside.any()
    assert np.allclose(motion.base_poses[0], problem.start)
    assert np.allclose(motion.base_poses[-1], problem.goal, atol=1e-6)
    written = small_plan.save_trajectories(tmp_path)
    assert written[0].name == "round.csv"
    header, *rows = written[0].read_text().splitlines()
    assert header.startswith("time,base.x,base.y,base.theta,base.v,base.vy,base.omega,")
    assert header.endswith(",gripper")
    assert len(rows) == len(motion)
    reported = [row.rsplit(",", 1)[1].split() for row in rows]
    assert sum(len(t) for t in reported) == len(motion.gripper)
    drive = np.genfromtxt(tmp_path / "drive_00.csv", delimiter=",", names=True, deletechars="", usecols=range(7))
    assert drive["time"][-1] == pytest.approx(small_plan.route[0].duration(setup.robot))


def test_wrong_input_is_named(small_plan: mg.part_supply.ScenarioPlan) -> None:
    setup, leg = small_plan.scenario.setup, small_plan.route[0]
    drive = RobotMotion.of_drive(leg, setup.robot, setup.arm, setup.home)
    with pytest.raises(mg.InvalidInput, match="period = -1"):
        RobotMotion.of_drive(leg, setup.robot, setup.arm, setup.home, period=-1)
    with pytest.raises(mg.InvalidInput, match="must begin where the motion ends: base poses"):
        drive.append(RobotMotion.of_drive(leg, setup.robot, setup.arm, setup.home))
    with pytest.raises(mg.InvalidInput, match="open or close"):
        drive.command_gripper("shut")
    with pytest.raises(mg.InvalidInput, match="duration"):
        drive.wait(-1)
    path = mg.planning.JointTrajectory(["a"], [0, 1], [[0], [1]])
    with pytest.raises(mg.InvalidInput, match="timed"):
        RobotMotion(path)
