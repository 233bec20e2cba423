"""P1 table 3.1, figures 3.13 and 3.15: one tray's base region against the number of objects in it."""

from __future__ import annotations

import itertools
import math
import statistics
import time
from typing import TYPE_CHECKING, Any

from .. import _core
from . import stored_regions
from .drawing import figure, paper_and_ours
from .entry import Context, Entry, Result
from .setup import RESOLUTION, Row, bars, database, describe, reach_samples

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PAPER = {
    (1, 1): (306, 0.22),
    (1, 2): (306, 0.26),
    (2, 2): (196, 0.28),
    (3, 4): (157, 0.51),
    (6, 8): (146, 1.64),
    (9, 12): (146, 3.01),
    (12, 16): (146, 5.10),
    (15, 20): (146, 7.84),
    (18, 24): (146, 11.14),
    (21, 28): (146, 15.41),
}
CELLS, TIME = "Number of base positions", "Calculation time (s)"


def measure(row: Row, samples: int, repeats: int) -> dict[str, Any]:
    """The region of a single tray: its cells, and how long it took from the loaded database.

    The database keeps no answers. Its file is mapped, so that a question about a tray 3 cm away loads it before the clock runs.
    """
    reach = database(row, samples)
    beside = row.with_(shift=row.shift + 0.03).problem()
    _core.ObjectRegions.compute(beside, reach, _core.make_base_grid(beside, reach))
    problem = row.problem()
    seconds, kept = [], []
    for _ in range(repeats):
        begun = time.perf_counter()
        grid = _core.make_base_grid(problem, reach)
        objects = _core.ObjectRegions.compute(problem, reach, grid)
        done = time.perf_counter()
        objects.region(0, objects.parts(0))
        seconds.append(done - begun)
        kept.append(time.perf_counter() - done)
    region = objects.base_region(0)
    return {
        "cells": region.count,
        "radius": _core.inscribed_circle(grid, region.cells(grid))[1],
        "objects": len(region.explanations),
        "grasps": sum(e.grasps for e in region.explanations),
        "tried": max(e.base_poses_tried for e in region.explanations),
        "seconds": statistics.median(seconds),
        "kept seconds": statistics.median(kept),
    }


def run(context: Context) -> Result:
    sizes = [(1, 1), (1, 2), (2, 2), (3, 4)] if context.quick else list(PAPER)
    samples = reach_samples(context.quick)
    repeats = 1 if context.quick else 3
    rows = [Row(objects=size) for size in sizes]
    items = [{"row": row, "samples": samples, "repeats": repeats} for row in rows]
    database(Row(), samples, progress=context.progress)
    found = context.sweep(measure, items, "p1-table-3.1")
    single_thread = [{"row": row.with_(threads=1), "samples": samples, "repeats": repeats} for row in rows]
    alone = context.sweep(measure, single_thread, "one thread")
    papers = stored_regions.run(context, rows)
    result = Result(setup=describe(Row(), samples, "objects", "trays") | papers.describe())
    for size, ours, single in zip(sizes, found, alone, strict=True):
        paper_cells, paper_seconds = PAPER[size]
        values = result.row({"objects": f"{size[0]}x{size[1]}"})
        values[CELLS] = (paper_cells, ours["cells"])
        values[TIME] = (paper_seconds, ours["seconds"])
        values["objects' regions kept (s)"] = (None, ours["kept seconds"])
        values["one thread (s)"] = (None, single["seconds"])
        values["radius of the inscribed circle (m)"] = (None, ours["radius"])
        values["objects"] = (size[0] * size[1], ours["objects"])
        values["grasps"] = (size[0] * size[1], ours["grasps"])
        values["base positions tried"] = (None, ours["tried"])
    for index, (_, values) in enumerate(result.rows):
        papers.fill(values, index)
    cells = [ours["cells"] for ours in found]
    filled = [n for size, n in zip(sizes, cells, strict=True) if size[0] * size[1] >= 12]
    result.trend("more objects never enlarge the region", all(a >= b for a, b in itertools.pairwise(cells)))
    result.trend(
        "once the corners are filled (from 3x4 on) the region hardly changes: within a quarter",
        min(filled) >= 0.75 * max(filled),
    )
    result.trend(
        "at least ten times as fast in every row",
        all(10 * ours["seconds"] <= PAPER[size][1] for size, ours in zip(sizes, found, strict=True)),
        clock=True,
    )
    papers.conclude(result)
    last = cells[-1] / PAPER[sizes[-1]][0]
    result.notes.append(
        f"Regions are {cells[0] / 306:.2f} (1x1) to {last:.2f} ({sizes[-1][0]}x{sizes[-1][1]}) times the paper's. A cell of ours "
        f"of {RESOLUTION} m counts only if its centre and its four corners are feasible with exact inverse kinematics and the "
        "robot at home stands free there; the paper counts a centre when a configuration of its voxel is free. Heights of table, "
        "torso and tool are not printed: of some 50 combinations the one with wide regions was kept, knowing the paper's counts, so that "
        "their closeness proves nothing by itself; p1-table-3.1-setups shows what each does around it. Objects are points: cubes of a "
        "millimetre, held by a grasp of nothing, and the tool stands 0.12 m above the floor of a tray 0.10 m deep, so that no finger "
        "passes the rim. Below it the same tray has no region (p1-table-3.1-setups, which has real parts and grasps, too)."
    )
    return result


