"""Grippers for an assembly from Python: the least set, grids, files, mistakes."""

from __future__ import annotations

import functools
import itertools
import operator
from pathlib import Path

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp.gripper_design import Gripper, GripperActuator, SegmentRequirement, minimal_grippers
from mmgrasp.reproduce.gripper_sets import ACTUATORS, every_set, requirements
from mmgrasp.viz.gripper_pictures import gripper_bodies

JAWS = GripperActuator("jaws", 0.01)


def test_thirteen_parts_need_five_grippers() -> None:
    found = minimal_grippers(requirements(), ACTUATORS)
    assert found.outcome == mg.Outcome.solved
    assert len(found.grippers) == found.lower_bound == 5
    for part, gripper, requirement in zip(found.parts, found.gripper_of_part, found.requirement_of_part, strict=True):
        asked = requirements()[requirement]
        assert asked.part == part
        assert found.grippers[gripper].holds(asked)
    as_dict = found.to_dict()
    assert as_dict["outcome"] == "solved"
    assert [g["fingers"] for g in as_dict["grippers"]] == [g.fingers for g in found.grippers]
    assert repr(found) == "MinimalGrippersResult(solved, 5 grippers, 8 changes)"


def test_a_grid_takes_what_its_points_take() -> None:
    """Two widths, one just a stroke above the other: only a grid that meets both ends needs one gripper."""
    asked = [SegmentRequirement("a", 0.02), SegmentRequirement("b", 0.03)]
    assert (
        len(minimal_grippers(asked, [JAWS], grid=(1, 1)).grippers) == 1
    )  # P1: the widest segment, where one value does
    apart = [*asked, SegmentRequirement("c", 0.06)]
    assert len(minimal_grippers(apart, [JAWS], grid=(4, 1)).grippers) == 2
    assert len(minimal_grippers(apart, [JAWS]).grippers) == 2
    assert minimal_grippers(apart, [JAWS], grid=(1, 1)).uncovered == ["a", "b"]


def test_parts_that_nothing_takes_say_why() -> None:
    asked = [
        SegmentRequirement("pin", 0.005, fingers=3),
        SegmentRequirement("plate", 0.4, segment="rim"),
        SegmentRequirement("cap", 0.02, min_finger_length=0.041),
    ]
    found = minimal_grippers(asked, [GripperActuator("jaws", 0.01, max_opening=0.1)], longest_finger=0.03)
    assert found.outcome == mg.Outcome.infeasible
    assert found.uncovered == ["pin", "plate", "cap"]
    pin, plate, cap = found.explanations
    assert pin == "part 'pin': no actuator has 3 fingers"
    assert plate == "part 'plate': segment 'rim': it is 400 mm wide, actuators with 2 fingers open to 100 mm"
    assert "from 41 mm" in cap and "longest_finger = 30 mm" in cap


def test_files_of_a_gripper_are_a_robot(tmp_path: Path) -> None:
    gripper = Gripper(name="centric", fingers=3, min_opening=0.014, max_opening=0.022, finger_length=0.05)
    gripper.to_urdf(tmp_path / "deep" / "centric")
    robot = mg.Robot.load(tmp_path / "deep/centric/gripper.urdf", srdf=tmp_path / "deep/centric/gripper.srdf")
    fingers = robot.group("fingers", tip="finger_1")
    assert fingers.upper == pytest.approx([0.004])
    opened = fingers.fk(np.array([0.004]))[:3, 3]
    assert np.hypot(*opened[:2]) == pytest.approx(0.011)
    assert opened[2] == pytest.approx(gripper.palm_height)
    mesh = mg.Mesh.load(tmp_path / "deep/centric/finger.stl")
    assert mesh.closed
    assert np.asarray(mesh.vertices)[:, 2].max() == pytest.approx(50)  # [mm]
    finger = robot.collisions("finger_1")[0].shape
    assert isinstance(finger, mg.Box) and finger.size[2] == pytest.approx(0.05)


def test_the_drawn_palm_is_as_wide_as_the_built_one(tmp_path: Path) -> None:
    gripper = Gripper(name="wide", fingers=3, min_opening=0.01, max_opening=0.05, finger_width=0.02)
    gripper.to_urdf(tmp_path)
    palm = mg.Robot.load(tmp_path / "gripper.urdf").collisions("base")[0].shape
    assert isinstance(palm, mg.Cylinder)
    vertices = gripper_bodies(gripper, 0.03, np.eye(4))[-1][0]
    assert np.linalg.norm(vertices[:, :2], axis=1) == pytest.approx(palm.radius)
    assert vertices[:, 2].max() == pytest.approx(-gripper.finger_length)


