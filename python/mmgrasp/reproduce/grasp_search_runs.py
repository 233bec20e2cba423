"""What the tables of P2 chapter 3 share: three pipes along paths, their optima, and runs of five searches in nine settings.

P2 prints neither its paths nor its cell. Here the KR 6-like arm carries each pipe of table 3.3 along an arc of eleven poses
(its text counts ten waypoints), above a table and past a column. As in its Algorithm 3.1 motions between poses are not
checked for collisions. A run has found the optimum when its cost is within 0.1 % of the best that branch and bound and a
longer search know of; that no run found a grasp below the proven bound is checked with figure 3.11.
"""

from __future__ import annotations

import functools
import os
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np

from .. import _core
from .._core import (
    Hand,
    JointGroup,
    ObjectPathProblem,
    Outcome,
    Pipe,
    PipeProvenance,
    World,
    beam_frame,
    copper,
    optimize_grasp,
    pose,
)
from ..problems.pipe_cells import FINGERS, pipe_robot, pipe_structures
from .entry import Context
from .statements import Pair

PIPES = {"Pipe1": 6, "Pipe2": 5, "Pipe3": 8}  # numbers of the structures
POSES = 11
BUDGET = 1530  # P2 3.5.1
WITHIN = 1e-3  # of the optimum
METHODS = ("Str1", "Str2", "Str3", "GA", "PSO")
STRATEGIES = {"Str1": "independent", "Str2": "same_section", "Str3": "connected_sections"}
# P2 table 3.5: elite recruits, best sites, recruits, share of scouts [%], population; one elite site in all.
SETTINGS = {
    1: (12, 7, 3, 10, 34),
    2: (15, 7, 5, 10, 51),
    3: (20, 15, 5, 10, 102),
    4: (12, 5, 3, 30, 34),
    5: (15, 6, 4, 30, 51),
    6: (20, 11, 5, 30, 102),
    7: (10, 4, 3, 45, 34),
    8: (12, 5, 4, 45, 51),
    9: (15, 9, 5, 45, 102),
}
_RATES = (0.2, 0.3, 0.4)  # of mutation
_CONNECTIVITY = (0.1, 0.5, 1.0)


def options_of(method: str, setting: int) -> dict[str, Any]:
    """Keywords of optimize_grasp for one of the nine settings of a method (P2 3.5.1)."""
    elite, best, recruits, _, population = SETTINGS[setting]
    third = (setting - 1) // 3
    if method == "GA":
        return {"algorithm": "ga", "population": population, "mutation_rate": _RATES[third]}
    if method == "PSO":
        return {"algorithm": "pso", "population": population, "connectivity": _CONNECTIVITY[third]}
    return {
        "algorithm": "bees",
        "neighbourhood_kind": STRATEGIES[method],
        "population": population,
        "elite_sites": 1,
        "elite_recruits": elite,
        "best_sites": best,
        "recruits": recruits,
    }


def arc_around_arm(radius: float, height: float, rise: float, poses: int) -> list[np.ndarray]:
    """Along an arc around the world's z while the object turns, half way as much higher as `rise` says [m]."""
    path = []
    for s in np.linspace(0, 1, poses):
        turn = 1.2 * (s - 0.5)
        at = [radius * np.cos(turn), radius * np.sin(turn), height + rise * np.sin(np.pi * s)]
        path.append(pose(at, rpy=[0.3 * s, 0.4 * s, turn]))
    return path


def carrying(
    arm: JointGroup, gripper: Hand, structure: Pipe, world: World, path: list[np.ndarray]
) -> ObjectPathProblem:
    """A pipe of P2's copper tube; only the fingers may touch it."""
    return ObjectPathProblem(
        arm,
        world,
        structure.shapes(),
        np.array(path),
        gripper=gripper,
        touch_links=sorted(FINGERS),
        frame=beam_frame(structure, 0.010, copper()),
        object_name="pipe",
    )


