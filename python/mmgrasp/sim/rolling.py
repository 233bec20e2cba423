"""The wheels and casters that a base rolls on in physics."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .._core import InvalidInput, Robot
from ..scenario.first.drive import find_wheels
from ..scenario.first.tree import box_around

BASE_JOINTS = ("base/x", "base/y", "base/theta")  # of a base that is pushed
ROOT_JOINT = "base/free"  # of one that rolls
CASTER_RADIUS = 0.03  # [m]
TYRES = "0.02 1"  # contacts of wheels and casters give (solref): hard ones hop, since four of them stand on one plane


@dataclass
class RollingBase:
    """Two driven wheels on one axle and casters: what the robot rolls on in place of being moved."""

    left: str
    """Joint of the left wheel."""
    right: str
    radius: float
    """[m]"""
    track: float
    """Between the wheels [m]."""
    height: float = 0.0
    """Height of the wheels' lowest points in the root's frame [m]."""
    casters: tuple[tuple[float, float], ...] = ((0.22, 0.0), (-0.22, 0.0))
    """Where they touch the ground, in the root's frame [m]."""
    friction: float = 0.9
    """Coefficient of the wheels on the floor."""

    @classmethod
    def of_robot(cls, robot: Robot) -> RollingBase:
        """The wheels of a robot, by its joints and shapes. Raises InvalidInput unless they are two on one axle."""
        wheels = find_wheels(robot)
        if robot.base != "diff_drive" or len(wheels) != 2:
            raise InvalidInput(
                f"{robot.name}: {len(wheels)} wheels and base {robot.base}: two wheels of a diff_drive base can roll"
            )
        right, left = sorted(wheels, key=lambda name: float(wheels[name].middle[1]))
        links = {j["name"]: j["child"] for j in robot.joint_table}
        box = box_around(robot, robot.link_poses(), [links[left]])
        if box is None:
            raise InvalidInput(f"{robot.name}: the wheel {links[left]} has no shape")
        track = float(wheels[left].middle[1] - wheels[right].middle[1])
        return cls(left, right, float(box[1][2] - box[0][2]) / 2, track, float(box[0][2]))

    def check(self, robot: Robot) -> None:
        """Raises InvalidInput naming field, value and rule."""
        for name in ("radius", "track", "friction"):
            value = float(getattr(self, name))
            if not (np.isfinite(value) and value > 0):
                raise InvalidInput(f"rolling.{name} = {value!r}: must be finite and positive")
        for name in (self.left, self.right):
            if name not in robot.joints:
                raise InvalidInput(f"rolling: the robot has no movable joint '{name}'")
        if robot.base != "diff_drive":
            raise InvalidInput(f"rolling: the base is {robot.base}, two wheels are a diff_drive's")
        if not np.isfinite(self.height):
            raise InvalidInput(f"rolling.height = {self.height!r}: must be finite")
        if not self.casters or not np.isfinite(np.asarray(self.casters, float)).all():
            raise InvalidInput(f"rolling.casters = {self.casters!r}: must be places (x, y), at least one")
