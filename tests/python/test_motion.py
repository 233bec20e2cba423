"""Motions at the Python door: goals by pose, cones, reports of better paths, lines, jerk; and MotionBenchMaker's problems solved."""

from __future__ import annotations

import itertools
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest

import mmgrasp as mg
from conftest import ASSETS
from mmgrasp.cli import main
from mmgrasp.problems.motion_bench import read_motion_problem
from mmgrasp.problems.motion_bench_run import verify_motion

LINK = 0.4
URDF = "<robot name='planar'><link name='l0'/>" + "".join(
    f"<link name='l{i}'><collision><origin xyz='{LINK / 2} 0 0'/><geometry><box size='{LINK} 0.04 0.04'/></geometry>"
    f"</collision></link><joint name='j{i}' type='revolute'><parent link='l{i - 1}'/><child link='l{i}'/>"
    f"<origin xyz='{0 if i == 1 else LINK} 0 0'/><axis xyz='0 0 1'/>"
    "<limit lower='-2.8' upper='2.8' velocity='2' effort='1'/></joint>"
    for i in range(1, 5)
)
URDF += f"<link name='tip'/><joint name='t' type='fixed'><parent link='l4'/><child link='tip'/><origin xyz='{LINK} 0 0'/></joint></robot>"
SRDF = "<robot name='planar'>" + "".join(
    f"<disable_collisions link1='l{i}' link2='l{k}' reason='User'/>" for i in range(5) for k in range(i)
)
SRDF += "</robot>"


@pytest.fixture(scope="module")
def robot() -> mg.Robot:
    return mg.Robot.from_strings(URDF, SRDF)


@pytest.fixture(scope="module")
def arm(robot: mg.Robot) -> mg.robot.JointGroup:
    return robot.group(base_link="l0", tip="tip")


@pytest.fixture
def world() -> mg.World:
    world = mg.World()
    world.add_box("wall", (0.7, 0.1, 0.2), mg.pose([1.2, 0, 0]))
    return world


def tip(q: np.ndarray) -> np.ndarray:
    """x, y and heading of the tool by trigonometry."""
    angles = np.cumsum(q)
    return np.array([LINK * np.cos(angles).sum(), LINK * np.sin(angles).sum(), angles[-1]])


START, GOAL = np.array([-0.9, 0.3, 0.3, 0.3]), np.array([0.9, -0.3, -0.3, -0.3])


def test_goals_may_be_poses_and_regions(robot: mg.Robot, arm: mg.robot.JointGroup, world: mg.World) -> None:
    wanted = mg.pose([0.6, 0.8, 0], rpy=[0, 0, 1.2])
    found = mg.plan_motion(robot, arm, world, start=START, tool_poses=wanted)
    assert found.outcome == mg.Outcome.solved
    np.testing.assert_allclose(tip(found.path[-1])[:2], [0.6, 0.8], atol=1e-4)
    region = mg.planning.ToolRegion(wanted, position=[0.1, 0.1, 0], rotation=[0, 0, 0.3])
    found = mg.plan_motion(robot, arm, world, start=START, goal=[[2.8, 2.8, 2.8, 9]], regions=[region])
    assert found.goal_index == 1
    assert np.hypot(*(tip(found.path[-1])[:2] - [0.6, 0.8])) <= 0.1 * 2**0.5 + 1e-4
    with pytest.raises(mg.InvalidInput, match="give goal, tool_poses or regions"):
        mg.plan_motion(robot, arm, world, start=START)


