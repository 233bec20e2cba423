"""P1 table 3.4: static base positions against such as follow the remaining objects or the objects to be picked."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np

from .. import _core
from .._shares import share_interval
from .drawing import figure
from .entry import Context, Entry, Result
from .rows import SPACING
from .scanned_trays import (
    COUNT,
    FILLS,
    SCANS,
    SETUP,
    emptied_best_first,
    part_cells,
    parts_from,
    random_scan,
)
from .setup import UNCERTAINTY, Row, database, describe, grid_of, reach_samples

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PAPER = {
    "Reg/ALL": ("Reliable", 0.100, "OK", "Yes"),
    "Reg/updateR": ("Reliable", 0.155, "OK", "Yes"),
    "Reg/updateT": ("Reliable", 0.186, "OK", "Yes"),
    "Rand/ALL": ("Reliable", 0.100, "OK", "Yes"),
    "Rand/updateR": ("Unreliable", 0.143, "OK", "No"),
    "Rand/updateT": ("Reliable", 0.229, "No", "No"),
}
POLICIES = {"ALL": "all", "updateR": "remaining", "updateT": "targets"}
BETTER = "Reg/updateT, optimised order"
SEEDS = 3  # draws of the random placement
ONLINE = 1.0  # a round's stops must be known in this time [s]

Cells = list[list[np.ndarray]]  # [tray][part]


class Limits(TypedDict):
    """Keywords of run_policy."""

    min_radius: float
    online_limit: float


LIMITS: Limits = {"min_radius": UNCERTAINTY, "online_limit": ONLINE}


def record(result: _core.PolicyResult, held: list[float]) -> dict[str, Any]:
    """A row of the table. `held`: mean radius of each round's discs if the trays stay grouped as for ALL."""
    return {
        "mean radius": result.mean_radius,
        "smallest radius": result.smallest_radius,
        "radii": [r.mean_radius for r in result.rounds],
        "held radius": float(np.mean(held)),
        "stops": result.mean_stops,
        "solved": result.solved,
        "reliable": sum(r.reliable for r in result.rounds),
        "rounds": len(result.rounds),
        "slowest": max(r.seconds for r in result.rounds),
        "online": result.online,
        "feasible": result.feasible,
    }


def over_seeds(runs: list[dict[str, Any]]) -> dict[str, Any]:
    """The rows of as many draws as one: means, but the least radius, the slowest round and the reliable rounds of all."""
    means = ("mean radius", "held radius", "stops")
    together = {key: float(np.mean([run[key] for run in runs])) for key in means}
    together |= {key: sum(run[key] for run in runs) for key in ("reliable", "rounds")}
    together |= {key: all(run[key] for run in runs) for key in ("solved", "online", "feasible")}
    together |= {"smallest radius": min(run["smallest radius"] for run in runs)}
    together |= {"slowest": max(run["slowest"] for run in runs)}
    return together | {"radii": np.mean([run["radii"] for run in runs], axis=0).tolist()}


def grouped_radius(grid: _core.BaseGrid, regions: list[_core.BaseRegion], groups: list[tuple[int, ...]]) -> float:
    masks = [region.cells(grid) for region in regions]
    shared = [np.bitwise_and.reduce([masks[t] for t in group]) for group in groups]
    return float(np.mean([_core.inscribed_circle(grid, mask)[1] for mask in shared]))


