"""Allowed collisions and padding: at the Python door, in scenarios, in verify, and in MoveIt scenes read and written."""

from __future__ import annotations

import copy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import mmgrasp as mg
from mmgrasp.cli import main
from mmgrasp.problems.motion_bench import read_motion_problem
from mmgrasp.problems.motion_bench_run import verify_motion
from mmgrasp.problems.planning_scene import write_planning_scene
from test_manipulation import ARM, problem
from test_motion import GOAL, SRDF, START, URDF


@pytest.fixture(scope="module")
def panda(data: Path) -> mg.Robot:
    folder = data / "robots/panda_vamp/panda"
    return mg.Robot.load(folder / "panda.urdf", folder / "panda.srdf")


def on_table(top: float = 0.0) -> mg.World:
    world = mg.World()
    world.add_box("table", (2, 2, 0.1), mg.pose([0, 0, top - 0.05]))
    world.add_box("wall", (0.1, 0.4, 0.6), mg.pose([0.5, 0.0, 0.3]))
    return world


def test_a_panda_stands_on_its_table(panda: mg.Robot) -> None:
    """The acceptance: the table's top is at z = 0, where the robot stands."""
    arm = panda.group("panda_arm")
    start = arm.q(dict(zip(arm.names, [-1.2, -0.3, 0, -2.2, 0, 2.0, 0.8], strict=True)))
    goal = arm.q({arm.names[0]: 1.2}, base=start)
    world = on_table()
    refused = mg.plan_motion(panda, arm, world, start=start, goal=goal)
    assert refused.outcome == mg.Outcome.invalid_start
    assert {(c.a, c.b) for c in refused.contacts} == {("panda_link0", "table")}
    world.allow("table", "panda_link0")
    assert world.allowed == [("panda_link0", "table")]
    found = mg.plan_motion(panda, arm, world, start=start, goal=goal)
    assert found.outcome == mg.Outcome.solved
    # The judge of its own agrees, and sees the table when it is not given it.
    bodies = [mg.verify.CheckedBody(n, world.shapes_of(n), world.pose_of(n)) for n in world.objects]

    def check(pairs: list[tuple[str, str]]) -> mg.verify.PathCheckResult:
        return mg.verify.check_path(panda, arm.names, found.path, bodies, allowed_collisions=pairs)

    assert check(world.allowed).free, check(world.allowed).where
    assert "'panda_link0' touches 'table'" in check([]).where
    with pytest.raises(mg.InvalidInput, match="'tabel'"):
        check([("tabel", "panda_link0")])
    world.disallow("panda_link0", "table")
    assert world.allowed == []
    with pytest.raises(mg.InvalidInput, match="not among the world's allowed ones"):
        world.disallow("panda_link0", "table")


def test_unknown_names_are_refused_with_the_nearest(panda: mg.Robot) -> None:
    arm, world = panda.group("panda_arm"), on_table()
    world.allow("panda_link00", "table")
    with pytest.raises(mg.InvalidInput, match=r"'panda_link00'.*did you mean \"panda_link0\""):
        mg.CollisionChecker(panda, world, group=arm)
    world.forget("panda_link00")
    world.allow("panda_link0", "box")  # comes later
    with pytest.raises(mg.InvalidInput, match="'box'"):
        mg.plan_motion(panda, arm, world, start=arm.q({}), goal=arm.q({}))
    world.add_box("box", (0.1, 0.1, 0.1), mg.pose([3, 0, 0]))
    assert isinstance(mg.CollisionChecker(panda, world, group=arm), mg.CollisionChecker)
    assert world.copy().allowed == world.allowed


