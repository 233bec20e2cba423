"""P1 figure 3.9: five regions, their robust intersections, and the three stops that serve them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from .drawing import TRAY_COLOURS, figure
from .entry import Context, Entry, Result
from .setup import UNCERTAINTY

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# The figure prints no lengths. These circles (middles on a line, one radius) have what its text states: regions 1, 2 and 3
# share a place that is also all that 1 and 3 share, and whose disc is too small; 1-2, 2-3 and 3-4 share more; 5 is alone.
MIDDLES = (0.0, 0.45, 0.90, 1.65, 2.80)
RADIUS = 0.50
CELL = 0.01


def regions() -> tuple[_core.BaseGrid, list[_core.BaseRegion]]:
    """The cells that lie in each circle as a whole."""
    low = MIDDLES[0] - RADIUS - CELL
    nx, ny = round((MIDDLES[-1] - MIDDLES[0] + 2 * RADIUS) / CELL) + 2, round(2 * RADIUS / CELL) + 2
    grid = _core.BaseGrid([low, -RADIUS - CELL], CELL, nx, ny)
    x, y = low + CELL * np.arange(nx + 1), -RADIUS - CELL + CELL * np.arange(ny + 1)
    out = []
    for i, middle in enumerate(MIDDLES):
        corner = np.hypot(x[None, :] - middle, y[:, None]) <= RADIUS
        inside = corner[:-1, :-1] & corner[1:, :-1] & corner[:-1, 1:] & corner[1:, 1:]
        out.append(_core.BaseRegion(str(i + 1), inside[None], grid))
    return grid, out


def run(context: Context) -> Result:
    grid, found = regions()
    sets = _core.robust_intersections(grid, found, UNCERTAINTY)
    stops = _core.cover_from_intersections(grid, sets.robust, len(found))
    result = Result(
        setup={"regions": len(found), "middles [m]": MIDDLES, "radius [m]": RADIUS, "uncertainty [m]": UNCERTAINTY}
    )
    paper = {1: 5, 2: 3, 3: 0}
    for order, count in paper.items():
        values = result.row({"order": order})
        values["robust intersections"] = (count, sum(len(s.trays) == order for s in sets.robust))
    values = result.row({"order": "all"})
    values["robust intersections"] = (8, len(sets.robust))
    values["stops"] = (3, len(stops.stops))
    values["proven least"] = (None, stops.lower_bound)
    chosen = sorted([t + 1 for t in stop.trays] for stop in stops.stops)
    too_small = sorted([t + 1 for t in s.trays] for s in sets.too_small)
    result.exact("8 robust intersections are kept: 5 regions and 3 pairs", len(sets.robust) == 8)
    result.exact("1-2-3 and 1-3, which are the same place, are discarded", [1, 3] in too_small)
    result.exact("3 stops, proven least: {1,2} {3,4} {5}", chosen == [[1, 2], [3, 4], [5]] and stops.lower_bound == 3)
    result.drawing = {
        "kept": [[[t + 1 for t in s.trays], [float(v) for v in s.centre], s.radius] for s in sets.robust],
        "stops": [[float(v) for v in stop.pose[:2]] for stop in sorted(stops.stops, key=lambda s: s.pose[0])],
    }
    return result


def draw(result: dict[str, Any]) -> Figure:
    from matplotlib.patches import Circle

    fig, (axis,) = figure(9.0, 3.4)
    for i, middle in enumerate(MIDDLES):
        axis.add_patch(Circle((middle, 0), RADIUS, facecolor=TRAY_COLOURS[i], alpha=0.25, edgecolor=TRAY_COLOURS[i]))
        axis.annotate(str(i + 1), (middle, RADIUS + 0.03), ha="center", color=TRAY_COLOURS[i])
    for trays, centre, radius in result["drawing"]["kept"]:
        if len(trays) > 1:
            axis.add_patch(Circle(centre, radius, fill=False, edgecolor="#333", linestyle=":"))
    stops = result["drawing"]["stops"]
    axis.plot(*zip(*stops, strict=True), "-o", color="#111", label="stops and the way between them")
    axis.set(xlabel="x [m]", ylabel="y [m]", aspect="equal", xlim=(-0.6, 3.4), ylim=(-0.6, 0.75))
    axis.legend(frameon=False, loc="lower right", bbox_to_anchor=(1, -0.02))
    return fig


ENTRIES = [Entry("p1-figure-3.9", "Five regions: robust intersections and least stops", run, draw)]
