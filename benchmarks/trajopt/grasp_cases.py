"""What the programs here share: random grasp poses, rooms with furniture, how a line is printed."""

from __future__ import annotations

import argparse
import json
import statistics
import time
from collections.abc import Callable
from typing import Any

import numpy as np

import mmgrasp as mg
from mmgrasp.reproduce.drive_by import GOAL, START, whole_body

LANE_END = 10.0  # x of the goal [m]


def drawn_pose(rng: np.random.Generator, x: tuple[float, float] = (2.0, 8.0)) -> np.ndarray:
    """x 2 to 8, |y| 0.5 to 2.5, z 0.3 to 1.1 m, approach within 60 degrees of horizontal, roll free."""
    place = [rng.uniform(*x), rng.choice([-1, 1]) * rng.uniform(0.5, 2.5), rng.uniform(0.3, 1.1)]
    return mg.pose(place, [rng.uniform(-np.pi, np.pi), rng.uniform(-np.pi / 3, np.pi / 3), rng.uniform(-np.pi, np.pi)])


def reachable(pose: np.ndarray, rng: np.random.Generator) -> bool:
    """Some base pose has an arm configuration for it."""
    _, group = whole_body()
    for trial in range(8):
        at = np.zeros(10)
        at[:2] = pose[:2, 3] + rng.uniform(-0.8, 0.8, 2)
        at[2] = rng.uniform(-np.pi, np.pi)
        if group.ik(pose, seed=at, restarts=10, rng_seed=trial + 1).outcome == mg.Outcome.solved:
            return True
    return False


def grasps(seed: int, count: int) -> list[np.ndarray]:
    """`count` poses that are reachable."""
    rng = np.random.default_rng(seed)
    kept: list[np.ndarray] = []
    while len(kept) < count:
        pose = drawn_pose(rng)
        if reachable(pose, rng):
            kept.append(pose)
    return kept


def furnished(pose: np.ndarray, seed: int) -> mg.World:
    """A room: a table below the grasp (a board above it when the hand comes from below), two walls that reach into the lane from either
    side, walls along it, another table."""
    rng = np.random.default_rng(seed)
    x, y, z = pose[:3, 3]
    world = mg.World()

    def block(name: str, size: list[float], centre: list[float], bottom: float = 0.0) -> None:
        world.add_box(name, size=size, pose=mg.pose([*centre, bottom + size[2] / 2]))

    width, depth, gap = rng.uniform(0.4, 0.8), rng.uniform(0.4, 0.6), rng.uniform(0.08, 0.15)
    if pose[2, 0] > 0:
        block("board", [width, depth, 0.04], [x, y], z + gap)
    else:
        block("table", [width, depth, max(0.1, z - gap)], [x, y])
    for k, side in enumerate((-1, 1)):
        while abs((at := rng.uniform(1.5, 8.5)) - x) < 1.3:
            pass
        inner = rng.uniform(-0.2, 0.6)  # beyond the middle of the lane, or short of it
        block(f"wall {k}", [0.1, 2.8, 1.5], [at, side * (1.4 + inner)])
    for k, side in enumerate((-1, 1)):
        block(f"side wall {k}", [LANE_END + 3, 0.1, 1.5], [LANE_END / 2, side * 4.0])
    while abs((at := rng.uniform(2, 8)) - x) < 1.2:
        pass
    block("other table", [0.8, 0.6, 0.72], [at, rng.choice([-1, 1]) * rng.uniform(0.9, 1.6)])
    return world


def can_on_a_table(rng: np.random.Generator) -> tuple[mg.World, np.ndarray]:
    """Furniture at the grasp: a can on a table beside the lane, a wall behind the table, a cupboard beside it, in every second room a board
    above; and the pose from which the hand takes the can, from the lane within 60 degrees of straight across."""
    world = mg.World()
    side, x, edge = rng.choice([-1, 1]), rng.uniform(2.5, 7.5), rng.uniform(0.6, 1.4)
    top, width, depth = rng.uniform(0.5, 0.9), rng.uniform(0.8, 1.4), rng.uniform(0.4, 0.6)
    radius, height = rng.uniform(0.022, 0.03), rng.uniform(0.1, 0.18)

    def block(name: str, size: list[float], along: float, across: float, bottom: float) -> None:
        """`across`: from the table's edge away from the lane."""
        world.add_box(name, size=size, pose=mg.pose([x + along, side * (edge + across), bottom + size[2] / 2]))

    place = [rng.uniform(-0.3, 0.3) * width, rng.uniform(0.05, 0.2)]
    block("table", [width, depth, top], 0, depth / 2, 0)
    block("wall", [13, 0.1, 1.5], 5 - x, depth + rng.uniform(0, 0.3) + 0.05, 0)
    beside = rng.choice([-1, 1]) * (width / 2 + rng.uniform(0.05, 0.4) + 0.2)
    block("cupboard", [0.4, depth, 1.5], beside, depth / 2, 0)
    if rng.random() < 0.5:
        block("board", [width, 0.7 * depth, 0.03], 0, 0.65 * depth, top + height + rng.uniform(0.15, 0.3))
    at = [x + place[0], side * (edge + place[1])]
    world.add("can", [mg.LinkShape(mg.Cylinder(radius, height))], mg.pose([*at, top + height / 2 + 0.001]))
    yaw = side * (np.pi / 2 + rng.uniform(-np.pi / 3, np.pi / 3))
    return world, mg.pose([*at, top + rng.uniform(0.45, 0.8) * height], rpy=[0, 0, yaw])


def timed(work: Callable[[], Any]) -> tuple[float, Any]:
    """Processor seconds and what came out."""
    begun = time.process_time()
    out = work()
    return time.process_time() - begun, out


def line(row: str, on: str, who: str, seconds: list[float], settings: str = "", **more: Any) -> None:
    """One JSON line; `value` is the median of processor time."""
    values = {"row": row, "on": on, "who": who, "value": statistics.median(seconds), "unit": "s"}
    values |= {"p95": float(np.percentile(seconds, 95)), **more, "settings": settings}
    print(json.dumps(values), flush=True)


def arguments(text: str | None, **integers: int) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=text, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, value in integers.items():
        parser.add_argument(f"--{name.replace('_', '-')}", type=int, default=value)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3])
    return parser


def plan(
    tasks: list[mg.DriveByTask], world: mg.World | None = None, base: str = "diff_drive", **options: Any
) -> mg.planning.DriveByResult:
    """The motion of the paper's example, past other tasks."""
    robot, group = whole_body(base=base)
    ends = {"start": START, "goal": GOAL} | {k: options.pop(k) for k in ("start", "goal") if k in options}
    return mg.plan_drive_by(robot, group, world or mg.World(), tasks=tasks, **ends, **options)
