"""Eight pipe structures and the work cells they are carried through, in the style of P2 figure 4.3.

The structures go from a single bend to a branched frame of eight sections; lengths of the larger ones are those of P2
table 3.3. A cell has an arm on a table, posts under the pipe where it lies and where it belongs, and what stands between:
columns, a partition to lift it over, a roof above that, or bays around start and goal. P2 prints no measures of its cells, so a
seeded generator draws them; what it rejects is counted by cause. No planner decides on a cell: geometry, inverse
kinematics at both ends and straight joint lines do.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace
from functools import cache
from math import pi

import numpy as np
from numpy.typing import NDArray

from .._core import (
    CollisionChecker,
    InvalidInput,
    Pipe,
    Roadmap,
    Robot,
    World,
    plan_manipulation,
    pose,
)
from ..documents.reading import check_name
from ._pipe_cell import FINGERS, ROBOTS, PipeCell, Pose, pipe_robot, pipe_structures

__all__ = ["FINGERS", "ROBOTS", "PipeCell", "pipe_cell", "pipe_robot", "pipe_structures"]


@dataclass(frozen=True)
class _Style:
    """What stands between and around start and goal."""

    columns: int = 0
    partition: float = 0.0
    """Height of a plate that the pipe must be lifted over [m]; 0: none."""
    gap: float = 0.0
    """A roof over the cell leaves this much above the partition [m]; 0: no roof."""
    low: tuple[str, ...] = ()
    """Which of start and goal lie close to the table: most grasps would need a hand below it."""
    far: bool = False
    """Near the end of the arm's reach."""
    bays: tuple[str, ...] = ()
    """Which of start and goal lie in a bay: back and sides, open towards the arm and above."""
    scarce: bool = False
    """Fewer than 30 % of single grasps may be within reach at both ends."""


_STYLES = {
    "narrow": (
        _Style(bays=("start", "goal")),
        _Style(partition=0.30, gap=0.60),
        _Style(bays=("goal",), partition=0.50),
        _Style(bays=("start", "goal"), far=True, scarce=True),
        _Style(partition=0.30, gap=0.60),
        _Style(bays=("start", "goal")),
        _Style(bays=("start", "goal"), scarce=True),
        _Style(bays=("goal",), partition=0.50, scarce=True),
    ),
    "open": (
        _Style(columns=1),
        _Style(low=("start", "goal")),
        _Style(low=("start", "goal"), far=True),
        _Style(bays=("goal",), far=True),
        _Style(columns=1),
        _Style(low=("start",)),
        _Style(columns=1),
        _Style(low=("start", "goal"), far=True),
    ),
}
_LOW = (0.02, 0.05)  # height of the lowest point [m]
_BAY_ROOM = 0.10  # between the pipe and the walls of its bay [m]
_RINGS = {"tm14like": (0.45, 0.70), "kr6like": (0.40, 0.58)}  # around the arm's axis [m]
_PARTITIONS = {"tm14like": 1.0, "kr6like": 0.5}  # heights, by the style's
_ROOFS = {"tm14like": 0.0, "kr6like": 0.13}  # gaps wider than the style's [m]: pipes are as long for a shorter arm
_TABLE_TOP = -0.005  # the arm's foot stands on it without touching [m]
_POST_RADIUS = 0.01
_POST_GAP = 0.005  # between a post and the pipe above it [m]
_CLEARANCE = 0.02  # between the pipe at rest and whatever else stands there [m]
_TRIES = 500
_FEWEST, _SCARCE = 0.03, 0.3  # of single grasps
_GRASPS = 500
_GRASP_SEED = 1_000_000  # of the grasps that decide on a cell


def pipe_cell(number: int, seed: int = 1, robot: str = "tm14like", style: str = "narrow") -> PipeCell:
    """The cell of one structure (1 to 8), drawn with a seed: the same every time.

    Rejected and counted are cells without room for pipe or posts and those in which fewer than 3 % of 500 grasps have
    collision-free arm configurations at both ends (for some structures also 30 % or more). "narrow" cells have bays,
    partitions and roofs, and those are rejected in which one of the 500 grasps carries the pipe along a straight joint
    line; "open" ones have little between start and goal. Whether a path exists is not asked: no planner has a say.
    Raises InvalidInput on a number, robot or style that does not exist and on a negative seed.
    """
    check_name("style", style, _STYLES)
    check_name("robot", robot, ROBOTS)
    if not _is_whole(number) or not 1 <= number <= len(_STYLES[style]):
        raise InvalidInput(f"number = {number!r}: must be from 1 to {len(_STYLES[style])}")
    if not _is_whole(seed) or seed < 0:
        raise InvalidInput(f"seed = {seed!r}: must be a whole number >= 0")
    return _pipe_cell(int(number), int(seed), robot, style)


