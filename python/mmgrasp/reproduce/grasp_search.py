"""P2 chapter 3: the grasp of a pipe along a path: weights, optima, three strategies of Bees beside GA and PSO, and many arm
configurations beside one."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import numpy as np

from .._core import pairwise_weights
from .drawing import figure
from .entry import Context, Entry, Result
from .grasp_search_runs import (
    METHODS,
    SETTINGS,
    WITHIN,
    all_runs,
    describe,
    free_configurations,
    interval,
    on_all_cores,
    optima,
    options_of,
    pairs,
    pairs_of_settings,
    scale_of,
    search,
)
from .statements import Pair

if TYPE_CHECKING:
    from matplotlib.figure import Figure

EVALUATIONS, SECONDS, SUCCESS = "grasp evaluations", "time [s]", "success [%]"
# One of METHODS each, in their order.
TABLE_3_7 = {EVALUATIONS: (1100, 845, 832, 2172, 1205), SECONDS: (31.4, 40.1, 37.5, 76.49, 49.7), SUCCESS: (100, 100, 100, 93.3, 98)}  # fmt: skip
TABLE_3_8 = {EVALUATIONS: (1572, 1192, 1168, 2699, 1891), SECONDS: (41, 57.4, 51.4, 92.4, 93.2), SUCCESS: (98.9, 98.5, 99.6, 76.8, 81.3)}  # fmt: skip
TABLE_3_9 = {"Pipe1": (0, 0, 2, 46, 154), "Pipe2": (9, 2, 2, 76, 7), "Pipe3": (5, 18, 1, 191, 91), "Total": (14, 20, 5, 313, 252)}  # fmt: skip
TABLE_3_10 = {
    "Str1": {34: (1179, 35.0, 99.5), 51: (1453, 39.5, 99.5), 102: (2085, 48.4, 97.7)},
    "Str2": {34: (976, 52.4, 98.4), 51: (1137, 57.5, 98.4), 102: (1462, 62.3, 98.7)},
    "Str3": {34: (975, 48.9, 99.5), 51: (1090, 49.8, 99.8), 102: (1441, 55.8, 99.5)},
}
TABLE_3_11 = {
    "Str1": {10: (1503, 41.2, 98.4), 30: (1546, 40.3, 99.3), 45: (1668, 41.6, 99.1)},
    "Str2": {10: (1180, 67.4, 96.8), 30: (1208, 56.8, 99.6), 45: (1186, 48.0, 99.1)},
    "Str3": {10: (1212, 61.5, 99.3), 30: (1112, 47.4, 100), 45: (1178, 45.3, 99.6)},
}
TABLE_3_6 = {"Pipe1": (4, "79", -155, 4.7638), "Pipe2": (3, "151", -100, 4.1487), "Pipe3": (2, "96/97", 23, 5.7905)}
SAVED = {"Pipe1": 19.6, "Pipe2": 11.3, "Pipe3": 8.4}  # [%], figure 3.12
RANDOM_INDEX = {3: 0.58, 4: 0.9, 5: 1.12, 6: 1.24, 7: 1.32, 8: 1.41, 9: 1.45, 10: 1.49}
COMPARISON = [[1, 6, 2], [1 / 6, 1, 1 / 4], [1 / 2, 4, 1]]
ROUND = 34  # evaluations an iteration in figure 3.12
ROUND_THIRDS = 3  # parts of its search after which the time is taken


# --- table 3.1 --------------------------------------------------------------------------------------------------------
def random_index(order: int, count: int, seed: int) -> float:
    """Mean consistency index of reciprocal matrices drawn from Saaty's scale 1/9, ..., 1, ..., 9."""
    rng = np.random.default_rng([seed, order])
    scale = np.array([1 / k for k in range(9, 1, -1)] + [float(k) for k in range(1, 10)])
    matrices = np.ones((count, order, order))
    for i in range(order):
        for j in range(i + 1, order):
            matrices[:, i, j] = rng.choice(scale, count)
            matrices[:, j, i] = 1 / matrices[:, i, j]
    largest = np.linalg.eigvals(matrices).real.max(axis=1)
    return float(np.mean((largest - order) / (order - 1)))


