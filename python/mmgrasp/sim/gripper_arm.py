"""A designed gripper on the flange of a shipped arm, as one robot: what a gripper change makes of the cell."""

from __future__ import annotations

import tempfile
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path

from .._core import Gripper, Hand, HandJoint, JointGroup, Robot
from .._files import shipped

ARM = "asset:robots/tm14like/tm14like.urdf"
FLANGE, OWN_GRIPPER = "wrist_3_link", "gripper_axis"
PREFIX = "designed_"
TOOL = PREFIX + "tips"


@dataclass(frozen=True)
class GripperArm:
    """The robot, its arm with the middle between the finger tips as tip, and the hand."""

    robot: Robot
    arm: JointGroup
    hand: Hand
    gripper: Gripper


def gripper_arm(gripper: Gripper) -> GripperArm:
    """The shipped six-joint arm with a designed gripper in the place of its own, base on the flange."""
    urdf = ET.parse(shipped(ARM)).getroot()
    _without_gripper(urdf)
    with tempfile.TemporaryDirectory() as folder:
        gripper.to_urdf(folder)
        tool = ET.parse(Path(folder, "gripper.urdf")).getroot()
        for element in [*tool.findall("link"), *tool.findall("joint")]:
            _rename(element)
            urdf.append(element)
        height = gripper.palm_height + gripper.finger_length
        urdf.append(_fixed("mount", FLANGE, PREFIX + "base", 0.0))
        urdf.append(ET.Element("link", name=TOOL))
        urdf.append(_fixed("tips", PREFIX + "base", TOOL, height))
        file = Path(folder, "arm.urdf")
        file.write_text(ET.tostring(urdf, encoding="unicode"))
        srdf = Path(folder, "arm.srdf")
        chain = f'<group name="arm"><chain base_link="base_link" tip_link="{TOOL}"/></group>'
        srdf.write_text(f'<robot name="{urdf.get("name")}">{chain}</robot>')
        robot = Robot.load(str(file), srdf=str(srdf))
    stroke = (gripper.max_opening - gripper.min_opening) / 2
    hand = Hand(
        TOOL,
        approach=[0, 0, 1],
        closing=[1, 0, 0],
        max_opening=gripper.max_opening,
        min_opening=gripper.min_opening,
        finger_depth=gripper.pad_length,
        finger_width=gripper.finger_width,
        joints=[HandJoint(f"{PREFIX}finger_{k + 1}_joint", 0.0, stroke) for k in range(gripper.fingers)],
        finger_links=[f"{PREFIX}finger_{k + 1}" for k in range(gripper.fingers)],
    )
    return GripperArm(robot, robot.group("arm"), hand, gripper)


def _without_gripper(urdf: ET.Element) -> None:
    """Takes away the joint of the arm's own gripper and all below it."""
    joints = {joint.get("name", ""): joint for joint in urdf.findall("joint")}
    gone = [joints[OWN_GRIPPER]]
    while gone:
        joint = gone.pop()
        child = _end(joint, "child")
        urdf.remove(joint)
        for link in urdf.findall("link"):
            if link.get("name") == child:
                urdf.remove(link)
        gone += [j for j in urdf.findall("joint") if _end(j, "parent") == child]


def _end(joint: ET.Element, tag: str) -> str:
    element = joint.find(tag)
    return "" if element is None else element.get("link", "")


def _rename(element: ET.Element) -> None:
    element.set("name", PREFIX + element.get("name", ""))
    for end in (*element.findall("parent"), *element.findall("child")):
        end.set("link", PREFIX + end.get("link", ""))
    for mimic in element.findall("mimic"):  # the hand says that its joints move as one, see sim.model
        element.remove(mimic)


def _fixed(name: str, parent: str, child: str, height: float) -> ET.Element:
    joint = ET.Element("joint", name=PREFIX + name, type="fixed")
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=child)
    ET.SubElement(joint, "origin", xyz=f"0 0 {height!r}")
    return joint