def test_a_cone_holds_and_better_paths_are_reported(robot: mg.Robot, arm: mg.robot.JointGroup, world: mg.World) -> None:
    cone = mg.planning.OrientationConstraint(tool_axis=[1, 0, 0], world_axis=[1, 0, 0], half_angle=0.3)
    found = mg.plan_motion(robot, arm, world, start=START, goal=GOAL, orientation_constraint=cone)
    for a, b in zip(found.path[:-1], found.path[1:], strict=True):
        for s in np.linspace(0, 1, 20):
            assert abs((a + s * (b - a)).sum()) <= 0.3 + 1e-9
    costs = []
    found = mg.plan_motion(
        robot,
        arm,
        world,
        start=START,
        goal=GOAL,
        planner="rrt_star",
        max_iterations=1500,
        time_limit=100,
        on_solution=lambda better: costs.append(
            (better.cost, np.linalg.norm(np.diff(better.path, axis=0), axis=1).sum(), better.stage, better.grasp)
        ),
    )
    assert len(costs) >= 2
    assert all(b[0] < a[0] for a, b in itertools.pairwise(costs))
    assert all(cost == pytest.approx(length) for cost, length, *_ in costs)
    assert {(stage, grasp) for *_, stage, grasp in costs} == {("search", -1)}
    assert costs[-1][0] <= found.cost + 1e-9

    def fail(better: mg.planning.Improvement) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        mg.plan_motion(robot, arm, world, start=START, goal=GOAL, on_solution=fail)
    with pytest.raises(mg.InvalidInput, match=r"on_solution = .*must take one argument, an Improvement"):
        mg.plan_motion(robot, arm, world, start=START, goal=GOAL, on_solution=cast(Any, lambda path, cost: None))


def test_lines_from_pose_to_pose() -> None:
    scene = mg.World()
    robot = mg.Robot.from_strings(URDF, SRDF)
    arm = robot.group(base_link="l0", tip="tip")
    checker = mg.CollisionChecker(robot, scene, group=arm)
    q = np.array([-0.9, 0.9, 0.9, 0.3])
    first = arm.fk(q)
    second = mg.pose([0.1, 0.1, 0]) @ first
    found = mg.plan_cartesian(checker, [first, second], near=q, max_branches=3)
    assert found.outcome == mg.Outcome.solved
    assert found.corners == [0, len(found.path) - 1]
    a, b = first[:2, 3], second[:2, 3]
    for p in found.path:
        off = tip(p)[:2] - a
        assert abs(off[0] * (b - a)[1] - off[1] * (b - a)[0]) / np.linalg.norm(b - a) < 1e-4
    assert json.dumps(found.to_dict())