def run_weights(context: Context) -> Result:
    result = Result()
    count = 2000 if context.quick else 50_000
    for order, printed in RANDOM_INDEX.items():
        result.row({"": f"random index, m = {order}"})["value"] = (printed, random_index(order, count, context.seed))
    found = pairwise_weights(np.array(COMPARISON))
    for name, printed, ours in zip(("O1", "O2", "O3"), (0.56, 0.12, 0.32), found.weights, strict=True):
        result.row({"": f"weight of {name}"})["value"] = (printed, float(ours))
    result.row({"": "consistency ratio [%]"})["value"] = (0.79, 100 * found.consistency_ratio)
    result.exact("the consistency ratio of P2's matrix is 0.79 %", round(100 * found.consistency_ratio, 2) == 0.79)
    result.exact(
        "its weights by P2's method are 0.587, 0.089, 0.324 (errata)",
        np.allclose(found.weights, (0.587, 0.089, 0.324), atol=5e-4),
    )
    result.setup = {"random matrices of each order": count, "scale": "1/9 to 9"}
    result.notes.append(
        "Random indices depend on the matrices drawn: P2 cites the oldest ones, whose first differ most from a large draw."
    )
    return result


# --- table 3.6, figure 3.11 -------------------------------------------------------------------------------------------
def run_optima(context: Context) -> Result:
    result = Result()
    known = optima(context)
    for pipe, found in known.items():
        section, length, angle, cost = TABLE_3_6[pipe]
        values = result.row({"pipe": pipe})
        values["section"] = (section, found["grasp"][0])
        values["len [mm]"] = (length, found["grasp"][1])
        values["angle [deg]"] = (angle, found["grasp"][2])
        values["flip [deg]"] = ("180/0", found["grasp"][3])
        values["cost"] = (cost, found["cost"])
        values["no grasp below"] = (None, found["lower bound"])
        values["gap [%]"] = (None, 100 * (1 - found["lower bound"] / found["cost"]))
        values["boxes bounded"] = (None, found["boxes"])
        values["O1 [rad]"] = (None, found["motion"])
        values["O2 [mm]"] = (None, 1000 * found["deflection"])
        values["O3"] = (None, found["force"])
    done = all_runs(context)
    for pipe, found in known.items():
        least = min(cost for d in done if d["pipe"] == pipe for cost in d["cost"] if cost is not None)
        values = result.rows[list(known).index(pipe)][1]
        values["least cost of all runs of tables 3.7 to 3.11"] = (None, least)
        result.exact(
            f"{pipe}: none of these runs found a grasp below the proven bound", found["lower bound"] <= least + 1e-12
        )
    if not context.quick:
        gaps = [1 - found["lower bound"] / found["cost"] for found in known.values()]
        result.trend("the optima are proven to 0.1 %", max(gaps) <= WITHIN)
    result.setup = describe(context)
    result.notes.append(
        "P2's grasps belong to its own paths and cell, which it does not print: only the order of magnitude compares."
    )
    result.drawing = {"paths": {pipe: found["path"] for pipe, found in known.items()}}
    return result


def draw_optima(stored: dict[str, Any]) -> Figure:
    """Figure 3.11 as joint values from pose to pose."""
    paths = stored["drawing"]["paths"]
    fig, axes = figure(3.6 * len(paths), 3.4, len(paths))
    for axis, (pipe, path) in zip(axes, paths.items(), strict=True):
        for k, values in enumerate(np.transpose(path)):
            axis.plot(values, marker="o", markersize=3, label=f"A{k + 1}")
        axis.set(title=pipe, xlabel="pose", ylabel="joint [rad]")
    axes[0].legend(frameon=False, fontsize=7)
    return fig


# --- tables 3.7 to 3.9 ------------------------------------------------------------------------------------------------
def _half(d: dict[str, Any], which: int) -> dict[str, Any]:
    """Every second of the runs in one setting: those that choose the setting (0), those that tell of it (1)."""
    return {key: value[which::2] if isinstance(value, list) else value for key, value in d.items()}


def _best(done: list[dict[str, Any]]) -> dict[str, Any]:
    """The setting with most successes, of several the one with fewest evaluations, by every second run; the others are
    returned, since those that chose it look better than it is."""
    chosen = max(done, key=lambda d: (np.mean(_half(d, 0)["solved"]), -np.mean(_half(d, 0)["evaluations"])))
    return _half(chosen, 1)


def _add(values: dict[str, Any], printed: tuple[float, ...], groups: list[list[dict[str, Any]]]) -> None:
    """Evaluations and seconds over all pipes together, successes over all runs; a group for each pipe."""
    solved = [s for group in groups for d in group for s in d["solved"]]
    for name, key, paper in ((EVALUATIONS, "evaluations", printed[0]), (SECONDS, "seconds", printed[1])):
        values[name] = (paper, float(sum(np.mean([v for d in group for v in d[key]]) for group in groups)))
    values[SUCCESS] = (printed[2], 100 * float(np.mean(solved)))
    values["success, 95 % interval"] = (None, interval(sum(solved), len(solved)))
    values["runs"] = (None, len(solved))


