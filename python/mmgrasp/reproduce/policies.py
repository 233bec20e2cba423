"""P1 table 3.4: static base positions against such as follow the remaining objects or the objects to be picked."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from .. import _core
from .drawing import figure
from .entry import Context, Entry, Result
from .rows import SPACING
from .setup import UNCERTAINTY, Row, database, describe, reach_samples

PAPER = {
    "Reg/ALL": ("Reliable", 0.100, "OK", "Yes"),
    "Reg/updateR": ("Reliable", 0.155, "OK", "Yes"),
    "Reg/updateT": ("Reliable", 0.186, "OK", "Yes"),
    "Rand/ALL": ("Reliable", 0.100, "OK", "Yes"),
    "Rand/updateR": ("Unreliable", 0.143, "OK", "No"),
    "Rand/updateT": ("Reliable", 0.229, "No", "No"),
}
SCANS = 4  # P1 3.7.2
RANDOM_TOOL = 0.15  # above the tray's floor: tilted and turned about the approach, fingers still clear the rim [m]
ONLINE = 1.0  # a round's stops must be known in this time [s]


def random_places(
    rng: np.random.Generator, count: int, size: tuple[float, float, float]
) -> list[tuple[float, float, float]]:
    """Objects thrown into a tray: place and turn about the vertical uniform, no margin kept between them."""
    x, y = (rng.uniform(-length / 2 + 0.015, length / 2 - 0.015, count) for length in size[:2])
    return [
        (float(a), float(b), float(t)) for a, b, t in zip(x, y, rng.uniform(-np.pi / 2, np.pi / 2, count), strict=True)
    ]


Chosen = Callable[[int, int], list[int]]  # (tray, round) -> objects that the stops must serve
Stops = list[tuple[np.ndarray, float, tuple[int, ...]]]  # middle, radius and trays of each


def rounds(
    grid, objects, trays: int, count: int, planned: dict[str, Chosen], picked: Chosen
) -> dict[str, dict[str, Any]]:
    """What each policy gives, ALL first: its stops serve the same trays together in every round and only move.

    Told are the discs of the stops, whether what is picked can be picked from all of each disc, and how the least number of
    stops would change if trays could be served together anew in each round.
    """
    out: dict[str, dict[str, Any]] = {}
    groups: list[tuple[int, ...]] = []
    for policy, choose in planned.items():
        radii, sizes, least_radii, kept, asked, slowest = [], [], [], 0, 0, 0.0
        known: dict[tuple, tuple[Stops, list[float]]] = {}
        for i in range(count):
            begun = time.perf_counter()
            key = tuple(tuple(choose(t, i)) for t in range(trays))
            if key not in known:
                masks = [objects.region(t, list(key[t])) for t in range(trays)]
                least = _least_stops(grid, masks)
                if not groups:
                    groups = [tuple(s.trays) for s in least]
                known[key] = ([_widest(grid, masks, group) for group in groups], [s.radius for s in least])
            stops, least_discs = known[key]
            slowest = max(slowest, time.perf_counter() - begun)
            radii.append(float(np.mean([radius for _, radius, _ in stops])) if stops else 0.0)
            sizes.append(len(least_discs))
            least_radii += least_discs
            for middle, _, served in stops:
                for t in served:
                    asked += 1
                    kept += _disc_inside(grid, objects.region(t, picked(t, i)), middle)
        out[policy] = {
            "mean radius": float(np.mean(radii)),
            "radii": radii,
            "stops": len(groups),
            "least stops": float(np.mean(sizes)),
            "least radius": float(np.mean(least_radii)) if least_radii else 0.0,
            "reliable": kept / asked if asked else 0.0,
            "slowest": slowest,
        }
    return out


def _least_stops(grid, masks: list[np.ndarray]) -> list[_core.Stop]:
    regions = [_core.BaseRegion(str(t), mask, grid) for t, mask in enumerate(masks)]
    return _core.minimal_stops(grid, _core.robust_intersections(grid, regions, UNCERTAINTY).robust, len(masks)).stops


def _widest(grid, masks: list[np.ndarray], trays: tuple[int, ...]) -> tuple[np.ndarray, float, tuple[int, ...]]:
    middle, radius = _core.inscribed_circle(grid, np.bitwise_and.reduce([masks[t] for t in trays]))
    return middle, radius, trays


def _disc_inside(grid, cells: np.ndarray, middle: np.ndarray) -> bool:
    """Whether every cell whose middle lies in the disc of the positioning uncertainty is marked."""
    x = grid.origin[0] + grid.resolution * (np.arange(grid.nx) + 0.5) - middle[0]
    y = grid.origin[1] + grid.resolution * (np.arange(grid.ny) + 0.5) - middle[1]
    return bool(cells[0][np.hypot(x[None, :], y[:, None]) <= UNCERTAINTY].all())


def regular(row: Row, samples: int) -> dict[str, Any]:
    reach, problem = database(row, samples), row.problem()
    grid = _core.make_base_grid(problem, reach)
    objects = _core.ObjectRegions.compute(problem, reach, grid)
    m, every = row.per_tray, list(range(row.per_tray))

    def target(_: int, i: int) -> list[int]:
        return [i]  # the objects of a pair lie alike in their trays, so that their distance is the trays' (figure 3.11)

    planned = {"ALL": lambda t, i: every, "updateR": lambda t, i: every[i:], "updateT": target}
    return rounds(grid, objects, row.trays, m, planned, target)


def randomly(row: Row, samples: int, seed: int) -> dict[str, Any]:
    """Places of the actual objects, and of SCANS other fillings of each tray by which the regions are estimated."""
    rng = np.random.default_rng(seed)
    m = row.per_tray
    places = tuple(tuple(random_places(rng, m * (1 + SCANS), row.tray_size)) for _ in range(row.trays))
    row = row.with_(places=places, tool=RANDOM_TOOL)
    reach, problem = database(row, samples), row.problem()
    grid = _core.make_base_grid(problem, reach)
    objects = _core.ObjectRegions.compute(problem, reach, grid)
    order = [list(rng.permutation(m)) for _ in range(row.trays)]

    def target(t: int, i: int) -> list[int]:
        return [int(order[t][i])]

    def scanned(share: float) -> list[int]:
        each = max(1, math.ceil(share * m))
        return [m * (1 + scan) + k for scan in range(SCANS) for k in range(each)]

    def remaining(_: int, i: int) -> list[int]:
        return scanned(math.ceil(4 * (m - i) / m) / 4)  # known for 100, 75, 50, 25 % (P1 3.5.2)

    planned = {"ALL": lambda t, i: scanned(1.0), "updateR": remaining, "updateT": target}
    found = rounds(grid, objects, row.trays, m, planned, target)
    targets = tuple((int(order[t][0]),) for t in range(row.trays))
    problem = row.with_(targets=targets).problem()
    begun = time.perf_counter()
    _core.compute_base_regions(problem, reach, grid)
    found["updateT"]["slowest"] += time.perf_counter() - begun  # nothing is known of these objects beforehand
    return found


def run(context: Context) -> Result:
    samples = reach_samples(context.quick)
    row = Row(trays=3 if context.quick else 9, objects=(2, 2) if context.quick else (3, 4), spacing=SPACING)
    database(row, samples, progress=context.progress)
    (reg,) = context.sweep(regular, [{"row": row, "samples": samples}], "regular placement")
    (rand,) = context.sweep(randomly, [{"row": row, "samples": samples, "seed": context.seed}], "random placement")
    result = Result(setup=describe(row, samples))
    result.setup |= {
        "rounds": row.per_tray,
        "scans of a randomly filled tray": SCANS,
        "tool, random placement [m]": RANDOM_TOOL,
        "seed": context.seed,
    }
    for name, paper in PAPER.items():
        placement, policy = name.split("/")
        ours = (reg if placement == "Reg" else rand)[policy]
        reliable, online = ours["reliable"] == 1.0, ours["slowest"] <= ONLINE
        values = result.row({"Policies": name})
        values["Base positions"] = (paper[0], "Reliable" if reliable else "Unreliable")
        values["Average robustness [m]"] = (paper[1], ours["mean radius"])
        values["Online"] = (paper[2], "OK" if online else "No")
        values["Feasibility"] = (paper[3], "Yes" if reliable and online else "No")
        values["picks inside the disc"] = (None, ours["reliable"])
        values["stops"] = (None, ours["stops"])
        values["least stops in a round (mean)"] = (None, ours["least stops"])
        values["radius with least stops [m]"] = (None, ours["least radius"])
        values["slowest round [s]"] = (None, ours["slowest"])
    for placement, found in (("Reg", reg), ("Rand", rand)):
        means = [found[policy]["mean radius"] for policy in ("ALL", "updateR", "updateT")]
        result.trend(f"{placement}: ALL < updateR < updateT in average robustness", means[0] < means[1] < means[2])
    result.exact("regular placement: every base position is reliable", all(o["reliable"] == 1.0 for o in reg.values()))
    result.notes.append(
        "The mean radius is that of stops which serve the same trays together as those of ALL and move with the policy. With larger "
        "regions fewer stops could do, at smaller discs: the columns on the right. Every radius counts from the objects' own regions, "
        "so that the first round of updateR is ALL."
    )
    result.drawing = {
        "rounds": {f"{p}/{k}": v["radii"] for p, found in (("Reg", reg), ("Rand", rand)) for k, v in found.items()}
    }
    return result


def draw(result: dict[str, Any]):
    fig, axes = figure(9.0, 3.4, columns=2)
    colours = {"ALL": "#8a8f98", "updateR": "#1f6fb4", "updateT": "#d9822b"}
    for axis, placement in zip(axes, ("Reg", "Rand"), strict=True):
        for policy, colour in colours.items():
            radii = result["drawing"]["rounds"][f"{placement}/{policy}"]
            axis.plot(range(1, len(radii) + 1), radii, "-o", markersize=4, color=colour, label=policy)
        axis.set(title=f"{placement}: objects placed {'on a grid' if placement == 'Reg' else 'at random'}")
        axis.set(xlabel="round", ylabel="mean radius of the round's stops [m]", ylim=(0, None))
        axis.legend(frameon=False)
    return fig


ENTRIES = [Entry("p1-table-3.4", "Policies for updating the base positions", run, draw)]
