"""The storeroom of P1 3.6: trays in a row, objects on a regular grid in each, the shipped Fetch-like robot before them.

What P1 states is taken from it: trays of 30 x 40 x 10 cm, m = a x b objects at the points of a grid, k grasps an object,
base positions 5 cm apart, one heading (towards the trays), the arm's seven joints, a positioning uncertainty of 0.10 m,
collisions with the trays and what carries them. What it leaves open is a field of Row, so that it can be varied.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .. import _core
from .._core import (
    BaseGrid,
    Box,
    CollisionChecker,
    Grasp,
    LinkShape,
    Part,
    PartSupplyProblem,
    ReachDatabase,
    Tray,
    World,
)
from .._files import shipped
from .._progress import Progress
from ..documents.reading import read_yaml
from ..scenario.robot_section import RobotSetup, choose_sections, read_setup
from ..scenario.tray_body import WALL

UNCERTAINTY = 0.10  # P1 3.7.1 [m]
RESOLUTION = 0.05  # P1 3.6 [m]
WORKSPACE = 300.0  # of the base: rows of 500 trays are 200 m long [m]
TOP = 0.03  # thickness of the table's top [m]
OPENING = 0.02  # of the hand at a grasp [m]
MARKER = LinkShape(Box([0.001, 0.001, 0.001]), _core.pose([0, 0, 0.0005]))


@dataclass(frozen=True)
class Row:
    """Trays in a row along y, the robot on their -x side (P1 figure 3.12)."""

    trays: int = 1
    objects: tuple[int, int] = (9, 12)
    """Along the tray's 30 cm and along its 40 cm."""
    grasps: int = 1
    """An object; from above, turned about the vertical by pi / grasps each."""
    spacing: float = 0.5
    """Between the middles of neighbouring trays [m]."""
    shift: float = 0.0
    """Shift of the whole row along itself [m]."""
    middles: tuple[float, ...] | None = None
    """Middles of the trays along the row [m]; None: by trays and spacing."""
    targets: tuple[tuple[int, ...], ...] | None = None
    """Objects to pick in each tray; None: all."""
    table: float = 0.40
    """Height of the table's top [m]."""
    tool: float = 0.12
    """Height of the tool above the tray's floor [m]: finger tips clear the rim, so that corners can be filled."""
    torso: float = 0.38
    """Where the torso lift stands [m]: P1 plans for the arm's seven joints."""
    turn: float = 0.0
    """Angle of the fingers' closing direction against the row's [rad]."""
    tilt: float = np.pi / 6
    """Angle of the approach from straight down towards the robot's heading [rad]."""
    margin: float = 0.02
    """From the tray's edge to the middles of the outermost objects [m]: they fill its corners (P1 3.6.1)."""
    deep: bool = False
    """The tray's 40 cm lie along x (away from the robot) instead of along the row."""
    ik_seeds: int = 8
    threads: int = 0

    @property
    def tray_size(self) -> tuple[float, float, float]:
        """x (depth), y (along the row), z [m]."""
        return (0.40, 0.30, 0.10) if self.deep else (0.30, 0.40, 0.10)

    @property
    def per_tray(self) -> int:
        return self.objects[0] * self.objects[1]

    def tray_middles(self) -> list[float]:
        middles = self.middles if self.middles is not None else [i * self.spacing for i in range(self.trays)]
        return [y + self.shift for y in middles]

    def tray_pose(self, middle: float) -> np.ndarray:
        """T_world_tray of the tray at this place of the row."""
        return _core.pose([0, middle, self.table + 0.006])

    def object_places(self) -> np.ndarray:
        """(m, 2): a x b points at equal distances from corner to corner, x fastest [m]; one alone in the middle."""
        counts = self.objects[::-1] if self.deep else self.objects
        ends = [length / 2 - self.margin for length in self.tray_size[:2]]
        axes = [np.linspace(-end, end, n) if n > 1 else np.zeros(1) for n, end in zip(counts, ends, strict=True)]
        return np.array([(x, y) for y in axes[1] for x in axes[0]])

    def problem(self, parts: Sequence[Sequence[Part]] | None = None) -> PartSupplyProblem:
        """The same as objects for the planner; `parts` of each tray instead of the regular grid's."""
        setup = robot_setup(self.torso)
        world, trays = World(), []
        middles = self.tray_middles()
        length = max(middles) - min(middles) + self.tray_size[1] + 0.1
        world.add_box(
            "table top",
            [self.tray_size[0] + 0.04, length, TOP],
            _core.pose([0, (max(middles) + min(middles)) / 2, self.table - TOP / 2]),
        )
        for index, y in enumerate(middles):
            T_world_tray = self.tray_pose(y)
            world.add(f"tray {index}", _core.tray_shapes(self.tray_size, WALL), T_world_tray)
            held = self._parts(index, T_world_tray) if parts is None else list(parts[index])
            trays.append(Tray(str(index), T_world_tray, self.tray_size, held, [0.0]))
        away = max(middles) + 3.0
        return PartSupplyProblem(
            setup.robot,
            setup.arm,
            setup.gripper,
            world,
            trays,
            setup.home,
            [-1.5, min(middles) - 1.0, 0.0],
            [-1.5, away - 2.0, 0.0],
            setup.place_region,
            positioning_uncertainty=UNCERTAINTY,
            grid_resolution=RESOLUTION,
            ik_seeds=self.ik_seeds,
            threads=self.threads,
        )

    def _parts(self, tray: int, T_world_tray: np.ndarray) -> list[Part]:
        down = np.pi / 2 - self.tilt
        rolls = [[0.0, down, self.turn + np.pi * k / self.grasps] for k in range(self.grasps)]
        chosen = None if self.targets is None else set(self.targets[tray])
        parts = []
        for i, (x, y) in enumerate(self.object_places()):
            grasps = [Grasp(_core.pose([0, 0, self.tool], rpy=rpy), OPENING) for rpy in rolls]
            T_world_part = T_world_tray @ _core.pose([x, y, 0.0])
            parts.append(Part(f"{tray}/{i}", [MARKER], T_world_part, grasps, target=chosen is None or i in chosen))
        return parts

    def with_(self, **changes: Any) -> Row:
        return replace(self, **changes)


