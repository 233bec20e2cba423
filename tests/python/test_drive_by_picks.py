"""Parts taken in passing: every pick of the main job as one motion with the way to it."""

from __future__ import annotations

import copy
import io
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest

import mmgrasp as mg
from conftest import ASSETS
from mmgrasp import sim
from mmgrasp.cli import main
from mmgrasp.part_supply.consistency import check_consistency
from mmgrasp.part_supply.drive_by import check_in_passing
from mmgrasp.part_supply.plan_file import plan_schema
from mmgrasp.viz.report import report_html
from mmgrasp.viz.timeline import GRIP_TIME, Timeline


@pytest.fixture(scope="module")
def passing(small_plan: mg.part_supply.ScenarioPlan) -> mg.part_supply.DriveByPlan:
    stages: list[str] = []
    found = mg.part_supply.plan_drive_by_picks(small_plan, progress=lambda stage, _: stages.append(stage))
    assert set(stages) == {f"drive-by {i + 1} of 2: {pick.part}" for i, pick in enumerate(found.picks)}
    return found


@pytest.fixture(scope="module")
def content(passing: mg.part_supply.DriveByPlan) -> dict[str, Any]:
    return passing.plan_to_dict()


def codes(plan: dict[str, Any]) -> set[str]:
    return {fault.code for fault in mg.verify_plan(plan, samples=20).faults}


def test_every_pick_is_done_in_passing(
    passing: mg.part_supply.DriveByPlan, small_plan: mg.part_supply.ScenarioPlan
) -> None:
    """Each is shorter than what it replaces, begins where the plan is before it, and ends where the plan lets the part go."""
    problem = small_plan.scenario.problem()
    drive = small_plan.route[0].duration(small_plan.scenario.setup.robot)
    home = small_plan.picks[0].motions[0].trajectory.positions[0]
    first_place = np.array([*problem.start, *home])
    for i, (done, pick) in enumerate(zip(passing.picks, small_plan.picks, strict=True)):
        assert done.used, done.result.report
        assert (done.pick, done.stop) == (i, pick.stop)
        part = problem.trays[pick.tray].parts[pick.part]
        assert done.part == part.name
        assert done.drive_by == done.result.duration < done.stop_and_pick
        motions = {m.kind: m.trajectory for m in pick.motions}
        pieces = [motions[kind].duration for kind in ("transit", "approach", "lift", "transfer")]
        pieces.append((pick.motions[0].opening - part.grasps[pick.grasp].opening) / 0.1)
        pieces.append(small_plan.picks[0].motions[-1].trajectory.duration if i else drive)
        assert done.stop_and_pick == pytest.approx(sum(pieces))
        q = done.result.trajectory.positions
        assert q[0] == pytest.approx(first_place[3:] if i else first_place, abs=1e-6)
        end = motions["transfer"].positions[-1]
        assert q[-1][-len(end) :] == pytest.approx(end, abs=1e-6)
        first_place = np.array([*small_plan.stops[0].pose, *end])
        assert done.drives == (i == 0)
        row = done.motion()
        assert (row["begins"], row["ends"]) == ("release" if i else "home", "release")
        assert np.asarray(row["positions"]).shape[1] == 3 + len(end)
        assert row["positions"][-1][:3] == pytest.approx(small_plan.stops[0].pose, abs=1e-6)
    assert passing.picks[0].result.events[-1]["base_speed"] > 0.02
    assert passing.saved == pytest.approx(passing.stop_and_pick - passing.drive_by)


@pytest.mark.slow
def test_the_storeroom_is_shortened_from_its_own_plan() -> None:
    """Its twenty picks need no motion guessed from nothing, the base drives on at each stop's first, and half of the round is saved."""
    found = mg.part_supply.plan_drive_by_picks(mg.plan_part_supply(ASSETS / "scenarios" / "storeroom.yaml"))
    assert len(found.picks) == 20
    assert sum(done.drives for done in found.picks) == 3
    for done in found.picks:
        assert done.used, done.report
        tried = done.report.splitlines()
        assert all(line.startswith("from a known motion: ") for line in tried), done.report
        assert "solved" in tried[-1]
        assert done.drive_by < 0.65 * done.stop_and_pick
    assert found.saved > 0.5 * found.stop_and_pick
    assert found.motion().duration == pytest.approx(found.drive_by, abs=1e-6)
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
    for key, value, code in (("begins", "home", "drive-by-pick"), ("ends", "lift", "discontinuous")):
        plan, _ = spoiled(content)
        plan["drive_by"]["motions"][1][key] = value
        assert code in codes(plan)
    plan, _ = spoiled(content)
    for row in plan["drive_by"]["motions"][1]["positions"]:
        row[0] += 0.05  # the base stands beside the stop
    assert "route-ends" in codes(plan)
    plan, motion = spoiled(content)
    motion["begins"] = "release"  # of nothing
    assert "drive-by-pick" in codes(plan)
    motion["begins"] = "somewhere"
    with pytest.raises(mg.InvalidInput, match="begins"):
        mg.verify_plan(plan)
    plan, motion = spoiled(content)
    motion["opening"] += 0.001
    assert [f.where for f in check_consistency(plan)] == ["drive_by.motions[0].opening"]
    plan, motion = spoiled(content)
    plan["drive_by"]["motions"].append(plan["drive_by"]["motions"][1])
    assert [f.where for f in check_consistency(plan)] == ["drive_by.motions"]


