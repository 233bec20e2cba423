"""plan.json as C++ writes it: the same as Python's for the same problem, and what programs without a scenario get."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from conftest import ASSETS
from mmgrasp.base import PartSupplyProblem, write_plan
from mmgrasp.part_supply import read_plan
from mmgrasp.part_supply.verification import differences
from mmgrasp.scenario import Scenario


def as_written(scenario: Scenario, plan: Any, folder: Path) -> dict[str, Any]:
    """The plan through C++, by the objects that the scenario makes."""
    problem = scenario.problem()
    file = folder / "plan.json"
    speed = scenario.setup.closing_speed
    write_plan(
        *(problem, scenario.reach_database(), plan, file),
        name=scenario.name,
        source=scenario.source,
        closing_speed=speed,
    )
    return read_plan(file)  # holds it against the schema


def comparable(plan: dict[str, Any]) -> dict[str, Any]:
    """Without what only the order of obstacles, the description of walls and joints that stand at 0 change."""
    plan = json.loads(json.dumps(plan))
    scenario = plan["scenario"]
    scenario["obstacles"].sort(key=lambda o: o["name"])
    for tray in scenario["trays"]:
        for key in ("own_body", "wall", "walls", "roof"):
            tray.pop(key, None)
    scenario["other_joints"] = {name: value for name, value in scenario["other_joints"].items() if value}
    scenario["allowed_collisions"] = sorted(sorted(pair) for pair in scenario.get("allowed_collisions", []))
    padding = {"links": 0, "attached": 0, "objects": 0, "by_name": {}} | scenario.get("padding", {})
    return plan | {"scenario": scenario | {"padding": padding}}


def same(mine: Any, its: Any) -> list[Any]:
    return differences(mine, its)


def test_the_small_round_is_the_same(small_plan: mg.part_supply.ScenarioPlan, tmp_path: Path) -> None:
    mine = as_written(small_plan.scenario, small_plan.plan, tmp_path)
    assert same(comparable(small_plan.to_dict()), comparable(mine)) == []
    assert mg.verify_plan(mine, samples=100).faults == []
    assert mg.verify_plan(tmp_path / "plan.json", samples=100).ok


def test_meshes_arrivals_padding_and_allowed_pairs(tmp_path: Path) -> None:
    """Another robot, and everything that a plan may leave out."""
    raw = (ASSETS / "scenarios" / "omni_cell.yaml").read_text()
    raw += "arrival_covariance: [[1e-4, 0, 0], [0, 1e-4, 0], [0, 0, 1e-4]]\nallowed_collisions: [[forearm_link, wall east]]\n"
    raw += "padding: {objects: 0.001, by_name: {wall west: 0.002}}\n"
    file = tmp_path / "cell.yaml"
    file.write_text(raw)
    plan = mg.plan_part_supply(file)
    mine = as_written(plan.scenario, plan.plan, tmp_path)
    assert mine["scenario"]["padding"]["by_name"] == {"wall west": 0.002}
    assert same(comparable(plan.to_dict()), comparable(mine)) == []


def test_a_failed_plan_says_why(small: dict[str, Any], write: Any, tmp_path: Path) -> None:
    plan = mg.plan_part_supply(write(small | {"positioning_uncertainty": 1.0}, "far.yaml"))
    assert plan.outcome != mg.Outcome.solved
    mine = as_written(plan.scenario, plan.plan, tmp_path)
    assert mine["obstructions"] == plan.to_dict()["obstructions"] != []
    assert same(comparable(plan.to_dict()), comparable(mine)) == []


def test_what_a_plan_cannot_hold(small_plan: mg.part_supply.ScenarioPlan, tmp_path: Path) -> None:
    scenario, plan = small_plan.scenario, small_plan.plan
    problem, database = scenario.problem(), scenario.reach_database()
    bad: list[tuple[str, Any]] = [("name", ""), ("source", ""), ("closing_speed", 0.0), ("closing_speed", 11.0)]
    for name, value in bad:
        with pytest.raises(mg.InvalidInput, match=name):
            write_plan(problem, database, plan, tmp_path / "p.json", **{name: value})
    world = scenario.world
    world.add_points("cloud", np.array([[9.0, 9.0, 1.0]]), resolution=0.01)
    other = PartSupplyProblem(
        *(problem.robot, problem.arm, problem.gripper, world, problem.trays, problem.home),
        problem.start,
        problem.goal,
        problem.place_region,
    )
    with pytest.raises(mg.InvalidInput, match=r"obstacle cloud.*voxels"):
        write_plan(other, database, plan, tmp_path / "p.json")
    with pytest.raises(mg.IoError):
        write_plan(problem, database, plan, tmp_path)
    assert not (tmp_path / "p.json").exists()