def test_padding_is_the_reason() -> None:
    robot = mg.Robot.from_strings(URDF, SRDF)
    arm, world = robot.group(base_link="l0", tip="tip"), mg.World()
    world.add_box("wall", (0.7, 0.1, 0.2), mg.pose([1.2, 0, 0]))
    world.add_box("beside", (0.1, 0.1, 0.1), mg.pose([0.2, 0.09, 0]) @ mg.pose([0, 0, 0]))
    start = np.array([-0.1, -0.8, 0.3, 0.3])
    assert mg.plan_motion(robot, arm, world, start=start, goal=START).outcome == mg.Outcome.solved
    padding: Any
    for padding in (0.1, {"links": 0.1}, {"by_name": {"l1": 0.1}}, {"objects": 0.1}, {"by_name": {"beside": 0.1}}):
        found = mg.plan_motion(robot, arm, world, start=start, goal=START, padding=padding)
        assert found.outcome == mg.Outcome.invalid_start
        assert found.contacts[0].by_padding
        assert "'l1' comes closer to 'beside' than their padding" in repr(found)
    for padding in (0, {"attached": 0.5}, {"links": 0.1, "by_name": {"l1": 0, "l2": 0, "l3": 0, "l4": 0}}):
        found = mg.plan_motion(robot, arm, world, start=start, goal=START, padding=padding)
        assert found.outcome == mg.Outcome.solved, found
    world.padding = {"links": 0.1}
    assert world.padding == {"links": 0.1, "attached": 0, "objects": 0, "by_name": {}}
    assert mg.plan_motion(robot, arm, world, start=start, goal=START).outcome == mg.Outcome.invalid_start
    assert mg.plan_motion(robot, arm, world, start=start, goal=START, padding=0).outcome == mg.Outcome.solved
    for padding, message in (
        (-0.1, "padding.links = -0.1"),
        ({"link": 0.1}, r"padding\['link'\]: unknown key.*links"),
        ({"by_name": {"l1": "far"}}, "l1"),
        ({"by_name": {"l11": 0.1}}, 'did you mean "l1"'),
        ("thick", "padding"),
    ):
        with pytest.raises(mg.InvalidInput, match=message):
            mg.plan_motion(robot, arm, world, start=start, goal=START, padding=padding)


def test_paths_keep_the_padding() -> None:
    robot = mg.Robot.from_strings(URDF, SRDF)
    arm, world = robot.group(base_link="l0", tip="tip"), mg.World()
    world.add_sphere("ball", 0.05, mg.pose([1.35, 0, 0]))
    bare = mg.CollisionChecker(robot, world, group=arm)
    nearest = {}
    for padding in (0.0, 0.05):
        found = mg.plan_motion(robot, arm, world, start=START, goal=GOAL, padding=padding)
        assert found.outcome == mg.Outcome.solved
        steps = np.concatenate([np.linspace(a, b, 60) for a, b in zip(found.path, found.path[1:], strict=False)])
        nearest[padding] = min(bare.distance(q).value for q in steps)
    assert 0 < nearest[0.0] < 0.05
    assert nearest[0.05] > 0.0499


def test_held_objects_are_padded_and_allowed() -> None:
    free = mg.plan_manipulation(problem(), seed=1)
    assert free.outcome == mg.Outcome.solved
    refused = mg.plan_manipulation(problem(), seed=1, padding={"attached": 0.5})
    assert refused.outcome in (mg.Outcome.invalid_start, mg.Outcome.invalid_goal)
    assert any(c.by_padding for c in refused.contacts)
    # A world in whose way the bar is at its goal: allowed by the name under which it is held.
    world = problem().world.copy()
    T = problem().T_world_goal
    world.add_box("shelf", (0.1, 0.1, 0.1), T @ mg.pose([0, 0, 0.055]))
    blocked = mg.plan_manipulation(problem(world=world), seed=1)
    assert blocked.outcome == mg.Outcome.invalid_goal
    world.allow("object", "shelf")
    for link in ARM.robot.links:
        world.allow(link, "shelf")
    again = mg.plan_manipulation(problem(world=world), seed=1)
    assert again.outcome == mg.Outcome.solved
    assert again.cost == free.cost


def floor_slab(small: dict[str, Any]) -> dict[str, Any]:
    """The small scenario on a floor that the wheels stand in by half a centimetre."""
    scenario = copy.deepcopy(small)
    scenario.setdefault("obstacles", []).append(
        {"name": "slab", "box": [20, 20, 0.02], "pose": {"xyz": [0, 0, -0.005]}}
    )
    return scenario


WHEELS = [["left_wheel_link", "slab"], ["slab", "right_wheel_link"]]