def test_jerk_limits() -> None:
    distance, v, a, j = 3.0, 1.0, 2.0, 20.0
    motion = mg.time_parameterize([[0.0], [distance]], [v], [a], jerk_limits=[j], sample_period=0.005)
    assert motion.duration == pytest.approx(distance / v + v / a + a / j, rel=5e-3)
    change = np.abs(np.diff(motion.accelerations, axis=0)) / np.diff(motion.times)[:, None]
    assert change.max() <= j * (1 + 1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("robot_name", ["panda", "ur5"])
def test_motion_bench_maker_is_solved_and_verified(
    robot_name: str, data: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    command = ["bench", "mbm", "--data", str(data), "--robot", robot_name, "--set", "table_pick", "box"]
    assert main([*command, "--limit", "2", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["holds"]
    assert [row["solved"] for row in answer["rows"]] == [2, 2]
    assert [row["verified"] for row in answer["rows"]] == [2, 2]
    assert all(row["mean length [rad]"] > 1 for row in answer["rows"])


def test_the_verification_finds_what_is_wrong(data: Path) -> None:
    folder = data / "planning/vamp_panda/problems/box_panda"
    problem = read_motion_problem(folder / "scene0001.yaml", folder / "request0001.yaml")
    panda = mg.Robot.load(data / "robots/panda_vamp/panda/panda.urdf", data / "robots/panda_vamp/panda/panda.srdf")
    _, group = problem.setting(panda)
    straight = np.array([problem.start_of(group), problem.goal_of(group)])
    assert "touches" in verify_motion(problem, panda, straight)
    assert "goal" in verify_motion(problem, panda, straight[[0, 0]])


def test_the_bench_refuses_what_is_not_there(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "mbm", "--data", str(tmp_path)]) == 2
    assert "--data" in capsys.readouterr().err
    assert main(["bench", "mbm", "--set", "kitchen"]) == 2
    assert "bookshelf_small" in capsys.readouterr().err
    for option in ("--limit", "--seeds"):
        with pytest.raises(SystemExit) as refused:
            main(["bench", "mbm", "--data", str(tmp_path), option, "0"])
        assert refused.value.code == 2
        reported = capsys.readouterr().err
        assert option in reported and "at least 1" in reported


def test_a_start_beyond_limits_is_told_by_joint_value_and_limits(
    robot: mg.Robot, arm: mg.robot.JointGroup, world: mg.World
) -> None:
    found = mg.plan_motion(robot, arm, world, start=[0, 0, 3.25, 0], goal=GOAL)
    assert found.outcome == mg.Outcome.invalid_start
    assert found.rejections.limits == 1
    for word in ("j3", "3.25", "[-2.8, 2.8]"):
        assert word in found.beyond_limits and word in repr(found)
    assert found.to_dict()["beyond_limits"] == found.beyond_limits
    found = mg.plan_motion(robot, arm, world, start=START, goal=[0, -2.9, 0, 0])
    assert found.outcome == mg.Outcome.invalid_goal
    assert found.rejections.limits == 1
    for word in ("j2", "-2.9", "[-2.8, 2.8]"):
        assert word in found.beyond_limits
    assert mg.plan_motion(robot, arm, world, start=START, goal=GOAL).beyond_limits == ""


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"world": None}, ["world = None", "a World"]),
        ({"robot": "planar"}, ["robot = 'planar'", "a Robot"]),
        ({"group": 3}, ["group = 3", "a JointGroup"]),
        ({"orientation_constraint": "up"}, ["orientation_constraint = 'up'", "a OrientationConstraint"]),
        ({"regions": 7}, ["regions = 7", "ToolRegion"]),
        ({"tool_poses": [np.eye(4), 2 * np.eye(4)]}, ["tool_poses[1]"]),
        ({"progress": "yes"}, ["progress = 'yes'", "a function, or None"]),
        ({"on_solution": 3}, ["on_solution = 3", "a function, or None"]),
        ({"goal": None}, ["goal = None: give goal, tool_poses or regions"]),
        ({"world": "x" * 100_000}, ["world = 'xxx", "xxx...: must be a World"]),
    ],
)
def test_bad_arguments_are_refused_by_name(
    robot: mg.Robot, arm: mg.robot.JointGroup, world: mg.World, changes: dict[str, Any], words: list[str]
) -> None:
    given = {"robot": robot, "group": arm, "world": world, "start": START, "goal": GOAL, **changes}
    with pytest.raises(mg.InvalidInput) as refused:
        mg.plan_motion(**given)
    for word in words:
        assert word in str(refused.value)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"checker": 3}, ["checker = 3", "a CollisionChecker"]),
        ({"checker": None}, ["checker = None", "a CollisionChecker"]),
        ({"checker": mg.World()}, ["checker = ", "a CollisionChecker"]),
    ],
)
def test_a_wrong_checker_is_refused_by_name(changes: dict[str, Any], words: list[str]) -> None:
    calls: list[Callable[[Any], Any]] = [
        lambda checker: mg.planning.plan_straight_line(checker, START, np.eye(4)),
        lambda checker: mg.plan_cartesian(checker, [np.eye(4)] * 2),
        lambda checker: mg.planning.time_parameterize_free(checker, [START, GOAL]),
    ]
    for call in calls:
        with pytest.raises(mg.InvalidInput) as refused:
            call(changes["checker"])
        for word in words:
            assert word in str(refused.value)


def test_wrong_timing_arguments_are_refused_by_name(robot: mg.Robot, arm: mg.robot.JointGroup, world: mg.World) -> None:
    checker = mg.CollisionChecker(robot, world, arm)
    word: Any = "fine"
    five: Any = 5
    refusals: list[tuple[Callable[[], Any], list[str]]] = [
        (
            lambda: mg.planning.time_parameterize_free(checker, [START, GOAL], joint_step=word),
            ["joint_step = 'fine'", "number"],
        ),
        (
            lambda: mg.planning.time_parameterize_free(checker, [START, GOAL], joint_step=0),
            ["joint_step = 0", "must be in [1e-09, 1e+06] rad or m"],
        ),
        (lambda: mg.time_parameterize([START, GOAL], [1] * 4, [1] * 4, names=five), ["names = 5", "names of joints"]),
        (
            lambda: mg.time_parameterize([START, GOAL], [1] * 4, [1] * 4, sample_period=1e-13),
            ["sample_period = 1e-13", "must be in [1e-09"],
        ),
        (lambda: mg.time_parameterize([[0], [2]], [1], [1], sample_period=1e-7), ["sample_period = 1e-07", "takes 3"]),
    ]
    for call, words in refusals:
        with pytest.raises(mg.InvalidInput) as refused:
            call()
        for word in words:
            assert word in str(refused.value)


