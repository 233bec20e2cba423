"""P1's own base regions (Algorithms 2 and 4) beside exact ones: stored configurations of a voxel stand for its poses.

A base position counts for P1 when, for every object, one of the configurations stored in the grasp's voxel is free of collisions
there. Such a configuration reaches some pose in the voxel, not the grasp: whether the grasp itself can be reached is told by
every branch of exact inverse kinematics. Both are asked at the middles of the same cells, by the same collision checks.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import _core
from .._core import BaseGrid, ReachDatabase
from .._progress import Progress
from .entry import Context, Result
from .setup import ChecksAtBase, Row, database, reach_samples

_RADIUS = ": radius (m)"  # the end of a column's name
FINDING = "Algorithm 4 is P1's:"
REDUNDANT_VALUES = (12, 96)  # of the seventh joint; the many where the few give no free configuration
ROUND = 8  # configurations of a pose that are checked together before the next ones are looked at


@dataclass(frozen=True)
class Density:
    """How many configurations a database is drawn from, and how many of them a voxel keeps."""

    name: str
    samples: int
    kept: int = 16

    def database(self, row: Row, progress: Progress = None) -> ReachDatabase:
        return database(row, self.samples, progress=progress, max_per_cell=self.kept)


# As many poses as the paper's database has, which keeps all; it prints 2 million voxels, ours are 1.3 million.
DENSE = Density("92 M poses", 111_000_000, kept=100_000)


@dataclass(frozen=True)
class Papers:
    """What P1's own algorithm gives for the rows of a table, at each density."""

    densities: list[Density]
    found: list[list[dict[str, Any]]]

    def fill(self, values: dict[str, tuple[Any, Any]], index: int) -> None:
        """The columns for the table's row of this index."""
        for density, rows in zip(self.densities, self.found, strict=True):
            ours, head = rows[index], f"Algorithm 4, {density.name}"
            values[f"{head}: cells"] = (None, ours["cells"])
            values[f"{head}: not exact"] = (None, ours["false"] / ours["cells"] if ours["cells"] else None)
            values[f"{head}: missed"] = (None, ours["missed"] / ours["exact"] if ours["exact"] else None)
            values[f"{head}{_RADIUS}"] = (None, ours["radius"])
            values[f"{head}: time (s)"] = (None, ours["seconds"])

    def describe(self) -> dict[str, Any]:
        """The databases, for a set-up."""
        return {
            f"Algorithm 4, {density.name}": f"{rows[0]['poses']} poses in {rows[0]['voxels']} voxels"
            for density, rows in zip(self.densities, self.found, strict=True)
        }

    def conclude(self, result: Result) -> None:
        """What the columns mean, and P1's first lemma: with more samples fewer cells are missed."""
        shares = []
        for density, rows in zip(self.densities, self.found, strict=True):
            cells, false = sum(ours["cells"] for ours in rows), sum(ours["false"] for ours in rows)
            shares.append(f"{false} of {cells} ({density.name})")
        result.notes.append(
            f"{FINDING} a base position counts when a configuration stored in each grasp's voxel is free of collisions. Such a "
            "configuration reaches another pose of the voxel. 'Not exact': the share of its cells at whose middle some object has no "
            f"configuration at all that reaches the grasp and is free, in all rows {' and '.join(shares)}; 'missed': the share of the cells "
            "with such configurations that it does not find. All branches of exact inverse kinematics decide, for "
            f"{REDUNDANT_VALUES[-1]} values of the redundant joint. Ours count when their corners are exact, too. Times of Algorithm 4 are a Python loop's."
        )
        if len(self.found) > 1:
            missed = [sum(ours["missed"] for ours in rows) for rows in self.found]
            result.trend("a denser database lets Algorithm 4 miss fewer cells (lemma 1)", missed[-1] < missed[0])


def radii(rows: Sequence[dict[str, Any]]) -> dict[str, list[float]]:
    """The radius that Algorithm 4 gives in each row of a table, by the name of its columns (one a density)."""
    names = [name for name in rows[0]["values"] if name.endswith(_RADIUS)]
    return {name.removesuffix(_RADIUS): [row["values"][name]["ours"] for row in rows] for name in names}


def densities(quick: bool) -> list[Density]:
    """The database that our own regions use, and the paper's number of poses in its number of voxels."""
    usual = Density(f"{reach_samples(quick) / 1e6:g} M drawn", reach_samples(quick))
    return [usual] if quick else [usual, DENSE]


