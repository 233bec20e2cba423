"""A robot's links and joints as a tree, and boxes around links."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from ..._core import LinkShape, Robot


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

    def axis(self, name: str) -> np.ndarray:
        """Unit axis of a joint that turns, in the root frame when all joints are 0."""
        joint = self.joints[name]
        parent, child = joint["parent"], joint["child"]
        step = min(0.5, 0.5 * (joint["upper"] - joint["lower"]))
        start = min(max(0.0, joint["lower"]), joint["upper"] - step)
        before, after = (self.robot.link_poses({name: value}) for value in (start, start + step))
        R = before[parent][:3, :3] @ (np.linalg.inv(after[parent]) @ after[child])[:3, :3] @ before[child][:3, :3].T
        axis = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
        return np.asarray(axis / max(float(np.linalg.norm(axis)), 1e-12))


def box_around(
    robot: Robot, poses: Mapping[str, np.ndarray], links: Iterable[str], frame: str | None = None
) -> tuple[np.ndarray, np.ndarray] | None:
    """Lowest and highest corner of the box around the shapes of links, along the axes of a link's frame or of the root; None: no shapes."""
    T_frame_root = np.eye(4) if frame is None else np.linalg.inv(poses[frame])
    boxes = [
        LinkShape(shape.shape, T_frame_root @ poses[link] @ shape.pose).bounds
        for link in links
        for shape in robot.collisions(link)
    ]
    if not boxes:
        return None
    return np.min([low for low, _ in boxes], axis=0), np.max([high for _, high in boxes], axis=0)
