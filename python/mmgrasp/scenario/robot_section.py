"""The sections `robot` and `place_region` of a scenario: one robot composed of files, mounts, frames and a bin."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import _core
from .._argument_errors import checked
from .._core import (
    Box,
    Hand,
    JointGroup,
    LinkShape,
    PlaceRegion,
    Robot,
)
from .._files import shipped
from .._progress import Progress
from ..documents.reading import Node, near_miss, read_yaml
from .closed_fingers import fingers_may_meet, held_links_may_meet
from .grasp_types import HandTypes, opened
from .gripper_section import check_finger_travel, has_types, read_hand, read_types
from .named_files import check_profile, find_file, find_profile, profile_path
from .robot_names import check_link, joint_value
from .shapes import read_shapes
from .wheels import limits_of_wheels

BASE_LIMITS = "linear_velocity angular_velocity linear_acceleration angular_acceleration workspace wheel_velocity wheel_separation wheelbase"
ROBOT_KEYS = (
    "urdf srdf packages xacro_args mesh_tolerance base base_limits wheels mount frames group tool_link joints home"
)
BIN_LINK = "place_bin"
LONGEST_CROSSING = 600.0  # from end to end of a joint's range [s]
MOST_IN_BIN = 1_000_000  # parts
SLOWEST = 1e-3  # of a base [m/s, rad/s and their rates]: a round that takes days has more samples than memory


@dataclass
class RobotSetup:
    """The composed robot and what the planner has to know about it."""

    robot: Robot
    arm: JointGroup
    group: dict[str, Any]
    """What `Robot.group` makes the arm of: an SRDF group's name or its base link, and the tip."""
    gripper: Hand
    place_region: PlaceRegion | None
    """The bin; None: the robot has none, and parts are carried in the hand."""
    home: np.ndarray
    other_joints: dict[str, float]
    sections: RobotSections
    """Where it was read from."""
    closing_speed: float = 0.1
    """How fast the gripper's opening shrinks [m/s] (P1 4.4.1)."""
    mesh_tolerance: float = 0.0
    """The coarsest one of its robots [m]."""

    @property
    def rates_all_pads(self) -> bool:
        """The gripper is more than two pads: grasps of a map are sought for its own links."""
        return has_types(self.sections.gripper) or len(self.gripper.groups) > 1


@dataclass
class RobotSections:
    """Where the three sections are read from: the scenario itself, or a robot profile that it names."""

    robot: Node
    gripper: Node
    place_region: Node | None
    """None: a profile of an arm alone, or a scenario whose parts are carried in the hand."""


def choose_sections(root: Node, robot_name: str | None) -> RobotSections:
    """The scenario's own sections, or those of the profile that `--robot` or `robot: {name: ...}` asks for; no bin beside an unload_region."""
    if "unload_region" in root and "place_region" in root:
        root["unload_region"].fail(
            "parts go into the bin, place_region, or are carried in the hand and let go here: leave one of both out"
        )
    sections = _sections_as_named(root, robot_name)
    if "unload_region" in root:
        sections.place_region = None
    elif sections.place_region is None and "trays" in root:
        root.fail(
            "needs a place_region, the bin on the robot, or an unload_region, where parts that the robot carries in its hand are let go at the goal"
        )
    return sections


def _sections_as_named(root: Node, robot_name: str | None) -> RobotSections:
    if robot_name is not None:
        return _profile_sections(read_yaml(profile_path(robot_name)).root)
    profile = _named_profile(root["robot"])
    own_bin = root["place_region"] if "place_region" in root else None
    if profile is None:
        return RobotSections(root["robot"], root["gripper"], own_bin)
    gripper = root["gripper"] if "gripper" in root else profile.gripper
    return RobotSections(profile.robot, gripper, own_bin or profile.place_region)


def _named_profile(own: Node) -> RobotSections | None:
    """The profile that `robot: {name: ...}` asks for; None where the section describes a robot itself."""
    if not isinstance(own.raw, dict) or not own.raw.keys() & {"name", "urdf"}:
        own.fail("must be a mapping with urdf, or with the name of a robot profile")
    if "name" not in own:
        return None
    own.mapping("name")
    return _profile_sections(read_yaml(find_profile(own["name"])).root)


def _profile_sections(profile: Node) -> RobotSections:
    check_profile(profile)
    place_region = profile["place_region"] if "place_region" in profile else None
    return RobotSections(profile["robot"], profile["gripper"], place_region)


