"""What soft fingers hold: weights from meshes, loads of operations, and which segment an assembly prefers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp.gripper_design import (
    AssemblyGrasp,
    AssemblyOperation,
    FingerGrip,
    GripperActuator,
    HeldLoad,
    HoldingRequirement,
    PlacedMesh,
    SegmentRequirement,
    centric_grasps,
    flat_contact,
    grasp_holding,
    held_load,
    jaw_grasps,
    line_contact,
    operation_load,
    preferred_grippers,
    soft_finger_torque,
)
from mmgrasp.grippers import load_assembly, plan_grippers
from mmgrasp.grippers.turned_parts import block, turned

AT_HOME = np.eye(4)
GRAVITY = 9.81  # [m/s2]
LIGHT = HoldingRequirement(FingerGrip(), density=1000)


def mass_and_centre(*parts: PlacedMesh) -> tuple[float, np.ndarray]:
    load = operation_load(AssemblyOperation(list(parts), [], [AT_HOME]), LIGHT)
    assert load.weights[0] == pytest.approx([0, 0, -load.mass * GRAVITY])
    return load.mass, load.centre


def test_mass_is_volume_times_density_wherever_parts_stand() -> None:
    left = PlacedMesh("left", block([0.02, 0.02, 0.02]), mg.pose([-0.1, 0, 0]))
    right = PlacedMesh("right", block([0.02, 0.02, 0.06]), mg.pose([0.1, 0, 0.2], rpy=[0.3, 0.2, 0.1]))
    mass, centre = mass_and_centre(left, right)
    assert mass == pytest.approx(0.008 + 0.024)
    assert centre == pytest.approx([0.05, 0, 0.15])
    cone = turned([[0.0, 0.0], [0.03, 0.0], [0.0, 0.04]])
    assert mass_and_centre(PlacedMesh("cone", cone))[1] == pytest.approx([0, 0, 0.01], abs=1e-12)
    sheet = mg.Mesh.from_arrays([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    with pytest.raises(mg.InvalidInput, match="'sheet': must be a closed mesh"):
        mass_and_centre(PlacedMesh("sheet", sheet))


def test_contacts_from_python_are_those_of_the_library() -> None:
    assert flat_contact(1, 1).torsion_radius == pytest.approx((np.sqrt(2) + np.log(1 + np.sqrt(2))) / 6)
    assert line_contact(20, 0.02, 0.01, pad_width=0.015, modulus=3e6, pad_radius=0.02).area == pytest.approx(1.5e-4)
    assert soft_finger_torque(50, 0.5, 0.004, 15) == pytest.approx(0.08)
    with pytest.raises(mg.InvalidInput, match="friction"):
        FingerGrip(friction=0)


def test_grasps_know_by_how_much_their_pads_overlap() -> None:
    options: dict[str, Any] = {"min_contact": 0.003, "pad_length": 0.02, "finger_width": 0.012}
    wide = jaw_grasps(block([0.02, 0.06, 0.06]), **options)
    assert {round(g.contact_length, 6) for g in wide} == {0.003, 0.01, 0.02}
    # Along an edge of the face the overlap is the whole width of the finger.
    straight = [g for g in wide if np.isclose(np.abs(g.T_active_tool[:3, 2]).max(), 1)]
    assert straight and all(g.contact_width == pytest.approx(0.012) for g in straight)
    narrow = [g for g in jaw_grasps(block([0.02, 0.008, 0.06]), **options) if abs(g.T_active_tool[2, 2]) > 0.999]
    across = [g for g in narrow if abs(g.T_active_tool[0, 0]) > 0.999]
    assert across and all(g.contact_width == pytest.approx(0.008) for g in across)
    round_ones = centric_grasps(np.eye(4), 0.02, -0.01, 0.01, **options)
    assert {round(g.contact_length, 6) for g in round_ones} == {0.003, 0.01, 0.02}


def grasp_above(x: float) -> AssemblyGrasp:
    """Two jaws from above, closing along y, at x."""
    T = np.diag([1.0, -1.0, -1.0, 1.0]) @ mg.pose([0, 0, 0], rpy=[0, 0, np.pi / 2])
    T[:3, 3] = [x, 0, 0]
    return AssemblyGrasp(T, opening=0.02, contact_length=0.01, contact_width=0.012)


def test_an_insertion_beside_the_fingers_bears_on_them_unevenly() -> None:
    """P1 figure 5.16 b5: a lever with its hole at one end, held over the hole and 50 mm beside it."""
    lever, way = PlacedMesh("lever", block([0.14, 0.02, 0.02])), [mg.pose([0, 0, 0.1]), AT_HOME]
    step = AssemblyOperation([lever], [], way, name="s", insertion_force=12.0, hole=[0.05, 0, -0.01])
    load = operation_load(step, LIGHT)
    over, beside = held_load(grasp_above(0.05), load), held_load(grasp_above(0.0), load)
    assert over.insertion_moment == pytest.approx(0, abs=1e-12)
    assert beside.insertion_moment == pytest.approx(12 * 0.05)
    assert load.resistance == pytest.approx([0, 0, 12])
    assert load.weights[0] == pytest.approx([0, 0, -0.056 * GRAVITY])
    # Both are also carried: the one beside the centre of mass needs torsion for that.
    carried = grasp_holding(grasp_above(0.05), FingerGrip(), weight=load.weights[0], centre=load.centre)
    assert over.safety <= carried.safety


def test_gravity_turns_with_parts_that_turn_on_their_way() -> None:
    bar = PlacedMesh("bar", block([0.14, 0.02, 0.02]))
    turned_over = mg.pose([0, 0, 0.1], rpy=[0, np.pi / 2, 0])
    load = operation_load(AssemblyOperation([bar], [], [turned_over, AT_HOME]), LIGHT)
    assert abs(load.weights[0][0]) == pytest.approx(abs(load.weights[1][2]))
    assert load.weights[0][2] == pytest.approx(0, abs=1e-12)


def test_preferred_grippers_take_better_segments() -> None:
    asked = [SegmentRequirement("a", 0.02), SegmentRequirement("a", 0.025), SegmentRequirement("b", 0.022)]
    drives = [GripperActuator("jaws", 0.01)]
    assert preferred_grippers(asked, [0, 1, 0], drives).requirement_of_part == [1, 2]
    assert preferred_grippers(asked, [1, 0, 0], drives).requirement_of_part == [0, 2]
    with pytest.raises(mg.InvalidInput, match="values"):
        preferred_grippers(asked, [1.0], drives)


PEG = """
format: mmgrasp-assembly
version: 1
name: peg
unit: mm
parts:
  - {{name: table, box: [120, 120, 10], pose: {{xyz: [0, 0, -5]}}}}
  - {{name: peg, turned: [[0, 0], [12, 0], [12, 14], [6, 14], [6, 50], [0, 50]]}}
