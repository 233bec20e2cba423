"""A thumb and two fingers beside its middle around upright cans: they meet them at once, as nearly as `verify` lets them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp import verify as checks
from mmgrasp.base import Part
from mmgrasp.part_supply import plan_part_supply
from mmgrasp.scenario import Scenario, held_grasps
from test_hand_in_a_round import OMNI, PINCH, tip_middle, with_hand, written

HALF = 0.012  # half the side of a fingertip's box [m]
TOOL = "hand_tcp_cylindrical"


def of_cans(folder: Path, **options: Any) -> Path:
    """Cans of 60, 70 and 80 mm, with options of the sampler, and a block."""
    raw = with_hand(OMNI, PINCH | {"type": "cylindrical"}, TOOL)
    can = {"grasp_options": options} if options else {}
    cans = {f"can{d}": can | {"cylinder": {"radius": d / 2000, "length": 0.09}} for d in (60, 70, 80)}
    raw["part_types"] |= cans | {"block": {"box": [0.05, 0.09, 0.07]}}
    placed = [{"type": kind, "xyz": [0.0, 0.13 * k - 0.2]} for k, kind in enumerate([*cans, "block"])]
    tray = {"size": [0.3, 0.6, 0.05], "parts": placed, "targets": ["can60_00", "can70_01", "can80_02"]}
    raw["trays"] = [raw["trays"][0] | tray]
    return written(folder, raw)


@pytest.fixture(scope="module")
def scenario(tmp_path_factory: pytest.TempPathFactory) -> Scenario:
    return mg.load_scenario(of_cans(tmp_path_factory.mktemp("cans")))


def pushed(scenario: Scenario, grasp: mg.Grasp, radius: float) -> float:
    """How far an upright can is pushed along the closing axis until both sides have it [m].

    The tips' boxes stand upright, too: seen from above they are squares that close on a circle, each side as fast as the other.
    """
    setup = scenario.setup
    hand = setup.gripper
    joints = hand.joint_values(min(grasp.opening + 2 * hand.clearance, hand.max_opening))
    axes = np.vstack((hand.closing, np.cross(hand.approach, hand.closing)))
    can = axes @ np.linalg.inv(grasp.T_object_hand)[:3, 3]
    gaps: dict[float, float] = {}
    for finger in ("thumb", "finger_1", "finger_2"):
        along, across = axes @ tip_middle(setup.robot, joints, TOOL, finger) - can
        nearest = max(0.0, abs(across) - HALF)  # of the circle's points before the tip's face
        if nearest < radius:
            gap = abs(along) - HALF - np.sqrt(radius**2 - nearest**2)
            side = float(np.sign(along))
            gaps[side] = min(gap, gaps.get(side, np.inf))
    assert len(gaps) == 2
    return abs(gaps[1.0] - gaps[-1.0]) / 2


@pytest.mark.parametrize("width", [0.02, 0.05])
def test_a_shift_counts_on_the_play_that_verify_has(width: float, scenario: Scenario) -> None:
    """Beside the middle by a little less, `verify` takes the pads for the grasp's; by a little more it does not."""
    hand = scenario.setup.gripper
    box = [mg.LinkShape(mg.Box([width, width, 0.08]))]
    play = max(held_grasps._PLAY, held_grasps._SHARE * width)
    across, down = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, -1.0])
    T = np.eye(4)
    hand_axes = np.column_stack((hand.approach, hand.closing, np.cross(hand.approach, hand.closing)))
    T[:3, :3] = np.column_stack((down, across, np.cross(down, across))) @ hand_axes.T
    for by, unlike in ((0.0, False), (play - 1e-4, False), (play + 1e-4, True)):
        T[:3, 3] = by * across
        assert bool(checks.pads_unlike_grasp(hand, box, checks.CheckedGrasp(T, width))) is unlike, by


def from_above(scenario: Scenario, part: Part) -> list[mg.Grasp]:
    approach = scenario.setup.gripper.approach
    return [grasp for grasp in part.grasps if (grasp.T_object_hand[:3, :3] @ approach)[2] < -1 + 1e-9]


@pytest.mark.parametrize(
    ("kind", "radius", "most"), [("can60", 0.03, 2e-3), ("can70", 0.035, 5e-4), ("can80", 0.04, 2e-4)]
)
def test_cans_are_hardly_pushed(kind: str, radius: float, most: float, scenario: Scenario) -> None:
    """Around the middle between the pads they would be pushed by 4.3, 3.5 and 3.0 mm; the narrowest was not to be had at all."""
    part = next(part for part in scenario.trays[0].tray.parts if kind in part.name)
    grasps = from_above(scenario, part)
    assert len(grasps) >= 8
    in_the_middle = (radius - np.sqrt(radius**2 - (0.033 - HALF) ** 2)) / 2
    assert in_the_middle > 2.9e-3
    for grasp in grasps:
        assert pushed(scenario, grasp, radius) < most
        T = grasp.T_object_hand.copy()
        T[:3, 3] -= (T[:3, 3] @ T[:3, :3] @ scenario.setup.gripper.closing) * T[:3, :3] @ scenario.setup.gripper.closing
        assert pushed(scenario, mg.Grasp(T, grasp.opening), radius) == pytest.approx(in_the_middle, abs=1e-4)


def test_blocks_stay_in_the_middle(scenario: Scenario) -> None:
    part = next(part for part in scenario.trays[0].tray.parts if "/block" in part.name)
    closing = scenario.setup.gripper.closing
    off = [abs(grasp.T_object_hand[:3, 3] @ grasp.T_object_hand[:3, :3] @ closing) for grasp in part.grasps]
    assert len(off) > 20 and max(off) < 1e-9


@pytest.mark.slow
def test_cans_taken_from_above_are_planned_and_verified(tmp_path: Path) -> None:
    path = of_cans(tmp_path, approach_direction=[0, 0, -1])
    plan = plan_part_supply(mg.load_scenario(path))
    assert plan.outcome == mg.Outcome.solved, plan
    assert len(plan.picks) == 3
    for pick in plan.picks:
        grasp = plan.scenario.trays[pick.tray].tray.parts[pick.part].grasps[pick.grasp]
        assert np.linalg.norm(grasp.T_object_hand[:2, 3]) > 2e-3  # beside the can's axis
    verdict = mg.verify_plan(plan.save(tmp_path / "plan.json"), scenario=path, samples=100)
    assert verdict.ok, verdict.faults
