"""The main job: a scenario in, a checked and explained plan out."""

from __future__ import annotations

import json
import os
import re
import time
from pathlib import Path
from typing import Any

from . import _core
from ._core import Outcome, PartSupplyResult
from ._files import write_file
from ._robot_section import Progress
from .plan_file import plan_to_dict
from .scenario import Scenario, load_scenario


class PartSupplyPlan:
    """A finished plan: where the base stops, which grasps it takes, how base and arm move, and why alternatives lost."""

    def __init__(self, scenario: Scenario, result: PartSupplyResult, extra_timings: list[tuple[str, float]]) -> None:
        self.scenario = scenario
        self.result = result
        self.timings: list[tuple[str, float]] = [*extra_timings, *result.timings]

    @property
    def outcome(self) -> Outcome:
        """Solved, or how the planning ended; `obstructions` then says why."""
        return self.result.outcome

    @property
    def stops(self) -> list[_core.Stop]:
        return self.result.stops

    @property
    def picks(self) -> list[_core.Pick]:
        return self.result.picks

    @property
    def route(self) -> list[_core.BasePath]:
        return self.result.route

    @property
    def obstructions(self) -> list[_core.Obstruction]:
        return self.result.obstructions

    def to_dict(self) -> dict[str, Any]:
        """The content of plan.json (docs/plan_format.md)."""
        return plan_to_dict(self.scenario, self.result, self.timings)

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Writes plan.json."""
        target = Path(path)
        write_file(target, json.dumps(self.to_dict(), allow_nan=False) + "\n")
        return target

    def save_trajectories(self, folder: str | os.PathLike[str]) -> list[Path]:
        """One CSV per arm motion and per leg of the route, named in the order they are carried out."""
        written = []
        for i, pick in enumerate(self.picks):
            tray = self.scenario.trays[pick.tray].tray
            part = re.sub(r"[^A-Za-z0-9_.-]+", "_", tray.parts[pick.part].name)
            for j, motion in enumerate(pick.motions):
                path = Path(folder) / f"pick_{i:02d}_{part}_{j}_{motion.kind}.csv"
                write_file(path, motion.trajectory.to_csv(base_pose=self.stops[pick.stop].pose))
                written.append(path)
        for i, leg in enumerate(self.route):
            path = Path(folder) / f"drive_{i:02d}.csv"
            rows = [",".join(f"{value:.17g}" for value in pose) for pose in leg.poses]
            write_file(path, "\n".join(["base.x,base.y,base.theta", *rows]) + "\n")
            written.append(path)
        return written

    def __repr__(self) -> str:
        if self.outcome != Outcome.solved:
            why = "; ".join(o.message for o in self.obstructions)
            return f"PartSupplyPlan({self.outcome.name}: {why})"
        length = sum(leg.length for leg in self.route)
        return f"PartSupplyPlan(solved, {len(self.stops)} stops, {len(self.picks)} picks, {length:.2f} m driven)"


def plan_part_supply(
    scenario: Scenario | str | os.PathLike[str],
    *,
    seed: int | None = None,
    threads: int | None = None,
    progress: Progress = None,
) -> PartSupplyPlan:
    """Plans a part-supply round: least stops, grasps, arm motions and the drive between (P1 chapter 3).

    `scenario` is a Scenario or a path to its YAML file; `seed` and `threads` go before those of its options; `progress` is
    called with (stage, fraction). Raises InvalidInput or IoError on bad input; that there is no plan is said by the
    result's `outcome` and `obstructions`.
    """
    begun = time.perf_counter()
    if not isinstance(scenario, Scenario):
        scenario = load_scenario(scenario, progress=progress)
    given = {"seed": seed, "threads": threads}
    scenario.options |= {key: value for key, value in given.items() if value is not None}
    problem = scenario.problem()
    loaded = time.perf_counter()
    database = scenario.reach_database(progress)
    timings = [("scenario", loaded - begun), ("reach database", time.perf_counter() - loaded)]
    return PartSupplyPlan(scenario, _core.solve_part_supply(problem, database, progress=progress), timings)
