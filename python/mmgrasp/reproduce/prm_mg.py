"""P2 4.5: PRM*-MG on eight pipes: success against the number of grasps, its three variants, and the size of batches."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np

from ..problems.pipe_cells import pipe_cell
from .drawing import figure
from .entry import Context, Entry, Result
from .pipe_runs import GAMMA, PROBLEMS, RUNS, by_seed, describe, describe_roadmap, items_of, mean, paired, plan_transfer

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COUNTS = (25, 50, 100, 500, 1000, 2000)
VERTICES = 5000
# Beyond P2: narrow cells, and the roadmap that ships, which does not fall to pieces.
WAYS = {
    "open": ("open", GAMMA),
    "open, shipped": ("open", 0.0),
    "narrow": ("narrow", GAMMA),
    "narrow, shipped": ("narrow", 0.0),
}
COLUMNS = {
    "open": "success rate",
    "open, shipped": "roadmap as it ships",
    "narrow": "narrow cells, gamma 4",
    "narrow, shipped": "narrow cells, roadmap as it ships",
}
SUCCESS = {25: 0.85, 50: 0.9125, 100: 0.9625, 500: 1.0, 1000: 1.0, 2000: 1.0}
VARIANTS = ("naive", "standard", "batch")
# Time to the first solution, in all [s], cost of the first solution; of naive, standard, batch.
TABLE_4_2: dict[int | str, tuple[tuple[float, float, float], ...]] = {
    1: ((1.21, 0.35, 0.63), (2.38, 0.71, 0.63), (10.39, 7.27, 5.81)),
    2: ((0.94, 0.68, 0.73), (1.95, 1.07, 0.73), (10.53, 7.79, 6.29)),
    3: ((1.24, 0.34, 0.61), (2.20, 0.71, 0.61), (10.22, 7.40, 6.10)),
    4: ((1.69, 0.61, 0.82), (3.59, 1.16, 0.82), (10.99, 7.56, 6.25)),
    5: ((5.61, 2.05, 1.59), (9.65, 3.67, 1.59), (10.55, 9.04, 7.81)),
    6: ((20.25, 2.89, 2.29), (26.96, 4.99, 2.29), (11.38, 9.29, 8.54)),
    7: ((5.38, 1.29, 1.06), (7.66, 1.39, 1.06), (9.81, 7.96, 7.76)),
    8: ((2.82, 1.12, 1.28), (4.82, 1.99, 1.28), (10.83, 8.40, 7.39)),
    "average": ((4.89, 1.16, 1.13), (7.40, 1.96, 1.13), (10.59, 8.09, 6.99)),
}
FIRST, TOTAL, FIRST_COST = "time to first solution [s]", "total time [s]", "cost of first solution"


def _scale(context: Context) -> tuple[list[int], int, tuple[int, ...], int]:
    """Problems, runs of each, numbers of grasps, vertices."""
    if context.quick:
        return [1, 3], 1, (25, 100), 1000
    return list(range(1, PROBLEMS + 1)), RUNS, COUNTS, VERTICES


# --- table 4.1 --------------------------------------------------------------------------------------------------------
def successes(number: int, seed: int, run: int, counts: tuple[int, ...], vertices: int) -> dict[str, Any]:
    """Whether in one run each number of grasps suffices over the run's roadmap. More grasps never lose a solution."""
    found: dict[str, list[dict[str, Any]]] = {}
    for way, (style, gamma) in WAYS.items():
        cell = pipe_cell(number, seed, style=style)
        for count in counts:
            one = plan_transfer(cell, count, run, vertices=vertices, gamma=gamma)
            found.setdefault(way, []).append({key: one[key] for key in ("solved", "reachable", "cost")})
    return {"number": number, "seed": seed, "found": found}


