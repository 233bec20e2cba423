"""Round parts and boxes that lean, which lie in a tray: grasps straight down are drawn for the pose they lie in."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from conftest import edited
from flat_parts import PAD, box, low_tray, prism
from mmgrasp.scenario.straight_down import MIN_STRAIGHT, MOST_ADDED
from round_parts import ball, bolt, bolt_pitch, drawn_round_part, rod

TILT = math.radians(15)
PARTS: dict[str, tuple[dict[str, Any], str, list[float]]] = {
    "rod": ({"mesh": "part.stl"}, rod(0.010, 0.12, 48), [0.3, 0.0, 0.4]),
    "bolt": ({"mesh": "part.stl"}, bolt(0.005, 0.07, 0.009, 32), [1.0, bolt_pitch(0.005, 0.07, 0.009), -0.7]),
    "ball": ({"mesh": "part.stl"}, ball(0.02, 30), [0.2, 0.5, 0.1]),
    "box that leans": ({"mesh": "part.stl"}, prism(box([0.06, 0.04, 0.02]), 0.02), [TILT, 0.0, 0.9]),
    "box that leans, as a shape": ({"box": [0.06, 0.04, 0.02]}, "", [TILT, 0.0, 0.9]),
    "cylinder that lies": ({"cylinder": {"radius": 0.012, "length": 0.12}}, "", [0.0, 1.5708, 0.4]),
}


def straight_down(part: mg.base.Part, hand: mg.Hand) -> list[mg.Grasp]:
    """Grasps whose approach is down to within a milliradian and whose tips stay above the tray's floor, for a tray that is level and low."""
    floor = 0.706
    found = []
    for grasp in part.grasps:
        T = part.T_world_part @ grasp.T_object_hand
        approach = T[:3, :3] @ hand.approach
        angle = math.atan2(math.hypot(approach[0], approach[1]), -approach[2])
        if angle <= 1.01e-3 and T[2, 3] - PAD / 2 >= floor:
            found.append(grasp)
    return found


def one_part(name: str, storeroom: dict[str, Any], write: Callable[..., Path], **options: Any) -> Path:
    """A scenario with one of PARTS in the low tray."""
    part, mesh, rpy = PARTS[name]
    more = {"grasp_options": options} if options else {}
    path = write(low_tray(storeroom, {**part, **more}, {"xyz": [0.0, 0.0], "rpy": rpy}))
    if mesh:
        (path.parent / "part.stl").write_text(mesh)
    return path


@pytest.mark.parametrize("name", PARTS)
def test_parts_that_lie_have_grasps_straight_down(
    name: str, storeroom: dict[str, Any], write: Callable[..., Path]
) -> None:
    scenario = mg.load_scenario(one_part(name, storeroom, write))
    part = scenario.trays[0].tray.parts[0]
    assert len(straight_down(part, scenario.setup.gripper)) >= MIN_STRAIGHT
    assert len(part.grasps) <= 200
    qualities = [grasp.quality for grasp in part.grasps]
    assert qualities == sorted(qualities, reverse=True)


@pytest.mark.parametrize("most", [1, 5, 60])
def test_no_more_grasps_than_were_asked_for(most: int, storeroom: dict[str, Any], write: Callable[..., Path]) -> None:
    scenario = mg.load_scenario(one_part("rod", storeroom, write, max_grasps=most))
    part = scenario.trays[0].tray.parts[0]
    assert len(part.grasps) == most
    assert len(straight_down(part, scenario.setup.gripper)) >= min(most, MIN_STRAIGHT)
    assert len(straight_down(part, scenario.setup.gripper)) <= MIN_STRAIGHT + MOST_ADDED


def test_the_same_pose_has_the_same_grasps(storeroom: dict[str, Any], write: Callable[..., Path]) -> None:
    """Parts of a type that differ by their heading share them, and reading again gives them again."""
    path = one_part("rod", storeroom, write)
    values = low_tray(storeroom, {"mesh": str(path.parent / "part.stl")}, {"xyz": [-0.07, 0.0], "rpy": [0.3, 0.0, 1.5]})
    values["trays"][0]["parts"].append({"type": "flat", "xyz": [0.07, 0.0], "rpy": [0.3, 0.0, 1.7]})
    first, second = mg.load_scenario(write(values)).trays[0].tray.parts
    (again,) = mg.load_scenario(path).trays[0].tray.parts
    for other in (second, again):
        assert len(other.grasps) == len(first.grasps)
        for a, b in zip(first.grasps, other.grasps, strict=True):
            np.testing.assert_array_equal(a.T_object_hand, b.T_object_hand)


