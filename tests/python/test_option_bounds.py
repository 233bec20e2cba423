"""Every number that a scenario or a pipe problem may set has both bounds: they are taken, and what is next to them is refused."""

from __future__ import annotations

import copy
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

import mmgrasp as mg
from argument_objects import BOX, gripper, object_path_problem, pipe, wall_map
from mmgrasp import _core

Door = Callable[..., Any]

TABLES: dict[str, tuple[dict[str, Any], dict[str, tuple[float, float]], Door]] = {
    "options": (
        _core._supply_option_table(),
        _core._supply_option_bounds(),
        lambda **option: _core._check_options("options", **option),
    ),
    "reach": (
        _core._reach_option_table(),
        _core._reach_option_bounds(),
        lambda **option: _core._check_options("reach", **option),
    ),
    "grasp_options": (
        _core._grasp_option_table(),
        _core._grasp_option_bounds(),
        lambda **option: _core._sample_grasps([BOX], gripper(), **option),
    ),
    "scan.grasps": (
        _core._synthesis_option_table(),
        _core._synthesis_option_bounds(),
        lambda **option: mg.synthesize_grasps(wall_map(), gripper(), **option),
    ),
    "pipe.options": (
        _core._object_path_option_table(),
        _core._object_path_option_bounds(),
        lambda **option: mg.grasping.optimize_grasp(object_path_problem(), pipe(), **option),
    ),
}
BESIDE = {
    "mesh_samples": {"approaches": 1},
    "positions": {"approaches": 1},
    "grid_max_distance": {"grid_resolution": 10},
}
"""What must be lower for another one to be as large as it may be."""
LEAST = {("reach", "samples"): 10_000}
MOST = {"seed": 2**31 - 1}
"""Bounds of a scenario that are narrower than those of the call."""
TAKEN = {("grasp_options", "standoff"): (-0.01, 0.01)}
"""What a scenario takes, where a part is left without a grasp by what is nearer to the bounds."""


def numbers(section: str) -> dict[str, bool]:
    """Name of each number, and whether it is a whole one."""
    table = TABLES[section][0]
    return {
        name: isinstance(value, int)
        for name, (value, _) in table.items()
        if isinstance(value, int | float) and not isinstance(value, bool)
    }


def next_to(bound: float, way: int, is_whole: bool) -> float:
    return int(bound) + way if is_whole else math.nextafter(bound, way * math.inf)


EVERY = [(section, name) for section in TABLES for name in numbers(section)]
IN_SCENARIO = [one for one in EVERY if one[0] in ("options", "reach", "grasp_options") and one[1] != "positioning_uncertainty"]  # fmt: skip


def test_every_number_has_both_bounds() -> None:
    for section, (table, bounds, _) in TABLES.items():
        assert numbers(section).keys() <= bounds.keys(), section
        for name in numbers(section):
            least, most = bounds[name]
            assert least <= table[name][0] <= most, (section, name)
            assert math.isfinite(least) and math.isfinite(most), (section, name)


@pytest.mark.parametrize(("section", "name"), EVERY)
def test_what_is_beyond_is_refused(section: str, name: str) -> None:
    _, bounds, door = TABLES[section]
    for bound, way in zip(bounds[name], (-1, 1), strict=True):
        with pytest.raises(mg.InvalidInput, match=name.replace("grid_", "grid.")):
            door(**{name: next_to(bound, way, numbers(section)[name])})


@pytest.mark.parametrize(("section", "name"), IN_SCENARIO)
def test_a_scenario_is_refused_at_the_line(section: str, name: str, small: dict[str, Any], tmp_path: Path) -> None:
    is_whole = numbers(section)[name]
    least, most = TABLES[section][1][name]
    least, most = LEAST.get((section, name), least), MOST.get(name, most)
    small = copy.deepcopy(small)
    owner = small["part_types"]["bracket"] if section == "grasp_options" else small
    file = tmp_path / "scenario.yaml"

    def load(value: float) -> None:
        owner[section] = {name: int(value) if is_whole else float(value), **BESIDE.get(name, {})}
        file.write_text(yaml.safe_dump(small, sort_keys=False))
        mg.load_scenario(file)

    for taken in TAKEN.get((section, name), (least, most)):
        load(taken)
    for bound, way in ((least, -1), (most, 1)):
        with pytest.raises(mg.InvalidInput, match=rf"scenario\.yaml:\d+: .*{name}"):
            load(next_to(bound, way, is_whole))