def run_success(context: Context) -> Result:
    problems, runs, counts, vertices = _scale(context)
    items = [i | {"counts": counts, "vertices": vertices} for i in items_of(context, problems, runs)]
    done = context.sweep(successes, items, "p2-table-4.1")
    result = Result()
    rates = []
    for k, count in enumerate(counts):
        values = result.row({"grasps": count})
        for way, column in COLUMNS.items():
            rate = float(np.mean([d["found"][way][k]["solved"] for d in done]))
            values[column] = (SUCCESS[count] if way == "open" else None, rate)
            if way == "open":
                rates.append(rate)
                values["of each seed"] = (None, by_seed(done, [d["found"]["open"][k]["solved"] for d in done]))
        values["grasps within reach at both ends"] = (None, mean(d["found"]["open"][k]["reachable"] for d in done))
    for number in problems:
        values = result.row({"grasps": f"problem {number}"})
        mine = [d for d in done if d["number"] == number]
        for way, column in COLUMNS.items():
            values[column] = (None, mean(float(f["solved"]) for d in mine for f in d["found"][way]))
        values["of each seed"] = (
            None,
            by_seed(mine, [float(np.mean([f["solved"] for f in d["found"]["open"]])) for d in mine]),
        )
        values["grasps within reach at both ends"] = (None, mean(d["found"]["open"][-1]["reachable"] for d in mine))
    result.exact(
        "a solution stays one when grasps are added, and never gets costlier",
        all(
            b["solved"] and b["cost"] <= a["cost"] + 1e-9
            for d in done
            for way in WAYS
            for a, b in itertools.pairwise(d["found"][way])
            if a["solved"]
        ),
    )
    for way, column in COLUMNS.items():
        result.statement(
            f"{column}: {counts[-1]} grasps less {counts[0]}",
            paired(done, [(d["found"][way][-1]["solved"], d["found"][way][0]["solved"]) for d in done]),
        )
    for style in ("open", "narrow"):
        result.statement(
            f"{style} cells, {counts[-1]} grasps: roadmap as it ships less gamma 4",
            paired(
                done, [(d["found"][f"{style}, shipped"][-1]["solved"], d["found"][style][-1]["solved"]) for d in done]
            ),
        )
    if not context.quick:
        result.trend(
            "every run succeeds from 500 grasps on, as P2's do",
            all(r == 1 for c, r in zip(counts, rates, strict=True) if c >= 500),
        )
    result.setup = describe(
        context, runs, problems, ("open", "narrow"), **describe_roadmap(context, vertices, gamma=GAMMA)
    )
    result.notes.append(
        "With gamma 4 the roadmap falls into pieces (mean degree and largest component below), and a run fails when its start"
        " and goal lie in different ones, whatever the grasps. Cells are not chosen by whether they can be solved."
    )
    return result


def draw_success(stored: dict[str, Any]) -> Figure:
    fig, (axis,) = figure(5.6, 3.4)
    rows = [row for row in stored["rows"] if isinstance(row["key"]["grasps"], int)]
    x = [row["key"]["grasps"] for row in rows]
    for side, colour, marker in (("paper", "#8a8f98", "s"), ("ours", "#1f6fb4", "o")):
        axis.plot(x, [row["values"]["success rate"][side] for row in rows], color=colour, marker=marker, label=side)
    axis.set(xscale="log", xlabel="grasps", ylabel="success rate", ylim=(0, 1.05))
    axis.legend(frameon=False)
    return fig