def _of(done: list[dict[str, Any]], method: str, pipes: list[str]) -> list[list[dict[str, Any]]]:
    return [[d for d in done if d["method"] == method and d["pipe"] == pipe] for pipe in pipes]


def _tenth(result: Result) -> None:
    result.trend(
        "times are at most a tenth of the paper's",
        all(
            ours <= 0.1 * paper
            for _, v in result.rows
            for paper, ours in [v.get(SECONDS, (None, None))]
            if paper and ours
        ),
        clock=True,
    )


def _statements(context: Context, result: Result, done: list[dict[str, Any]], said: list[tuple[str, str, str]]) -> None:
    """What P2 concludes, asked again over pipes and settings; too few in the quick version."""
    if context.quick:
        return
    for value, larger, smaller in said:
        result.statement(
            f"{value}: {larger} less {smaller}", pairs(done, value, larger, smaller), clock=value == "seconds"
        )


ORDERS = [("evaluations", "Str1", "Str2"), ("evaluations", "Str1", "Str3"), ("evaluations", "GA", "Str3"),
          ("evaluations", "PSO", "Str3"), ("seconds", "Str2", "Str1"), ("seconds", "Str3", "Str1"),
          ("seconds", "GA", "Str3"), ("seconds", "PSO", "Str3"), ("solved", "Str3", "GA"), ("solved", "Str3", "PSO")]  # fmt: skip


def run_table_3_7(context: Context) -> Result:
    result, done = Result(), all_runs(context)
    pipes = scale_of(context)[0]
    chosen = []
    for i, method in enumerate(METHODS):
        best = [[_best(group)] for group in _of(done, method, pipes)]
        chosen += [group[0] | {"setting": 0} for group in best]
        values = result.row({"search": method})
        _add(values, tuple(TABLE_3_7[name][i] for name in (EVALUATIONS, SECONDS, SUCCESS)), best)
        values["settings"] = (None, ", ".join(str(group[0]["setting"]) for group in best))
    if not context.quick:
        ours = [values[SUCCESS][1] for _, values in result.rows]
        result.trend(
            "with its best settings each strategy of Bees succeeds in at least 99 % of the runs", min(ours[:3]) >= 99
        )
    _statements(context, result, chosen, ORDERS)
    _tenth(result)
    result.setup = describe(context)
    result.notes.append(
        "Of each search the best setting for each pipe, chosen by every second run; the table tells of the other runs. "
        "Evaluations and times are sums over the pipes, as P2's must be."
    )
    return result


def run_table_3_8(context: Context) -> Result:
    result, done = Result(), all_runs(context)
    for i, method in enumerate(METHODS):
        _add(
            result.row({"search": method}),
            tuple(TABLE_3_8[name][i] for name in (EVALUATIONS, SECONDS, SUCCESS)),
            _of(done, method, scale_of(context)[0]),
        )
    _statements(context, result, done, [*ORDERS, ("solved", "Str3", "Str1"), ("solved", "Str3", "Str2")])
    _tenth(result)
    result.setup = describe(context)
    return result


def run_table_3_9(context: Context) -> Result:
    result, done = Result(), all_runs(context)
    pipes, settings, runs, _, _ = scale_of(context)
    for pipe in [*pipes, "Total"]:
        values = result.row({"pipe": pipe})
        for i, method in enumerate(METHODS):
            mine = [d for d in done if d["method"] == method and pipe in (d["pipe"], "Total")]
            failed = sum(not s for d in mine for s in d["solved"])
            values[method] = (None if context.quick else TABLE_3_9[pipe][i], failed)
        values["of"] = (None, len(settings) * runs * (len(pipes) if pipe == "Total" else 1))
    if not context.quick:
        failures = [d | {"failed": [not s for s in d["solved"]]} for d in done]
        for larger, smaller in (("GA", "Str3"), ("PSO", "Str3"), ("Str2", "Str3"), ("Str1", "Str3")):
            result.statement(f"share of failures: {larger} less {smaller}", pairs(failures, "failed", larger, smaller))
        for pipe, values in zip(pipes, (v for _, v in result.rows), strict=False):
            worst = METHODS[int(np.argmax(TABLE_3_9[pipe]))]
            result.trend(
                f"{pipe}: {worst} fails most often",
                values[worst][1] == max(v[1] for v in values.values() if v[0] is not None),
            )
    result.setup = describe(context)
    return result


