"""Which joints of a robot are its arm, and which its hand."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from ..._core import InvalidInput, Robot
from ...documents.reading import near_miss
from .tree import Tree

_LEAST_ARM = 4  # joints
_JAW = re.compile(r"grip|finger|jaw|claw|thumb", re.IGNORECASE)


@dataclass
class Arm:
    """The arm and hand that were chosen."""

    base_link: str
    joints: list[str]
    hand_link: str  # the arm's last body, where a hand's joints begin or a gripper is mounted
    hand_joints: list[str]
    group: str | None = None  # of the SRDF
    others: list[str] = field(default_factory=list)  # links at the ends of arms that were not chosen


def find_arm(robot: Robot, wheels: list[str], group: str | None, end: str | None) -> Arm:
    """The arm: the group asked for, the one that carries the link `end`, or the longest. InvalidInput where there is none."""
    tree = Tree(robot)
    ends = _arm_ends(tree, wheels)
    if group is not None:
        return _arm_of_group(tree, group)
    if end is not None:
        if end not in robot.links:
            raise InvalidInput(f"tool_link = {end!r}: the robot has no such link{near_miss(end, robot.links)}")
        ends = [tree.body(end)]
        if (count := len(_driven(tree, ends[0], wheels))) < _LEAST_ARM:
            raise InvalidInput(f"tool_link = {end!r}: {count} joints lead to it: an arm has at least {_LEAST_ARM}")
    ends = [link for link in ends if len(_driven(tree, link, wheels)) >= _LEAST_ARM]
    if not ends:
        raise InvalidInput(
            f"{robot.name}: no chain of at least {_LEAST_ARM} joints that is an arm: nothing can pick; put one on it: --mount ARM.urdf=LINK"
        )
    chosen = max(ends, key=lambda link: len(_driven(tree, link, wheels)))
    joints = _driven(tree, chosen, wheels)
    own = next((n for n, g in robot.groups.items() if g["joints"] == joints and g["tip_link"]), None)
    return Arm(
        tree.joints[joints[0]]["parent"],
        joints,
        chosen,
        tree.all_below(chosen),
        own,
        [link for link in ends if link != chosen],
    )


def _driven(tree: Tree, link: str, wheels: list[str]) -> list[str]:
    """Joints on the way to a link that a planner moves."""
    path = tree.path(link)
    return [n for n in path if tree.joints[n]["mimic"] is None] if not set(path) & set(wheels) else []


def _arm_ends(tree: Tree, wheels: list[str]) -> list[str]:
    """The first link of each body at which an arm ends and its hand, if any, begins."""
    ends = []
    for effector in tree.robot.end_effectors:
        body = tree.body(effector["parent_link"])
        if body not in tree.into or not _JAW.search(f"{tree.into[body]} {body}"):  # else it names a finger
            ends.append(body)
    leaves = {tree.body(link) for link in tree.robot.links if not tree.below(link)}
    for leaf in sorted(leaves, key=tree.robot.links.index):
        way = [leaf]  # bodies from the leaf to the root
        while way[-1] in tree.into:
            way.append(tree.body(tree.joints[tree.into[way[-1]]]["parent"]))
        palms = [b for b in way[1:] if len(tree.path(b)) >= _LEAST_ARM and _carries_fingers(tree, b)]
        ends.append(palms[-1] if palms else leaf)
    return [link for link in dict.fromkeys(ends) if not set(tree.path(link)) & set(wheels)]


def _carries_fingers(tree: Tree, link: str) -> bool:
    """Whether more than one joint begins at a body, or a last one whose name says that it is a jaw."""
    below = tree.below(link)
    if len(below) != 1:
        return len(below) > 1
    child = tree.joints[below[0]]["child"]
    return not tree.below(child) and _JAW.search(f"{below[0]} {child}") is not None


def _arm_of_group(tree: Tree, name: str) -> Arm:
    robot = tree.robot
    if name not in robot.groups:
        raise InvalidInput(
            f"group = {name!r}: the SRDF has no such group{near_miss(name, list(robot.groups) or ['(none)'])}"
        )
    described = robot.groups[name]
    if not described["tip_link"]:
        raise InvalidInput(f"group = {name!r}: must be a chain")
    tip = tree.body(described["tip_link"])
    return Arm(described["base_link"], list(described["joints"]), tip, tree.all_below(tip), name)
