"""The tool frame of a hand, and where a gripper belongs on an arm that has none."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from ..._core import Hand, InvalidInput, Robot, pose
from .arm import Arm
from .tree import Tree, box_around

_FARTHEST = 0.06  # finger tips reach at most so far past a tool frame that lies between the pads [m]
_TOOL_WORDS = re.compile(r"tcp|tool|grasp|eef|(^|_)ee(_|$)|grip.*(point|cent)", re.IGNORECASE)
_PAD = 0.02  # a tool frame of ours lies so far behind the finger tips, or half way to the palm [m]
_AMONG = 0.01  # a tool frame lies at most so far outside of the box around the fingers [m]
_TOLD = 0.01  # links farther apart along an axis tell which way it points [m]
TOOL_FRAME = "tool_frame"


@dataclass
class Tool:
    """The tool frame, and the hand measured in it."""

    link: str
    frame: dict[str, object] | None  # an entry of `frames`, where the robot has no fitting link
    gripper: dict[str, object]  # the scenario's section
    hand: Hand


def find_tool(robot: Robot, arm: Arm, link: str | None) -> Tool | None:
    """Tool frame and hand: the link asked for, a link whose name says so, else a frame between the finger tips; None: no fingers."""
    if not arm.hand_joints:
        return None
    tree = Tree(robot)
    members = tree.members(tree.body(arm.hand_link))
    named = [link] if link is not None else [m for m in members if _TOOL_WORDS.search(m)]
    failures = []
    for candidate in named:
        try:
            hand = Hand.from_robot(robot, candidate)
        except InvalidInput as error:
            failures.append(str(error))
            continue
        if link is not None or (hand.finger_depth / 2 <= _FARTHEST and _among_fingers(robot, tree, arm, candidate)):
            return Tool(candidate, None, {"from_robot": True}, hand)
    if link is None:
        for parent, T, approach in _frames_between_tips(robot, tree, arm):
            try:
                hand = Hand.from_robot(robot.with_link(TOOL_FRAME, parent, T), TOOL_FRAME, approach=approach)
            except InvalidInput as error:
                failures.append(str(error))
                continue
            frame: dict[str, object] = {
                "name": TOOL_FRAME,
                "parent": parent,
                "pose": {"xyz": _plain(T[:3, 3])},
            }
            return Tool(TOOL_FRAME, frame, {"from_robot": True, "approach": _plain(approach)}, hand)
    why = failures[-1] if failures else f"{robot.name}: the fingers at {arm.hand_link} have no shapes"
    raise InvalidInput(
        f"{why}. (A first scenario needs a hand that can be measured: another tool frame, by --tool-link, or a URDF without this hand, on which the shipped gripper is put.)"
    )


def _among_fingers(robot: Robot, tree: Tree, arm: Arm, link: str) -> bool:
    """Whether a link's origin lies in the box around the fingers, half closed."""
    body = tree.body(arm.hand_link)
    poses = robot.link_poses(_half_closed(tree, arm))
    fingers = box_around(robot, poses, _finger_links(tree, arm), body)
    at = (np.linalg.inv(poses[body]) @ poses[link])[:3, 3]
    return fingers is not None and bool(((at > fingers[0] - _AMONG) & (at < fingers[1] + _AMONG)).all())


def _half_closed(tree: Tree, arm: Arm) -> dict[str, float]:
    drives = [n for n in arm.hand_joints if tree.joints[n]["mimic"] is None]
    half = {n: 0.5 * (tree.joints[n]["lower"] + tree.joints[n]["upper"]) for n in drives}
    return {n: v if np.isfinite(v) else 0.0 for n, v in half.items()}


def _finger_links(tree: Tree, arm: Arm) -> list[str]:
    return [m for n in arm.hand_joints for m in tree.members(tree.joints[n]["child"])]


def flange(robot: Robot, arm: Arm) -> tuple[str, np.ndarray]:
    """Where a gripper is put on an arm without one: the last body's link, and a frame in it whose x lies along the last joint's axis, outwards, at the end of its shapes."""
    tree = Tree(robot)
    last = tree.joints[arm.joints[-1]]
    body = last["child"]
    poses = robot.link_poses()
    turns = last["type"] != "prismatic"
    axis = tree.axis(last["name"]) if turns else poses[body][:3, 0]
    axis = poses[body][:3, :3].T @ axis
    members = tree.members(body)
    ends = [np.linalg.inv(poses[body]) @ poses[m][:, 3] for m in members]
    box = box_around(robot, poses, members, body)
    before = (np.linalg.inv(poses[body]) @ poses[last["parent"]][:, 3])[:3]
    hints = [-before, max((e[:3] for e in ends), key=np.linalg.norm), (box[0] + box[1]) / 2 if box else -before]
    along = next((float(h @ axis) for h in hints if abs(h @ axis) > _TOLD), 1.0)
    axis = axis if along > 0 else -axis
    solid = float(np.maximum(box[0] * axis, box[1] * axis).sum()) if box else 0.0  # the farthest corner of the box
    reach = max(solid, 0.0, *(float(e[:3] @ axis) for e in ends))
    across = np.eye(3)[int(np.argmin(np.abs(axis)))]
    y = np.cross(axis, across) / np.linalg.norm(np.cross(axis, across))
    T = np.eye(4)
    T[:3, :3] = np.column_stack([axis, y, np.cross(axis, y)])
    T[:3, 3] = reach * axis
    return body, T


def _plain(axis: np.ndarray) -> list[float]:
    return [round(float(x), 9) + 0.0 for x in axis]


def _frames_between_tips(robot: Robot, tree: Tree, arm: Arm) -> list[tuple[str, np.ndarray, np.ndarray]]:
    """Frames on the hand's body between the finger tips: (parent link, pose in it, approach), likeliest first."""
    body = tree.body(arm.hand_link)
    poses = robot.link_poses(_half_closed(tree, arm))
    fingers, palm = (box_around(robot, poses, links, body) for links in (_finger_links(tree, arm), tree.members(body)))
    if fingers is None:
        return []
    low, high = fingers
    out = (low + high) / 2 - ((palm[0] + palm[1]) / 2 if palm is not None else 0)
    frames = []
    for axis in np.argsort(-np.abs(out)):
        approach = np.zeros(3)
        approach[axis] = 1.0 if out[axis] >= 0 else -1.0
        tip = high[axis] if approach[axis] > 0 else low[axis]
        length = high[axis] - low[axis]
        at = (low + high) / 2
        at[axis] = tip - approach[axis] * min(_PAD, length / 4)
        frames.append((body, pose(np.round(at, 4)), approach))
    return frames