@pytest.mark.slow
def test_a_scenario_on_a_floor(small: dict[str, Any], write: Callable[..., Path], tmp_path: Path, capsys: Any) -> None:
    scenario = floor_slab(small)
    with pytest.raises(mg.InvalidInput, match="wheel_link touches slab"):
        mg.load_scenario(write(scenario))
    scenario["allowed_collisions"] = WHEELS
    path = write(scenario)
    plan = mg.plan_part_supply(path)
    assert plan.outcome == mg.Outcome.solved, plan
    expected = [["left_wheel_link", "slab"], ["right_wheel_link", "slab"]]
    content = plan.to_dict()
    assert content["scenario"]["allowed_collisions"] == expected
    file = plan.save(tmp_path / "plan.json")
    verdict = mg.verify_plan(file, scenario=path, samples=50)
    assert verdict.ok, verdict.faults
    assert verdict.allowed_collisions == [tuple(pair) for pair in expected]
    assert main(["verify", str(file), "--samples", "50"]) == 0
    assert "not checked, since the scenario lets them touch: left_wheel_link and slab" in capsys.readouterr().out
    # Without the pairs in the file, the judge sees the wheels in the floor; a name it does not know is malformed.
    del content["scenario"]["allowed_collisions"]
    codes = {fault.code for fault in mg.verify_plan(content, samples=50).faults}
    assert codes & {"start-collision", "route-collision"}
    content["scenario"]["allowed_collisions"] = [["slab", "wheel"]]
    faults = mg.verify_plan(content, samples=50).faults
    assert [(f.code, f.where) for f in faults] == [("malformed", "allowed_collisions")]
    # The file was written for other pairs.
    scenario["allowed_collisions"] = [*WHEELS, ["gripper", "slab"]]
    changed = mg.verify_plan(file, scenario=write(scenario), samples=50).faults
    assert [f.code for f in changed] == ["scenario-changed"]


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("allowed_collisions", [["left_whel_link", "slab"]], r"scenario.yaml:\d+: allowed_collisions\[0\]\[0\] = 'left_whel_link'.*did you mean left_wheel_link"),
        ("allowed_collisions", [["left_wheel_link"]], r"allowed_collisions\[0\] = .*must be a pair of names"),
        ("allowed_collisions", [["left_wheel_link", "slab"], ["slab", "left_wheel_link"]], r"allowed_collisions\[1\] = .*listed twice"),
        ("allowed_collisions", ["left_wheel_link"], "must be a list"),
        ("allowed_collisions", {"a": "b"}, "must be a list"),
        ("padding", -0.1, r"scenario.yaml:\d+: padding = -0.1: must be >= 0"),
        ("padding", {"link": 0.1}, "unknown key; did you mean links"),
        ("padding", {"by_name": {"gripper_lin": 0.1}}, r"padding.by_name.gripper_lin = 0.1: .*did you mean gripper_link"),
    ],
)  # fmt: skip
def test_bad_keys_are_refused(
    small: dict[str, Any], write: Callable[..., Path], key: str, value: Any, message: str
) -> None:
    scenario = floor_slab(small)
    scenario[key] = value
    with pytest.raises(mg.InvalidInput, match=message):
        mg.load_scenario(write(scenario))


@pytest.mark.slow
def test_a_scenario_with_padding(small: dict[str, Any], write: Callable[..., Path]) -> None:
    scenario = copy.deepcopy(small)
    scenario["padding"] = {"links": 0.005, "by_name": {"gripper": 0}}
    loaded = mg.load_scenario(write(scenario))
    assert loaded.world.padding["links"] == 0.005
    assert loaded.problem().world.padding["by_name"] == {"gripper": 0}
    plan = mg.plan_part_supply(loaded)
    assert plan.outcome == mg.Outcome.solved, plan
    assert plan.to_dict()["scenario"]["padding"]["links"] == 0.005
    # Where the arm moves, all links but the gripper's keep the distance from what stands around.
    checker_of = loaded.setup.arm
    world = loaded.world
    world.padding = 0
    for pick in plan.picks:
        stop = plan.stops[pick.stop].pose
        arm = checker_of.at(mg.pose([stop[0], stop[1], 0], rpy=[0, 0, stop[2]]))
        checker = mg.CollisionChecker(loaded.setup.robot, world, group=arm)
        gripper = set(loaded.setup.robot.group_links["gripper"])
        for motion in pick.motions:
            for q in motion.trajectory.positions:
                near = [d for d in checker.distances(q, 0.004) if d.with_scene and d.a not in gripper]
                assert not near, near


