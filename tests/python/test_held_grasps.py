"""Scenarios whose parts the closing fingers do not meet are refused where they are wrong; what is left verify accepts."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
import yaml

import mmgrasp as mg

STOREROOM = Path(mg.__file__).parent / "assets" / "scenarios" / "storeroom.yaml"


def with_brackets(folder: Path, body: str) -> Path:
    """The storeroom with tray A alone, whose four targets have this body."""
    text = STOREROOM.read_text().replace("bracket: {box: [0.03, 0.05, 0.07]}", f"bracket: {{{body}}}")
    head, rest = text.split("  - name: B\n")
    path = folder / "scenario.yaml"
    path.write_text(head + "\noptions:" + rest.split("\noptions:")[1])
    return path


def parts_of(path: Path) -> list[mg.base.Part]:
    return mg.load_scenario(path).problem().trays[0].parts


def gap_of_closed_fingers() -> float:
    """Between the storeroom's two finger links, closed [m]."""
    scenario = mg.load_scenario(STOREROOM)
    problem = scenario.problem()
    robot, hand = problem.robot, problem.gripper
    bare = robot.with_disabled_pairs([pair for pair in robot.disabled_pairs if set(pair[:2]) != set(hand.finger_links)])
    arm = bare.group(base_link=robot.links[0], tip=hand.tool_link).with_reference(hand.joint_values(0.0))
    near = mg.CollisionChecker(bare, mg.World(), arm).distances((arm.sample_lower + arm.sample_upper) / 2, 0.05)
    return min(float(d) for d in near if {d.a, d.b} == set(hand.finger_links))


def test_parts_thinner_than_the_gap_of_closed_fingers_are_refused_at_their_line(tmp_path: Path) -> None:
    gap = gap_of_closed_fingers()
    assert 2e-4 < gap < 5e-3
    thin = with_brackets(tmp_path, f"cylinder: {{radius: {0.475 * gap:.6f}, length: 0.2}}")
    with pytest.raises(
        mg.InvalidInput,
        match=r"scenario.yaml:63: part_types.bracket.*has no grasp.*from both sides.*thinner than the gap",
    ):
        mg.load_scenario(thin)
    width = round(gap + 5e-4, 6)
    wide = parts_of(with_brackets(tmp_path, f"box: [{width}, 0.05, 0.07]"))[0]
    openings = {round(grasp.opening, 6) for grasp in wide.grasps}
    assert width in openings


@pytest.mark.slow
def test_grasps_that_just_touch_a_tray_do_not_refute_a_region(tmp_path: Path) -> None:
    """Thin brackets have few grasps; with the hand at 45 degrees it lies on the tray's rim, 1e-9 m away or in it."""
    scenario = mg.load_scenario(with_brackets(tmp_path, "box: [0.03, 0.001, 0.07]"))
    plan = mg.part_supply.plan_part_supply(scenario)
    assert plan.outcome == mg.Outcome.solved
    assert mg.part_supply.verify_plan(plan.to_dict()).faults == []


def test_grasps_across_the_thin_side_are_left_out_and_others_stay(tmp_path: Path) -> None:
    grasps = parts_of(with_brackets(tmp_path, "box: [0.0005, 0.05, 0.07]"))[0].grasps
    assert grasps
    assert min(grasp.opening for grasp in grasps) > 0.04


def test_others_take_the_places_of_grasps_that_are_left_out(tmp_path: Path) -> None:
    usual = parts_of(with_brackets(tmp_path, "box: [0.03, 0.05, 0.07]"))[0].grasps
    assert len(parts_of(with_brackets(tmp_path, "box: [0.0005, 0.05, 0.07]"))[0].grasps) == len(usual)


def test_listed_grasps_are_refused_at_their_entry(tmp_path: Path) -> None:
    down = mg.pose([0, 0, 0.02], rpy=[0, np.pi / 2, 0])
    xyz, rpy = [0.0, 0.0, 0.02], [0.0, 1.5707963, 0.0]
    assert np.allclose(mg.pose(xyz, rpy=rpy), down, atol=1e-6)
    listed = f"grasps: [{{pose: {{xyz: {xyz}, rpy: {rpy}}}, opening: 0.05}}, {{pose: {{xyz: {xyz}, rpy: [0, 1.5707963, 1.5707963]}}, opening: 0.0005}}]"
    with pytest.raises(mg.InvalidInput, match=r"grasps\[1\].*does not hold part type bracket.*both sides"):
        mg.load_scenario(with_brackets(tmp_path, f"box: [0.0005, 0.05, 0.07], {listed}"))


# Parts a hair thicker than the gap were planned and refused by verify: an arm stands within 0.1 mm of its grasp.
@pytest.mark.parametrize("beyond", [0.0, 1e-8, 1e-6, 1e-5, 1e-4])
def test_parts_as_thin_as_the_gap_are_refused(tmp_path: Path, beyond: float) -> None:
    radius = (gap_of_closed_fingers() + beyond) / 2
    with pytest.raises(mg.InvalidInput, match=r"has no grasp.*from both sides"):
        mg.load_scenario(with_brackets(tmp_path, f"cylinder: {{radius: {radius!r}, length: 0.2}}"))


