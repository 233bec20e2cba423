"""Parts asked for by number ("3 brackets", any of them), several types in a tray."""

from __future__ import annotations

import copy
import itertools
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import mmgrasp as mg
from conftest import ASSETS
from mmgrasp import _core
from mmgrasp.part_supply.chosen_parts import _choice, with_targets
from mmgrasp.scenario import TraySetup


def cell(targets: Any, *, wall: float = 2.05) -> dict[str, Any]:
    """One deep tray of blocks and pins for the omnidirectional robot; its last row is at the edge of the reach."""
    raw: dict[str, Any] = yaml.safe_load((ASSETS / "scenarios" / "omni_cell.yaml").read_text())
    raw["obstacles"] = [{"name": "wall", "box": [0.1, 6.0, 1.2], "pose": {"xyz": [wall, 0.0, 0.6]}}]
    raw["part_types"] = {"block": {"box": [0.05, 0.04, 0.06]}, "pin": {"cylinder": {"radius": 0.015, "length": 0.08}}}
    parts = [{"type": "block", "xyz": [-0.15 + 0.1 * i, y]} for i in range(4) for y in (-0.15, 0.0)]
    parts += [{"type": "pin", "xyz": [-0.15 + 0.1 * i, 0.15]} for i in range(4)]
    raw["trays"] = [
        {
            "name": "deep",
            "pose": {"xyz": [1.70, 0.0, 0.80]},
            "size": [0.5, 0.5, 0.1],
            "parts": parts,
            "targets": targets,
        }
    ]
    return raw


@pytest.fixture(scope="module")
def planned(write: Callable[..., Path]) -> tuple[Path, mg.part_supply.ScenarioPlan]:
    path = write(cell({"block": 3, "pin": 2}), "number.yaml")
    return path, mg.plan_part_supply(path)


def test_so_many_are_picked_and_verified(planned: tuple[Path, mg.part_supply.ScenarioPlan]) -> None:
    path, plan = planned
    assert plan.outcome == mg.Outcome.solved
    picked = [plan.scenario.trays[p.tray].tray.parts[p.part].name for p in plan.picks]
    assert sum("block" in name for name in picked) == 3 and sum("pin" in name for name in picked) == 2
    content = plan.to_dict()
    assert mg.verify_plan(content, scenario=path, samples=100).faults == []
    assert content["premises"]["chosen_parts"] == 5
    assert content["scenario"]["trays"][0]["wanted"]["pin"]["count"] == 2
    assert len(content["scenario"]["trays"][0]["wanted"]["block"]["of"]) == 8
    again = mg.plan_part_supply(path, threads=1)
    assert again.to_dict() == content


def test_no_other_choice_leaves_more_room(planned: tuple[Path, mg.part_supply.ScenarioPlan]) -> None:
    """All choices by brute force over the regions that the planner's own function gives for fixed targets."""
    path, plan = planned
    scenario = mg.load_scenario(path)
    chosen = {part.name for part in plan.scenario.trays[0].tray.parts if part.target}
    cells = {}
    database = scenario.reach_database()
    for part in scenario.trays[0].tray.parts:
        problem = with_targets(scenario, {part.name}).problem()
        grid = _core.make_base_grid(problem, database)
        (region,) = _core.compute_base_regions(problem, database, grid)
        cells[part.name] = set(np.flatnonzero(region.cells(grid)))

    def shared(names: tuple[str, ...]) -> int:
        return len(set.intersection(*(cells[name] for name in names)))

    blocks, pins = ([n for n in cells if kind in n] for kind in ("block", "pin"))
    best = max(
        shared((*some, *others))
        for some, others in itertools.product(itertools.combinations(blocks, 3), itertools.combinations(pins, 2))
    )
    assert shared(tuple(chosen)) == best
    assert best > shared(tuple(cells))  # all of them leave less room