order:
  - {{part: peg, onto: [table], from: {{xyz: [0, 0, 60]}}, insertion: {insertion}}}
actuators:
  - {{name: chuck, fingers: 3, stroke: 12}}
fingers: {{width: 10, thickness: 6, min_contact: 2}}
holding: {holding}
"""


@pytest.mark.slow
def test_an_assembly_file_asks_for_what_is_held(tmp_path: Path) -> None:
    file = tmp_path / "peg.yaml"
    file.write_text(PEG.format(insertion="{force: 20}", holding="{force: 40, modulus: 3}"))
    plan = plan_grippers(load_assembly(file))
    assert plan.solved and plan.result is not None
    taken = plan.holdings[plan.result.requirement_of_part[0]]
    assert isinstance(taken, HeldLoad) and taken.safety >= 1
    assert taken.insertion_moment == pytest.approx(0, abs=1e-4)  # the hole's axis is the peg's
    held = [h for h in plan.holdings if h is not None]
    ranks = [(round(h.insertion_moment, 4), -round(h.safety, 3), -round(h.contact_area, 8)) for h in held]
    assert len(set(ranks)) > 1
    assert ranks[plan.result.requirement_of_part[0]] == min(ranks)
    file.write_text(PEG.format(insertion="{force: 20}", holding="{force: 2, friction: 0.1}"))
    weak = plan_grippers(load_assembly(file))
    assert not weak.solved
    assert "pads slip" in weak.missing[0]


@pytest.mark.parametrize(
    ("insertion", "holding", "message"),
    [
        ("{force: -1}", "{}", "force = -1"),
        ("{forces: 1}", "{}", "forces"),
        ("{force: 1, hole: [0, 0]}", "{}", "list of 3 numbers"),
        ("{force: 1}", "{friction: 0}", "friction = 0"),
        ("{force: 1}", "{modulus: soft}", "must be a number"),
        ("{force: 1}", "{softness: 1}", "softness"),
    ],
)
def test_wrong_loads_are_refused_at_their_line(tmp_path: Path, insertion: str, holding: str, message: str) -> None:
    file = tmp_path / "peg.yaml"
    file.write_text(PEG.format(insertion=insertion, holding=holding))
    with pytest.raises(mg.InvalidInput, match=r"peg\.yaml") as caught:
        load_assembly(file)
    assert message in str(caught.value)


def test_an_insertion_needs_a_way(tmp_path: Path) -> None:
    file = tmp_path / "peg.yaml"
    file.write_text(PEG.format(insertion="{force: 1}", holding="{}").replace("from: {xyz: [0, 0, 60]}, ", ""))
    with pytest.raises(mg.InvalidInput, match="needs a way"):
        load_assembly(file)