@functools.cache
def path_problem(pipe: str, home: tuple[float, ...] | None = None) -> ObjectPathProblem:
    """`home`: where the arm stands before."""
    _, arm, gripper = pipe_robot("kr6like")
    if home is not None:
        arm = arm.with_reference(dict(zip(arm.names, home, strict=True)))
    world = World()
    world.add_box("table", [2.6, 2.6, 0.05], pose([0, 0, -0.03]))
    world.add_cylinder("column", 0.05, 0.3, pose([0.2625, 0, 0.15]))
    # As drawn, no grasp takes Pipe2 along this path without meeting the table: it lies with its ends up.
    lies = pose([0, 0, 0], rpy=[np.pi if pipe == "Pipe2" else 0.0, 0, 0])
    path = [T @ lies for T in arc_around_arm(0.45, 0.34, 0.08, POSES)]
    return carrying(arm, gripper, pipe_structures()[PIPES[pipe] - 1], world, path)


def search(pipe: str, home: tuple[float, ...] | None = None, **options: Any) -> _core.GraspOptimum:
    return optimize_grasp(path_problem(pipe, home), pipe_structures()[PIPES[pipe] - 1], check_edges=False, **options)


def free_configurations(pipe: str, count: int, seed: int) -> list[tuple[float, ...]]:
    """Configurations of the arm without a pipe, evenly within its limits."""
    robot, arm, _ = pipe_robot("kr6like")
    checker = _core.CollisionChecker(robot, path_problem(pipe).world, group=arm)
    rng = np.random.default_rng(seed)
    out: list[tuple[float, ...]] = []
    while len(out) < count:
        q = rng.uniform(arm.lower, arm.upper)
        if checker.is_free(q):
            out.append(tuple(float(value) for value in q))
    return out


def optimum(pipe: str, seed: int, boxes: int, evaluations: int, threads: int) -> dict[str, Any]:
    """The best grasp of branch and bound and of a search with many times P2's budget, and what is proven of it."""
    begun = time.perf_counter()
    proven = search(pipe, algorithm="branch_and_bound", max_boxes=boxes, time_limit=1e6, seed=seed, threads=threads)
    seconds = time.perf_counter() - begun
    longer = search(pipe, max_evaluations=evaluations, seed=seed + 1000)
    best = min((r for r in (proven, longer) if r.grasp is not None), key=lambda r: r.path.cost)
    assert best.grasp is not None
    held = best.grasp.provenance
    assert isinstance(held, PipeProvenance)
    return {
        "cost": best.path.cost,
        "lower bound": proven.lower_bound,
        "boxes": proven.boxes,
        "seconds": seconds,
        "grasp": [held.section + 1, 1000 * held.length, float(np.degrees(held.angle)), 180 if held.flipped else 0],
        "motion": best.path.joint_motion,
        "deflection": best.path.deflection,
        "force": best.path.force_manipulability,
        "path": best.path.path.tolist(),
        "front": len(best.front),
    }


def on_all_cores(run: Callable[[int], Any], runs: int) -> list[Any]:
    """Gives each run its own seed; the calls below leave Python free meanwhile."""
    with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        return list(pool.map(run, range(runs)))


