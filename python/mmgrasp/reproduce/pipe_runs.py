"""What the tables and figures of P2 chapters 4 and 5 share: runs of planners over many grasps, and paired comparisons.

A run is one pipe cell with its own roadmap and its own list of grasps (P2 4.5.1: "each time the grasps and graph are
regenerated"); a shorter list is the beginning of the longer one. Times are those of the search: building the roadmap and
inverse kinematics come before it, as in P2, and are told apart.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from .._core import Outcome, Roadmap, plan_manipulation
from ..problems.pipe_cells import PipeCell, pipe_cell, pipe_robot
from .entry import Context

PROBLEMS = 8
GAMMA = 4.0  # P2 4.5.1
TIME_LIMIT = 15.0  # P2 4.5.1 [s]


def p2_cell(number: int, seed: int) -> PipeCell:
    """Open enough for roadmaps of P2's density, over which start and goal are not joined directly."""
    return pipe_cell(number, seed=seed, style="open")


@functools.lru_cache(maxsize=4)
def grasps_of(cell: PipeCell, run: int) -> list[Any]:
    """2000 grasps of a run, fewer where no more fit on the pipe."""
    return cell.grasps(2000, seed=1000 * cell.seed + run)


@functools.lru_cache(maxsize=20)  # ten runs, two of each
def roadmap_of(robot: str, vertices: int, run: int, neighbours: int = 0) -> Roadmap:
    return Roadmap.build(pipe_robot(robot)[1], vertices=vertices, gamma=GAMMA, neighbours=neighbours, seed=run + 1)


def carry(
    cell: PipeCell, count: int, run: int, *, vertices: int = 0, neighbours: int = 0, **options: Any
) -> dict[str, Any]:
    """One call of plan_manipulation as plain values; with `vertices` over the run's roadmap of that size."""
    if vertices:
        options.update(roadmap=roadmap_of(cell.robot_name, vertices, run, neighbours), shorten=False)
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
    better, ik_time = result.improvements, result.stats["ik_seconds"]
    return {
        "solved": solved,
        "first time": better[0].seconds - ik_time if solved else None,
        "best time": better[-1].seconds - ik_time if solved else None,
        "total time": result.stats["search_seconds"],
        "first cost": better[0].cost if solved else None,
        "cost": result.cost if solved else None,
        "ik time": ik_time,
        "reachable": sum(g.start_solutions > 0 and g.goal_solutions > 0 for g in result.grasps),
    }


def items_of(context: Context, problems: Iterable[int], runs: int) -> list[dict[str, int]]:
    return [{"number": n, "seed": context.seed, "run": run} for n in problems for run in range(runs)]


def mean(values: Iterable[float | None]) -> float | None:
    """Mean of what there is; None of nothing."""
    found = [v for v in values if v is not None]
    return float(np.mean(found)) if found else None


def difference(first: Sequence[float | None], second: Sequence[float | None]) -> tuple[float, float, int] | None:
    """Mean of first - second over the pairs that have both, half the width of its 95 % interval, and their number."""
    pairs = np.array([(a, b) for a, b in zip(first, second, strict=True) if a is not None and b is not None])
    if len(pairs) < 2:
        return None
    deltas = pairs[:, 0] - pairs[:, 1]
    return (
        float(deltas.mean()),
        float(_student(len(deltas) - 1) * deltas.std(ddof=1) / math.sqrt(len(deltas))),
        len(deltas),
    )


def not_reversed(smaller: Sequence[float | None], larger: Sequence[float | None]) -> bool:
    """That `smaller` is the smaller one on average, or not the larger one beyond the interval."""
    found = difference(smaller, larger)
    return found is None or found[0] - found[1] <= 0


def told(found: tuple[float, float, int] | None, unit: str = "") -> str:
    return "-" if found is None else f"{found[0]:+.3g} +- {found[1]:.2g}{unit} ({found[2]} pairs)"


def _student(freedom: int) -> float:
    """The two-sided 95 % point of Student's t, to 0.3 % (Cornish-Fisher)."""
    z = 1.959964
    g1 = (z**3 + z) / 4
    g2 = (5 * z**5 + 16 * z**3 + 3 * z) / 96
    g3 = (3 * z**7 + 19 * z**5 + 17 * z**3 - 15 * z) / 384
    return z + g1 / freedom + g2 / freedom**2 + g3 / freedom**3


def describe(context: Context, runs: int, problems: Sequence[int], **more: Any) -> dict[str, Any]:
    cells = [p2_cell(n, context.seed) for n in problems]
    turned_down: dict[str, int] = {}
    for cell in cells:
        for cause, count in cell.rejected.items():
            turned_down[cause] = turned_down.get(cause, 0) + count
    return {
        "arm": "the shipped TM14-like one with its gripper for pipes",
        "problems": ", ".join(map(str, problems)),
        "runs a problem": runs,
        "seed of the cells": context.seed,
        "cells rejected by the generator": ", ".join(f"{c}: {n}" for c, n in turned_down.items()) or "none",
        "arm configurations a grasp and end": 4,
        "threads": 1,
        "edge step": "0.02 rad and 5 mm",
        **more,
    }


def describe_roadmap(vertices: int) -> dict[str, Any]:
    """What P2 leaves open about its graph (errata.md): the box, the degree, gamma*."""
    figures = roadmap_of("tm14like", vertices, 0).statistics
    return {
        "roadmap": f"{vertices} vertices, gamma {GAMMA:g}, joints within half a turn either way",
        "mean degree": figures["mean_degree"],
        "vertices in the largest component": figures["largest_component"],
        "gamma*": figures["gamma_star"],
    }
