"""What `plan` calls solved its own `verify` never refuses. (`odd_scenarios.py` by itself tries as many as one likes.)"""

from __future__ import annotations

import time
import types
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import mmgrasp as mg
from odd_scenarios import Watch, odd_full_scenario, odd_scenario, one, try_out

# The first 561 were tried. These were called solved and refused by their own check:
BROKE = {
    33: "solved",  # a bushing of 38 cm goes straight up: sampled accelerations were those of no interval
    58: "refused",  # fingers whose strokes differ
    66: "solved",  # accelerations that swing away and back between two samples
    133: "solved",  # the check's search missed grasps that are there
    176: "refused",  # parts inside a wall
    277: "refused",  # a finger that does not close
    306: "solved",  # a heading listed twice, on both sides of half a turn
    388: "solved",  # as 133, in a region
    477: "not_found",  # blocks that touch the tray's walls: no motion lifts them without touching
    543: "solved",  # a turn of half a micro-radian on the way, taken for standing still
}
SEEDS = [1, 2, 3, 4, 5, 6, *BROKE]


def test_a_solved_plan_holds(tmp_path: Path) -> None:
    assert try_out(odd_scenario(66), tmp_path) == ("solved", [])


@pytest.mark.slow
def test_solved_plans_hold(tmp_path: Path) -> None:
    outcomes = {}
    for seed in SEEDS:
        outcome, faults = try_out(odd_scenario(seed), tmp_path)
        assert not faults, f"odd_scenario({seed})"
        outcomes[seed] = outcome
    assert {seed: outcomes[seed] for seed in BROKE} == BROKE
    assert sum(outcome == "solved" for outcome in outcomes.values()) >= 4, outcomes


# With all features at once, and a small database. These were called solved and refused by their own check:
BROKE_WITH_ALL = {
    62: "solved",  # the closed fingers of a second hand, flush: they touched at some base poses by rounding
    75: "solved",  # stops sought again without a pose that had failed: intersections without it, too
}


@pytest.mark.slow
@pytest.mark.parametrize("seed", [7, *BROKE_WITH_ALL])
def test_solved_plans_with_every_feature_hold(seed: int, tmp_path: Path) -> None:
    scenario = odd_full_scenario(seed, tmp_path) | {"reach": {"samples": 300_000}}
    outcome, faults = try_out(scenario, tmp_path, in_passing=seed % 3 == 0)
    assert faults == []
    assert outcome == BROKE_WITH_ALL.get(seed, outcome)


def refusing(message: str) -> Callable[..., Any]:
    def refuse(*arguments: Any, **keywords: Any) -> Any:
        raise mg.InvalidInput(message)

    return refuse


def read_at_once(path: Path, **keywords: Any) -> Any:
    return types.SimpleNamespace(options={"seed": 7})


def outcomes_by_seed(outcomes: dict[int | None, mg.Outcome]) -> Callable[..., Any]:
    def plan(scenario: Any, seed: int | None = None, **keywords: Any) -> Any:
        return types.SimpleNamespace(outcome=outcomes.get(seed, mg.Outcome.infeasible))

    return plan


def test_a_refusal_names_a_line_of_the_scenario(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mg, "load_scenario", refusing("scenario.yaml:7: trays[0].size: must be > 0"))
    assert try_out({}, tmp_path) == ("refused", [])
    monkeypatch.setattr(mg, "load_scenario", refusing("trays[0].size: must be > 0"))
    outcome, faults = try_out({}, tmp_path)
    assert outcome == "refused" and "without the scenario's line" in faults[0]


def test_a_late_refusal_is_a_fault(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mg, "load_scenario", read_at_once)
    monkeypatch.setattr(mg, "plan_part_supply", refusing("scenario.yaml:7: trays[0].size: must be > 0"))
    assert try_out({}, tmp_path)[0] == "refused late"
    assert try_out({}, tmp_path)[1]


@pytest.mark.parametrize(("other", "faults"), [
    ({}, []),
    ({1007: mg.Outcome.not_found}, []),
    ({2007: mg.Outcome.solved}, ["infeasible, and solved with seed 2007"]),
])  # fmt: skip
def test_what_is_infeasible_is_not_solved_with_another_seed(
    other: dict[int | None, mg.Outcome], faults: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mg, "load_scenario", read_at_once)
    monkeypatch.setattr(mg, "plan_part_supply", outcomes_by_seed(other))
    assert try_out({}, tmp_path) == ("infeasible", faults)


@pytest.mark.parametrize(("moments", "share", "is_slow"), [
    ([0, 59], 1, False),
    ([0, 61], 1, True),
    ([*range(0, 100, 2)], 1, False),
    ([*range(0, 100, 2), 103], 1, True),
    ([*range(0, 100, 2), 103], 4, True),
    ([*range(0, 100, 2)], 4, False),
    ([*range(0, 100, 2), 103], 0.5, False),
    ([*range(0, 200, 2), 206], 0.5, True),
    ([*range(0, 500, 50)], 0.02, False),
    ([0, 61], 0, True),
])  # fmt: skip
def test_a_long_work_that_says_nothing_is_a_fault(
    moments: list[int], share: float, is_slow: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """`share`: of the processor that the work has: below 1 on a busy machine, 0 where it is stuck, more with threads."""
    for clock, rate in (("monotonic", 1.0), ("process_time", share)):
        read = iter([*moments, moments[-1]])
        monkeypatch.setattr(time, clock, lambda read=read, rate=rate: rate * next(read))
    watch = Watch()
    for _ in moments[1:]:
        watch("planning", 0.5)
    assert bool(watch.faults()) is is_slow


def test_a_mistake_of_the_programs_is_a_fault(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*arguments: Any, **keywords: Any) -> None:
        raise KeyError("x")

    monkeypatch.setattr(mg, "load_scenario", broken)
    assert one(1, tmp_path, []) == ("KeyError", ["'x'"])
