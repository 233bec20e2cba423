"""`mmgrasp init`: what it reads from robots whose answer is known, and that what it writes is planned and verified as it stands."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from conftest import ASSETS
from mmgrasp.cli import main
from mmgrasp.part_supply import read_plan
from mmgrasp.scenario.closed_fingers import fingers_may_meet
from mmgrasp.scenario.first import first_scenario
from mmgrasp.scenario.first.arm import find_arm
from mmgrasp.scenario.first.drive import read_drive
from mmgrasp.scenario.first.room import place_room
from mmgrasp.scenario.first.standing import Outline
from mmgrasp.scenario.first.tool import find_tool

FETCH = ASSETS / "robots" / "fetchlike" / "fetchlike.urdf"
OMNI = ASSETS / "robots" / "omni6" / "omni6.urdf"


def wheeled(wheels: list[tuple[float, float, str]]) -> mg.Robot:
    """A box on wheels at (x, y) with axles along an axis."""
    links = joints = ""
    for i, (x, y, axis) in enumerate(wheels):
        links += f"<link name='wheel_{i}'><collision><geometry><sphere radius='0.1'/></geometry></collision></link>"
        joints += (
            f"<joint name='j{i}' type='continuous'><parent link='base'/><child link='wheel_{i}'/><axis xyz='{axis}'/>"
            f"<origin xyz='{x} {y} 0.1'/><limit effort='1' velocity='5'/></joint>"
        )
    body = "<link name='base'><collision><origin xyz='0 0 0.3'/><geometry><box size='0.4 0.3 0.2'/></geometry></collision></link>"
    return mg.Robot.from_strings(f"<robot name='r'>{body}{links}{joints}</robot>")


def test_the_base_is_told_from_its_wheels() -> None:
    two = read_drive(wheeled([(0, 0.2, "0 1 0"), (0, -0.2, "0 1 0")]), "", None)
    assert (two.base, two.sure) == ("diff_drive", True)
    assert two.separation == pytest.approx(0.4)
    four = wheeled([(x, y, "0 1 0") for x in (-0.2, 0.2) for y in (-0.2, 0.2)])
    assert (read_drive(four, "", None).base, read_drive(four, "", None).sure) == ("diff_drive", False)
    mecanum = read_drive(four, "<mesh filename='Mecanum.stl'/>", None)
    assert mecanum.base == "omni"
    corners = wheeled([(x, y, "0 1 0") for x in (0.25, -0.25) for y in (0.2, -0.2)])
    for base in (None, "omni"):
        drive = read_drive(corners, "<mesh filename='Mecanum.stl'/>", base)
        assert drive.base == "omni"
        assert [drive.separation, drive.wheelbase] == pytest.approx([0.4, 0.5])
    assert read_drive(corners, "", "omni").wheelbase is None  # nothing says which wheels they are
    turned = [(np.cos(a), np.sin(a), f"{np.cos(a)} {np.sin(a)} 0") for a in (0, 2.1, 4.2)]
    assert read_drive(wheeled(turned), "", None).base == "omni"
    with pytest.raises(mg.InvalidInput, match="--base"):
        read_drive(mg.Robot.load(OMNI), "", None)


def test_the_arm_and_hand_of_a_panda(data: Path) -> None:
    robot = mg.Robot.load(data / "robots/panda/expanded/panda.urdf")
    arm = find_arm(robot, [], None, None)
    assert arm.joints == [f"panda_joint{i}" for i in range(1, 8)]
    tool = find_tool(robot, arm, None)
    assert tool is not None
    assert tool.hand.max_opening == pytest.approx(0.08, abs=1e-3)  # its data sheet's
    # Its fingers close half way between x and y of the last link, in which the frame between their tips was made.
    assert np.abs(tool.hand.closing) == pytest.approx([np.sqrt(0.5), np.sqrt(0.5), 0], abs=1e-6)


def test_an_arm_without_fingers(data: Path) -> None:
    path = data / "robots/tiago/example-robot-data/robots/tiago_description/robots/tiago_no_hand.urdf"
    robot = mg.Robot.load(path, allow_missing_meshes=True)
    drive = read_drive(robot, path.read_text(), None)
    assert drive.base == "diff_drive"
    assert drive.separation == pytest.approx(0.4044)  # where the URDF puts the wheels
    arm = find_arm(robot, drive.wheels, None, None)
    assert arm.joints == ["torso_lift_joint", *(f"arm_{i}_joint" for i in range(1, 8))]
    assert find_tool(robot, arm, None) is None


def planned_and_verified(folder: Path, urdf: Path, *options: str, drive_by: bool = False) -> dict[str, Any]:
    """Through the command's doors, without an edit of what init wrote."""
    file, out = folder / "first.yaml", folder / "out"
    assert main(["init", str(urdf), "-o", str(file), *options]) == 0
    assert main(["plan", str(file), "-o", str(out), "--no-pictures", *["--drive-by"] * drive_by]) == 0
    assert main(["verify", str(out / "plan.json"), "--scenario", str(file), "--samples", "100"]) == 0
    return read_plan(out / "plan.json")


