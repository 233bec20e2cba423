"""P1 3.7.1, 3.7.2 and table 3.5: trays 1, 2 and 4 served from two stops instead of three, and the driving time that saves.

Robot and room are simulated: the base drives between the stops on collision-free ways with a velocity profile, and comes to
stand where its positioning error takes it.
"""

from __future__ import annotations

import statistics
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from .drawing import TRAY_COLOURS, cells_to_runs, draw_cells, figure, grid_values
from .entry import Context, Entry, Result
from .rows import SPACING
from .scanned_trays import SCANS, parts_from, random_scan
from .setup import UNCERTAINTY, Row, database, describe, reach_samples

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TRAYS = (1, 2, 4)
MIDDLES = tuple(round((tray - 1) * SPACING, 6) for tray in TRAYS)
PAPER_TIMES = {"ExperA": (46.94, 29.68), "ExperB": (38.20, 26.98)}


def problem_of(placement: str, seed: int) -> _core.PartSupplyProblem:
    """ExperA: four objects on a grid (P1 3.7.3). ExperB: the grasps of four scans of a tray with parts thrown in."""
    row = experiment_row()
    if placement == "ExperA":
        return row.problem()
    scans = [[g for scan in range(SCANS) for g in random_scan(row, t, scan, seed).grasps] for t in range(row.trays)]
    return row.problem([parts_from(row, t, grasps) for t, grasps in enumerate(scans)])


def experiment_row() -> Row:
    return Row(trays=3, objects=(2, 2), middles=MIDDLES)


def plan(placement: str, samples: int, seed: int) -> dict[str, Any]:
    """The planned stops and, as the baseline, the middle of each region."""
    reach, problem = database(experiment_row(), samples), problem_of(placement, seed)
    grid = _core.make_base_grid(problem, reach)
    regions = _core.compute_base_regions(problem, reach, grid)
    sets = _core.robust_intersections(grid, regions, UNCERTAINTY)
    stops = _core.cover_from_intersections(grid, sets.robust, len(TRAYS))
    circles = [_core.inscribed_circle(grid, r.cells(grid)) for r in regions]
    return {
        "grid": grid_values(grid),
        "runs": [cells_to_runs(r.cells(grid)[0]) for r in regions],
        "cells": [r.count for r in regions],
        "objects": sum(len(r.explanations) for r in regions),
        "grasps": sum(e.grasps for r in regions for e in r.explanations),
        "baseline": [[float(c[0]), float(c[1]), 0.0] for c, _ in circles],
        "baseline radii": [radius for _, radius in circles],
        "stops": [[float(v) for v in s.pose] for s in stops.stops],
        "radii": [s.radius for s in stops.stops],
        "trays": [[TRAYS[t] for t in s.trays] for s in stops.stops],
        "least": stops.lower_bound,
    }


def drive(seed: int, stops: list[list[float]], run: int) -> dict[str, Any]:
    """One run over the stops: each is missed by an error drawn from the disc's normal distribution (10 cm on average)."""
    problem = experiment_row().problem()
    rng = np.random.default_rng([seed, run])
    wanted = [np.array(stop) for stop in stops]
    points = np.array([p[:2] for p in [*wanted, problem.start, problem.goal]])
    order = _core.shortest_visiting_tour(np.linalg.norm(points[:, None] - points[None], axis=2)).order
    here, seconds, length = problem.start, 0.0, 0.0
    for target in [*(wanted[i] for i in order), problem.goal]:
        leg = _core.plan_base_route(problem.arm, problem.world, home=problem.home, start=here, goal=target)
        if leg.outcome != _core.Outcome.solved:
            return {"seconds": None, "length": None}
        seconds += leg.duration(problem.robot)
        length += leg.length
        here = _missed(rng, problem, target)
    return {"seconds": seconds, "length": length}


def _missed(rng: np.random.Generator, problem: _core.PartSupplyProblem, target: np.ndarray) -> np.ndarray:
    """Where the base comes to stand: off by 0.10 m on average, evenly in all directions, and where it has room."""
    moving = problem.robot.group("arm", tip=problem.gripper.tool_link, with_base=True)
    checker = _core.CollisionChecker(problem.robot, problem.world, group=moving)
    while True:
        pose: np.ndarray = target + [*rng.normal(0.0, UNCERTAINTY / np.sqrt(np.pi / 2), 2), 0.0]
        if checker.is_free([*pose, *problem.home]):
            return pose


# --- experiment 3.7.1 -------------------------------------------------------------------------------------------------
def run_experiment(context: Context) -> Result:
    samples = reach_samples(context.quick)
    row = experiment_row()
    database(row, samples, progress=context.progress)
    item = {"placement": "ExperA", "samples": samples, "seed": context.seed}
    (ours,) = context.sweep(plan, [item], "p1-experiment-3.7.1")
    result = Result(setup=describe(row, samples, "spacing [m]", "trays"))
    result.setup["trays"] = f"1, 2 and 4 of a row {SPACING} m apart"
    values = result.row({"sequence": "planned"})
    values["stops"] = (2, len(ours["stops"]))
    values["trays of each stop"] = ("{1,2} {4}", " ".join(_braces(t) for t in sorted(ours["trays"])))
    values["least radius [m]"] = (None, min(ours["radii"], default=None))
    values["objects"] = (3 * 4, ours["objects"])
    values["grasps"] = (None, ours["grasps"])
    values["cells"] = (None, " ".join(map(str, ours["cells"])))
    values = result.row({"sequence": "baseline"})
    alone = [tray for tray, radius in zip(TRAYS, ours["baseline radii"], strict=True) if radius >= UNCERTAINTY]
    values["stops"] = (3, len(alone))
    values["trays of each stop"] = ("{1} {2} {4}", " ".join(_braces([t]) for t in alone))
    values["least radius [m]"] = (None, min(ours["baseline radii"]))
    result.exact("2 stops, {1,2} and {4}, proven least", sorted(ours["trays"]) == [[1, 2], [4]] and ours["least"] == 2)
    result.trend(
        "every stop of both keeps a disc of 0.10 m", min(ours["radii"] + ours["baseline radii"]) >= UNCERTAINTY
    )
    result.drawing = {key: ours[key] for key in ("grid", "runs", "baseline", "stops")} | {"middles": row.tray_middles()}
    return result