def runs_of(
    pipe: str, method: str, settings: list[int], runs: int, seed: int, target: float
) -> dict[str, list[dict[str, Any]]]:
    """For each setting runs that differ in their seed; each ends at the target or when the budget is spent."""

    def one(number: int) -> tuple[Any, float]:
        begun = time.perf_counter()
        setting, run = settings[number // runs], number % runs
        seeds = 10_000 * seed + 100 * setting + run
        result = search(pipe, max_evaluations=BUDGET, target=target, seed=seeds, **options_of(method, setting))
        return result, time.perf_counter() - begun

    done = on_all_cores(one, runs * len(settings))
    by_setting = [(setting, done[i * runs : (i + 1) * runs]) for i, setting in enumerate(settings)]
    return {
        "settings": [
            {
                "pipe": pipe,
                "method": method,
                "setting": setting,
                "evaluations": [result.evaluations for result, _ in own],
                "seconds": [seconds for _, seconds in own],
                "cost": [result.path.cost if result.grasp is not None else None for result, _ in own],
                "solved": [result.outcome == Outcome.solved for result, _ in own],
            }
            for setting, own in by_setting
        ]
    }


def scale_of(context: Context) -> tuple[list[str], list[int], int, int, int]:
    """Pipes, settings, runs of each, boxes of branch and bound, evaluations of the longer search."""
    if context.quick:
        return ["Pipe1", "Pipe2"], [1, 5, 9], 2, 3000, 4000
    return list(PIPES), list(SETTINGS), 50, 1_000_000, 30_000


_KEPT: dict[tuple[str, bool, int], Any] = {}
_SECONDS: dict[tuple[str, bool, int], float] = {}


def _once(what: str, context: Context, compute: Callable[[], Any]) -> Any:
    """For all tables of a process together."""
    key = (what, context.quick, context.seed)
    if key not in _KEPT:
        begun = time.perf_counter()
        _KEPT[key] = compute()
        _SECONDS[key] = time.perf_counter() - begun
    return _KEPT[key]


def optima(context: Context) -> dict[str, dict[str, Any]]:
    """The optimum of each pipe."""

    def compute() -> dict[str, dict[str, Any]]:
        pipes, _, _, boxes, evaluations = scale_of(context)
        items = [
            {"pipe": p, "seed": context.seed, "boxes": boxes, "evaluations": evaluations, "threads": 0} for p in pipes
        ]
        return dict(zip(pipes, context.sweep(optimum, items, "optima"), strict=True))

    found: dict[str, dict[str, Any]] = _once("optima", context, compute)
    return found


def all_runs(context: Context) -> list[dict[str, Any]]:
    """Every method in every setting on every pipe."""
    known = optima(context)

    def compute() -> list[dict[str, Any]]:
        pipes, settings, runs, _, _ = scale_of(context)
        items = [
            {
                "pipe": pipe,
                "method": method,
                "settings": settings,
                "runs": runs,
                "seed": context.seed,
                "target": (1 + WITHIN) * known[pipe]["cost"],
            }
            for pipe in pipes
            for method in METHODS
        ]
        return [setting for found in context.sweep(runs_of, items, "searches") for setting in found["settings"]]

    found: list[dict[str, Any]] = _once("runs", context, compute)
    return found


def pairs(done: list[dict[str, Any]], value: str, larger: str, smaller: str) -> list[Pair]:
    """Two methods on the same pipe in the same setting: means over the runs. The pipe is the cell: settings of one pipe are
    no independent draws."""
    by = {(d["pipe"], d["setting"], d["method"]): float(np.mean(d[value])) for d in done}
    both = sorted({key[:2] for key in by})
    return [Pair(0, at[0], by.get((*at, larger)), by.get((*at, smaller))) for at in both]


def pairs_of_settings(
    done: list[dict[str, Any]], value: str, method: str, larger: int, smaller: int, which: int
) -> list[Pair]:
    """One method in settings that differ in one entry of SETTINGS (`which`: 3 scouts, 4 population), the pipe again the
    cell."""
    by = {
        (d["pipe"], SETTINGS[d["setting"]][7 - which], SETTINGS[d["setting"]][which]): float(np.mean(d[value]))
        for d in done
        if d["method"] == method
    }
    both = sorted({key[:2] for key in by})
    return [Pair(0, at[0], by.get((*at, larger)), by.get((*at, smaller))) for at in both]


def interval(hits: int, count: int) -> str:
    """Wilson's 95 % interval of a share, in per cent."""
    if count == 0:
        return "-"
    z, share = 1.959964, hits / count
    middle = (share + z * z / (2 * count)) / (1 + z * z / count)
    half = z * np.sqrt(share * (1 - share) / count + z * z / (4 * count * count)) / (1 + z * z / count)
    return f"{100 * max(0.0, middle - half):.1f} to {100 * min(1.0, middle + half):.1f}"


def describe(context: Context) -> dict[str, Any]:
    pipes, settings, runs, _, _ = scale_of(context)
    known = optima(context)
    shared = {
        text: round(_SECONDS[key], 1)
        for what, text in (
            ("optima", "optima, once for all these pages [s]"),
            ("runs", "runs of tables 3.7 to 3.11, once for all of them [s]"),
        )
        if (key := (what, context.quick, context.seed)) in _SECONDS
    }
    return {
        "arm": "the shipped KR 6-like one with its gripper for pipes",
        "pipes": ", ".join(pipes),
        "poses": POSES,
        "settings": ", ".join(map(str, settings)),
        "runs of each": runs,
        "most evaluations": BUDGET,
        "optimum": ", ".join(
            f"{p} {known[p]['cost']:.4f} (no grasp below {known[p]['lower bound']:.4f} by branch and bound)"
            for p in pipes
        ),
        "weights": "0.587, 0.089, 0.324; per rad, mm and 1",
        "threads": f"1 a search, {len(os.sched_getaffinity(0))} searches at once; branch and bound all",
        **shared,
    }