SCENE = """
name: ""
robot_model_name: planar
allowed_collision_matrix:
  entry_names: [l0, l1, l2, l3, l4, beside]
  entry_values:
    - [false, true, true, true, true, false]
    - [true, false, true, true, true, true]
    - [true, true, false, true, true, false]
    - [true, true, true, false, true, false]
    - [true, true, true, true, false, false]
    - [false, true, false, false, false, false]
  default_entry_names: [cloud]
  default_entry_values: [true]
link_padding:
  - {link_name: l2, padding: 0.03}
  - {link_name: l3, padding: 0}
world:
  collision_objects:
    - id: beside
      primitives: [{type: box, dimensions: [0.1, 0.1, 0.1]}]
      primitive_poses: [{position: [0.2, 0.05, 0], orientation: [0, 0, 0, 1]}]
    - id: cloud
      primitives: [{type: sphere, dimensions: [0.05]}]
      primitive_poses: [{position: [0.6, 0.06, 0], orientation: [0, 0, 0, 1]}]
    - id: wall
      primitives: [{type: cylinder, dimensions: [0.2, 0.05]}]
      primitive_poses: [{position: [1.4, 0.4, 0], orientation: [0, 0, 0, 1]}]
"""
REQUEST = """
group_name: arm
start_state: {joint_state: {name: [j1, j2, j3, j4], position: [0, 0, 0, 0]}}
goal_constraints:
  - joint_constraints:
      - {joint_name: j1, position: -0.5}
      - {joint_name: j2, position: -0.5}
      - {joint_name: j3, position: 0}
      - {joint_name: j4, position: 0}
"""


def test_moveit_scenes_are_read_and_written(tmp_path: Path) -> None:
    """Entries of the matrix that name objects count, as MoveIt has it, and so do defaults and link padding."""
    srdf = SRDF.replace("</robot>", "<group name='arm'><chain base_link='l0' tip_link='tip'/></group></robot>")
    robot = mg.Robot.from_strings(URDF, srdf)
    scene, request = tmp_path / "scene0001.yaml", tmp_path / "request0001.yaml"
    scene.write_text(SCENE)
    request.write_text(REQUEST)
    motion = read_motion_problem(scene, request)
    world = motion.world_of(robot)
    assert ("beside", "l1") in world.allowed
    assert {("cloud", f"l{i}") for i in range(5)} <= set(world.allowed)
    assert world.padding["by_name"] == {"l2": 0.03}
    checker = motion.checker(robot)
    q = np.zeros(4)
    assert checker.is_free(q), checker.contacts(q)
    bare = mg.CollisionChecker(robot, motion.world, group=robot.group("arm"))
    assert {(c.a, c.b) for c in bare.contacts(q)} == {("l1", "beside"), ("l2", "cloud")}
    found = mg.plan_motion(checker, start=q, goal=motion.goal_of(robot.group("arm")))
    assert found.outcome == mg.Outcome.solved
    assert verify_motion(motion, robot, found.path) == ""
    # Written and read again it is the same scene.
    world.allow("arm", "wall")
    copy_of = tmp_path / "copy.yaml"
    write_planning_scene(copy_of, robot, world)
    again = read_motion_problem(copy_of, request).world_of(robot)
    arm_pairs = {(f"l{i}", "wall") for i in range(1, 5)} | {("tip", "wall")}
    assert set(again.allowed) == set(world.allowed) - {("arm", "wall")} | arm_pairs
    assert again.padding == world.padding
    assert again.objects == world.objects
    for name in world.objects:
        was, now = (w.pose_of(name) @ w.shapes_of(name)[0].pose for w in (world, again))
        assert np.allclose(was, now)
        assert repr(world.shapes_of(name)) == repr(again.shapes_of(name))
    content = yaml.safe_load(SCENE)
    content["link_padding"][0]["padding"] = -1
    scene.write_text(yaml.safe_dump(content))
    with pytest.raises(mg.InvalidInput, match=r"scene0001.yaml: link_padding of 'l2' = -1.0: must be >= 0"):
        read_motion_problem(scene, request)
    world.padding = {"objects": 0.1}
    with pytest.raises(mg.InvalidInput, match="MoveIt pads links alone"):
        write_planning_scene(copy_of, robot, world)


