"""Scenarios and plans changed at random are read or refused with a message. (`file_fuzz.py` by itself tries as many as one likes.)"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
import yaml

from file_fuzz import fuzz, read_plan_whole, read_scenario

SIZES = [100, pytest.param(400, marks=pytest.mark.slow)]


@pytest.mark.parametrize("tries", SIZES)
def test_scenarios(small: dict[str, Any], tmp_path: Path, tries: int) -> None:
    taken, refused = fuzz(yaml.safe_dump(small, sort_keys=False), read_scenario, tmp_path, tries, seed=tries)
    assert taken > 0
    assert refused > tries // 5


@pytest.mark.parametrize("tries", SIZES)
def test_plans(small_plan_dict: dict[str, Any], tmp_path: Path, tries: int) -> None:
    plan = json.loads(json.dumps(small_plan_dict))
    for pick in plan["picks"]:  # most of the text would be numbers of motions
        for motion in pick["motions"]:
            for key in ("times", "positions", "velocities", "accelerations"):
                motion[key] = motion[key][:2]
    taken, refused = fuzz(json.dumps(plan, indent=1), read_plan_whole, tmp_path, tries, seed=tries)
    assert taken > 0
    assert refused > tries // 5
