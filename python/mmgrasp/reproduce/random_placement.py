"""P1 3.5.2 and 3.7.2: regions of randomly filled trays, estimated from the union of the grasps of several scans."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from .drawing import figure
from .entry import Context, Entry, Result
from .scanned_trays import COUNT, FILLS, REGULAR, SCANS, SETUP, part_cells, parts_from, random_scan
from .setup import Row, database, describe, grid_of, reach_samples

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def measure(row: Row, samples: int, seed: int, fill: int) -> dict[str, Any]:
    """Regions by 1 .. SCANS scans, and how many of their cells one more, unseen filling would not confirm."""
    scans = [random_scan(row, 0, scan, seed, fill).grasps for scan in range(SCANS + 1)]
    ends = list(itertools.accumulate(len(grasps) for grasps in scans))
    parts = parts_from(row, 0, [grasp for grasps in scans for grasp in grasps])
    reach = database(row, samples)
    grid = grid_of(row.problem([parts]), reach)
    objects = part_cells(row, [parts], reach, grid)
    unseen = objects.region(0, list(range(ends[-2], ends[-1]))).astype(bool)
    out = []
    for count, end in enumerate(ends[:-1], start=1):
        cells = objects.region(0, list(range(end)))
        out.append(
            {
                "scans": count,
                "cells": int(cells.sum()),
                "grasps": end,
                "radius": _core.inscribed_circle(grid, cells)[1],
                "promised wrongly": int((cells & ~unseen).sum()),
            }
        )
    return {"rows": out, "unseen": int(unseen.sum())}


def run(context: Context) -> Result:
    samples = reach_samples(context.quick)
    row = Row(trays=1)
    database(row, samples, progress=context.progress)
    seeds = [context.seed + k for k in range(1 if context.quick else 10)]
    fills = FILLS[::3] if context.quick else FILLS
    items = [{"row": row, "samples": samples, "seed": seed, "fill": fill} for fill in fills for seed in seeds]
    found = iter(context.sweep(measure, items, "p1-random-placement"))
    result = Result(setup=describe(row, samples, *REGULAR))
    result.setup |= SETUP | {"fillings": f"seeds {seeds[0]} to {seeds[-1]}, means over them"}
    cells: dict[tuple[int, int], float] = {}
    wrong: dict[tuple[int, int], float] = {}
    for fill in fills:
        of_fill = [next(found) for _ in seeds]
        for lines in zip(*(one["rows"] for one in of_fill), strict=True):
            scans = lines[0]["scans"]
            cells[fill, scans] = float(np.mean([line["cells"] for line in lines]))
            wrong[fill, scans] = float(np.mean([line["promised wrongly"] for line in lines]))
            values = result.row({"fill [%]": fill, "scans": scans})
            values["cells"] = (None, cells[fill, scans])
            values["radius [m]"] = (None, float(np.mean([line["radius"] for line in lines])))
            values["cells promised wrongly"] = (None, wrong[fill, scans])
            values["cells of an unseen filling"] = (None, float(np.mean([one["unseen"] for one in of_fill])))
            values["objects"] = (None, round(COUNT * fill / 100))
            values["grasps"] = (None, float(np.mean([line["grasps"] for line in lines])))
    result.trend(
        "the fewer parts are left the larger is the region of one scan",
        all(cells[a, 1] <= cells[b, 1] for a, b in itertools.pairwise(fills)),
    )
    result.trend(
        "four scans promise fewer cells wrongly than one",
        sum(wrong[fill, SCANS] for fill in fills) < sum(wrong[fill, 1] for fill in fills),
    )
    result.trend(
        "the union of four scans differs less between fills than one scan does (the paper: in theory not at all)",
        abs(cells[fills[-1], SCANS] - cells[100, SCANS]) <= abs(cells[fills[-1], 1] - cells[100, 1]),
    )
    return result


def draw(result: dict[str, Any]) -> Figure:
    fig, (axis,) = figure(6.0, 3.4)
    for fill, shade in zip(FILLS, ("#123f66", "#1f6fb4", "#6aa9dc", "#b5d4ee"), strict=True):
        rows = [row for row in result["rows"] if row["key"]["fill [%]"] == fill]
        points = [(row["key"]["scans"], row["values"]["cells"]["ours"]) for row in rows]
        if points:
            axis.plot(*zip(*points, strict=True), "-o", color=shade, label=f"{fill} %")
    axis.set(
        xlabel="scans whose grasps are united", ylabel="cells of the region", ylim=(0, None), xticks=range(1, SCANS + 1)
    )
    axis.legend(frameon=False, title="fill")
    return fig


ENTRIES = [
    Entry("p1-random-placement", "Randomly filled trays: region against fill and scans (3.5.2, 3.7.2)", run, draw)
]
