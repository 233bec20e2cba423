"""P1 tables 3.2 and 3.3, figures 3.14 and 3.16: trays in a row, from base regions to the visiting order."""

from __future__ import annotations

import itertools
import time
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from . import stored_regions
from .drawing import figure, paper_and_ours
from .entry import Context, Entry, Result
from .setup import UNCERTAINTY, Row, database, describe, reach_samples

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Fixed beforehand from our figure 3.14: neighbours share a robust place, trays two apart do not.
SPACING = 0.40
PAPER_ROWS = {
    2: (1, 6.17),
    4: (2, 12.01),
    6: (3, 18.40),
    8: (4, 24.00),
    10: (5, 31.07),
    12: (6, 36.57),
    14: (7, 42.55),
    16: (8, 48.73),
    18: (9, 54.94),
    20: (10, 67.93),
    22: (11, 139.25),
}
SIZE, TIME = "sequence size", "time [s]"


def plan(row: Row, samples: int) -> dict[str, Any]:
    """Algorithm 1 on a row: how many stops, what they are, and what each step took."""
    reach = database(row, samples)
    problem = row.problem()
    count = len(problem.trays)
    marks = [time.perf_counter()]
    grid = _core.make_base_grid(problem, reach)
    objects = _core.ObjectRegions.compute(problem, reach, grid)
    marks.append(time.perf_counter())
    regions = [_core.BaseRegion(str(t), objects.region(t, objects.parts(t)), grid) for t in range(count)]
    marks.append(time.perf_counter())
    sets = _core.robust_intersections(grid, regions, UNCERTAINTY)
    marks.append(time.perf_counter())
    stops = _core.cover_from_intersections(grid, sets.robust, count)
    marks.append(time.perf_counter())
    order = _core.shortest_visiting_tour(_straight_lengths(problem, stops.stops)).order
    marks.append(time.perf_counter())
    steps = [b - a for a, b in itertools.pairwise(marks)]
    return {
        "size": len(stops.stops) if stops.outcome == _core.Outcome.solved else None,
        "least": stops.lower_bound,
        "uncovered": len(stops.unreachable_trays),
        "cells": [region.count for region in regions],
        "radii": [stops.stops[i].radius for i in order],
        "stops": [[float(v) for v in stops.stops[i].pose] for i in order],
        "trays": [list(stops.stops[i].trays) for i in order],
        "objects": sum(len(objects.parts(t)) for t in range(count)),
        "grasps": sum(len(part.grasps) for tray in problem.trays for part in tray.parts),
        "robust": len(sets.robust),
        "steps": steps,
        "seconds": marks[-1] - marks[0],
        "kept_seconds": sum(steps[1:]),
    }


def _straight_lengths(problem: _core.PartSupplyProblem, stops: list[_core.Stop]) -> np.ndarray:
    points = np.array([s.pose[:2] for s in stops] + [problem.start[:2], problem.goal[:2]])
    return np.asarray(np.linalg.norm(points[:, None] - points[None], axis=2))


def pair_radius(row: Row, samples: int) -> dict[str, Any]:
    """The largest disc in what the first and the last tray of a row share."""
    reach = database(row, samples)
    problem = row.problem()
    grid = _core.make_base_grid(problem, reach)
    a, *_, b = _core.compute_base_regions(problem, reach, grid)
    shared = a.cells(grid) & b.cells(grid)
    return {
        "radius": _core.inscribed_circle(grid, shared)[1],
        "cells": int(shared.sum()),
        "region cells": [a.count, b.count],
    }


def base_row(quick: bool) -> Row:
    """Two trays; the quick version's smaller database reaches no corner of a tray robustly."""
    row = Row(trays=2, objects=(9, 12), spacing=SPACING)
    return row.with_(objects=(3, 4), margin=0.05) if quick else row


# --- figure 3.14 ------------------------------------------------------------------------------------------------------
def run_distance(context: Context) -> Result:
    samples, row = reach_samples(context.quick), base_row(context.quick)
    step = 0.2 if context.quick else 0.05
    distances = [round(float(d), 3) for d in np.arange(0.30 if not context.quick else 0.4, 1.2001, step)]
    database(row, samples, progress=context.progress)
    found = context.sweep(
        pair_radius, [{"row": row.with_(spacing=d), "samples": samples} for d in distances], "p1-figure-3.14"
    )
    papers = stored_regions.run(context, [row.with_(spacing=d) for d in distances])
    result = Result(setup=describe(row, samples, "spacing [m]") | papers.describe())
    for index, (distance, ours) in enumerate(zip(distances, found, strict=True)):
        values = result.row({"distance [m]": distance})
        values["radius [m]"] = (None, ours["radius"])
        values["radius >= 0.10"] = (distance < 0.8, ours["radius"] >= UNCERTAINTY)
        values["cells shared"] = (None, ours["cells"])
        values["cells of a region"] = (None, ours["region cells"][0])
        values["objects"] = (None, 2 * row.per_tray)
        values["grasps"] = (None, 2 * row.per_tray * row.grasps)
        papers.fill(values, index)
    radii = [ours["radius"] for ours in found]
    robust = [d for d, r in zip(distances, radii, strict=True) if r >= UNCERTAINTY]
    farthest = max(robust, default=None)
    result.trend(
        "the radius falls with the distance (no step upwards of more than half a cell)",
        all(b <= a + 0.025 for a, b in itertools.pairwise(radii)),
    )
    result.trend(
        "two trays are robust together up to one distance and not beyond it",
        bool(robust) and robust == [d for d in distances if d <= max(robust)],
    )
    for density, rows in zip(papers.densities, papers.found, strict=True):
        wide = max((d for d, f in zip(distances, rows, strict=True) if f["radius"] >= UNCERTAINTY), default=None)
        result.notes.append(
            f"The paper's pairs stay robust below 0.8 m, its algorithm's with {density.name} up to {wide} m, ours up to {farthest} m."
        )
    papers.conclude(result)
    result.drawing = {"limit": UNCERTAINTY}
    return result


