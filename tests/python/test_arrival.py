"""Arrive, measure, replan: picks from where the base really stands, checked by the independent checker's own means."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp.cli import main
from mmgrasp.part_supply import ScenarioPlan, arrive


@pytest.fixture(scope="module")
def plan(small_path: Path) -> ScenarioPlan:
    found = mg.plan_part_supply(mg.load_scenario(small_path))
    assert found.outcome == mg.Outcome.solved
    return found


def displaced(plan: ScenarioPlan, seed: int) -> np.ndarray:
    """A base pose in the stop's uncertainty disc, turned by up to five degrees."""
    rng = np.random.default_rng(seed)
    angle, radius = rng.uniform(-np.pi, np.pi), plan.scenario.positioning_uncertainty * np.sqrt(rng.uniform())
    pose = np.array(plan.stops[0].pose)
    return np.asarray(pose + [radius * np.cos(angle), radius * np.sin(angle), rng.uniform(-0.09, 0.09)])


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_picks_hold_from_where_the_base_stands(plan: ScenarioPlan, seed: int) -> None:
    pose = displaced(plan, seed)
    found = arrive(plan, 0, pose)
    assert found.outcome == mg.Outcome.solved
    names = [plan.scenario.trays[p.tray].tray.parts[p.part].name for p in found.picks]
    assert sorted(names) == sorted(plan.scenario.trays[p.tray].tray.parts[p.part].name for p in plan.picks)
    arm, problem = plan.scenario.setup.arm, plan.scenario.problem()
    standing = arm.at(mg.pose([pose[0], pose[1], 0], rpy=[0, 0, pose[2]]))
    start = np.asarray(problem.home)
    for pick in found.picks:
        part = plan.scenario.trays[pick.tray].tray.parts[pick.part]
        approach = pick.motions[1].trajectory
        wanted = part.T_world_part @ part.grasps[pick.grasp].T_object_hand
        np.testing.assert_allclose(standing.fk(approach.positions[-1]), wanted, atol=2e-3)
        np.testing.assert_allclose(pick.motions[0].trajectory.positions[0], start, atol=1e-9)
        start = pick.motions[-1].trajectory.positions[-1]
    assert found.offset == pytest.approx(np.linalg.norm(pose[:2] - np.asarray(plan.stops[0].pose)[:2]))
    assert found.turned == pytest.approx(pose[2] - plan.stops[0].pose[2])
    again = arrive(plan, 0, pose)
    for a, b in zip(found.picks, again.picks, strict=True):
        np.testing.assert_array_equal(a.motions[0].trajectory.positions, b.motions[0].trajectory.positions)


def test_from_its_own_base_pose_the_plan_comes_back(plan: ScenarioPlan) -> None:
    found = arrive(plan, 0, plan.stops[0].pose)
    for ours, planned in zip(found.picks, plan.picks, strict=True):
        assert (ours.tray, ours.part, ours.grasp) == (planned.tray, planned.part, planned.grasp)
        for a, b in zip(ours.motions, planned.motions, strict=True):
            np.testing.assert_allclose(a.trajectory.positions, b.trajectory.positions, atol=1e-9)


def test_parts_that_are_gone_are_not_picked(plan: ScenarioPlan) -> None:
    first = plan.scenario.trays[plan.picks[0].tray].tray.parts[plan.picks[0].part].name
    found = arrive(plan, 0, plan.stops[0].pose, picked=[first])
    assert len(found.picks) == len(plan.picks) - 1
    assert all((p.tray, p.part) != (plan.picks[0].tray, plan.picks[0].part) for p in found.picks)


def test_too_far_away_is_explained(plan: ScenarioPlan) -> None:
    start = plan.scenario.start
    found = arrive(plan, 0, start)
    assert found.outcome == mg.Outcome.not_found
    assert found.to_dict()["picks"] == []
    assert all("outside the" in why and "drive nearer" in why for why in found.explanations)


def test_bad_input(plan: ScenarioPlan) -> None:
    pose = plan.stops[0].pose
    with pytest.raises(mg.InvalidInput, match=r"stop = 7: .*the plan has 1 stop$"):
        arrive(plan, 7, pose)
    with pytest.raises(mg.InvalidInput, match="pose"):
        arrive(plan, 0, [0, 0])
    with pytest.raises(mg.InvalidInput, match="pose"):
        arrive(plan, 0, [0, 0, float("nan")])
    with pytest.raises(mg.InvalidInput, match="'mug': is no part"):
        arrive(plan, 0, pose, picked=["mug"])
    with pytest.raises(mg.InvalidInput, match="touches"):
        arrive(plan, 0, [*plan.scenario.trays[0].tray.T_world_tray[:2, 3], 0])
    with pytest.raises(mg.InvalidInput, match="scenario"):
        arrive(plan, 0, pose, scenario="storeroom.yaml")
    problem, database = plan.scenario.problem(), plan.scenario.reach_database()
    with pytest.raises(mg.InvalidInput, match="remaining"):
        mg.base.plan_stop_picks(problem, database, pose, [0], [(0, 0), (0, 0)])
    with pytest.raises(mg.InvalidInput, match="trays"):
        mg.base.plan_stop_picks(problem, database, pose, [0, 5], [(0, 0)])


def test_the_command(
    plan: ScenarioPlan,
    small: dict[str, Any],
    write: Callable[..., Path],
    tmp_path: Path,
    capfd: pytest.CaptureFixture[str],
) -> None:
    file = plan.save(tmp_path / "plan.json")
    pose = [f"{x:.6f}" for x in displaced(plan, 4)]
    out = tmp_path / "out"
    assert main(["arrive", str(file), "--stop", "1", "--pose", *pose, "-o", str(out)]) == 0
    written = json.loads((out / "arrival.json").read_text())
    assert written["outcome"] == "solved" and len(written["picks"]) == len(plan.picks)
    assert len(list((out / "trajectories").iterdir())) == 5 * len(plan.picks)
    assert main(["arrive", str(file), "--stop", "2", "--pose", *pose]) == 2
    assert "--stop 2" in capfd.readouterr().err
    assert main(["arrive", str(file), "--stop", "1", "--pose", *(str(x) for x in plan.scenario.start)]) == 4
    changed = copy.deepcopy(small)
    changed["obstacles"][0]["box"][0] += 0.01
    other = write(changed)
    assert main(["arrive", str(file), "--stop", "1", "--pose", *pose, "--scenario", str(other)]) == 2
    assert "is not what" in capfd.readouterr().err
