"""P1 3.5.2 and 3.7.2: regions of randomly filled trays, estimated from the union of several placements."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np

from .. import _core
from .drawing import figure
from .entry import Context, Entry, Result
from .policies import RANDOM_TOOL, SCANS, random_places
from .setup import Row, database, describe, reach_samples

FILLS = (100, 75, 50, 25)


def measure(row: Row, samples: int, seed: int) -> dict[str, Any]:
    """Regions by 1 .. SCANS placements at each fill, and how much of a fresh placement's region they would promise wrongly.

    A placement at 50 % is one at 100 % with half of its objects taken out.
    """
    rng = np.random.default_rng(seed)
    m = row.per_tray
    row = row.with_(tool=RANDOM_TOOL, places=(tuple(random_places(rng, m * (SCANS + 1), row.tray_size)),))
    reach, problem = database(row, samples), row.problem()
    grid = _core.make_base_grid(problem, reach)
    objects = _core.ObjectRegions.compute(problem, reach, grid)
    out = []
    for fill in FILLS:
        each = math.ceil(fill * m / 100)
        for scans in range(1, SCANS + 1):
            union = [m * scan + k for scan in range(scans) for k in range(each)]
            cells = objects.region(0, union)
            fresh = objects.region(0, [m * SCANS + k for k in range(each)])
            out.append(
                {
                    "fill": fill,
                    "scans": scans,
                    "cells": int(cells.sum()),
                    "grasps": len(union),
                    "radius": _core.inscribed_circle(grid, cells)[1],
                    "promised wrongly": int((cells & ~fresh.astype(bool)).sum()),
                }
            )
    return {"rows": out}


def run(context: Context) -> Result:
    samples = reach_samples(context.quick)
    row = Row(trays=1, objects=(2, 2) if context.quick else (3, 4), tool=RANDOM_TOOL)
    database(row, samples, progress=context.progress)
    seeds = [context.seed + k for k in range(1 if context.quick else 10)]
    found = context.sweep(measure, [{"row": row, "samples": samples, "seed": s} for s in seeds], "p1-random-placement")
    result = Result(setup=describe(row, samples, "objects"))
    result.setup |= {
        "objects at 100 %": row.per_tray,
        "placements": f"seeds {seeds[0]} to {seeds[-1]}, means over them",
    }
    cells: dict[tuple[int, int], float] = {}
    for lines in zip(*(one["rows"] for one in found), strict=True):
        fill, scans = lines[0]["fill"], lines[0]["scans"]
        cells[fill, scans] = float(np.mean([line["cells"] for line in lines]))
        values = result.row({"fill [%]": fill, "scans": scans})
        values["cells"] = (None, cells[fill, scans])
        values["radius [m]"] = (None, float(np.mean([line["radius"] for line in lines])))
        values["cells promised wrongly"] = (None, float(np.mean([line["promised wrongly"] for line in lines])))
        values["objects"] = (None, math.ceil(fill * row.per_tray / 100))
        values["grasps"] = (None, lines[0]["grasps"])
    result.trend(
        "fewer objects left never shrink the region",
        all(cells[a, k] <= cells[b, k] for a, b in itertools.pairwise(FILLS) for k in range(1, SCANS + 1)),
    )
    result.trend(
        "every further scan shrinks the estimate or leaves it",
        all(cells[f, k + 1] <= cells[f, k] for f in FILLS for k in range(1, SCANS)),
    )
    spread = [cells[100, k] - cells[25, k] for k in (1, SCANS)]
    result.trend(
        "the union of four scans differs less between fills than one scan does (the paper: in theory not at all)",
        abs(spread[1]) <= abs(spread[0]),
    )
    return result


def draw(result: dict[str, Any]):
    fig, (axis,) = figure(6.0, 3.4)
    for fill, shade in zip(FILLS, ("#123f66", "#1f6fb4", "#6aa9dc", "#b5d4ee"), strict=True):
        rows = [row for row in result["rows"] if row["key"]["fill [%]"] == fill]
        points = [(row["key"]["scans"], row["values"]["cells"]["ours"]) for row in rows]
        axis.plot(*zip(*points, strict=True), "-o", color=shade, label=f"{fill} %")
    axis.set(
        xlabel="scans whose grasps are united", ylabel="cells of the region", ylim=(0, None), xticks=range(1, SCANS + 1)
    )
    axis.legend(frameon=False, title="fill")
    return fig


ENTRIES = [
    Entry("p1-random-placement", "Randomly filled trays: region against fill and scans (3.5.2, 3.7.2)", run, draw)
]
