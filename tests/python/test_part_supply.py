"""plan_part_supply: what it takes, and that it leaves the caller's scenario as it was."""

from __future__ import annotations

import copy
from pathlib import Path

import pytest

import mmgrasp as mg


@pytest.fixture(scope="module")
def scenario(small_path: Path) -> mg.scenario.Scenario:
    return mg.load_scenario(small_path)


def test_planning_does_not_change_the_callers_scenario(scenario: mg.scenario.Scenario) -> None:
    before = copy.deepcopy(scenario.options)
    plan = mg.plan_part_supply(scenario, seed=7, threads=1)
    assert scenario.options == before
    assert plan.to_dict()["scenario"]["options"]["seed"] == 7
    again = mg.plan_part_supply(scenario)  # a seed given once does not stick
    assert again.to_dict()["scenario"]["options"]["seed"] == scenario.problem().options["seed"] != 7


def test_later_changes_of_the_scenario_do_not_reach_the_plan(scenario: mg.scenario.Scenario) -> None:
    mine = mg.scenario.Scenario(**vars(scenario))
    plan = mg.plan_part_supply(mine)
    before = plan.to_dict()["scenario"]["options"]
    mine.options["seed"] = 9
    try:
        assert plan.to_dict()["scenario"]["options"] == before
    finally:
        del mine.options["seed"]


def test_a_problem_as_objects_gives_the_plan_that_its_scenario_gives(
    scenario: mg.scenario.Scenario, small_plan: mg.part_supply.ScenarioPlan
) -> None:
    plan = mg.plan_part_supply(scenario.problem(), scenario.reach_database())
    assert isinstance(plan, mg.base.PartSupplyPlan) and isinstance(small_plan.plan, mg.base.PartSupplyPlan)
    assert plan.outcome == mg.Outcome.solved
    assert [s.pose.tolist() for s in plan.stops] == [s.pose.tolist() for s in small_plan.stops]
    for ours, theirs in zip(plan.picks, small_plan.picks, strict=True):
        assert (ours.tray, ours.part, ours.grasp) == (theirs.tray, theirs.part, theirs.grasp)
        for a, b in zip(ours.motions, theirs.motions, strict=True):
            assert a.trajectory.positions.tolist() == b.trajectory.positions.tolist()


def test_a_problem_needs_its_database_and_has_its_own_seed(scenario: mg.scenario.Scenario) -> None:
    problem, database = scenario.problem(), scenario.reach_database()
    with pytest.raises(mg.InvalidInput, match="database = None"):
        mg.plan_part_supply(problem)  # type: ignore[call-overload]
    with pytest.raises(mg.InvalidInput, match="own options"):
        mg.plan_part_supply(problem, database, seed=1)  # type: ignore[call-overload]
    with pytest.raises(mg.InvalidInput, match="section `reach`"):
        mg.plan_part_supply(scenario, database)  # type: ignore[call-overload]