def regular(row: Row, samples: int) -> dict[str, Any]:
    """Objects on a grid, picked in P1's pairing (figure 3.11) and in the order that is best for the stops of ALL."""
    reach, problem = database(row, samples), row.problem()
    grid = grid_of(problem, reach)
    objects = _core.ObjectRegions.compute(problem, reach, grid)
    trays, every = range(row.trays), range(row.per_tray)
    cells: Cells = [[objects.region(t, [k]) for k in every] for t in trays]
    middles = row.tray_middles()
    paired = _core.paired_order([row.object_places() + [0.0, middles[t]] for t in trays])
    static = _core.run_policy(grid, cells, paired, "all", **LIMITS)
    groups = [tuple(stop.trays) for stop in static.rounds[0].stops]
    best = _core.optimised_order(grid, cells, groups, paired)
    out = {}
    for name, order, policy in [
        *((f"Reg/{name}", paired, policy) for name, policy in POLICIES.items()),
        (BETTER, best.order, "targets"),
    ]:
        ran = static if policy == "all" else _core.run_policy(grid, cells, order, policy, **LIMITS)
        held = []
        for i in every:
            chosen = {"all": list(every), "remaining": None, "targets": None}[policy]
            parts = [chosen or list(order[t][i:] if policy == "remaining" else [order[t][i]]) for t in trays]
            regions = [_core.BaseRegion(str(t), objects.region(t, parts[t]), grid) for t in trays]
            held.append(grouped_radius(grid, regions, groups))
        out[name] = record(ran, held)
    return out


def randomly(row: Row, samples: int, seed: int) -> dict[str, Any]:
    """Trays filled at random: ALL and updateR plan for the grasps of SCANS other fillings, updateT for the grasp to come."""
    reach = database(row, samples)
    trays = range(row.trays)
    taken = [emptied_best_first(row, t, seed) for t in trays]
    parts = [parts_from(row, t, [grasp for grasp in taken[t] if grasp is not None]) for t in trays]
    grid = grid_of(row.problem(parts), reach)
    actual = part_cells(row, parts, reach, grid)
    cells: Cells = [[actual.region(t, [k]) for k in range(len(parts[t]))] for t in trays]
    order = [_numbered([grasp is not None for grasp in taken[t]]) for t in trays]

    @functools.cache
    def estimated(fill: int) -> list[_core.BaseRegion]:
        grasps = [[g for scan in range(SCANS) for g in random_scan(row, t, scan, seed, fill).grasps] for t in trays]
        wanted = [parts_from(row, t, grasps[t]) for t in trays]
        found = part_cells(row, wanted, reach, grid)
        return [_core.BaseRegion(str(t), found.region(t, list(range(len(wanted[t])))), grid) for t in trays]

    def left(i: int) -> list[_core.BaseRegion]:
        share = 100 * (COUNT - i) / COUNT
        return estimated(min(fill for fill in FILLS if fill >= share))  # a weighing device tells how many

    def coming(i: int) -> list[_core.BaseRegion]:
        """Nothing is known beforehand of the parts that will be picked: their regions cost time between the rounds."""
        now = [[parts[t][order[t][i]]] if order[t][i] >= 0 else [] for t in trays]
        found = part_cells(row, now, reach, grid)
        empty = np.zeros_like(cells[0][0])
        masks = [found.region(t, [0]) if now[t] else empty for t in trays]
        return [_core.BaseRegion(str(t), mask, grid) for t, mask in enumerate(masks)]

    for fill in FILLS:
        estimated(fill)  # known offline (P1 3.5.2)
    out: dict[str, dict[str, Any]] = {}
    groups: list[tuple[int, ...]] = []
    for name, planned in {"ALL": lambda i: estimated(100), "updateR": left, "updateT": coming}.items():
        ran = _core.run_policy(grid, cells, order, POLICIES[name], planned=planned, **LIMITS)
        groups = groups or [tuple(stop.trays) for stop in ran.rounds[0].stops]
        served = [[g for g in (tuple(t for t in g if order[t][i] >= 0) for g in groups) if g] for i in range(COUNT)]
        held = [grouped_radius(grid, planned(i), served[i]) for i in range(COUNT) if served[i]]
        out[f"Rand/{name}"] = record(ran, held)
    return out


def _numbered(there: list[bool]) -> list[int]:
    """[round]: the how-manieth part that is picked, -1 for none."""
    counts = np.cumsum(there) - 1
    return [int(k) if is_there else -1 for k, is_there in zip(counts, there, strict=True)]


