"""P2 5.4: RRT*-MG beside PRM*-MG, with and without trees from both ends and informed sampling, and its p_blt."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..problems.pipe_cells import pipe_cell
from .drawing import figure
from .entry import Context, Entry, Result
from .pipe_runs import PROBLEMS, by_seed, describe, describe_roadmap, items_of, mean, paired, plan_transfer

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COUNTS = (50, 100, 500, 1000, 2000)
SAMPLES = 1000
PLANNERS = ("RRT*-MG", "PRM*-MG 1000", "PRM*-MG 20000")
COLOURS = {"RRT*-MG": "#2a9d5c", "PRM*-MG 1000": "#1f6fb4", "PRM*-MG 20000": "#C1121F"}


def _scale(context: Context) -> tuple[list[int], int, tuple[int, ...]]:
    return ([1, 3], 1, (50, 100)) if context.quick else (list(range(1, PROBLEMS + 1)), 1, COUNTS)


# --- figures 5.5 and 5.6 ----------------------------------------------------------------------------------------------
def both_planners(number: int, seed: int, run: int, counts: tuple[int, ...], large: int) -> dict[str, Any]:
    """One run of each planner for each number of grasps; PRM*-MG in its standard variant, a fifth of the grasps a batch."""
    cell = pipe_cell(number, seed)
    found: dict[str, list[dict[str, Any]]] = {}
    for count in counts:
        batch = max(1, count // 5)
        ones = (
            plan_transfer(cell, count, run, planner="rrt_star_mg", max_iterations=SAMPLES),
            plan_transfer(cell, count, run, vertices=1000, batch=batch, lazy_grasps=False),
            plan_transfer(cell, count, run, vertices=large, batch=batch, lazy_grasps=False),
        )
        for name, one in zip(PLANNERS, ones, strict=True):
            found.setdefault(name, []).append(one)
    return {"number": number, "seed": seed, "found": found}


CURVES = {
    "cost of first solution": "first cost",
    "cost of best solution": "cost",
    "time to first solution [s]": "first time",
    "time to best solution [s]": "best time",
    "total time [s]": "total time",
}
PAPER_FIRST = {"RRT*-MG": 0.05, "PRM*-MG 1000": 0.5}  # in words (P2 5.4.1) [s]


def run_compared(context: Context) -> Result:
    problems, runs, counts = _scale(context)
    large = 2000 if context.quick else 20000
    items = [i | {"counts": counts, "large": large} for i in items_of(context, problems, runs)]
    done = context.sweep(both_planners, items, "p2-figure-5.5")
    result = Result()
    lines: dict[str, dict[str, list[float | None]]] = {name: {key: [] for key in CURVES.values()} for name in PLANNERS}
    pairs: dict[str, dict[str, list[float]]] = {name: {key: [] for key in CURVES.values()} for name in PLANNERS}
    for k, count in enumerate(counts):
        solved = [d["found"] for d in done if all(d["found"][name][k]["solved"] for name in PLANNERS)]
        for name in PLANNERS:
            values = result.row({"grasps": count, "planner": name})
            values["success rate"] = (None, float(np.mean([d["found"][name][k]["solved"] for d in done])))
            for column, key in CURVES.items():
                here = [found[name][k][key] for found in solved]
                pairs[name][key] += here
                lines[name][key].append(mean(here))
                values[column] = (None, lines[name][key][-1])
    for name in PLANNERS:
        values = result.row({"grasps": "all", "planner": name})
        for column, key in CURVES.items():
            values[column] = (PAPER_FIRST.get(name) if key == "first time" else None, mean(pairs[name][key]))
    each = [
        {name: d["found"][name][k] for name in PLANNERS} | {"number": d["number"], "seed": d["seed"]}
        for d in done
        for k in range(len(counts))
    ]
    for name in PLANNERS[1:]:
        result.statement(
            f"success rate, RRT*-MG less {name}",
            paired(each, [(d["RRT*-MG"]["solved"], d[name]["solved"]) for d in each]),
        )
        for key, what in (("cost", "best cost"), ("first time", "time to first solution [s]")):
            result.statement(
                f"{what}, {name} less RRT*-MG where both succeed",
                paired(each, [(d[name][key], d["RRT*-MG"][key]) for d in each]),
                clock=key != "cost",
            )
    result.setup = describe(context, runs, problems, samples=SAMPLES, **describe_roadmap(context, large))
    result.notes.append("Means of cost and time are over the runs that all three solved; the rate is over all.")
    if context.quick:
        result.notes.append(f"Quick version: {large} vertices stand for 20,000.")
    result.drawing = {"counts": list(counts), "lines": lines}
    return result


def draw_compared(stored: dict[str, Any]) -> Figure:
    """Figures 5.5 (a), (b) and 5.6 (a), (b), (c)."""
    drawing = stored["drawing"]
    fig, axes = figure(12.0, 6.6, 3, 2)
    for axis, (column, key) in zip(axes, CURVES.items(), strict=False):
        for name, line in drawing["lines"].items():
            points = [(c, v) for c, v in zip(drawing["counts"], line[key], strict=True) if v is not None]
            if points:
                axis.plot(*zip(*points, strict=True), color=COLOURS[name], marker="o", label=name)
        axis.set(xscale="log", yscale="log" if "time" in key else "linear", xlabel="grasps", ylabel=column)
    axes[0].legend(frameon=False)
    axes[-1].set_axis_off()
    return fig


# --- table 5.1 --------------------------------------------------------------------------------------------------------
VERSIONS = {"V1": (69.75, 2915, 3301, 6.29, 5.80), "V2": (99.50, 57, 252, 5.40, 3.37)}
COLUMNS = ("success rate [%]", "initial time [ms]", "optimal time [ms]", "initial cost", "optimal cost")


def versions(number: int, seed: int, run: int, counts: tuple[int, ...], samples: int) -> dict[str, Any]:
    """V1: trees from the start alone, samples from the whole joint limits. V2: from both ends, informed."""
    cell = pipe_cell(number, seed)
    found = {}
    for name, on in (("V1", False), ("V2", True)):
        found[name] = [
            plan_transfer(
                cell, count, run, planner="rrt_star_mg", max_iterations=samples, bidirectional=on, informed=on
            )
            for count in counts
        ]
    return {"number": number, "seed": seed, "found": found}


def run_versions(context: Context) -> Result:
    problems, runs, counts = _scale(context)
    items = [i | {"counts": counts, "samples": SAMPLES} for i in items_of(context, problems, runs)]
    done = context.sweep(versions, items, "p2-table-5.1")
    result = Result()
    flat = {name: [one for d in done for one in d["found"][name]] for name in VERSIONS}
    for name, paper in VERSIONS.items():
        ours = (
            100 * float(np.mean([one["solved"] for one in flat[name]])),
            *(_milliseconds(mean(one[key] for one in flat[name])) for key in ("first time", "best time")),
            *(mean(one[key] for one in flat[name]) for key in ("first cost", "cost")),
        )
        values = result.row({"version": name})
        for column, p, o in zip(COLUMNS, paper, ours, strict=True):
            values[column] = (p, o)
        values["success rate of each seed [%]"] = (
            None,
            by_seed(done, [100 * float(np.mean([one["solved"] for one in d["found"][name]])) for d in done]),
        )
        values["runs"] = (None, len(flat[name]))
    each = [
        {name: d["found"][name][k] for name in VERSIONS} | {"number": d["number"], "seed": d["seed"]}
        for d in done
        for k in range(len(counts))
    ]
    result.statement("success rate, V2 less V1", paired(each, [(d["V2"]["solved"], d["V1"]["solved"]) for d in each]))
    for key in ("first time", "first cost", "cost"):
        result.statement(
            f"{key}, V1 less V2 where both succeed",
            paired(each, [(d["V1"][key], d["V2"][key]) for d in each]),
            clock="time" in key,
        )
    if not context.quick:
        first, best = (mean(one[key] for one in flat["V2"]) for key in ("first time", "best time"))
        result.trend(
            "V2: first solution within a tenth of the paper's 57 ms", first is not None and first <= 0.0057, clock=True
        )
        result.trend(
            "V2: best solution within a tenth of the paper's 252 ms", best is not None and best <= 0.0252, clock=True
        )
        rate = float(np.mean([one["solved"] for one in flat["V2"]]))
        result.trend("V2 solves at least 99 % of the runs, as P2's does", rate >= 0.99)
    result.setup = describe(context, runs, problems, grasps=", ".join(map(str, counts)), samples=SAMPLES)
    result.notes.append(
        "V1 leaves out the two things that the table is about and nothing else: it is our RRT*-MG with trees from the start"
        " alone, which join the goals at any distance, and so it succeeds more often than P2's."
    )
    result.notes.append(
        f"Not in these times, as in P2: inverse kinematics, {mean(d['found']['V2'][-1]['ik time'] for d in done):.3g} s for {counts[-1]} grasps."
    )
    return result


def _milliseconds(seconds: float | None) -> float | None:
    return None if seconds is None else 1000 * seconds


# --- tables 5.2 and 5.3 -----------------------------------------------------------------------------------------------
EXPLORATION = (1.0, 0.5, 0.0)
TABLE_5_2 = {1.0: (100, 2741, 3.22), 0.5: (100, 3146, 2.99), 0.0: (100, 3859, 3.01)}
TABLE_5_3 = {1.0: (100, 1779, 3.49), 0.5: (100, 2809, 3.49), 0.0: (100, 1213, 3.60)}


def explorations(number: int, seed: int, run: int, count: int, samples: int) -> dict[str, Any]:
    cell = pipe_cell(number, seed)
    found = [
        plan_transfer(cell, count, run, planner="rrt_star_mg", max_iterations=samples, exploration=share)
        for share in EXPLORATION
    ]
    return {"number": number, "seed": seed, "found": found}


def _explored(
    context: Context, name: str, problems: list[int], runs: int, paper: dict[float, tuple[int, int, float]]
) -> Result:
    count, samples = (100, 1000) if context.quick else (2000, 20000)
    items = [i | {"count": count, "samples": samples} for i in items_of(context, problems, runs)]
    done = context.sweep(explorations, items, name)
    result = Result()
    for k, share in enumerate(EXPLORATION):
        ones = [d["found"][k] for d in done]
        values = result.row({"p_blt": share})
        values["success rate [%]"] = (paper[share][0], 100 * float(np.mean([one["solved"] for one in ones])))
        values["optimal time [ms]"] = (paper[share][1], _milliseconds(mean(one["best time"] for one in ones)))
        values["optimal cost"] = (paper[share][2], mean(one["cost"] for one in ones))
        values["runs"] = (None, len(ones))
    for share, k in ((1.0, 0), (0.0, 2)):
        if paper[share][2] == paper[0.5][2]:
            continue  # The paper has no difference either.
        a, b = (k, 1) if paper[share][2] > paper[0.5][2] else (1, k)
        result.statement(
            f"cost, p_blt {EXPLORATION[a]:g} less {EXPLORATION[b]:g}",
            paired(done, [(d["found"][a]["cost"], d["found"][b]["cost"]) for d in done]),
        )
    if not context.quick:
        for key, values in result.rows:
            theirs, ours = values["optimal time [ms]"]
            result.trend(
                f"p_blt {key['p_blt']:g}: best solution within a tenth of the paper's {theirs} ms",
                ours is not None and ours <= 0.1 * theirs,
                clock=True,
            )
    result.setup = describe(context, runs, problems, grasps=count, samples=samples)
    result.notes.append(
        "Ours draws samples in the ellipsoids of all grasps whatever p_blt is, and cuts corners on the paths of several grasps."
    )
    return result


def run_exploration(context: Context) -> Result:
    problems, runs, _ = _scale(context)
    return _explored(context, "p2-table-5.2", problems, runs, TABLE_5_2)


def run_problem_8(context: Context) -> Result:
    result = _explored(context, "p2-table-5.3", [8], 1 if context.quick else 4, TABLE_5_3)
    result.notes.append(
        "P2's problem 8 is the one that p_blt = 1 suits best; our cells are our own, and 8 is its number alone."
    )
    return result


ENTRIES = (
    Entry(
        "p2-figure-5.5",
        "RRT*-MG and PRM*-MG: cost and time against the number of grasps (and figure 5.6)",
        run_compared,
        draw_compared,
    ),
    Entry("p2-table-5.1", "RRT*-MG without and with both ends and informed samples", run_versions),
    Entry("p2-table-5.2", "RRT*-MG: p_blt over eight problems", run_exploration),
    Entry("p2-table-5.3", "RRT*-MG: p_blt in problem 8", run_problem_8),
)
