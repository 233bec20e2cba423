"""A real plan broken in one physical way at a time is refused, with a fault that names it."""

from __future__ import annotations

import copy
from pathlib import Path
from typing import Any

import pytest
import yaml

import mmgrasp as mg
import plan_breaks
from conftest import ASSETS
from mmgrasp.part_supply.consistency import masks
from mmgrasp.part_supply.plan_writer import runs_of


def test_the_plan_itself_holds(small_plan_dict: dict[str, Any]) -> None:
    verdict = mg.verify_plan(small_plan_dict)
    assert verdict.ok, verdict.faults
    assert verdict.configurations_checked > 100
    assert all(rate.good >= 0.999 * rate.samples for rate in verdict.rates)
    assert verdict.minimal_stops == len(small_plan_dict["stops"])


SLOW = {plan_breaks.fingers_press_into_the_part, plan_breaks.region_and_radius_inflated, plan_breaks.uncertainty_grown}


def marked(*row: Any) -> Any:
    """Marks what the check searches long for before it says no."""
    return pytest.param(*row, marks=[pytest.mark.slow] if row[0] in SLOW else [])


@pytest.mark.parametrize("breaking", [marked(each) for each in plan_breaks.BREAKS], ids=lambda f: f.__name__)
def test_broken_plans_are_refused(small_plan_dict: dict[str, Any], breaking: Any) -> None:
    plan = copy.deepcopy(small_plan_dict)
    breaking(plan)
    assert plan != small_plan_dict, "the break changed nothing"
    verdict = mg.verify_plan(plan, samples=200)
    assert not verdict.ok
    assert all(fault.code and fault.message for fault in verdict.faults)


@pytest.mark.parametrize(
    ("breaking", "code"),
    [
        (plan_breaks.approach_cut, "short-approach"),
        (plan_breaks.lift_cut, "no-lift"),
        (plan_breaks.accelerations_zeroed, "acceleration"),
        marked(plan_breaks.fingers_press_into_the_part, "grasp-opening"),
        (plan_breaks.fingers_stand_clear_of_the_part, "grasp-opening"),
        marked(plan_breaks.region_and_radius_inflated, "stop-radius"),
        (plan_breaks.workspace_shrunk, "base-workspace"),
        (plan_breaks.clock_begins_late, "times"),
    ],
    ids=lambda f: getattr(f, "__name__", f),
)
def test_broken_plans_are_refused_for_what_is_broken(small_plan_dict: dict[str, Any], breaking: Any, code: str) -> None:
    plan = copy.deepcopy(small_plan_dict)
    breaking(plan)
    assert code in {fault.code for fault in mg.verify_plan(plan, samples=50).faults}


@pytest.mark.parametrize("zero_padding", [False, True])
@pytest.mark.parametrize(("axis", "sign"), [(0, 1), (0, -1), (1, 1), (1, -1)])
def test_regions_cut_off_on_one_side_are_refused(
    small_plan_dict: dict[str, Any], axis: int, sign: int, zero_padding: bool
) -> None:
    """A search that gave up on one side of a tray proves nothing about the least number of stops."""
    import numpy as np

    plan = copy.deepcopy(small_plan_dict)
    grid, stop = plan["grid"], plan["stops"][0]["pose"]
    middles = [grid["origin"][a] + grid["resolution"] * (np.arange(grid[("nx", "ny")[a]]) + 0.5) for a in (0, 1)]
    kept = sign * (middles[axis] - stop[axis]) <= 0.2
    region = plan["regions"][0]
    for heading, runs in region["cells"].items():
        layer = np.zeros((grid["ny"], grid["nx"]), bool)
        for iy, a, b in runs:
            layer[iy, a:b] = True
        region["cells"][heading] = runs_of((layer & (kept if axis == 0 else kept[:, None])).astype(int))
    if zero_padding:
        plan["scenario"]["padding"] = {"links": 0.0, "by_name": {}}
    codes = {fault.code for fault in mg.verify_plan(plan, samples=1).faults}
    assert "region-incomplete" in codes


