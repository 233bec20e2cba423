"""A bottle on a table beside the base's way, taken by one motion of base and arm (P1 4.4, figures 4.10 to 4.12)."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Unpack

import numpy as np

from .. import _core
from .._core import Cylinder, LinkShape, Outcome, Robot, World
from .._options import DriveByOptions
from .execution import ExecutionOptions
from .model import SimPart
from .passing import FINGERS, TIPS, robot_setup
from .result import SimResult
from .simulation import Simulation

TABLE = 0.70  # height of the top [m]
RADIUS, HEIGHT = 0.028, 0.16  # of the bottle [m]
DEPTH = TIPS + RADIUS  # engagement at the grasp [m]
CLEARANCE = 0.001  # a planner takes what touches for a collision [m]
OPENING = 0.08  # of the hand as it comes [m]
GRASP_HEIGHT = 0.07  # above the table [m]
WAY = 4.0  # from start to goal, straight ahead [m]
PLANNED_SPEED = 0.5  # of the base; it can do 0.6 m/s, what is left corrects the way
TOOL_SPEED = 0.3  # of the hand in a push-grasp [m/s]
SIDES = (-0.6, -0.3, -0.9, 0.0, -1.2)  # directions from which the bottle is tried [rad]


@dataclass(frozen=True)
class Bottle:
    """Where it stands, and how it is taken."""

    x: float = 2.0
    y: float = -0.8
    push: bool = True
    """Push-grasp with the hand at TOOL_SPEED, or with the hand still while the base drives on."""

    def world(self) -> World:
        """The table."""
        world = World()
        world.add_box("table", [1.4, 0.5, TABLE], _core.pose([2.0, -0.9, TABLE / 2]))
        return world

    def part(self) -> SimPart:
        """The bottle, standing on it."""
        pose = _core.pose([self.x, self.y, TABLE + HEIGHT / 2])
        return SimPart("bottle", [LinkShape(Cylinder(RADIUS, HEIGHT))], pose, mass=0.3)

    def tasks(self, yaw: float) -> list[_core.DriveByTask]:
        """What the hand does, coming from a direction; it closes at the last task."""
        T_grasp = _core.pose([self.x, self.y, TABLE + GRASP_HEIGHT], rpy=[0, 0, yaw])
        if not self.push:
            T_before = T_grasp @ _core.pose([-0.12, 0, 0])
            dwell = (OPENING - 2 * RADIUS) / 0.1 + 0.15
            before = _core.DriveByTask(T_before, tolerance=[0.005] * 3 + [0.03] * 3)
            return [before, _core.DriveByTask(T_grasp, dwell=dwell, object="bottle")]
        push = {
            "opening": OPENING,
            "object_width": 2 * RADIUS,
            "finger_length": FINGERS,
            "planned_depth": DEPTH,
            "tool_speed": TOOL_SPEED,
            "max_push": 0.02,
            "along_error": 0.02,
            "approach": robot_setup().gripper.approach,
        }
        return [_core.DriveByTask(T_grasp, object="bottle", push=push)]

    def plan(self, **options: Unpack[DriveByOptions]) -> tuple[_core.DriveByResult, float]:
        """The motion and the time at which the hand begins to close [s]; the first direction that works is taken."""
        setup = robot_setup()
        robot = planned_robot()
        world = self.world()
        part = self.part()
        world.add(part.name, part.shapes, _core.pose([0, 0, CLEARANCE]) @ part.pose)
        group = robot.group("arm_with_torso", tip=setup.gripper.tool_link, with_base=True)
        group = group.with_reference({**setup.other_joints, **setup.gripper.joint_values(OPENING)})
        start, goal = [0.0, 0.0, 0.0, *setup.home], [WAY, 0.0, 0.0, *setup.home]
        options.setdefault("waypoints", 55)
        for yaw in SIDES:
            tasks = self.tasks(yaw)
            found = _core.plan_drive_by(robot, group, world, start=start, tasks=tasks, goal=goal, **options)
            if found.outcome == Outcome.solved:
                return found, float(found.events[-1]["close_time"])
        return found, 0.0

    def simulation(self) -> Simulation:
        """Robot, table and bottle in physics."""
        setup = robot_setup()
        return Simulation(setup.robot, self.world(), [self.part()], gripper=setup.gripper, joints=setup.other_joints)

    def run(self, found: _core.DriveByResult, close_at: float, /, **execution: Unpack[ExecutionOptions]) -> SimResult:
        """The motion carried out with a little noise of wheels and localisation; the bottle rides along, then 2 s more."""
        keywords: ExecutionOptions = {
            "close_at": close_at,
            "opening": OPENING,
            "travel_noise": 0.003,
            "position_noise": 0.002,
            "heading_noise": 0.002,
            **execution,
        }
        return self.simulation().run(found.trajectory.sampled(between=9), **keywords)


@functools.cache
def planned_robot() -> Robot:
    """The robot whose base is planned a little slower than it is."""
    robot = robot_setup().robot
    limits = {**robot.base_limits, "linear_velocity": PLANNED_SPEED}
    return Robot.from_strings(
        robot.to_urdf(),
        robot.to_srdf(),
        base=robot.base,
        base_limits={k: v for k, v in limits.items() if np.isfinite(v)},
    )