def _is_whole(value: object) -> bool:
    return isinstance(value, int | np.integer) and not isinstance(value, bool)


@cache
def _pipe_cell(number: int, seed: int, robot: str, style: str) -> PipeCell:
    rng = np.random.default_rng([seed, number, ROBOTS.index(robot)])
    rejected: Counter[str] = Counter()
    for drawn in range(1, _TRIES + 1):
        cell = _draw(number, seed, robot, style, rng)
        cause = _fault(cell)
        if not cause:
            return replace(cell, drawn=drawn, rejected=dict(rejected))
        rejected[cause] += 1
    raise InvalidInput(f"number = {number}, seed = {seed}: none of {_TRIES} cells will do: {dict(rejected)}")


def _draw(number: int, seed: int, robot: str, style_name: str, rng: np.random.Generator) -> PipeCell:
    """Start to the left of the arm, goal to its right, obstacles ahead."""
    pipe, style = pipe_structures()[number - 1], _STYLES[style_name][number - 1]
    between = rng.uniform(-0.3, 0.3)  # direction of what stands between [rad]
    T_world_start, T_world_goal = (
        _resting(
            pipe,
            rng,
            _ring(robot, style),
            between + side * rng.uniform(0.9, 1.5),
            _LOW if name in style.low else heights,
        )
        for name, side, heights in (("start", 1, (0.06, 0.20)), ("goal", -1, (0.06, 0.35)))
    )
    world = World()
    world.add_box("table", [2.6, 2.6, 0.05], pose([0, 0, _TABLE_TOP - 0.025]))
    behind = -0.38 * _direction(between)
    world.add_box("wall", [0.04, 2.4, 1.5], pose([*behind, 0.75 + _TABLE_TOP], rpy=[0, 0, between]))
    for name, T in (("start", T_world_start), ("goal", T_world_goal)):
        for i, top in enumerate(_post_tops(pipe, T, rng)):
            height = top[2] - _TABLE_TOP
            world.add_cylinder(
                f"{name} post {i + 1}", _POST_RADIUS, height, pose([top[0], top[1], _TABLE_TOP + height / 2])
            )
    for name, T in (("start", T_world_start), ("goal", T_world_goal)):
        if name in style.bays:
            _add_bay(world, name, pipe, T)
    if style.partition:
        _add_partition(world, between, robot, style, rng)
    for i in range(style.columns):
        radius, height = rng.uniform(0.03, 0.05), rng.uniform(0.5, 0.9) * _scale(robot)
        at = rng.uniform(0.40, 0.90) * _scale(robot) * _direction(between + rng.uniform(-0.6, 0.6))
        world.add_cylinder(f"column {i + 1}", radius, height, pose([at[0], at[1], _TABLE_TOP + height / 2]))
    return PipeCell(number, seed, robot, style_name, pipe, world, T_world_start, T_world_goal)


def _direction(angle: float) -> NDArray[np.float64]:
    return np.array([np.cos(angle), np.sin(angle)])


def _ring(robot: str, style: _Style) -> tuple[float, float]:
    """Distances of centres of mass from the arm's axis [m]."""
    near, far = _RINGS[robot]
    return (far + 0.05, far + 0.15) if style.far else (near, far)


def _resting(
    pipe: Pipe, rng: np.random.Generator, ring: tuple[float, float], angle: float, heights: tuple[float, float]
) -> Pose:
    """Any of the 24 turns by right angles, any heading, the lowest point at a height within bounds."""
    turn = pose([0, 0, 0], rpy=rng.integers(0, 4, 3) * (pi / 2))
    T = pose([0, 0, 0], rpy=[0, 0, rng.uniform(-pi, pi)]) @ turn
    radius = max(pipe.diameters) / 2
    lowest = (pipe.nodes @ T[:3, :3].T)[:, 2].min() - radius
    T[:2, 3] = rng.uniform(*ring) * _direction(angle)
    T[2, 3] = rng.uniform(*heights) - lowest
    return T


def _post_tops(pipe: Pipe, T: Pose, rng: np.random.Generator) -> list[NDArray[np.float64]]:
    """Two points below the pipe with nothing of it further down, the farthest apart of some draws."""
    nodes = pipe.nodes @ T[:3, :3].T + T[:3, 3]
    points, radii = [], []  # along the whole pipe
    for (a, b), diameter in zip(pipe.sections, pipe.diameters, strict=True):
        points.append(nodes[a] + np.linspace(0, 1, 41)[:, None] * (nodes[b] - nodes[a]))
        radii.append(np.full(41, diameter / 2))
    along, radius = np.concatenate(points), np.concatenate(radii)
    tops = []
    for i in rng.integers(0, len(along), 24):
        beside = np.linalg.norm(along[:, :2] - along[i, :2], axis=1) > radius + _POST_RADIUS + _POST_GAP
        above = along[:, 2] - radius >= along[i, 2] - radius[i] - 1e-9
        if np.all(beside | above):
            tops.append(along[i] - [0, 0, radius[i] + _POST_GAP])
    pairs = [(a, b) for i, a in enumerate(tops) for b in tops[:i]]
    if not pairs:
        return tops
    widest = max(pairs, key=lambda pair: float(np.linalg.norm(pair[0] - pair[1])))
    return list(widest)


