"""What the pictures share. Paper and ours keep one colour and one marker each throughout."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np

from .._core import BaseGrid
from ..viz.style import TRAY_COLOURS as TRAY_COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


class LineStyle(TypedDict):
    """Keywords of matplotlib's plot."""

    color: str
    marker: str
    linestyle: str
    label: str


PAPER_STYLE: LineStyle = {"color": "#8a8f98", "marker": "s", "linestyle": "--", "label": "paper"}
OUR_STYLE: LineStyle = {"color": "#1f6fb4", "marker": "o", "linestyle": "-", "label": "ours"}


def figure(width: float, height: float, columns: int = 1, rows: int = 1) -> tuple[Figure, list[Axes]]:
    """A figure of this size [inch] and its axes, row by row."""
    os.environ.setdefault("MPLBACKEND", "Agg")
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    made = Figure(figsize=(width, height), dpi=110, layout="constrained")
    FigureCanvasAgg(made)
    axes = list(made.subplots(rows, columns, squeeze=False).ravel())
    for axis in axes:
        axis.grid(True, color="#e4e6ea", linewidth=0.8)
        axis.set_axisbelow(True)
        axis.spines[["top", "right"]].set_visible(False)
    return made, axes


def paper_and_ours(axis: Axes, x: Sequence[Any], rows: Sequence[dict[str, Any]], name: str) -> None:
    """One column of a table over x; what is not printed is left out."""
    for side, style in (("paper", PAPER_STYLE), ("ours", OUR_STYLE)):
        points = [
            (a, row["values"][name][side])
            for a, row in zip(x, rows, strict=True)
            if row["values"].get(name, {}).get(side) is not None
        ]
        if points:
            axis.plot(*zip(*points, strict=True), **style)
    axis.legend(frameon=False)


def cells_to_runs(cells: np.ndarray) -> list[list[int]]:
    """A (ny, nx) mask as runs [iy, first, end): small in JSON."""
    runs = []
    for iy, line in enumerate(np.asarray(cells, dtype=bool)):
        steps = np.flatnonzero(np.diff(np.concatenate([[0], line.astype(np.int8), [0]])))
        runs += [[iy, int(a), int(b)] for a, b in zip(steps[::2], steps[1::2], strict=True)]
    return runs


def draw_cells(axis: Axes, grid: dict[str, Any], runs: list[list[int]], colour: str, alpha: float = 0.45) -> None:
    """Runs of cells as filled bars in the world's x and y, the row of trays from left to right."""
    from matplotlib.patches import Rectangle

    edge, (x0, y0) = grid["resolution"], grid["origin"]
    for iy, first, end in runs:
        axis.add_patch(
            Rectangle(
                (y0 + iy * edge, x0 + first * edge), edge, (end - first) * edge, color=colour, alpha=alpha, linewidth=0
            )
        )


def grid_values(grid: BaseGrid) -> dict[str, Any]:
    return {"resolution": grid.resolution, "origin": [float(v) for v in grid.origin], "nx": grid.nx, "ny": grid.ny}