def test_a_tool_line_from_a_start_that_is_not_allowed_says_why(robot: mg.Robot, arm: mg.robot.JointGroup) -> None:
    q = np.array([-0.9, 0.9, 0.9, 0.3])
    first, scene = arm.fk(q), mg.World()
    scene.add_box("crate", [0.05, 0.05, 0.05], first)
    checker = mg.CollisionChecker(robot, scene, arm)
    second = mg.pose([0.1, 0.1, 0]) @ first
    for found in (
        mg.plan_cartesian(checker, [first, second], near=q),
        mg.planning.plan_straight_line(checker, q, second),
    ):
        assert found.outcome == mg.Outcome.invalid_start
        assert found.cause == mg.planning.Rejection.scene
        assert found.contact is not None and found.contact.b == "crate"
        assert "touches 'crate'" in repr(found)
        assert found.to_dict()["contact"]["b"] == "crate"
    checker = mg.CollisionChecker(robot, mg.World(), arm)
    found = mg.planning.plan_straight_line(checker, [0, 0, 3.25, 0], second)
    assert found.outcome == mg.Outcome.invalid_start
    for word in ("j3", "3.25", "[-2.8, 2.8]"):
        assert word in found.beyond_limits and word in repr(found)
    assert found.to_dict()["beyond_limits"] == found.beyond_limits


def test_a_group_of_another_robot_is_told_by_what_differs(robot: mg.Robot, world: mg.World) -> None:
    def other(urdf: str = URDF, srdf: str = SRDF, **options: Any) -> mg.Robot:
        return mg.Robot.from_strings(urdf, srdf, **options)

    for another, words in [
        (other(URDF.replace("j3", "elbow")), "'elbow', not 'j3'"),
        (other(URDF.replace("upper='2.8'", "upper='2.7'")), "'j1' has other limits"),
        (other(URDF.replace(f"xyz='{LINK} 0 0'", "xyz='0.5 0 0'")), "'j2' has another type, origin or axis"),
        (other(srdf="<robot name='planar'/>"), "pairs of its links"),
        (other(base="omni"), "base is omni, not fixed"),
        (other(URDF.replace(f"size='{LINK} 0.04 0.04'", "size='0.1 0.1 0.1'")), "shapes"),
    ]:
        group = another.group(base_link="l0", tip="tip")
        with pytest.raises(mg.InvalidInput, match="another robot") as refused:
            mg.plan_motion(robot, group, world, start=START, goal=GOAL)
        assert words in str(refused.value)
        with pytest.raises(mg.InvalidInput, match="another robot"):
            mg.CollisionChecker(robot, world, group)


def test_a_diff_drive_base_is_not_moved_sideways() -> None:
    folder = ASSETS / "robots" / "fetchlike"
    robot = mg.Robot.load(folder / "fetchlike.urdf", folder / "fetchlike.srdf", base="diff_drive")
    group = robot.group("arm", with_base=True)
    checker = mg.CollisionChecker(robot, mg.World(), group)
    q = np.zeros(len(group.names))
    aside = mg.pose([0, 0.2, 0]) @ group.fk(q)
    box = mg.LinkShape(mg.Box([0.02, 0.02, 0.02]))
    calls: dict[str, Callable[[], Any]] = {
        "plan_straight_line": lambda: mg.planning.plan_straight_line(checker, q, aside),
        "plan_cartesian": lambda: mg.plan_cartesian(checker, [group.fk(q), aside], near=q),
        "plan_manipulation": lambda: mg.ManipulationProblem(
            group, mg.World(), box, group.fk(q), aside, [mg.Grasp(np.eye(4))]
        ),
    }
    for name, call in calls.items():
        with pytest.raises(mg.InvalidInput, match="diff_drive") as refused:
            call()
        assert name in str(refused.value) and "group = " in str(refused.value)


def test_keywords_of_earlier_versions_say_what_they_are_called_now(arm: mg.robot.JointGroup) -> None:
    q = np.zeros(len(arm.names))
    with pytest.raises(mg.InvalidInput, match="attached_only now"):
        mg.CollisionChecker(arm.robot, mg.World(), arm, held_only=True)  # type: ignore[call-arg]
    with pytest.raises(mg.InvalidInput, match="orientation_constraint now"):
        mg.plan_motion(arm.robot, arm, mg.World(), start=q, goal=q + 0.1, tool_cone=1)  # type: ignore[call-arg]