def test_many_parts_are_given_up_one_by_one() -> None:
    """More choices than are compared: never worse than parts drawn at random, and at most a little worse than the best known."""
    rng = np.random.default_rng(4)
    size, count = 400, 40
    names = [f"t/{i:02d}" for i in range(count)]
    good = rng.random(size) < 0.5
    cells = {
        n: np.flatnonzero(good | (rng.random(size) < 0.3)) if i % 3 == 0 else np.flatnonzero(rng.random(size) < 0.4)
        for i, n in enumerate(names)
    }
    cells[names[1]] = np.array([], dtype=np.int64)  # out of reach
    tray = TraySetup(None, [], names, wanted={"x": 10}, kinds=dict.fromkeys(names, "x"))  # type: ignore[arg-type]
    chosen = _choice(cells, size, tray, set())
    assert len(chosen) == len(set(chosen)) == 10 and names[1] not in chosen

    def shared(some: Any) -> int:
        return len(set.intersection(*(set(cells[n].tolist()) for n in some)))

    assert shared(chosen) >= int(good.sum())  # those of the 14 that share `good` do at least this
    assert shared(chosen) >= max(shared(rng.choice(names, 10, replace=False)) for _ in range(200))
    kept = _choice(cells, size, tray, set(chosen[:3]))
    assert not set(chosen[:3]) & set(kept)  # others are there
    few = TraySetup(None, [], names, wanted={"x": 39}, kinds=dict.fromkeys(names, "x"))  # type: ignore[arg-type]
    assert len(set(_choice(cells, size, few, set(names[:5])))) == 39


def test_what_verify_says_of_another_choice(planned: tuple[Path, mg.part_supply.ScenarioPlan]) -> None:
    _, plan = planned
    content = plan.to_dict()

    def codes(change: Callable[[dict[str, Any]], None]) -> list[str]:
        changed = copy.deepcopy(content)
        change(changed["scenario"]["trays"][0]["wanted"])
        return [f.where for f in mg.verify_plan(changed, samples=1).faults if f.code == "wrong-values"]

    assert "scenario.trays[0].wanted.pin" in codes(lambda wanted: wanted["pin"].update(count=3))
    assert "scenario.trays[0].wanted.pin" in codes(lambda wanted: wanted["pin"]["of"].append("deep/none"))
    assert "scenario.trays[0].wanted" in codes(lambda wanted: wanted.pop("pin"))


def test_a_part_that_cannot_be_picked_is_left(write: Callable[..., Path]) -> None:
    """A deck right above the front blocks and one pin: with fixed targets there is no plan, by number there is."""
    raw = cell({"block": 2})
    lid = {"name": "lid", "box": [0.16, 0.4, 0.01], "pose": {"xyz": [1.60, -0.1, 0.90]}}
    raw["obstacles"].append(lid)
    plan = mg.plan_part_supply(write(raw, "lid.yaml"))
    assert plan.outcome == mg.Outcome.solved
    fixed = copy.deepcopy(raw)
    fixed["trays"][0]["targets"] = [0, 1]
    assert mg.plan_part_supply(write(fixed, "fixed.yaml")).outcome != mg.Outcome.solved


@pytest.mark.parametrize(
    ("targets", "told"),
    [
        ({"blok": 1}, "did you mean block"),
        ({"block": 9}, "no more than 8 of type block"),
        ({"block": 0}, ">= 1"),
        ({"block": 1.5}, "whole number"),
        ({}, "must name a type"),
    ],
)
def test_bad_numbers(write: Callable[..., Path], targets: Any, told: str) -> None:
    with pytest.raises(mg.InvalidInput, match=rf"bad.yaml:\d+: trays\[0\].targets.*{told}"):
        mg.load_scenario(write(cell(targets), "bad.yaml"))


def test_scanned_parts_have_no_types(write: Callable[..., Path]) -> None:
    raw = yaml.safe_load((ASSETS / "scenarios" / "scanned_tray.yaml").read_text())
    next(tray for tray in raw["trays"] if "scan" in tray)["targets"] = {"block": 1}
    with pytest.raises(mg.InvalidInput, match="objects of a scan have no types"):
        mg.load_scenario(write(raw))


def test_arriving_at_a_stop_keeps_the_choice(planned: tuple[Path, mg.part_supply.ScenarioPlan], tmp_path: Path) -> None:
    path, plan = planned
    file = plan.save(tmp_path / "plan.json")
    x, y, theta = plan.stops[0].pose
    arrived = mg.part_supply.arrive(file, 0, [x + 0.01, y, theta], scenario=path)
    assert arrived.outcome == mg.Outcome.solved
    assert {p.part for p in arrived.picks} == {p.part for p in plan.picks if p.stop == 0}
