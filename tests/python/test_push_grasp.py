"""Push-grasps through the Python door."""

from __future__ import annotations

import math

import pytest

import mmgrasp as mg


def test_both_strategies_in_numbers() -> None:
    found = mg.grasping.push_grasp(tool_speed=0.5, object_width=0.05, opening=0.10, planned_depth=0.06, max_push=0.3)
    assert found.closing_time == pytest.approx(0.5)
    assert found.plain.side_clearance == pytest.approx(0.1 * 0.06 / (2 * 0.5))
    assert found.push.side_clearance == pytest.approx(0.025)
    assert found.push.holds and found.push.pushed > 0 == found.plain.pushed
    assert found.feasible and found.earliest <= found.push.start <= found.latest
    assert found.window == pytest.approx((found.latest - found.earliest) / 0.5)
    assert found.to_dict()["push"]["side_clearance"] == found.push.side_clearance
    assert (
        mg.grasping.closing_outcome(found.plain.start, tool_speed=0.5, planned_depth=0.06).side_clearance
        == found.plain.side_clearance
    )


def test_the_leap_limits_the_speed() -> None:
    assert mg.grasping.push_speed_limit(length=0.03, friction=0.3, restitution=0.4) == pytest.approx(
        math.sqrt(2 * 0.3 * 9.81 * 0.03) / 0.4
    )


def test_wrong_input_is_refused() -> None:
    with pytest.raises(mg.InvalidInput, match="did you mean tool_speed"):
        mg.grasping.push_grasp(tol_speed=1)  # type: ignore[call-arg]
    for bad in ({"tool_speed": 0}, {"opening": 0.01}, {"grip_depth": 1.0}, {"max_push": -1}):
        with pytest.raises(mg.InvalidInput, match=next(iter(bad))):
            mg.grasping.push_grasp(**bad)
