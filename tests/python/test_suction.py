"""Hands of suction cups: a scenario's section, parts that they do not hold, plans and their independent check."""

from __future__ import annotations

import copy
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import mmgrasp as mg
from conftest import ASSETS, REMOVE, edited
from mmgrasp.cli.commands import report_page
from mmgrasp.grasping import Suction, SuctionCup, sample_suction_grasps, seal_gap, suction_share

Write = Callable[..., Path]
SCENARIO = ASSETS / "scenarios" / "suction_cell.yaml"


@pytest.fixture(scope="module")
def cell() -> dict[str, Any]:
    """The shipped scenario with one part to pick in each tray."""
    raw: dict[str, Any] = yaml.safe_load(SCENARIO.read_text())
    raw["trays"][0]["targets"] = {"panel": 1}
    raw["trays"][1]["targets"] = [2]
    raw["reach"] = {"samples": 500_000}
    return raw


@pytest.fixture(scope="module")
def planned(cell: dict[str, Any], write: Write) -> tuple[Path, mg.part_supply.ScenarioPlan]:
    path = write(cell, "cups.yaml")
    plan = mg.plan_part_supply(path)
    assert plan.outcome == mg.Outcome.solved, plan.obstructions
    return path, plan


def test_the_plan_holds(planned: tuple[Path, mg.part_supply.ScenarioPlan]) -> None:
    path, plan = planned
    content = plan.to_dict()
    assert content["scenario"]["gripper"]["suction"]["cups"][0] == {"xyz": [0.0, 0.03, 0.0], "radius": 0.0175}
    assert all(motion["opening"] == 0 for pick in content["picks"] for motion in pick["motions"])
    assert mg.verify_plan(content, scenario=path, samples=200).faults == []
    assert mg.plan_part_supply(path, threads=1).to_dict() == content


def test_grasps_seal_by_the_closed_form(planned: tuple[Path, mg.part_supply.ScenarioPlan]) -> None:
    """Every listed grasp of a box has its rims' planes 0.2 mm before a face and the rims within it."""
    _, plan = planned
    part = next(p for p in plan.scenario.trays[0].tray.parts if p.target)
    half = np.array([0.12, 0.16, 0.05]) / 2
    assert part.mass == 1.1 and len(part.grasps) > 20
    for grasp in part.grasps:
        axis = grasp.T_object_hand[:3, 0]
        face = int(np.argmax(np.abs(axis)))
        assert abs(abs(axis[face]) - 1) < 1e-6
        for y in (0.03, -0.03):
            middle = (grasp.T_object_hand @ [0, y, 0, 1])[:3]
            assert abs(middle[face]) - half[face] == pytest.approx(2e-4, abs=2e-6)
            others = [i for i in range(3) if i != face]
            assert (np.abs(middle[others]) + 0.0175 <= half[others] + 1e-6).all()


def test_parts_stay_on_the_cups_while_they_move(planned: tuple[Path, mg.part_supply.ScenarioPlan]) -> None:
    """Against the makers' load cases, on the motions themselves: pull along and across the cups, by differences."""
    _, plan = planned
    setup = plan.scenario.setup
    suction = setup.gripper.suction
    assert suction is not None
    for pick in plan.picks:
        part = plan.scenario.trays[pick.tray].tray.parts[pick.part]
        centre = np.linalg.inv(part.grasps[pick.grasp].T_object_hand)[:3, 3]  # both types are centred
        for motion in (m for m in pick.motions if m.attached):
            t = motion.trajectory
            q = t.positions
            middle = np.array([(setup.arm.fk(x) @ [*centre, 1])[:3] for x in q])
            velocity = np.gradient(middle, t.times, axis=0)
            acceleration = np.gradient(velocity, t.times, axis=0)
            for x, a in zip(q, acceleration, strict=True):
                pull = part.mass * setup.arm.fk(x)[:3, :3].T @ (np.array([0, 0, -9.80665]) - a)
                along, across = pull[0], np.linalg.norm(pull[1:])
                assert suction.safety * (along + across / suction.friction) <= 1.02 * suction.force


