"""The section `path` of a pipe problem: the poses that the pipe must follow, given or generated."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from .._argument_errors import checked
from .._turns import between, rotation_about, rotation_vector
from ..documents.reading import Node

MOST_POSES = 2000
SAME_PLACE, SAME_TURN = 1e-6, 1e-6  # [m], [rad]


@checked
def line_poses(start: np.ndarray, end: np.ndarray, count: int) -> list[np.ndarray]:
    """`count` poses after `start`, evenly on the straight way to `end`, the last of them `end`."""
    return [between(start, end, i / count) for i in range(1, count + 1)]


@checked
def arc_poses(
    start: np.ndarray, centre: np.ndarray, axis: np.ndarray, angle: float, count: int, turns: bool = True
) -> list[np.ndarray]:
    """`count` poses after `start`, evenly on an arc about an axis through `centre`; the pipe turns with it unless `turns` is false."""
    unit = np.asarray(axis, float) / np.linalg.norm(axis)
    poses = []
    for i in range(1, count + 1):
        R = rotation_about(unit * (angle * i / count))
        T = start.copy()
        T[:3, 3] = centre + R @ (start[:3, 3] - centre)
        if turns:
            T[:3, :3] = R @ start[:3, :3]
        poses.append(T)
    return poses


def read_path(root: Node) -> np.ndarray:
    """(m, 4, 4), the first where the pipe lies."""
    start = root["start"].pose()
    node = root["path"].mapping("", "poses segments")
    if ("poses" in node) == ("segments" in node):
        node.fail("must have either poses or segments")
    if "poses" in node:
        poses = _listed(node["poses"], start)
    else:
        poses = [start]
        for segment in node["segments"].elements():
            poses += _segment(segment, poses[-1])
    if len(poses) < 2:
        node.fail("must have at least two poses, the start and another")
    if len(poses) > MOST_POSES:
        node.fail(f"has {len(poses)} poses: must be at most {MOST_POSES}")
    for i, (a, b) in enumerate(pairwise(poses)):
        if np.linalg.norm(rotation_vector(a[:3, :3].T @ b[:3, :3])) > np.pi - 1e-3:
            node.fail(
                f"turns by half a turn or more from pose {i} to pose {i + 1}: which way round? give poses between"
            )
    return np.array(poses)


def _listed(node: Node, start: np.ndarray) -> list[np.ndarray]:
    elements = node.elements()
    poses = [element.pose() for element in elements]
    if not poses:
        node.fail("must not be empty")
    away = float(np.linalg.norm(poses[0][:3, 3] - start[:3, 3]))
    turned = float(np.linalg.norm(rotation_vector(start[:3, :3].T @ poses[0][:3, :3])))
    if away > SAME_PLACE or turned > SAME_TURN:
        elements[0].fail(
            f"the first pose of the path must be the start; it is {away:.6g} m and {turned:.6g} rad away from it"
        )
    return poses


def _segment(node: Node, last: np.ndarray) -> list[np.ndarray]:
    node.mapping("", "line arc")
    if ("line" in node) == ("arc" in node):
        node.fail("must be either a line or an arc")
    if "line" in node:
        line = node["line"].mapping("to poses")
        return line_poses(last, line["to"].pose(), _count(line["poses"]))
    arc = node["arc"].mapping("centre axis angle poses", "turns")
    axis = np.array(arc["axis"].numbers(3))
    if np.linalg.norm(axis) < 1e-6:
        arc["axis"].fail("must be a direction other than 0, 0, 0")
    angle = arc["angle"].number()
    if abs(angle) < 1e-6:
        arc["angle"].fail("must not be zero")
    count = _count(arc["poses"])
    if abs(angle) / count > np.pi - 1e-3:
        arc["angle"].fail(
            f"{count} poses turn by half a turn or more from one to the next: it is in radians, or give more"
        )
    turns = arc["turns"].boolean() if "turns" in arc else True
    return arc_poses(last, np.array(arc["centre"].numbers(3)), axis, angle, count, turns)


def _count(node: Node) -> int:
    count = node.integer(least=1)
    if count > MOST_POSES:
        node.fail(f"must be at most {MOST_POSES}")
    return count
