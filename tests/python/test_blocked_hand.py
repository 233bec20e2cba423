"""What the plan says where the open hand finds no room around a part: what is in its way, counted by hand from the scene."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import mmgrasp as mg
from conftest import edited


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
