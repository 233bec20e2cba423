"""Push-grasps through the Python door."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp.reproduce.drive_by import GOAL, START, whole_body


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
    wrong: list[dict[str, Any]] = [{"tool_speed": 0}, {"opening": 0.01}, {"grip_depth": 1.0}, {"max_push": -1}]
    for bad in wrong:
        with pytest.raises(mg.InvalidInput, match=next(iter(bad))):
            mg.grasping.push_grasp(**bad)


def test_deviations_are_covered_and_the_probability_is_a_normal_distributions() -> None:
    hand: dict[str, Any] = {
        "tool_speed": 0.3,
        "object_width": 0.05,
        "opening": 0.10,
        "planned_depth": 0.06,
        "max_push": 1.0,
    }
    found = mg.grasping.push_grasp(along_deviation=0.002, lateral_deviation=0.01, sigmas=2.0, **hand)
    # Both errors are far from every limit but the fingers' free space of 25 mm on either side.
    assert found.push.covered_sigmas == pytest.approx(2.5)
    assert found.push.probability == pytest.approx(math.erf(2.5 / math.sqrt(2)), abs=1e-6)
    assert not mg.grasping.push_grasp(lateral_deviation=0.01, sigmas=3.0, **hand).feasible
    assert mg.grasping.push_grasp(lateral_deviation=0.01, **hand).push.to_dict()["covered_sigmas"] == pytest.approx(2.5)
    assert mg.grasping.push_grasp(**hand).push.to_dict()["covered_sigmas"] is None


def test_a_task_covers_the_covariance_of_the_objects_position() -> None:
    push: dict[str, Any] = {"tool_speed": 0.3, "object_width": 0.05, "opening": 0.10, "max_push": 0.3, "sigmas": 2.0}
    turned = mg.pose([1, 2, 0.5], [0, 0, math.pi / 2])  # approach along y of the world, fingers close along x
    covariance = np.diag([0.01**2, 0.003**2, 1.0])
    task = mg.DriveByTask(turned, push={**push, "covariance": covariance})
    same = mg.grasping.push_grasp(along_deviation=0.003, lateral_deviation=0.01, **push)
    assert task.push.to_dict()["push"] == pytest.approx(same.to_dict()["push"])
    assert task.push.earliest == pytest.approx(same.earliest)
    for wrong, field in (
        ({"covariance": np.eye(2)}, "covariance"),
        ({"covariance": np.diag([0.01, -1e-4, 0.0])}, "eigenvalue"),
        ({"covariance": [[0, 1e-4, 0], [0, 0, 0], [0, 0, 0]]}, "symmetric"),
        ({"covariance": np.full((3, 3), np.nan)}, "covariance"),
        ({"closing_direction": [1, 0, 0]}, "closing_direction"),
        ({"closing_direction": [0, 2, 0]}, "closing_direction"),
        ({"covariance": np.diag([1.0, 1.0, 1.0])}, "tool_speed"),  # no moment to close
    ):
        robot, group = whole_body()
        with pytest.raises(mg.InvalidInput, match=field):
            mg.plan_drive_by(
                robot, group, mg.World(), start=START, goal=GOAL, tasks=[mg.DriveByTask(turned, push={**push, **wrong})]
            )
