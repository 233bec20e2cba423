"""The section `gripper` of a scenario."""

from __future__ import annotations

import contextlib
import math
from typing import Any

import numpy as np

from .._core import Hand, HandJoint, InvalidInput, Mesh, Robot
from ..documents.reading import Node
from .clearance import check_clearance
from .grasp_types import CLEARANCE, TypesSection, read_grasp_types, read_hand_of_type
from .named_files import find_profile, read_profile
from .robot_names import check_link, joint_value
from .suction_section import read_cups


def read_hand(node: Node, robot: Robot, tool_link: str) -> Hand:
    """The hand of the section `gripper`: fingers, suction cups, or what is found on the robot."""
    hand = _read_hand(node, robot, tool_link)
    with _blame(node):
        check_clearance(clearance_key(node), [hand])
    return hand


def _read_hand(node: Node, robot: Robot, tool_link: str) -> Hand:
    payload = node["payload"].number(above=0) if "payload" in node else math.inf
    if "suction" in node:
        node.mapping("approach suction cup_links", "payload")
        for link in node["cup_links"].elements():
            check_link(robot, link)
        return read_cups(node, robot, tool_link, read_axes(node)["approach"], payload)
    if "from_robot" in node:
        return _gripper_from_robot(node, robot, tool_link, payload)
    if has_types(node):
        with _blame(node):
            return read_hand_of_type(_types_section(node), robot, tool_link)
    node.mapping(
        "approach closing max_opening finger_depth finger_width joints finger_links", "clearance closing_speed payload"
    )
    joints: list[HandJoint] = []
    for joint in node["joints"].elements():
        joint.mapping("name closed open")
        name = joint["name"].string()
        if name in [other.name for other in joints]:
            joint["name"].fail("is listed twice")
        closed, opened = (joint_value(robot, name, joint[key]) for key in ("closed", "open"))
        if closed == opened:
            joint["open"].fail("must differ from closed: the joint would not move")
        joints.append(HandJoint(name, closed, opened))
    if not joints:
        node["joints"].fail("must name a joint: the fingers would not move")
    links = node["finger_links"].elements()
    for link in links:
        check_link(robot, link)
    if len({link.raw for link in links}) < max(2, len(links)):
        node["finger_links"].fail("must be at least two links, each once: parts are held between them")
    sizes: dict[str, Any] = {key: node[key].number(above=0) for key in ("max_opening", "finger_depth", "finger_width")}
    if "clearance" in node:
        sizes["clearance"] = node["clearance"].number(least=0)
    axes = read_axes(node)
    with node.blamed():
        hand = Hand(
            tool_link,
            approach=axes["approach"],
            closing=axes["closing"],
            joints=joints,
            finger_links=[link.raw for link in links],
            payload=payload,
            **sizes,
        )
    return hand


def has_types(node: Node) -> bool:
    """The section is a hand of many joints by its types of grasp, its own or a profile's."""
    return bool({"name", "groups", "types"} & set(node.raw)) if isinstance(node.raw, dict) else False


def read_types(node: Node, robot: Robot, tool_link: str) -> dict[str, Hand]:
    """The hands of such a section by type, each group of joints closing by itself; one where the section chooses it."""
    with _blame(node):
        hands = read_grasp_types(_types_section(node), robot, tool_link)
        check_clearance(clearance_key(node), hands.values())
    return hands


def clearance_key(node: Node) -> Node | None:
    """Where the section, or the profile that it names, states the clearance; None: nowhere."""
    if "clearance" in node:
        return node["clearance"]
    profile = _profile_of(node["name"]) if "name" in node else node
    return profile["clearance"] if "clearance" in profile else None


def _types_section(node: Node) -> TypesSection:
    """`name` of a profile, or groups and types; what the section says goes before what the profile says."""
    own = "approach groups types"
    if "name" in node:
        node.mapping("name", "type prefix clearance closing_speed payload")
        profile = _profile_of(node["name"])
        if "types" not in profile:
            node["name"].fail("has no types of grasp: must be the profile of a hand of many joints")
        profile.mapping(own, "clearance payload")
    else:
        profile = node.mapping(own, "type clearance closing_speed payload")

    def number(key: str, otherwise: float, **bounds: float) -> float:
        for section in (node, profile):
            if key in section:
                return section[key].number(**bounds)
        return otherwise

    return TypesSection(
        node,
        profile,
        read_axes(profile)["approach"],
        node["prefix"].string() if "prefix" in node else "",
        node["type"] if "type" in node else None,
        number("clearance", CLEARANCE, least=0),
        number("payload", math.inf, above=0),
    )