@checked
def read_gripper(source: str) -> Hand:
    """The gripper of a robot profile (name or file) or of a scenario, `asset:...` for a shipped one.

    Raises InvalidInput or IoError with one message that names file, line, key, value and rule.
    """
    sections = _sections_of(source)
    robot = compose(sections.robot.mapping("urdf tool_link", f"group home {ROBOT_KEYS}"))
    check_link(robot, sections.robot["tool_link"])
    hand = read_hand(sections.gripper, robot, sections.robot["tool_link"].string())
    check_finger_travel(sections.gripper, robot, hand)
    return hand


@checked
def read_arm_of(source: str, progress: Progress = None) -> ArmSetup:
    """Arm and gripper of a robot profile or scenario, named and refused as in read_gripper()."""
    sections = _sections_of(source)
    return _arm_setup(sections.robot, sections.gripper, progress)


@checked
def read_hand_types(source: str, *, arm: bool = False, progress: Progress = None) -> HandTypes:
    """A gripper by its types of grasp, with `arm` also the arm that carries it; named and refused as in read_gripper()."""
    sections = _sections_of(source)
    if not has_types(sections.gripper):
        if not arm:
            return HandTypes({"": read_gripper(source)})
        setup = _arm_setup(sections.robot, sections.gripper, progress)
        return HandTypes({"": setup.gripper}, arms={"": setup.arm})
    node = sections.robot.mapping("urdf tool_link group" if arm else "urdf tool_link", f"group home {ROBOT_KEYS}")
    robot = compose(node)
    tool_link = node["tool_link"].string()
    check_link(robot, node["tool_link"])
    types = read_types(sections.gripper, robot, tool_link)
    if not arm:
        return HandTypes(types, robot)
    robot = _core.with_sampled_pairs(robot, progress=progress)
    other = {name: joint_value(robot, name, value) for name, value in _named_numbers(node, "joints")}
    group = _arm_of(robot, node["group"], _read_group(robot, node["group"], tool_link))
    arms = {kind: group.with_reference({**other, **opened(made)}) for kind, made in types.items()}
    return HandTypes(types, robot, arms)


def _sections_of(source: str) -> RobotSections:
    path = shipped(source) if source.startswith("asset:") else profile_path(source, ("robots", "grippers"))
    root = read_yaml(path).root
    return choose_sections(root, None) if "trays" in root else _profile_sections(root)


def read_setup(sections: RobotSections, progress: Progress = None) -> RobotSetup:
    """Composes the robot, finds which of its links can never touch, and sets up its arm, gripper and, where there is one, bin."""
    node = sections.robot.mapping("urdf group tool_link home", ROBOT_KEYS)
    robot = compose(node)
    tool_link = node["tool_link"].string()
    check_link(robot, node["tool_link"])
    gripper = read_hand(sections.gripper, robot, tool_link)
    bin_section, place_region = sections.place_region, None
    if bin_section is not None:
        robot, bin_pose = _add_bin(robot, bin_section)
        place_region = _read_place_region(bin_section, bin_pose)
    robot = fingers_may_meet(_core.with_sampled_pairs(robot, progress=progress), gripper)

    other = {name: joint_value(robot, name, value) for name, value in _named_numbers(node, "joints")}
    closed = gripper.joint_values(0.0)
    group = _read_group(robot, node["group"], tool_link)
    arm = _arm_of(robot, node["group"], group)
    _check_joint_owners(sections, arm, gripper)
    robot = held_links_may_meet(robot, arm, gripper, other)
    arm = robot.group(**group).with_reference({**other, **closed})
    home = _read_home(node["home"], arm)
    if bin_section is not None:
        _fixed_to_root(arm, bin_section["parent"], home)
    for key in ("finger_links", "cup_links"):
        if key in sections.gripper:
            _check_finger_links(sections.gripper[key], arm, tool_link, home)
    check_finger_travel(sections.gripper, robot, gripper)
    speed = (
        sections.gripper["closing_speed"].number(least=1e-4, most=10) if "closing_speed" in sections.gripper else 0.1
    )
    return RobotSetup(robot, arm, group, gripper, place_region, home, other, sections, speed, _mesh_tolerance(node))


@dataclass
class ArmSetup:
    """A robot that needs no bin: an arm, where its other joints stand, and its gripper."""

    robot: Robot
    arm: JointGroup
    gripper: Hand


def read_arm(root: Node, progress: Progress = None) -> ArmSetup:
    """The sections `robot` and `gripper` of a file: an arm or an arm on a base, and its gripper; `robot: {name: ...}` takes a profile's."""
    profile = _named_profile(root["robot"])
    node = root["robot"] if profile is None else profile.robot
    hand = root["gripper"] if profile is None or "gripper" in root else profile.gripper
    return _arm_setup(node, hand, progress)