def test_a_leg_on_which_the_base_stands_is_found(content: dict[str, Any]) -> None:
    plan, _ = spoiled(content)
    assert check_consistency(plan) == []
    plan["route"][0]["poses"].insert(1, plan["route"][0]["poses"][0])
    assert [f.where for f in check_consistency(plan)] == ["route[0].poses"]


def test_the_whole_round_is_one_motion(passing: mg.part_supply.DriveByPlan) -> None:
    """As long as is said, with each part taken and let go in its turn, the arm away from home between them, and the base on the move at the first."""
    motion = passing.motion()
    done, second = passing.picks
    assert motion.duration == pytest.approx(passing.drive_by, abs=1e-6)
    assert np.allclose(motion.base_poses[0], passing.problem.start)
    assert np.allclose(motion.base_poses[-1], passing.problem.goal, atol=1e-6)
    done_with = [(e["command"], e["object"]) for e in motion.gripper]
    assert done_with == [("close", done.part), ("open", done.part), ("close", second.part), ("open", second.part)]
    closing, letting_go, again, _ = motion.gripper
    assert closing["object"] == done.part
    assert closing["time"] == pytest.approx(done.close_at)
    assert letting_go["time"] == pytest.approx(done.result.duration)
    assert again["time"] == pytest.approx(letting_go["time"] + letting_go["duration"] + second.close_at)
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
    name, second = sorted(name for name in files if name.startswith("drive_by_") and name.endswith(".csv"))
    assert (name[:12], second[:12]) == ("drive_by_00_", "drive_by_01_")
    assert files[second].read_text().startswith("time,torso_lift_joint,")
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
    done, _ = passing.picks
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
    done, _ = passing.picks
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
    # It ends over the bin: in the hand alone, between both fingers, where the hand should have it, and not moving in it while it stands.
    at_end = {
        e.b if e.a == done.part else e.a for e in run.contacts if done.part in (e.a, e.b) and e.end > run.duration - 0.1
    }
    assert at_end == set(setup.gripper.finger_links), at_end
    positions = [state["parts"][done.part][:3, 3] for state in run.states if state["time"] > run.duration - 0.9]
    assert np.ptp(positions, axis=0).max() < 0.01
    part = next(p for p in problem.trays[0].parts if p.name == done.part)
    grasp = part.grasps[small_plan.picks[0].grasp]
    x, y, theta = done.base
    T_world_hand = mg.pose([x, y, 0], rpy=[0, 0, theta]) @ problem.arm.fk(done.result.trajectory.positions[-1][3:])
    assert np.linalg.norm((T_world_hand @ np.linalg.inv(grasp.T_object_hand))[:3, 3] - positions[-1]) < 0.03
    assert max(p.displacement for name, p in run.parts.items() if name != done.part) < 0.002


def test_clock_and_report_know_of_it(
    content: dict[str, Any], passing: mg.part_supply.DriveByPlan, small_plan: mg.part_supply.ScenarioPlan
) -> None:
    done, second = passing.picks
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
    opened = timeline.state_at(done.drive_by + 0.1)  # over the bin
    assert opened.attached is not None and opened.attached[0] == done.part
    after = timeline.state_at(done.drive_by + GRIP_TIME + 0.1)  # on the way to the second, without coming home
    assert after.attached is None and done.part in after.removed
    wanted = content["drive_by"]["motions"][1]
    assert after.arm == pytest.approx(
        [np.interp(0.1, wanted["times"], c) for c in np.transpose(wanted["positions"])[3:]]
    )
    assert timeline.duration == pytest.approx(
        done.drive_by
        + second.drive_by
        + 2 * GRIP_TIME
        + small_plan.picks[1].motions[-1].trajectory.duration
        + content["route"][1]["duration"]
    )
    assert "Parts taken in passing" in report_html(content)
    assert "Parts taken in passing" not in report_html(small_plan.to_dict())


def test_it_can_be_stopped(small_plan: mg.part_supply.ScenarioPlan) -> None:
    class StopError(Exception):
        pass

    def progress(stage: str, fraction: float) -> None:
        raise StopError

    with pytest.raises(StopError):
        mg.part_supply.plan_drive_by_picks(small_plan, progress=progress)


def test_fingers_that_close_for_minutes_are_refused_before_the_round_is_planned(
    small: dict[str, Any], write: Callable[..., Path], capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """They close by twice the clearance, 20 mm: 12 s at 1.67 mm/s, 200 s at 0.1 mm/s."""
    file = write({**small, "gripper": {**small["gripper"], "closing_speed": 0.0001}})
    line = next(i for i, text in enumerate(file.read_text().splitlines(), 1) if "closing_speed" in text)
    assert main(["plan", str(file), "-o", str(tmp_path / "out"), "--drive-by"]) == 2
    said = capfd.readouterr().err.splitlines()[-1]
    assert f"{file}:{line}: gripper.closing_speed = 0.0001: fingers close for 200 s on A/bracket_00" in said
    assert "more than 11.9 s: must be at least 0.001681 m/s" in said
    assert not (tmp_path / "out").exists()
    enough = {**small["gripper"], "closing_speed": 0.0017}
    check_in_passing(mg.load_scenario(write({**small, "gripper": enough})))
