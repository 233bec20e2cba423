"""Cans that a camera saw, taken from the side by thumb and two fingers: planned, verified by the pads of the fingertips, held in physics."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import mmgrasp as mg
from mmgrasp import sim
from mmgrasp.part_supply import ScenarioPlan, plan_part_supply
from test_hand_in_a_round import PINCH, SCANNED, lifted, with_hand

try:
    import mujoco
except ImportError:
    mujoco = None

pytestmark = pytest.mark.slow

LENGTH, FLOOR = 0.18, np.array([1.68, 0.0, 0.756])
RADII = {-0.20: 0.04, 0.02: 0.035, 0.22: 0.03}  # by the place along the tray
OPTIONS = {"max_tilt": 1.6, "plane_tolerance": 0.004, "samples": 3000}


def scenario(folder: Path, options: dict[str, float]) -> Path:
    raw = with_hand(SCANNED, PINCH | {"type": "cylindrical"}, "hand_tcp_cylindrical")
    raw["part_types"] = {f"can {y}": {"cylinder": {"radius": r, "length": LENGTH}} for y, r in RADII.items()}
    rendered = {"parts": [{"type": f"can {y}", "xyz": [0.0, y]} for y in RADII]}
    scan = {"rendered": rendered} | ({"grasp_options": options} if options else {})
    raw["trays"] = [raw["trays"][0] | {"size": [0.3, 0.6, 0.04], "scan": scan}]
    path = folder / "cans.yaml"
    path.write_text(yaml.safe_dump(raw))
    return path


@pytest.fixture(scope="module")
def plan(own_cache: None, tmp_path_factory: pytest.TempPathFactory) -> ScenarioPlan:
    return plan_part_supply(mg.load_scenario(scenario(tmp_path_factory.mktemp("cans"), OPTIONS)))


@pytest.fixture(scope="module")
def content(plan: ScenarioPlan) -> dict[str, Any]:
    raw: dict[str, Any] = json.loads(json.dumps(plan.to_dict()))
    return raw


def faults(content: dict[str, Any], change: Callable[[dict[str, Any]], None] = lambda content: None) -> set[str]:
    changed = copy.deepcopy(content)
    change(changed)
    return {fault.code for fault in mg.verify_plan(changed, samples=20).faults}


def picked(content: dict[str, Any]) -> dict[str, Any]:
    """The grasp of the first pick."""
    pick = content["picks"][0]
    part = next(p for p in content["scenario"]["parts"] if p["name"] == pick["part"])
    grasp: dict[str, Any] = part["grasps"][pick["grasp"]]
    return grasp


def test_all_cans_are_planned_and_verified(plan: ScenarioPlan, content: dict[str, Any]) -> None:
    assert plan.outcome == mg.Outcome.solved, plan
    assert len(plan.picks) == 3
    verdict = mg.verify_plan(content, samples=100)
    assert verdict.ok, verdict.faults
    assert all(rate.good == rate.samples for rate in verdict.rates)


def test_verify_rates_by_the_pads_of_the_fingertips(content: dict[str, Any]) -> None:
    """Two pads in the hand's middle are no measure of it; another probability or width than the map's are refused."""

    def unlike(content: dict[str, Any]) -> None:
        grasp = picked(content)
        grasp["probability"] = grasp["quality"] = grasp["probability"] - 0.15

    def wider(content: dict[str, Any]) -> None:
        picked(content)["opening"] += 0.006

    def aside(content: dict[str, Any]) -> None:
        """The hand stands 6 mm off along its closing axis."""
        grasp = picked(content)["pose"]
        T = mg.pose(grasp["xyz"], quat_xyzw=grasp["quat_xyzw"])
        grasp["xyz"] = (T[:3, 3] + 0.006 * T[:3, :3] @ content["scenario"]["gripper"]["closing"]).tolist()

    def two_pads(content: dict[str, Any]) -> None:
        del content["scenario"]["scans"][0]["fingertips"]

    assert content["scenario"]["scans"][0]["fingertips"] is True
    assert not faults(content)
    assert "grasp-probability" in faults(content, unlike)
    assert "grasp-opening" in faults(content, wider)
    assert "grasp-opening" in faults(content, aside)
    assert "grasp-probability" in faults(content, two_pads)


def test_a_clearance_wider_than_the_hand_opens_is_judged_as_far_as_it_opens(
    own_cache: None, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """Cans of 70 and 80 mm and 30 mm on either side: the hand opens 106 mm."""
    path = scenario(tmp_path, OPTIONS)
    raw = yaml.safe_load(path.read_text())
    raw["gripper"]["clearance"] = 0.03
    path.write_text(yaml.safe_dump(raw))
    plan = plan_part_supply(mg.load_scenario(path))
    assert "gripper.clearance: 0.03 m is more than" in caplog.text
    assert plan.outcome == mg.Outcome.solved, plan
    assert not faults(json.loads(json.dumps(plan.to_dict())))


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("finger_links", ["hand_palm", "hand_thumb_tip"], r"finger_links\[0\].*must have a shape and move"),
        ("finger_links", ["hand_thumb_tip", "no such"], r"finger_links\[1\].*the robot has no such link"),
        ("tool_link", "no such", "tool_link.*the robot has no such link"),
        ("openings", None, "openings is missing"),
    ],
)
def test_a_hand_without_such_pads_is_told(key: str, value: Any, said: str, content: dict[str, Any]) -> None:
    changed = copy.deepcopy(content)
    gripper = changed["scenario"]["gripper"]
    del gripper[key]
    if value is not None:
        gripper[key] = value
    with pytest.raises(mg.InvalidInput, match=said):
        mg.verify_plan(changed, samples=10)


@pytest.mark.skipif(mujoco is None, reason="MuJoCo is not installed (pip install 'mmgrasp[sim]')")
def test_the_cans_themselves_stay_in_the_hand(plan: ScenarioPlan) -> None:
    """Approach, closing and lift at the cans as they are, which the planner never saw: pushed by less than 1 mm, and held by fingertips alone."""
    for pick in plan.picks:
        seen = plan.scenario.trays[pick.tray].tray.parts[pick.part].T_world_part[:3, 3]
        y = min(RADII, key=lambda y: abs(float(seen[1]) - y))
        stands = mg.pose(FLOOR + [0, y, 0.001 + LENGTH / 2])
        part = sim.SimPart("can", [mg.LinkShape(mg.Cylinder(RADII[y], LENGTH))], stands, mass=0.3)
        result = lifted(plan, pick, part)
        moved = result.parts["can"]
        assert moved.grasped, moved.cause
        assert moved.displacement < 1e-3 and moved.slip < 1e-3
        touching = {e.b if e.a == "can" else e.a for e in result.contacts if e.end > result.duration - 0.05}
        assert (
            "hand_thumb_tip" in touching
            and 2 <= len(touching)
            and touching <= set(plan.scenario.setup.gripper.finger_links)
        )


def test_a_can_without_a_grasp_says_which_options_help(own_cache: None, tmp_path: Path) -> None:
    """The hand comes from above by default, where no can of this length and width is to be had; what is proposed is taken."""
    with pytest.raises(
        mg.InvalidInput, match=r"object_\d has no grasp: .*; with grasp_options: \{.*\} it has \d+"
    ) as no:
        mg.load_scenario(scenario(tmp_path, {}))
    proposed = yaml.safe_load(str(no.value).split("grasp_options: ")[1].split("}")[0] + "}")
    name = str(no.value).split("part mixed/")[1].split(" ")[0]
    path = scenario(tmp_path, proposed)
    raw = yaml.safe_load(path.read_text())
    raw["trays"][0]["targets"] = [name]
    path.write_text(yaml.safe_dump(raw))
    assert mg.load_scenario(path).trays[0].targets == [f"mixed/{name}"]