def test_regions_that_lack_their_outermost_cells_are_refused(small_plan_dict: dict[str, Any]) -> None:
    import numpy as np

    plan = copy.deepcopy(small_plan_dict)
    for tray, layers in masks(plan).items():
        region = next(one for one in plan["regions"] if one["tray"] == tray)
        inner = layers.copy()
        for axis in (1, 2):
            for step in (-1, 1):
                inner &= np.roll(layers, step, axis)
        assert 0.5 * layers.sum() < inner.sum() < layers.sum()
        region["cells"] = {str(i): runs_of(layer.astype(int)) for i, layer in enumerate(inner)}
    assert "region-incomplete" in {fault.code for fault in mg.verify_plan(plan, samples=1).faults}


def small_regions(plan: dict[str, Any], cells: int) -> None:
    """Leaves so many rows and columns of cells around the first stop of its region."""
    import numpy as np

    grid, stop, region = plan["grid"], plan["stops"][0], plan["regions"][0]
    at = [int((stop["pose"][a] - grid["origin"][a]) / grid["resolution"]) - (cells - 1) // 2 for a in (0, 1)]
    for heading, runs in region["cells"].items():
        layer = np.zeros((grid["ny"], grid["nx"]), int)
        for iy, a, b in runs:
            layer[iy, a:b] = 1
        kept = np.zeros_like(layer)
        kept[at[1] : at[1] + cells, at[0] : at[0] + cells] = 1
        region["cells"][heading] = runs_of(layer & kept)


@pytest.mark.parametrize("cells", [2, 3, 4])
def test_regions_of_few_cells_are_refused_where_there_are_more(small_plan_dict: dict[str, Any], cells: int) -> None:
    plan = copy.deepcopy(small_plan_dict)
    small_regions(plan, cells)
    assert "region-incomplete" in {fault.code for fault in mg.verify_plan(plan, samples=1).faults}


@pytest.mark.slow
def test_single_cells_left_out_to_need_another_stop_are_missed(tmp_path: Path) -> None:
    """Two trays that one stop serves: holes in one region, a cell here and there, leave no disc to stop in."""
    import numpy as np

    scenario = yaml.safe_load((ASSETS / "scenarios" / "storeroom.yaml").read_text())
    scenario["trays"] = scenario["trays"][:2]

    def planned(uncertainty: float) -> dict[str, Any]:
        path = tmp_path / f"{uncertainty}.yaml"
        path.write_text(yaml.safe_dump({**scenario, "positioning_uncertainty": uncertainty}, sort_keys=False))
        return mg.plan_part_supply(path).to_dict()

    assert len(planned(0.1)["stops"]) == 1
    plan = planned(0.3)
    assert len(plan["stops"]) == 2
    first, second = (layers.astype(bool) for layers in masks(plan).values())
    _, rows, columns = np.indices(first.shape)
    holes = first & second & (rows % 3 == 0) & (columns % 3 == 0)
    assert 10 < holes.sum() < 0.1 * second.sum()
    plan["regions"][1]["cells"] = {str(i): runs_of(layer.astype(int)) for i, layer in enumerate(second & ~holes)}
    for place in (plan["scenario"], plan["scenario"]["options"], plan["premises"]):
        place["positioning_uncertainty"] = 0.1
    faults = {fault.code: fault.message for fault in mg.verify_plan(plan, samples=1).faults}
    assert "not-minimal" not in faults, "one stop is not enough for the regions as they stand"
    assert "1 stop is enough: the least number of stops is not 2" in faults["region-incomplete"]


def test_a_heading_whose_cells_are_left_out_is_missed(small: dict[str, Any], tmp_path: Path) -> None:
    turned = {**small, "trays": [{**tray, "headings": [0.0, 0.3]} for tray in small["trays"]]}
    (tmp_path / "scenario.yaml").write_text(yaml.safe_dump(turned, sort_keys=False))
    plan = mg.plan_part_supply(tmp_path / "scenario.yaml").to_dict()
    assert mg.verify_plan(plan, samples=1).ok
    region = plan["regions"][0]
    other = str(1 - plan["grid"]["headings"].index(plan["stops"][0]["pose"][2]))
    assert sum(b - a for _, a, b in region["cells"][other]) > 50
    region["cells"][other] = []
    assert "region-incomplete" in {fault.code for fault in mg.verify_plan(plan, samples=1).faults}


def test_runs_hold_every_cell() -> None:
    import numpy as np

    layer = np.random.default_rng(1).integers(0, 2, (7, 11))
    again = np.zeros_like(layer)
    for iy, a, b in runs_of(layer):
        again[iy, a:b] = 1
    np.testing.assert_array_equal(layer, again)
