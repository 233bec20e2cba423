"""plan_part_supply: what it takes, and that it leaves the caller's scenario as it was."""

from __future__ import annotations

import copy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg


@pytest.fixture(scope="module")
def scenario(small_path: Path) -> mg.scenario.Scenario:
    return mg.load_scenario(small_path)


@pytest.mark.slow
def test_planning_does_not_change_the_callers_scenario(scenario: mg.scenario.Scenario) -> None:
    before = copy.deepcopy(scenario.options)
    plan = mg.plan_part_supply(scenario, seed=7, threads=1)
    assert scenario.options == before
    assert plan.to_dict()["scenario"]["options"]["seed"] == 7
    again = mg.plan_part_supply(scenario)  # a seed given once does not stick
    assert again.to_dict()["scenario"]["options"]["seed"] == scenario.problem().options["seed"] != 7


@pytest.mark.slow
def test_later_changes_of_the_scenario_do_not_reach_the_plan(scenario: mg.scenario.Scenario) -> None:
    mine = mg.scenario.Scenario(**vars(scenario))
    plan = mg.plan_part_supply(mine)
    before = plan.to_dict()["scenario"]["options"]
    mine.options["seed"] = 9
    try:
        assert plan.to_dict()["scenario"]["options"] == before
    finally:
        del mine.options["seed"]


@pytest.mark.slow
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


def test_any_object_is_picked_like_a_part(
    scenario: mg.scenario.Scenario, small_plan: mg.part_supply.ScenarioPlan
) -> None:
    problem, database = scenario.problem(), scenario.reach_database()
    picked = small_plan.picks[-1]  # the last one: no other target is in its way
    part = problem.trays[picked.tray].parts[picked.part]
    world = problem.world.copy()
    world.add("thing", part.shapes, part.T_world_part)
    stop = small_plan.stops[picked.stop].pose
    place = part.T_world_part.copy()
    place[2, 3] += 0.01
    for places, kinds in (
        (None, ["transit", "approach", "lift"]),
        ([place], ["transit", "approach", "lift", "transfer", "retreat"]),
    ):
        pick = mg.base.plan_object_pick(
            problem.arm,
            problem.gripper,
            world,
            "thing",
            part.grasps,
            database=database,
            home=problem.home,
            base_pose=stop,
            places=places,
            lift_height=0.1,
        )
        assert pick.outcome == mg.Outcome.solved, pick.failed_at
        assert [motion.kind for motion in pick.motions] == kinds
        assert (pick.tray, pick.part, pick.stop) == (-1, -1, -1)
        arm = problem.arm.at(mg.pose(xyz=(stop[0], stop[1], 0), rpy=(0, 0, stop[2])))
        tool = part.T_world_part @ part.grasps[pick.grasp].T_object_hand
        lift = pick.motions[2].trajectory.positions
        assert np.allclose(arm.fk(lift[0]), tool, atol=1e-3)
        assert np.allclose(arm.fk(lift[-1])[:3, 3], tool[:3, 3] + (0, 0, 0.1), atol=2e-3)
        if places:
            end = arm.fk(pick.motions[3].trajectory.positions[-1])
            assert np.allclose(end @ np.linalg.inv(arm.fk(lift[0])) @ part.T_world_part, place, atol=2e-3)
    with pytest.raises(mg.InvalidInput, match="object = 'stone'"):
        mg.base.plan_object_pick(
            problem.arm, problem.gripper, world, "stone", [], database=database, home=problem.home, base_pose=stop
        )


@pytest.mark.slow
def test_the_base_stays_in_its_workspace(small: dict[str, Any], write: Callable[..., Path]) -> None:
    robot = small["robot"]

    def within(workspace: float) -> dict[str, Any]:
        limits = {**robot.get("base_limits", {}), "workspace": workspace}
        return {**small, "robot": {**robot, "base_limits": limits}}

    plan = mg.plan_part_supply(write(within(2.0)))  # without it the stop is at x = 2.06
    assert plan.outcome == mg.Outcome.solved
    for stop in plan.stops:
        assert np.abs(stop.pose[:2]).max() + 0.1 <= 2.0 + 1e-6
    assert max(np.abs(leg.poses[:, :2]).max() for leg in plan.route) <= 2.0 + 1e-9
    assert mg.verify_plan(plan.to_dict(), samples=50).ok
    near = {**within(0.5), "start": [-0.4, -0.4, 0.0], "goal": [-0.4, 0.4, 0.0]}
    nothing = mg.plan_part_supply(write(near))
    assert nothing.outcome == mg.Outcome.infeasible  # the arm does not reach the tray from anywhere in it: proven
    assert "base_limits.workspace (0.5 m)" in nothing.obstructions[0].message