def test_a_checker_stands_for_robot_group_and_world() -> None:
    robot = mg.Robot.from_strings(URDF, SRDF)
    arm, world = robot.group(base_link="l0", tip="tip"), mg.World()
    world.add_box("wall", (0.7, 0.1, 0.2), mg.pose([1.2, 0, 0]))
    checker = mg.CollisionChecker(robot, world, group=arm)
    found = mg.plan_motion(checker, start=START, goal=GOAL, seed=3)
    assert found.outcome == mg.Outcome.solved
    assert np.array_equal(found.path, mg.plan_motion(robot, arm, world, start=START, goal=GOAL, seed=3).path)
    with pytest.raises(mg.InvalidInput, match="leave those out"):
        mg.plan_motion(checker, arm, world, start=START, goal=GOAL)
    with pytest.raises(mg.InvalidInput, match="leave those out"):
        mg.plan_motion(checker, start=START, goal=GOAL, padding=0.1)
    with pytest.raises(mg.InvalidInput, match="group"):
        mg.plan_motion(robot, start=START, goal=GOAL)
    with pytest.raises(mg.InvalidInput, match="world"):
        mg.plan_motion(robot, arm, start=START, goal=GOAL)


def test_waypoints_to_pass() -> None:
    robot = mg.Robot.from_strings(URDF, SRDF)
    arm, world = robot.group(base_link="l0", tip="tip"), mg.World()
    world.add_box("wall", (0.7, 0.1, 0.2), mg.pose([1.2, 0, 0]))
    via = [[-1.5, 1, 1, 0], [0.5, 2, 1, 1]]
    found = mg.plan_motion(robot, arm, world, start=START, goal=GOAL, via=via)
    assert found.outcome == mg.Outcome.solved
    assert found.via_reached == 2
    rows = [i for q in via for i in np.flatnonzero((found.path == q).all(axis=1))]
    assert len(rows) == 2
    assert rows[0] < rows[1]
    with pytest.raises(mg.InvalidInput, match="via"):
        mg.plan_motion(robot, arm, world, start=START, goal=GOAL, via=[[0, 0]])


def test_configurations_by_name(panda: mg.Robot) -> None:
    arm = panda.group("panda_arm")
    q = arm.q({"panda_joint4": -1.5, "panda_joint1": 0.2})
    assert q[3] == -1.5
    assert q[0] == 0.2
    assert np.array_equal(arm.q({}, base=q), q)
    with pytest.raises(mg.InvalidInput, match='did you mean "panda_joint4"'):
        arm.q({"panda_jiont4": 1})
    states = panda.group_states["panda_arm"]
    name, values = next(iter(states.items()))
    assert dict(zip(arm.names, arm.state(name), strict=True)) == values
    with pytest.raises(mg.InvalidInput, match=f"known are .*{name}"):
        arm.state("no such state")


def test_links_that_lie_flush_and_stay_so_are_left_out(small: dict[str, Any], write: Any) -> None:
    """The closed fingers of a second hand meet; with room between them they are checked."""

    def reasons(closed: float) -> list[str]:
        scenario = copy.deepcopy(small)
        scenario["robot"]["mount"] = [
            {
                "urdf": "asset:grippers/parallel/parallel.urdf",
                "parent_link": "base_link",
                "pose": {"xyz": [-0.1, 0.22, 0.6], "rpy": [0.0, -1.2, 0.0]},
                "prefix": "spare_",
            }
        ]
        scenario["robot"]["joints"] |= {"spare_left_finger_joint": closed}
        robot = mg.load_scenario(write(scenario)).setup.robot
        return [
            reason for a, b, reason in robot.disabled_pairs if {a, b} == {"spare_left_finger", "spare_right_finger"}
        ]

    assert reasons(0.0) == ["default"]
    assert reasons(0.0001) == []
