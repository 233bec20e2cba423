"""The least number of stops: what it is proven for, what the check proves again, and that it says what it cannot decide."""

from __future__ import annotations

import copy
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import yaml
from rich.console import Console

import mmgrasp as mg
from mmgrasp.cli.tables import print_verdict, summary
from mmgrasp.part_supply import PlanVerdict
from mmgrasp.part_supply.premises import premises, premises_text


def test_both_sides_prove_the_least_number(small_plan_dict: dict[str, Any]) -> None:
    verdict = mg.verify_plan(small_plan_dict)
    assert verdict.lower_bound == verdict.minimal_stops == small_plan_dict["lower_bound"]
    assert not verdict.search_cut
    assert {"lower_bound", "search_cut"} <= verdict.to_dict().keys()


def test_undecided_is_said() -> None:
    verdict = PlanVerdict([], minimal_stops=7, lower_bound=5, search_cut=True)
    console = Console(record=True, width=200)
    print_verdict(verdict, console)
    text = console.export_text()
    assert "whether 7 stops are the least was not decided (at least 5), since the search" in text


def test_shares_of_few_draws_say_how_sure_they_are() -> None:
    console = Console(record=True, width=200)
    rates: Any = [SimpleNamespace(stop=0, samples=n, good=n, worst_part="") for n in (1, 1000)]
    print_verdict(PlanVerdict([], rates, 2, lower_bound=2), console)
    text = console.export_text()
    assert "from 1 of 1 base poses, 100.00 % (95 %: 20.65 to 100.00)" in text  # 1 / (1 + 1.96^2)
    assert "from 1000 of 1000 base poses, 100.00 % (95 %: 99.62 to 100.00)" in text


def test_markup_in_names_is_text_in_tables(small: dict[str, Any], tmp_path: Path) -> None:
    marked = {**small, "name": "[bold]a[/nothing]", "trays": [{**small["trays"][0], "name": "[red]b[/x]"}]}
    path = tmp_path / "scenario.yaml"
    path.write_text(yaml.safe_dump(marked))
    console = Console(record=True, width=200)
    console.print(summary(mg.plan_part_supply(path)))
    text = console.export_text()
    assert "[bold]a[/nothing]" in text and "[red]b[/x]" in text


def test_parts_with_few_grasps_are_tried_in_more_postures(small_plan_dict: dict[str, Any]) -> None:
    plan = copy.deepcopy(small_plan_dict)
    plan["scenario"]["options"]["ik_seeds"] = 8
    parts = [part for part in plan["scenario"]["parts"] if part["grasps"]]
    for count, seeds in ((1, 128), (5, 26), (16, 8), (200, 8)):
        for part in parts:
            part["grasps"] = [part["grasps"][0]] * 300
        parts[-1]["grasps"] = [parts[-1]["grasps"][0]] * count
        assert premises(plan)["ik_seeds"] == seeds
    plan["scenario"]["options"]["ik_seeds"] = 30
    assert premises(plan)["ik_seeds"] == 30


def test_premises_of_the_proof(small_plan: mg.part_supply.ScenarioPlan, small_plan_dict: dict[str, Any]) -> None:
    said = small_plan_dict["premises"]
    assert said == small_plan.premises
    grasps = [len(part["grasps"]) for part in small_plan_dict["scenario"]["parts"]]
    assert said["grasps"] == sum(grasps) > 0
    assert said["headings"] == {"A": [0.0]}
    assert (said["cell"], said["positioning_uncertainty"], said["search_finished"]) == (0.05, 0.1, True)
    assert said["database"]["samples"] == 500_000
    text = premises_text(said)
    for piece in (
        "base headings of 0°",
        "base cells of 5 cm",
        "discs of 0.1 m",
        f"{sum(grasps)} grasps",
        "500,000 draws",
    ):
        assert piece in text
    plan = copy.deepcopy(small_plan_dict)
    plan["premises"]["headings"]["A"] = [0.0, 1.5]
    faults = mg.verify_plan(plan).faults
    assert [(f.code, f.where) for f in faults] == [("wrong-values", "premises.headings")]
