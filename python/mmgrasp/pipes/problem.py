"""Pipe problems: one YAML file that says which arm carries which pipe along which poses (docs/pipe_format.md)."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .. import _core
from .._argument_errors import checked
from .._core import (
    BeamFrame,
    Grasp,
    Hand,
    InvalidInput,
    JointGroup,
    ManipulationProblem,
    ObjectPathProblem,
    Pipe,
    Robot,
    World,
)
from .._files import ASSETS, shipped
from .._progress import Progress
from ..documents.reading import Node, near_miss, read_yaml
from ..scenario.contact_rules import read_contact_rules
from ..scenario.named_files import find_file
from ..scenario.robot_section import read_arm
from ..scenario.shapes import read_shapes
from .path_section import read_path
from .preferences import Limits, Preferences, read_limits, read_preferences
from .structure_section import read_structure

TOP_KEYS = "format version name structure start path robot"
TOP_OPTIONAL = "gripper obstacles allowed_collisions padding preferences limits timing compare options"
SHAPE_KEYS = "box cylinder sphere mesh shapes scale"
PIPE = "pipe"
SLOWEST = 1e-3  # share of the joints' limits: slower motions take hours
SEARCH_OPTIONS = (
    "algorithm",
    "max_evaluations",
    "seed",
    "max_gap",
    "max_boxes",
    "front_searches",
    "time_limit",
    "threads",
)
NOT_HERE = {"max_sag", "motion_weight", "deflection_weight", "manipulability_weight"} | {
    f"{word}_scale" for word in ("motion", "deflection", "manipulability")
}


@dataclass
class PipeProblem:
    """A pipe problem with everything resolved."""

    name: str
    source: str
    pipe: Pipe
    frame: BeamFrame
    robot: Robot
    arm: JointGroup
    gripper: Hand
    world: World
    """Without the pipe."""
    T_world_pipe: np.ndarray
    """(m, 4, 4): where the pipe lies, then the poses it must follow."""
    preferences: Preferences = field(default_factory=lambda: Preferences({}))
    limits: Limits = field(default_factory=Limits)
    speed: float = 1.0
    """Share of the joints' velocity limits that the motion may use, in (0, 1]."""
    acceleration: float = 1.0
    """Share of their acceleration limits."""
    compare: list[Grasp] = field(default_factory=list)
    """Grasps that the file wants costed beside the best one."""
    path_options: dict[str, Any] = field(default_factory=dict)
    """Fields of ObjectPathOptions, without weights, scales and limits."""
    search_options: dict[str, Any] = field(default_factory=dict)

    @property
    def all_path_options(self) -> dict[str, Any]:
        """Keywords of follow_object_path."""
        return {**self.path_options, **self.preferences.options, "max_sag": self.limits.sag}

    @property
    def overload(self) -> str:
        """What the pipe must not do, in words."""
        limits = []
        if self.limits.sag:
            limits.append(f"sags more than {self.limits.sag:g} m")
        if any(member.material.stress_limit > 0 for member in self.frame.members):
            limits.append("bears more stress than its material's limit")
        return " or ".join(limits)

    def gravity_in_pipe(self, T_world_pipe: np.ndarray) -> np.ndarray:
        """Gravity in the pipe's frame (3,) [m/s2]."""
        usual = _core._object_path_option_table()["gravity"][0]
        down: np.ndarray = -float(self.path_options.get("gravity", usual)) * T_world_pipe[2, :3]
        return down

    def object_path_problem(self) -> ObjectPathProblem:
        """The same for the library: only the fingers may touch the pipe."""
        return ObjectPathProblem(
            self.arm,
            self.world,
            self.pipe.shapes(),
            self.T_world_pipe,
            gripper=self.gripper,
            touch_links=sorted(self.gripper.finger_links),
            frame=self.frame,
            object_name=PIPE,
        )

    def manipulation_problem(self, grasps: list[Grasp]) -> ManipulationProblem:
        """For plan_manipulation: the pipe from its first pose to its last any way, with any of these grasps; only the fingers may touch it."""
        return ManipulationProblem(
            self.arm,
            self.world,
            self.pipe.shapes(),
            self.T_world_pipe[0],
            self.T_world_pipe[-1],
            grasps,
            gripper=self.gripper,
            touch_links=sorted(self.gripper.finger_links),
            object_name=PIPE,
        )

    def holding(self, grasp: Grasp) -> tuple[JointGroup, World]:
        """The arm with its fingers as far open as the grasp holds, and the world with the pipe in the hand."""
        world = self.world.copy()
        world.add(PIPE, self.pipe.shapes(), self.T_world_pipe[0])
        world.attach(PIPE, self.gripper.tool_link, np.linalg.inv(grasp.T_object_hand), set(self.gripper.finger_links))
        return self.arm.with_reference(self.gripper.joint_values(grasp.opening)), world

    def __repr__(self) -> str:
        return f"PipeProblem({self.name!r}, {self.pipe!r}, robot {self.robot.name!r}, {len(self.T_world_pipe)} poses)"


def shipped_problem(path: str | os.PathLike[str]) -> Path:
    """The file of a problem: `asset:...`, the name of a shipped one, or a path."""
    text = os.fspath(path)
    known = {p.stem: p for p in sorted((ASSETS / "pipes").glob("*.yaml"))}
    if text in known and not Path(text).exists():
        return known[text]
    if "." not in text and os.sep not in text and not Path(text).exists():
        raise InvalidInput(f"problem = {text!r}: no such file, nor a shipped problem{near_miss(text, list(known))}")
    return shipped(path)


