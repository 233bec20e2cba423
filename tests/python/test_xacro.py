"""xacro files at the door: the same robots as their expansions in the data, and errors that name files."""

from __future__ import annotations

import builtins
import json
import shutil
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from conftest import DATA
from mmgrasp.cli import main

ROBOTS = DATA / "robots"
UR = ROBOTS / "ur" / "ur_description" / "urdf"
CASES = {
    "ur5e": (UR / "ur5e.xacro", ROBOTS / "ur/expanded/ur5e.urdf"),
    "ur10e": (UR / "ur10e.xacro", ROBOTS / "ur/expanded/ur10e.urdf"),
    "ridgeback": (
        ROBOTS / "ridgeback/ridgeback_description/urdf/ridgeback.urdf.xacro",
        ROBOTS / "ridgeback/expanded/ridgeback.urdf",
    ),
    "robotiq": (
        ROBOTS / "robotiq/robotiq_3f_gripper_visualization/cfg/robotiq-3f-gripper_articulated.xacro",
        ROBOTS / "robotiq/expanded/robotiq_3f_articulated.urdf",
    ),
    "panda": (
        ROBOTS / "panda/moveit_resources_panda_description/urdf/panda.urdf.xacro",
        ROBOTS / "panda/expanded/panda.urdf",
    ),
}
pytestmark = pytest.mark.skipif(not DATA.is_dir(), reason="the shared test data is not there")


def stub_package(folder: Any, name: str) -> Any:
    """What the data's notes call a stub: a package whose macro files define nothing."""
    (folder / name / "urdf").mkdir(parents=True)
    (folder / name / "package.xml").write_text(f"<package><name>{name}</name></package>")
    for file in ("sick_lms1xx.urdf.xacro", "sick_lms1xx_upside_down.urdf.xacro"):
        (folder / name / "urdf" / file).write_text('<robot xmlns:xacro="http://ros.org/wiki/xacro"/>')
    return {name: str(folder / name)}


@pytest.mark.parametrize("name", sorted(CASES))
def test_expansion_equals_the_one_in_the_data(name: str, tmp_path: Path) -> None:
    source, expanded = CASES[name]
    packages = None
    if name == "ridgeback":
        packages = stub_package(tmp_path, "lms1xx")
        # Its Gazebo plugins are not in the data; they hold no link and no joint.
        source = shutil.copytree(source.parents[1], tmp_path / "ridgeback_description") / "urdf" / source.name
        source.parent.chmod(0o755)
        (source.parent / "ridgeback.gazebo").write_text('<robot xmlns:xacro="http://ros.org/wiki/xacro"/>')
    ours = mg.Robot.load(source, package_dirs=packages, load_meshes=False)
    theirs = mg.Robot.load(expanded, load_meshes=False)
    assert ours.links == theirs.links
    assert ours.joints == theirs.joints
    for a, b in zip(ours.joint_table, theirs.joint_table, strict=True):
        for key in ("name", "type", "parent", "child", "mimic"):
            assert a[key] == b[key]
        for limit in ("lower", "upper", "velocity"):
            assert a[limit] == pytest.approx(b[limit], abs=1e-12)
    rng = np.random.default_rng(5)
    table = {joint["name"]: joint for joint in ours.joint_table}
    for _ in range(20):
        q = {joint: rng.uniform(max(table[joint]["lower"], -3), min(table[joint]["upper"], 3)) for joint in ours.joints}
        poses, expected = ours.link_poses(q), theirs.link_poses(q)
        for link in ours.links:
            np.testing.assert_allclose(poses[link], expected[link], atol=1e-12)


def test_arguments_change_the_robot(tmp_path: Path) -> None:
    path = tmp_path / "r.urdf.xacro"
    path.write_text(
        '<robot name="r" xmlns:xacro="http://ros.org/wiki/xacro"><xacro:arg name="length" default="1"/>'
        '<xacro:arg name="tool" default="false"/><link name="a"/><link name="b"/>'
        '<joint name="j" type="fixed"><parent link="a"/><child link="b"/><origin xyz="$(arg length) 0 0"/></joint>'
        '<xacro:if value="$(arg tool)"><link name="t"/><joint name="k" type="fixed"><parent link="b"/>'
        '<child link="t"/></joint></xacro:if></robot>'
    )
    assert mg.Robot.load(path).link_poses()["b"][0, 3] == 1
    robot = mg.Robot.load(path, xacro_args={"length": 0.25, "tool": True})
    assert robot.link_poses()["b"][0, 3] == 0.25 and "t" in robot.links
    with pytest.raises(mg.InvalidInput, match="xacro_args"):
        mg.Robot.load(path, xacro_args={"length": [1]})
    with pytest.raises(mg.InvalidInput, match="xacro_args"):
        mg.Robot.load(ROBOTS / "ur/expanded/ur5e.urdf", load_meshes=False, xacro_args={"a": 1})


