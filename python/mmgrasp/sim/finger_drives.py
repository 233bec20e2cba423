"""The fingers of a hand in physics: their two sides, and what a force at a fingertip asks of each joint."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .._core import Hand, Robot
from ..scenario.gripper_section import middle_of


@dataclass(frozen=True)
class FingerDrive:
    """How a joint pushes a fingertip."""

    reach: float = 1.0
    """The tip's way for one of the joint's, all joints going as the opening says [m/m or m/rad]."""
    sharing: int = 1
    """Joints that push the same tip."""

    def limit(self, force: float) -> float:
        """The joint's largest force for this one at the tip [N] -> [N or N m]."""
        return force * self.reach / self.sharing

    def stiffness(self, at_tip: float) -> float:
        """The joint's stiffness for this one at the tip [N/m] -> [N/m or N m/rad]."""
        return at_tip * self.reach**2 / self.sharing


def finger_drives(robot: Robot, hand: Hand) -> dict[str, FingerDrive]:
    """For each joint of the hand, by name. Joints that slide push as they go; those that move no finger keep the force as their torque."""
    table = {j["name"]: j for j in robot.joint_table}
    before, after = (hand.joint_values(hand.opening_at(share)) for share in (0.45, 0.55))
    places = []
    for values in (before, after):
        poses = robot.link_poses(values)
        to_tool = np.linalg.inv(poses[hand.tool_link])
        places.append({link: (to_tool @ poses[link] @ middle_of(robot, link))[:3] for link in hand.finger_links})
    way = {link: float(np.linalg.norm(places[1][link] - places[0][link])) for link in hand.finger_links}
    carrying = {link: _joints_before(robot, link) for link in hand.finger_links}
    moving = {name for name in before if abs(after[name] - before[name]) > 1e-12}
    drives = {}
    for joint in hand.joints:
        pushed = [link for link in hand.finger_links if joint.name in carrying[link]]
        if joint.name not in moving or not pushed or table[joint.name]["type"] == "prismatic":
            drives[joint.name] = FingerDrive()
            continue
        reach = max(way[link] for link in pushed) / abs(after[joint.name] - before[joint.name])
        drives[joint.name] = FingerDrive(reach, max(len(carrying[link] & moving) for link in pushed))
    return drives


def finger_sides(robot: Robot, hand: Hand) -> list[set[str]]:
    """Finger links on either side of the middle between the outermost ones, along the closing axis of the open hand."""
    poses = robot.link_poses(hand.joint_values(hand.max_opening))
    to_tool = np.linalg.inv(poses[hand.tool_link])
    along = {k: float(hand.closing @ (to_tool @ poses[k] @ middle_of(robot, k))[:3]) for k in hand.finger_links}
    middle = (min(along.values()) + max(along.values())) / 2
    return [{k for k, at in along.items() if (at > middle) == side} for side in (False, True)]


def _joints_before(robot: Robot, link: str) -> set[str]:
    """Joints on the way from the root to a link."""
    above = {j["child"]: (j["parent"], j["name"]) for j in robot.joint_table}
    names = set()
    while link in above:
        link, name = above[link]
        names.add(name)
    return names