@checked
def load_pipe_problem(
    path: str | os.PathLike[str],
    *,
    seed: int | None = None,
    threads: int | None = None,
    algorithm: str | None = None,
    progress: Progress = None,
) -> PipeProblem:
    """Reads a pipe problem: a file, or the name of a shipped one ("pipe1").

    Raises InvalidInput or IoError with one message that names file, line, key, value and rule.
    """
    file = shipped_problem(path)
    root = read_yaml(file).root
    with root.blamed():
        return _read_problem(
            root, str(file.resolve()), {"seed": seed, "threads": threads, "algorithm": algorithm}, progress
        )


def _read_problem(root: Node, source: str, given: dict[str, Any], progress: Progress) -> PipeProblem:
    if not isinstance(root.raw, dict) or "format" not in root.raw:
        raise InvalidInput(f"{root.place}: is no pipe problem: the key format: mmgrasp-pipe is missing")
    root["format"].choice("mmgrasp-pipe")
    root.read_version(1)
    root.mapping(TOP_KEYS, TOP_OPTIONAL)
    limits, preferences = read_limits(root), read_preferences(root)
    pipe, frame = read_structure(root["structure"], limits.stress)
    T_world_pipe = read_path(root)
    setup = read_arm(root, progress)
    if setup.robot.base == "diff_drive":
        root["robot"].fail("its base cannot go sideways as the pipe's path may ask: base must be fixed or omni")
    _check_holdable(root["structure"], pipe, setup.gripper)
    path_options, search_options = _read_options(root)
    search_options |= {key: value for key, value in given.items() if value is not None}
    return PipeProblem(
        root["name"].label(),
        source,
        pipe,
        frame,
        setup.robot,
        setup.arm,
        setup.gripper,
        _read_world(root, setup.robot),
        T_world_pipe,
        preferences,
        limits,
        *_read_timing(root),
        _read_compared(root, pipe, setup.gripper),
        path_options,
        search_options,
    )


def _read_world(root: Node, robot: Robot) -> World:
    world = World()
    for node in root["obstacles"].elements() if "obstacles" in root else []:
        node.mapping("name", "pose " + SHAPE_KEYS)
        name = node["name"].label()
        if name == PIPE or name in world.objects:
            node["name"].fail("is the name of the pipe" if name == PIPE else "is used twice")
        with node.blamed():
            world.add(name, read_shapes(node, find_file), node["pose"].pose() if "pose" in node else np.eye(4))
    read_contact_rules(root, robot, list(world.objects), [PIPE]).apply(world)
    return world


def _check_holdable(node: Node, pipe: Pipe, gripper: Hand) -> None:
    """Some section fits between the fingers and is longer than they are wide."""
    thin = [length for length, wide in zip(pipe.lengths, pipe.diameters, strict=True) if wide <= gripper.max_opening]
    if not thin:
        node.fail(
            f"no section fits the hand, which opens {gripper.max_opening:g} m: the thinnest is {min(pipe.diameters):g} m thick"
        )
    if max(thin) <= gripper.finger_width:
        node.fail(
            f"no section that fits the hand is longer than its fingers are wide, {gripper.finger_width:g} m: the longest is {max(thin):g} m"
        )


def _read_timing(root: Node) -> tuple[float, float]:
    shares = [1.0, 1.0]
    if "timing" in root:
        node = root["timing"].mapping("", "speed acceleration")
        for i, key in enumerate(("speed", "acceleration")):
            if key in node:
                shares[i] = node[key].number()
                if not SLOWEST <= shares[i] <= 1:
                    node[key].fail(f"must be at least {SLOWEST:g} and at most 1, the joints' own limits")
    return shares[0], shares[1]


def _read_compared(root: Node, pipe: Pipe, gripper: Hand) -> list[Grasp]:
    grasps = []
    for node in root["compare"].elements() if "compare" in root else []:
        node.mapping("section length angle", "flipped")
        section = node["section"].integer(least=0)
        if section >= len(pipe.sections):
            node["section"].fail(f"there is no such section, only 0 to {len(pipe.sections) - 1}")
        length = node["length"].number(least=0)
        if length > pipe.lengths[section]:
            node["length"].fail(f"is beyond the end of section {section}, which is {pipe.lengths[section]:g} m long")
        flipped = node["flipped"].boolean() if "flipped" in node else False
        with node.blamed():
            grasps.append(pipe.grasp(section, length, node["angle"].number(), flipped, gripper=gripper))
    return grasps


def _read_options(root: Node) -> tuple[dict[str, Any], dict[str, Any]]:
    """Keywords of follow_object_path and of the search. Weights, scales and limits have sections of their own."""
    table = {key: value for key, value in _core._object_path_option_table().items() if key not in NOT_HERE}
    bounds = _core._object_path_option_bounds()
    path: dict[str, Any] = {}
    search: dict[str, Any] = {}
    for key, node in root["options"].items() if "options" in root else []:
        if key in table:
            default = table[key][0]
            if isinstance(default, bool):
                path[key] = node.boolean()
            elif isinstance(default, int):
                path[key] = node.integer(least=0)
            else:
                path[key] = node.number(least=0) if key == "gravity" else node.number(above=0)
        elif key == "algorithm":
            search[key] = node.choice(*_core.grasp_search_names())
        elif key == "max_gap":
            search[key] = node.number(above=0)
            if search[key] >= 1:
                node.fail("must be less than 1")
        elif key == "time_limit":
            search[key] = node.number(above=0)
        elif key in SEARCH_OPTIONS:
            search[key] = node.integer(least=1 if key.startswith("max_") else 0)
        else:
            node.refuse_key([*table, *SEARCH_OPTIONS])
        if key in bounds:
            node.within(bounds[key])
    return path, search
