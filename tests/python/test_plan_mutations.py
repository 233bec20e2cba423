"""Every field of a plan, and of the scenario beside it, changed in every way: what `verify` does not refuse does no harm, and it is said why.

These are the quick sizes; the scripts `plan_mutations.py` and `scenario_mutations.py` make all changes.
"""

from __future__ import annotations

import copy
from pathlib import Path
from typing import Any

import pytest

import mmgrasp as mg
import plan_mutations
import scenario_mutations
from field_changes import Result, all_changes, at, changed, explained, pattern, try_out


def unexplained(result: Result, harmless: Any) -> list[tuple[Any, str]]:
    return [(change.field, change.kind) for change in result.left if not explained(change, harmless)]


@pytest.mark.parametrize("every", [400, pytest.param(17, marks=pytest.mark.slow)])
def test_changes_of_a_plan_are_refused(small: dict[str, Any], write: Any, every: int) -> None:
    path = write({**small, "arrival_covariance": plan_mutations.ARRIVALS})
    plan = mg.part_supply.plan_drive_by_picks(mg.plan_part_supply(path)).plan_to_dict()
    judged = plan_mutations.judge(path)
    assert judged(plan) == {"alone": False, "beside": False}
    result = try_out(
        plan, lambda values: judged(values)["beside"], of_each=4, every=every
    )  # several places of each pattern
    assert result.tried > 4250 / every
    assert not unexplained(result, plan_mutations.HARMLESS)
    assert len(result.left) <= 0.05 * result.tried + 2  # of all: below 1 %
    limits = plan["scenario"]["arm"]["acceleration_limits"]
    for change in result.left:
        if pattern(change.field) == "drive_by.motions[].accelerations[][]" and int(change.field[5]) >= 3:
            assert abs(change.new - at(plan, change.field)) <= 0.01 * limits[int(change.field[5]) - 3], change
        if pattern(change.field) == "picks[].motions[].opening":
            assert at(plan, change.field[:4])["kind"] == "retreat", change
        if pattern(change.field) == "picks[].motions[].accelerations[][]" and change.kind in ("sign", "doubled"):
            assert abs(at(plan, change.field)) <= 0.01 * limits[int(change.field[6])], change


@pytest.mark.parametrize("every", [1000, pytest.param(150, marks=pytest.mark.slow)])
def test_the_judge_says_what_verify_says(small_plan_dict: dict[str, Any], small_path: Path, every: int) -> None:
    """The early refusals are a short cut only, and a scenario that changed is nothing that the plan itself says."""
    judged = plan_mutations.judge(small_path)
    renamed = {**small_plan_dict, "scenario": {**small_plan_dict["scenario"], "positioning_uncertainty": 0.099}}
    assert judged(small_plan_dict) == {"alone": False, "beside": False}
    assert judged(renamed)["beside"]
    changes = list(all_changes(small_plan_dict, of_each=1))[::every]
    early = [c for c in changes if plan_mutations.refused_early(changed(small_plan_dict, c.place, c.new), 60)]
    assert len(early) >= 1500 / every
    assert [c for c in early if not refused_by_verify(changed(small_plan_dict, c.place, c.new), small_path)] == []


def refused_by_verify(plan: dict[str, Any], scenario: Path) -> bool:
    try:
        return bool(mg.verify_plan(plan, scenario=scenario, samples=60, region_samples=0, threads=1).faults)
    except mg.Error:
        return True


@pytest.mark.parametrize("every", [70, pytest.param(7, marks=pytest.mark.slow)])
def test_changes_of_a_scenario_are_told(small: dict[str, Any], tmp_path: Path, every: int) -> None:
    scenario = scenario_mutations.full_scenario(small)
    told = scenario_mutations.tells(scenario, tmp_path)
    assert not told(scenario)
    result = try_out(scenario, told, of_each=4, every=every)
    assert result.tried > 1750 / every
    assert not unexplained(result, scenario_mutations.HARMLESS)
    assert len(result.left) <= 0.05 * result.tried + 2


def test_targets_are_listed_once(small: dict[str, Any], write: Any) -> None:
    scenario = copy.deepcopy(small)
    scenario["trays"][0]["targets"] = [0, "bracket_00"]
    with pytest.raises(mg.InvalidInput, match=r"targets\[1\].*A/bracket_00 is listed twice"):
        mg.load_scenario(write(scenario))
