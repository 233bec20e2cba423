"""Every field of a plan changed in every way: what `verify` does not refuse. (`mutation_shares.py` tries all of them.)"""

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
from mmgrasp.part_supply.plan_writer import scenario_to_dict
from mmgrasp.part_supply.verification import differences

HARMLESS: Harmless = {
    "scenario.name": ("misspelt, other", "a title"),
    "scenario.source": ("misspelt, other", "where the scenario was read from: reported, not used"),
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
    "drive_by.motions[].accelerations[]": ("swapped", "nearly those of the next sample"),
    "drive_by.motions[].velocities[][]": ("sign, zero, doubled", "one that is nearly zero"),
    "drive_by.motions[].accelerations[][]": ("sign, zero, doubled", "as for picks"),
}
"""Changes that may go unnoticed, and why they do no harm."""

ARRIVALS = [[4e-4, 1e-4, 0.0], [1e-4, 4e-4, 0.0], [0.0, 0.0, 3e-4]]
"""A covariance of arrivals for the plan, so that what is counted of them is changed, too."""


def differs(plan: dict[str, Any], expected: dict[str, Any]) -> bool:
    """Whether `verify --scenario` tells the plan's scenario from the file's."""
    return bool(differences(plan.get("scenario"), expected))


def refuses(expected: dict[str, Any] | None, samples: int = 60) -> Callable[[dict[str, Any]], bool]:
    """Verify's answer, beside a scenario or (None) without one; the quick rules first, the samples of regions last."""

    def refused(plan: dict[str, Any]) -> bool:
        try:
            if expected is not None and differs(plan, expected):
                return True
            root = Document("plan", plan, {}).root
            check_form(root)
            if plan["outcome"] != "solved":
                return True
            to_check = plan_to_check(root)
            if check_consistency(plan):
                return True
        except mg.Error:
            return True
        return any(
            checks.check_plan(to_check, samples=samples, region_samples=regions, threads=1).faults for regions in (0, 5)
        )

    return refused


def plan_and_scenario(folder: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    """A plan of three trays and two stops, both reached in passing, and the scenario it is compared with."""
    scenario = yaml.safe_load((ASSETS / "scenarios" / "storeroom.yaml").read_text())
    scenario["trays"] = [{**scenario["trays"][i], "targets": scenario["trays"][i]["targets"][:1]} for i in (0, 1, 3)]
    scenario["reach"] = {"samples": 500_000}
    scenario["arrival_covariance"] = ARRIVALS
    path = folder / "scenario.yaml"
    path.write_text(yaml.safe_dump(scenario, sort_keys=False))
    plan = mg.part_supply.plan_drive_by_picks(mg.plan_part_supply(path)).plan_to_dict()
    return plan, scenario_to_dict(mg.load_scenario(path))
