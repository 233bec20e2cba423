"""A bin that takes few parts: trips to the goal, where it is emptied, in plan, check, motion and report."""

from __future__ import annotations

import copy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp.base import write_plan
from mmgrasp.cli.commands import report_page
from mmgrasp.part_supply import read_plan
from mmgrasp.viz.timeline import Timeline

Write = Callable[..., Path]


def with_capacity(small: dict[str, Any], capacity: Any, targets: int) -> dict[str, Any]:
    raw = copy.deepcopy(small)
    raw["place_region"]["capacity"] = capacity
    raw["trays"][0]["targets"] = list(range(targets))
    return raw


@pytest.fixture(scope="module")
def planned(small: dict[str, Any], write: Write) -> tuple[Path, mg.part_supply.ScenarioPlan]:
    """Three parts of one tray, two of which fill the bin."""
    path = write(with_capacity(small, 2, 3), "trips.yaml")
    plan = mg.plan_part_supply(path)
    assert plan.outcome == mg.Outcome.solved, plan.obstructions
    return path, plan


def test_the_least_number_of_trips(planned: tuple[Path, mg.part_supply.ScenarioPlan]) -> None:
    path, plan = planned
    (unloading,) = plan.plan.unloadings
    assert unloading.after_pick == 1 and len(plan.picks) == 3
    goal, stop = plan.scenario.goal, plan.stops[0].pose
    np.testing.assert_allclose([unloading.to_goal.poses[0], unloading.to_goal.poses[-1]], [stop, goal], atol=1e-6)
    assert unloading.back is not None  # the third part waits at the same stop
    np.testing.assert_allclose([unloading.back.poses[0], unloading.back.poses[-1]], [goal, stop], atol=1e-6)
    content = plan.to_dict()
    assert mg.verify_plan(content, scenario=path, samples=100).faults == []
    assert mg.plan_part_supply(path, threads=1).to_dict() == content


def test_no_way_back_where_nothing_is_left(storeroom: dict[str, Any], write: Write) -> None:
    """Two trays far apart, one part each: the bin is emptied between them, and the second drive begins at the goal."""
    raw = copy.deepcopy(storeroom)
    raw["reach"] = {"samples": 500_000}
    raw["place_region"]["capacity"] = 1
    for tray in raw["trays"]:
        tray["targets"] = [0]
    path = write(raw, "stops.yaml")
    plan = mg.plan_part_supply(path)
    assert plan.outcome == mg.Outcome.solved and len(plan.stops) > 1
    assert len(plan.plan.unloadings) == len(plan.picks) - 1
    for unloading in plan.plan.unloadings:
        stop = plan.picks[unloading.after_pick].stop
        follows = plan.picks[unloading.after_pick + 1].stop
        assert (unloading.back is None) == (follows != stop)
        if unloading.back is None:
            np.testing.assert_allclose(plan.route[stop + 1].poses[0], plan.scenario.goal, atol=1e-6)
    content = plan.to_dict()
    assert mg.verify_plan(content, scenario=path, samples=50).faults == []
    for leg in range(1, len(plan.route)):
        if np.allclose(content["route"][leg]["poses"][0], plan.scenario.goal, atol=1e-6):
            broken = copy.deepcopy(content)
            broken["unloadings"].pop(next(i for i, u in enumerate(content["unloadings"]) if "back" not in u))
            assert {"route-ends", "capacity"} <= {f.code for f in mg.verify_plan(broken, samples=20).faults}
            break
    else:
        pytest.fail("no drive begins at the goal")


