"""`joint_weights` from Python: by array or by name, in costs and refusals."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from test_manipulation import ARM, problem

START, GOAL = np.array([0.6, 0.1, 0.1]), np.array([-0.6, -0.1, -0.1])


def weighted_length(path: np.ndarray, weights: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(path, axis=0) * weights, axis=1).sum())


def world() -> mg.World:
    scene = mg.World()
    scene.add_box("post", [0.1, 0.1, 0.2], mg.pose([1.0, 0, 0]))
    return scene


def motion(**options: Any) -> mg.planning.MotionResult:
    return mg.plan_motion(ARM.robot, ARM, world(), start=START, goal=GOAL, **options)


def test_an_array_and_a_dict_by_name_are_the_same() -> None:
    weights = np.array([1, 4, 0.5])
    by_array, by_name = motion(joint_weights=weights), motion(joint_weights={"j2": 4, "j3": 0.5})
    assert by_array.outcome == mg.Outcome.solved
    assert np.array_equal(by_array.path, by_name.path)
    assert by_array.cost == by_name.cost == pytest.approx(weighted_length(by_array.path, weights))
    plain = motion(joint_weights=None)
    assert np.array_equal(motion().path, plain.path) and np.array_equal(motion(joint_weights={}).path, plain.path)
    assert np.array_equal(motion(joint_weights=[1, 1, 1]).path, plain.path)


@pytest.mark.parametrize("planner", ["prm_star_mg", "rrt_star_mg"])
def test_over_many_grasps(planner: str) -> None:
    weights = np.array([3, 1, 0.5])
    found = mg.plan_manipulation(problem(), planner=planner, joint_weights={"j1": 3, "j3": 0.5})
    assert found.outcome == mg.Outcome.solved
    assert found.cost == pytest.approx(weighted_length(found.path, weights))
    assert found.lower_bound <= found.cost


def test_a_roadmap_keeps_its_weights(tmp_path: Any) -> None:
    weights = {"j1": 2}
    roadmap = mg.planning.Roadmap.build(ARM, vertices=200, joint_weights=weights)
    assert roadmap.to_dict()["options"]["joint_weights"] == weights
    roadmap.save(tmp_path / "a.roadmap")
    again = mg.planning.Roadmap.load(tmp_path / "a.roadmap", ARM)
    assert again.to_dict()["options"]["joint_weights"] == [2, 1, 1]
    assert np.array_equal(again.edges, roadmap.edges)
    assert mg.plan_manipulation(problem(), roadmap=again, joint_weights=weights).outcome == mg.Outcome.solved
    with pytest.raises(mg.InvalidInput, match="built with joint_weights 2, 1, 1, not with all joint_weights 1"):
        mg.plan_manipulation(problem(), roadmap=again)


@pytest.mark.parametrize(
    ("weights", "said"),
    [
        ([1, 2], "joint_weights: number of them = 2: must be 3"),
        ([1, 2, 0], "joint_weights of 'j3' = 0"),
        ([1, -2, 1], "joint_weights of 'j2' = -2"),
        ([1, np.nan, 1], "joint_weights"),
        ({"j2": 0}, "joint_weights of 'j2' = 0"),
        ({"j9": 1}, "has no joint 'j9'"),
        ({"j2": "much"}, r"joint_weights\['j2'\]"),
        ("heavy", "joint_weights"),
        ([], "joint_weights"),
    ],
)
def test_bad_ones_are_refused_by_name(weights: Any, said: str) -> None:
    with pytest.raises(mg.InvalidInput, match=said):
        motion(joint_weights=weights)
    with pytest.raises(mg.InvalidInput, match=said):
        mg.plan_manipulation(problem(), joint_weights=weights)
    with pytest.raises(mg.InvalidInput, match=said):
        mg.planning.Roadmap.build(ARM, vertices=10, joint_weights=weights)
