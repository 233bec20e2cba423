"""A trial of P1 4.3: the base drives along a table without stopping, the hand held out to its side takes a box on the way.

The plan is made by hand: the arm keeps its posture while the hand meets the box, so that speed, error and moment of closing are the
only things that change.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Unpack

import numpy as np

from .. import _core
from .._core import Box, JointTrajectory, LinkShape, PushGrasp, World
from .._files import shipped
from ..documents.reading import read_yaml
from ..scenario.robot_section import RobotSetup, choose_sections, read_setup
from .execution import ExecutionOptions
from .model import SimPart
from .result import SimResult
from .simulation import Simulation

FULL_SPEED = 0.5  # of base and hand along the table [m/s]
TABLE = 0.70  # height of the top [m]
TOOL = (0.5, -0.75, 0.765)  # of the tool centre point in the base's frame [m]
SIZE = (0.05, 0.05, 0.12)  # of the box [m]
PLACE = (2.0, -0.75)  # where it is planned to stand [m]
TIPS = 0.02  # beyond the tool centre point [m]
FINGERS = 0.12  # from palm to tips [m]
ACCELERATION = 0.5  # of the base [m/s^2]
AFTER = 0.25  # goes on this long after the fingers should have met [s]


@dataclass(frozen=True)
class Passing:
    """One trial."""

    share: float = 1.0
    """Share of FULL_SPEED, in (0, 1]."""
    push: bool = True
    """Push-grasp, or plain closing so that both fingers touch at the planned pose (P1 figure 4.7)."""
    along: float = 0.0
    """The box stands this much farther than planned [m]."""
    aside: float = 0.0
    """And this much to the left [m]."""
    along_error: float = 0.03
    """Error along the approach that the push-grasp is planned for [m]."""
    seed: int = 1

    @property
    def speed(self) -> float:
        """Speed of base and hand [m/s]."""
        return self.share * FULL_SPEED

    def closing(self) -> PushGrasp:
        """When to close, and what that should forgive."""
        return _core.push_grasp(
            tool_speed=self.speed,
            finger_length=FINGERS,
            object_width=SIZE[1],
            planned_depth=TIPS + SIZE[0] / 2,
            max_push=0.4,
            along_error=self.along_error if self.push else 0.0,
        )

    def start(self) -> float:
        """Engagement at which closing begins [m]."""
        closing = self.closing()
        return max(self.along_error, closing.earliest) if self.push else closing.plain.start

    def promised(self) -> bool:
        """What the closed form says of this trial."""
        problem = dict(
            tool_speed=self.speed, finger_length=FINGERS, object_width=SIZE[1], planned_depth=TIPS + SIZE[0] / 2, max_push=0.4
        )  # fmt: skip
        out = _core.closing_outcome(self.start(), lateral_error=abs(self.aside), **problem)
        return bool(out.holds and -out.nearer_tolerance <= self.along <= out.farther_tolerance)

    def plan(self) -> tuple[JointTrajectory, float]:
        """The trajectory and the time at which closing begins [s]."""
        closing, v = self.closing(), self.speed
        meet = PLACE[0] - SIZE[0] / 2 - TIPS - TOOL[0]  # where the base is as the tips reach the near face
        begin = meet + self.start()
        done = begin + v * (closing.closing_time + AFTER)
        ramp = v**2 / (2 * ACCELERATION)
        first = min(begin, meet) - 0.15 - ramp
        length = done - first + ramp
        times = np.arange(0.0, length / v + v / ACCELERATION + 0.01, 0.01)
        end = length / v + v / ACCELERATION
        left = np.clip(end - times, 0, None)
        near = np.minimum(np.minimum(times, left), v / ACCELERATION)
        part = ACCELERATION * near**2 / 2 + v * (np.minimum(times, left) - near)
        way = first + np.where(times < end / 2, part, length - part)
        arm, q = posture()
        rows = np.column_stack([way, np.zeros((len(way), 2)), np.tile(q, (len(way), 1))])
        close_at = v / ACCELERATION + (begin - first - ramp) / v
        return JointTrajectory(["x", "y", "theta", *arm.names], times, rows), close_at

    def world(self) -> World:
        """The table."""
        world = World()
        world.add_box("table", [3.0, 0.5, TABLE], _core.pose([PLACE[0], PLACE[1] - 0.1, TABLE / 2]))
        return world

    def part(self) -> SimPart:
        """The box where it really stands."""
        pose = _core.pose([PLACE[0] + self.along, PLACE[1] + self.aside, TABLE + SIZE[2] / 2])
        return SimPart("box", [LinkShape(Box(list(SIZE)))], pose, mass=0.2)

    def simulation(self) -> Simulation:
        """Robot, table and box in physics."""
        setup = robot_setup()
        return Simulation(setup.robot, self.world(), [self.part()], gripper=setup.gripper)

    def run(self, simulation: Simulation | None = None, **execution: Unpack[ExecutionOptions]) -> SimResult:
        """Executes the plan with a little noise of wheels and localisation."""
        trajectory, close_at = self.plan()
        keywords: ExecutionOptions = {
            "close_at": close_at,
            "seed": self.seed,
            "travel_noise": 0.002,
            "position_noise": 0.001,
            "heading_noise": 0.001,
            **execution,
        }
        return (simulation or self.simulation()).run(trajectory, arm=posture()[0], **keywords)


@functools.cache
def robot_setup() -> RobotSetup:
    """The shipped robot of the storeroom."""
    return read_setup(choose_sections(read_yaml(shipped("asset:scenarios/storeroom.yaml")).root, None))


@functools.cache
def posture() -> tuple[_core.JointGroup, np.ndarray]:
    """The arm and its configuration: the open hand at TOOL, looking ahead."""
    setup = robot_setup()
    arm = setup.arm.with_reference({**setup.other_joints, **setup.gripper.joint_values(setup.gripper.max_opening)})
    checker = _core.CollisionChecker(
        setup.robot, Passing().world(), group=arm.at(_core.pose([PLACE[0] - TOOL[0], 0, 0]))
    )
    for seed in range(1, 50):
        found = arm.ik(_core.pose(list(TOOL)), rng_seed=seed)
        if found.outcome == _core.Outcome.solved and checker.is_free(found.q):
            return arm, np.asarray(found.q)
    raise _core.Error("no posture with the hand beside the base was found")


__all__ = ["FULL_SPEED", "Passing", "posture", "robot_setup"]
