"""Motion planning problems of the MotionBenchMaker kind: a MoveIt planning scene and a motion plan request, two YAML files.

Read are the scene's objects, its allowed collision matrix, the padding of its links, and the request's group, start
state and joint goal.
Cylinders are [height, radius], boxes full lengths; an object's pose times its primitive's is where the primitive stands.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Unpack

import numpy as np

from .._core import CollisionChecker, InvalidInput, IoError, JointGroup, LinkShape, Robot, World
from .._options import CheckerOptions
from ..documents.moveit_scene import SceneFile, scene_bodies

MBM_SETS = ("bookshelf_small", "bookshelf_tall", "bookshelf_thin", "box", "cage", "table_pick", "table_under_pick")
"""The sets of problems that MotionBenchMaker makes for an arm."""


@dataclass(frozen=True)
class MotionProblem:
    """Where a robot is to go from a start to a goal, and among what."""

    name: str
    group: str
    start: dict[str, float]
    """Joint name to value [rad or m], every joint the request names (those of a gripper too)."""
    goal: dict[str, float]
    """The joints of the group."""
    bodies: dict[str, tuple[list[LinkShape], np.ndarray | None]] = field(repr=False)
    """Name to shapes and pose (None: the world's origin) of each object of the scene."""
    allowed: frozenset[frozenset[str]] = field(repr=False)
    """Pairs of links and objects that may touch."""
    padding: dict[str, float] = field(default_factory=dict, repr=False)
    """Link to its padding against the scene [m]."""

    @property
    def world(self) -> World:
        """The scene, without what it says of links; see world_of()."""
        world = World()
        for name, (shapes, at) in self.bodies.items():
            world.add(name, shapes, at)
        return world

    def world_of(self, robot: Robot) -> World:
        """The scene with its allowed pairs and its padding. Names that neither robot nor scene has are passed over."""
        world = self.world
        links = set(robot.links)
        for pair in self.allowed:
            a, b = min(pair), max(pair)
            if {a, b} <= links | self.bodies.keys() and not {a, b} <= links:  # setting() has pairs of links
                world.allow(a, b)
        world.padding = {"by_name": {link: value for link, value in self.padding.items() if link in links}}
        return world

    def setting(self, robot: Robot) -> tuple[Robot, JointGroup]:
        """The robot with the problem's allowed pairs on top of its disabled ones, and the problem's group of it.

        Joints outside the group stand where the start has them; those the robot does not move are passed over.
        """
        pairs = {(a, b): reason for a, b, reason in robot.disabled_pairs}
        known = set(robot.links)
        for pair in self.allowed:
            a, b = sorted(pair)
            if a in known and b in known and (a, b) not in pairs and (b, a) not in pairs:
                pairs[a, b] = "user"
        robot = robot.with_disabled_pairs([(a, b, reason) for (a, b), reason in pairs.items()])
        group = robot.group(self.group)
        movable = set(robot.joints) - set(group.names)
        return robot, group.with_reference({name: value for name, value in self.start.items() if name in movable})

    def checker(self, robot: Robot, **options: Unpack[CheckerOptions]) -> CollisionChecker:
        """Checks the problem's group (see setting()) in its scene; options as CollisionChecker's."""
        robot, group = self.setting(robot)
        return CollisionChecker(robot, self.world_of(robot), group=group, **options)

    def start_of(self, group: JointGroup) -> np.ndarray:
        """The start as a configuration of the group."""
        return self._values(group, self.start, "start state")

    def goal_of(self, group: JointGroup) -> np.ndarray:
        """The goal as a configuration of the group."""
        return self._values(group, self.goal, "goal")

    def _values(self, group: JointGroup, values: dict[str, float], what: str) -> np.ndarray:
        for name in group.names:
            if name not in values:
                raise InvalidInput(f"{self.name}: the {what} says nothing of joint '{name}'")
        return np.array([values[name] for name in group.names])


def read_motion_problem(scene: str | Path, request: str | Path) -> MotionProblem:
    """Reads one problem. Errors name the file and the entry."""
    scene_file, request_file = SceneFile(scene), SceneFile(request)
    goals = request_file.items("goal_constraints")
    if len(goals) != 1:
        raise InvalidInput(f"{request}: goal_constraints: has {len(goals)} entries, must have one")
    state = request_file.of(request_file.root, "start_state", "joint_state")
    names, positions = request_file.of(state, "name"), request_file.of(state, "position")
    if len(names) != len(positions):
        raise InvalidInput(f"{request}: start_state: {len(names)} names but {len(positions)} positions")
    path = Path(scene)
    bodies = scene_bodies(scene_file)
    return MotionProblem(
        name=f"{path.parent.name}/{path.stem}",
        group=request_file.of(request_file.root, "group_name"),
        start={name: request_file.number(value) for name, value in zip(names, positions, strict=True)},
        goal={
            request_file.of(constraint, "joint_name"): request_file.number(request_file.of(constraint, "position"))
            for constraint in request_file.of(goals[0], "joint_constraints")
        },
        bodies=bodies,
        allowed=_allowed(scene_file, bodies),
        padding=_padding(scene_file),
    )


def read_motion_problems(folder: str | Path) -> Iterator[MotionProblem]:
    """The problems of a folder, scene0001.yaml with request0001.yaml and so on, by number."""
    scenes = sorted(Path(folder).glob("scene*.yaml"))
    if not scenes:
        raise IoError(f"{folder}: holds no scene*.yaml")
    for scene in scenes:
        yield read_motion_problem(scene, scene.with_name(scene.name.replace("scene", "request")))


def _allowed(file: SceneFile, objects: Collection[str]) -> frozenset[frozenset[str]]:
    matrix = file.of(file.root, "allowed_collision_matrix")
    names, rows = file.of(matrix, "entry_names"), file.of(matrix, "entry_values")
    defaults, values = matrix.get("default_entry_names") or [], matrix.get("default_entry_values") or []
    if len(defaults) != len(values):
        raise InvalidInput(f"{file.path}: default_entry_names: must be as many as default_entry_values")
    if len(rows) != len(names) or any(len(row) != len(names) for row in rows):
        raise InvalidInput(f"{file.path}: allowed_collision_matrix: must have a row and a column for each of its names")
    pairs = set()
    for i, row in enumerate(rows):
        pairs |= {frozenset((names[i], names[k])) for k in range(i) if row[k]}
    # A name's default holds for whatever has no entry of its own with it.
    everything = {*names, *defaults, *objects}
    for name, value in zip(defaults, values, strict=True):
        own = set(names) if name in names else set()
        pairs |= {frozenset((name, other)) for other in everything - own - {name} if value}
    return frozenset(pairs)


def _padding(file: SceneFile) -> dict[str, float]:
    """The entries of link_padding, a list of {link_name, padding}; MoveIt leaves it out when there is none."""
    padding = {}
    for entry in file.root.get("link_padding") or []:
        link, value = file.of(entry, "link_name"), file.number(file.of(entry, "padding"))
        if value < 0:
            raise InvalidInput(f"{file.path}: link_padding of '{link}' = {value}: must be >= 0 [m]")
        if value > 0:
            padding[link] = value
    return padding