# --- tables 3.10 and 3.11 ---------------------------------------------------------------------------------------------
def _by_entry(
    context: Context, which: int, printed: dict[str, Any], column: str
) -> tuple[Result, list[dict[str, Any]]]:
    result, done = Result(), all_runs(context)
    for method, entries in printed.items():
        for value, paper in entries.items():
            mine = [d for d in done if SETTINGS[d["setting"]][which] == value]
            _add(result.row({"search": method, column: value}), paper, _of(mine, method, scale_of(context)[0]))
    result.setup = describe(context)
    return result, done


def run_table_3_10(context: Context) -> Result:
    result, done = _by_entry(context, 4, TABLE_3_10, "population")
    if context.quick:
        return result
    for method in TABLE_3_10:
        for value in ("evaluations", "seconds"):
            found = pairs_of_settings(done, value, method, 102, 34, 4)
            result.statement(f"{value} of {method}: population 102 less 34", found, clock=value == "seconds")
    for method, larger, smaller in (("Str1", 34, 102), ("Str1", 51, 102), ("Str2", 102, 34), ("Str2", 102, 51)):
        found = pairs_of_settings(done, "solved", method, larger, smaller, 4)
        result.statement(f"success of {method}: population {larger} less {smaller}", found)
    return result


def run_table_3_11(context: Context) -> Result:
    result, done = _by_entry(context, 3, TABLE_3_11, "random scouts [%]")
    if context.quick:
        return result
    result.statement("evaluations of Str1: 45 % less 10 %", pairs_of_settings(done, "evaluations", "Str1", 45, 10, 3))
    for method in TABLE_3_11:
        for low in (10, 45):  # success rises from 10 to 30 % and drops beyond
            found = pairs_of_settings(done, "solved", method, 30, low, 3)
            result.statement(f"success of {method}: 30 % less {low} %", found)
    ours = {(key["search"], key["random scouts [%]"]): values for key, values in result.rows}

    def nearly_level(method: str, name: str) -> bool:
        ten, most = (ours[method, share][name][1] for share in (10, 45))
        return bool(abs(most / ten - 1) <= 0.1)

    for method in ("Str2", "Str3"):
        found = pairs_of_settings(done, "seconds", method, 10, 45, 3)
        result.statement(f"seconds of {method}: 10 % less 45 %", found, clock=True)
        result.trend(
            f"evaluations of {method} change by less than 10 % from 10 to 45 %", nearly_level(method, EVALUATIONS)
        )
    result.trend("seconds of Str1 change by less than 10 % from 10 to 45 %", nearly_level("Str1", SECONDS), clock=True)
    return result


# --- figure 3.12 ------------------------------------------------------------------------------------------------------
def both_ways(pipe: str, runs: int, thirds: int, seed: int) -> dict[str, Any]:
    """Each run over all arm configurations and over one, with the same seed. Before the path the arm stands somewhere,
    drawn evenly among its free configurations: the one configuration begins with that nearest to it."""
    homes = free_configurations(pipe, runs, seed)

    def one(run: int) -> dict[str, Any]:
        out: dict[str, Any] = {"pipe": pipe, "run": run}
        for way, single in (("multi", False), ("single", True)):
            seconds = []
            for third in range(1, ROUND_THIRDS + 1):  # of the same search: how long it takes so far
                begun = time.perf_counter()
                found = search(
                    pipe,
                    home=homes[run],
                    single_configuration=single,
                    max_evaluations=ROUND * thirds * third,
                    seed=10_000 * seed + run,
                    **options_of("Str3", 7),
                )
                seconds.append(time.perf_counter() - begun)
            out[f"{way} seconds"] = seconds
            costs = np.array(found.history)[ROUND - 1 :: ROUND]
            out[way] = [float(c) if np.isfinite(c) else None for c in costs]
        return out

    return {"runs": on_all_cores(one, runs)}


def _mean_of(values: list[float]) -> float | None:
    return float(np.mean(values)) if values else None


def _error_of(values: list[float]) -> float | None:
    """Standard error of the mean."""
    return float(np.std(values, ddof=1) / np.sqrt(len(values))) if len(values) > 1 else None


