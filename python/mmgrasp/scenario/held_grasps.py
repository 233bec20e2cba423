"""Grasps at which closing fingers meet the part."""

from __future__ import annotations

from .. import _core
from .._core import Grasp, Hand, LinkShape, Robot

CLOSING_PLAY = "10 mm or a quarter of it"
"""How far below a part's width fingers may close to meet it: verify::narrowest_grip() in words."""


def held(robot: Robot, gripper: Hand, shapes: list[LinkShape], grasps: list[Grasp]) -> list[Grasp]:
    """Those of the grasps at which the closing fingers meet the part, as `verify` asks."""
    meet = _core.fingers_meet(robot, gripper, shapes, grasps)
    return [grasp for grasp, meets in zip(grasps, meet, strict=True) if meets]
