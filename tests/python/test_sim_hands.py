"""Hands in physics: what a fingertip presses with, and how a held part creeps where the hand swings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pytest

import mmgrasp as mg
from conftest import ASSETS
from mmgrasp import sim
from mmgrasp.grasping import HandJoint, eigengrasp_hand
from mmgrasp.sim.finger_drives import finger_drives, finger_sides

pytest.importorskip("mujoco", reason="MuJoCo is not installed (pip install 'mmgrasp[sim]')")

FINGERS = ["finger_1_proximal", "finger_1_distal", "finger_2_proximal", "finger_2_distal"]
SPREAD = float(np.pi / 2)
LOWER = 0.0865  # of a finger's lower link [m]


@dataclass
class Follow:
    """Joints after functions of time, for so long."""

    joints: Sequence[str]
    rows: Sequence[object]
    seconds: float
    period: float

    def command(self, time: float, scene: sim.SceneState) -> sim.Command:
        return sim.Command([float(row(time)) for row in self.rows])  # type: ignore[operator]

    def finished(self, time: float, scene: sim.SceneState) -> bool:
        return time >= self.seconds


def three_fingers() -> mg.Robot:
    return mg.Robot.load(ASSETS / "grippers" / "sdhlike" / "sdhlike.urdf")


def pinching(robot: mg.Robot) -> mg.Hand:
    """Two fingers opposite each other whose tips stay upright."""
    groups = [("fingers", FINGERS), ("thumb", ["thumb_proximal", "thumb_distal"]), ("spread", ["spread"])]
    still = [-SPREAD, 0.0, SPREAD]
    return eigengrasp_hand(
        robot,
        "tcp_pinch",
        groups,
        open=[-0.4363, 0.4363, -0.4363, 0.4363, *still],
        closed=[0.2094, -0.2094, 0.2094, -0.2094, *still],
    )


@pytest.mark.parametrize("force", [15.0, 40.0])
def test_turning_fingers_press_with_the_grip_force(force: float) -> None:
    """On a block that stands still: torques by the way of the tips, whichever joints share it. One drive moves both, so their sum is told."""
    robot = three_fingers()
    hand = pinching(robot)
    world = mg.World()
    T_tool = robot.link_poses()["tcp_pinch"]
    world.add_box("block", [0.05, 0.03, 0.05], T_tool)
    scene = sim.SimScene(robot, world, gripper=hand, physics=sim.Physics(grip_force=force))
    opened, closed = hand.joint_values(hand.max_opening), hand.joint_values(0.0)
    scene.reset(np.zeros(3), opened)
    names = list(opened)
    rows = [lambda t, n=n: opened[n] + min(1.0, 2 * t) * (closed[n] - opened[n]) for n in names]
    scene.drive(Follow(names, rows, 1.5, 0.01))
    forces = scene.contact_forces()
    assert set(forces) == {("block", "finger_1_tip"), ("block", "finger_2_tip")}
    assert sum(forces.values()) == pytest.approx(2 * force, rel=0.03)


def test_a_joint_pushes_as_far_as_its_finger_reaches() -> None:
    """The tip, upright, goes a circle around the lower link's joint: two joints drive it, each by half."""
    robot = three_fingers()
    drives = finger_drives(robot, pinching(robot))
    for name in FINGERS:
        assert drives[name].reach == pytest.approx(LOWER, rel=1e-3)
        assert drives[name].limit(40.0) == pytest.approx(40.0 * LOWER / 2, rel=1e-3)
        assert drives[name].stiffness(8000.0) == pytest.approx(8000.0 * LOWER**2 / 2, rel=2e-3)
    for name in ("thumb_proximal", "spread"):  # hold their values
        assert drives[name].limit(40.0) == 40.0


def test_a_hand_that_does_not_close_far_is_as_strong() -> None:
    """Openings below min_opening are closed: the middle of the joints' way is not the middle of the opening."""
    robot, hand = three_fingers(), pinching(three_fingers())
    short = mg.Hand(
        hand.tool_link, approach=hand.approach, closing=hand.closing, max_opening=0.09, min_opening=0.06,
        finger_depth=0.04, finger_width=0.02, joints=hand.joints, preshape=hand.preshape, finger_links=hand.finger_links,
    )  # fmt: skip
    assert finger_drives(robot, short)["finger_1_proximal"].reach == pytest.approx(LOWER, rel=1e-3)


def test_sides_are_what_is_on_either_side() -> None:
    robot = three_fingers()
    assert sorted(map(sorted, finger_sides(robot, pinching(robot)))) == [["finger_1_tip"], ["finger_2_tip"]]


def test_a_part_may_lie_below_the_floor_of_a_world_without_one() -> None:
    part = sim.SimPart("cube", [mg.LinkShape(mg.Box([0.03, 0.03, 0.03]))], mg.pose([1, 0, -0.2]), mass=0.1)
    scene = sim.SimScene(mg.Robot.from_strings(SWING), mg.World(), [part])
    assert scene.built.floor == pytest.approx(-0.215)


SWING = """<robot name="swing">
  <link name="foot"/>
  <joint name="turn" type="revolute"><parent link="foot"/><child link="arm"/><axis xyz="0 0 1"/>
    <limit lower="-100" upper="100" velocity="10" effort="1000"/></joint>
  <link name="arm"><inertial><mass value="1"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="tool_mount" type="fixed"><parent link="arm"/><child link="tool"/><origin xyz="1 0 0"/></joint>
  <link name="tool"/>
  <joint name="up" type="prismatic"><parent link="tool"/><child link="upper"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="0.03" velocity="1" effort="100"/></joint>
  <link name="upper"><collision><origin xyz="0 0 0.005"/><geometry><box size="0.12 0.04 0.01"/></geometry></collision></link>
  <joint name="down" type="prismatic"><parent link="tool"/><child link="lower"/><axis xyz="0 0 -1"/>
    <limit lower="0" upper="0.03" velocity="1" effort="100"/></joint>
  <link name="lower"><collision><origin xyz="0 0 -0.005"/><geometry><box size="0.12 0.04 0.01"/></geometry></collision></link>
</robot>"""


