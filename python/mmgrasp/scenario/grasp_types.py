"""The keys `groups` and `types` of the section `gripper`: a hand of many joints by its types of grasp (P3 4.6.1)."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from .._core import Hand, JointGroup, LinkShape, Robot, _closing_line, eigengrasp_hand
from ..documents.reading import Node, near_miss
from .robot_names import joint_value

CLEARANCE = 0.01
"""Unless a section says otherwise: kept free on each side of a part [m]."""
SLANT = np.radians(15.0)
"""Pads of two sides face each other within this [rad]."""
SAME_VALUE = 1e-12
"""Joints whose two values differ by less stand still."""
POSTURES = 9
"""At which the pads are looked at, from closed to open."""
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
class TypesSection:
    """Where types of grasp are read from."""

    asked: Node
    """The section that asks for a hand."""
    node: Node
    """Has `groups`, joints that one number moves together, and `types`, their values opened and closed [rad] or [m]."""
    approach: np.ndarray
    prefix: str
    """Stands before the joints' names on the robot."""
    chosen: Node | None
    """The name of a type; None: all of them."""
    clearance: float
    payload: float


@dataclass(frozen=True)
class _GraspType:
    """A type as it is written: its groups of joints, and their values by name."""

    groups: list[tuple[str, list[str]]]
    opened: dict[str, float]
    closed: dict[str, float]

    def together(self) -> _GraspType:
        """All groups that close as one, which the opening moves."""
        still = [g for g in self.groups if all(abs(self.opened[n] - self.closed[n]) < SAME_VALUE for n in g[1])]
        names = [name for group in self.groups if group not in still for name in group[1]]
        fingers = "fingers"
        while fingers in [name for name, _ in still]:
            fingers += "_"
        return _GraspType([(fingers, names), *still] if names else still, self.opened, self.closed)

    def closed_to(self, share: float) -> _GraspType:
        """Closed no farther than to be open by `share` of what it was."""
        closed = {name: value + share * (self.opened[name] - value) for name, value in self.closed.items()}
        return _GraspType(self.groups, self.opened, closed)

    def hand(self, section: TypesSection, robot: Robot, tool_link: str, name: str) -> Hand:
        joints = [name for _, names in self.groups for name in names]
        return eigengrasp_hand(
            robot,
            tool_link,
            self.groups,
            open=[self.opened[joint] for joint in joints],
            closed=[self.closed[joint] for joint in joints],
            approach=section.approach,
            name=name,
            clearance=section.clearance,
        ).with_payload(section.payload)


def read_grasp_types(section: TypesSection, robot: Robot, tool_link: str) -> dict[str, Hand]:
    """Hands by type, each group of joints closing by itself."""
    types = _read_types(section.node, robot, section.prefix)
    kinds = [section.chosen.choice(*types)] if section.chosen else list(types)
    hands: dict[str, Hand] = {}
    for kind in kinds:
        with section.node["types"][kind].blamed():
            hands[kind] = types[kind].hand(section, robot, tool_link, kind)
    return hands


def read_hand_of_type(section: TypesSection, robot: Robot, tool_link: str) -> Hand:
    """The hand of the chosen type, or of the only one, whose fingers close together until they meet, as the opening says."""
    types = _read_types(section.node, robot, section.prefix)
    if section.chosen is None and len(types) > 1:
        section.asked.fail(f"type is missing: a round takes all parts by one type of grasp, one of {', '.join(types)}")
    kind = section.chosen.choice(*types) if section.chosen else next(iter(types))
    node = section.node["types"][kind]
    with node.blamed():
        made = types[kind].together()
        hand = made.hand(section, robot, tool_link, kind)
        share = _first_touch(hand, robot)
        if share > 0:
            hand = made.closed_to(share).hand(section, robot, tool_link, kind)
    if not hand.openings:
        node.fail("must part the fingertips all the way from closed to open")
    _check_pads(section.chosen or node, robot, hand, kind)
    return _with_whole_tips(hand, robot)


def _with_whole_tips(hand: Hand, robot: Robot) -> Hand:
    """Pads as deep as the fingertips reach beyond the tool frame and behind it: what is beside them is in the way, too."""
    poses = robot.link_poses(hand.joint_values(hand.opening_at(0.5)))
    across = np.cross(hand.approach, hand.closing)
    T_axes_root = np.eye(4)
    T_axes_root[:3, :3] = np.vstack((hand.closing, across, hand.approach))
    T_axes_root = T_axes_root @ np.linalg.inv(poses[hand.tool_link])
    ends = [
        [corner[2] for corner in LinkShape(shape.shape, T_axes_root @ poses[link] @ shape.pose).bounds]
        for link in hand.finger_links
        for shape in robot.collisions(link)
    ]
    behind, beyond = min(low for low, _ in ends), max(high for _, high in ends)
    return hand.with_finger_depth(2 * max(-behind, beyond))


def _first_touch(hand: Hand, robot: Robot) -> float:
    """How far open the pads are where they first meet; 0: they do not pass each other."""
    low, high = 0.0, 1.0
    if _closing_line(hand, robot, low)[1] >= 0:
        return 0.0
    while high - low > 1e-9:
        middle = (low + high) / 2
        if _closing_line(hand, robot, middle)[1] < 0:
            low = middle
        else:
            high = middle
    return high


def _check_pads(node: Node, robot: Robot, hand: Hand, kind: str) -> None:
    """A round's grasps lie between two sides that close alike, with the tool frame midway between the pads."""
    lines = [_closing_line(hand, robot, share) for share in np.linspace(0, 1, POSTURES)]
    slant = max(line[2] for line in lines)
    if slant > SLANT:
        node.fail(
            f"{kind} closes from all around (a pad pushes at {np.degrees(slant):.0f} degrees to the line of closing, at "
            f"most {np.degrees(SLANT):.0f}): a round's grasps lie between two sides; `mmgrasp grasp` seeks such grasps"
        )
    middle = lines[POSTURES // 2][0]
    moved = max(_beside(line[0] - middle, hand) for line in lines)
    if moved > PLAY_BESIDE:
        node.fail(
            f"the middle of the pads of {kind} moves by {moved:.4f} m while they close, at most {PLAY_BESIDE:g}: both "
            "sides must close alike, so that they meet a part at once"
        )
    if abs(middle @ hand.approach) > PLAY_ALONG or _beside(middle, hand) > PLAY_BESIDE:
        place = ", ".join(f"{value:.4f}" for value in middle)
        node.fail(
            f"the pads of {kind} close around [{place}] m in {hand.tool_link}: must be its origin; add {{name: pads, "
            f"parent: {hand.tool_link}, pose: {{xyz: [{place}]}}}} to robot.frames, and make pads the tool_link"
        )


def _beside(place: np.ndarray, hand: Hand) -> float:
    """How far a place is from the line along the approach through the tool frame's origin [m]."""
    return float(np.linalg.norm(place - (place @ hand.approach) * hand.approach))


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