@pytest.mark.parametrize(("urdf", "options"), [(FETCH, []), (OMNI, ["--base", "omni"])])
def test_shipped_robots_need_no_edit(tmp_path: Path, urdf: Path, options: list[str]) -> None:
    plan = planned_and_verified(tmp_path, urdf, *options)
    assert len(plan["picks"]) == 12


RIDGEBACK = "ridgeback/expanded/ridgeback.urdf"
OTHERS_ROBOTS = {
    "tiago": ["tiago/example-robot-data/robots/tiago_description/robots/tiago_no_hand.urdf"],
    "panda": [RIDGEBACK, "panda/moveit_resources_panda_description/urdf/panda.urdf"],
    "iiwa": [RIDGEBACK, "kuka_iiwa/kuka_lbr_iiwa_support/urdf/lbr_iiwa_14_r820.urdf"],
    "ur10e": [RIDGEBACK, "ur/expanded/ur10e.urdf"],
    "ur5e": [RIDGEBACK, "ur/expanded/ur5e.urdf"],
    "ur5, 148,000 faces": [RIDGEBACK, "ur5_vamp/ur5/ur5.urdf"],
    "ur10e, three fingers": [RIDGEBACK, "ur/expanded/ur10e.urdf", "robotiq/expanded/robotiq_3f_articulated.urdf"],
}
MOUNTED_ON = ["mid_mount", "ur10e_robot_tool0"]  # arm, hand


def others_robot(data: Path, name: str) -> list[str]:
    """What init is told: a robot, or a base and the arm on it."""
    base, *mounted = (str(data / "robots" / file) for file in OTHERS_ROBOTS[name])
    pairs = zip(mounted, MOUNTED_ON, strict=False)
    return [base, *(word for file, link in pairs for word in ("--mount", f"{file}={link}"))]


@pytest.mark.slow
@pytest.mark.parametrize("name", OTHERS_ROBOTS)
def test_robots_that_others_wrote_need_no_edit(data: Path, tmp_path: Path, name: str) -> None:
    urdf, *options = others_robot(data, name)
    assert len(planned_and_verified(tmp_path, Path(urdf), *options)["picks"]) == 12


@pytest.mark.slow
def test_an_arm_given_by_its_links_takes_parts_in_passing(data: Path, tmp_path: Path) -> None:
    """All but one: the file's wheels do 0.076 m/s, and of the long way to the first part the motion's few waypoints lose more than is saved."""
    urdf, *options = others_robot(data, "iiwa")
    plan = planned_and_verified(tmp_path, Path(urdf), *options, drive_by=True)
    assert len(plan["picks"]) == 12
    assert len(plan["drive_by"]["motions"]) == 11


