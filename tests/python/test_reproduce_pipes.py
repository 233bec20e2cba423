"""What the reproductions over pipe cells compute with."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mmgrasp.reproduce import grasp_search, grasp_search_runs
from mmgrasp.reproduce.entry import Result
from mmgrasp.reproduce.pipe_runs import mean
from mmgrasp.reproduce.statements import CONFIRMED, NO_DIFFERENCE, REVERSED, Pair, difference


def pairs(larger: list[float | None], smaller: list[float | None]) -> list[Pair]:
    """A cell each, four of a seed."""
    return [Pair(i // 4, i, a, b) for i, (a, b) in enumerate(zip(larger, smaller, strict=True))]


def test_paired_differences_have_students_interval() -> None:
    # 1..80 less a constant: mean 40.5 - 3, deviation sqrt(540), and t(79) = 1.99045 (printed tables).
    found = difference(pairs([float(i) for i in range(1, 81)], [3.0] * 80))
    assert found is not None and found.cells == 80
    assert found.mean == pytest.approx(37.5)
    assert found.half == pytest.approx(1.99045 * np.sqrt(540 / 80), rel=1e-4)
    assert found.by_seed[0] == pytest.approx(-0.5) and len(found.by_seed) == 20
    # t(4) = 2.77645
    found = difference(pairs([1.0, 2, 3, 4, 5, None], [0.0, 0, 0, 0, 0, 7]))
    assert found is not None and found.cells == 5
    assert found.half == pytest.approx(2.77645 * np.sqrt(2.5 / 5), rel=5e-3)
    assert difference(pairs([1.0], [2.0])) is None


def test_runs_of_a_cell_are_one_pair() -> None:
    """A cell that is run a hundred times weighs as much as one that is run once."""
    found = difference([*(Pair(1, "a", 1.0, 0.0) for _ in range(100)), Pair(1, "b", 3.0, 0.0)])
    assert found is not None
    assert (found.cells, found.mean) == (2, 2.0)
    assert found.half == pytest.approx(12.7062, rel=1e-5)  # t(1), a deviation of sqrt(2) over sqrt(2)


def test_a_statement_has_three_answers() -> None:
    rng = np.random.default_rng(1)
    noise = list(rng.normal(0, 1, 100))
    zeros: list[float | None] = [0.0] * 100
    result = Result()
    result.statement("up", pairs([n + 1 for n in noise], zeros))
    result.statement("down", pairs([n - 1 for n in noise], zeros))
    result.statement("alike", pairs([n - float(np.mean(noise)) for n in noise], zeros))
    result.statement("the same", pairs(zeros, zeros))
    result.statement("nothing", pairs([None] * 100, zeros))
    assert [c.answer for c in result.checks] == [CONFIRMED, REVERSED, NO_DIFFERENCE, NO_DIFFERENCE]
    assert [c.holds for c in result.checks] == [True, False, True, True]
    assert result.to_dict()["checks"][1]["answer"] == "reversed"
    assert mean([None, 1.0, 3.0]) == 2.0
    assert mean([None]) is None


def run_of(pipe: str, method: str, setting: int, solved: list[bool], evaluations: list[int]) -> dict[str, Any]:
    return {"pipe": pipe, "method": method, "setting": setting, "solved": solved, "evaluations": evaluations}


def test_settings_of_a_pipe_are_one_cell() -> None:
    """Nine settings that agree on each of three pipes are three draws, and the words name them."""
    done = [
        run_of(pipe, method, setting, [True], [100 * (1 + i) + (50 * (i + 1) if method == "Str1" else 0)])
        for i, pipe in enumerate(("Pipe1", "Pipe2", "Pipe3"))
        for method in ("Str1", "Str3")
        for setting in range(1, 10)
    ]
    found = difference(grasp_search_runs.pairs(done, "evaluations", "Str1", "Str3"))
    assert found is not None and found.cells == 3 and found.mean == pytest.approx(100)
    assert found.half == pytest.approx(4.30265 * 50 / np.sqrt(3), rel=1e-5)  # t(2), deviation 50
    assert found.answer == NO_DIFFERENCE  # 27 draws would have said otherwise
    assert "Pipe1 +50, Pipe2 +100, Pipe3 +150" in str(found)
    small = [d for d in done if d["method"] == "Str1"]
    by_population = difference(grasp_search_runs.pairs_of_settings(small, "evaluations", "Str1", 102, 34, 4))
    assert by_population is not None and by_population.cells == 3


def test_the_runs_that_choose_a_setting_do_not_tell_of_it() -> None:
    lucky = run_of("Pipe1", "GA", 1, [True, False] * 5, [1, 1000] * 5)  # good in every second run only
    steady = run_of("Pipe1", "GA", 2, [True, True, False, True] * 2 + [True, True], [500] * 10)
    best = grasp_search._best([lucky, steady])
    assert best["setting"] == 1
    assert best["solved"] == [False] * 5 and best["evaluations"] == [1000] * 5
