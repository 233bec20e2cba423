"""The shipped robot before a table, for the tests of physics."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np

import mmgrasp as mg
from mmgrasp import sim
from mmgrasp._files import shipped

TABLE = 0.70
TOOL = 0.78
FINGERS = ("left_gripper_finger", "right_gripper_finger")


@functools.cache
def robot() -> mg.Robot:
    path = shipped("asset:robots/fetchlike/fetchlike.urdf")
    return mg.Robot.load(path, path.with_suffix(".srdf"), base="diff_drive", base_limits={"wheel_separation": 0.37476})


def gripper() -> mg.grasping.Gripper:
    return mg.grasping.Gripper(
        "gripper_tcp",
        approach=[1, 0, 0],
        closing=[0, 1, 0],
        max_opening=0.10,
        finger_depth=0.04,
        finger_width=0.022,
        joints=[mg.grasping.FingerJoint(f"{f}_joint", 0.0, 0.05) for f in FINGERS],
        finger_links=[f"{f}_link" for f in FINGERS],
    )


@functools.cache
def arm() -> mg.robot.JointGroup:
    return robot().group("arm_with_torso", tip="gripper_tcp").with_reference(gripper().joint_values(0.1))


def table() -> mg.World:
    world = mg.World()
    world.add_box("table", [0.6, 1.2, TABLE], mg.pose([0.95, 0, TABLE / 2]))
    return world


def box(x: float = 0.8, y: float = 0.0, **keywords: Any) -> sim.SimPart:
    return sim.SimPart("box", [mg.LinkShape(mg.Box([0.05, 0.05, 0.12]))], mg.pose([x, y, TABLE + 0.0601]), **keywords)


@functools.cache
def approach(x: float = 0.8, length: float = 0.15) -> mg.planning.JointTrajectory:
    """The tool goes straight ahead and stops where the box is."""
    first = arm().ik(mg.pose([x - length, 0, TOOL]), rng_seed=3)
    assert first.outcome == mg.Outcome.solved
    line = [np.asarray(first.q)]
    for share in np.linspace(0.1, 1.0, 10):
        step = arm().ik(mg.pose([x - length * (1 - share), 0, TOOL]), seed=line[-1], restarts=0)
        assert step.outcome == mg.Outcome.solved
        line.append(np.asarray(step.q))
    limits = arm().velocity_limits, arm().acceleration_limits
    return mg.time_parameterize(np.array(line), *limits, names=list(arm().names))