@pytest.mark.parametrize("step", [0.002, 0.0005])
def test_a_held_part_creeps_as_is_said(step: float) -> None:
    """MuJoCo's constraints leave the centripetal acceleration out: one step of it is the speed with which a held part goes outwards."""
    omega, begin, end = 4.0, 0.9, 1.2
    hand = mg.Hand(
        "tool", approach=[1, 0, 0], closing=[0, 0, 1], max_opening=0.06, finger_depth=0.1, finger_width=0.04,
        joints=[HandJoint("up", 0.0, 0.03), HandJoint("down", 0.0, 0.03)], finger_links=["upper", "lower"],
    )  # fmt: skip
    part = sim.SimPart("cube", [mg.LinkShape(mg.Box([0.03, 0.03, 0.03]))], mg.pose([1, 0, 0]), mass=0.1)
    physics = sim.Physics(time_step=step, gravity=(0.0, 0.0, 0.0))
    scene = sim.SimScene(mg.Robot.from_strings(SWING), mg.World(), [part], gripper=hand, physics=physics)
    scene.reset(np.zeros(3), {"turn": 0.0, "up": 0.0152, "down": 0.0152})

    def angle(t: float) -> float:  # closes for 0.3 s, gathers speed for 0.4 s
        up = min(max(t - 0.3, 0.0), 0.4)
        return omega * up * up / 0.8 + omega * max(t - 0.7, 0.0)

    radii = {}

    class Radius:
        def before(self, step: int, time: float, scene: sim.SceneState) -> None:
            """Nothing."""

        def after(self, step: int, time: float, scene: sim.SceneState) -> None:
            T = np.linalg.inv(scene.body_pose("link/tool")) @ scene.part_pose("cube")
            radii[round(time, 6)] = 1 + float(T[0, 3])

    scene.drive(Follow(["turn", "up", "down"], [angle, lambda t: 0.0, lambda t: 0.0], end + 0.05, 0.002), [Radius()])
    speed = (radii[end] - radii[begin]) / (end - begin)
    assert speed == pytest.approx(step * omega**2 * (radii[end] + radii[begin]) / 2, rel=0.1)


ONE_DRIVE = """<robot name="one_drive">
  <link name="palm"/>
  <joint name="drive" type="DRIVE"><parent link="palm"/><child link="upper"/><axis xyz="AXIS"/>
    <origin xyz="0 HALF 0"/><limit lower="-1" upper="1" velocity="1" effort="100"/></joint>
  <link name="upper"><collision><origin xyz="REACH 0.005 0"/><geometry><box size="0.02 0.01 0.04"/></geometry></collision></link>
  <joint name="other" type="DRIVE"><parent link="palm"/><child link="lower"/><axis xyz="AXIS"/>
    <origin xyz="0 -HALF 0"/><limit lower="-1" upper="1" velocity="1" effort="100"/><mimic joint="drive" multiplier="-1"/></joint>
  <link name="lower"><collision><origin xyz="REACH -0.005 0"/><geometry><box size="0.02 0.01 0.04"/></geometry></collision></link>
</robot>"""


@pytest.mark.parametrize("force", [15.0, 40.0])
@pytest.mark.parametrize("turning", [False, True])
def test_both_tips_of_one_drive_press_with_the_grip_force(turning: bool, force: float) -> None:
    """The other finger follows by a mimic joint: the drive's force is that of both tips, and the part stays in the middle."""
    kind, axis, reach = ("revolute", "0 0 1", 0.1) if turning else ("prismatic", "0 1 0", 0.0)
    urdf = ONE_DRIVE
    for word, text in (("DRIVE", kind), ("AXIS", axis), ("HALF", "0.015"), ("REACH", str(reach))):
        urdf = urdf.replace(word, text)
    robot = mg.Robot.from_strings(urdf)
    opened = 0.01 / reach if turning else 0.01
    hand = mg.Hand(
        "palm", approach=[1, 0, 0], closing=[0, 1, 0], max_opening=0.02, finger_depth=0.02, finger_width=0.04,
        joints=[HandJoint("drive", -opened, opened)], finger_links=["upper", "lower"],
    )  # fmt: skip
    part = sim.SimPart("cube", [mg.LinkShape(mg.Box([0.03, 0.03, 0.03]))], mg.pose([reach, 0, 0]), mass=0.1)
    physics = sim.Physics(grip_force=force, gravity=(0.0, 0.0, 0.0))
    scene = sim.SimScene(robot, mg.World(), [part], gripper=hand, physics=physics)
    scene.reset(np.zeros(3), {"drive": 0.1 * opened})
    assert scene.contact_forces() == {}  # the other finger stands where the drive asks, not in the part
    scene.drive(Follow(["drive"], [lambda t: -opened], 1.0, 0.002))
    forces = scene.contact_forces()
    for tip in ("upper", "lower"):
        assert forces["cube", tip] == pytest.approx(force, rel=0.03)
    assert abs(scene.part_pose("cube")[1, 3]) < 1e-3
    drives = finger_drives(robot, hand)
    assert drives["drive"].limit(force) == pytest.approx(2 * force * (reach or 1.0), rel=0.01)
