"""Parts taken in passing: the main job's first picks merged with the drive."""

from __future__ import annotations

import copy
import io
import json
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest

import mmgrasp as mg
from conftest import ASSETS
from mmgrasp import sim
from mmgrasp.part_supply.consistency import check_consistency
from mmgrasp.part_supply.plan_file import plan_schema
from mmgrasp.viz.report import report_html
from mmgrasp.viz.timeline import Timeline


@pytest.fixture(scope="module")
def passing(small_plan: mg.part_supply.ScenarioPlan) -> mg.part_supply.DriveByPlan:
    stages: list[str] = []
    found = mg.part_supply.plan_drive_by_picks(small_plan, progress=lambda stage, _: stages.append(stage))
    assert stages
    assert set(stages) <= {f"drive-by 1 of 1: {found.picks[0].part}"}
    return found


@pytest.fixture(scope="module")
def content(passing: mg.part_supply.DriveByPlan) -> dict[str, Any]:
    return passing.plan_to_dict()


def codes(plan: dict[str, Any]) -> set[str]:
    return {fault.code for fault in mg.verify_plan(plan, samples=20).faults}


def test_the_first_pick_is_done_in_passing(
    passing: mg.part_supply.DriveByPlan, small_plan: mg.part_supply.ScenarioPlan
) -> None:
    """It is shorter than what it replaces, begins where the plan does, and stands where the plan goes on."""
    (done,) = passing.picks
    pick = small_plan.picks[0]
    problem = small_plan.scenario.problem()
    assert done.used, done.result.report
    assert done.pick == 0
    assert done.part == problem.trays[pick.tray].parts[pick.part].name
    assert done.drive_by == done.result.duration < done.stop_and_pick
    motions = {m.kind: m for m in pick.motions}
    arm = sum(motions[kind].trajectory.duration for kind in ("transit", "approach", "lift"))
    width = problem.trays[pick.tray].parts[pick.part].grasps[pick.grasp].opening
    closing = (motions["transit"].opening - width) / 0.1
    drive = small_plan.route[0].duration(small_plan.scenario.setup.robot)
    assert done.stop_and_pick == pytest.approx(drive + arm + closing)
    assert passing.saved == pytest.approx(done.stop_and_pick - done.drive_by)
    assert passing.drive_by == pytest.approx(passing.stop_and_pick - passing.saved)
    q = done.result.trajectory.positions
    assert q[0] == pytest.approx([*problem.start, *motions["transit"].trajectory.positions[0]], abs=1e-6)
    assert q[-1][3:] == pytest.approx(motions["transfer"].trajectory.positions[0], abs=1e-6)
    assert done.result.events[-1]["base_speed"] > 0.02


@pytest.mark.slow
def test_the_storeroom_is_shortened_from_its_own_plan() -> None:
    """Its three stops need no motion guessed from nothing, and the base drives on at each."""
    found = mg.part_supply.plan_drive_by_picks(mg.plan_part_supply(ASSETS / "scenarios" / "storeroom.yaml"))
    assert len(found.picks) == 3
    for done in found.picks:
        assert done.used, done.report
        tried = done.report.splitlines()
        assert all(line.startswith("from a known motion: ") for line in tried), done.report
        assert "solved" in tried[-1]
        assert done.drive_by < 0.65 * done.stop_and_pick
    verdict = mg.verify_plan(found.plan_to_dict(), samples=20)
    assert verdict.ok, verdict.faults


def test_the_plan_holds_for_the_independent_check(content: dict[str, Any]) -> None:
    verdict = mg.verify_plan(content, samples=50)
    assert verdict.ok, verdict.faults
    jsonschema.validate(content, plan_schema())