def draw_distance(result: dict[str, Any]) -> Figure:
    fig, (axis,) = figure(6.0, 3.6)
    x = [row["key"]["distance [m]"] for row in result["rows"]]
    paper_and_ours(axis, x, result["rows"], "radius [m]")
    for (algorithm, radii), marker in zip(stored_regions.radii(result["rows"]).items(), "sv", strict=False):
        axis.plot(x, radii, "--", marker=marker, markersize=4, linewidth=1, color="#d98324", label=algorithm)
    axis.legend(fontsize=8)
    axis.axhline(result["drawing"]["limit"], color="#b8405e", linewidth=1)
    axis.annotate("needed: the positioning uncertainty", (0.3, 0.085), color="#b8405e", fontsize=8)
    axis.axvline(0.8, color="#8a8f98", linestyle="--", linewidth=1)
    axis.annotate("paper: >= 0.10 m\nbelow 0.8 m", (0.61, 0.255), color="#6a6f78", fontsize=8)
    axis.set(
        xlabel="distance between the trays [m]",
        ylabel="radius of the largest shared disc [m]",
        ylim=(0, None),
    )
    return fig


# --- table 3.2 --------------------------------------------------------------------------------------------------------
def run_steps(context: Context) -> Result:
    samples = reach_samples(context.quick)
    row = base_row(context.quick).with_(trays=4 if context.quick else 10)
    database(row, samples, progress=context.progress)
    (ours,) = context.sweep(plan, [{"row": row, "samples": samples}], "p1-table-3.2")
    compute, gather, robust, least, order = ours["steps"]
    result = Result(setup=describe(row, samples))
    lines = [
        ("Generate base regions for all objects", 30.58, compute),
        ("Explore intersections", 0.029, gather),
        ("Find robust positions", 0.226, robust),
        ("Least set of positions", None, least),
        ("Search for the shortest path", 0.0, order),
    ]
    for name, paper, seconds in lines:
        result.row({"sub-task": name})["Calculation time (s)"] = (paper, seconds)
    for name, value in (("objects", row.trays * row.per_tray), ("grasps", row.trays * row.per_tray * row.grasps)):
        result.row({"sub-task": "of the set-up"})[name] = (value if not context.quick else None, ours[name])
    result.row({"sub-task": "of the set-up"})["cells in all regions"] = (None, sum(ours["cells"]))
    result.trend("the base regions take most of the time", compute > 0.5 * ours["seconds"], clock=True)
    result.trend("the regions ten times as fast", 10 * compute <= 30.58, clock=True)
    result.notes.append(
        "'Explore intersections' is intersecting the ready regions of all objects of each tray; the search for sets of trays with a "
        "robust disc does not list the others first, so it is one step with finding their discs. The shortest path is over "
        "straight lines, as in the paper."
    )
    return result


# --- table 3.3 and figure 3.16 ----------------------------------------------------------------------------------------
def _fill(values: dict[str, tuple[Any, Any]], ours: dict[str, Any], paper: tuple[int, float] | None) -> None:
    size, seconds = paper if paper is not None else (None, None)
    values[SIZE] = (size, ours["size"])
    values[TIME] = (seconds, ours["seconds"])
    values["time, regions kept [s]"] = (None, ours["kept_seconds"])
    values["proven least"] = (None, ours["least"])
    values["least radius [m]"] = (None, min(ours["radii"], default=None))
    values["objects"] = (None, ours["objects"])
    values["grasps"] = (None, ours["grasps"])
    values["cells of a region (least)"] = (None, min(ours["cells"]))