@pytest.mark.parametrize(
    ("keys", "value", "message"),
    [
        ("part_types.panel.mass", REMOVE, "has no mass .kg., which a hand of suction cups must know"),
        ("part_types.panel.mass", 2.9, r"weighs 2.9 kg, the cups, of 115.5 N, hold 2\.\d+ kg of it"),
        ("part_types.panel.mass", 3.5, "weighs more than the gripper's payload, 3 kg"),
        ("part_types.panel.box", [0.06, 0.06, 0.06], "too small or too curved for the suction cups"),
        ("part_types.tin", {"sphere": 0.045, "mass": 0.3}, "too small or too curved for the suction cups"),
        ("gripper.suction.cups", [], "must be from 1 to 100 cups"),
        ("gripper.suction.cups", [{"radius": 0.01}] * 101, "must be at most 100 cups"),
        ("gripper.suction.cups.0.radius", 0, "must be > 0"),
        ("gripper.suction.cups.0.radius", 9e-4, "0.001"),
        ("gripper.suction.cups.0.radius", 1.1, "1"),
        ("gripper.suction.cups.0.xyz", [0, 11, 0], "10"),
        ("gripper.suction.vacuum", 0.9, "1"),
        ("gripper.suction.max_gap", 0.11, "0.1"),
        ("gripper.suction.friction", 0.009, "0.01"),
        ("gripper.suction.safety", 101, "100"),
        ("gripper.suction.cups.0.xyz", [0.01, 0, 0], "rims lie in the plane through its origin"),
        ("gripper.suction.vacuum", 2e5, "110000"),
        ("gripper.suction.max_gap", 1e-4, "0.0004"),
        ("gripper.suction.friction", 20, "10"),
        ("gripper.suction.safety", 0.5, "safety"),
        ("gripper.cup_links", ["cup"], "no such link"),
        ("gripper.cup_links", ["forearm_link"], "does not move with the tool frame"),
        ("gripper.closing", [0, 1, 0], "closing"),
        ("robot.frames.0.pose.xyz", [0.16, 0, 0], None),
        ("robot.frames.0.shapes.2.pose.xyz", [-0.008, 0.03, 0], "2 mm past the plane of the rims"),
        ("padding", {"objects": 0.001}, "must be left out"),
        ("part_types.panel.grasps", [{"pose": {"xyz": [0, 0, 0.1]}}], "do not seal on part type panel: cup 0"),
        ("part_types.panel.grasps", [{"pose": {"xyz": [0, 0, 0]}, "opening": 0.1}], "opening"),
        ("part_types.panel.grasp_options", {"approaches": 3}, "approaches"),
        ("part_types.panel.grasp_options", {"turns": 0}, "turns"),
    ],
)
def test_what_cups_do_not_hold_is_refused(
    cell: dict[str, Any], write: Write, keys: str, value: Any, message: str | None
) -> None:
    path = write(edited(cell, keys, value), "refused.yaml")
    if message is None:
        mg.load_scenario(path)
        return
    with pytest.raises(mg.InvalidInput, match=message) as error:
        mg.load_scenario(path)
    assert "refused.yaml:" in str(error.value)  # with the line


def test_a_payload_counts_for_fingers_too(small: dict[str, Any], write: Write) -> None:
    raw = copy.deepcopy(small)
    raw["gripper"]["payload"] = 0.5
    kind = raw["trays"][0]["parts"]["type"]
    raw["part_types"][kind]["mass"] = 0.4
    assert mg.load_scenario(write(raw)).setup.gripper.payload == 0.5
    raw["part_types"][kind]["mass"] = 0.6
    with pytest.raises(mg.InvalidInput, match=r"weighs more than the gripper's payload, 0\.5 kg"):
        mg.load_scenario(write(raw))


def faults(content: dict[str, Any]) -> set[str]:
    return {fault.code for fault in mg.verify_plan(content, samples=20).faults}


