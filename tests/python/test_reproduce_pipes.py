"""What the reproductions over pipe cells compute with."""

from __future__ import annotations

import numpy as np
import pytest

from mmgrasp.reproduce.pipe_runs import difference, mean, not_reversed


def test_paired_differences_have_students_interval() -> None:
    # 1..80 less a constant: mean 40.5 - 3, deviation sqrt(540), and t(79) = 1.99045 (printed tables).
    first = [float(i) for i in range(1, 81)]
    compared = difference(first, [3.0] * 80)
    assert compared is not None
    found, half, pairs = compared
    assert pairs == 80
    assert found == pytest.approx(37.5)
    assert half == pytest.approx(1.99045 * np.sqrt(540 / 80), rel=1e-4)
    # t(4) = 2.77645
    compared = difference([1.0, 2, 3, 4, 5, None], [0.0, 0, 0, 0, 0, 7])
    assert compared is not None
    _, half, pairs = compared
    assert pairs == 5
    assert half == pytest.approx(2.77645 * np.sqrt(2.5 / 5), rel=5e-3)
    assert difference([1.0], [2.0]) is None


def test_an_order_is_reversed_only_beyond_the_interval() -> None:
    rng = np.random.default_rng(1)
    noise = list(rng.normal(0, 1, 100))
    zeros = [0.0] * 100
    assert not_reversed(zeros, [n + 1 for n in noise])
    assert not_reversed(zeros, list(rng.normal(0, 1, 100)))
    assert not not_reversed([n + 1 for n in noise], zeros)
    assert mean([None, 1.0, 3.0]) == 2.0
    assert mean([None]) is None
