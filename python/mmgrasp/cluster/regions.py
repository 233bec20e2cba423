"""Base regions with one shard a tray."""

from __future__ import annotations

import functools
import os
from pathlib import Path
from typing import Any, Protocol

from .. import _core
from .._argument_errors import checked
from .._core import BaseGrid, BaseRegion, Error, Part, PartSupplyProblem, ReachDatabase, Tray
from .._progress import Progress
from .._reach_cache import cached_database
from ..scenario import Scenario, load_scenario
from .content import problem_digest
from .engine import Engine


class ProblemSource(Protocol):
    """A frozen dataclass of plain values that makes the same problem on every machine (mmgrasp.reproduce.setup.Row)."""

    def problem(self) -> PartSupplyProblem:
        """The problem, made where it is needed."""


@checked
def compute_base_regions(
    source: str | os.PathLike[str] | ProblemSource,
    *,
    engine: Engine,
    database: str | os.PathLike[str] | dict[str, Any] | None = None,
    progress: Progress = None,
) -> tuple[BaseGrid, list[BaseRegion]]:
    """What mmgrasp.base.compute_base_regions gives on make_base_grid's grid, bit for bit, computed tray by tray on the engine.

    `source` is a scenario's path or a ProblemSource. `database` is the path of a saved database or the options to build one
    with (from each machine's cache); None: a scenario's own `reach` section. Paths must mean the same files on every
    worker: a worker that reads another problem or database refuses its shard. Raises InvalidInput, IoError, Error.
    """
    place = named(source)
    given = named(database) if isinstance(database, (str, os.PathLike)) else database
    problem, reach = _load(place, _frozen(given))
    grid = _core.make_base_grid(problem, reach)
    digest = problem_digest(problem, reach)
    trays = range(len(problem.trays))
    items = [{"source": place, "database": given, "digest": digest, "tray": t} for t in trays]
    regions = engine.run(compute_tray, items, progress=progress, stage="base regions")
    return grid, regions


def compute_tray(source: Any, database: Any, digest: str, tray: int) -> BaseRegion:
    """The region of one tray; the parts of the others stay in place as obstacles."""
    problem, reach = _load(source, _frozen(database))
    if problem_digest(problem, reach) != digest:
        raise Error(f"{source}: a worker reads another scenario or database than the client under this name")
    grid = _core.make_base_grid(problem, reach)
    return _core.compute_base_regions(alone(problem, tray), reach, grid)[tray]


def alone(problem: PartSupplyProblem, tray: int) -> PartSupplyProblem:
    """The same problem with targets in one tray only."""
    options: dict[str, Any] = problem.options
    trays = []
    for i, t in enumerate(problem.trays):
        parts = t.parts if i == tray else [_staying(part) for part in t.parts]
        trays.append(Tray(t.name, t.T_world_tray, t.size, parts, t.headings))
    return PartSupplyProblem(
        problem.robot,
        problem.arm,
        problem.gripper,
        problem.world,
        trays,
        problem.home,
        problem.start,
        problem.goal,
        problem.place_region,
        unload_region=problem.unload_region,
        **options,
    )


def _staying(part: Part) -> Part:
    return Part(
        part.name, part.shapes, part.T_world_part, part.grasps, target=False, grasps_too_wide=part.grasps_too_wide
    )


def named(path: Any) -> Any:
    """A path in full, so that workers in other folders find it; anything else as it is."""
    return (
        str(Path(path).resolve())
        if isinstance(path, (str, os.PathLike)) and not str(path).startswith("asset:")
        else path
    )


def _frozen(database: Any) -> Any:
    return tuple(sorted(database.items())) if isinstance(database, dict) else database


@functools.lru_cache(maxsize=2)
def _load(source: Any, database: Any) -> tuple[PartSupplyProblem, ReachDatabase]:
    """Once for the shards that a worker does one after the other."""
    made = load_scenario(source) if isinstance(source, str) else source
    problem = made.problem()
    if isinstance(database, str):
        return problem, ReachDatabase.load(database, problem.arm)
    if database is not None:
        return problem, cached_database(problem.arm, **dict(database))
    if not isinstance(made, Scenario):
        raise _core.InvalidInput("database: must be given with a problem that is no scenario")
    return problem, made.reach_database()
