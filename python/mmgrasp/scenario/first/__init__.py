"""A first scenario for a robot that nobody described to mmgrasp: what its URDF tells is read, the rest is chosen and said in comments.

`first_scenario` is what `mmgrasp init` calls.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ... import _core
from ..._core import JointGroup, LinkShape, Robot
from ..._progress import Progress
from ...documents.reading import Document
from ..closed_fingers import fingers_may_meet
from ..floor_map import read_floor_map
from ..robot_section import BIN_LINK
from .bin import BIN_SIZE, Bin, find_bin
from .robot_files import FirstRobot, read_robot, relative
from .room import counter_height, fitting_part, place_room
from .standing import Home, find_home, outline_of
from .text import MAP_HEIGHT, Choices, scenario_text

_SELDOM = 0.5  # a counter of which a smaller share is reached is doubtful


@dataclass
class FirstScenario:
    """The scenario's text, what was found and why, and what a person should look at."""

    text: str
    found: list[str]
    doubts: list[str]


def first_scenario(
    urdf: str | os.PathLike[str],
    floor_map: str | os.PathLike[str] | None = None,
    *,
    folder: str | os.PathLike[str] = ".",
    srdf: str | os.PathLike[str] | None = None,
    package_dirs: Mapping[str, str] | None = None,
    xacro_args: Mapping[str, str] | None = None,
    mounts: Sequence[tuple[str, str]] = (),
    base: str | None = None,
    group: str | None = None,
    tool_link: str | None = None,
    progress: Progress = None,
) -> FirstScenario:
    """A scenario to begin with: the robot as its files tell, a bin on it, and a counter with two trays that it reaches.

    `urdf`: a URDF or .xacro file, `asset:...` for a shipped one. `floor_map`: the YAML file of a map (map_server, SLAM) in
    whose free space the counter is put. `folder`: where the scenario will lie; paths in it are relative to that. `srdf`: without it one of the
    same name beside the URDF or in ../srdf is taken. `mounts`: (file, link) of robots put on a link, as an arm on a base.
    `base`: diff_drive or omni; None: told from the wheels. `group`, `tool_link`: the arm and the tool frame; None: the longest arm, and a frame between
    its finger tips. A robot without fingers gets the shipped parallel gripper. InvalidInput, IoError: one message with what was looked for and what would help.
    """
    at = Path(folder)
    given = read_robot(urdf, at, srdf, dict(package_dirs or {}), dict(xacro_args or {}), mounts, base, group, tool_link)
    hand, wheels, doubts = given.tool.hand, given.drive.wheels, given.doubts
    robot = fingers_may_meet(_core.with_sampled_pairs(given.robot, progress=progress), hand)
    outline = outline_of(robot, wheels)
    home = find_home(robot, given.arm, _arm_of(robot, given), hand, wheels, outline, progress)
    joints = _arm_of(robot, given, home)
    q = np.array([home.arm[name] for name in joints.names])
    place = find_bin(robot, joints, q, hand, outline, progress)
    if place is None:
        doubts.append(
            "no place for a bin was found that the hand reaches from above: put one where it does (place_region), or have parts carried in the hand (unload_region)"
        )
        place = Bin(robot.links[0], np.array([outline.low[0] - BIN_SIZE[0], 0.0, outline.low[2] + 0.5]), 0.0)
    box = LinkShape(_core.Box(BIN_SIZE), _core.pose([0, 0, -BIN_SIZE[2] / 2]))
    joints = _arm_of(robot.with_link(BIN_LINK, place.parent, _core.pose(place.xyz), [box]), given, home)
    part = fitting_part(robot, hand)
    height, reached = counter_height(joints, hand, q, outline, part, progress)
    if reached < _SELDOM:
        doubts.append(
            f"the arm reaches {reached:.0%} of the places in a tray on the best counter that was tried ({height:g} m high): move the trays to where it works"
        )
    map_file = None if floor_map is None else relative(floor_map, at)
    walls = None if map_file is None else _read_walls(map_file, at)
    layout = place_room(outline, walls)
    doubts += layout.doubts
    text = scenario_text(given, Choices(home, place, part, height, float(outline.low[2]), layout, map_file))
    return FirstScenario(text, [*given.found, *_what_was_chosen(given, home, place, height, reached)], doubts)


def _arm_of(robot: Robot, given: FirstRobot, home: Home | None = None) -> JointGroup:
    """The arm, with the hand closed; what else moves stands as at home."""
    joints = robot.group(base_link=given.arm.base_link, tip=given.tool.link)
    others = {} if home is None else home.others
    return joints.with_reference({**others, **given.tool.hand.joint_values(0.0)})


def _read_walls(map_file: str, folder: Path) -> list[LinkShape]:
    raw = {"map": map_file, "height": MAP_HEIGHT}
    return read_floor_map(Document(str(folder / "the scenario"), raw, {}).root)


def _what_was_chosen(given: FirstRobot, home: Home, place: Bin, height: float, reached: float) -> list[str]:
    arm, hand = given.arm, given.tool.hand
    return [
        f"arm        {len(arm.joints)} joints from {arm.base_link} to {arm.hand_link}"
        + (f"; others end at {', '.join(arm.others)}" if arm.others else ""),
        f"hand       opens {hand.min_opening * 1000:.0f} to {hand.max_opening * 1000:.0f} mm, tool frame {given.tool.link}"
        + (" (made here, between the finger tips)" if given.tool.frame else ""),
        f"home       {home.reason}; sticks out at most {home.overhang * 1000:.0f} mm of the base's outline",
        f"bin        on {place.parent}, reached in {place.reached:.0%} of the tried hand poses",
        f"counter    {height:g} m high: {reached:.0%} of the places in a tray are reached from one place of the base",
    ]