def test_listed_grasps_and_wanted_directions_stay_as_they_are(
    storeroom: dict[str, Any], write: Callable[..., Path]
) -> None:
    across = {"pose": {"xyz": [0, 0, 0], "rpy": [0.0, 0.0, 0.0]}, "opening": 0.04}
    listed = low_tray(storeroom, {"box": [0.06, 0.04, 0.02], "grasps": [across]}, {"xyz": [0, 0], "rpy": [TILT, 0, 0]})
    (part,) = mg.load_scenario(write(listed)).trays[0].tray.parts
    assert len(part.grasps) == 1
    scenario = mg.load_scenario(one_part("rod", storeroom, write, approach_direction=[0.0, 1.0, 0.0]))
    (part,) = scenario.trays[0].tray.parts
    assert part.grasps
    for grasp in part.grasps:
        np.testing.assert_allclose(grasp.T_object_hand[:3, :3] @ scenario.setup.gripper.approach, [0, 1, 0], atol=1e-3)


@pytest.mark.parametrize(
    ("change", "pieces"),
    [
        ({"approach_direction": [0.0, 0.0, -2.0]}, ["approach_direction", "must be 1"]),
        ({"approach_direction": [0.0, 0.0]}, ["approach_direction", "list of 3 numbers"]),
        ({"approach_direction": -1}, ["approach_direction", "must be a list"]),
        ({"approach_directions": [0.0, 0.0, -1.0]}, ["did you mean approach_direction?"]),
        ({"approach_direction": [0.0, 0.8, 0.6]}, ["approach_direction", "no grasp: without it there are"]),
        ({"standoff": 10}, ["grasp_options.standoff = 10", "no grasp: without it there are"]),
        ({"standoff": 10, "approach_direction": [0.0, 0.8, 0.6]}, ["no grasp: without these options there are"]),
    ],
)
def test_bad_directions_are_refused_at_their_line(
    change: dict[str, Any], pieces: list[str], storeroom: dict[str, Any], write: Callable[..., Path]
) -> None:
    wide = {"box": [0.2, 0.05, 0.05], "grasp_options": change}  # the hand takes it along neither of its edges
    path = write(low_tray(storeroom, wide, {"xyz": [0.0, 0.0]}))
    with pytest.raises(mg.InvalidInput, match=r"scenario\.yaml:\d+: part_types\.flat\.grasp_options") as told:
        mg.load_scenario(path)
    for piece in pieces:
        assert piece in str(told.value)


def test_options_beside_listed_grasps_are_refused(small: dict[str, Any], write: Callable[..., Path]) -> None:
    down = {"pose": {"xyz": [0, 0, 0.01], "rpy": [0, 1.570796, 0]}, "opening": 0.05}
    both = {"box": [0.03, 0.05, 0.07], "grasps": [down], "grasp_options": {"approaches": 6}}
    with pytest.raises(mg.InvalidInput, match=r"scenario\.yaml:\d+: part_types\.bracket\.grasp_options: .*listed"):
        mg.load_scenario(write(edited(small, "part_types.bracket", both)))


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2, 3, 4])
def test_drawn_parts_are_picked(
    seed: int, storeroom: dict[str, Any], tmp_path: Path, write: Callable[..., Path]
) -> None:
    """A bolt, a ball, a box that leans and a rod, by the default plan, which verify accepts."""
    _, part, where = drawn_round_part(seed, tmp_path)
    path = write(low_tray(storeroom, {"mesh": str(tmp_path / part["mesh"])}, where))
    plan = mg.plan_part_supply(path)
    assert plan.outcome == mg.Outcome.solved, plan
    assert mg.verify_plan(plan.to_dict(), scenario=path, samples=100).faults == []
    document = plan.to_dict()
    assert document["premises"]["grasps"] == len(plan.scenario.trays[0].tray.parts[0].grasps)
