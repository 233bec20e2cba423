"""The keys `groups` and `types` of the section `gripper`: a hand of many joints by its types of grasp (P3 4.6.1)."""

from __future__ import annotations

from dataclasses import dataclass, field

from .._core import Hand, JointGroup, Robot, eigengrasp_hand
from ..documents.reading import Node, near_miss
from .robot_names import joint_value


@dataclass(frozen=True)
class HandTypes:
    """A hand that grasps are sought for: one `Hand` a type of grasp; two pads are of one type without a name."""

    hands: dict[str, Hand]
    robot: Robot | None = None
    """Whose joints and bodies a hand of several groups has; None: two pads."""
    arms: dict[str, JointGroup] = field(default_factory=dict)
    """For each type the arm that carries the hand, opened; empty where none was asked for."""


def read_grasp_types(node: Node, robot: Robot, tool_link: str, approach: list[float]) -> dict[str, Hand]:
    """Hands by type. `groups` names the joints that one number moves together, `types` their values opened and closed [rad] or [m]."""
    groups = _read_groups(node["groups"], robot)
    joints = [name for _, names in groups for name in names]
    hands: dict[str, Hand] = {}
    for kind, ends in node["types"].items():
        if not kind.isprintable() or not kind.strip():
            ends.fail("a type of grasp needs a name")
        ends.mapping("open closed")
        opened = _read_posture(ends["open"], robot, joints)
        for name in joints:
            if name not in opened:
                ends["open"].fail(f"must have a value for each joint of the groups; {name} is missing")
        closed = opened | _read_posture(ends["closed"], robot, joints)
        with ends.blamed():
            hands[kind] = eigengrasp_hand(
                robot,
                tool_link,
                groups,
                open=[opened[name] for name in joints],
                closed=[closed[name] for name in joints],
                approach=approach,
                name=kind,
            )
    if not hands:
        node["types"].fail("must name a type of grasp")
    return hands


def opened(hand: Hand) -> dict[str, float]:
    """Values of a hand's joints while an arm moves it to a part."""
    return {joint.name: joint.open for joint in hand.joints}


def _read_groups(node: Node, robot: Robot) -> list[tuple[str, list[str]]]:
    owners: dict[str, str] = {}
    groups = []
    for group, joints in node.items():
        names = []
        for joint in joints.elements():
            name = joint.string()
            if name not in robot.joints:
                joint.fail(f"the robot has no movable joint {name}{near_miss(name, robot.joints)}")
            if name in owners:
                joint.fail(f"{name} is a joint of the group {owners[name]}, too: a joint belongs to one")
            owners[name] = group
            names.append(name)
        if not names:
            joints.fail("must name a joint")
        groups.append((group, names))
    if not groups:
        node.fail("must name a group of joints")
    return groups


def _read_posture(node: Node, robot: Robot, joints: list[str]) -> dict[str, float]:
    values = {}
    for name, value in node.items():
        if name not in joints:
            value.fail(f"no group has the joint {name}{near_miss(name, joints)}")
        values[name] = joint_value(robot, name, value)
    return values
