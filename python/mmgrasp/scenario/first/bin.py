"""A place for an open bin on a robot, which its hand reaches from above."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from ..._core import Hand, JointGroup, LinkShape, Outcome, Robot, World, pose
from ..._progress import Progress
from .standing import Outline

BIN_SIZE = np.array([0.24, 0.20, 0.10])
DROP_HEIGHT = 0.03
_MARGIN = 0.01  # bodies that do not belong together keep so far apart [m]
_ABOVE_BIN = 0.08  # the tool frame is tried so far above the bin's top face [m]
_HEIGHTS = (0.35, 0.5, 0.65, 0.8)  # of its top face above the ground where it hangs beside the base [m]
_LOWEST, _HIGHEST = 0.15, 1.2  # of its bottom and its top face above the ground [m]
_HIGH = 0.9  # places whose top face lies higher come last [m]
_BESIDE = 0.02  # how far beside the base it hangs [m]
_CELL = 0.06  # from place to place [m]
_PLACES = 150  # at most so many are tried
TURNS = 4  # of the hand about the vertical that are tried


@dataclass
class Bin:
    """Where an open bin may be fixed: the middle of its top face in the parent's frame."""

    parent: str
    xyz: np.ndarray
    reached: float  # share of the tried hand poses above it that the arm reaches


def find_bin(
    robot: Robot, group: JointGroup, home: np.ndarray, hand: Hand, outline: Outline, progress: Progress = None
) -> Bin | None:
    """The place on the base, or beside it, above which the arm reaches most hand poses that look down; None: nowhere any."""
    parent = robot.links[0]
    best: Bin | None = None
    places = _bin_places(robot, group, home, outline)
    for i, place in enumerate(places):
        if progress is not None:
            progress("looking for a place for the bin", i / len(places))
        world = World()
        world.add_box("bin", BIN_SIZE, pose(place - [0, 0, BIN_SIZE[2] / 2]))
        reached = 0
        for turn in range(TURNS):
            T = looking_down(hand, place + [0, 0, _ABOVE_BIN], 2 * np.pi * turn / TURNS)
            reached += group.ik(T, home, world, restarts=8).outcome == Outcome.solved
        if best is None or reached / TURNS > best.reached:
            best = Bin(parent, place, reached / TURNS)
        if reached == TURNS:
            break
    return best if best is not None and best.reached > 0 else None


def looking_down(hand: Hand, point: np.ndarray, turn: float) -> np.ndarray:
    """A pose of the tool frame at a point with the approach axis downwards, turned about it [rad]."""
    axes = np.column_stack([hand.approach, hand.closing, np.cross(hand.approach, hand.closing)])
    c, s = np.cos(turn), np.sin(turn)
    wanted = np.column_stack([[0, 0, -1], [c, s, 0], np.cross([0, 0, -1], [c, s, 0])])
    T = np.eye(4)
    T[:3, :3] = wanted @ axes.T
    T[:3, 3] = point
    return T


def _bin_places(robot: Robot, group: JointGroup, home: np.ndarray, outline: Outline) -> list[np.ndarray]:
    """Middles of the bin's top face where it touches nothing: those that stick out least first, from behind to the front; on the base, or beside it at one of some heights."""
    poses = group.link_poses(home)
    boxes = [
        LinkShape(shape.shape, T @ shape.pose).bounds for link, T in poses.items() for shape in robot.collisions(link)
    ]
    low, high = outline.low[:2] - BIN_SIZE[:2] / 2 - _BESIDE, outline.high[:2] + BIN_SIZE[:2] / 2 + _BESIDE
    half = BIN_SIZE[:2] / 2 + _MARGIN
    found = []
    for x, y in itertools.product(
        *(np.linspace(a, b, max(2, int(np.ceil((b - a) / _CELL)) + 1)) for a, b in zip(low, high, strict=True))
    ):
        middle = np.array([x, y])
        under = [b for b in boxes if (np.abs(middle - np.clip(middle, b[0][:2], b[1][:2])) < half).all()]
        ground = float(outline.low[2])
        tops = {round(float(b[1][2]) + BIN_SIZE[2] + _MARGIN, 3) for b in under} | {ground + h for h in _HEIGHTS}
        sticks = float(
            outline.outside(
                np.array([middle + np.array(s) * BIN_SIZE[:2] / 2 for s in itertools.product((-1, 1), repeat=2)])
            ).max()
        )
        for top in sorted(tops):
            bottom = top - BIN_SIZE[2]
            free = all(b[1][2] <= bottom - 0.5 * _MARGIN or b[0][2] >= top + 0.5 * _MARGIN for b in under)
            stands = bool(under) and any(b[1][2] <= bottom for b in under)
            if free and ground + _LOWEST <= bottom and top <= ground + _HIGHEST and (stands or sticks > 0):
                found.append((round(sticks, 2), top > ground + _HIGH, x, abs(y), np.array([x, y, top])))
    found.sort(key=lambda f: f[:4])
    return [np.round(f[4], 3) for f in found[:_PLACES]]