# --- table 4.2 and figure 4.5 -----------------------------------------------------------------------------------------
def variants(number: int, seed: int, run: int, counts: tuple[int, ...], vertices: int) -> dict[str, Any]:
    """The paper's three variants and ours, which searches a grasp only when it may still win, over one roadmap."""
    cell = pipe_cell(number, seed)
    found: dict[str, list[dict[str, Any]]] = {}
    for count in counts:
        for name, batch, lazy in (
            ("naive", 1, False),
            ("standard", max(1, count // 5), False),
            ("batch", 0, False),
            ("ours", 0, True),
        ):
            one = plan_transfer(cell, count, run, vertices=vertices, batch=batch, lazy_grasps=lazy)
            found.setdefault(name, []).append(one)
    return {"number": number, "seed": seed, "found": found}


def run_variants(context: Context) -> Result:
    problems, runs, counts, vertices = _scale(context)
    items = [i | {"counts": counts, "vertices": vertices} for i in items_of(context, problems, runs)]
    done = context.sweep(variants, items, "p2-table-4.2")
    result = Result()
    names = (*VARIANTS, "ours")
    # Averages are over what all variants solved; a capped run has no path to compare.
    kept = [
        {name: d["found"][name][k] for name in names} | {"number": d["number"], "seed": d["seed"], "count": count}
        for d in done
        for k, count in enumerate(counts)
        if all(d["found"][name][k]["solved"] for name in names)
    ]
    keys: list[int | str] = [*problems, "average"]
    for number in keys:
        mine = [d for d in kept if number in ("average", d["number"])]
        for i, name in enumerate(names):
            values = result.row({"problem": number, "variant": "batch, lazy over grasps" if name == "ours" else name})
            for j, (column, key) in enumerate(
                ((FIRST, "first time"), (TOTAL, "total time"), (FIRST_COST, "first cost"))
            ):
                paper = None if name == "ours" else TABLE_4_2[number][j][i]
                values[column] = (paper, mean(d[name][key] for d in mine))
            values["cost of best solution"] = (None, mean(d[name]["cost"] for d in mine))
            values["runs"] = (None, len(mine))
    costs = [[d[name]["cost"] for name in names] for d in kept]
    result.exact(
        "all variants find the same optimum on the same roadmap", all(max(c) - min(c) < 1e-9 * max(c) for c in costs)
    )
    for key, larger, smaller in (
        ("first cost", "naive", "standard"),
        ("first cost", "standard", "batch"),
        ("total time", "naive", "standard"),
        ("total time", "naive", "batch"),
    ):
        result.statement(
            f"{key}, {larger} less {smaller}",
            paired(kept, [(d[larger][key], d[smaller][key]) for d in kept]),
            clock=key != "first cost",
        )
    result.trend(
        "total time: lazy over grasps is the quickest",
        mean(d["ours"]["total time"] for d in kept) == min(mean(d[n]["total time"] for d in kept) or 0 for n in names),
        clock=True,
    )
    if not context.quick:
        batch = mean(d["batch"]["total time"] for d in kept)
        result.trend("batch: at most a tenth of the paper's 1.13 s", batch is not None and batch <= 0.113, clock=True)
    extra = [d["found"]["batch"][-1]["ik time"] for d in done]
    result.setup = describe(
        context, runs, problems, grasps=", ".join(map(str, counts)), **describe_roadmap(context, vertices)
    )
    result.notes.append(
        f"Not in these times, as in P2: inverse kinematics of all grasps, {mean(extra):.3g} s for {counts[-1]} of them, and the roadmap."
    )
    result.drawing = {
        "counts": list(counts),
        "lines": {
            name: {
                key: [mean(d[name][key] for d in kept if d["count"] == count) for count in counts]
                for key in ("first time", "total time", "best time", "first cost", "cost")
            }
            for name in names
        },
    }
    return result


STYLES = {
    "naive": ("#8a8f98", "s"),
    "standard": ("#d98b1f", "^"),
    "batch": ("#1f6fb4", "o"),
    "ours": ("#2a9d5c", "D"),
}


def draw_variants(stored: dict[str, Any]) -> Figure:
    """Figure 4.5 (a) to (d)."""
    fig, axes = figure(9.0, 6.4, 2, 2)
    drawing = stored["drawing"]
    panels = (
        ("first time", "time to first solution [s]"),
        ("total time", "total time [s]"),
        ("best time", "time to best solution [s]"),
        ("first cost", "cost of first solution, best dashed"),
    )
    for axis, (key, label) in zip(axes, panels, strict=True):
        for name, (colour, marker) in STYLES.items():
            line = drawing["lines"][name]
            points = [(c, v) for c, v in zip(drawing["counts"], line[key], strict=True) if v is not None]
            if points:
                axis.plot(
                    *zip(*points, strict=True),
                    color=colour,
                    marker=marker,
                    label="batch, lazy" if name == "ours" else name,
                )
        if key == "first cost":
            best = [
                (c, v)
                for c, v in zip(drawing["counts"], drawing["lines"]["batch"]["cost"], strict=True)
                if v is not None
            ]
            axis.plot(*zip(*best, strict=True), color="#1f6fb4", linestyle="--")
        else:
            axis.set(yscale="log")
        axis.set(xscale="log", xlabel="grasps", ylabel=label)
    axes[0].legend(frameon=False)
    return fig


# --- figure 4.6 -------------------------------------------------------------------------------------------------------
BATCHES = (1, 5, 20, 50, 100, 200, 500, 1000, 2000)


def batches(number: int, seed: int, run: int, count: int, sizes: tuple[int, ...], vertices: int) -> dict[str, Any]:
    cell = pipe_cell(number, seed)
    found = [plan_transfer(cell, count, run, vertices=vertices, batch=size, lazy_grasps=False) for size in sizes]
    return {"number": number, "seed": seed, "found": found}


def run_batches(context: Context) -> Result:
    problems, _, counts, vertices = _scale(context)
    runs = 1
    count = 100 if context.quick else counts[-1]
    sizes = (1, 10, 100) if context.quick else BATCHES
    items = [i | {"count": count, "sizes": sizes, "vertices": vertices} for i in items_of(context, problems, runs)]
    done = [d for d in context.sweep(batches, items, "p2-figure-4.6") if all(f["solved"] for f in d["found"])]
    result = Result()
    for k, size in enumerate(sizes):
        values = result.row({"batch size": size})
        for column, key in (
            (FIRST, "first time"),
            (TOTAL, "total time"),
            (FIRST_COST, "first cost"),
            ("cost of best solution", "cost"),
        ):
            values[column] = (None, mean(d["found"][k][key] for d in done))
    total = [[d["found"][k]["total time"] for d in done] for k in range(len(sizes))]
    result.statement(
        "cost of the first solution, smallest batch less largest",
        paired(done, [(d["found"][0]["first cost"], d["found"][-1]["first cost"]) for d in done]),
    )
    result.exact(
        "every batch size finds the same optimum",
        all(np.ptp([f["cost"] for f in d["found"]]) < 1e-9 * d["found"][0]["cost"] for d in done),
    )
    best = int(np.argmin([mean(t) or 0.0 for t in total])) if done else 0
    if not context.quick:
        result.trend(
            f"a medium batch is quickest in all (ours: {sizes[best]} of {count}; P2: 100 to 500)",
            20 <= sizes[best] <= 1000,
            clock=True,
        )
    result.setup = describe(context, runs, problems, grasps=count)
    result.setup |= {"runs solved": len(done), **describe_roadmap(context, vertices)}
    return result


def draw_batches(stored: dict[str, Any]) -> Figure:
    fig, axes = figure(9.0, 3.4, 2)
    x = [row["key"]["batch size"] for row in stored["rows"]]
    for axis, columns in zip(axes, ((FIRST, TOTAL), (FIRST_COST, "cost of best solution")), strict=True):
        for column, colour in zip(columns, ("#1f6fb4", "#d98b1f"), strict=True):
            points = [(a, row["values"][column]["ours"]) for a, row in zip(x, stored["rows"], strict=True)]
            points = [p for p in points if p[1] is not None]
            if points:
                axis.plot(*zip(*points, strict=True), color=colour, marker="o", label=column)
        axis.set(xscale="log", xlabel="batch size", ylim=(0, None))
        axis.legend(frameon=False)
    return fig


ENTRIES = (
    Entry("p2-table-4.1", "PRM*-MG: success against the number of grasps", run_success, draw_success),
    Entry("p2-table-4.2", "PRM*-MG: naive, standard and batch (and figure 4.5)", run_variants, draw_variants),
    Entry("p2-figure-4.6", "PRM*-MG: the size of batches", run_batches, draw_batches),
)
