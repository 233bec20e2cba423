"""The default roadmap hangs together on every robot of the data and on those that ship."""

from __future__ import annotations

from pathlib import Path

import pytest

import mmgrasp as mg

DATA = Path(__file__).parents[2].parent / "shared" / "data" / "robots"
SHIPPED = Path(mg.__file__).parent / "assets" / "robots"
# File, base, and the group: joints from one link to another.
ROBOTS = {
    "tm14like": (SHIPPED / "tm14like/tm14like.urdf", "fixed", "", "gripper_tcp"),
    "kr6like": (SHIPPED / "kr6like/kr6like.urdf", "fixed", "", "gripper_tcp"),
    "fetchlike": (SHIPPED / "fetchlike/fetchlike.urdf", "fixed", "", "gripper_tcp"),
    "omni6": (SHIPPED / "omni6/omni6.urdf", "fixed", "", "gripper_tcp"),
    "omni6 with its base": (SHIPPED / "omni6/omni6.urdf", "omni", "", "gripper_tcp"),
    "panda": (DATA / "panda/expanded/panda.urdf", "fixed", "", "panda_link8"),
    "panda of VAMP": (DATA / "panda_vamp/panda/panda.urdf", "fixed", "", "panda_hand"),
    "ur5 of VAMP": (DATA / "ur5_vamp/ur5/ur5.urdf", "fixed", "", "tool0"),
    "ur5e": (DATA / "ur/expanded/ur5e.urdf", "fixed", "", "tool0"),
    "ur10e": (DATA / "ur/expanded/ur10e.urdf", "fixed", "", "tool0"),
    "iiwa": (DATA / "kuka_iiwa/kuka_lbr_iiwa_support/urdf/lbr_iiwa_14_r820.urdf", "fixed", "", "tool0"),
    "tiago": (
        DATA / "tiago/example-robot-data/robots/tiago_description/robots/tiago_no_hand.urdf", "fixed", "", "arm_tool_link",
    ),
    "pr2": (DATA / "pr2/example-robot-data/robots/pr2_description/urdf/pr2.urdf", "fixed", "torso_lift_link", "r_gripper_tool_frame"),
}  # fmt: skip


def group_of(name: str) -> mg.robot.JointGroup:
    path, base, base_link, tip = ROBOTS[name]
    if not path.exists():
        pytest.skip("the robot's files (../shared/data) are not here")
    robot = mg.Robot.load(path, base=base, allow_missing_meshes=True)
    return robot.group(base_link=base_link or robot.links[0], tip=tip, with_base=base != "fixed")


@pytest.mark.parametrize("name", list(ROBOTS))
def test_the_default_roadmap_hangs_together(name: str) -> None:
    roadmap = mg.planning.Roadmap.build(group_of(name))
    assert len(roadmap) == 5000
    assert roadmap.statistics["largest_component"] >= 0.99 * 5000
    assert roadmap.warning == "" and "warning" not in repr(roadmap)


def test_the_gamma_of_the_paper_is_there_and_warns() -> None:
    """P2's 4: on a UR5e, whose joints turn twice around, next to nothing is joined."""
    roadmap = mg.planning.Roadmap.build(group_of("ur5e"), gamma=4.0)
    assert roadmap.statistics["largest_component"] < 50
    assert f"the largest of {roadmap.statistics['largest_component']} of 5000" in roadmap.warning
    assert "neighbours = 0" in roadmap.warning and roadmap.warning in repr(roadmap)