def draw(result: dict[str, Any]) -> Figure:
    """Figures 3.13 and 3.15."""
    objects = [row["values"]["objects"]["ours"] for row in result["rows"]]
    fig, axes = figure(9.0, 3.6, columns=2)
    paper_and_ours(axes[0], objects, result["rows"], CELLS)
    axes[0].set(xlabel="objects in the tray", ylabel="base positions (5 cm cells)", ylim=(0, None))
    paper_and_ours(axes[1], objects, result["rows"], TIME)
    axes[1].set(xlabel="objects in the tray", ylabel="calculation time [s]", yscale="log")
    return fig


# --- what the paper leaves open ---------------------------------------------------------------------------------------
VARIED: list[tuple[str, dict[str, Any]]] = [
    ("as chosen", {}),
    ("table 0.35 m", {"table": 0.35}),
    ("table 0.45 m", {"table": 0.45}),
    ("table 0.50 m", {"table": 0.50}),
    ("approach straight down", {"tilt": 0.0}),
    ("approach tilted by 15 degrees", {"tilt": math.pi / 12}),
    ("approach tilted by 45 degrees", {"tilt": math.pi / 4}),
    ("tool 0.13 m above the floor", {"tool": 0.13}),
    ("tray's 40 cm away from the robot", {"deep": True}),
    ("2 grasps per object", {"grasps": 2}),
    ("4 grasps per object", {"grasps": 4}),
    ("outermost objects 1 cm from the edge", {"margin": 0.01}),
    ("outermost objects 5 cm from the edge", {"margin": 0.05}),
    *(
        (f"{a}x{b} objects, tool {tool:.2f} m above the floor", {"objects": (a, b), "tool": tool})
        for a, b in ((3, 4), (9, 12))
        for tool in (0.12, 0.10, 0.08, 0.05, 0.02)
    ),
]
REAL = [(3, 4), (6, 8)]


def measure_real(objects: tuple[int, int], samples: int) -> dict[str, Any]:
    """The region of a tray full of upright bars, each with the grasps that are sampled on it."""
    row = Row(objects=objects)
    reach = database(row, samples)
    problem = row.problem([bars(row)])
    grid = _core.make_base_grid(problem, reach)
    region = _core.compute_base_regions(problem, reach, grid)[0]
    return {
        "cells": region.count,
        "radius": _core.inscribed_circle(grid, region.cells(grid))[1],
        "objects": len(region.explanations),
        "grasps": sum(e.grasps for e in region.explanations),
    }


def _describe_region(values: dict[str, tuple[Any, Any]], ours: dict[str, Any]) -> None:
    values["radius of the inscribed circle (m)"] = (None, ours["radius"])
    values["objects"] = (None, ours["objects"])
    values["grasps"] = (None, ours["grasps"])


def run_setups(context: Context) -> Result:
    samples = reach_samples(context.quick)
    row = Row(objects=(2, 2) if context.quick else (3, 4))
    varied = [VARIED[i] for i in (0, 4, 9)] if context.quick else VARIED
    database(row, samples, progress=context.progress)
    items = [{"row": row.with_(**changes), "samples": samples, "repeats": 1} for _, changes in varied]
    found = context.sweep(measure, items, "p1-table-3.1-setups")
    real = REAL[:1] if context.quick else REAL
    found_real = context.sweep(measure_real, [{"objects": size, "samples": samples} for size in real], "real parts")
    result = Result(setup=describe(row, samples))
    paper = PAPER[row.objects][0]
    for (name, changes), ours in zip(varied, found, strict=True):
        values = result.row({"set-up": name})
        values[CELLS] = (None if changes else paper, ours["cells"])
        values["against the paper's"] = (None, ours["cells"] / PAPER[changes.get("objects", row.objects)][0])
        _describe_region(values, ours)
    for size, ours in zip(real, found_real, strict=True):
        values = result.row({"set-up": f"{size[0]}x{size[1]} upright bars with their sampled grasps"})
        values[CELLS] = (None, ours["cells"])
        values["against the paper's"] = (None, ours["cells"] / PAPER[size][0])
        _describe_region(values, ours)
    by_grasps = [o["cells"] for (_, c), o in zip(varied, found, strict=True) if not c or "grasps" in c]
    result.trend("more grasps never shrink the region", by_grasps == sorted(by_grasps))
    return result


ENTRIES = [
    Entry("p1-table-3.1", "Base region of one tray against the number of objects", run, draw),
    Entry("p1-table-3.1-setups", "What the size of a region owes to what the paper leaves open", run_setups),
]
