"""Which joints of a robot are its arm, which its hand, and where the tool frame belongs."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

import numpy as np

from ..._core import Hand, InvalidInput, LinkShape, Robot, pose
from ...documents.reading import near_miss
from .drive import joint_axis

_LEAST_ARM = 4  # joints
_JAW = re.compile(r"grip|finger|jaw|claw|thumb", re.IGNORECASE)
_FARTHEST = 0.06  # finger tips reach at most so far past a tool frame that lies between the pads [m]
_TOOL_WORDS = re.compile(r"tcp|tool|grasp|eef|(^|_)ee(_|$)|grip.*(point|cent)", re.IGNORECASE)
_PAD = 0.02  # a tool frame of ours lies so far behind the finger tips, or half way to the palm [m]
_AMONG = 0.01  # a tool frame lies at most so far outside of the box around the fingers [m]
_TOLD = 0.01  # links farther apart along an axis tell which way it points [m]
TOOL_FRAME = "tool_frame"


@dataclass
class Arm:
    """The arm and hand that were chosen."""

    base_link: str
    joints: list[str]
    hand_link: str  # the arm's last body, where a hand's joints begin or a gripper is mounted
    hand_joints: list[str]
    group: str | None = None  # of the SRDF
    others: list[str] = field(default_factory=list)  # links at the ends of arms that were not chosen


@dataclass
class Tool:
    """The tool frame, and the hand measured in it."""

    link: str
    frame: dict[str, object] | None  # an entry of `frames`, where the robot has no fitting link
    gripper: dict[str, object]  # the scenario's section
    hand: Hand


class Tree:
    """Links and joints of a robot as a tree."""

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self.joints = {joint["name"]: joint for joint in robot.joint_table}
        self.into = {joint["child"]: joint["name"] for joint in robot.joint_table}
        self.out: dict[str, list[str]] = {link: [] for link in robot.links}
        for joint in robot.joint_table:
            self.out[joint["parent"]].append(joint["name"])

    def movable(self, name: str) -> bool:
        """Whether the joint is not fixed; one that follows another counts."""
        return self.joints[name]["type"] != "fixed"

    def path(self, link: str) -> list[str]:
        """Movable joints from the root to a link."""
        names = []
        while link in self.into:
            name = self.into[link]
            if self.movable(name):
                names.append(name)
            link = self.joints[name]["parent"]
        return names[::-1]

    def body(self, link: str) -> str:
        """The first link of the rigid body that a link belongs to."""
        while link in self.into and not self.movable(self.into[link]):
            link = self.joints[self.into[link]]["parent"]
        return link

    def members(self, link: str) -> list[str]:
        """Links of the rigid body that begins with a link."""
        found, open_ = [], [link]
        while open_:
            found.append(open_.pop())
            open_ += [self.joints[n]["child"] for n in self.out[found[-1]] if not self.movable(n)]
        return found

    def below(self, link: str) -> list[str]:
        """Movable joints that begin at the rigid body of a link."""
        return [n for member in self.members(self.body(link)) for n in self.out[member] if self.movable(n)]

    def all_below(self, link: str) -> list[str]:
        """Every movable joint beyond the rigid body of a link."""
        found, open_ = [], self.below(link)
        while open_:
            found.append(open_.pop(0))
            open_ += self.below(self.joints[found[-1]]["child"])
        return found

    def depth(self, link: str) -> int:
        """The most movable joints on a way from a link to a leaf."""
        return max((1 + self.depth(self.joints[n]["child"]) for n in self.below(link)), default=0)


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
    return len(below) > 1 or (
        tree.depth(link) == 1 and any(_JAW.search(f"{n} {tree.joints[n]['child']}") for n in below)
    )


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
                "pose": {"xyz": [round(float(x), 4) for x in T[:3, 3]]},
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
    low, high = _bounds(robot, poses, body, _finger_links(tree, arm))
    at = (np.linalg.inv(poses[body]) @ poses[link])[:3, 3]
    return bool(((at > low - _AMONG) & (at < high + _AMONG)).all())


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
    axis = joint_axis(robot, last["name"], last["parent"], body) if turns else poses[body][:3, 0]
    axis = poses[body][:3, :3].T @ axis
    members = tree.members(body)
    ends = [np.linalg.inv(poses[body]) @ poses[m][:, 3] for m in members]
    low, high = _bounds(robot, poses, body, members)
    before = (np.linalg.inv(poses[body]) @ poses[last["parent"]][:, 3])[:3]
    solid = np.isfinite(low).all()
    hints = [-before, max((e[:3] for e in ends), key=np.linalg.norm), (low + high) / 2 if solid else -before]
    along = next((float(h @ axis) for h in hints if abs(h @ axis) > _TOLD), 1.0)
    axis = axis if along > 0 else -axis
    corners = np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(3, -1).T if solid else np.zeros((1, 3))
    reach = max(float((corners @ axis).max()), 0.0, *(float(e[:3] @ axis) for e in ends))
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
    low, high = _bounds(robot, poses, body, _finger_links(tree, arm))
    palm_low, palm_high = _bounds(robot, poses, body, tree.members(body))
    if not np.isfinite(low).all():
        return []
    out = (low + high) / 2 - ((palm_low + palm_high) / 2 if np.isfinite(palm_low).all() else 0)
    frames = []
    for axis in np.argsort(-np.abs(out)):
        approach = np.zeros(3)
        approach[axis] = 1.0 if out[axis] >= 0 else -1.0
        tip = high[axis] if approach[axis] > 0 else low[axis]
        length = high[axis] - low[axis]
        at = (low + high) / 2
        at[axis] = tip - approach[axis] * min(_PAD, length / 4)
        frames.append((body, pose(at), approach))
    return frames


def _bounds(robot: Robot, poses: dict[str, np.ndarray], frame: str, links: list[str]) -> tuple[np.ndarray, np.ndarray]:
    """The box around the shapes of links, along the axes of a link's frame."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for link in links:
        T = np.linalg.inv(poses[frame]) @ poses[link]
        for shape in robot.collisions(link):
            a, b = LinkShape(shape.shape, T @ shape.pose).bounds
            low, high = np.minimum(low, a), np.maximum(high, b)
    return low, high
