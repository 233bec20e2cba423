"""Inverse kinematics and platform locations through the Python door."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import mmgrasp as mg
from conftest import ASSETS

FOLDER = ASSETS / "robots" / "fetchlike"


@pytest.fixture(scope="module")
def robot() -> mg.Robot:
    return mg.Robot.load(FOLDER / "fetchlike.urdf", FOLDER / "fetchlike.srdf", base="diff_drive")


@pytest.fixture(scope="module")
def arm(robot: mg.Robot) -> mg.robot.JointGroup:
    return robot.group("arm_with_torso", tip="gripper_tcp")


TARGET = mg.pose([0.7, 0.2, 0.9], rpy=[0, 0, 0])


def test_objectives_lower_the_cost(arm: mg.robot.JointGroup) -> None:
    objective = mg.robot.joint_limit_objective(arm, soft_fraction=0.4)
    plain = arm.ik(TARGET, rng_seed=1)
    better = arm.ik(TARGET, rng_seed=1, objectives=[objective, mg.robot.singularity_objective(arm, 0.05)])
    assert better.outcome == mg.Outcome.solved
    assert (
        better.objective
        <= objective.evaluate(plain.q)[0] + mg.robot.singularity_objective(arm, 0.05).evaluate(plain.q)[0]
    )
    assert np.abs(arm.fk(better.q) - TARGET).max() < 2e-4
    cost, gradient = objective.evaluate(better.q)
    step = 1e-6 * np.eye(arm.size)
    numeric = [(objective.evaluate(better.q + d)[0] - objective.evaluate(better.q - d)[0]) / 2e-6 for d in step]
    assert cost >= 0
    assert np.allclose(gradient, numeric, atol=1e-6)


def test_objectives_and_weights_are_checked(arm: mg.robot.JointGroup) -> None:
    with pytest.raises(mg.InvalidInput, match="objectives"):
        arm.ik(TARGET, objectives=[1])  # type: ignore[list-item]
    with pytest.raises(mg.InvalidInput, match="joint_weights length"):
        arm.ik(TARGET, joint_weights=[1, 2])
    with pytest.raises(mg.InvalidInput, match="joint_weights"):
        arm.ik(TARGET, joint_weights=[0.0] * arm.size)


@pytest.mark.parametrize("group", ["arm", "arm_with_torso"])
def test_ik_all_of_a_redundant_arm_finds_as_many_as_are_asked_for(robot: mg.Robot, group: str) -> None:
    """Seven joints, of which one is sampled, and eight, which random descents search."""
    arm = robot.group(group, tip="gripper_tcp")
    target = arm.fk([0.3, 0.3, 0.2, 1.0, 0.3, 1.0, 0.2]) if group == "arm" else TARGET
    found = arm.ik_all(target, count=40)
    assert found.shape == (40, arm.size)
    assert max(np.abs(arm.fk(q) - target).max() for q in found) < 2e-4
    apart = np.abs(found[:, None] - found[None]).max(axis=2)
    assert apart[~np.eye(40, dtype=bool)].min() > 1e-2


def test_ik_all_is_diverse_and_free(robot: mg.Robot, arm: mg.robot.JointGroup) -> None:
    world = mg.World()
    world.add_box("table", size=(0.6, 1.2, 0.04), pose=mg.pose([0.9, 0, 0.7]))
    found = arm.ik_all(TARGET, count=6, world=world)
    assert 2 <= len(found) <= 6
    checker = mg.CollisionChecker(robot, world, group=arm)
    for q in found:
        assert checker.is_free(q)
        assert np.abs(arm.fk(q) - TARGET).max() < 2e-4
    branches = arm.ik_branches(TARGET, world=world)
    assert len(branches) == len(branches.solutions) > 0
    assert branches.to_dict()["complete"] is False  # eight joints: searched
    with pytest.raises(mg.InvalidInput, match="count"):
        arm.ik_all(TARGET, count=0)


def test_all_turns_are_listed_on_request(tmp_path: Path) -> None:
    urdf = "<robot name='turns'><link name='l0'/>"
    for i in (1, 2):
        urdf += (
            f"<link name='l{i}'/><joint name='j{i}' type='revolute'><parent link='l{i - 1}'/><child link='l{i}'/>"
            "<origin xyz='0.4 0 0'/><axis xyz='0 0 1'/><limit lower='-3.5' upper='3.5' velocity='1' effort='1'/></joint>"
        )
    (tmp_path / "turns.urdf").write_text(urdf + "</robot>")
    arm = mg.Robot.load(tmp_path / "turns.urdf").group(base_link="l0", tip="l2")
    pose = arm.fk([3.0, 0.5])
    one = arm.ik_all(pose)
    both = arm.ik_all(pose, all_turns=True)
    assert one.shape == (1, 2)
    assert sorted(both[:, 0]) == pytest.approx([3.0 - 2 * np.pi, 3.0], abs=1e-4)
    assert len(arm.ik_branches(pose, all_turns=True)) == 2


def test_platform_locations(robot: mg.Robot, tmp_path: Path) -> None:
    whole = robot.group("arm_with_torso", tip="gripper_tcp", with_base=True)
    checker = mg.CollisionChecker(robot, mg.World(), group=whole)
    database = mg.base.IkSeedDatabase(whole)
    down = [0, np.pi / 2, 0]
    pick, place = mg.pose([0.8, -0.2, 0.9], rpy=down), mg.pose([0.8, 0.2, 0.9], rpy=down)
    found = mg.base.plan_platform_locations(checker, pick, place, database=database, samples=10)
    assert found.outcome == mg.Outcome.solved
    assert np.abs(whole.fk(found.q_pick) - pick).max() < 2e-4
    assert np.abs(whole.fk(found.q_place) - place).max() < 2e-4
    assert found.cost == 0
    assert found.to_dict()["pick"]["draws"] > 0
    assert len(database) > 0
    database.save(tmp_path / "seeds.txt")
    back = mg.base.IkSeedDatabase.load(tmp_path / "seeds.txt", whole)
    assert np.array_equal(back.seeds(pick, 3), database.seeds(pick, 3))
    (tmp_path / "seeds.txt").write_text("nonsense")
    with pytest.raises(mg.IoError, match="seeds"):
        mg.base.IkSeedDatabase.load(tmp_path / "seeds.txt", whole)
    with pytest.raises(mg.InvalidInput, match="samples"):
        mg.base.plan_platform_locations(checker, pick, place, sample=3)  # type: ignore[call-arg]
