"""Every field of a plan changed in every way: what `verify` does not refuse. (`mutation_shares.py` tries all of
them.)"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import yaml

import mmgrasp as mg
from field_changes import Harmless
from mmgrasp._core import verify as checks
from mmgrasp._files import ASSETS
from mmgrasp.documents.reading import Document
from mmgrasp.part_supply.consistency import check_consistency
from mmgrasp.part_supply.plan_file import check_form
from mmgrasp.part_supply.plan_reader import plan_to_check

HARMLESS: Harmless = {
    "scenario.name": ("misspelt, other", "a title"),
    "scenario.source": ("misspelt, other", "where the scenario was read from: reported, not used"),
    "scenario.robot.urdfs[].origin": ("misspelt, other, emptied", "where the robot was read from: its text decides"),
    "scenario.options.seed": ("any", "another seed is another search, and any answer is checked"),
    "grid.nx": ("more, less", "one column of empty cells at the border, as an arm of another reach would need"),
    "grid.ny": ("more, less", "one row of empty cells, as for columns"),
    "stops[].arrivals.served": ("more, less", "one arrival of 2000: other draws differ by more"),
    "picks[].motions[].opening": (
        "more, less",
        "of the way back: any opening that the fingers have room for will do, and is checked",
    ),
    "picks[].motions[].velocities[]": ("swapped", "nearly those of the next sample"),
    "picks[].motions[].accelerations[]": ("swapped", "nearly those of the next sample"),
    "picks[].motions[].accelerations[][]": (
        "sign, zero, doubled",
        "one that is nearly zero, below a thousandth of its limit; or where it jumps as the interval before has it",
    ),
    "drive_by": ("removed", "the plan holds with it and without it"),
    "drive_by.motions": ("dropped, emptied", "each is checked by itself, and the plan holds without it"),
    "drive_by.motions[]": ("removed", "as for the list"),
    "drive_by.motions[].closed_at": (
        "more, less",
        "2 % of it: the fingers get 0.1 s more than they need, and the tool still stands a little later",
    ),
    "drive_by.motions[].begins": ("removed", "home where it is left out, as the first one says"),
    "intersections[]": ("swapped", "two in which no stop stands: their order says nothing"),
    "intersections[].centre[]": (
        "more",
        "of one in which no stop stands: its region goes on along y and has room there",
    ),
    "drive_by.motions[].accelerations[][]": ("sign, zero, doubled", "as for picks"),
}
"""Changes that may go unnoticed, and why they do no harm."""

ARRIVALS = [[4e-4, 1e-4, 0.0], [1e-4, 4e-4, 0.0], [0.0, 0.0, 3e-4]]
"""A covariance of arrivals for the plan, so that what is counted of them is changed, too."""


def refused_early(plan: dict[str, Any], samples: int) -> bool:
    """Some of what verify_plan asks, the quick rules first and without the samples of regions: what is refused here it
    refuses, too. Most changes end here. (verify_plan goes through all its rules whatever the first ones say: 75 s
    instead of 28 s for 150 changes.)"""
    try:
        root = Document("plan", plan, {}).root
        check_form(root)
        if plan["outcome"] != "solved":
            return True
        to_check = plan_to_check(root)
        if check_consistency(plan):
            return True
    except mg.Error:
        return True
    return bool(checks.check_plan(to_check, samples=samples, region_samples=0, threads=1).faults)


def judge(scenario: Path, samples: int = 60) -> Callable[[dict[str, Any]], dict[str, bool]]:
    """Whether `verify` refuses a plan alone, and beside this scenario; that it does not is said by verify_plan
    itself."""

    def judged(plan: dict[str, Any]) -> dict[str, bool]:
        if refused_early(plan, samples):
            return {"alone": True, "beside": True}
        try:
            found = mg.verify_plan(plan, scenario=scenario, samples=samples, region_samples=5, threads=1).faults
        except mg.Error:
            return {"alone": True, "beside": True}
        return {"alone": any(fault.code != "scenario-changed" for fault in found), "beside": bool(found)}

    return judged


def plan_and_scenario(folder: Path) -> tuple[dict[str, Any], Path]:
    """A plan of three trays and two stops, both reached in passing, and the scenario it was made for, a file in the
    folder."""
    scenario = yaml.safe_load((ASSETS / "scenarios" / "storeroom.yaml").read_text())
    scenario["trays"] = [{**scenario["trays"][i], "targets": scenario["trays"][i]["targets"][:1]} for i in (0, 1, 3)]
    scenario["reach"] = {"samples": 500_000}
    scenario["arrival_covariance"] = ARRIVALS
    path = folder / "scenario.yaml"
    path.write_text(yaml.safe_dump(scenario, sort_keys=False))
    return mg.part_supply.plan_drive_by_picks(mg.plan_part_supply(path)).plan_to_dict(), path
