"""Kinematics at the Python door: shapes, batches, points, manipulability, and what is refused."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from conftest import ASSETS


@pytest.fixture(scope="module")
def arm() -> mg.robot.JointGroup:
    folder = ASSETS / "robots" / "fetchlike"
    robot = mg.Robot.load(folder / "fetchlike.urdf", folder / "fetchlike.srdf", base="diff_drive")
    return robot.group("arm_with_torso", tip="gripper_tcp")


@pytest.fixture(scope="module")
def configurations(arm: mg.robot.JointGroup) -> np.ndarray:
    return np.random.default_rng(5).uniform(arm.sample_lower, arm.sample_upper, (23, len(arm)))


def differences(arm: mg.robot.JointGroup, q: np.ndarray, pose: Callable[..., Any]) -> np.ndarray:
    """Central differences of a pose's position and rotation."""
    columns = []
    for i in range(len(arm)):
        step = np.zeros(len(arm))
        step[i] = 1e-6
        before, after = pose(q - step), pose(q + step)
        turn = (after[:3, :3] - before[:3, :3]) @ pose(q)[:3, :3].T / 2e-6
        columns.append([*(after[:3, 3] - before[:3, 3]) / 2e-6, turn[2, 1], turn[0, 2], turn[1, 0]])
    return np.array(columns).T


def test_batches_equal_single_calls(arm: mg.robot.JointGroup, configurations: np.ndarray) -> None:
    poses, jacobians = arm.fk_batch(configurations), arm.jacobian_batch(configurations)
    values = arm.manipulability_batch(configurations)
    assert poses.shape == (23, 4, 4)
    assert jacobians.shape == (23, 6, len(arm))
    assert values.shape == (23,)
    for q, T, J, value in zip(configurations, poses, jacobians, values, strict=True):
        np.testing.assert_array_equal(T, arm.fk(q))
        np.testing.assert_allclose(J, arm.jacobian(q), atol=1e-12)
        np.testing.assert_allclose(value, arm.manipulability(q), atol=1e-12)
        np.testing.assert_allclose(value, np.prod(np.linalg.svd(J, compute_uv=False)), atol=1e-12)
        np.testing.assert_allclose(arm.link_poses(q)[arm.tip], T, atol=1e-12)
    assert arm.fk_batch(np.zeros((0, len(arm)))).shape == (0, 4, 4)


def test_jacobian_of_any_point(arm: mg.robot.JointGroup, configurations: np.ndarray) -> None:
    point = [0.1, -0.2, 0.3]
    tip = arm.robot.links[-1]
    for q in configurations[:5]:
        np.testing.assert_allclose(arm.jacobian(q), differences(arm, q, arm.fk), atol=1e-8)
        for link in (arm.tip, tip, arm.robot.links[0], *arm.robot.links[5:9]):

            def pose(at: np.ndarray, link: str = link) -> np.ndarray:
                T = arm.link_poses(at)[link].copy()
                T[:3, 3] = (T @ [*point, 1])[:3]
                return np.asarray(T)

            np.testing.assert_allclose(arm.jacobian(q, link=link, point=point), differences(arm, q, pose), atol=1e-8)
        np.testing.assert_allclose(arm.jacobian(q, link=arm.tip), arm.jacobian(q), atol=1e-12)


def test_ellipsoids_along_a_direction(arm: mg.robot.JointGroup, configurations: np.ndarray) -> None:
    z = np.array([0.3, -2.0, 0.6, 0.1, 0.5, -0.4])
    for q in configurations[:5]:
        J = arm.jacobian(q)
        unit = z / np.linalg.norm(z)
        alpha = (unit @ np.linalg.inv(J @ J.T) @ unit) ** -0.5
        beta = (unit @ J @ J.T @ unit) ** -0.5
        assert arm.velocity_manipulability(q, z) == pytest.approx(alpha, rel=1e-7)
        assert arm.force_manipulability(q, direction=z) == pytest.approx(beta, rel=1e-9)
        assert alpha * beta <= 1
        assert arm.velocity_manipulability(q, z[:3]) >= arm.velocity_manipulability(q, [*z[:3], 0, 0, 0])


def test_bad_arguments_are_named(arm: mg.robot.JointGroup, configurations: np.ndarray) -> None:
    q = configurations[0]
    nan = q.copy()
    nan[2] = np.nan
    with pytest.raises(mg.Error, match=r"Q has shape \(2, 3\): must be \(m, 8\)"):
        arm.jacobian_batch(np.zeros((2, 3)))
    with pytest.raises(mg.Error, match=r"q has shape \(3,\): must be \(8,\)"):
        arm.jacobian(np.zeros(3), link=arm.tip)
    with pytest.raises(mg.Error, match="q holds nan at entry 2"):
        arm.velocity_manipulability(nan, [1, 0, 0])
    with pytest.raises(mg.Error, match="point"):
        arm.jacobian(q, point=[1, 2])
    with pytest.raises(mg.Error, match="no such link"):
        arm.jacobian(q, link="gripper_tpc")
    with pytest.raises(mg.Error, match="direction length = 2"):
        arm.force_manipulability(q, [1, 2])
    with pytest.raises(mg.Error, match="must not be zero"):
        arm.velocity_manipulability(q, [0, 0, 0])
    with pytest.raises(mg.Error, match="Q"):
        arm.manipulability_batch([[0] * 7 + [np.inf]])


def test_floating_joints_are_columns() -> None:
    urdf = """<robot name="r"><link name="a"/><link name="b"/>
      <joint name="f" type="floating"><parent link="a"/><child link="b"/></joint></robot>"""
    group = mg.Robot.from_strings(urdf).group(base_link="a", tip="b")
    assert list(group.names) == ["f/x", "f/y", "f/z", "f/rx", "f/ry", "f/rz"]
    T = group.fk([1, 2, 3, 0, 0, np.pi / 2])
    np.testing.assert_allclose(T, mg.pose([1, 2, 3], [0, 0, np.pi / 2]), atol=1e-14)