def _arm_setup(node: Node, hand: Node, progress: Progress) -> ArmSetup:
    node.mapping("urdf group tool_link", ROBOT_KEYS)
    robot = compose(node)
    tool_link = node["tool_link"].string()
    check_link(robot, node["tool_link"])
    gripper = read_hand(hand, robot, tool_link)
    robot = fingers_may_meet(_core.with_sampled_pairs(robot, progress=progress), gripper)
    other = {name: joint_value(robot, name, value) for name, value in _named_numbers(node, "joints")}
    arm = _arm_of(robot, node["group"], _read_group(robot, node["group"], tool_link))
    check_finger_travel(hand, robot, gripper)
    return ArmSetup(robot, arm.with_reference({**other, **gripper.joint_values(0.0)}), gripper)


def compose(node: Node) -> Robot:
    """The robot of a section: its own files, what is mounted on it, and frames."""
    limits = {}
    if "base_limits" in node:
        section = node["base_limits"].mapping("", BASE_LIMITS)
        slow = {key for key in BASE_LIMITS.split() if key.endswith(("velocity", "acceleration"))}
        limits = {
            key: value.number(least=SLOWEST) if key in slow else value.number(above=0) for key, value in section.items()
        }
    base = node["base"].choice("fixed", "diff_drive", "omni") if "base" in node else "fixed"
    if "wheels" in node:
        limits = limits_of_wheels(node["wheels"], base, limits)
    with (node["base_limits"] if "base_limits" in node else node).blamed():
        robot = _load(node, base, limits)
    for mount in node["mount"].elements() if "mount" in node else []:
        mount.mapping("urdf parent_link", "srdf packages xacro_args mesh_tolerance pose prefix")
        other = _load(mount, "fixed", {})
        check_link(robot, mount["parent_link"])
        T = mount["pose"].pose() if "pose" in mount else np.eye(4)
        prefix = mount["prefix"].string() if "prefix" in mount else ""
        with mount.blamed():
            robot = robot.mount(other, mount["parent_link"].string(), T, prefix)
    for frame in node["frames"].elements() if "frames" in node else []:
        frame.mapping("name parent", "pose box cylinder sphere mesh shapes scale")
        check_link(robot, frame["parent"])
        if frame["name"].label() in (*robot.links, BIN_LINK):
            frame["name"].fail("the robot has a link of this name already")
        T = frame["pose"].pose() if "pose" in frame else np.eye(4)
        shapes = read_shapes(frame, find_file, required=False)
        with frame.blamed():
            robot = robot.with_link(frame["name"].string(), frame["parent"].string(), T, shapes)
    return robot


def _mesh_tolerance(robot: Node) -> float:
    parts = [robot, *(robot["mount"].elements() if "mount" in robot else [])]
    return max(part["mesh_tolerance"].number(least=0) if "mesh_tolerance" in part else 0.0 for part in parts)


def _load(node: Node, base: str, limits: dict[str, float]) -> Robot:
    urdf = find_file(node["urdf"])
    srdf = find_file(node["srdf"]) if "srdf" in node else None
    packages = {}
    for name, folder in node["packages"].items() if "packages" in node else []:
        packages[name] = str(find_file(folder))
    if "xacro_args" in node and urdf.suffix != ".xacro":
        node["xacro_args"].fail("only a .xacro file takes arguments")
    arguments = {name: value.raw for name, value in node["xacro_args"].items()} if "xacro_args" in node else None
    tolerance = node["mesh_tolerance"].number(least=0) if "mesh_tolerance" in node else 0.0
    return Robot.load(urdf, srdf, packages, base, base_limits=limits, mesh_tolerance=tolerance, xacro_args=arguments)


def _named_numbers(node: Node, key: str) -> list[tuple[str, Node]]:
    return list(node[key].items()) if key in node else []


def _read_group(robot: Robot, node: Node, tool_link: str) -> dict[str, Any]:
    if isinstance(node.raw, str):
        if node.raw not in robot.groups:
            node.fail(f"the SRDF has no such group{near_miss(node.raw, list(robot.groups) or ['(none)'])}")
        return {"name": node.raw, "tip": tool_link}
    node.mapping("base_link", "tip_link")
    for key in ("base_link", "tip_link"):
        if key in node:
            check_link(robot, node[key])
    return {"base_link": node["base_link"].string(), "tip": tool_link}


def _arm_of(robot: Robot, node: Node, group: dict[str, Any]) -> JointGroup:
    with node.blamed():
        arm = robot.group(**group)
    _check_speeds(node, arm)
    return arm


