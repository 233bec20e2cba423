"""What `verify_plan` reads: files that are no plan, values of another form, and a scenario that asks for something else."""

from __future__ import annotations

import copy
import itertools
import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import mmgrasp as mg
from mmgrasp.part_supply.verification import differences


@pytest.mark.parametrize(
    ("text", "piece"),
    [
        ('{"format": "mmgrasp-plan", "format": "mmgrasp-plan"}', "'format' is given twice"),
        ('{"format": "mmgrasp-plan", "version": ' + "9" * 5000 + "}", "5000 digits"),
        ('{"format": "mmgrasp-plan", "version": NaN}', "no number in JSON"),
        ('{"format": ' + "[" * 900 + "]" * 900 + "}", "nested"),
        ("[" * 100000, "nested"),
        ('{"format": "mmgrasp-plan", "version": 4', "is no valid JSON"),
        ("[]", "is no plan"),
        ('"\\ud800"', "is no plan"),
    ],
)
def test_texts_that_are_no_plan(tmp_path: Path, text: str, piece: str) -> None:
    (tmp_path / "plan.json").write_text(text)
    with pytest.raises(mg.InvalidInput, match=re.escape(piece)):
        mg.verify_plan(tmp_path / "plan.json")


def test_a_plan_of_an_older_version_brings_the_new_names(tmp_path: Path) -> None:
    old = {
        "format": "mmgrasp-plan",
        "version": 3,
        "lost_intersections": [],
        "picks": [{"motions": [{"holding": True}]}],
    }
    (tmp_path / "plan.json").write_text(json.dumps(old))
    names = "reads version 4: holding is attached, lost_intersections is too_small_intersections now"
    with pytest.raises(mg.InvalidInput, match=names):
        mg.verify_plan(tmp_path / "plan.json")


def test_a_key_that_has_a_new_name_brings_it(tmp_path: Path, small_plan_dict: dict[str, Any]) -> None:
    plan = copy.deepcopy(small_plan_dict)
    motion = plan["picks"][0]["motions"][2]
    motion["holding"] = motion["attached"]
    (tmp_path / "plan.json").write_text(json.dumps(plan))
    with pytest.raises(mg.InvalidInput, match="holding: unknown key; it is called attached now"):
        mg.verify_plan(tmp_path / "plan.json")


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("mmgrasp", "0.1.0x"),
        ("timings", []),
        ("proven_minimal", "banana"),
        ("regions.0.cells.0.0", 3),
        ("scenario.obstacles.0.pose", {"xyz": [0, 0, 0], "rpy": [0, 0, 0]}),
        ("scenario.obstacles.0.shapes", []),
        ("scenario.gripper.finger_depth", "x"),
        ("scenario.options.seed", None),
        ("scenario.extra", 1),
        ("stops.0.intersection", 1.5),
        ("robustness_rate", 1e400),
        ("too_small_intersections", {}),
    ],
)
def test_values_of_another_form_are_named(small_plan_dict: dict[str, Any], path: str, value: Any) -> None:
    plan = copy.deepcopy(small_plan_dict)
    here: Any = plan
    *parents, last = [int(key) if key.isdigit() and not parent == "cells" else key
                      for parent, key in itertools.pairwise(["", *path.split(".")])]  # fmt: skip
    for key in parents:
        here = here[key]
    here[last] = value
    with pytest.raises(mg.InvalidInput, match=path.split(".")[0]):
        mg.verify_plan(plan)


def test_values_that_are_no_numbers_are_refused(small_plan_dict: dict[str, Any]) -> None:
    for value in (None, "x", float("nan"), [1]):
        plan = json.loads(json.dumps(small_plan_dict))
        plan["picks"][0]["motions"][0]["positions"][0][0] = value
        with pytest.raises(mg.InvalidInput, match=r"picks\[0\]\.motions\[0\]\.positions"):
            mg.verify_plan(plan)


def test_every_section_of_the_scenario_is_compared(small_plan_dict: dict[str, Any]) -> None:
    """A section that is another one differs, and so does a number deep inside of it."""
    scenario = small_plan_dict["scenario"]

    def numbers(value: Any, path: tuple[Any, ...]) -> Iterator[tuple[Any, ...]]:
        items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
        for key, one in items:
            yield from numbers(one, (*path, key))
        if isinstance(value, float):
            yield path

    for key in scenario.keys() - {"name", "source"}:
        assert differences(scenario, {**scenario, key: "another"})[0][0] == f".{key}"
        for path in itertools.islice(numbers(scenario[key], (key,)), 3):
            changed = copy.deepcopy(scenario)
            here = changed
            for step in path[:-1]:
                here = here[step]
            here[path[-1]] += 0.01
            assert differences(scenario, changed), path


@pytest.mark.slow
def test_a_scenario_that_defines_another_problem_is_named(
    small_plan_dict: dict[str, Any], small: dict[str, Any], write: Callable[..., Path]
) -> None:
    tray = {**small["trays"][0], "headings": [0.0, 0.3]}
    for changed, where in (
        ({**small, "trays": [tray]}, ["trays[0].headings", "trays[0].shares_headings"]),
        ({**small, "reach": {"samples": 400_000}}, ["reach.samples"]),
        ({**small, "gripper": {**small["gripper"], "closing_speed": 0.2}}, ["gripper.closing_speed"]),
    ):
        verdict = mg.verify_plan(small_plan_dict, scenario=write(changed), samples=20)
        assert [f.where for f in verdict.faults if f.code == "scenario-changed"] == [f"scenario.{key}" for key in where]


def test_a_changed_scenario_is_named(
    small_plan_dict: dict[str, Any], small: dict[str, Any], write: Callable[..., Path]
) -> None:
    changed = copy.deepcopy(small)
    changed["obstacles"][0]["box"][0] += 0.01
    verdict = mg.verify_plan(small_plan_dict, scenario=write(changed), samples=50)
    assert [f.code for f in verdict.faults] == ["scenario-changed"]
    assert "obstacles[0]" in verdict.faults[0].where