def _braces(trays: list[int]) -> str:
    return "{" + ",".join(map(str, trays)) + "}"


def draw_experiment(result: dict[str, Any]) -> Figure:
    """Figures 3.18 and 3.19 from above."""
    from matplotlib.patches import Rectangle

    drawing = result["drawing"]
    fig, (axis,) = figure(7.0, 4.6)
    for i, runs in enumerate(drawing["runs"]):
        draw_cells(axis, drawing["grid"], runs, TRAY_COLOURS[i])
        y = drawing["middles"][i]
        axis.add_patch(Rectangle((y - 0.2, -0.15), 0.4, 0.3, fill=False, edgecolor=TRAY_COLOURS[i], linewidth=1.5))
        axis.annotate(str(TRAYS[i]), (y, 0), ha="center", va="center", color=TRAY_COLOURS[i])
    for name, colour, marker in (("baseline", "#8a8f98", "s"), ("stops", "#C1121F", "o")):
        x, y = [p[1] for p in drawing[name]], [p[0] for p in drawing[name]]
        axis.plot(
            x,
            y,
            linestyle="none",
            color=colour,
            marker=marker,
            label="planned stops" if name == "stops" else "baseline",
        )
    axis.set(xlabel="along the row [m]", ylabel="towards the trays [m]", aspect="equal", ylim=(-1.3, 0.7))
    axis.set(xlim=(min(drawing["middles"]) - 1.1, max(drawing["middles"]) + 1.1))
    axis.legend(frameon=False, loc="upper left")
    return fig


# --- table 3.5 --------------------------------------------------------------------------------------------------------
def run_driving(context: Context) -> Result:
    samples = reach_samples(context.quick)
    runs = 2 if context.quick else 10
    names = ["ExperA"] if context.quick else ["ExperA", "ExperB"]
    row = experiment_row()
    database(row, samples, progress=context.progress)
    common = {"samples": samples, "seed": context.seed}
    plans = context.sweep(plan, [{"placement": name, **common} for name in names], "stops")
    items = [
        {"seed": context.seed, "stops": ours[kind], "run": run}
        for name, ours in zip(names, plans, strict=True)
        for kind in ("baseline", "stops")
        for run in range(runs)
    ]
    legs = iter(context.sweep(drive, items, "driving"))
    result = Result(setup=describe(row, samples, "spacing [m]", "trays", "objects"))
    result.setup |= {"trays": f"1, 2 and 4 of a row {SPACING} m apart", "runs": runs, "seed": context.seed}
    result.setup["velocity profile"] = "trapezoidal, 0.6 m/s, 0.5 m/s2, 1.0 rad/s, 1.0 rad/s2, a stop at every turn"
    result.setup["positioning error"] = "normal, 0.10 m on average"
    for name, ours in zip(names, plans, strict=True):
        times = [[next(legs)["seconds"] for _ in range(runs)] for _ in range(2)]
        if any(t is None for kind in times for t in kind):
            result.trend(f"{name}: every drive found", False)
            continue
        baseline, planned = (statistics.mean(t) for t in times)
        paper = PAPER_TIMES[name]
        values = result.row({"Experiment": name})
        values["Baseline"] = (paper[0], baseline)
        values["Planned sequence"] = (paper[1], planned)
        values["Improvement [s]"] = (round(paper[1] - paper[0], 2), planned - baseline)
        values["Improvement [%]"] = (round(100 * (paper[1] / paper[0] - 1), 2), 100 * (planned / baseline - 1))
        values["stops"] = (None, f"{len(ours['baseline'])} -> {len(ours['stops'])}")
        values["standard deviation of a run [s]"] = (
            None,
            statistics.stdev([b - a for a, b in zip(*times, strict=True)]),
        )
        values["objects"] = (None, ours["objects"])
        values["grasps"] = (None, ours["grasps"])
        result.trend(
            f"{name}: one stop less saves driving time in every run", all(b < a for a, b in zip(*times, strict=True))
        )
    if not context.quick:
        result.near_paper("Improvement [s]", 0.25)
        result.near_paper("Improvement [%]", 0.25)
    result.notes.append(
        "The paper's times come from a real room, whose size it does not print; ours are those of the way from 1 m before the row "
        "to 1 m behind it, so that the saving in seconds compares and the share does not."
    )
    return result


ENTRIES = [
    Entry("p1-experiment-3.7.1", "Trays 1, 2 and 4: two stops instead of three", run_experiment, draw_experiment),
    Entry("p1-table-3.5", "Time for moving the base, 10 runs", run_driving),
]
