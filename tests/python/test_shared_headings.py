"""Trays that face each other get stops in common, and the plan says for which headings its proof holds."""

from __future__ import annotations

import copy
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

import mmgrasp as mg
from mmgrasp.part_supply.premises import premises_text

ASSETS = Path(mg.__file__).parent / "assets"


def facing(apart: float) -> dict[str, Any]:
    """The shipped cell's robot between two boxes of blocks that open towards each other."""
    values: dict[str, Any] = yaml.safe_load((ASSETS / "scenarios" / "omni_cell.yaml").read_text())
    east, west = copy.deepcopy(values["trays"][0]), copy.deepcopy(values["trays"][0])
    east |= {"name": "east", "pose": {"xyz": [apart / 2, 0.0, 0.756]}}
    west |= {"name": "west", "pose": {"xyz": [-apart / 2, 0.0, 0.756], "rpy": [0, 0, math.pi]}}
    return values | {"trays": [east, west], "obstacles": [], "start": [0, -2.5, 0], "goal": [0, 2.5, 0]}


@pytest.mark.slow
@pytest.mark.parametrize("apart", [1.7, 2.1])
def test_trays_that_face_each_other_share_a_stop(apart: float, write: Callable[..., Path], tmp_path: Path) -> None:
    values = facing(apart)
    file = write(values)
    plan = mg.plan_part_supply(mg.load_scenario(file))
    assert [sorted(stop.trays) for stop in plan.stops] == [[0, 1]]
    assert plan.premises["shared_headings"]
    assert "at its own, and at another's where that one is served, too" in premises_text(plan.premises)
    path = plan.save(tmp_path / "plan.json")
    verdict = mg.verify_plan(path, scenario=file)
    assert verdict.ok, verdict.faults
    written = json.loads(path.read_text())
    for tray in written["scenario"]["trays"]:
        tray["shares_headings"] = False
    written["premises"]["shared_headings"] = False
    path.write_text(json.dumps(written))
    faults = mg.verify_plan(path).faults
    assert any("which its tray does not list" in fault.message for fault in faults), faults
    for tray in values["trays"]:
        tray["headings"] = [0.0] if tray["name"] == "east" else [math.pi]
    listed = mg.plan_part_supply(mg.load_scenario(write(values)))
    assert len(listed.stops) == 2 and not listed.premises["shared_headings"]


@pytest.mark.slow
@pytest.mark.parametrize("other", [math.pi, 3.1416, -3.1419, 3 * math.pi, 3.1436])
def test_headings_that_differ_by_rounding_are_one(other: float, write: Callable[..., Path], tmp_path: Path) -> None:
    """Two trays side by side that list the same heading; 2 mrad apart they are two."""
    values = facing(1.8)
    west = values["trays"][1] | {"size": [0.2, 0.2, 0.08], "targets": [0], "parts": [{"type": "block", "xyz": [0, 0]}]}
    first, second = copy.deepcopy(west), copy.deepcopy(west)
    first |= {"name": "first", "headings": [3.14159]}
    second |= {"name": "second", "headings": [other]}
    second["pose"]["xyz"][1] += 0.3
    file = write(values | {"trays": [first, second]})
    plan = mg.plan_part_supply(mg.load_scenario(file))
    assert len(plan.stops) == (2 if other == 3.1436 else 1)
    verdict = mg.verify_plan(plan.save(tmp_path / "plan.json"), scenario=file)
    assert verdict.ok, verdict.faults
