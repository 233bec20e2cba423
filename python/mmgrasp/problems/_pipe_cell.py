"""Pipe structures, the arms that carry them, and a cell as data: what `pipe_cells` draws."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from functools import cache
from math import acos, pi, sin

import numpy as np
from numpy.typing import NDArray

from .._core import (
    CollisionChecker,
    Grasp,
    Hand,
    HandJoint,
    InvalidInput,
    JointGroup,
    LinkShape,
    ManipulationProblem,
    Pipe,
    PipeProvenance,
    Robot,
    World,
)
from .._files import shipped
from ..documents.reading import check_name

Pose = NDArray[np.float64]
ROBOTS = ("tm14like", "kr6like")
_HALF_TURN = 3.14159
FINGERS = frozenset({"left_finger_link", "right_finger_link"})

# Nodes [m], sections, outer diameter [m].
_STRUCTURES: tuple[tuple[list[tuple[float, float, float]], list[tuple[int, int]], float], ...] = (
    # 1: a bend
    ([(0, 0, 0), (0.30, 0, 0), (0.30, 0.20, 0)], [(0, 1), (1, 2)], 0.022),
    # 2: an offset
    ([(0, 0, 0), (0.20, 0, 0), (0.20, 0.15, 0), (0.40, 0.15, 0)], [(0, 1), (1, 2), (2, 3)], 0.022),
    # 3: a tee
    ([(0, 0, 0), (0.20, 0, 0), (0.40, 0, 0), (0.20, 0.20, 0)], [(0, 1), (1, 2), (1, 3)], 0.028),
    # 4: a bow with its ends in another plane
    (
        [(0, 0, 0.15), (0, 0, 0), (0.30, 0, 0), (0.30, 0.20, 0), (0.30, 0.20, 0.15)],
        [(0, 1), (1, 2), (2, 3), (3, 4)],
        0.018,
    ),
    # 5: Pipe2 of table 3.3
    (
        [(0, 0, 0), (0.20, 0, 0), (0.20, 0.20, 0), (0.20, 0.20, 0.30), (0.40, 0.20, 0.30), (0.40, 0.40, 0.30)],
        [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5)],
        0.012,
    ),
    # 6: Pipe1 of table 3.3, joined as in figure 3.4
    (
        [(0, 0, 0), (0.20, 0, 0), (0.20, 0.20, 0), (0.20, 0.20, 0.15), (0.40, 0.20, 0.15), (0.20, 0.60, 0.15)]
        + [(0.20, 0.60, 0.25)],
        [(0, 1), (1, 2), (2, 3), (3, 4), (3, 5), (5, 6)],
        0.012,
    ),
    # 7: a closed frame with three legs
    (
        [(0, 0, 0), (0.35, 0, 0), (0.35, 0.25, 0), (0, 0.25, 0), (0, 0, 0.15), (0.35, 0, 0.15), (0.35, 0.25, -0.15)],
        [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 5), (2, 6)],
        0.015,
    ),
    # 8: a branched frame with the lengths of Pipe3 of table 3.3
    (
        [(0, 0, 0), (0.20, 0, 0), (0.20, 0.15, 0), (0.20, 0.15, 0.20), (0.40, 0.15, 0), (0.20, 0.55, 0)]
        + [(0.35, 0.55, 0), (0.20, 0.55, 0.10), (0.40, 0.15, 0.05)],
        [(0, 1), (1, 2), (2, 3), (2, 4), (2, 5), (5, 6), (5, 7), (4, 8)],
        0.012,
    ),
)


def pipe_structures() -> list[Pipe]:
    """The eight structures, from one bend to eight sections; the object's frame stands in the centre of mass."""
    pipes = []
    for nodes, sections, diameter in _STRUCTURES:
        raw = Pipe(nodes, sections, diameter)
        pipes.append(Pipe(raw.nodes - raw.centre_of_mass, sections, diameter))
    return pipes


def _section_of(grasp: Grasp) -> int:
    """The section that a grasp drawn on a pipe is on."""
    if not isinstance(grasp.provenance, PipeProvenance):
        raise InvalidInput(f"grasp = {grasp!r}: must come from a pipe")
    return grasp.provenance.section


@cache
def pipe_robot(name: str) -> tuple[Robot, JointGroup, Hand]:
    """One of ROBOTS with its arm (the tip is the tool) and its gripper.

    Joints that could turn further are kept to half a turn either way. P2's gamma* of about 10 belongs to that box; in the
    whole one the thesis' roadmap of 5000 vertices has a mean degree below one and falls to pieces.
    """
    check_name("robot", name, ROBOTS)
    urdf, srdf = (shipped(f"asset:robots/{name}/{name}.{kind}").read_text() for kind in ("urdf", "srdf"))
    urdf = re.sub(r'(lower|upper)="(-?)([0-9.]+)"', lambda m: f'{m[1]}="{m[2]}{min(float(m[3]), _HALF_TURN):g}"', urdf)
    robot = Robot.from_strings(urdf, srdf)
    gripper = Hand(
        "gripper_tcp",
        approach=[1, 0, 0],
        closing=[0, 1, 0],
        max_opening=0.06,
        finger_depth=0.03,
        finger_width=0.02,
        clearance=0.008,
        joints=[HandJoint(f"{side}_finger_joint", 0.0, 0.03) for side in ("left", "right")],
        finger_links=sorted(FINGERS),
    )
    return robot, robot.group("arm"), gripper


