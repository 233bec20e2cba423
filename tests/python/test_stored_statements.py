"""What the stored full results say: every statement that does not hold is named here, and those against printed numbers follow from the rows."""

from __future__ import annotations

import json
import re
from typing import Any

import pytest

from conftest import REPOSITORY

STORED = REPOSITORY / "docs" / "reproduction"

FAILING = {
    "p1-figure-4.13": [
        "a waypoint of its own: every task is solved",
        "common: fewer tasks are solved, or half as many iterations more are needed",
    ],
    "p1-figure-5.14": ["four grippers take all 13 parts"],
    "p1-table-3.5": [
        "ExperA: Improvement [s] within 25 % of the paper's -17.26",
        "ExperB: Improvement [s] within 25 % of the paper's -11.22",
        "ExperA: Improvement [%] within 25 % of the paper's -36.77",
        "ExperB: Improvement [%] within 25 % of the paper's -29.37",
    ],
    "p2-table-3.11": ["evaluations of Str2 change by less than 10 %"],
    "p2-table-3.7": ["with its best settings each strategy of Bees"],
    "p2-table-3.9": ["Pipe1: PSO fails most often", "Pipe3: GA fails most often"],
    "p2-table-4.1": ["every run succeeds from 500 grasps on"],
    "p2-table-5.1": ["V2 solves at least 99 % of the runs"],
    "p3-figure-3.31": ["arm: maximal index [%] within 10 % of the paper's 85"],
    "p3-figure-3.34": ["before the shelf: maximal index inside [%] within 25 % of the paper's 20"],
    "p3-figure-4.15": ["and the hand is turned by no more than 30 degrees"],
    "p3-table-4.1": ["ours at the defaults reaches the goal of 0.975 for S."],
    "p3-table-4.1-rough": [
        "ours at the defaults reaches the goal of 0.975 for S.",
        "ours at the defaults reaches the goal of 0.900 for S.w.P.",
    ],
}
"""The beginnings of the statements of seed 1, in order; those about times are left out: machines differ."""

QUICK = {"p2-table-5.2", "p2-table-5.3"}
"""Stored in their quick versions only."""

NEAR = re.compile(r"(.*): (.*) within (\S+) % of the paper's (\S+)")


def stored(name: str) -> dict[str, Any]:
    result: dict[str, Any] = json.loads((STORED / f"{name}.json").read_text())
    return result


NAMES = sorted(path.stem for path in STORED.glob("*.json") if "-seed-" not in path.stem)


def test_results_are_stored() -> None:
    assert len(NAMES) > 50 and FAILING.keys() <= set(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_what_does_not_hold_is_named(name: str) -> None:
    result = stored(name)
    assert result["quick"] == (name in QUICK)
    broken = [check["what"] for check in result["checks"] if not check["holds"] and not check["clock"]]
    expected = FAILING.get(name, [])
    assert len(broken) == len(expected), broken
    for what, beginning in zip(broken, expected, strict=True):
        assert what.startswith(beginning)


@pytest.mark.parametrize("name", ["p3-figure-3.31", "p3-figure-3.34", "p1-table-3.5"])
def test_statements_on_printed_numbers_follow_from_the_rows(name: str) -> None:
    result = stored(name)
    held = {near.group(0): check["holds"] for check in result["checks"] if (near := NEAR.fullmatch(check["what"]))}
    expected = {}
    for what in held:
        match = NEAR.fullmatch(what)
        assert match is not None
        where, column, share, paper = match.groups()
        (row,) = [r for r in result["rows"] if ", ".join(map(str, r["key"].values())) == where]
        both = row["values"][column]
        assert both["paper"] == float(paper)
        expected[what] = abs(both["ours"] - both["paper"]) <= float(share) / 100 * abs(both["paper"])
    assert held == expected != {}
    columns = {NEAR.fullmatch(what).group(2) for what in held}  # type: ignore[union-attr]
    printed = sum(row["values"][c]["paper"] is not None for row in result["rows"] for c in columns)
    assert len(held) == printed