def spoiled(content: dict[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    plan = copy.deepcopy(content)
    return plan, plan["drive_by"]["motions"][0]


def test_what_is_wrong_in_passing_is_found(content: dict[str, Any]) -> None:
    """The plan without it stays good; with one thing changed in it each time the check names that."""
    plan, motion = spoiled(content)
    for row in motion["positions"]:
        row[1] += 0.05  # beside the start
    assert "route-ends" in codes(plan)
    plan, motion = spoiled(content)
    motion["times"] = [t / 1.5 for t in motion["times"]]
    motion["velocities"] = [[1.5 * v for v in row] for row in motion["velocities"]]
    motion["close_at"], motion["closed_at"] = motion["close_at"] / 1.5, motion["closed_at"] / 1.5
    assert {"base-limit", "velocity-limit", "acceleration-limit"} <= codes(plan)
    plan, motion = spoiled(content)
    motion["closed_at"] = motion["close_at"] + 0.1  # 2 cm at 0.1 m/s
    assert "closing-time" in codes(plan)
    plan, motion = spoiled(content)
    motion["close_at"] -= 0.5  # the hand still moves
    assert "grasp-missed" in codes(plan)
    plan, motion = spoiled(content)
    middle = next(i for i, t in enumerate(motion["times"]) if t > motion["close_at"]) // 2
    x, y = motion["positions"][middle][:2]
    shape = {"type": "box", "pose": {"xyz": [0, 0, 0], "quat_xyzw": [0, 0, 0, 1]}, "size": [0.1, 0.1, 0.1]}
    crate = {"name": "crate", "pose": {"xyz": [x, y, 0.1], "quat_xyzw": [0, 0, 0, 1]}, "shapes": [shape]}
    plan["scenario"]["obstacles"].append(crate)
    where = [f.where for f in mg.verify_plan(plan, samples=20).faults if f.code == "scene-collision"]
    assert any("drive-by" in text for text in where)
    plan, motion = spoiled(content)
    motion["pick"] = 1
    assert "drive-by-pick" in codes(plan)
    plan, motion = spoiled(content)
    motion["opening"] += 0.001
    assert [f.where for f in check_consistency(plan)] == ["drive_by.motions[0].opening"]
    plan, motion = spoiled(content)
    plan["drive_by"]["motions"].append(motion)
    assert [f.where for f in check_consistency(plan)] == ["drive_by.motions"]


def test_a_leg_on_which_the_base_stands_is_found(content: dict[str, Any]) -> None:
    plan, _ = spoiled(content)
    assert check_consistency(plan) == []
    plan["route"][0]["poses"].insert(1, plan["route"][0]["poses"][0])
    assert [f.where for f in check_consistency(plan)] == ["route[0].poses"]


def test_the_whole_round_is_one_motion(passing: mg.part_supply.DriveByPlan) -> None:
    """As long as is said, with the part taken in passing where its motion has it, and the base on the move then."""
    motion = passing.motion()
    (done,) = passing.picks
    assert motion.duration == pytest.approx(passing.drive_by, abs=1e-6)
    assert np.allclose(motion.base_poses[0], passing.problem.start)
    assert np.allclose(motion.base_poses[-1], passing.problem.goal, atol=1e-6)
    closing = next(e for e in motion.gripper if e["command"] == "close")
    assert closing["object"] == done.part
    assert closing["time"] == pytest.approx(done.close_at)
    opened = next(m.opening for m in passing.plan.picks[done.pick].motions if m.attached)
    assert closing["opening"] == opened
    at = int(np.searchsorted(motion.times, closing["time"]))
    assert np.linalg.norm(motion.base_twists[at, :2]) > 0.02
    for k in range(len(motion) - 1):  # twists lead from pose to pose
        h = motion.times[k + 1] - motion.times[k]
        v = 0.5 * (motion.base_twists[k] + motion.base_twists[k + 1])
        theta = 0.5 * (motion.base_poses[k, 2] + motion.base_poses[k + 1, 2])
        way = h * np.array([v[0] * np.cos(theta), v[0] * np.sin(theta), v[2]])
        assert np.abs(motion.base_poses[k] + way - motion.base_poses[k + 1]).max() < 1e-4


def test_what_is_written(
    passing: mg.part_supply.DriveByPlan,
    small_plan: mg.part_supply.ScenarioPlan,
    content: dict[str, Any],
    tmp_path: Path,
) -> None:
    """A stranger with the CSV alone: wheel speeds lead the base along, joints follow their velocities, accelerations fit, and the
    grasp is where the marks say."""
    files = {path.name: path for path in passing.save(tmp_path)}
    assert json.loads(files["drive_by.json"].read_text())["saved"] == passing.saved
    assert json.loads(files["plan.json"].read_text()) == json.loads(json.dumps(content))
    (name,) = [name for name in files if name.startswith("drive_by_") and name.endswith(".csv")]
    assert files["round.csv"].read_text() == passing.motion().to_csv()
    lines = files[name].read_text()
    table = np.genfromtxt(io.StringIO(lines), delimiter=",", names=True, deletechars="", dtype=None, encoding="utf-8")
    problem = small_plan.scenario.problem()
    h = np.diff(table["time"])
    separation = problem.robot.base_limits["wheel_separation"]
    x, y, theta = (table[c][0] for c in ("x", "y", "theta"))
    for i in range(len(h)):
        s = (np.arange(200) + 0.5) / 200
        left = table["wheel.left"][i] + s * (table["wheel.left"][i + 1] - table["wheel.left"][i])
        right = table["wheel.right"][i] + s * (table["wheel.right"][i + 1] - table["wheel.right"][i])
        turn = np.cumsum((right - left) / separation) * h[i] / 200
        heading = theta + turn - (right - left) / separation * h[i] / 400
        x += np.mean((left + right) / 2 * np.cos(heading)) * h[i]
        y += np.mean((left + right) / 2 * np.sin(heading)) * h[i]
        theta += turn[-1]
        assert np.hypot(x - table["x"][i + 1], y - table["y"][i + 1]) < 1e-4
        assert abs(theta - table["theta"][i + 1]) < 1e-4
    for joint in problem.arm.names:
        v, a = table[f"{joint}.velocity"], table[f"{joint}.acceleration"]
        assert np.allclose(np.diff(table[joint]), h / 2 * (v[1:] + v[:-1]), atol=1e-7)
        assert np.allclose(np.diff(v), h * a[:-1], atol=1e-6)
    (done,) = passing.picks
    taken = table["time"][table["task"] == 1]  # the grasp; task 0 is the place before it
    assert len(taken) == 1
    assert taken[0] == pytest.approx(done.close_at)
    attached = table["attached"]
    assert set(attached[table["time"] < done.close_at - 1e-9]) == {""}
    assert set(attached[table["time"] >= done.close_at + done.dwell]) == {done.part}


@pytest.mark.slow
def test_physics_takes_the_part(passing: mg.part_supply.DriveByPlan, small_plan: mg.part_supply.ScenarioPlan) -> None:
    """Contact and friction only, with a little noise of the wheels: the part is held at the end, its neighbours stand where they stood."""
    pytest.importorskip("mujoco")
    (done,) = passing.picks
    problem, setup = small_plan.scenario.problem(), small_plan.scenario.setup
    parts = [sim.SimPart(p.name, p.shapes, p.T_world_part, mass=0.1) for p in problem.trays[0].parts]
    trial = sim.Simulation(setup.robot, problem.world, parts, gripper=setup.gripper, joints=setup.other_joints)
    # At half speed: plans know limits of joints, not of their motors, which cannot follow this one at full speed.
    how: dict[str, Any] = {
        "close_at": done.close_at,
        "opening": done.opening,
        "speed": 0.5,
        "hold": 1.0,
        "travel_noise": 0.001,
    }
    run = trial.run(done.result.trajectory.sampled(between=9), **how)
    assert run.parts[done.part].grasped, run.parts[done.part].cause
    assert run.parts[done.part].rise > 0.05
    assert max(p.displacement for name, p in run.parts.items() if name != done.part) < 0.002


def test_clock_and_report_know_of_it(
    content: dict[str, Any], passing: mg.part_supply.DriveByPlan, small_plan: mg.part_supply.ScenarioPlan
) -> None:
    (done,) = passing.picks
    timeline, before = Timeline(content), Timeline(small_plan.to_dict())
    motion = content["drive_by"]["motions"][0]
    assert timeline.duration < before.duration
    start, end = timeline.state_at(0.0), timeline.state_at(done.drive_by - 1e-9)
    assert start.base == pytest.approx(motion["positions"][0][:3])
    assert end.arm == pytest.approx(motion["positions"][-1][3:], abs=1e-6)
    assert timeline.state_at(motion["closed_at"] - 0.01).attached is None
    held = timeline.state_at(motion["closed_at"] + 0.01).attached
    assert held is not None and held[0] == done.part
    assert len(timeline.grasp_times()) == len(content["picks"])
    assert "Parts taken in passing" in report_html(content)
    assert "Parts taken in passing" not in report_html(small_plan.to_dict())


def test_it_can_be_stopped(small_plan: mg.part_supply.ScenarioPlan) -> None:
    class StopError(Exception):
        pass

    def progress(stage: str, fraction: float) -> None:
        raise StopError

    with pytest.raises(StopError):
        mg.part_supply.plan_drive_by_picks(small_plan, progress=progress)