def _check_speeds(node: Node, arm: JointGroup) -> None:
    """Every joint crosses its range in minutes: motions that take days have more samples than memory."""
    travel = np.minimum(arm.upper - arm.lower, 2 * np.pi)
    for name, way, speed in zip(arm.names, travel, arm.velocity_limits, strict=True):
        if way > LONGEST_CROSSING * speed:
            node.fail(
                f"the joint {name} has a velocity of {speed:g} in its URDF: must be at least {way / LONGEST_CROSSING:.3g}, for it to cross "
                f"its range, or a turn, in {LONGEST_CROSSING:g} s"
            )


def _read_home(node: Node, arm: JointGroup) -> np.ndarray:
    given = dict(node.items())
    for name, value in given.items():
        if name not in arm.names:
            value.fail(f"the arm has no joint {name}{near_miss(name, arm.names)}")
    missing = [name for name in arm.names if name not in given]
    if missing:
        node.fail("every arm joint must be given; missing: " + ", ".join(missing))
    home = np.array([given[name].number() for name in arm.names])
    for i, name in enumerate(arm.names):
        if not arm.lower[i] - 1e-9 <= home[i] <= arm.upper[i] + 1e-9:
            given[name].fail(f"must be in [{arm.lower[i]:g}, {arm.upper[i]:g}]")
    return home


def _add_bin(robot: Robot, node: Node) -> tuple[Robot, np.ndarray]:
    """The robot with the bin's solid box as a link; the link's frame is the middle of the box's top face."""
    node.mapping("parent pose size", "drop_height capacity")
    check_link(robot, node["parent"])
    size = node["size"].numbers(3, above=0)
    parent, T_parent_bin = node["parent"].string(), node["pose"].pose()
    box = LinkShape(Box(size), _core.pose([0, 0, -size[2] / 2]))
    with node.blamed():
        robot = robot.with_link(BIN_LINK, parent, T_parent_bin, [box])
    T_root_bin = robot.link_poses()[BIN_LINK]
    if T_root_bin[2, 2] < 1 - 1e-9:
        node["pose"].fail("the bin's top face must be level")
    return robot, T_root_bin


def _read_place_region(node: Node, T_root_bin: np.ndarray) -> PlaceRegion:
    size = node["size"].numbers(3, above=0)
    options: dict[str, Any] = {}
    if "drop_height" in node:
        options["drop_height"] = node["drop_height"].number(least=0)
    if "capacity" in node:
        options["capacity"] = node["capacity"].integer(least=1)
        node["capacity"].within((1, MOST_IN_BIN))
    with node.blamed():
        return PlaceRegion(T_root_bin, size[:2], **options)


def _check_joint_owners(sections: RobotSections, arm: JointGroup, gripper: Hand) -> None:
    """A joint is moved by the arm or by the gripper, or keeps the value of the section `joints`."""
    owners = dict.fromkeys(arm.names, "the arm")
    listed = sections.gripper["joints"].elements() if "joints" in sections.gripper else []
    for k, joint in enumerate(gripper.joints):
        if joint.name in owners:
            node = listed[k]["name"] if listed else sections.gripper
            node.fail(f"{joint.name} is a joint of {owners[joint.name]}")
        owners[joint.name] = "the gripper"
    for name, value in _named_numbers(sections.robot, "joints"):
        if name in owners:
            value.fail(f"{name} is a joint of {owners[name]}, which moves it")


def _moved(arm: JointGroup, home: np.ndarray) -> np.ndarray:
    """A configuration in which every joint is a little off home."""
    moved: np.ndarray = home + 0.05 * np.where(home + 0.05 <= arm.upper, 1.0, -1.0)
    return moved


def _check_finger_links(node: Node, arm: JointGroup, tool_link: str, home: np.ndarray) -> None:
    """Fingers belong to the hand: they keep their place beside the tool frame whatever the arm does."""
    before, after = arm.link_poses(home), arm.link_poses(_moved(arm, home))
    for link in node.elements():
        beside = [np.linalg.inv(poses[tool_link]) @ poses[link.raw] for poses in (before, after)]
        if np.abs(beside[0] - beside[1]).max() > 1e-9:
            link.fail("is no part of the hand: it does not move with the tool frame")


def _fixed_to_root(arm: JointGroup, node: Node, home: np.ndarray) -> None:
    before, after = arm.link_poses(home)[node.raw], arm.link_poses(_moved(arm, home))[node.raw]
    if np.abs(before - after).max() > 1e-9:
        node.fail("the bin's parent must not move with the arm")