def _profile_of(name: Node) -> Node:
    """The section `gripper` of the profile of this name, or in this file."""
    return read_profile(find_profile(name, ("grippers", "robots")))["gripper"]


def _blame(node: Node) -> contextlib.AbstractContextManager[None]:
    """What is refused in a profile is told with the key that names it."""
    return node["name"].blamed() if "name" in node else contextlib.nullcontext()


def check_finger_travel(section: Node, robot: Robot, hand: Hand) -> None:
    """Both fingers meet a part at once: all move, and those that slide go half of the opening along `closing`, apart as they open."""
    if "joints" not in section:
        return
    node = section["joints"]
    ends = [robot.link_poses(hand.joint_values(opening)) for opening in (0.0, hand.max_opening)]
    ways, places = {}, {}
    for link in hand.finger_links:
        closed, opened = (np.linalg.inv(poses[hand.tool_link]) @ poses[link] for poses in ends)
        if np.allclose(opened, closed, atol=1e-9):
            node.fail(f"must move every finger: the finger link {link} stands still")
        places[link] = float(hand.closing @ (closed @ middle_of(robot, link))[:3])
        moved = (opened - closed)[:3, 3]
        if np.linalg.norm(moved) > 1e-9 and np.allclose(opened[:3, :3], closed[:3, :3], atol=1e-9):
            ways[link] = hand.closing @ moved
    for link, way in ways.items():
        if abs(abs(way) - hand.max_opening / 2) > 1e-3:
            node.fail(
                f"{link} moves {abs(way):.4g} m along closing between closed and open: must be half of max_opening, "
                f"{hand.max_opening / 2:.4g} m, so that both fingers meet the part at once"
            )
    if len(ways) > 1 and len({way > 0 for way in ways.values()}) == 1:
        node.fail(f"{' and '.join(ways)} move the same way along closing: fingers must move apart as they open")
    outer = max(ways, key=lambda link: places[link], default=None)
    inner = min(ways, key=lambda link: places[link], default=None)
    if outer and inner and places[outer] > places[inner] and ways[outer] < ways[inner]:
        node.fail(f"{inner} and {outer} come nearer to each other as they open: are closed and open swapped?")


def middle_of(robot: Robot, link: str) -> np.ndarray:
    """Mean place of a link's shapes in its frame, homogeneous; its origin where it has none [m]."""
    places = [
        shape.pose @ np.append(shape.shape.vertices.mean(axis=0) if isinstance(shape.shape, Mesh) else np.zeros(3), 1.0)
        for shape in robot.collisions(link)
    ]
    return np.mean(places, axis=0) if places else np.array([0.0, 0.0, 0.0, 1.0])


def read_axes(node: Node) -> dict[str, Any]:
    """The axes `approach` and `closing` of the tool frame, as far as they are given."""
    axes: dict[str, Any] = {}
    for key in ("approach", "closing"):
        if key not in node:
            continue
        axis = np.array(node[key].numbers(3))
        if abs(np.linalg.norm(axis) - 1) > 1e-6:
            node[key].fail("must be a unit axis of the tool frame")
        axes[key] = axis
    if len(axes) == 2 and abs(axes["approach"] @ axes["closing"]) > 1e-6:
        node["closing"].fail("must be orthogonal to approach")
    return axes


def _gripper_from_robot(node: Node, robot: Robot, tool_link: str, payload: float) -> Hand:
    """A hand measured on the robot's own shapes; what the section states goes first."""
    source = node.mapping("from_robot", "approach closing clearance closing_speed payload")["from_robot"]
    if source.raw is not True and not isinstance(source.raw, str):
        source.fail("must be an SRDF end effector or group, or true: every joint below the tool frame's body")
    stated = read_axes(node)
    if "clearance" in node:
        stated["clearance"] = node["clearance"].number(least=0)
    try:
        hand = Hand.from_robot(robot, tool_link, group="" if source.raw is True else source.string(), **stated)
    except InvalidInput as error:
        node.fail(str(error))
    return hand.with_payload(payload)
