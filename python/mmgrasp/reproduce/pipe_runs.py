"""What the tables and figures of P2 chapters 4 and 5 share: runs of planners over many grasps, and paired comparisons.

A run is one pipe cell with its own roadmap and its own list of grasps (P2 4.5.1: "each time the grasps and graph are
regenerated"); a shorter list is the beginning of the longer one. Cells come from three seeds. Times are those of the
search: building the roadmap and inverse kinematics come before it, as in P2, and are reported by themselves.
"""

from __future__ import annotations

import functools
import itertools
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from .._core import Outcome, Roadmap, plan_manipulation
from ..problems.pipe_cells import PipeCell, pipe_cell, pipe_robot
from .entry import Context
from .statements import Pair

PROBLEMS = 8
SEEDS = 3  # of the cells
RUNS = 3  # of a cell, in tables 4.1 and 4.2; one elsewhere: the pairs that are compared are cells
GAMMA = 4.0  # P2 4.5.1
TIME_LIMIT = 15.0  # P2 4.5.1 [s]


@functools.lru_cache(maxsize=4)
def grasps_of(cell: PipeCell, run: int) -> list[Any]:
    """2000 grasps of a run, fewer where no more fit on the pipe."""
    return cell.grasps(2000, seed=1000 * cell.seed + run)


@functools.lru_cache(maxsize=4)
def roadmap_of(robot: str, vertices: int, seed: int, gamma: float) -> Roadmap:
    """With gamma 0 as it ships."""
    return Roadmap.build(pipe_robot(robot)[1], vertices=vertices, gamma=gamma, seed=seed)


def plan_transfer(
    cell: PipeCell, count: int, run: int, *, vertices: int = 0, gamma: float = 0.0, **options: Any
) -> dict[str, Any]:
    """One call of plan_manipulation as plain values; with `vertices` over the run's roadmap of that size."""
    if vertices:
        options.update(roadmap=roadmap_of(cell.robot_name, vertices, 100 * cell.seed + run, gamma), shorten=False)
    result = plan_manipulation(
        cell.problem(grasps_of(cell, run)[:count]),
        seed=run + 1,
        threads=1,
        time_limit=TIME_LIMIT,
        first_grasps=0,
        straight=False,
        **options,
    )
    solved = result.outcome == Outcome.solved
    better, ik_time = result.improvements, result.stats.ik_seconds
    return {
        "solved": solved,
        "first time": better[0].seconds - ik_time if solved else None,
        "best time": better[-1].seconds - ik_time if solved else None,
        "total time": result.stats.search_seconds,
        "first cost": better[0].cost if solved else None,
        "cost": result.cost if solved else None,
        "ik time": ik_time,
        "reachable": sum(g.start_solutions > 0 and g.goal_solutions > 0 for g in result.grasps),
    }


def items_of(context: Context, problems: Iterable[int], runs: int) -> list[dict[str, int]]:
    return [
        {"number": number, "seed": seed, "run": run}
        for seed in seeds_of(context)
        for number in problems
        for run in range(runs)
    ]


def seeds_of(context: Context) -> range:
    """Seeds of the cells: 1 to 3 with the first seed, 4 to 6 with the second."""
    return range(SEEDS * (context.seed - 1) + 1, SEEDS * context.seed + 1)


def paired(done: Iterable[dict[str, Any]], values: Iterable[tuple[float | None, float | None]]) -> list[Pair]:
    """Two values of each run, which says where it belongs: first the one that is to be larger."""
    return [Pair(d["seed"], d["number"], *two) for d, two in zip(done, values, strict=True)]


def by_seed(done: Iterable[dict[str, Any]], values: Iterable[float]) -> str:
    """Means of the runs' values over each seed, in words."""
    found: dict[int, list[float]] = {}
    for d, value in zip(done, values, strict=True):
        found.setdefault(d["seed"], []).append(value)
    return ", ".join(f"{np.mean(values):.3g}" for values in found.values())


def mean(values: Iterable[float | None]) -> float | None:
    """Mean of what there is; None of nothing."""
    found = [v for v in values if v is not None]
    return float(np.mean(found)) if found else None


def describe(
    context: Context, runs: int, problems: Sequence[int], styles: Sequence[str] = ("narrow",), **more: Any
) -> dict[str, Any]:
    rejected: dict[str, int] = {}
    for style, seed, number in itertools.product(styles, seeds_of(context), problems):
        for cause, count in pipe_cell(number, seed, style=style).rejected.items():
            rejected[cause] = rejected.get(cause, 0) + count
    return {
        "arm": "the shipped TM14-like one with its gripper for pipes",
        "problems": ", ".join(map(str, problems)),
        "cells": f"{' and '.join(styles)}, one a problem and seed; drawn by geometry, inverse kinematics and straight lines, no planner asked",
        "seeds of the cells": ", ".join(map(str, seeds_of(context))),
        "runs a cell": runs,
        "cells rejected by the generator": ", ".join(f"{c}: {n}" for c, n in rejected.items()) or "none",
        "arm configurations a grasp and end": 4,
        "threads": 1,
        "edge step": "0.02 rad and 5 mm",
        **more,
    }


def describe_roadmap(context: Context, vertices: int, gamma: float = 0.0) -> dict[str, Any]:
    """What P2 leaves open about its graph (errata.md): the box, the degree, gamma*."""
    figures = roadmap_of("tm14like", vertices, 100 * seeds_of(context)[0], gamma).statistics
    joined = f"gamma {gamma:g}" if gamma > 0 else f"each joined with its {figures['neighbours']} nearest"
    return {
        "roadmap": f"{vertices} vertices, {joined}, joints within half a turn either way",
        "mean degree": figures["mean_degree"],
        "vertices in the largest component": figures["largest_component"],
        "gamma*": figures["gamma_star"],
    }
