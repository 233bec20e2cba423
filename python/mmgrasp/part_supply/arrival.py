"""Arrive, measure, replan: the picks of a stop from where the base really came to stand (P1 3.2: nobody stops exactly)."""

from __future__ import annotations

import json
import math
import os
import time
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from .._argument_errors import checked
from .._core import InvalidInput, Outcome
from .._files import write_files
from .._progress import Progress
from ..documents.reading import near_miss, read_json
from ..scenario import Scenario, load_scenario
from .chosen_parts import chosen_as
from .plan_file import check_form
from .plan_writer import pick_to_dict, scenario_to_dict
from .planning import ScenarioPlan, file_name
from .verification import differences

FORMAT, VERSION = "mmgrasp-arrival", 1


@dataclass(frozen=True)
class Arrival:
    """The picks of one stop, planned again for the base pose that was measured there."""

    scenario: Scenario
    stop: int
    """Index of the plan's stop."""
    pose: NDArray[np.float64]
    """The measured base pose x, y [m], theta [rad]."""
    planned: NDArray[np.float64]
    """The stop's base pose in the plan."""
    radius: float
    """The plan's disc around it [m]: within it, at the planned heading, every part stays graspable."""
    outcome: Outcome
    picks: list[_core.Pick]
    """The picks in order; without a solution those that failed, `failed_at` names the stage."""
    seconds: float
    """What planning took, without reading files."""

    @property
    def offset(self) -> float:
        """How far the base stands from where it was to stand [m]."""
        return float(np.linalg.norm(self.pose[:2] - self.planned[:2]))

    @property
    def turned(self) -> float:
        """How far it is turned against the planned heading [rad], from -pi to pi."""
        return math.remainder(float(self.pose[2] - self.planned[2]), math.tau)

    @property
    def explanations(self) -> list[str]:
        """Why picks failed; empty when solved."""
        if self.outcome == Outcome.solved:
            return []
        near = self.offset <= self.radius
        where = (
            f"the base stands {self.offset:.3f} m from its stop, {'within' if near else 'outside'} the {self.radius:.3f} m that the "
            f"plan allows, and {math.degrees(self.turned):.1f} degrees turned: {'turn it as planned' if near else 'drive nearer to it'}"
        )
        return [
            f"part '{self._part(pick).name}': no pick from here, most candidates fell at stage '{pick.failed_at}' "
            f"({_fallen(pick.rejections)}); {where}"
            for pick in self.picks
        ]

    def _part(self, pick: _core.Pick) -> _core.Part:
        return self.scenario.trays[pick.tray].tray.parts[pick.part]

    def to_dict(self) -> dict[str, Any]:
        """The content of arrival.json: poses, outcome and picks as in plan.json."""
        solved = self.outcome == Outcome.solved
        return {
            "format": FORMAT,
            "version": VERSION,
            "scenario": self.scenario.name,
            "stop": self.stop,
            "pose": self.pose.tolist(),
            "planned_pose": self.planned.tolist(),
            "planned_radius": self.radius,
            "outcome": self.outcome.name,
            "explanations": self.explanations,
            "picks": [pick_to_dict(pick, self.scenario) | {"stop": self.stop} for pick in self.picks] if solved else [],
            "seconds": self.seconds,
        }

    def save(self, folder: str | os.PathLike[str]) -> list[Path]:
        """Writes arrival.json and, solved, one CSV for each arm motion in `trajectories`; returns the paths."""
        motions = {}
        for i, pick in enumerate(self.picks if self.outcome == Outcome.solved else []):
            for j, motion in enumerate(pick.motions):
                name = f"pick_{i:02d}_{file_name(self._part(pick).name)}_{j}_{motion.kind}.csv"
                motions[name] = motion.trajectory.to_csv(base_pose=self.pose)
        written = write_files(Path(folder) / "trajectories", motions, "pick_*.csv")
        answer = json.dumps(self.to_dict(), allow_nan=False) + "\n"
        return [*write_files(Path(folder), {"arrival.json": answer}), *written]


def _fallen(rejections: _core.Rejections) -> str:
    causes = ("unreachable", "limits", "self_collision", "scene", "grasp_filter")
    counts = {cause.replace("_", " "): getattr(rejections, cause) for cause in causes}
    return ", ".join(f"{cause} {count}" for cause, count in counts.items() if count) or "none counted"


