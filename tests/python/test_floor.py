"""The ground: in a world, in scenarios, in plans and in `verify`."""

from __future__ import annotations

import copy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp.scenario import load_scenario

Write = Callable[..., Path]


@pytest.fixture(scope="module")
def low(small: dict[str, Any]) -> dict[str, Any]:
    """The tray stands on the ground: its own floor is 5 mm thick."""
    values = copy.deepcopy(small)
    values["obstacles"] = []
    values["trays"][0]["pose"]["xyz"][2] = 0.005
    return values


def at(values: dict[str, Any], height: float, **changes: Any) -> dict[str, Any]:
    changed = copy.deepcopy(values) | changes
    changed["trays"][0]["pose"]["xyz"][2] = height
    return changed


@pytest.fixture(scope="module")
def low_plan(low: dict[str, Any], write: Write) -> dict[str, Any]:
    plan = mg.plan_part_supply(write(low))
    assert plan.outcome == mg.Outcome.solved, plan
    return plan.to_dict()


def test_a_tray_stands_on_the_ground(low: dict[str, Any], low_plan: dict[str, Any], write: Write) -> None:
    """Solved and verified; the tool gets near the ground, and not under it."""
    assert low_plan["scenario"]["floor"] == 0
    verdict = mg.verify_plan(low_plan)
    assert verdict.ok, verdict.faults
    setup = load_scenario(write(low)).setup
    heights = [setup.arm.fk(np.array(q))[2, 3] for p in low_plan["picks"] for m in p["motions"] for q in m["positions"]]
    assert 0 < min(heights) < 0.1


@pytest.mark.slow
def test_a_pit_is_for_who_says_that_there_is_no_floor(low: dict[str, Any], write: Write) -> None:
    """What an audit found: a tray 8 cm under the ground was planned and verified, fingers under the ground."""
    pit = at(low, -0.075)
    with pytest.raises(mg.InvalidInput, match=r"trays\[0\].*tray A reaches under the floor, z = 0 m"):
        load_scenario(write(pit))
    with pytest.raises(mg.InvalidInput, match=r"under the floor, z = 0\.01 m"):
        load_scenario(write(at(low, 0.01, floor=0.01)))
    assert load_scenario(write(at(low, -0.075, floor=-0.08))).floor == -0.08
    plan = mg.plan_part_supply(write(pit | {"floor": "none"}))
    assert plan.outcome == mg.Outcome.solved, plan
    content = plan.to_dict()
    assert content["scenario"]["floor"] is None
    assert mg.verify_plan(content).ok
    content["scenario"]["floor"] = 0.0
    codes = {fault.code for fault in mg.verify_plan(content, samples=10, region_samples=1).faults}
    assert {"tray-overlap", "part-overlap"} <= codes


@pytest.mark.parametrize(("height", "code"), [(0.01, "attached-collision"), (0.03, "scene-collision")])
def test_motions_through_the_ground_are_found(low_plan: dict[str, Any], height: float, code: str) -> None:
    """A floor raised under a finished plan is met by the part that is lifted, then by the fingers, never by the base."""
    plan = copy.deepcopy(low_plan)
    plan["scenario"]["floor"] = height
    faults = [f for f in mg.verify_plan(plan).faults if "'floor'" in f.message and f.where.startswith("pick")]
    assert code in {f.code for f in faults}
    assert any("gripper_finger_link" in f.message for f in faults) == (code == "scene-collision")
    assert not any(link in f.message for f in faults for link in ("base_link", "wheel"))


def test_the_files_say_what_they_mean(small: dict[str, Any], write: Write) -> None:
    assert load_scenario(write(small)).floor == 0
    named = copy.deepcopy(small)
    named["obstacles"].append({"name": "floor", "box": [9, 9, 0.1], "pose": {"xyz": [0, 0, -0.06]}})
    with pytest.raises(mg.InvalidInput, match=r"the name 'floor' is that of the ground.*floor: none"):
        load_scenario(write(named))
    assert load_scenario(write(named | {"floor": "none"})).floor is None
    for value in ("yes", [0], {"height": 0}, "0.1 m"):
        with pytest.raises(mg.InvalidInput, match=r":\d+: floor"):
            load_scenario(write(small | {"floor": value}))
    may_touch = load_scenario(write(small | {"allowed_collisions": [["gripper_link", "floor"]]}))
    assert ("floor", "gripper_link") in may_touch.world.allowed


def test_verify_compares_the_floor_with_the_file(
    small: dict[str, Any], small_plan_dict: dict[str, Any], write: Write
) -> None:
    verdict = mg.verify_plan(small_plan_dict, scenario=write(small | {"floor": -0.1}))
    assert [(f.code, f.where) for f in verdict.faults] == [("scenario-changed", "scenario.floor")]


def test_a_world_of_ones_own_has_a_floor_on_request(small_path: Path) -> None:
    setup = load_scenario(small_path).setup
    world = mg.World()
    world.add_floor(setup.arm, height=0.3)
    wheels = {a if b == "floor" else b for a, b in world.allowed}
    assert wheels.isdisjoint(setup.gripper.finger_links)
    assert {setup.robot.links[0]} <= wheels
    checker = mg.CollisionChecker(setup.robot, world, group=setup.arm)
    assert checker.is_free(setup.home)
    with pytest.raises(mg.InvalidInput, match="floor: is in use"):
        world.add_floor(setup.arm)
