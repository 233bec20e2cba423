"""Checks a finished plan again, without the planner: KDL, FCL and CBC called directly by the C++ module `verify`."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Unpack

from .._argument_errors import checked
from .._core import InvalidInput
from .._core import verify as checks
from .._options import CheckOptions
from .._progress import Progress
from ..documents.reading import Document, read_json
from ..scenario import load_scenario
from .chosen_parts import chosen_as
from .consistency import check_consistency
from .plan_file import check_form
from .plan_reader import allowed_collisions, plan_to_check
from .plan_writer import scenario_to_dict
from .scan_check import check_scans


@dataclass
class PlanVerdict:
    """What the check found. Without faults the plan holds."""

    faults: list[checks.Fault]
    rates: list[checks.StopRate] = field(default_factory=list)
    minimal_stops: int = 0
    """So many stops are enough for the plan's regions."""
    configurations_checked: int = 0
    allowed_collisions: list[tuple[str, str]] = field(default_factory=list)
    """Pairs that the plan's scenario lets touch, so that nobody checked them."""
    compared_with: str = "the scenario stored in it"
    """The scenario file, or the one stored in the plan when none was given; "nothing" where there is no plan."""
    lower_bound: int = 0
    """Fewer stops are proven not to be enough; below `minimal_stops` the least number is not decided."""
    search_cut: bool = False
    """The search for regions that trays share ended at its limit, which `lower_bound` allows for."""
    regions_searched: bool = False
    """Cells were looked for that the regions lack; without it the numbers of stops hold for the regions as they stand."""

    @property
    def ok(self) -> bool:
        """No fault was found."""
        return not self.faults

    def to_dict(self) -> dict[str, Any]:
        """Plain values, as `mmgrasp verify --json` prints them."""
        return {
            "ok": self.ok,
            "faults": [f.to_dict() for f in self.faults],
            "rates": [r.to_dict() for r in self.rates],
            "minimal_stops": self.minimal_stops,
            "lower_bound": self.lower_bound,
            "search_cut": self.search_cut,
            "regions_searched": self.regions_searched,
            "configurations_checked": self.configurations_checked,
            "allowed_collisions": [list(pair) for pair in self.allowed_collisions],
            "compared_with": self.compared_with,
        }


@checked
def verify_plan(
    plan: dict[str, Any] | str | os.PathLike[str],
    *,
    scenario: str | os.PathLike[str] | None = None,
    robot: str | None = None,
    progress: Progress = None,
    **options: Unpack[CheckOptions],
) -> PlanVerdict:
    """Checks a plan given as plan.json or as its content, against the scenario stored in it.

    With `scenario` the stored one is first compared with that file, read anew (`robot` as in load_scenario). Options are
    those of the C++ PlanCheckOptions (joint_step, samples, ...). Raises InvalidInput when the plan cannot be read at all,
    and for a robot without a scenario.
    """
    if robot is not None and scenario is None:
        raise InvalidInput(f"robot = {robot!r}: needs scenario: it takes the place of that file's robot")
    document = Document("plan", plan, {}) if isinstance(plan, dict) else read_json(Path(plan))
    root = document.root
    check_form(root)
    outcome = root["outcome"].string()
    if outcome != "solved":
        no_plan = checks.Fault("no-plan", "outcome", f"the file holds no plan: its outcome is {outcome}")
        return PlanVerdict([no_plan], compared_with="nothing")
    with root["scenario"].blamed():
        to_check = plan_to_check(root)
        faults = check_consistency(root.raw) + check_scans(root)
    if scenario is not None:
        expected = scenario_to_dict(chosen_as(load_scenario(scenario, robot=robot, progress=progress), root.raw))
        faults += [_changed(path, was, now) for path, was, now in differences(root["scenario"].raw, expected)]
    checked = checks.check_plan(to_check, progress=progress, **options)
    return PlanVerdict(
        faults + checked.faults,
        checked.rates,
        checked.minimal_stops,
        checked.configurations_checked,
        allowed_collisions(root["scenario"]),
        "the scenario stored in it" if scenario is None else os.fspath(scenario),
        checked.lower_bound,
        checked.search_cut,
        checked.regions_searched,
    )


def _changed(path: str, was: Any, now: Any) -> checks.Fault:
    return checks.Fault(
        "scenario-changed", f"scenario{path}", f"the plan was made for {_short(was)}, the file says {_short(now)}"
    )


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


def differences(was: Any, now: Any, path: str = "", limit: int = 20) -> list[tuple[str, Any, Any]]:
    """Where two scenario sections differ physically; numbers may differ by rounding."""
    out = []
    for found in _walk(was, now, path):
        out.append(found)
        if len(out) == limit:
            break
    return out


# A scan's map and a robot's URDF are compared by what they hold.
IGNORED = re.compile(r"\.name|\.source|\.options\.seed|\.scans\[\d+\]\.map|\.robot\.urdfs\[\d+\]\.origin")


def _walk(was: Any, now: Any, path: str) -> Iterator[tuple[str, Any, Any]]:
    if IGNORED.fullmatch(path):
        return
    if isinstance(was, dict) and isinstance(now, dict):
        for key in sorted(was.keys() | now.keys()):
            yield from _walk(was.get(key), now.get(key), f"{path}.{key}")
    elif isinstance(was, list) and isinstance(now, list) and len(was) == len(now):
        for i, (a, b) in enumerate(zip(was, now, strict=True)):
            yield from _walk(a, b, f"{path}[{i}]")
    elif _is_number(was) and _is_number(now):
        if abs(was - now) > 1e-9 * max(1.0, abs(was)):
            yield path, was, now
    elif was != now:
        yield path, was, now


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