@checked
def arrive(
    plan: ScenarioPlan | str | os.PathLike[str],
    stop: int,
    pose: ArrayLike,
    *,
    picked: Iterable[str] = (),
    scenario: str | os.PathLike[str] | None = None,
    robot: str | None = None,
    progress: Progress = None,
) -> Arrival:
    """Plans the picks of a stop again, from the base pose (x, y, theta) measured there.

    `plan` is a plan or the path of a plan.json; the latter's scenario is read from where it was, or from `scenario` (`robot` as in load_scenario),
    and must be the one that was planned for. `stop` is an index into the plan's stops. Parts that the plan picks at earlier stops are gone,
    and so are those named in `picked`. Every motion is checked before it is returned. Raises InvalidInput for a
    stop, pose, part or scenario that is none, where the robot at home is not free at the pose, and where it has no bin.
    """
    loaded, stops, picks = _read(plan, scenario, robot, progress)
    if loaded.unload_region is not None:
        raise InvalidInput(
            f"{loaded.source}: unload_region: picks are not planned from a measured pose where the robot carries each part to the "
            "goal in its hand: it stands elsewhere whenever it comes back to the stop"
        )
    if not stops:
        raise InvalidInput(f"plan = {_name(plan)}: holds no stops")
    if not 0 <= stop < len(stops):
        raise InvalidInput(
            f"stop = {stop}: must be an index from 0, the plan has {len(stops)} stop{'s' * (len(stops) > 1)}"
        )
    index = {part.name: (t, p) for t, tray in enumerate(loaded.trays) for p, part in enumerate(tray.tray.parts)}
    gone = {part for at, part in picks if at < stop}
    for name in picked:
        if name not in index:
            raise InvalidInput(f"picked = {name!r}: is no part of {loaded.source}{near_miss(name, list(index))}")
        gone.add(name)
    planned, radius, trays = stops[stop]
    measured = np.asarray(pose, float)
    if measured.shape != (3,) or not np.isfinite(measured).all():
        raise InvalidInput(f"pose = {pose!r}: must be three finite numbers x, y [m], theta [rad]")
    problem, database = loaded.problem(), loaded.reach_database(progress)
    served = [t for t, tray in enumerate(loaded.trays) if tray.tray.name in trays]
    remaining = [where for name, where in index.items() if name not in gone]
    begun = time.perf_counter()
    outcome, found = _core.plan_stop_picks(problem, database, measured, served, remaining, progress=progress)
    return Arrival(loaded, stop, measured, planned, radius, outcome, found, time.perf_counter() - begun)


Stops = list[tuple[NDArray[np.float64], float, list[str]]]


def _read(
    plan: ScenarioPlan | str | os.PathLike[str],
    scenario: str | os.PathLike[str] | None,
    robot: str | None,
    progress: Progress,
) -> tuple[Scenario, Stops, list[tuple[int, str]]]:
    """The scenario, the stops (pose, radius, trays) and which part is picked at which stop."""
    if isinstance(plan, ScenarioPlan):
        if scenario is not None or robot is not None:
            raise InvalidInput("scenario, robot: a plan that is no file brings its own")
        trays = [tray.tray for tray in plan.scenario.trays]
        stops = [(np.array(s.pose), s.radius, [trays[t].name for t in s.trays]) for s in plan.stops]
        return plan.scenario, stops, [(p.stop, trays[p.tray].parts[p.part].name) for p in plan.picks]
    root = read_json(Path(plan)).root
    check_form(root)
    content = root.raw
    source = content["scenario"]["source"] if scenario is None else os.fspath(scenario)
    loaded = chosen_as(load_scenario(source, robot=robot, progress=progress), content)
    changed = differences(content["scenario"], scenario_to_dict(loaded), limit=1)
    if changed:
        raise InvalidInput(f"{source}: is not what {_name(plan)} was planned for: scenario{changed[0][0]} differs")
    stops = [(np.array(s["pose"], float), float(s["radius"]), list(s["trays"])) for s in content["stops"]]
    return loaded, stops, [(p["stop"], p["part"]) for p in content["picks"]]


def _name(plan: Any) -> str:
    return repr(plan) if isinstance(plan, ScenarioPlan) else os.fspath(plan)
