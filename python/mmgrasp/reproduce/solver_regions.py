"""P1 figures 3.4 to 3.8: base regions by an inverse kinematics solver against those by the database, four trays."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from . import stored_regions
from .drawing import TRAY_COLOURS, cells_to_runs, draw_cells, figure, grid_values
from .entry import Context, Entry, Result
from .setup import ChecksAtBase, Row, database, describe, reach_samples

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Four trays in a row at which trays up to two apart share places and the outer two do not: the paper's intersections.
SPACING = 0.40


def by_solver(row: Row, tray: int, samples: int, restarts: int) -> dict[str, Any]:
    """A region in which a solver that knows of no collisions gives one configuration, which is then checked.

    As for the database a cell counts when its centre and its corners are feasible and the robot at home stands free there.
    """
    reach = database(row, samples)
    problem = row.problem()
    grid = _core.make_base_grid(problem, reach)
    solver = _Solver(problem, row.torso, restarts)
    parts = [part for part in problem.trays[tray].parts if part.target]
    targets = [part.T_world_part @ part.grasps[0].T_object_hand for part in parts]
    middle = problem.trays[tray].T_world_tray[:2, 3]
    cells = np.zeros((grid.ny, grid.nx), dtype=bool)
    known: dict[tuple[int, int], bool] = {}

    def feasible(jx: int, jy: int) -> bool:
        """At a point of the lattice of half cells."""
        if (jx, jy) not in known:
            base = [*(grid.origin + 0.5 * grid.resolution * np.array([jx, jy])), 0.0]
            known[jx, jy] = solver.at_home(base) and all(solver.reaches(base, T) for T in targets)
        return known[jx, jy]

    for iy, ix in itertools.product(range(grid.ny), range(grid.nx)):
        if np.hypot(*(grid.centre(0, ix, iy)[:2] - middle)) > 1.2:
            continue
        around = ((1, 1), (0, 0), (2, 0), (0, 2), (2, 2))
        cells[iy, ix] = all(feasible(2 * ix + dx, 2 * iy + dy) for dx, dy in around)
    return {"runs": cells_to_runs(cells), "cells": int(cells.sum())}


class _Solver:
    """One answer of damped least squares for each pose, found without a look at collisions."""

    def __init__(self, problem: _core.PartSupplyProblem, torso: float, restarts: int) -> None:
        self.home, self.arm, self.restarts = problem.home, problem.arm, restarts
        self.checks = ChecksAtBase(problem, torso)

    def at_home(self, base: list[float]) -> bool:
        return bool(self.checks.at_home(np.array([base]))[0])

    def reaches(self, base: list[float], T_world_tip: np.ndarray) -> bool:
        T_base_tip = _core.pose([-base[0], -base[1], 0.0]) @ T_world_tip  # the heading is 0
        if np.linalg.norm(T_base_tip[:2, 3]) > 1.2:
            return False
        found = self.arm.ik(T_base_tip, seed=self.home, restarts=self.restarts, time_limit=10.0)
        return found.outcome == _core.Outcome.solved and bool(self.checks.free(np.array([base]), found.q[None])[0])


def by_database(row: Row, samples: int) -> dict[str, Any]:
    reach = database(row, samples)
    problem = row.problem()
    grid = _core.make_base_grid(problem, reach)
    regions = _core.compute_base_regions(problem, reach, grid)
    return {"grid": grid_values(grid), "runs": [cells_to_runs(r.cells(grid)[0]) for r in regions]}


def _mask(grid: dict[str, Any], runs: list[list[int]]) -> np.ndarray:
    mask = np.zeros((grid["ny"], grid["nx"]), dtype=bool)
    for iy, first, end in runs:
        mask[iy, first:end] = True
    return mask


def shared_sets(masks: list[np.ndarray]) -> dict[int, list[list[int]]]:
    """Sets of two and more trays whose regions share a cell, by their order; trays from 1."""
    out: dict[int, list[list[int]]] = {}
    for order in range(2, len(masks) + 1):
        for trays in itertools.combinations(range(len(masks)), order):
            if np.logical_and.reduce([masks[t] for t in trays]).any():
                out.setdefault(order, []).append([t + 1 for t in trays])
    return out


def run(context: Context) -> Result:
    samples = reach_samples(context.quick)
    row = Row(trays=2 if context.quick else 4, objects=(1, 2) if context.quick else (2, 2), spacing=SPACING)
    database(row, samples, progress=context.progress)
    (kept,) = context.sweep(by_database, [{"row": row, "samples": samples}], "by the database")
    restarts = 2
    solved = context.sweep(
        by_solver,
        [{"row": row, "tray": t, "samples": samples, "restarts": restarts} for t in range(row.trays)],
        "by the solver",
    )
    grid = kept["grid"]
    ours = [_mask(grid, runs) for runs in kept["runs"]]
    theirs = [_mask(grid, one["runs"]) for one in solved]
    papers = stored_regions.run(context, [row] * row.trays, range(row.trays))
    result = Result(setup=describe(row, samples) | papers.describe())
    result.setup["solver"] = f"damped least squares from the home configuration, {restarts} random restarts, one answer"
    for t in range(row.trays):
        values = result.row({"tray": t + 1})
        values["cells by the solver"] = (None, int(theirs[t].sum()))
        values["cells by the database"] = (None, int(ours[t].sum()))
        values["found by the solver only"] = (None, int((theirs[t] & ~ours[t]).sum()))
        values["objects"] = (None, row.per_tray)
        values["grasps"] = (None, row.per_tray * row.grasps)
        papers.fill(values, t)
    papers.conclude(result)
    by_order = {"solver": shared_sets(theirs), "database": shared_sets(ours)}
    for order, paper in ((2, (5, 5)), (3, (0, 2))):
        values = result.row({"order": order})
        for name, count in zip(("solver", "database"), paper, strict=True):
            values[f"intersections, {name}"] = (
                None if context.quick else count,
                len(by_order[name].get(order, [])),
            )
    result.trend(
        "every region by the database is larger than by the solver",
        all(int(a.sum()) > int(b.sum()) for a, b in zip(ours, theirs, strict=True)),
    )
    if not context.quick:
        result.trend(
            "by the database 5 intersections of two and 2 of three regions",
            [len(by_order["database"].get(k, [])) for k in (2, 3, 4)] == [5, 2, 0],
        )
        result.trend(
            "the solver has fewer intersections of three regions",
            len(by_order["solver"].get(3, [])) < len(by_order["database"].get(3, [])),
        )
    result.drawing = {"grid": grid, "database": kept["runs"], "solver": [one["runs"] for one in solved]}
    result.drawing["middles"] = row.tray_middles()
    return result


def draw(result: dict[str, Any]) -> Figure:
    """Figures 3.4 and 3.5."""
    from matplotlib.patches import Rectangle

    drawing = result["drawing"]
    fig, axes = figure(10.0, 4.2, columns=2)
    for axis, name in zip(axes, ("solver", "database"), strict=True):
        for t, runs in enumerate(drawing[name]):
            draw_cells(axis, drawing["grid"], runs, TRAY_COLOURS[t])
        for t, y in enumerate(drawing["middles"]):
            axis.add_patch(Rectangle((y - 0.2, -0.15), 0.4, 0.3, fill=False, edgecolor=TRAY_COLOURS[t], linewidth=1.5))
            axis.annotate(str(t + 1), (y, 0), ha="center", va="center", color=TRAY_COLOURS[t])
        axis.set(title=f"by the {name}", xlabel="along the row [m]", ylabel="towards the trays [m]", aspect="equal")
        ys = drawing["middles"]
        axis.set(xlim=(min(ys) - 1.1, max(ys) + 1.1), ylim=(-1.3, 0.7))
    return fig


ENTRIES = [Entry("p1-figure-3.5", "Base regions by an IK solver and by the database, four trays", run, draw)]
