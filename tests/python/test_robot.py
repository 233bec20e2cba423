"""Kinematics against pinocchio's numbers, arguments refused by name, collisions and motions on the shipped robot."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from conftest import ASSETS, DATA

REFERENCE = DATA / "reference" / "transcribed" / "fk_pinocchio.json"
CASES = json.loads(REFERENCE.read_text())["robots"] if REFERENCE.is_file() else {}


@pytest.mark.skipif(not CASES, reason="the shared reference numbers are not there")
@pytest.mark.parametrize("name", sorted(CASES) or ["none"])
def test_kinematics_equal_pinocchio(name: str) -> None:
    entry = CASES[name]
    robot = mg.Robot.load(DATA / "robots" / entry["urdf"], load_meshes=False)
    group = robot.group(base_link=robot.links[0], tip=entry["tip"])
    configurations = np.array([[case["q"][joint] for joint in group.names] for case in entry["cases"]])
    poses = group.fk_batch(configurations)
    columns = [entry["joints"].index(joint) for joint in group.names]
    for q, T, case in zip(configurations, poses, entry["cases"], strict=True):
        np.testing.assert_allclose(T[:3, 3], case["p"], atol=2e-9)
        _, quat = mg.robot.pose_to_xyz_quat(T)
        assert abs(abs(np.dot(quat, case["quat"])) - 1) < 1e-8
        np.testing.assert_array_equal(T, group.fk(q))
        np.testing.assert_allclose(group.jacobian(q), np.array(case["J"])[:, columns], atol=2e-9)


def test_inverse_kinematics_meets_the_pose(arm: mg.robot.JointGroup) -> None:
    rng = np.random.default_rng(3)
    for _ in range(20):
        T = arm.fk(rng.uniform(arm.sample_lower, arm.sample_upper))
        found = arm.ik(T, rng_seed=1)
        assert found.outcome == mg.Outcome.solved
        np.testing.assert_allclose(arm.fk(found.q)[:3, 3], T[:3, 3], atol=1e-5)
        assert arm.within_limits(found.q)
        again = arm.ik(T, rng_seed=1)
        np.testing.assert_array_equal(found.q, again.q)


def test_unreachable_is_a_value(arm: mg.robot.JointGroup) -> None:
    found = arm.ik(mg.pose([9, 0, 0]), restarts=2)
    assert found.outcome != mg.Outcome.solved
    assert found.q is None
    assert found.to_dict()["q"] is None


@pytest.mark.parametrize(
    ("call", "pieces"),
    [
        (lambda a: a.fk([0, 0]), ["q", "(2,)", f"({8},)"]),
        (lambda a: a.fk([np.nan] * 8), ["q", "nan", "finite"]),
        (lambda a: a.fk("abc"), ["q", "str", "numbers"]),
        (lambda a: a.fk(None), ["q", "None"]),
        (lambda a: a.fk_batch(np.zeros((3, 2))), ["Q", "(3, 2)"]),
        (lambda a: a.ik(np.eye(3)), ["T_world_tip", "(3, 3)", "(4, 4)"]),
        (lambda a: a.ik(2 * np.eye(4)), ["T_world_tip"]),
        (lambda a: a.ik(np.eye(4), rng_sed=1), ["rng_sed", "did you mean rng_seed?"]),
        (lambda a: a.ik(np.eye(4), restarts=-1), ["restarts", "-1"]),
        (lambda a: a.ik(np.eye(4), restarts="many"), ["restarts", "many", "whole number"]),
        (lambda a: a.ik(np.eye(4), seed=[1.0]), ["seed", "(1,)"]),
        (lambda a: a.robot.group("arm_with_torsoo"), ["arm_with_torso"]),
        (lambda a: a.robot.group(), ["group"]),
        (lambda a: mg.World().add_box("b", size=(1, 0, 1)), ["0"]),
        (lambda a: mg.World().add_sphere("b", radius=float("nan")), ["nan"]),
        (lambda a: mg.World().add_points("b", np.zeros((4, 2)), 0.1), ["points", "(4, 2)"]),
        (lambda a: mg.World().remove("b"), ["b"]),
        (lambda a: mg.Robot.load("r.urdf", base="wheels"), ["wheels", "diff_drive"]),
        (lambda a: mg.time_parameterize(np.zeros((2, 2)), [1, 1], [1, 0]), ["0"]),
        (lambda a: mg.time_parameterize(np.zeros((2, 2)), [1], [1, 1]), ["velocity_limits"]),
    ],
)
def test_misuse_names_the_argument(arm: mg.robot.JointGroup, call: Any, pieces: list[str]) -> None:
    with pytest.raises(mg.InvalidInput) as raised:
        call(arm)
    assert isinstance(raised.value, ValueError)
    assert isinstance(raised.value, mg.Error)
    for piece in pieces:
        assert piece in str(raised.value)


def test_missing_files_are_os_errors(tmp_path: Path) -> None:
    with pytest.raises(mg.IoError, match=r"nowhere\.urdf"):
        mg.Robot.load(tmp_path / "nowhere.urdf")
    with pytest.raises(OSError, match=r"nowhere\.stl"):
        mg.World().add_mesh("m", tmp_path / "nowhere.stl")
    with pytest.raises(mg.Error, match=r"nowhere\.bt"):
        mg.World().add_octree("m", tmp_path / "nowhere.bt")


def test_checker_and_held_objects(fetch: mg.Robot, arm: mg.robot.JointGroup) -> None:
    q = arm.ik(mg.pose([0.7, 0.0, 1.0]), world=mg.World()).q
    world = mg.World()
    assert mg.CollisionChecker(fetch, world, group=arm).is_free(q)
    world.add_box("wall", size=(0.1, 1, 1), pose=mg.pose([0.7, 0, 1]))
    checker = mg.CollisionChecker(fetch, world, group=arm)
    assert checker.rejection(q) == mg.planning.Rejection.scene
    assert any("wall" in (c.a, c.b) for c in checker.contacts(q))
    assert checker.distance(q).value <= 0
    world.move("wall", mg.pose([3, 0, 1]))
    checker = mg.CollisionChecker(fetch, world, group=arm)
    assert checker.distance(q).value > 0
    T_link_part = mg.pose([0.0, 0, 0])
    world.add_box("long", size=(6, 0.02, 0.02))
    world.attach("long", link="gripper_tcp", pose=T_link_part)
    assert world.attached == ["long"]
    assert not mg.CollisionChecker(fetch, world, group=arm).is_free(q)
    world.detach("long")
    assert "long" not in world


def test_octree_has_every_occupied_leaf(data: Path) -> None:
    world = mg.World()
    world.add_octree("map", data / "clouds" / "octomap" / "geb079.bt")
    shapes = [s.shape for s in world.shapes_of("map") if isinstance(s.shape, mg.collision.Voxels)]
    assert len(shapes) == len(world.shapes_of("map"))
    expected = json.loads((data / "reference" / "transcribed" / "octomap_counts.json").read_text())["geb079.bt"]
    assert sum(len(s.centres) for s in shapes) == expected["occupied_leaves"]
    low = np.min([(s.centres - s.resolution / 2).min(axis=0) for s in shapes], axis=0)
    high = np.max([(s.centres + s.resolution / 2).max(axis=0) for s in shapes], axis=0)
    np.testing.assert_allclose([low, high], expected["occupied_bbox"], atol=1e-6)


def test_points_become_the_cells_that_hold_one() -> None:
    world = mg.World()
    world.add_points("scan", [[0.01, 0.02, 0.03], [0.09, 0.05, 0.01], [-0.01, 0, 0]], resolution=0.1)
    cells = world.shapes_of("scan")[0].shape
    assert isinstance(cells, mg.collision.Voxels)
    np.testing.assert_allclose(sorted(cells.centres.tolist()), [[-0.05, 0.05, 0.05], [0.05, 0.05, 0.05]])


def test_motion_is_free_and_repeats(fetch: mg.Robot, arm: mg.robot.JointGroup) -> None:
    world = mg.World()
    world.add_box("post", size=(0.08, 0.08, 1.6), pose=mg.pose([0.75, 0, 0.8]))
    start = arm.ik(mg.pose([0.6, 0.4, 0.9]), world=world).q
    goal = arm.ik(mg.pose([0.6, -0.4, 0.9]), seed=start, world=world).q
    first = mg.plan_motion(fetch, arm, world, start=start, goal=goal, planner="rrt_connect", seed=1, time_limit=5.0)
    assert first.outcome == mg.Outcome.solved
    checker = mg.CollisionChecker(fetch, world, group=arm)
    for a, b in zip(first.path[:-1], first.path[1:], strict=True):
        assert checker.edge_is_free(a, b, 0.005)
    np.testing.assert_array_equal(first.path[0], start)
    np.testing.assert_allclose(
        np.exp(1j * first.path[-1]), np.exp(1j * goal), atol=1e-9
    )  # continuous joints may wind back
    length = sum(np.linalg.norm(b - a) for a, b in zip(first.path[:-1], first.path[1:], strict=True))
    assert first.cost == pytest.approx(length)
    again = mg.plan_motion(fetch, arm, world, start=start, goal=goal, seed=1)
    np.testing.assert_array_equal(first.path, again.path)

    timed = mg.time_parameterize(first.path, arm.velocity_limits, arm.acceleration_limits, names=arm.names)
    assert (np.abs(timed.velocities) <= arm.velocity_limits * (1 + 1e-6)).all()
    assert (np.abs(timed.accelerations) <= arm.acceleration_limits * (1 + 1e-6)).all()
    np.testing.assert_allclose(timed.at(timed.duration), first.path[-1], atol=1e-9)
    rows = timed.to_csv(base_pose=[1, 2, 0.5]).splitlines()
    assert rows[0].startswith("time,base.x,base.y,base.theta,")
    assert len(rows) == len(timed) + 1
    message = timed.to_joint_trajectory(base_pose=[1, 2, 0.5])
    assert message["joint_names"] == arm.names
    last = message["points"][-1]["time_from_start"]
    assert last["sec"] + last["nanosec"] * 1e-9 == pytest.approx(timed.duration, abs=1e-9)


def test_unknown_planner_lists_the_known(fetch: mg.Robot, arm: mg.robot.JointGroup) -> None:
    q = arm.ik(mg.pose([0.6, 0.4, 0.9]), world=mg.World()).q
    with pytest.raises(mg.InvalidInput, match="rrt_connect"):
        mg.plan_motion(fetch, arm, mg.World(), start=q, goal=q, planner="rrt_conect")


def test_database_answers_after_a_round_trip(arm: mg.robot.JointGroup, tmp_path: Path) -> None:
    db = mg.ReachDatabase.build(arm, samples=20_000, seed=1)
    db.save(tmp_path / "arm.reach")
    again = mg.ReachDatabase.load(tmp_path / "arm.reach")
    assert len(again) == len(db) > 0
    T = arm.fk(np.array([0.1, 0.3, 0.2, 0.1, 0.9, 0.0, 0.4, 0.0]))
    np.testing.assert_array_equal(db.nearest(T, 4), again.nearest(T, 4))
    assert again.path == str(tmp_path / "arm.reach")
    again.verify()
    configurations = tmp_path / "arm.reach" / "configurations.npy"
    configurations.write_bytes(configurations.read_bytes()[:-1])
    with pytest.raises(mg.IoError, match=r"configurations\.npy: truncated"):
        mg.ReachDatabase.load(tmp_path / "arm.reach")


def test_mounting_writes_one_robot(fetch: mg.Robot, arm: mg.robot.JointGroup) -> None:
    omni = ASSETS / "robots" / "omni6"
    other = mg.Robot.load(omni / "omni6.urdf", omni / "omni6.srdf")
    both = fetch.mount(other, "torso_lift_link", mg.pose([0, 0, 1]), "second_")
    again = mg.Robot.from_strings(both.to_urdf(), both.to_srdf(), base="diff_drive")
    assert set(again.links) == set(both.links)
    assert len(both.links) == len(fetch.links) + len(other.links)
    T = both.link_poses({"torso_lift_joint": 0.2})
    T_again = again.link_poses({"torso_lift_joint": 0.2})
    for link in both.links:
        np.testing.assert_allclose(T[link], T_again[link], atol=1e-12)


def test_exact_small_programmes() -> None:
    cover = mg.optim.solve_set_cover(4, [[0, 1], [1, 2], [2, 3], [0, 3], [1, 2, 3]])
    assert cover.outcome == mg.Outcome.solved
    assert cover.cost == 2
    lengths = np.abs(np.subtract.outer([1.0, 3, 2, 0, 4], [1.0, 3, 2, 0, 4]))
    tour = mg.optim.shortest_visiting_tour(lengths)
    assert tour.order == [0, 2, 1]
    assert tour.length == pytest.approx(4)
    grid = mg.base.BaseGrid([0, 0], 0.1, 8, 6)
    _, radius = mg.base.inscribed_circle(grid, np.ones((1, 6, 8), dtype=np.uint8))
    assert radius == pytest.approx(0.3, abs=1e-5)


def test_results_read_well(arm: mg.robot.JointGroup) -> None:
    assert "gripper_tcp" in repr(arm)