def test_mistakes_are_named(tmp_path: Path) -> None:
    with pytest.raises(mg.InvalidInput, match=r"opening of .a, rim. = -0\.01"):
        SegmentRequirement("a", -0.01, segment="rim")
    with pytest.raises(mg.InvalidInput, match="fingers = 4"):
        Gripper(fingers=4)
    with pytest.raises(mg.InvalidInput, match="stroke of actuator 'j' = 0"):
        minimal_grippers([SegmentRequirement("a", 0.01)], [GripperActuator("j", 0)])
    with pytest.raises(mg.InvalidInput, match=r"grid = .*two positive whole numbers"):
        minimal_grippers([SegmentRequirement("a", 0.01)], [JAWS], grid=(0, 3))
    with pytest.raises(mg.InvalidInput, match="did you mean change_cost"):
        minimal_grippers([SegmentRequirement("a", 0.01)], [JAWS], change_costs=1)  # type: ignore[call-arg]
    with pytest.raises(mg.InvalidInput, match="requirements"):
        minimal_grippers([0.01], [JAWS])  # type: ignore[list-item]
    (tmp_path / "file").write_text("")
    with pytest.raises(mg.IoError, match="file"):
        Gripper().to_urdf(tmp_path / "file" / "in")


def test_a_gripper_is_a_hand_to_planners(tmp_path: Path) -> None:
    gripper = Gripper(name="jaws", min_opening=0.01, max_opening=0.06, finger_length=0.04)
    hand = gripper.hand()
    assert (hand.tool_link, hand.min_opening, hand.max_opening) == ("tool", 0.01, 0.06)
    gripper.to_urdf(tmp_path)
    robot = mg.Robot.load(tmp_path / "gripper.urdf", tmp_path / "gripper.srdf")
    assert hand.joint_values(0.06) == pytest.approx(mg.Hand.from_robot(robot, "tool").joint_values(0.06))
    assert mg.grasping.sample_grasps([mg.LinkShape(mg.Box([0.03, 0.05, 0.04]))], hand)
    with pytest.raises(mg.InvalidInput, match="fingers = 3"):
        Gripper(fingers=3).hand()


def test_trying_all_sets_is_what_it_says() -> None:
    """Against all combinations, and it does not go on for ever."""
    rng = np.random.default_rng(1)
    for _ in range(200):
        parts = int(rng.integers(1, 8))
        masks = [int(m) for m in rng.integers(1, 1 << parts, rng.integers(1, 9))]
        sizes = [
            size
            for size in range(1, len(masks) + 1)
            for chosen in itertools.combinations(masks, size)
            if functools.reduce(operator.or_, chosen) == (1 << parts) - 1
        ]
        assert every_set(masks, parts, len(masks)) == min(sizes, default=len(masks) + 1)
    assert every_set([1 << i for i in range(12)] * 3, 12, 11, tries=1000) is None


@pytest.mark.parametrize("fingers", [2, 3])
def test_files_mean_the_same_to_mujoco(fingers: int, tmp_path: Path) -> None:
    """Read by MuJoCo's own URDF reader, pads are half an opening off the axis at either end of the stroke, tips a finger's length off the palm."""
    mujoco = pytest.importorskip("mujoco")
    gripper = mg.gripper_design.Gripper(
        name="g",
        actuator="drive",
        fingers=fingers,
        min_opening=0.01,
        max_opening=0.04,
        finger_length=0.05,
        finger_width=0.015,
        finger_thickness=0.008,
    )
    gripper.to_urdf(tmp_path)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "gripper.urdf"))
    data = mujoco.MjData(model)
    assert model.njnt == fingers
    for share, opening in ((0.0, gripper.min_opening), (1.0, gripper.max_opening)):
        data.qpos[:] = model.jnt_range[:, 0] + share * (model.jnt_range[:, 1] - model.jnt_range[:, 0])
        mujoco.mj_forward(model, data)
        meshes = [g for g in range(model.ngeom) if model.geom_type[g] == mujoco.mjtGeom.mjGEOM_MESH]
        assert len(meshes) == fingers
        outward = [data.xaxis[j] for j in range(fingers)]
        for geom, axis in zip(meshes, outward, strict=True):
            mesh = model.geom_dataid[geom]
            first, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
            corners = (
                model.mesh_vert[first : first + count] @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom]
            )
            assert (corners @ axis).min() == pytest.approx(opening / 2, abs=1e-6)
            assert corners[:, 2].max() == pytest.approx(gripper.palm_height + gripper.finger_length, abs=1e-6)
        turns = np.sort(np.degrees(np.arctan2(*np.array(outward)[:, 1::-1].T)) % 360)
        assert np.diff(turns) == pytest.approx([360 / fingers] * (fingers - 1), abs=1e-6)
