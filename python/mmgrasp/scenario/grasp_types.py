"""The keys `groups` and `types` of the section `gripper`: a hand of many joints by its types of grasp (P3 4.6.1)."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from .._core import Hand, JointGroup, Robot, _closing_line, eigengrasp_hand
from ..documents.reading import Node, near_miss
from .robot_names import joint_value

CLEARANCE = 0.01
"""Unless a section says otherwise: kept free on each side of a part [m]."""
SLANT = np.radians(15.0)
"""Pads of two sides face each other within this [rad]."""
PLAY_ALONG, PLAY_BESIDE = 0.005, 0.001
"""So far may the tool frame be from where half open pads close, along the approach and across it [m]: tips that turn rise while they close."""


@dataclass(frozen=True)
class HandTypes:
    """A hand that grasps are sought for: one `Hand` a type of grasp; two pads are of one type without a name."""

    hands: dict[str, Hand]
    robot: Robot | None = None
    """Whose joints and bodies a hand of several groups has; None: two pads."""
    arms: dict[str, JointGroup] = field(default_factory=dict)
    """For each type the arm that carries the hand, opened; empty where none was asked for."""


@dataclass(frozen=True)
class _GraspType:
    """A type as it is written: its groups of joints, and their values by name."""

    groups: list[tuple[str, list[str]]]
    opened: dict[str, float]
    closed: dict[str, float]

    def together(self) -> _GraspType:
        """All groups that close as one, which the opening moves."""
        closing = [g for g in self.groups if any(self.opened[name] != self.closed[name] for name in g[1])]
        still = [g for g in self.groups if g not in closing]
        fingers = [("fingers", [name for _, names in closing for name in names])] if closing else []
        return _GraspType([*fingers, *still], self.opened, self.closed)

    def hand(self, robot: Robot, tool_link: str, approach: np.ndarray, name: str, clearance: float) -> Hand:
        joints = [name for _, names in self.groups for name in names]
        return eigengrasp_hand(
            robot,
            tool_link,
            self.groups,
            open=[self.opened[joint] for joint in joints],
            closed=[self.closed[joint] for joint in joints],
            approach=approach,
            name=name,
            clearance=clearance,
        )


def read_grasp_types(node: Node, robot: Robot, tool_link: str, approach: np.ndarray) -> dict[str, Hand]:
    """Hands by type. `groups` names the joints that one number moves together, `types` their values opened and closed [rad] or [m]."""
    hands: dict[str, Hand] = {}
    for kind, made in _read_types(node, robot, "").items():
        with node["types"][kind].blamed():
            hands[kind] = made.hand(robot, tool_link, approach, kind, CLEARANCE)
    return hands


def read_hand_of_type(
    node: Node, chosen: Node | None, robot: Robot, tool_link: str, approach: np.ndarray, prefix: str, clearance: float
) -> Hand:
    """The hand of one type, whose fingers close together as the opening says. `chosen`: its name, None where there is
    one alone; `prefix` stands before the joints' names on the robot.
    """
    types = _read_types(node, robot, prefix)
    if chosen is None:
        if len(types) > 1:
            node.fail(f"type is missing: a round takes all parts by one type of grasp, one of {', '.join(types)}")
        kind = next(iter(types))
    else:
        kind = chosen.choice(*types)
    with node["types"][kind].blamed():
        hand = types[kind].together().hand(robot, tool_link, approach, kind, clearance)
    _check_pads(chosen or node["types"][kind], robot, hand, kind)
    return hand


def _check_pads(node: Node, robot: Robot, hand: Hand, kind: str) -> None:
    """A round's grasps lie between two sides, with the tool frame midway between the pads."""
    middle, slant = _closing_line(hand, robot)
    if slant > SLANT:
        node.fail(
            f"{kind} closes from all around (a pad pushes at {np.degrees(slant):.0f} degrees to the line of closing, at most "
            f"{np.degrees(SLANT):.0f}): a round's grasps lie between two sides; `mmgrasp grasp` seeks such grasps"
        )
    along = abs(middle @ hand.approach)
    beside = np.linalg.norm(middle - (middle @ hand.approach) * hand.approach)
    if along > PLAY_ALONG or beside > PLAY_BESIDE:
        place = ", ".join(f"{value:.4f}" for value in middle)
        node.fail(
            f"the pads of {kind} close around [{place}] m in {hand.tool_link}: must be its origin; add {{name: pads, parent: "
            f"{hand.tool_link}, pose: {{xyz: [{place}]}}}} to robot.frames, and make pads the tool_link"
        )


def _read_types(node: Node, robot: Robot, prefix: str) -> dict[str, _GraspType]:
    groups = _read_groups(node["groups"], robot, prefix)
    joints = [name for _, names in groups for name in names]
    types: dict[str, _GraspType] = {}
    for kind, ends in node["types"].items():
        if not kind.isprintable() or not kind.strip():
            ends.fail("a type of grasp needs a name")
        ends.mapping("open closed")
        opened = _read_posture(ends["open"], robot, joints, prefix)
        for name in joints:
            if name not in opened:
                ends["open"].fail(f"must have a value for each joint of the groups; {name} is missing")
        types[kind] = _GraspType(groups, opened, opened | _read_posture(ends["closed"], robot, joints, prefix))
    if not types:
        node["types"].fail("must name a type of grasp")
    return types


def opened(hand: Hand) -> dict[str, float]:
    """Values of a hand's joints while an arm moves it to a part."""
    return {joint.name: joint.open for joint in hand.joints}


def _read_groups(node: Node, robot: Robot, prefix: str) -> list[tuple[str, list[str]]]:
    owners: dict[str, str] = {}
    groups = []
    for group, joints in node.items():
        names = []
        for joint in joints.elements():
            name = prefix + joint.string()
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


def _read_posture(node: Node, robot: Robot, joints: list[str], prefix: str) -> dict[str, float]:
    values = {}
    for key, value in node.items():
        name = prefix + key
        if name not in joints:
            value.fail(f"no group has the joint {name}{near_miss(name, joints)}")
        values[name] = joint_value(robot, name, value)
    return values