def run(context: Context) -> Result:
    samples = reach_samples(context.quick)
    row = Row(trays=2 if context.quick else 9, objects=(2, 2) if context.quick else (3, 4), spacing=SPACING)
    database(row, samples, progress=context.progress)
    (found,) = context.sweep(regular, [{"row": row, "samples": samples}], "regular placement")
    seeds = [context.seed + k for k in range(1 if context.quick else SEEDS)]
    drawn = context.sweep(
        randomly, [{"row": row, "samples": samples, "seed": seed} for seed in seeds], "random placement"
    )
    found |= {name: over_seeds([rows[name] for rows in drawn]) for name in drawn[0]}
    result = Result(setup=describe(row, samples))
    result.setup |= {"rounds": f"{row.per_tray} (regular), {COUNT} (random, of each seed)", "seeds": seeds}
    result.setup |= {f"random: {key}": value for key, value in SETUP.items()} | {"random: scans": SCANS}
    for name, ours in found.items():
        paper = PAPER.get(name, (None,) * 4)
        low, high = share_interval(ours["reliable"], ours["rounds"])
        values = result.row({"Policies": name})
        values["Base positions"] = (paper[0], "Reliable" if ours["reliable"] == ours["rounds"] else "Unreliable")
        values["Average robustness [m]"] = (paper[1], ours["mean radius"])
        values["Online"] = (paper[2], "OK" if ours["online"] else "No")
        values["Feasibility"] = (paper[3], "Yes" if ours["feasible"] else "No")
        values["stops in a round (mean)"] = (None, ours["stops"])
        values["smallest radius [m]"] = (None, ours["smallest radius"])
        values["average with the trays grouped as for ALL [m]"] = (None, ours["held radius"])
        values["rounds picked reliably (95 %)"] = (
            None,
            f"{ours['reliable']} of {ours['rounds']} ({low:.0%} to {high:.0%})",
        )
        values["slowest round [s]"] = (None, ours["slowest"])
    for placement in ("Reg", "Rand"):
        rows = [found[f"{placement}/{policy}"] for policy in POLICIES]
        means, held, stops = ([r[key] for r in rows] for key in ("mean radius", "held radius", "stops"))
        result.trend(f"{placement}: ALL < updateR < updateT in average robustness", means[0] < means[1] < means[2])
        result.trend(
            f"{placement}: the same with the trays grouped as for ALL, while the least number of stops never grows",
            held[0] < held[1] < held[2] and stops[0] >= stops[1] >= stops[2],
        )
    result.exact(
        "regular placement: every base position is reliable",
        all(ours["reliable"] == ours["rounds"] for name, ours in found.items() if name.startswith("Reg")),
    )
    result.trend(
        "an optimised picking order is no worse than P1's pairing, for the stops of ALL",
        found[BETTER]["held radius"] >= found["Reg/updateT"]["held radius"] - 1e-9,
    )
    result.notes.append(
        "The average robustness is equation 3.2 over the least stops of each round: with larger regions fewer stops do, at smaller "
        "discs. The column to the right of the smallest radius keeps the trays together as ALL groups them, so that only the discs move."
    )
    result.drawing = {"rounds": {name: ours["radii"] for name, ours in found.items()}}
    return result


def draw(result: dict[str, Any]) -> Figure:
    fig, axes = figure(9.0, 3.4, columns=2)
    colours = {"ALL": "#8a8f98", "updateR": "#1f6fb4", "updateT": "#d9822b", "updateT, optimised order": "#b8405e"}
    for axis, placement in zip(axes, ("Reg", "Rand"), strict=True):
        for policy, colour in colours.items():
            radii = result["drawing"]["rounds"].get(f"{placement}/{policy}", [])
            if radii:
                axis.plot(range(1, len(radii) + 1), radii, "-o", markersize=4, color=colour, label=policy)
        axis.set(title=f"{placement}: objects placed {'on a grid' if placement == 'Reg' else 'at random'}")
        axis.set(xlabel="round", ylabel="mean radius of the round's stops [m]", ylim=(0, None))
        axis.legend(frameon=False)
    return fig


ENTRIES = [Entry("p1-table-3.4", "Policies for updating the base positions", run, draw)]