def run(context: Context, rows: Sequence[Row], trays: Sequence[int | None] | None = None) -> Papers:
    """Algorithm 4 on each row, at each density; of a row's trays on that one alone if `trays` names one."""
    chosen = densities(context.quick)
    found = []
    for density in chosen:
        density.database(rows[0], context.progress)
        asked = [None] * len(rows) if trays is None else trays
        items = [{"row": row, "density": density, "tray": tray} for row, tray in zip(rows, asked, strict=True)]
        found.append(context.sweep(measure, items, f"Algorithm 4, {density.name}"))
    return Papers(chosen, found)


def measure(row: Row, density: Density, tray: int | None = None) -> dict[str, Any]:
    """Algorithm 4's region of a tray, or the cells shared by all: what it holds, what of it is false, the radius it promises."""
    reach = density.database(row)
    problem = row.problem()
    grid = _core.make_base_grid(problem, reach)
    checks = ChecksAtBase(problem, row.torso)
    targets = _targets(problem.trays if tray is None else [problem.trays[tray]])
    begun = time.perf_counter()
    standing = _standing(grid, checks)
    stored = _served(standing, targets, [reach.query], checks)
    seconds = time.perf_counter() - begun
    exact = _served(standing, targets, _exact(problem.arm), checks)
    cells = _mask(grid, stored)
    return {
        "poses": len(reach),
        "voxels": reach.cell_count,
        "cells": int(cells.sum()),
        "false": int((cells & ~_mask(grid, exact)).sum()),
        "exact": len(exact),
        "missed": int((_mask(grid, exact) & ~cells).sum()),
        "radius": _core.inscribed_circle(grid, cells[None])[1],
        "seconds": seconds,
    }


def _targets(trays: Sequence[_core.Tray]) -> list[list[np.ndarray]]:
    """T_world_tip of every grasp of each target, the parts farthest from their tray's middle first: they decide most."""
    poses: list[tuple[float, list[np.ndarray]]] = []
    for tray in trays:
        for part in tray.parts:
            if part.target:
                away = float(np.linalg.norm((part.T_world_part - tray.T_world_tray)[:2, 3]))
                poses.append((-away, [part.T_world_part @ grasp.T_object_hand for grasp in part.grasps]))
    return [grasps for _, grasps in sorted(poses, key=lambda pose: pose[0])]


def _standing(grid: BaseGrid, checks: ChecksAtBase) -> np.ndarray:
    """(k, 3) middles of the cells where the robot at home stands free."""
    centres = np.array([grid.centre(0, ix, iy) for iy in range(grid.ny) for ix in range(grid.nx)])
    return np.asarray(centres[checks.at_home(centres)])


def _served(
    bases: np.ndarray,
    targets: Sequence[list[np.ndarray]],
    sources: Sequence[Callable[[np.ndarray], np.ndarray]],
    checks: ChecksAtBase,
) -> np.ndarray:
    """Those of the base poses (k, 3) at which every target has a grasp with a configuration free of collisions.

    The sources of configurations for a tool pose are asked one after the other, where those before gave none that is free.
    """
    for grasps in targets:
        served = np.zeros(len(bases), dtype=bool)
        for configurations in sources:
            left = np.flatnonzero(~served)
            found = [np.vstack([configurations(_seen_from(base, T)) for T in grasps]) for base in bases[left]]
            served[left] = _any_free(bases[left], found, checks)
        bases = bases[served]
    return bases


def _any_free(bases: np.ndarray, found: list[np.ndarray], checks: ChecksAtBase) -> np.ndarray:
    """Whether one of the configurations found for each base pose is free."""
    served = np.zeros(len(bases), dtype=bool)
    for first in range(0, max(map(len, found), default=0), ROUND):
        asked = [i for i in np.flatnonzero(~served) if len(found[i]) > first]
        if not asked:
            break
        some = [found[i][first : first + ROUND] for i in asked]
        owners = np.repeat(asked, [len(rows) for rows in some])
        served[owners[checks.free(bases[owners], np.vstack(some))]] = True
    return served


def _seen_from(base: np.ndarray, T_world_tip: np.ndarray) -> np.ndarray:
    """T_base_tip; the heading is 0."""
    T = T_world_tip.copy()
    T[:2, 3] -= base[:2]
    return T


def _exact(arm: _core.JointGroup) -> list[Callable[[np.ndarray], np.ndarray]]:
    def branches(values: int) -> Callable[[np.ndarray], np.ndarray]:
        return lambda T_base_tip: arm.ik_branches(T_base_tip, redundant_values=values, restarts=0).solutions

    return [branches(values) for values in REDUNDANT_VALUES]


def _mask(grid: BaseGrid, bases: np.ndarray) -> np.ndarray:
    """(ny, nx): the cells with these middles."""
    mask = np.zeros((grid.ny, grid.nx), dtype=bool)
    ix, iy = np.floor((bases[:, :2] - grid.origin) / grid.resolution).astype(int).T
    mask[iy, ix] = True
    return mask
