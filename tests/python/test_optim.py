"""Search by values alone from Python: functions, options, exceptions."""

from __future__ import annotations

import numpy as np
import pytest

import mmgrasp as mg

Array = np.ndarray[tuple[int, ...], np.dtype[np.float64]]
LOWER, UPPER = [-2.0, -1.0], [3.0, 4.0]


def bowl(x: Array) -> float:
    """Least, 0.5, at (1, -0.25)."""
    return float(0.5 + (x[0] - 1) ** 2 + 3 * (x[1] + 0.25) ** 2)


@pytest.mark.parametrize("solver", mg.optim.derivative_free_solver_names())
def test_solvers_find_the_bottom_and_repeat_themselves(solver: str) -> None:
    found = mg.optim.minimize_derivative_free(
        bowl, [2, 3], LOWER, UPPER, solver=solver, max_evaluations=6000, tolerance=1e-5, seed=3
    )
    assert found.value == bowl(found.x) == pytest.approx(0.5, abs=1e-2)
    assert found.evaluations <= 6000
    again = mg.optim.minimize_derivative_free(
        bowl, [2, 3], LOWER, UPPER, solver=solver, max_evaluations=6000, tolerance=1e-5, seed=3
    )
    assert again.x.tolist() == found.x.tolist()
    assert again.to_dict()["evaluations"] == found.evaluations


def test_constraints_and_open_bounds() -> None:
    found = mg.optim.minimize_derivative_free(
        lambda x: float(np.sum((x - 2) ** 2)),
        [0, 0],
        [-np.inf, 0],
        [np.inf, np.inf],
        solver="cobyla",
        constraints=lambda x: [x @ x - 1],
        constraint_count=1,
    )
    assert found.outcome == mg.Outcome.solved
    assert found.violation <= 1e-8
    np.testing.assert_allclose(found.x, [0.5**0.5] * 2, atol=1e-4)


def test_what_a_function_raises_is_raised() -> None:
    def broken(x: Array) -> float:
        raise KeyError("no such part")

    with pytest.raises(KeyError, match="no such part"):
        mg.optim.minimize_derivative_free(broken, [0, 0], LOWER, UPPER)
    assert mg.optim.minimize_derivative_free(bowl, [0, 0], LOWER, UPPER).outcome == mg.Outcome.solved


def test_mistakes_are_named() -> None:
    with pytest.raises(mg.InvalidInput, match="bobyqa, cobyla"):
        mg.optim.minimize_derivative_free(bowl, [0, 0], LOWER, UPPER, solver="powell")
    with pytest.raises(mg.InvalidInput, match="max_evaluations"):
        mg.optim.minimize_derivative_free(bowl, [0, 0], LOWER, UPPER, max_evaluation=10)  # type: ignore[call-arg]
    with pytest.raises(mg.InvalidInput, match="lower"):
        mg.optim.minimize_derivative_free(bowl, [0, 0], [0], UPPER)
    with pytest.raises(mg.InvalidInput, match="cobyla, isres"):
        mg.optim.minimize_derivative_free(
            bowl, [0, 0], LOWER, UPPER, constraints=lambda x: [x[0]], constraint_count=1, solver="crs2"
        )


def test_constraints_need_their_number() -> None:
    with pytest.raises(mg.InvalidInput, match="constraint_count = 0: must be how many numbers"):
        mg.optim.minimize_derivative_free(
            bowl, [0, 0], LOWER, UPPER, solver="cobyla", constraints=lambda x: np.array([x[0]])
        )
