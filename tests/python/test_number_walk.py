"""What number_walk.py complains of, and what it lets pass."""

from __future__ import annotations

import pytest

from number_walk import Try, complaint

PLAIN = ("make_height_map", "hole_radius")  # one number
UNBOUNDED = ("plan_motion", "time_limit")


@pytest.mark.parametrize("value", ["nan", "inf", "-inf", "1e160", "a word", "complex", "a huge list"])
@pytest.mark.parametrize(("outcome", "said"), [("returned", "took"), ("interrupted", "went on, until Ctrl-C, with")])
def test_what_is_never_a_number_is_not_taken(value: str, outcome: str, said: str) -> None:
    assert complaint(Try(*PLAIN, value), outcome) == f"{said} {value}"
    assert complaint(Try(*PLAIN, value), "refused") is None


@pytest.mark.parametrize("outcome", ["returned", "interrupted"])
def test_numbers_that_may_be_large_are_taken(outcome: str) -> None:
    assert complaint(Try(*PLAIN, "1e300"), outcome) is None
    assert complaint(Try(*UNBOUNDED, "inf"), outcome) is None
    assert complaint(Try(*UNBOUNDED, "nan"), outcome) is not None


def test_whatever_else_ends_a_call_is_told() -> None:
    for outcome in ("did not hear Ctrl-C", "ended with -11", "MemoryError: ", "refused for something else: x"):
        assert complaint(Try(*PLAIN, "-1"), outcome) == outcome


def test_wrong_values_of_a_plan_are_for_its_check_but_not_to_go_on_with() -> None:
    one = Try("verify.PlanToCheck.floor", "arg1", "nan")
    assert complaint(one, "returned") is None
    assert complaint(one, "interrupted") == "went on, until Ctrl-C, with nan"
