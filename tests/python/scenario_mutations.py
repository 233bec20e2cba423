"""Every field of a scenario changed in every way beside a plan that was made for it: what `verify --scenario` does not tell.

(`mutation_shares.py` tries all of them.)
"""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import yaml

import mmgrasp as mg
from field_changes import Harmless
from mmgrasp import _core
from mmgrasp._files import ASSETS
from mmgrasp.part_supply.plan_writer import scenario_to_dict
from mmgrasp.part_supply.verification import differences

HARMLESS: Harmless = {
    "name": ("any", "a title"),
    "part_types": ("key added", "a type that no tray holds"),
    "trays[].targets": ("reordered", "the order of targets is the planner's to choose"),
    "arrival_covariance[][]": ("type", "the text 1e-05 is written without quotes, and so it is the number"),
    "trays[].targets[]": ("swapped", "the order of targets is the planner's to choose"),
    "options.seed": ("any", "another seed is another search, and any answer is checked"),
    "options.threads": ("any", "plans do not depend on it"),
    "reach.threads": ("any", "databases do not depend on it"),
    "allowed_collisions[]": ("reordered", "a pair has no order"),
    "allowed_collisions[][]": ("swapped", "a pair has no order"),
}
"""Changes that no plan needs to be told from, and why."""

# Unlike the defaults, so that leaving one out is a change, too.
BASE_LIMITS = {
    "linear_velocity": 0.5,
    "angular_velocity": 0.9,
    "linear_acceleration": 0.4,
    "angular_acceleration": 0.8,
    "workspace": 50.0,
    "wheel_velocity": 0.8,
    "wheel_separation": 0.4,
}
OPTIONS = {
    "grid_resolution": 0.06,
    "grid_max_distance": 1.5,
    "ik_seeds": 9,
    "approach_distance": 0.09,
    "lift_height": 0.13,
    "motion_time_limit": 6.0,
    "route_resolution": 0.12,
    "robustness_samples": 1000,
    "seed": 3,
    "threads": 2,
}
REACH = {
    "samples": 500_000,
    "position_cell": 0.11,
    "rotation_cell": 0.5,
    "max_per_cell": 15,
    "min_manipulability": 0.03,
    "thinning": 0.1,
    "seed": 2,
    "threads": 2,
}


def full_scenario(small: dict[str, Any]) -> dict[str, Any]:
    """A scenario with what else may stand in one: all options, extra links, lists of parts and grasps."""
    scenario = copy.deepcopy(small)
    scenario["robot"]["frames"] = [
        {
            "name": "lamp",
            "parent": "base_link",
            "pose": {"xyz": [0.0, 0.1, 0.3], "rpy": [0.1, 0.0, 0.0]},
            "sphere": 0.02,
        }
    ]
    scenario["robot"]["base_limits"] = BASE_LIMITS
    scenario["gripper"].update(closing_speed=0.12, clearance=0.012)
    scenario["place_region"]["drop_height"] = 0.04
    scenario["floor"] = -0.01
    scenario["arrival_covariance"] = [[4e-4, 1e-5, 0.0], [1e-5, 4e-4, 0.0], [0.0, 0.0, 3e-4]]
    scenario["drive_clearance"] = 0.03
    scenario["allowed_collisions"] = [["lamp", "pillar"]]
    scenario["padding"] = {"links": 0.001, "objects": 0.002, "by_name": {"pillar": 0.003}}
    assert OPTIONS.keys() | {"positioning_uncertainty"} == _core._supply_option_table().keys()
    assert REACH.keys() == _core._reach_option_table().keys()
    scenario["options"], scenario["reach"] = OPTIONS, REACH
    grasp = {"pose": {"xyz": [0.0, 0.0, 0.0], "rpy": [0.0, 1.6, 0.0]}, "opening": 0.06, "quality": 0.7}
    scenario["part_types"] = {
        "bracket": {**scenario["part_types"]["bracket"], "grasp_options": {"approaches": 6, "positions": 2}},
        "rail": {"shapes": [{"box": [0.025, 0.06, 0.08], "pose": {"xyz": [0.0, 0.0, 0.01]}}], "grasps": [grasp]},
    }
    second = copy.deepcopy(scenario["trays"][0])
    second.update(name="list", headings=[0.0, 0.5], targets=["one"])
    second["pose"]["xyz"][1] += 0.6
    second["parts"] = [{"type": "rail", "name": "one", "xyz": [0.02, 0.03], "rpy": [0.0, 0.0, 0.2]},
                       {"type": "rail", "name": "two", "xyz": [-0.06, 0.03, 0.05]}]  # fmt: skip
    scenario["trays"][0]["parts"]["yaw"] = 0.1
    scenario["trays"].append(second)
    return scenario


def tells(scenario: dict[str, Any], folder: Path) -> Callable[[dict[str, Any]], bool]:
    """Whether a plan made for `scenario` is told from one for another scenario, as `verify --scenario` does, or that one is refused."""
    path = folder / "scenario.yaml"

    def content(values: dict[str, Any]) -> Any:
        path.write_text(yaml.safe_dump(values, sort_keys=False))
        return scenario_to_dict(mg.load_scenario(path))

    planned = json.loads(json.dumps(content(scenario)))

    def told(values: dict[str, Any]) -> bool:
        try:
            return bool(differences(planned, content(values)))
        except mg.Error as error:
            assert str(error), "an error without a word"
            return True

    return told


def whole_scenario() -> dict[str, Any]:
    """The shipped storeroom's first tray with everything else that may stand in a scenario."""
    scenario = yaml.safe_load((ASSETS / "scenarios" / "storeroom.yaml").read_text())
    del scenario["trays"][1:]
    return full_scenario(scenario)