def _add_bay(world: World, name: str, pipe: Pipe, T: Pose) -> None:
    """Back and two sides around the resting pipe, open towards the arm's axis and above."""
    heading = float(np.arctan2(T[1, 3], T[0, 3]))
    T_world_bay = pose([0, 0, 0], rpy=[0, 0, heading])
    nodes = (pipe.nodes @ T[:3, :3].T + T[:3, 3]) @ T_world_bay[:3, :3]
    reach, thick = max(pipe.diameters) / 2 + _BAY_ROOM, 0.02
    low, high = nodes.min(axis=0) - reach, nodes.max(axis=0) + reach
    low[2], high[2] = _TABLE_TOP, nodes[:, 2].max()
    depth, width, height = high - low
    middle = (low + high) / 2
    for part, size, at in (
        ("back", [thick, width + 2 * thick, height], [high[0] + thick / 2, middle[1], middle[2]]),
        ("left side", [depth, thick, height], [middle[0], high[1] + thick / 2, middle[2]]),
        ("right side", [depth, thick, height], [middle[0], low[1] - thick / 2, middle[2]]),
    ):
        world.add_box(f"{name} bay {part}", size, T_world_bay @ pose(at))


def _scale(robot: str) -> float:
    """How far the arm reaches, by the larger one."""
    return _RINGS[robot][1] / _RINGS["tm14like"][1]


def _add_partition(world: World, between: float, robot: str, style: _Style, rng: np.random.Generator) -> None:
    """A plate that stands out from near the arm, and a roof above it."""
    near, far = 0.28 * _scale(robot), 1.15 * _scale(robot)
    middle = (near + far) / 2 * _direction(between)
    height = style.partition * _PARTITIONS[robot] * rng.uniform(0.9, 1.1)
    plate = pose([middle[0], middle[1], _TABLE_TOP + height / 2], rpy=[0, 0, between])
    world.add_box("partition", [far - near, 0.03, height], plate)
    if style.gap:
        bottom = height + (style.gap + _ROOFS[robot]) * rng.uniform(0.95, 1.05)
        world.add_box("roof", [2.6, 2.6, 0.04], pose([0, 0, bottom + 0.02]))


def _fault(cell: PipeCell) -> str:
    """Why a drawn cell will not do; empty when it will."""
    for name, T in (("start", cell.T_world_start), ("goal", cell.T_world_goal)):
        if _nearest(cell.pipe, cell.world, T, ignored=f"{name} post") < _CLEARANCE:
            return f"no room for the pipe at its {name}"
        if _nearest(cell.pipe, cell.world, T) < 0.8 * _POST_GAP:
            return f"a post stands in the pipe at its {name}"
    return _fault_of_ends(cell)


def _fault_of_ends(cell: PipeCell) -> str:
    """Judges by inverse kinematics of all grasps, and by all straight joint lines between their ends."""
    problem = cell.problem(cell.grasps(_GRASPS, seed=_GRASP_SEED))
    nothing_joined = Roadmap.build(cell.arm, vertices=2, gamma=1e-9)
    lines = plan_manipulation(problem, roadmap=nothing_joined, first_grasps=0, shorten=False, time_limit=600.0)
    within_reach = sum(g.start_solutions > 0 and g.goal_solutions > 0 for g in lines.grasps) / len(lines.grasps)
    if within_reach < _FEWEST:
        return "fewer than 3 % of the grasps within reach"
    if _STYLES[cell.style][cell.number - 1].scarce and within_reach >= _SCARCE:
        return "30 % of the grasps within reach, or more"
    return "a straight line will do" if cell.style == "narrow" and lines.path is not None else ""


def _nearest(pipe: Pipe, world: World, T_world_pipe: Pose, ignored: str | None = None) -> float:
    """Distance of the pipe from the scene, without the bodies whose names begin as said [m]."""
    others = world.copy()
    for name in others.objects:
        if ignored is not None and name.startswith(ignored):
            others.remove(name)
    body = Robot.from_strings(
        '<robot name="pipe"><link name="world"/><link name="rail"/><joint name="rail" type="prismatic">'
        '<parent link="world"/><child link="rail"/><limit lower="0" upper="1" velocity="1" effort="1"/></joint></robot>'
    ).with_link("pipe", "rail", T_world_pipe, pipe.shapes())
    checker = CollisionChecker(body, others, body.group(base_link="world", tip="pipe"))
    return checker.distance([0.0]).value