def run_figure_3_12(context: Context) -> Result:
    pipes, _, runs, _, _ = scale_of(context)
    thirds = 4 if context.quick else 10
    rounds = ROUND_THIRDS * thirds
    items = [{"pipe": pipe, "runs": runs, "thirds": thirds, "seed": context.seed} for pipe in pipes]
    done = [d for group in context.sweep(both_ways, items, "one configuration and many") for d in group["runs"]]
    result = Result()
    result.drawing = {
        "rounds": [ROUND * (k + 1) for k in range(rounds)],
        "timed": [ROUND * thirds * (k + 1) for k in range(ROUND_THIRDS)],
        "pipes": {},
        "seconds": {},
    }
    for pipe in pipes:
        mine = [d for d in done if d["pipe"] == pipe]
        values = result.row({"pipe": pipe})
        both = [d for d in mine if d["multi"][-1] is not None and d["single"][-1] is not None]
        saved = [100 * (1 - d["multi"][-1] / d["single"][-1]) for d in both]
        values["saved by many configurations [%]"] = (SAVED[pipe], _mean_of(saved))
        if len(saved) > 1:
            half = 1.96 * (_error_of(saved) or 0)
            values["95 % interval"] = (None, f"{np.mean(saved) - half:.1f} to {np.mean(saved) + half:.1f}")
        values["runs with a grasp both ways"] = (None, len(both))
        errors = {}
        for way in ("multi", "single"):
            costs = [d[way][-1] for d in both]
            errors[way] = _error_of(costs)
            values[f"cost, {way}"] = (None, _mean_of(costs))
            values[f"its standard error, {way}"] = (None, errors[way])
            values[f"{SECONDS}, {way}"] = (None, _mean_of([d[f"{way} seconds"][-1] for d in mine]))
            values[f"runs without a grasp, {way}"] = (None, sum(d[way][-1] is None for d in mine))
        result.drawing["pipes"][pipe] = {
            way: [_mean_of([d[way][k] for d in both if d[way][k] is not None]) for k in range(rounds)]
            for way in ("multi", "single")
        }
        result.drawing["seconds"][pipe] = {
            way: [_mean_of([d[f"{way} seconds"][k] for d in mine]) for k in range(ROUND_THIRDS)]
            for way in ("multi", "single")
        }
        result.statement(
            f"{pipe}, over its runs: cost of single less multi",
            [Pair(context.seed, d["run"], d["single"][-1], d["multi"][-1]) for d in both],
        )
        if errors["multi"] is not None and errors["single"] is not None:
            result.trend(f"{pipe}: the standard error is smaller with many", errors["multi"] < errors["single"])
        slower, faster = ("single", "multi") if pipe == "Pipe3" else ("multi", "single")
        result.statement(
            f"{pipe}, over its runs: seconds of {slower} less {faster}",
            [Pair(context.seed, d["run"], d[f"{slower} seconds"][-1], d[f"{faster} seconds"][-1]) for d in mine],
            clock=True,
        )
    result.setup = describe(context) | {
        "settings": "7 with Str3",
        "rounds": f"{rounds} of {ROUND} evaluations",
        "where the arm stands before": "in each run somewhere free within its limits, the same both ways",
    }
    result.notes.append(
        "P2 does not say where its numerical solver begins. Here it begins where the arm stands, in a configuration drawn "
        "anew for each run, and goes to the nearest of the arm's configurations from pose to pose; so it keeps one posture, "
        "which some grasps cannot, where P2's may jump."
    )
    return result


def draw_figure_3_12(stored: dict[str, Any]) -> Figure:
    """(a) to (c): the best cost after each round; (d) to (f): the time until then."""
    drawing = stored["drawing"]
    pipes = list(drawing["pipes"])
    fig, axes = figure(3.6 * len(pipes), 6.0, len(pipes), rows=2)
    for column, pipe in enumerate(pipes):
        for way, colour in (("single", "#8a8f98"), ("multi", "#1f6fb4")):
            costs = [np.nan if c is None else c for c in drawing["pipes"][pipe][way]]
            axes[column].plot(drawing["rounds"], costs, color=colour, label=f"{way} IK")
            seconds = [0.0, *drawing["seconds"][pipe][way]]
            axes[len(pipes) + column].plot([0, *drawing["timed"]], seconds, color=colour, marker="o", markersize=3)
        axes[column].set(title=pipe, ylabel="cost of the best grasp, mean")
        axes[len(pipes) + column].set(xlabel="grasp evaluations", ylabel="time [s], mean")
    axes[0].legend(frameon=False)
    return fig


ENTRIES = (
    Entry("p2-table-3.1", "weights by comparison in pairs, and random indices", run_weights),
    Entry("p2-figure-3.11", "optimal grasps and the arm's motions (with table 3.6)", run_optima, draw_optima),
    Entry("p2-table-3.7", "five searches, each with its best settings", run_table_3_7),
    Entry("p2-table-3.8", "five searches over nine settings", run_table_3_8),
    Entry("p2-table-3.9", "runs that miss the optimum", run_table_3_9),
    Entry("p2-table-3.10", "the size of the population", run_table_3_10),
    Entry("p2-table-3.11", "the share of random scouts", run_table_3_11),
    Entry("p2-figure-3.12", "many arm configurations against one", run_figure_3_12, draw_figure_3_12),
)
