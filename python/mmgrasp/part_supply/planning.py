"""The main job: a scenario in, a checked and explained plan out."""

from __future__ import annotations

import json
import os
import re
import time
from dataclasses import replace
from pathlib import Path
from typing import Any, overload

from .. import _core
from .._argument_errors import checked
from .._core import InvalidInput, Outcome, PartSupplyPlan, PartSupplyProblem, ReachDatabase, RobotMotion
from .._files import check_file, write_file, write_files
from .._progress import Progress, growing, is_callers
from ..scenario import Scenario, load_scenario
from .chosen_parts import by_number, choose_parts, others_will_do
from .plan_writer import plan_to_dict, scenario_to_dict
from .premises import Premises, premises
from .round_motion import AT_GOAL, RoundMotion

_IN_PASSES = ("route", "picks")  # of the floor, of drives to choose from and of those that are driven; stop after stop
_MOST_CHOICES = 5  # choices of parts asked for by number that are planned for


def file_name(name: str) -> str:
    """A name as a piece of a file's name."""
    return re.sub(r"[^A-Za-z0-9_.-]+", "_", name)[:80]


class ScenarioPlan:
    """A scenario and the plan made for it: where the base stops, which grasps it takes, how base and arm move, and why alternatives lost.

    The plan names trays and parts by their indices in the scenario; both together are what plan.json holds.
    """

    def __init__(self, scenario: Scenario, plan: PartSupplyPlan, extra_timings: list[tuple[str, float]]) -> None:
        self.scenario = scenario
        self.plan = plan
        self.timings: list[tuple[str, float]] = [*extra_timings, *plan.timings]

    @property
    def outcome(self) -> Outcome:
        """Solved, or how the planning ended; `obstructions` then says why."""
        return self.plan.outcome

    @property
    def stops(self) -> list[_core.Stop]:
        """Base poses in the order in which they are visited."""
        return self.plan.stops

    @property
    def picks(self) -> list[_core.Pick]:
        """Every pick with its timed motions, in order."""
        return self.plan.picks

    @property
    def route(self) -> list[_core.BasePath]:
        """Drives from the start over the stops to the goal."""
        return self.plan.route

    @property
    def obstructions(self) -> list[_core.Obstruction]:
        """Why there is no plan and what would help; empty when solved."""
        return self.plan.obstructions

    @property
    def premises(self) -> Premises:
        """What the least number of stops was proven for: headings, cells, grasps, ... (docs/plan_format.md)."""
        return premises(
            {
                "scenario": scenario_to_dict(self.scenario),
                "grid": {"resolution": self.plan.grid.resolution},
                "proven_minimal": self.plan.proven_minimal,
            }
        )

    def to_dict(self) -> dict[str, Any]:
        """The content of plan.json (docs/plan_format.md): the same from run to run, at any number of threads."""
        return plan_to_dict(self.scenario, self.plan)

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Writes plan.json. Raises IoError where a file is that is no plan: the scenario, say."""
        target = Path(path)
        check_file(target, b'{"format": "mmgrasp-plan"')
        write_file(target, json.dumps(self.to_dict(), allow_nan=False) + "\n")
        return target

    def motion(self) -> RobotMotion:
        """The whole round as a robot carries it out: drives, picks and gripper on one clock. Raises InvalidInput without a plan."""
        return RoundMotion(self.scenario, self.plan).make({})

    def save_trajectories(self, folder: str | os.PathLike[str]) -> list[Path]:
        """One CSV for the whole round, and one per arm motion and per leg of the route, named in the order they are carried out."""
        contents = {}
        if self.outcome == Outcome.solved:
            contents["round.csv"] = self.motion().to_csv()
        for i, pick in enumerate(self.picks):
            tray = self.scenario.trays[pick.tray].tray
            part = file_name(tray.parts[pick.part].name)
            for j, motion in enumerate(pick.motions):
                at_goal = self.scenario.unload_region is not None and motion.kind in AT_GOAL
                base = self.scenario.goal if at_goal else self.stops[pick.stop].pose
                csv = motion.trajectory.to_csv(base_pose=base)
                contents[f"pick_{i:02d}_{part}_{j}_{motion.kind}.csv"] = csv
        robot, arm, home = self.scenario.setup.robot, self.scenario.setup.arm, self.scenario.setup.home
        for i, leg in enumerate(self.route):
            contents[f"drive_{i:02d}.csv"] = RobotMotion.of_drive(leg, robot, arm, home).to_csv()
        for unloading in self.plan.unloadings:
            for name, drive in (("to_goal", unloading.to_goal), ("back", unloading.back)):
                if drive is not None:
                    csv = RobotMotion.of_drive(drive, robot, arm, home).to_csv()
                    contents[f"drive_unloading_{unloading.after_pick:02d}_{name}.csv"] = csv
        return write_files(Path(folder), contents, "pick_*.csv", "drive_*.csv", "round.csv")

    def __repr__(self) -> str:
        if self.outcome != Outcome.solved:
            why = "; ".join(o.message for o in self.obstructions)
            return f"ScenarioPlan({self.outcome.name}: {why})"
        length = sum(leg.length for leg in self.route)
        return f"ScenarioPlan(solved, {len(self.stops)} stops, {len(self.picks)} picks, {length:.2f} m driven)"


@overload
def plan_part_supply(
    scenario: Scenario | str | os.PathLike[str],
    *,
    seed: int | None = None,
    threads: int | None = None,
    progress: Progress = None,
) -> ScenarioPlan: ...
@overload
def plan_part_supply(
    scenario: PartSupplyProblem, database: ReachDatabase, *, progress: Progress = None
) -> PartSupplyPlan: ...
@checked
def plan_part_supply(
    scenario: Scenario | PartSupplyProblem | str | os.PathLike[str],
    database: ReachDatabase | None = None,
    *,
    seed: int | None = None,
    threads: int | None = None,
    progress: Progress = None,
) -> ScenarioPlan | PartSupplyPlan:
    """Plans a part-supply round: least stops, grasps, arm motions and the drive between (P1 chapter 3).

    `scenario` is a Scenario or a path to its YAML file and stays as it is; `seed` and `threads` go before those of its
    options, for this call. Given as objects instead, a PartSupplyProblem comes with its arm's reachability database, its
    seed and threads are in its own options, and the answer is the plan alone. `progress` is called with (stage, fraction), of each stage with fractions that grow to 1.
    Raises InvalidInput or IoError on bad input; that there is no plan is said by the answer's `outcome` and `obstructions`.
    """
    with growing(progress, _IN_PASSES) as progress:
        if isinstance(scenario, PartSupplyProblem):
            if database is None:
                raise InvalidInput("database = None: a PartSupplyProblem needs its arm's ReachDatabase")
            if seed is not None or threads is not None:
                raise InvalidInput("seed, threads: those of a PartSupplyProblem are in its own options")
            return _core.plan_part_supply(scenario, database, progress=progress)
        if database is not None:
            raise InvalidInput(
                "database: only a PartSupplyProblem takes one; a scenario has its own (its section `reach`)"
            )
        begun = time.perf_counter()
        if not isinstance(scenario, Scenario):
            scenario = load_scenario(scenario, progress=progress)
        given = {"seed": seed, "threads": threads}
        options = scenario.options | {key: value for key, value in given.items() if value is not None}
        scenario = replace(scenario, options=options)  # the caller's keeps its own
        try:  # what only shows with the robot's reach known: cells too fine for it, too large a grid
            problem = scenario.problem()
            loaded = time.perf_counter()
            reach = scenario.reach_database(progress)
            timings = [("scenario", loaded - begun), ("reach database", time.perf_counter() - loaded)]
            if by_number(scenario):
                return _plan_by_number(scenario, reach, timings, progress)
            return ScenarioPlan(scenario, _core.plan_part_supply(problem, reach, progress=progress), timings)
        except InvalidInput as error:
            if is_callers(error):
                raise
            raise InvalidInput(f"{scenario.source}: {error}") from None


def _plan_by_number(
    scenario: Scenario, reach: ReachDatabase, timings: list[tuple[str, float]], progress: Progress
) -> ScenarioPlan:
    """Chooses the parts that were asked for by number and plans; parts that cannot be picked are left where others of their type are there."""
    left: set[str] = set()
    for tries in range(_MOST_CHOICES):
        begun = time.perf_counter()
        chosen = choose_parts(scenario, reach, left, progress)
        timings.append(("parts by number", time.perf_counter() - begun))
        plan = ScenarioPlan(chosen, _core.plan_part_supply(chosen.problem(), reach, progress=progress), timings)
        failed = others_will_do(chosen, (o.part for o in plan.obstructions if o.part)) - left
        if plan.outcome in (Outcome.solved, Outcome.stopped) or not failed or tries + 1 == _MOST_CHOICES:
            return plan
        left |= failed
    raise AssertionError("the last choice was returned")
