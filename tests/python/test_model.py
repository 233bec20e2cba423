"""Base motion, SRDFs written and read, stand-ins of meshes, and what `mmgrasp check` says of them."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from conftest import ASSETS, DATA
from mmgrasp.cli import main

FETCH = ASSETS / "robots" / "fetchlike"
CUBE = """solid cube
{}endsolid cube
"""


def fetch(**options: Any) -> mg.Robot:
    return mg.Robot.load(FETCH / "fetchlike.urdf", FETCH / "fetchlike.srdf", base="diff_drive", **options)


def write_box(path: Path, size: np.ndarray) -> None:
    """An ASCII STL of a box, corner at the origin."""
    corners = [np.array([x, y, z]) * size for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    facets = ""
    for a, b, c, d in sides:
        for triangle in ((a, b, c), (a, c, d)):
            lines = "".join("vertex {} {} {}\n".format(*corners[i]) for i in triangle)
            facets += f"facet normal 0 0 0\nouter loop\n{lines}endloop\nendfacet\n"
    path.write_text(CUBE.format(facets))


def test_base_motion() -> None:
    np.testing.assert_allclose(mg.base.platform_velocity(math.pi / 2, [0.0, 0.5, 0.2]), [0.5, 0, 0.2], atol=1e-15)
    np.testing.assert_allclose(mg.base.joint_velocity(math.pi / 2, [0.5, 0, 0.2]), [0, 0.5, 0.2], atol=1e-15)
    left, right = mg.base.wheel_speeds(0.5, 0.6, wheel_separation=0.4)
    assert (left, right) == pytest.approx((0.38, 0.62))
    np.testing.assert_allclose(mg.base.platform_velocity(left=left, right=right, wheel_separation=0.4), [0.5, 0, 0.6])
    for bad in ([0.1, 0.2], [0, math.nan, 0], "xyz"):
        with pytest.raises(mg.InvalidInput, match="joint_velocity"):
            mg.base.platform_velocity(0.0, bad)
    with pytest.raises(mg.InvalidInput, match="wheel_separation"):
        mg.base.wheel_speeds(0.1, 0.1, wheel_separation=0)


def test_wheel_limits_reach_the_robot() -> None:
    robot = fetch(base_limits={"wheel_velocity": 0.5, "wheel_separation": 0.4})
    assert robot.base_limits["wheel_velocity"] == 0.5
    assert robot.velocity_scale([0.6, 0, 1.0]) == pytest.approx(0.5 / 0.8)
    assert robot.velocity_scale([0.1, 0.1, 0]) == 0
    assert fetch().base_limits["wheel_velocity"] == math.inf
    assert fetch(base_limits=fetch().base_limits).hash == fetch().hash  # what was read may be given back
    with pytest.raises(mg.InvalidInput, match="wheel_velocity"):
        fetch(base_limits={"wheel_velocity": -1})
    with pytest.raises(mg.InvalidInput, match="wheel_separation"):
        fetch(base_limits={"wheel_seperation": 0.4})


def test_wheel_limits_slow_a_drive() -> None:
    path = {}
    for velocity in (None, 0.3):
        robot = fetch(base_limits={"wheel_velocity": velocity, "linear_acceleration": 0.5, "linear_velocity": 0.6})
        arm = robot.group("arm_with_torso")
        home = np.clip(np.zeros(len(arm.names)), arm.lower, arm.upper)
        route = mg.base.plan_base_route(arm, mg.World(), home=home, start=[0, 0, 0], goal=[3, 0, 0])
        path[velocity] = route.duration(robot)
    assert path[None] == pytest.approx(3 / 0.6 + 0.6 / 0.5)
    assert path[0.3] == pytest.approx(3 / 0.3 + 0.3 / 0.5)


def test_check_writes_an_srdf_with_the_computed_pairs(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    target = tmp_path / "new" / "fetch.srdf"
    assert main(["check", str(FETCH / "fetchlike.urdf"), "--write-srdf", str(target)]) == 0
    capfd.readouterr()
    plain = mg.Robot.load(FETCH / "fetchlike.urdf")
    sampled = mg.robot.with_sampled_pairs(plain)
    again = mg.Robot.load(FETCH / "fetchlike.urdf", target)
    assert again.disabled_pairs == sampled.disabled_pairs
    assert {"adjacent", "never"} <= {reason for *_, reason in again.disabled_pairs}
    assert len(again.disabled_pairs) > len(plain.disabled_pairs)
    # With an SRDF given, groups, states and the rest are kept. It is written beside: what is there is not replaced.
    target = target.with_name("full.srdf")
    assert (
        main(
            [
                "check",
                str(FETCH / "fetchlike.urdf"),
                "--srdf",
                str(FETCH / "fetchlike.srdf"),
                "--write-srdf",
                str(target),
            ]
        )
        == 0
    )
    full = mg.Robot.load(FETCH / "fetchlike.urdf", target)
    original = mg.Robot.load(FETCH / "fetchlike.urdf", FETCH / "fetchlike.srdf")
    assert full.groups == original.groups and full.group_states == original.group_states
    assert set(original.disabled_pairs) <= set(full.disabled_pairs)


def test_an_srdf_is_not_written_with_meshes_missing(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    urdf = '<robot name="r"><link name="a"><collision><geometry><mesh filename="no.stl"/></geometry></collision></link></robot>'
    (tmp_path / "r.urdf").write_text(urdf)
    assert main(["check", str(tmp_path / "r.urdf"), "--write-srdf", str(tmp_path / "r.srdf")]) == 2
    assert "no.stl" in capfd.readouterr().err
    assert not (tmp_path / "r.srdf").exists()


def test_check_tells_what_stands_in_for_a_mesh(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    write_box(tmp_path / "part.stl", np.array([0.2, 0.3, 0.4]))
    urdf = (
        '<robot name="r"><link name="a"><collision><geometry><mesh filename="part.stl"/></geometry></collision></link>'
        '<link name="b"/><joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint></robot>'
    )
    (tmp_path / "r.urdf").write_text(urdf)
    assert main(["check", str(tmp_path / "r.urdf")]) == 0
    line = next(line for line in capfd.readouterr().out.splitlines() if line.startswith("mesh"))
    assert "checked as box" in line and "saves 12 triangles" in line and "the same solid" in line
    robot = mg.Robot.load(tmp_path / "r.urdf")
    (shape,) = robot.collisions("a")
    assert isinstance(shape.shape, mg.Box) and sorted(shape.shape.size) == pytest.approx([0.2, 0.3, 0.4])
    np.testing.assert_allclose(np.array(shape.bounds), np.array([[0, 0, 0], [0.2, 0.3, 0.4]]), atol=1e-9)
    assert robot.report["meshes"][0]["chosen"] == "box"
    again = mg.Robot.from_strings(robot.to_urdf())
    np.testing.assert_allclose(again.collisions("a")[0].bounds, shape.bounds, atol=1e-12)


def test_simplify_mesh_of_arrays() -> None:
    shape = mg.LinkShape(mg.Cylinder(0.05, 0.3)).surface(segments=48)
    assert mg.collision.simplify_mesh(shape)["chosen"] == "hull"
    found = mg.collision.simplify_mesh(shape, 0.001)
    assert found["chosen"] == "cylinder" and 0 < found["deviation"] <= 0.001
    assert found["triangles_saved"] == len(shape.triangles)
    with pytest.raises(mg.InvalidInput, match="mesh_tolerance"):
        mg.collision.simplify_mesh(shape, -1.0)


@pytest.mark.skipif(not DATA.is_dir(), reason="the shared test data is not there")
def test_tolerance_at_the_door_and_in_the_command(capfd: pytest.CaptureFixture[str]) -> None:
    urdf = DATA / "robots/wsg50/wsg_50_simulation/urdf/wsg_50.urdf"
    simple = mg.Robot.load(urdf, mesh_tolerance=0.01)
    assert all(mesh["deviation"] <= 0.01 for mesh in simple.report["meshes"])
    assert any(mesh["chosen"] in ("box", "cylinder", "hull") for mesh in simple.report["meshes"])
    assert main(["check", str(urdf), "--mesh-tolerance", "0.01", "--json"]) == 0
    report = json.loads(capfd.readouterr().out)["report"]
    assert report["meshes"] == simple.report["meshes"]
    with pytest.raises(mg.InvalidInput, match="mesh_tolerance"):
        mg.Robot.load(urdf, mesh_tolerance=-0.01)


def test_find_package(tmp_path: Path) -> None:
    (tmp_path / "ws/pkg_folder/urdf").mkdir(parents=True)
    (tmp_path / "ws/pkg_folder/package.xml").write_text("<package><name>pkg</name></package>")
    assert mg.robot.find_package("pkg", tmp_path / "ws/pkg_folder/urdf") == str(tmp_path / "ws/pkg_folder")
    assert mg.robot.find_package("other", tmp_path) == ""
    assert mg.robot.find_package("other", tmp_path, {"other": str(tmp_path)}) == str(tmp_path)