def test_srdf_may_be_xacro_too() -> None:
    config = ROBOTS / "panda/moveit_resources_panda_moveit_config/config"
    robot = mg.Robot.load(ROBOTS / "panda/expanded/panda.urdf", config / "panda_arm_hand.srdf.xacro", load_meshes=False)
    assert {"panda_arm", "hand"} <= set(robot.groups)


BAD = {
    "missing include": ('<xacro:include filename="none.xacro"/>', ["bad.xacro", "none.xacro"]),
    "unknown package": (
        '<xacro:include filename="$(find nowhere)/x.xacro"/>',
        ["bad.xacro", "nowhere", "package_dirs"],
    ),
    "not closed": ("<link>", ["bad.xacro", "line"]),
    "undefined": ('<link name="${nothing}"/>', ["bad.xacro", "nothing"]),
    "endless macro": ('<xacro:macro name="m"><xacro:m/></xacro:macro><xacro:m/>', ["bad.xacro"]),
    "missing argument": ('<link name="$(arg who)"/>', ["bad.xacro", "who"]),
    "fault inside the URDF": ('<link name="a"/><link name="a"/>', ["bad.xacro", "unique"]),
}


@pytest.mark.parametrize("name", sorted(BAD))
def test_errors_name_the_file(name: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    inside, reported = BAD[name]
    path = tmp_path / "bad.xacro"
    path.write_text(f'<robot name="r" xmlns:xacro="http://ros.org/wiki/xacro">{inside}</robot>')
    with pytest.raises(mg.InvalidInput) as error:
        mg.Robot.load(path)
    for word in reported:
        assert word in str(error.value), str(error.value)
    assert capfd.readouterr() == ("", "")


def test_errors_name_the_included_file(tmp_path: Path) -> None:
    (tmp_path / "inner.xacro").write_text('<robot><link name="${1 / 0}"/></robot>')
    (tmp_path / "outer.xacro").write_text(
        '<robot name="r" xmlns:xacro="http://ros.org/wiki/xacro"><xacro:include filename="inner.xacro"/></robot>'
    )
    with pytest.raises(mg.InvalidInput, match=r"outer\.xacro.*"):
        mg.Robot.load(tmp_path / "outer.xacro")


def test_entity_declarations_are_refused(tmp_path: Path) -> None:
    bomb = '<!DOCTYPE r [<!ENTITY a "x"><!ENTITY b "&a;&a;">]><robot name="&b;"/>'
    (tmp_path / "bomb.xacro").write_text(bomb)
    (tmp_path / "outer.xacro").write_text(
        '<robot name="r" xmlns:xacro="http://ros.org/wiki/xacro"><xacro:include filename="bomb.xacro"/></robot>'
    )
    for name in ("bomb.xacro", "outer.xacro"):
        with pytest.raises(mg.InvalidInput, match=r"bomb\.xacro.*DOCTYPE"):
            mg.Robot.load(tmp_path / name)


def test_without_the_package_the_error_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    real = builtins.__import__

    def without_xacro(name: str, *arguments: Any, **keywords: Any) -> Any:
        if name.split(".")[0] == "xacro":
            raise ImportError(name)
        return real(name, *arguments, **keywords)

    monkeypatch.setattr(builtins, "__import__", without_xacro)
    with pytest.raises(mg.InvalidInput, match=r"pip install 'mmgrasp\[xacro\]'"):
        mg.Robot.load(CASES["ur5e"][0])


def test_missing_files_are_io_errors(tmp_path: Path) -> None:
    with pytest.raises(mg.IoError, match=r"none\.xacro"):
        mg.Robot.load(tmp_path / "none.xacro")
    with pytest.raises(mg.IoError, match=r"none\.srdf"):
        mg.Robot.load(CASES["ur5e"][0], tmp_path / "none.srdf")


def test_threads_do_not_mix_their_robots() -> None:
    names = {}

    def load(key: Any) -> None:
        names[key] = [mg.Robot.load(CASES[key][0], load_meshes=False).name for _ in range(3)]

    threads = [threading.Thread(target=load, args=(key,)) for key in ("ur5e", "ur10e", "panda")]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert names == {"ur5e": ["ur5e_robot"] * 3, "ur10e": ["ur10e_robot"] * 3, "panda": ["panda"] * 3}


def test_check_reads_xacro(capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(CASES["ur5e"][0]), "--json"]) == 0
    assert json.loads(capfd.readouterr().out)["name"] == "ur5e_robot"
