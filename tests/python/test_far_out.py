"""Numbers at and beyond the ends of what is allowed: at the end the answer is right, beyond it is refused."""

from __future__ import annotations

import re

import numpy as np
import pytest

import mmgrasp as mg
from argument_calls import CALLS
from argument_objects import ARM, POSE, ROBOT, Q, world
from number_walk import Try, perform

MOST = 2_000_000_000
BEYOND = 2**31 - 1
BUDGETS = re.compile(r"(max_)?(iterations|evaluations|restarts|draws|nodes|boxes)|.*_iterations")


def budgets() -> list[Try]:
    found = [
        (c.function, p.name) for c in CALLS for p in c.parameters if BUDGETS.fullmatch(p.name) and p.annotation == "int"
    ]
    return [Try(function, name, "2**31-1") for function, name in dict.fromkeys(found)]


def test_budgets_were_found_in_the_stubs() -> None:
    assert {one.parameter for one in budgets()} >= {
        "restarts",
        "max_iterations",
        "max_evaluations",
        "draws",
        "max_nodes",
    }
    assert len(budgets()) > 20


@pytest.mark.parametrize("one", budgets(), ids=str)
def test_a_budget_beyond_the_largest_is_refused_by_name(one: Try) -> None:
    """One more than an int holds was a negative budget: nothing was tried, and "unreachable" was said."""
    action = perform(one)
    with pytest.raises(mg.InvalidInput, match=rf"{one.parameter} = {BEYOND}"):
        action()


def test_descents_with_the_most_restarts_find_what_they_find_with_few() -> None:
    few = ARM.ik_all(POSE, restarts=5)
    many = ARM.ik_all(POSE, restarts=MOST, time_limit=0.5)
    assert len(few) > 0
    assert len(many) >= len(few)
    assert ARM.ik(POSE, seed=ARM.lower, restarts=MOST).outcome == mg.Outcome.solved


def past_a_corner() -> tuple[np.ndarray, list[mg.verify.CheckedBody]]:
    """A square column turns by a quarter: its corner alone, half-way, meets a peg 5 mm beside its face."""
    path = np.array([[0, 0, 0.5], [np.pi / 2, 0, 0.5]])
    peg = mg.LinkShape(mg.Box([0.02, 0.002, 0.1]))
    return path, [mg.verify.CheckedBody("peg", [peg], mg.pose([0.065, 0, 0]))]


@pytest.mark.parametrize("step", [1e-300, 1e-12, 0.0, -1.0, float("nan"), float("inf")])
def test_a_path_is_not_checked_in_steps_that_cannot_be_counted(step: float) -> None:
    """A count of steps beyond an int became one step: the ends alone were looked at."""
    path, bodies = past_a_corner()
    with pytest.raises(mg.InvalidInput, match="joint_step"):
        mg.verify.check_path(ROBOT, ARM.names, path, bodies, joint_step=step)


@pytest.mark.parametrize("step", [1e-3, 0.02])
def test_a_path_whose_middle_touches_is_refused(step: float) -> None:
    path, bodies = past_a_corner()
    assert not mg.verify.check_path(ROBOT, ARM.names, path, bodies, joint_step=step).free
    for end in path:
        assert mg.verify.check_path(ROBOT, ARM.names, [end], bodies, joint_step=step).free


@pytest.mark.parametrize("step", [1e-300, 1e-12])
def test_edges_are_not_walked_in_steps_that_cannot_be_counted(step: float) -> None:
    checker = mg.CollisionChecker(ROBOT, world(), group=ARM)
    for check in (checker.edge_is_free, checker.check_edge):
        with pytest.raises(mg.InvalidInput, match="step"):
            check(Q, Q + 0.1, joint_step=step)