@dataclass(frozen=True, eq=False)
class PipeCell:
    """A pipe, where it lies and where it belongs, and the cell around the arm."""

    number: int
    """Number of the structure, from 1."""
    seed: int
    robot_name: str
    style: str
    pipe: Pipe
    world: World
    """Table, posts and obstacles; without the pipe."""
    T_world_start: Pose
    T_world_goal: Pose
    drawn: int = 1
    """Cells drawn until this one was taken."""
    rejected: dict[str, int] = field(default_factory=dict)
    """Cells rejected, by cause."""

    @property
    def robot(self) -> Robot:
        return pipe_robot(self.robot_name)[0]

    @property
    def arm(self) -> JointGroup:
        return pipe_robot(self.robot_name)[1]

    @property
    def gripper(self) -> Hand:
        return pipe_robot(self.robot_name)[2]

    def grasps(self, count: int, seed: int = 1) -> list[Grasp]:
        """Grasps whose hand meets no other section of the pipe; fewer than `count` when no more fit on it."""
        found: list[Grasp] = []
        wanted = count
        while True:
            drawn = self.pipe.sample_grasps(wanted, gripper=self.gripper, seed=seed)
            found = [g for g, free in zip(drawn, self._hand_is_free(drawn), strict=True) if free]
            if len(found) >= count or len(drawn) < wanted:
                return found[:count]
            wanted = 2 * wanted

    def _hand_is_free(self, grasps: list[Grasp]) -> NDArray[np.bool_]:
        free = np.zeros(len(grasps), dtype=bool)
        sections = [_section_of(grasp) for grasp in grasps]
        for section in set(sections):
            chosen = [i for i, own in enumerate(sections) if own == section]
            checker = _hand_checker(self.robot_name, self.pipe, section)
            free[chosen] = checker.are_free([_flying(grasps[i].T_object_hand) for i in chosen], threads=1)
        return free

    def problem(self, grasps: list[Grasp]) -> ManipulationProblem:
        """For plan_manipulation: only the fingers may touch the pipe."""
        if not isinstance(grasps, list | tuple) or not all(isinstance(grasp, Grasp) for grasp in grasps):
            raise InvalidInput(f"grasps = {grasps!r}: must be a list of Grasp")
        return ManipulationProblem(
            self.arm,
            self.world,
            self.pipe.shapes(),
            self.T_world_start,
            self.T_world_goal,
            grasps,
            gripper=self.gripper,
            touch_links=sorted(FINGERS),
            object_name="pipe",
        )

    def arm_holding(self, grasp: Grasp) -> JointGroup:
        """The arm with its fingers as far open as the grasp holds."""
        return self.arm.with_reference(self.gripper.joint_values(grasp.opening))

    def world_holding(self, grasp: Grasp) -> World:
        """The cell with the pipe in the hand, which only the fingers may touch."""
        world = self.world.copy()
        world.add("pipe", self.pipe.shapes(), self.T_world_start)
        world.attach("pipe", "gripper_tcp", np.linalg.inv(grasp.T_object_hand), set(FINGERS))
        return world

    def ends(self, grasp: Grasp, count: int = 8) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Collision-free configurations (k, 6) that hold the pipe by this grasp at its start and at its goal."""
        arm, world = self.arm_holding(grasp), self.world_holding(grasp)
        starts = arm.ik_all(self.T_world_start @ grasp.T_object_hand, count, world=world)
        if len(starts) == 0:
            return starts, starts
        return starts, arm.ik_all(self.T_world_goal @ grasp.T_object_hand, count, world=world)


def _flying(T: Pose) -> NDArray[np.float64]:
    """(x, y, z, rotation vector) of a pose."""
    R = T[:3, :3]
    angle = acos(float(np.clip((np.trace(R) - 1) / 2, -1, 1)))
    axis = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
    if angle < 1e-9:
        axis = np.zeros(3)
    elif angle > pi - 1e-6:  # from the symmetric part
        column = np.argmax(np.diag(R))
        axis = R[:, column] + np.eye(3)[:, column]
        axis *= angle / np.linalg.norm(axis)
    else:
        axis *= angle / (2 * sin(angle))
    return np.concatenate([T[:3, 3], axis])


@cache
def _hand_checker(robot_name: str, pipe: Pipe, section: int) -> CollisionChecker:
    """The hand, opened as wide as the section, flying among the pipe's other sections."""
    robot, _, gripper = pipe_robot(robot_name)
    opening = gripper.joint_values(pipe.diameters[section])
    poses = robot.link_poses(opening)
    T_tool_world = np.linalg.inv(poses["gripper_tcp"])
    shapes = [
        LinkShape(shape.shape, T_tool_world @ poses[link] @ shape.pose)
        for link in ("gripper_link", *sorted(FINGERS))
        for shape in robot.collisions(link)
    ]
    flying = Robot.from_strings(
        '<robot name="hand"><link name="object"/><link name="tool"/><joint name="flight" type="floating">'
        '<parent link="object"/><child link="tool"/></joint></robot>'
    ).with_link("hand", "tool", np.eye(4), shapes)
    world = World()
    others = [shape for i, shape in enumerate(pipe.shapes()) if i != section]
    if others:
        world.add("pipe", others, np.eye(4))
    return CollisionChecker(flying, world, flying.group(base_link="object", tip="hand"))