def run_rows(context: Context) -> Result:
    samples = reach_samples(context.quick)
    counts = [2, 4, 6] if context.quick else list(PAPER_ROWS)
    row = base_row(context.quick)
    database(row, samples, progress=context.progress)
    near, far = context.sweep(
        pair_radius,
        [{"row": row.with_(spacing=d), "samples": samples} for d in (SPACING, 2 * SPACING)],
        "radius at s and at 2 s",
    )
    found = context.sweep(plan, [{"row": row.with_(trays=n), "samples": samples} for n in counts], "p1-table-3.3")
    result = Result(setup=describe(row, samples, "trays"))
    result.setup["radius at the spacing [m]"] = near["radius"]
    result.setup["radius at twice the spacing [m]"] = far["radius"]
    for n, ours in zip(counts, found, strict=True):
        _fill(result.row({"trays": n}), ours, PAPER_ROWS[n])
    result.exact(
        "every sequence is as long as the paper's, and proven least",
        all(o["size"] == PAPER_ROWS[n][0] == o["least"] for n, o in zip(counts, found, strict=True)),
    )
    result.exact(f"spacing {SPACING} m: radius(s) >= 0.10 > radius(2 s)", near["radius"] >= UNCERTAINTY > far["radius"])
    result.trend(
        "ten times as fast in every row",
        all(10 * o["seconds"] <= PAPER_ROWS[n][1] for n, o in zip(counts, found, strict=True)),
        clock=True,
    )
    result.trend(
        "the time does not explode: per tray the last row takes no more than twice the first",
        _linear(counts, found),
        clock=True,
    )
    return result


def _linear(counts: list[int], found: list[dict[str, Any]]) -> bool:
    return bool(found[-1]["seconds"] / counts[-1] <= 2 * found[0]["seconds"] / counts[0])


def draw_rows(result: dict[str, Any]) -> Figure:
    """Figure 3.16."""
    fig, axes = figure(9.0, 3.6, columns=2)
    x = [row["key"]["trays"] for row in result["rows"]]
    paper_and_ours(axes[0], x, result["rows"], TIME)
    axes[0].set(xlabel="trays in the row", ylabel="calculation time [s]", yscale="log")
    paper_and_ours(axes[1], x, result["rows"], SIZE)
    axes[1].set(xlabel="trays in the row", ylabel="sequence size", ylim=(0, None))
    return fig


def run_long_rows(context: Context) -> Result:
    samples = reach_samples(context.quick)
    counts = [4, 8] if context.quick else [22, 50, 100, 200, 500]
    row = base_row(context.quick)
    database(row, samples, progress=context.progress)
    found = context.sweep(plan, [{"row": row.with_(trays=n), "samples": samples} for n in counts], "p1-figure-3.16")
    result = Result(setup=describe(row, samples, "trays"))
    for n, ours in zip(counts, found, strict=True):
        _fill(result.row({"trays": n}), ours, PAPER_ROWS.get(n))
    result.exact(
        "half as many stops as trays, proven",
        all(o["size"] == n // 2 == o["least"] for n, o in zip(counts, found, strict=True)),
    )
    result.trend(
        "time linear in the trays: per tray the last row takes no more than twice the first",
        _linear(counts, found),
        clock=True,
    )
    return result


def run_spacings(context: Context) -> Result:
    samples = reach_samples(context.quick)
    row = base_row(context.quick).with_(trays=4 if context.quick else 10)
    spacings = [0.4, 0.8, 1.2] if context.quick else [round(0.3 + 0.05 * i, 2) for i in range(19)]
    database(row, samples, progress=context.progress)
    found = context.sweep(
        plan, [{"row": row.with_(spacing=s), "samples": samples} for s in spacings], "p1-table-3.3-spacings"
    )
    result = Result(setup=describe(row, samples, "spacing [m]"))
    for spacing, ours in zip(spacings, found, strict=True):
        _fill(result.row({"trays": row.trays, "spacing [m]": spacing}), ours, None)
    sizes = [o["size"] for o in found]
    result.trend("wider spacing never saves a stop", all(a <= b for a, b in itertools.pairwise(sizes)))
    result.trend("from some spacing on every tray needs a stop of its own", sizes[-1] == row.trays)
    result.notes.append(
        "Trays are 0.40 m wide along the row: at 0.30 and 0.35 m they overlap, which only the walls notice that the arm passes over."
    )
    return result


def draw_spacings(result: dict[str, Any]) -> Figure:
    fig, (axis,) = figure(6.0, 3.4)
    x = [row["key"]["spacing [m]"] for row in result["rows"]]
    paper_and_ours(axis, x, result["rows"], SIZE)
    axis.set(xlabel="spacing of the trays [m]", ylabel=f"stops for {result['setup']['trays']} trays", ylim=(0, None))
    return fig


ENTRIES = [
    Entry("p1-figure-3.14", "Radius shared by two trays against their distance", run_distance, draw_distance),
    Entry("p1-table-3.2", "Time of each sub-task, 10 trays of 9x12 objects", run_steps),
    Entry("p1-table-3.3", "Trays in a row: sequence size and time", run_rows, draw_rows),
    Entry("p1-table-3.3-spacings", "Sequence size against the spacing of the row", run_spacings, draw_spacings),
    Entry("p1-figure-3.16", "Time against the number of trays, to 500", run_long_rows, draw_rows),
]
