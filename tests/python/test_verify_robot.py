"""`verify` reads the robot by urdfdom: what our own reader made of the URDF is held against it."""

from __future__ import annotations

import copy
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import mmgrasp as mg
from conftest import ASSETS, DATA, REPOSITORY
from mmgrasp._core import RobotSource
from mmgrasp._core import verify as checks

FOLDERS = (ASSETS, REPOSITORY / "tests" / "fuzz" / "corpus" / "urdf", DATA / "robots")


def urdf_changed(plan: dict[str, Any], old: str, new: str) -> None:
    """The URDF that was given says something else than the robot that was planned for."""
    urdf = next(u for u in plan["scenario"]["robot"]["urdfs"] if old in u["urdf"])
    urdf["urdf"] = urdf["urdf"].replace(old, new, 1)


def joint_text(plan: dict[str, Any], joint: str) -> str:
    text: str = next(u["urdf"] for u in plan["scenario"]["robot"]["urdfs"] if f'joint name="{joint}"' in u["urdf"])
    start = text.index(f'<joint name="{joint}"')
    return text[start : text.index("</joint>", start)]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("tag", "quantity"), [("origin", "its origin"), ("axis", "its axis"), ("limit", "its upper limit")]
)
def test_a_robot_that_was_read_wrongly_is_named(small_plan_dict: dict[str, Any], tag: str, quantity: str) -> None:
    plan = copy.deepcopy(small_plan_dict)
    joint = plan["scenario"]["arm"]["joints"][1]
    text = joint_text(plan, joint)
    (before, *_) = re.findall(f"<{tag} [^>]*>", text)
    after = {
        "origin": before.replace('xyz="', 'xyz="1'),
        "axis": re.sub('xyz="[^"]*"', 'xyz="0.6 0.8 0"', before),
        "limit": re.sub('upper="[^"]*"', 'upper="0.01"', re.sub('lower="[^"]*"', 'lower="-0.01"', before)),
    }[tag]
    urdf_changed(plan, text, text.replace(before, after))
    faults = mg.verify_plan(plan, samples=50).faults
    named = [f for f in faults if f.code == "robot-differs"]
    assert {f.where for f in named} == {f"joint '{joint}'"}
    assert any(quantity in f.message for f in named), named
    assert any(f.code != "robot-differs" for f in faults), "the motions must give it away, too"


@pytest.mark.parametrize(
    "path", [p for folder in FOLDERS for p in sorted(folder.rglob("*.urdf"))], ids=lambda p: p.stem
)
def test_urdfdom_reads_the_same_robot_as_we_do(path: Path) -> None:
    try:
        robot = mg.Robot.load(path, allow_missing_meshes=True)
    except mg.InvalidInput:
        pytest.skip("refused by our reader")
    files = {s.mesh_path: s.mesh_path for link in robot.links for s in robot.collisions(link) if s.mesh_path}
    plan = checks.PlanToCheck(robot.source)
    planned = RobotSource(srdf=robot.to_srdf())
    planned.add_urdf(robot.to_urdf(), mesh_files=files)
    plan.planned_robot = planned
    faults = checks.check_plan(plan).faults
    assert faults, "a plan without anything in it"
    assert not [f for f in faults if f.code in ("robot-differs", "robot-unreadable")], faults


def test_what_urdfdom_refuses_is_named(small_plan_dict: dict[str, Any]) -> None:
    plan = copy.deepcopy(small_plan_dict)
    urdf_changed(plan, "</robot>", '<joint name="loose" type="fixed"><parent link="nowhere"/></joint></robot>')
    (fault,) = mg.verify_plan(plan).faults
    assert fault.code == "robot-unreadable"
    assert "urdfdom" in fault.message
    assert "loose" in fault.message or "nowhere" in fault.message


@pytest.mark.parametrize("gone", [("urdfs",), ("links",), ("urdfs", "links")])
def test_plans_without_the_robot_as_it_was_read_are_refused(
    gone: tuple[str, ...], small_plan_dict: dict[str, Any]
) -> None:
    plan = copy.deepcopy(small_plan_dict)
    for key in gone:
        del plan["scenario"]["robot"][key]
    with pytest.raises(mg.InvalidInput, match=rf"scenario\.robot.*{gone[0]}"):
        mg.verify_plan(plan)


def test_a_plan_holds_where_the_robot_lies_elsewhere(
    small_plan_dict: dict[str, Any], small: dict[str, Any], write: Callable[..., Path]
) -> None:
    plan = copy.deepcopy(small_plan_dict)
    for urdf in plan["scenario"]["robot"]["urdfs"]:
        urdf["origin"] = "/home/colleague/" + Path(urdf["origin"]).name
    verdict = mg.verify_plan(plan, scenario=write(small), samples=50)
    assert verdict.ok, verdict.faults
