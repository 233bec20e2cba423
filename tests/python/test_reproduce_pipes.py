"""What the reproductions over pipe cells compute with."""

from __future__ import annotations

import numpy as np
import pytest

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
