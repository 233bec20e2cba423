"""Hands read from the shipped robots against the numbers written in their URDFs; grasps as records."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp.problems.pipe_cells import pipe_robot


def test_a_hand_is_what_its_urdf_says() -> None:
    """Fingers 85 x 12 x 20 mm, 1 mm apart when closed, 30 mm of travel each; tool frame 15 mm before their tips."""
    robot, _, by_hand = pipe_robot("tm14like")
    for group in ("gripper", ""):  # the SRDF's end effector, or every joint that moves beside the tool frame
        hand = mg.Hand.from_robot(robot, "gripper_tcp", group=group, clearance=0.008)
        assert hand.kind == "parallel"
        assert hand.groups == ["fingers"]
        np.testing.assert_array_equal(hand.approach, by_hand.approach)
        np.testing.assert_array_equal(hand.closing, by_hand.closing)
        assert [(j.name, j.closed, j.open) for j in hand.joints] == [(j.name, j.closed, j.open) for j in by_hand.joints]
        assert hand.finger_links == by_hand.finger_links
        assert (hand.min_opening, hand.max_opening) == pytest.approx((0.001, 0.061), abs=1e-9)
        assert hand.openings == []
        assert (hand.finger_depth, hand.finger_width, hand.clearance) == pytest.approx((0.03, 0.02, 0.008), abs=1e-9)
        body = hand.body
        assert (body.finger_thickness, body.finger_length) == pytest.approx((0.012, 0.085), abs=1e-9)
        assert (body.palm_length, body.palm_width) == pytest.approx((0.11, 0.06), abs=1e-9)


@pytest.mark.parametrize("opening", [0.001, 0.02, 0.061])
def test_its_boxes_stand_where_the_fingers_do(opening: float) -> None:
    robot, _, _ = pipe_robot("tm14like")
    hand = mg.Hand.from_robot(robot, "gripper_tcp", group="gripper")
    poses = robot.link_poses(hand.joint_values(opening))
    shapes = hand.shapes(opening)
    for shape, link in zip(shapes, ("right_finger_link", "left_finger_link", "gripper_link"), strict=True):
        (own,) = robot.collisions(link)
        assert isinstance(shape.shape, mg.Box) and isinstance(own.shape, mg.Box)
        expected = np.linalg.inv(poses["gripper_tcp"]) @ poses[link] @ own.pose
        if link != "gripper_link":  # the palm's box is as deep as masks need it, not as the link is
            np.testing.assert_allclose(shape.shape.size, own.shape.size, atol=1e-9)
            np.testing.assert_allclose(shape.pose, expected, atol=1e-9)
        front = [(T @ [s.size[0] / 2, 0, 0, 1])[0] for T, s in ((shape.pose, shape.shape), (expected, own.shape))]
        assert front[0] == pytest.approx(front[1], abs=1e-9)


def test_postures_open_groups() -> None:
    joints = [mg.grasping.HandJoint(f"{finger}{i}", 1.0, 0.2, finger) for finger in "ab" for i in (1, 2)]
    hand = mg.Hand(
        "palm", approach=[0, 0, 1], closing=[1, 0, 0], max_opening=0.12, finger_depth=0.04, finger_width=0.02,
        joints=[*joints, mg.grasping.HandJoint("spread", -0.1, 0.3, "spread")], preshape={"spread": 0.25}, kind="adaptive",
        min_opening=0.02, openings=[0.02, 0.04, 0.12],
    )  # fmt: skip
    assert hand.groups == ["a", "b", "spread"]
    assert hand.share_open(0.08) == pytest.approx(0.75)
    assert hand.opening_at(0.75) == pytest.approx(0.08)
    assert hand.joint_values(0.08) == pytest.approx({"a1": 0.4, "a2": 0.4, "b1": 0.4, "b2": 0.4, "spread": 0.0})
    grasp = mg.Grasp(np.eye(4), 0.08, posture=[0.0, 1.0, 0.5])
    expected = {"a1": 1.0, "a2": 1.0, "b1": 0.2, "b2": 0.2, "spread": 0.1}
    assert hand.joint_values(grasp) == pytest.approx(expected)
    assert hand.posture_values([0.0, 1.0, 0.5]) == pytest.approx(expected)
    with pytest.raises(mg.InvalidInput, match="posture = 2 numbers"):
        hand.posture_values([0.0, 1.0])
    with pytest.raises(mg.InvalidInput, match="must be 'parallel', 'angular' or 'adaptive'"):
        mg.Hand(
            "t", approach=[0, 0, 1], closing=[1, 0, 0], max_opening=0.1, finger_depth=0.1, finger_width=0.1, kind="soft"
        )


CRANE = """<robot name="crane"><link name="base"/><link name="boom"/><link name="tip"/>
<link name="finger"><collision><origin xyz="0.05 0 0"/><geometry><box size="0.1 0.01 0.01"/></geometry></collision></link>
<joint name="turn" type="revolute"><parent link="base"/><child link="boom"/><axis xyz="0 0 1"/>
<limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
<joint name="end" type="fixed"><parent link="boom"/><child link="tip"/><origin xyz="0.5 0 0"/></joint>
<joint name="fold" type="revolute"><parent link="tip"/><child link="finger"/><axis xyz="0 0 1"/>
<limit lower="0" upper="1.5" velocity="1" effort="1"/></joint></robot>"""


def test_planners_set_the_posture_of_a_grasp() -> None:
    """A finger that points ahead meets the wall, folded aside it does not; both grasps have one opening."""
    robot = mg.Robot.from_strings(CRANE)
    arm = robot.group(base_link="base", tip="tip")
    world = mg.World()
    world.add_box("wall", [0.04, 0.3, 0.3], mg.pose([0.6, 0, 0]))
    hand = mg.Hand(
        "tip", approach=[1, 0, 0], closing=[0, 1, 0], max_opening=0.1, finger_depth=0.02, finger_width=0.01,
        joints=[mg.grasping.HandJoint("fold", 0.0, 1.5)], finger_links=["finger"],
    )  # fmt: skip
    grasps = [mg.Grasp(np.eye(4), 0.05, posture=[share]) for share in (0.0, 1.0)]
    bead = mg.LinkShape(mg.Box([0.002, 0.002, 0.002]))
    ends = arm.fk([0.0]), arm.fk([0.4])
    problem = mg.ManipulationProblem(arm, world, bead, *ends, grasps, gripper=hand, touch_links=["finger"])
    found = mg.plan_manipulation(problem, seed=1)
    assert found.outcome == mg.Outcome.solved
    assert found.grasp_index == 1
    with pytest.raises(mg.InvalidInput, match="posture = 2 numbers"):
        mg.ManipulationProblem(arm, world, bead, *ends, [mg.Grasp(np.eye(4), posture=[0, 1])], gripper=hand)


def test_quality_is_the_product_of_its_factors() -> None:
    _, _, gripper = pipe_robot("tm14like")
    grasps = mg.grasping.sample_grasps([mg.LinkShape(mg.Box([0.04, 0.05, 0.08]))], gripper)
    assert grasps
    for grasp in grasps:
        assert set(grasp.quality_factors) == {"alignment", "centring", "support", "insertion", "clearance"}
        factors = [1 - weight + weight * value for value, weight in grasp.quality_factors.values()]
        assert grasp.quality == pytest.approx(np.prod(factors), rel=1e-15)
        assert isinstance(grasp.provenance, mg.grasping.ContactPairProvenance)
        assert grasp.to_dict()["provenance"]["sampler"] == "contact_pairs"
    given = mg.Grasp(np.eye(4), 0.03, cost=1.5, quality=0.25)
    assert given.provenance is None
    assert given.to_dict() == {
        "T_object_hand": np.eye(4).tolist(), "opening": 0.03, "cost": 1.5, "quality": 0.25, "quality_factors": {}, "posture": [],
        "provenance": None,
    }  # fmt: skip


def test_a_push_grasp_takes_its_lengths_from_the_hand() -> None:
    _, _, gripper = pipe_robot("tm14like")
    given: Any = {
        "opening": 0.06,
        "finger_length": 0.12,
        "grip_depth": 0.015,
        "planned_depth": 0.06,
        "clearance": 0.008,
    }
    found = mg.grasping.push_grasp(hand=gripper, object_width=0.03, tool_speed=0.2)
    assert found.to_dict() == mg.grasping.push_grasp(object_width=0.03, tool_speed=0.2, **given).to_dict()
    narrow = mg.grasping.push_grasp(hand=gripper, object_width=0.03, opening=0.05)
    assert narrow.closing_time == pytest.approx(0.2)
