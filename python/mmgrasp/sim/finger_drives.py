"""The fingers of a hand in physics: their two sides, and what a force at a fingertip asks of each joint."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .._core import Hand, Robot
from ..scenario.gripper_section import middle_of

TOGETHER = "0.004 1"  # joints that one drive moves keep together so firmly (solref)


@dataclass(frozen=True)
class FingerDrive:
    """How a joint pushes a fingertip."""

    reach: float = 1.0
    """The tip's way for one of the joint's, all joints going as the opening says [m/m or m/rad]."""
    sharing: int = 1
    """Joints that push the same tip."""
    followed: tuple[FingerDrive, ...] = ()
    """How it pushes other tips, each through a joint that follows it (`mimic`)."""

    def limit(self, force: float) -> float:
        """The joint's largest force for this one at each tip [N] -> [N or N m]."""
        return force * self.reach / self.sharing + sum(other.limit(force) for other in self.followed)

    def stiffness(self, at_tip: float) -> float:
        """The joint's stiffness for this one at each tip [N/m] -> [N/m or N m/rad]."""
        return at_tip * self.reach**2 / self.sharing + sum(other.stiffness(at_tip) for other in self.followed)


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
    leader = {name: j["mimic"] or name for name, j in table.items()}
    carrying = {link: _joints_before(robot, link) for link in hand.finger_links}
    moving = {name for name in before if abs(after[name] - before[name]) > 1e-12}
    sharing = {link: len({leader[name] for name in carrying[link]} & moving) for link in hand.finger_links}
    drives = {}
    for joint in hand.joints:
        pushes = []
        for name, pushed in _tips_pushed(joint.name, leader, carrying) if joint.name in moving else []:
            if name == joint.name and table[name]["type"] == "prismatic":
                pushes.append(FingerDrive())
                continue
            reach = max(way[link] for link in pushed) / abs(after[joint.name] - before[joint.name])
            pushes.append(FingerDrive(reach, max(sharing[link] for link in pushed)))
        first, *others = pushes or [FingerDrive()]
        drives[joint.name] = replace(first, followed=tuple(others))
    return drives


def _tips_pushed(drive: str, leader: dict[str, str], carrying: dict[str, set[str]]) -> list[tuple[str, list[str]]]:
    """The joint, and those that follow it, each with the tips that it carries, every tip once: with the joint itself or the follower nearest the root."""
    out, known = [], set[str]()
    carried = {name: [link for link in carrying if name in carrying[link]] for name in leader if leader[name] == drive}
    for name in sorted(carried, key=lambda name: (name != drive, -len(carried[name]))):
        new = [link for link in carried[name] if link not in known]
        known.update(new)
        if new:
            out.append((name, new))
    return out


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
