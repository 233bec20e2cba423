"""Drives keep a clearance: in scenarios, plans, advice and `verify`."""

from __future__ import annotations

import copy
import itertools
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp.scenario import load_scenario
from mmgrasp.viz.report import report_html

Write = Callable[..., Path]
NEAR_ENDS = 1.0  # [m]
CLEARANCE = 0.25


@pytest.fixture(scope="module")
def roomy(small: dict[str, Any]) -> dict[str, Any]:
    """A post beside the straight way from the start to the goal, which is driven after the picks."""
    scenario = copy.deepcopy(small) | {"drive_clearance": CLEARANCE}
    scenario["goal"] = [-6.0, 0.0, 0.0]
    scenario["obstacles"] = [
        *scenario["obstacles"],
        {"name": "post", "box": [0.2, 0.2, 1.0], "pose": {"xyz": [-3.0, 0.45, 0.5]}},
        {"name": "other post", "box": [0.2, 0.2, 1.0], "pose": {"xyz": [-3.0, -0.9, 0.5]}},
    ]
    return scenario


@pytest.fixture(scope="module")
def plan(roomy: dict[str, Any], write: Write) -> mg.part_supply.ScenarioPlan:
    made = mg.plan_part_supply(write(roomy))
    assert made.outcome == mg.Outcome.solved, made
    return made


def kept(scenario: mg.scenario.Scenario, poses: np.ndarray) -> float:
    """Least distance to all but the ground where the base is farther than 1 m from both ends [m], every centimetre."""
    world = scenario.world_with_parts
    world.remove("floor")
    robot, arm = scenario.setup.robot, scenario.setup.arm
    least = np.inf
    for a, b in itertools.pairwise(poses):
        steps = 1 + round(max(np.linalg.norm((b - a)[:2]) / 0.01, abs(b - a)[2] / 0.02))
        for share in np.linspace(0.0, 1.0, steps):
            x, y, theta = a + share * (b - a)
            if min(np.linalg.norm([x, y] - end[:2]) for end in (poses[0], poses[-1])) <= NEAR_ENDS:
                continue
            root = np.eye(4)
            root[:2, :2] = [[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]]
            root[:2, 3] = x, y
            checker = mg.CollisionChecker(robot, world, arm.at(root), check_self=False)
            least = min([least, *(near.value for near in checker.distances(scenario.setup.home, 1.0))])
    return float(least)


def test_every_drive_keeps_it(roomy: dict[str, Any], plan: mg.part_supply.ScenarioPlan, write: Write) -> None:
    close = mg.plan_part_supply(write({k: v for k, v in roomy.items() if k != "drive_clearance"}))
    scenario = load_scenario(write(roomy))
    assert min(kept(scenario, np.array(leg.poses)) for leg in close.route) < 0.9 * CLEARANCE
    assert min(kept(scenario, np.array(leg.poses)) for leg in plan.route) >= CLEARANCE
    values = plan.to_dict()
    assert values["scenario"]["drive_clearance"] == CLEARANCE
    assert "drives keep" in report_html(values)
    assert mg.verify_plan(values).ok
    boast = close.to_dict()
    boast["scenario"]["drive_clearance"] = CLEARANCE
    assert {fault.code for fault in mg.verify_plan(boast).faults} == {"route-clearance"}


def test_another_clearance_is_another_problem(
    roomy: dict[str, Any], plan: mg.part_supply.ScenarioPlan, write: Write
) -> None:
    for other in (roomy | {"drive_clearance": 0.2}, {k: v for k, v in roomy.items() if k != "drive_clearance"}):
        verdict = mg.verify_plan(plan.to_dict(), scenario=write(other))
        assert "scenario-changed" in {fault.code for fault in verdict.faults}


def test_one_that_is_too_large_is_told_with_one_that_works(roomy: dict[str, Any], write: Write) -> None:
    walls = [
        {"name": f"wall {side}", "box": [0.1, 40.0, 1.0], "pose": {"xyz": [-3.0, 20.6 * side, 0.5]}} for side in (-1, 1)
    ]
    gate = roomy | {"obstacles": [*roomy["obstacles"][:-2], *walls], "drive_clearance": 0.8}
    made = mg.plan_part_supply(write(gate))
    assert made.outcome == mg.Outcome.not_found
    [told] = [o for o in made.obstructions if o.stage == "route"]
    words, advised = told.message.rsplit("drive_clearance: ", 1)
    assert "that keeps drive_clearance: there is one with" in words
    assert 0 < float(advised) < 0.8
    again = mg.plan_part_supply(write(gate | {"drive_clearance": float(advised)}))
    assert again.outcome == mg.Outcome.solved


def test_motions_in_passing_are_refused_beside_it(
    plan: mg.part_supply.ScenarioPlan, small_plan: mg.part_supply.ScenarioPlan
) -> None:
    with pytest.raises(
        mg.InvalidInput, match=r"scenario\.yaml: drive_clearance = .*: motions of a drive-by do not keep it"
    ):
        mg.part_supply.plan_drive_by_picks(plan)
    values = mg.part_supply.plan_drive_by_picks(small_plan).plan_to_dict()
    assert values["drive_by"]["motions"]
    values["scenario"]["drive_clearance"] = 0.001
    assert {fault.code for fault in mg.verify_plan(values).faults} == {"route-clearance"}


@pytest.mark.parametrize("value", [-0.1, 1e-9, 10.5, "wide", None])
def test_bad_ones_are_refused_at_their_line(roomy: dict[str, Any], value: Any, write: Write) -> None:
    with pytest.raises(mg.InvalidInput, match="drive_clearance"):
        load_scenario(write(roomy | {"drive_clearance": value}))