@pytest.mark.parametrize(
    ("change", "codes"),
    [
        (lambda p: p.pop("unloadings"), {"capacity"}),
        (lambda p: p["scenario"]["place_region"].update(capacity=1), {"capacity"}),
        (lambda p: p["unloadings"][0].update(after_pick=2), {"unloading"}),
        (lambda p: p["unloadings"][0].update(after_pick=0), set()),
        (lambda p: p["unloadings"].append(copy.deepcopy(p["unloadings"][0])), {"unloading"}),
        (lambda p: p["unloadings"][0].pop("back"), {"route-ends"}),
        (lambda p: p["unloadings"][0]["to_goal"]["poses"].pop(), {"route-ends"}),
        (lambda p: p["unloadings"][0]["back"]["poses"].pop(0), {"route-ends"}),
        (lambda p: p["unloadings"][0]["back"].update(duration=1.0), {"route-values"}),
        (lambda p: p["unloadings"][0]["to_goal"]["poses"].insert(1, [40.0, 0.0, 0.0]), {"route-not-driveable"}),
    ],
)
def test_broken_trips_are_seen(
    planned: tuple[Path, mg.part_supply.ScenarioPlan], change: Callable[[dict[str, Any]], Any], codes: set[str]
) -> None:
    content = planned[1].to_dict()
    change(content)
    found = {fault.code for fault in mg.verify_plan(content, samples=20).faults}
    assert codes <= found
    assert codes or not found  # emptied earlier than needed, the bin still takes all


def test_trips_are_seen_in_time_and_report(planned: tuple[Path, mg.part_supply.ScenarioPlan], tmp_path: Path) -> None:
    plan = planned[1]
    content = plan.to_dict()
    timeline = Timeline(content)
    labels = [segment.label for segment in timeline.segments if segment.kind == "drive"]
    assert labels == ["drive to stop 1", "drive to the goal to unload", "drive to stop 1 again", "drive to the goal"]
    for before, after in zip(timeline.segments, timeline.segments[1:], strict=False):
        end = timeline.state_at(before.start + before.duration - 1e-9).base
        np.testing.assert_allclose(end, timeline.state_at(after.start + 1e-9).base, atol=1e-3)
    lines = plan.motion().to_csv().splitlines()
    assert lines[0].startswith("time,base.x,base.y,")
    base = np.array([[float(word) for word in line.split(",")[1:3]] for line in lines[1:]])
    assert np.abs(np.diff(base, axis=0)).max() < 0.3  # joined to one motion
    page = report_page(content, tmp_path, [])
    assert "trips, of 2 and 1 parts; the bin takes 2" in page
    names = {path.name for path in plan.save_trajectories(tmp_path / "csv")}
    assert {"drive_unloading_01_to_goal.csv", "drive_unloading_01_back.csv"} <= names


def test_written_from_objects_it_is_the_same(planned: tuple[Path, mg.part_supply.ScenarioPlan], tmp_path: Path) -> None:
    scenario, plan = planned[1].scenario, planned[1].plan
    write_plan(scenario.problem(), scenario.reach_database(), plan, tmp_path / "plan.json", name="a", source="b")
    mine, own = read_plan(tmp_path / "plan.json"), planned[1].to_dict()
    assert mine["unloadings"] == own["unloadings"]
    assert mine["scenario"]["place_region"]["capacity"] == 2


def test_a_bin_large_enough_needs_no_trip(small: dict[str, Any], write: Write) -> None:
    plan = mg.plan_part_supply(write(with_capacity(small, 2, 2)))
    assert plan.outcome == mg.Outcome.solved and plan.plan.unloadings == []
    assert "unloadings" not in plan.to_dict()


@pytest.mark.parametrize(
    ("capacity", "words"), [(0, "capacity = 0: must be >= 1"), (1.5, "capacity"), (10**7, "capacity")]
)
def test_odd_capacities_are_refused(small: dict[str, Any], write: Write, capacity: Any, words: str) -> None:
    with pytest.raises(mg.InvalidInput, match=words):
        mg.load_scenario(write(with_capacity(small, capacity, 2)))


def test_no_parts_in_passing(planned: tuple[Path, mg.part_supply.ScenarioPlan]) -> None:
    with pytest.raises(mg.InvalidInput, match="capacity"):
        mg.part_supply.plan_drive_by_picks(planned[1])
