"""What a plan says where parts cannot be picked: what is in the hand's way, and what would help, tried by planning once more."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import mmgrasp as mg
from conftest import edited
from mmgrasp.part_supply.planning import ScenarioPlan
from test_shared_headings import facing


def hand_touches(scenario: dict[str, Any], write: Callable[..., Path]) -> dict[str, int]:
    """Objects that the refused plan names, and at how many grasps."""
    plan = mg.plan_part_supply(write(scenario))
    assert plan.outcome != mg.Outcome.solved
    text = next(o.message for o in plan.obstructions if "the open hand touches" in o.message)
    told = re.search(r"the open hand touches (.*?): give grasps", text)
    assert told is not None, text
    return {name: int(count) for name, count in re.findall(r"'([^']+)' \((\d+)", told[1])}


def test_a_narrow_deep_tray_is_what_the_hand_touches(small: dict[str, Any], write: Callable[..., Path]) -> None:
    """One part of 3 x 5 cm in a shaft of 9 x 9 cm and 30 cm of depth, narrower than the palm: every grasp meets its walls."""
    tray = small["trays"][0]
    shaft = {
        **tray,
        "size": [0.09, 0.09, 0.3],
        "parts": {"type": "bracket", "grid": [1, 1], "spacing": [0.08, 0.08]},
        "targets": [0],
    }
    touched = hand_touches(edited(small, "trays.0", shaft), write)
    assert next(iter(touched)) == f"tray {tray['name']}"
    grasps = next(t for t in mg.scenario.load_scenario(write(small)).problem().trays).parts[0].grasps
    assert touched[f"tray {tray['name']}"] == len(grasps)


@pytest.mark.slow
def test_remedies_are_those_that_work(small: dict[str, Any], write: Callable[..., Path]) -> None:
    """A board 40 cm above the tray's floor lets the hand grasp, not lift."""
    x, y, z = small["trays"][0]["pose"]["xyz"]
    roof = {"name": "roof", "box": [0.6, 0.6, 0.02], "pose": {"xyz": [x, y, z + 0.4]}}
    under = edited(small, "obstacles", [*small["obstacles"], roof])
    plan = mg.plan_part_supply(write(under))
    assert plan.outcome == mg.Outcome.not_found
    first = plan.obstructions[0]
    assert first.stage == "motion"
    assert "move 'roof' away" in first.message and "lower lift_height (0.02 m works)" in first.message
    assert "approach_distance" not in first.message and "the bin" not in first.message
    solved = {change: plans(under, write, change) for change in ("lift_height", "approach_distance")}
    assert solved == {"lift_height": True, "approach_distance": False}


def test_a_tray_s_roof_is_told_from_its_walls(write: Callable[..., Path]) -> None:
    """A block in a tray below a roof of its own, which can be grasped and not lifted: each of both, alone, helps."""
    values = facing(1.8)
    tray = values["trays"][0] | {"targets": [0], "parts": [{"type": "block", "xyz": [0, 0]}]}

    def planned(**body: object) -> ScenarioPlan:
        return mg.plan_part_supply(mg.load_scenario(write(values | {"trays": [tray | {"roof": 0.25} | body]})))

    plan = planned()
    assert plan.outcome == mg.Outcome.not_found
    message = plan.obstructions[0].message
    assert "lower the walls of 'tray east'" in message and "raise the roof of 'tray east'" in message
    assert planned(roof=0.7).outcome == mg.Outcome.solved
    assert planned(walls=dict.fromkeys(("front", "back", "left", "right"), 0)).outcome == mg.Outcome.solved


def test_what_the_hand_touches_is_named_where_a_move_helps_too(write: Callable[..., Path]) -> None:
    """One grasp from above, and a bar hangs where the palm must be; tray and table could be moved from under it."""
    values = facing(1.8)
    x, y, z = values["trays"][0]["pose"]["xyz"]
    down = {"pose": {"xyz": [0, 0, 0], "quat_xyzw": [0, 0.70710678, 0, 0.70710678]}, "opening": 0.04}
    values["part_types"]["block"]["grasps"] = [down]
    tray = values["trays"][0] | {"size": [0.2, 0.2, 0.08], "targets": [0], "parts": [{"type": "block", "xyz": [0, 0]}]}
    table = {"name": "table", "box": [0.5, 0.5, 0.02], "pose": {"xyz": [x, y, z - 0.011]}}
    bar = {"name": "bar", "box": [0.02, 0.3, 0.02], "pose": {"xyz": [x, y, z + 0.194]}}
    plan = mg.plan_part_supply(mg.load_scenario(write(values | {"trays": [tray], "obstacles": [table, bar]})))
    assert plan.outcome != mg.Outcome.solved
    first = plan.obstructions[0]
    assert "the open hand touches 'bar' (1 of 1 grasps): move the tray" in first.message
    assert "'tray east'" not in first.message  # it is moved with its body
    freed = mg.plan_part_supply(mg.load_scenario(write(values | {"trays": [tray], "obstacles": [table]})))
    assert freed.outcome == mg.Outcome.solved


def plans(scenario: dict[str, Any], write: Callable[..., Path], short: str) -> bool:
    """Whether all is picked with a straight move of 2 cm."""
    options = {**scenario.get("options", {}), short: 0.02}
    return mg.plan_part_supply(write(edited(scenario, "options", options))).outcome == mg.Outcome.solved


def test_a_tray_too_high_is_lowered(small: dict[str, Any], write: Callable[..., Path]) -> None:
    """As far as is said, to a centimetre: then some grasp's height is reached, whatever else is in the way."""
    x, y, _ = small["trays"][0]["pose"]["xyz"]

    def words(z: float) -> str:
        plan = mg.plan_part_supply(write(edited(small, "trays.0.pose", small["trays"][0]["pose"] | {"xyz": [x, y, z]})))
        assert plan.outcome != mg.Outcome.solved
        return plan.obstructions[0].message

    said = re.search(
        r"lie ([\d.]+) m above all that was found in the arm's reach, wherever the base stands: lower the tray",
        words(2.8),
    )
    assert said
    assert "above all that was found" in words(2.83 - float(said[1]))
    assert "above all that was found" not in words(2.79 - float(said[1]))