BAR = (0.02, 0.02, 0.05)  # [m]; at 6x8 objects the fingers still fit between two of them


def bars(row: Row) -> list[Part]:
    """Upright bars at the places of the row's first tray, with antipodal grasps sampled on them: parts with bodies, taken below the rim."""
    shape = LinkShape(Box(list(BAR)), _core.pose([0, 0, BAR[2] / 2]))
    grasps = _core.sample_grasps([shape], robot_setup(row.torso).gripper)
    T_world_tray = row.tray_pose(row.tray_middles()[0])
    return [
        Part(f"0/{i}", [shape], T_world_tray @ _core.pose([x, y, 0.0]), grasps)
        for i, (x, y) in enumerate(row.object_places())
    ]


@functools.cache
def robot_setup(torso: float) -> RobotSetup:
    """The shipped Fetch-like robot with its seven-joint arm, the torso lift held."""
    document = read_yaml(shipped("asset:scenarios/storeroom.yaml"))
    section = document.root["robot"].raw
    home = dict(section["home"])
    home.pop("torso_lift_joint")
    section["group"] = "arm"
    section["home"] = home
    section["joints"] = {**section["joints"], "torso_lift_joint": torso}
    section["base_limits"] = {**section["base_limits"], "workspace": WORKSPACE}
    return read_setup(choose_sections(document.root, None))


class ChecksAtBase:
    """Collision checks of base and arm together, at rest with the hand closed and with it open for the parts.

    Base poses are (k, 3) arrays of x, y, theta, arm configurations (k, n) arrays of the same length.
    """

    def __init__(self, problem: PartSupplyProblem, torso: float) -> None:
        moving = problem.robot.group("arm", tip=problem.gripper.tool_link, with_base=True)
        world = problem.world.copy()
        for tray in problem.trays:
            for part in tray.parts:
                world.add(part.name, part.shapes, part.T_world_part)
        self._home = problem.home
        self._rest, self._open = (
            CollisionChecker(
                problem.robot,
                world,
                group=moving.with_reference({"torso_lift_joint": torso} | problem.gripper.joint_values(opening)),
            )
            for opening in (0.0, problem.gripper.pregrasp_opening(OPENING))
        )

    def at_home(self, bases: np.ndarray) -> np.ndarray:
        """Where the robot at home stands free."""
        return self._rest.are_free(np.hstack([bases, np.tile(self._home, (len(bases), 1))]))

    def free(self, bases: np.ndarray, Q: np.ndarray) -> np.ndarray:
        """Which arm configurations are free with the hand open."""
        return self._open.are_free(np.hstack([bases, Q]))


def database(row: Row, samples: int, *, seed: int = 1, progress: Progress = None, **options: Any) -> ReachDatabase:
    """The arm's database for a row's torso height, from the cache or built now."""
    return ReachDatabase.load_or_build(
        robot_setup(row.torso).arm, _core.cache_folder(), progress=progress, samples=samples, seed=seed, **options
    )


def grid_of(problem: PartSupplyProblem, reach: ReachDatabase) -> BaseGrid:
    return _core.make_base_grid(problem, reach)


def reach_samples(quick: bool) -> int:
    """Configurations drawn for the database."""
    return 500_000 if quick else 2_000_000


def describe(row: Row, samples: int, *varied: str) -> dict[str, Any]:
    """A set-up in words and numbers; `varied` are given by the rows instead."""
    words = {
        "robot": "fetchlike, seven-joint arm, diff-drive base",
        "tray [m]": row.tray_size,
        "trays": row.trays,
        "objects": f"{row.objects[0]}x{row.objects[1]}",
        "grasps per object": row.grasps,
        "grid [m]": RESOLUTION,
        "uncertainty [m]": UNCERTAINTY,
        "spacing [m]": row.spacing,
        "table height [m]": row.table,
        "tool above the tray's floor [m]": row.tool,
        "torso lift [m]": row.torso,
        "approach tilted from straight down [rad]": row.tilt,
        "closing direction against the row [rad]": row.turn,
        "configurations drawn for the database": samples,
        "obstacles": "table top, walls and floors of all trays",
    }
    if row.trays == 1:
        varied = (*varied, "spacing [m]")
    return {key: value for key, value in words.items() if key not in varied}