def test_a_link_of_a_mounted_robot_is_told_by_its_own_name(
    data: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    urdf, *options = others_robot(data, "ur10e, three fingers")
    options[-1] = options[-1].replace("=ur10e_robot_tool0", "=tool0")
    assert main(["init", urdf, "-o", str(tmp_path / "first.yaml"), *options]) == 2
    assert "'tool0': the robot has no such link; did you mean ur10e_robot_tool0?" in capsys.readouterr().err


def write_map(folder: Path, cells: np.ndarray) -> Path:
    """A map of 10 cm cells, True where they are taken, rows upwards."""
    rows = np.where(np.flipud(cells), 0, 254).astype(np.uint8)
    (folder / "room.pgm").write_bytes(b"P5 %d %d 255\n" % rows.shape[::-1] + rows.tobytes())
    text = "image: room.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    (folder / "room.yaml").write_text(text)
    return folder / "room.yaml"


def test_the_counter_stands_where_the_map_is_free(tmp_path: Path) -> None:
    cells = np.ones((60, 80), dtype=bool)
    cells[2:-2, 2:-2] = False
    cells[20:60, 40:44] = True  # a wall between two rooms
    file = tmp_path / "first.yaml"
    assert main(["init", str(FETCH), str(write_map(tmp_path, cells)), "-o", str(file)]) == 0
    scenario = mg.load_scenario(file)  # refuses bodies that overlap, and a start or goal in collision
    counter = next(o for o in scenario.obstacles if o.name == "counter")
    low, high = counter.shapes[0].bounds
    corners = np.array([[x, y, 0, 1] for x in (low[0], high[0]) for y in (low[1], high[1])]) @ counter.pose.T
    assert not cells[(corners[:, 1] / 0.1).astype(int), (corners[:, 0] / 0.1).astype(int)].any()


def test_counter_and_base_keep_off_pillars() -> None:
    """Rooms with pillars anywhere: looked at as distances from points to boxes, which is not how a place is sought."""
    outline = Outline(np.array([-0.3, -0.25, 0.0]), np.array([0.3, 0.25, 0.5]))
    placed = 0
    for seed in range(20):
        random = np.random.default_rng(seed)
        ends = [(6.0, 0.1, 3, 0), (6.0, 0.1, 3, 5), (0.1, 5.0, 0, 2.5), (0.1, 5.0, 6, 2.5)]
        boxes = [*ends, *((0.2, 0.2, *random.uniform((0, 0), (6, 5))) for _ in range(12))]
        walls = [mg.collision.LinkShape(mg.collision.Box([a, b, 1.0]), mg.pose([x, y, 0.5])) for a, b, x, y in boxes]
        try:
            layout = place_room(outline, walls)
        except mg.InvalidInput:
            continue
        placed += 1

        def clearance(points: np.ndarray, boxes: list[Any] = boxes) -> float:
            gaps = [np.maximum(np.abs(points - [x, y]) - [a / 2, b / 2], 0) for a, b, x, y in boxes]
            return float(np.linalg.norm(gaps, axis=2).min())

        x, y, heading = layout.counter
        R = np.array([[np.cos(heading), -np.sin(heading)], [np.sin(heading), np.cos(heading)]])
        grid = np.stack(np.meshgrid(np.linspace(-0.25, 0.25, 26), np.linspace(-0.8, 0.8, 81)), axis=-1).reshape(-1, 2)
        assert clearance(grid @ R.T + [x, y]) > 0
        for base in (layout.start, layout.goal):
            assert clearance(base[None, :2]) > np.hypot(0.3, 0.25)  # it can turn there
    assert placed > 10


def test_a_map_without_room_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cells = np.ones((60, 80), dtype=bool)
    cells[:, 30:34] = False
    assert main(["init", str(FETCH), str(write_map(tmp_path, cells)), "-o", str(tmp_path / "first.yaml")]) == 2
    assert "no free place" in capsys.readouterr().err
    assert not (tmp_path / "first.yaml").exists()


def test_what_is_there_is_not_replaced(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text("mine")
    assert main(["init", str(FETCH), "-o", str(file)]) == 2
    assert "not replaced" in capsys.readouterr().err
    assert file.read_text() == "mine"
    urdf = tmp_path / "r.urdf"
    urdf.write_bytes(FETCH.read_bytes())
    assert main(["check", str(urdf), "--write-srdf", str(urdf)]) == 2
    assert urdf.read_bytes() == FETCH.read_bytes()
    srdf = tmp_path / "r.srdf"
    srdf.write_bytes(FETCH.with_suffix(".srdf").read_bytes())
    assert main(["check", str(urdf), "--srdf", str(srdf), "--write-srdf", str(srdf)]) == 2
    assert srdf.read_bytes() == FETCH.with_suffix(".srdf").read_bytes()


def test_a_plan_is_not_replaced_by_its_picture(small_plan: mg.part_supply.ScenarioPlan, tmp_path: Path) -> None:
    plan = small_plan.save(tmp_path / "plan.json")
    before = plan.read_bytes()
    for option in ("--png", "--film"):
        assert main(["view", str(plan), option, str(plan)]) == 2
        assert plan.read_bytes() == before


def meeting_fingers(apart: float) -> mg.Robot:
    """Two blocks on slides that stand so far apart when closed [m], which an SRDF says touch never."""
    links = "<link name='palm'/>"
    joints = ""
    for name, side in (("left", 1), ("right", -1)):
        y = side * (0.01 + apart / 2)
        links += f"<link name='{name}'><collision><origin xyz='0.05 {y} 0'/><geometry><box size='0.04 0.02 0.02'/></geometry></collision></link>"
        joints += (
            f"<joint name='{name}_joint' type='prismatic'><parent link='palm'/><child link='{name}'/><axis xyz='0 {side} 0'/>"
            "<limit lower='0' upper='0.04' effort='1' velocity='1'/></joint>"
        )
    turn = (
        "<link name='base'/><joint name='turn' type='revolute'><parent link='base'/><child link='palm'/><axis xyz='1 0 0'/>"
        "<limit lower='-1' upper='1' effort='1' velocity='1'/></joint>"
    )
    tool = "<link name='tool'/><joint name='at' type='fixed'><parent link='palm'/><child link='tool'/><origin xyz='0.05 0 0'/></joint>"
    srdf = "<robot name='r'><disable_collisions link1='left' link2='right' reason='Never'/></robot>"
    return mg.Robot.from_strings(f"<robot name='r'>{turn}{links}{joints}{tool}</robot>", srdf)


@pytest.mark.parametrize(("apart", "reason"), [(0.0, "default"), (5e-5, "default"), (0.002, "never")])
def test_fingers_that_meet_when_closed_may(apart: float, reason: str) -> None:
    robot = meeting_fingers(apart)
    joints = [mg.grasping.HandJoint(f"{side}_joint", 0.0, 0.04) for side in ("left", "right")]
    hand = mg.grasping.Hand(
        "tool", approach=[1, 0, 0], closing=[0, 1, 0], max_opening=0.08, finger_depth=0.04, finger_width=0.02,
        joints=joints, finger_links=["left", "right"],
    )  # fmt: skip
    pairs = fingers_may_meet(robot, hand).disabled_pairs
    assert [why for a, b, why in pairs if {a, b} == {"left", "right"}] == [reason]


def test_what_keeps_a_robot_from_picking_is_told(tmp_path: Path) -> None:
    base = tmp_path / "base.urdf"
    base.write_text("<robot name='cart'><link name='base'/></robot>")
    with pytest.raises(mg.InvalidInput, match="--base diff_drive or --base omni"):
        first_scenario(base)
    with pytest.raises(mg.InvalidInput, match="nothing can pick"):
        first_scenario(base, base="omni")
    with pytest.raises(mg.InvalidInput, match="no such link"):
        first_scenario(FETCH, tool_link="gripper_tpc")
    with pytest.raises(mg.InvalidInput, match="0 joints lead to it"):
        first_scenario(FETCH, tool_link="base_link")
    with pytest.raises(mg.InvalidInput, match="no such group"):
        first_scenario(FETCH, group="amr")


def test_shipped_files_keep_their_shipped_names() -> None:
    text = first_scenario("asset:robots/fetchlike/fetchlike.urdf").text
    assert 'srdf: "asset:robots/fetchlike/fetchlike.srdf"' in text
    assert str(ASSETS) not in text


def test_the_same_robot_gives_the_same_scenario(tmp_path: Path) -> None:
    first, second = (first_scenario(FETCH, folder=tmp_path) for _ in range(2))
    assert first.text == second.text
