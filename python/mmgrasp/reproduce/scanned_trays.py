"""Trays of parts thrown in at random and checked from above: what their base regions are planned for (P1 3.5.2, 3.7.2)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .. import _core
from .._core import Box, Grasp, LinkShape, Part
from ..problems.random_trays import RandomTrayScan, parts_of_grasps, scan_random_tray, scan_tray
from .setup import Row, robot_setup

BODY = [LinkShape(Box([0.03, 0.03, 0.05]), np.eye(4))]
COUNT = 12  # parts of a full tray, as many as P1's 3x4
SCANS = 4  # P1 3.7.2
FILLS = (100, 75, 50, 25)  # P1 3.5.2 [%]
REGULAR = (  # what describe() tells of objects on a grid
    "objects",
    "grasps per object",
    "tool above the tray's floor [m]",
    "approach tilted from straight down [rad]",
    "closing direction against the row [rad]",
)
SETUP = {
    "part [m]": (0.03, 0.03, 0.05),
    "parts of a full tray": COUNT,
    "grasps": "fast graspability evaluation of a depth image from 0.8 m, depth noise 0.5 mm",
}


def scan_seed(seed: int, tray: int, scan: int) -> int:
    return (seed * 1000 + tray) * 10 + scan


def random_scan(row: Row, tray: int, scan: int, seed: int, fill: int = 100) -> RandomTrayScan:
    """A random filling of which `fill` percent are left, another one for every number of scan."""
    gripper = robot_setup(row.torso).gripper
    chosen = scan_seed(seed, tray, scan)
    return scan_random_tray(BODY, row.tray_size, gripper, count=COUNT, fill=fill / 100, seed=chosen)


def parts_from(row: Row, tray: int, grasps: Sequence[Grasp]) -> list[Part]:
    """One part a grasp, for the row's planning problem."""
    pose = row.tray_pose(row.tray_middles()[tray])
    return parts_of_grasps(str(tray), grasps, robot_setup(row.torso).gripper, pose)


def emptied_best_first(row: Row, tray: int, seed: int) -> list[Grasp | None]:
    """The grasps by which a full tray is emptied: in each round the best one that a new image of what is left shows.

    None in a round whose image shows no grasp; the parts then stay.
    """
    gripper = robot_setup(row.torso).gripper
    left = [np.array(p.T_tray_part) for p in random_scan(row, tray, SCANS, seed).placement.parts]
    taken: list[Grasp | None] = []
    for turn in range(COUNT):
        chosen = scan_seed(seed, tray, SCANS) + 100_000 * (turn + 1)
        found = scan_tray(BODY, left, row.tray_size, gripper, seed=chosen).grasps if left else []
        taken.append(found[0] if found else None)
        if found:
            held = found[0].T_object_hand[:3, 3]
            left.pop(int(np.argmin([np.linalg.norm(pose[:3, 3] - held) for pose in left])))
    return taken


def part_cells(
    row: Row, parts: Sequence[Sequence[Part]], reach: _core.ReachDatabase, grid: _core.BaseGrid
) -> _core.ObjectRegions:
    """[tray][part]: the cells from which that part can be grasped."""
    return _core.ObjectRegions.compute(row.problem(parts), reach, grid)