def test_broken_plans_are_seen(planned: tuple[Path, mg.part_supply.ScenarioPlan]) -> None:
    content = planned[1].to_dict()
    gripper = content["scenario"]["gripper"]
    pick = content["picks"][0]
    part = next(k for k, p in enumerate(content["scenario"]["parts"]) if p["name"] == pick["part"])
    at = f"scenario.parts.{part}"
    pose = content["scenario"]["parts"][part]["grasps"][0]["pose"]
    off = {**pose, "xyz": [x + 0.002 for x in pose["xyz"]]}
    wide = [{"xyz": cup["xyz"], "radius": 0.05} for cup in gripper["suction"]["cups"]]
    for keys, value, code in (
        (f"{at}.grasps.0.pose", off, "no-seal"),
        ("scenario.gripper.suction.cups", wide, "no-seal"),
        ("scenario.gripper.suction.max_gap", 1e-4, "no-seal"),
        (f"{at}.mass", 3.1, "payload"),
        ("scenario.gripper.payload", 1.0, "payload"),
        ("scenario.gripper.suction.vacuum", 2e4, "payload"),
        ("scenario.gripper.suction.safety", 9.0, "payload"),
        (f"{at}.mass", REMOVE, "malformed"),
        ("scenario.gripper.max_opening", 0.1, "malformed"),
        ("scenario.gripper.suction", None, "malformed"),
    ):
        try:
            found = faults(edited(content, keys, value))
        except mg.InvalidInput:
            found = {"malformed"}
        assert code in found, keys


def test_a_motion_too_fast_for_the_cups_is_seen(planned: tuple[Path, mg.part_supply.ScenarioPlan]) -> None:
    content = planned[1].to_dict()
    transfer = next(m for m in content["picks"][0]["motions"] if m["kind"] == "transfer")
    for k in (1, 2, 3):
        content["scenario"]["arm"][("velocity_limits", "acceleration_limits", "velocity_limits")[k - 1]] = [1e3] * 6
    transfer["times"] = [t / 6 for t in transfer["times"]]
    transfer["velocities"] = [[6 * v for v in row] for row in transfer["velocities"]]
    transfer["accelerations"] = [[36 * a for a in row] for row in transfer["accelerations"]]
    assert "payload" in faults(content)


def test_written_from_objects_it_is_the_same(planned: tuple[Path, mg.part_supply.ScenarioPlan], tmp_path: Path) -> None:
    from mmgrasp.base import write_plan
    from mmgrasp.part_supply import read_plan

    scenario, plan = planned[1].scenario, planned[1].plan
    write_plan(scenario.problem(), scenario.reach_database(), plan, tmp_path / "plan.json", name="a", source="b")
    mine, own = read_plan(tmp_path / "plan.json")["scenario"], planned[1].to_dict()["scenario"]
    assert mine["gripper"]["suction"] == own["gripper"]["suction"]
    assert mine["gripper"]["payload"] == 3.0
    assert [p["mass"] for p in mine["parts"]] == [p["mass"] for p in own["parts"]]


def test_reports_and_films_know_cups(planned: tuple[Path, mg.part_supply.ScenarioPlan], tmp_path: Path) -> None:
    assert "<td>2, 115.5 N together</td>" in report_page(planned[1].to_dict(), tmp_path, [])


def test_calls_in_python() -> None:
    suction = Suction([SuctionCup([0, 0, 0], 0.02)], max_gap=0.001)
    assert suction.force == pytest.approx(6e4 * math.pi * 4e-4)
    ball = [mg.LinkShape(mg.Sphere(0.3))]
    T = mg.pose([0, 0, 0.3], rpy=[math.pi, 0, 0])
    assert seal_gap(ball, T, [0, 0, 1], suction) == pytest.approx(0.3 - math.sqrt(0.09 - 4e-4), abs=3e-5)
    assert suction_share(suction, [0, 0, 1], 1.0, [0, 0, 0]) == pytest.approx(
        2 * 9.80665 * math.sqrt(5) / suction.force
    )
    hand = mg.Hand.of_cups("cup", approach=[0, 0, 1], suction=suction)
    found = sample_suction_grasps(ball, hand, 0.1, turns=2, surface_samples=10)
    assert len(found.grasps) > 20 and found.too_heavy == 0
    with pytest.raises(mg.InvalidInput, match="suction cups"):
        mg.grasping.sample_grasps(ball, hand)