@pytest.mark.slow
@pytest.mark.parametrize("beyond", [4.2e-4, 1e-3])
def test_thin_parts_that_are_planned_are_accepted_by_verify(tmp_path: Path, beyond: float) -> None:
    radius = (gap_of_closed_fingers() + beyond) / 2
    scenario = with_brackets(tmp_path, f"cylinder: {{radius: {radius!r}, length: 0.07}}")
    plan = mg.plan_part_supply(scenario)
    assert plan.outcome == mg.Outcome.solved
    plan.save(tmp_path / "plan.json")
    verdict = mg.verify_plan(tmp_path / "plan.json", scenario=scenario)
    assert verdict.ok, verdict.faults


def test_grippers_whose_fingers_do_not_move_apart_are_refused(tmp_path: Path) -> None:
    text = STOREROOM.read_text()
    joints = next(line for line in text.splitlines() if "right_gripper_finger_joint" in line and "open" in line)

    def refusal(changed: str) -> str:
        path = tmp_path / "scenario.yaml"
        path.write_text(changed)
        with pytest.raises(mg.InvalidInput) as caught:
            mg.load_scenario(path)
        return str(caught.value)

    closed, opened = (yaml.safe_load(text)["gripper"]["joints"][0][key] for key in ("closed", "open"))
    swapped = joints.replace(f"closed: {closed}", "closed: @").replace(f"open: {opened}", f"open: {closed}")
    swapped = swapped.replace("closed: @", f"closed: {opened}")
    still = joints.replace(f"open: {opened}", f"open: {closed}")
    assert joints not in (swapped, still)
    both_swapped = text
    for line in text.splitlines():
        if "_gripper_finger_joint, closed:" in line:
            both_swapped = both_swapped.replace(
                line, line.replace("closed: 0.0, open: 0.05", "closed: 0.05, open: 0.0")
            )
    assert "are closed and open swapped?" in refusal(both_swapped)
    left = next(line for line in text.splitlines() if "left_gripper_finger_joint" in line and "open" in line)
    assert "the finger link left_gripper_finger_link stands still" in refusal(text.replace(left + "\n", "", 1))
    assert "move the same way along closing" in refusal(text.replace(joints, swapped, 1))
    assert "must differ from closed" in refusal(text.replace(joints, still, 1))
    both = re.search(r"joints:\n(    - .*\n){2}", text)
    assert both
    assert "joints = []: must name a joint" in refusal(text.replace(both[0], "joints: []\n"))
    assert "moves 0 m along closing" in refusal(text.replace("closing: [0, 1, 0]", "closing: [0, 0, 1]"))


def test_a_part_is_no_wider_beside_the_pads() -> None:
    """A shaft of 24 mm with a cap on the palm's side of the pads, between the fingers: as wide as the shaft and 1.5 mm on either side at most."""
    setup = mg.load_scenario(STOREROOM).setup
    hand = setup.gripper
    poses = setup.robot.link_poses(hand.joint_values(0.024))
    behind = min(
        mg.LinkShape(shape.shape, np.linalg.inv(poses[hand.tool_link]) @ poses[link] @ shape.pose).bounds[0][0]
        for link in hand.finger_links
        for shape in setup.robot.collisions(link)
    )
    assert np.allclose(hand.approach, [1, 0, 0]) and behind < -hand.finger_depth / 2 - 0.01
    shaft = mg.LinkShape(mg.Box([0.08, 0.024, 0.024]), mg.pose([0.02, 0, 0]))

    def capped(width: float) -> list[mg.LinkShape]:
        return [shaft, mg.LinkShape(mg.Box([0.01, width, 0.024]), mg.pose([behind + 0.006, 0, 0]))]

    grasp = [mg.Grasp(np.eye(4), 0.024)]
    most = 0.027 + gap_of_closed_fingers()  # their faces stand so much back, both together; the arm may be 0.2 mm off
    fits = [
        mg.grasping.fingers_fit(setup.arm, hand, capped(w), grasp)[0] for w in (0.020, most - 6e-4, most + 2e-4, 0.04)
    ]
    assert fits == [True, True, False, False]
    assert mg.grasping.fingers_meet(setup.arm, hand, capped(0.04), grasp) == [True]


def test_listed_grasps_with_fingers_in_the_part_are_refused(tmp_path: Path) -> None:
    """The pads meet the shaft; what they say of its width is right, and the cap is in the fingers' way."""
    cap = "{box: [0.024, 0.06, 0.01], pose: {xyz: [0, 0, 0.045]}}"
    shapes = f"shapes: [{{box: [0.024, 0.024, 0.09]}}, {cap}]"
    grasp = "grasps: [{pose: {xyz: [0, 0, 0], rpy: [0, 1.57079633, 0]}, opening: 0.024}]"
    with pytest.raises(mg.InvalidInput, match=r"grasps\[0\].*it is wider beside the pads, fingers would stand in it"):
        mg.load_scenario(with_brackets(tmp_path, f"{shapes}, {grasp}"))
