"""`mmgrasp check`: what a robot lacks for planning, and that its verdict is the planner's, in both directions."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from conftest import ASSETS
from mmgrasp.cli import main
from mmgrasp.cli.check import RobotCheck, check_robot

FETCH = ASSETS / "robots" / "fetchlike" / "fetchlike.urdf"
OMNI = ASSETS / "robots" / "omni6" / "omni6.urdf"
BARE = '<collision><geometry><box size="{0} {0} {0}"/></geometry></collision>'


def chain(axes: list[str], *, lower: float = -2.0, base: str = "") -> str:
    """An arm whose joints stand 0.2 m above each other and turn about these axes."""
    text = f"<robot name='r'><link name='l0'>{BARE.format(0.1)}</link>{base}"
    for i, axis in enumerate(axes, 1):
        text += (
            f"<link name='l{i}'>{BARE.format(0.05)}</link><joint name='j{i}' type='revolute'><parent link='l{i - 1}'/><child link='l{i}'/>"
            f"<origin xyz='0 0 0.2'/><axis xyz='{axis}'/><limit lower='{lower}' upper='2' velocity='1' effort='1'/></joint>"
        )
    return text + "</robot>"


def checked(folder: Path, urdf: str, base: str | None = None) -> RobotCheck:
    file = folder / "r.urdf"
    file.write_text(urdf)
    return check_robot(file, base=base)


@pytest.mark.parametrize(
    ("axes", "rank"),
    [
        (["0 1 0"] * 4, 3),  # in a plane: two directions and a turn
        (["0 0 1", "0 1 0", "0 1 0", "0 1 0"], 4),
        (["0 0 1", "0 1 0", "0 1 0", "0 1 0", "0 0 1"], 5),
        (["0 0 1", "0 1 0", "0 1 0", "0 0 1", "0 1 0", "0 0 1"], 6),
        (["0 0 1", "0 1 0", "0 0 1", "0 1 0", "0 0 1", "0 1 0", "0 0 1"], 6),
    ],
)
def test_the_rank_of_an_arm(tmp_path: Path, axes: list[str], rank: int) -> None:
    check = checked(tmp_path, chain(axes))
    said = [re.search(r"in (\d) of 6 directions", line) for line in check.missing]
    assert [int(m.group(1)) for m in said if m] == ([rank] if rank < 6 else [])
    assert check.ok  # motions of its joints can be planned all the same
    assert checked(tmp_path, chain(axes), "omni").ok == (rank == 6)  # who has a base that drives wants rounds


WHEELS = "".join(
    f"<link name='w{i}'>{BARE.format(0.1)}</link><joint name='wheel{i}' type='continuous'><parent link='l0'/><child link='w{i}'/>"
    f"<origin xyz='0 {y} 0'/><axis xyz='0 1 0'/><limit velocity='9' effort='1'/></joint>"
    for i, y in enumerate((-0.2, 0.2))
)
SIX = ["0 0 1", "0 1 0", "0 1 0", "0 0 1", "0 1 0", "0 0 1"]


def test_wheels_tell_the_base_and_a_base_alone_cannot_be_planned_for(tmp_path: Path) -> None:
    assert checked(tmp_path, chain(SIX, base=WHEELS)).robot.base == "diff_drive"
    assert "its wheels tell diff_drive" in " ".join(checked(tmp_path, chain(SIX, base=WHEELS), "omni").doubts)
    assert "its wheels tell diff_drive" in " ".join(checked(tmp_path, chain(SIX, base=WHEELS), "fixed").missing)
    assert checked(tmp_path, chain(SIX)).robot.base == "fixed"
    alone = checked(tmp_path, chain([], base=WHEELS))
    assert not alone.ok and "no arm" in alone.problems[0] and alone.verdict == "cannot be planned for"
    lift = checked(tmp_path, chain(["0 0 1"], base=WHEELS))
    assert not lift.ok and "--mount" in lift.problems[0]


def test_hand_tool_frame_bodies_and_srdf(tmp_path: Path) -> None:
    check = checked(tmp_path, chain(SIX).replace(BARE.format(0.05), "", 2))
    assert "no fingers were found at l6" in " ".join(check.missing)
    assert any("2 moving bodies have no collision shape" in d and "l1, l2" in d for d in check.doubts)
    assert any(d.startswith("no SRDF") and "base_link: l0" in d for d in check.doubts)
    whole = check_robot(FETCH, FETCH.with_suffix(".srdf"))
    assert whole.ok and not whole.missing and not any(d.startswith("no SRDF") for d in whole.doubts)
    assert any("tool frame gripper_tcp" in line and "101 mm" in line for line in whole.found)
    assert whole.verdict.endswith("whole rounds")


def test_real_robots(data: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(data / "robots/ridgeback/expanded/ridgeback.urdf")]) == 1  # four wheels, no arm
    assert "base omni" in capsys.readouterr().out
    tiago = data / "robots/tiago/example-robot-data/robots/tiago_description/robots/tiago_no_hand.urdf"
    assert main(["check", str(tiago), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["base"] == "diff_drive" and "arm_7_link" in found["missing"][0]


def without(urdf: Path, joint: str, change: tuple[str, str], target: Path) -> Path:
    """A copy of a robot whose joint's tag is changed."""
    before, joint_tag, after = re.split(f'(<joint name="{joint}".*?</joint>)', urdf.read_text(), flags=re.S)
    changed = re.sub(change[0], change[1], joint_tag)
    assert changed != joint_tag
    target.write_text(before + changed + after)
    return target


def test_verdict_is_the_planners(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A head that stands still at [0, 0] is no obstacle, a wrist that is missing is one: judged by check, then tried."""
    still = without(
        FETCH, "head_pan_joint", (r'lower="[^"]*" upper="[^"]*"', 'lower="0" upper="0"'), tmp_path / "still.urdf"
    )
    five = without(OMNI, "wrist_3_joint", (r'type="revolute"', 'type="fixed"'), tmp_path / "five.urdf")
    for urdf, base, can in ((still, "diff_drive", True), (five, "omni", False)):
        file, out = tmp_path / f"{urdf.stem}.yaml", tmp_path / urdf.stem
        assert main(["check", str(urdf), "--base", base]) == (0 if can else 1)
        assert ("can be planned for: motions of its joints and whole rounds" in capsys.readouterr().out) == can
        assert main(["init", str(urdf), "-o", str(file), "--base", base]) == 0
        assert (main(["plan", str(file), "-o", str(out), "--no-pictures"]) == 0) == can


def test_a_chain_of_more_joints_than_a_group_may_have_is_told_so(tmp_path: Path) -> None:
    """Twelve hundred links, deeper than Python's calls may be nested; no shapes, so that no pairs are looked at."""
    check = checked(tmp_path, chain(["0 0 1"] * 1200).replace(BARE.format(0.05), ""))
    assert any("1200" in line and "at most 64" in line for line in check.missing), check.missing
