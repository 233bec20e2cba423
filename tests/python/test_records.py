"""The dicts inside results have exactly the keys, and values of the types, that mmgrasp.records says."""

from __future__ import annotations

import re
import types
import typing
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp import _core, records
from mmgrasp._files import shipped

ROOT = Path(__file__).resolve().parents[2]


def check(value: object, annotation: Any, place: str) -> None:
    """Fails where the value is not what the annotation says."""
    origin, arguments = typing.get_origin(annotation), typing.get_args(annotation)
    if typing.is_typeddict(annotation):
        assert isinstance(value, dict), place
        fields = typing.get_type_hints(annotation)
        assert value.keys() == fields.keys(), place
        for key, kind in fields.items():
            check(value[key], kind, f"{place}.{key}")
    elif origin is list:
        assert isinstance(value, list), place
        for entry in value:
            check(entry, arguments[0], place)
    elif origin is dict:
        assert isinstance(value, dict), place
        for key, entry in value.items():
            check(key, arguments[0], place)
            check(entry, arguments[1], f"{place}[{key!r}]")
    elif origin is types.UnionType:
        if value is not None:
            check(value, arguments[0], place)
    elif origin is np.ndarray:
        assert isinstance(value, np.ndarray) and value.dtype == typing.get_args(arguments[1])[0], place
    else:
        assert type(value) is annotation, f"{place} = {value!r}"


@pytest.fixture(scope="module")
def robot() -> mg.Robot:
    folder = shipped("asset:robots/tm14like")
    return mg.Robot.load(folder / "tm14like.urdf", folder / "tm14like.srdf", base="omni")


def test_robot(robot: mg.Robot) -> None:
    check(robot.report, records.RobotReport, "report")
    check(robot.joint_table, list[records.JointRow], "joint_table")
    check(robot.groups, dict[str, records.GroupRow], "groups")
    check(robot.end_effectors, list[records.EndEffectorRow], "end_effectors")
    assert robot.joint_table and robot.groups and robot.end_effectors
    source = robot.with_link("camera", robot.links[0], np.eye(4), [mg.LinkShape(mg.Sphere(0.01))]).source
    check(source.urdfs, list[records.UrdfRow], "urdfs")
    check(source.added_links, list[records.AddedLinkRow], "added_links")
    assert source.urdfs and source.added_links


def test_world() -> None:
    world = mg.World()
    world.add_box("table", (1, 1, 1), np.eye(4))
    world.padding = {"links": 0.01, "by_name": {"table": 0.0}}
    check(world.padding, records.WorldPadding, "padding")
    again = mg.World()
    again.padding = world.padding
    assert again.padding == world.padding == {"links": 0.01, "attached": 0.0, "objects": 0.0, "by_name": {"table": 0.0}}


def test_counts_of_grasps_in_maps() -> None:
    hand = mg.Hand("tool", approach=[1, 0, 0], closing=[0, 1, 0], max_opening=0.1, finger_depth=0.04, finger_width=0.02)
    height = np.zeros((60, 60), np.float32)
    height[25:35, 20:40] = 0.03
    found = mg.grasping.evaluate_graspability(mg.mapping.HeightMap(height, 0.004), hand)
    check(found.counts, records.GraspabilityCounts, "counts")
    sdf = mg.ProbabilisticSdf()
    camera = mg.mapping.DepthCamera(mg.mapping.PinholeCamera())
    eye = mg.mapping.look_down([0, 0, 0.5])
    scene = [mg.LinkShape(mg.Box([0.6, 0.6, 0.02])), mg.LinkShape(mg.Box([0.04, 0.08, 0.06]), mg.pose([0, 0, 0.04]))]
    sdf.integrate(mg.mapping.render_depth(scene, mg.mapping.PinholeCamera(), eye), camera)
    synthesis = mg.synthesize_grasps(sdf, hand, table=0.01)
    check(synthesis.counts, records.SynthesisCounts, "counts")
    assert synthesis.counts["drawn"] > 0


def test_message_of_a_trajectory() -> None:
    motion = mg.time_parameterize([[0.0], [1.0]], [1.0], [1.0], names=["a"])
    check(motion.to_joint_trajectory(), records.MotionMessage, "message")


def test_mesh(tmp_path: typing.Any) -> None:
    file = tmp_path / "one.obj"
    file.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    check(_core.simplify_mesh(mg.Mesh.load(file), 0.5), records.MeshStandIn, "simplify_mesh")
    urdf = f'<robot name="r"><link name="l"><collision><geometry><mesh filename="{file}"/></geometry></collision></link></robot>'
    report = mg.Robot.from_strings(urdf).report
    check(report, records.RobotReport, "report")
    assert len(report["meshes"]) == 1


def test_planning(robot: mg.Robot) -> None:
    arm = robot.group(next(iter(robot.groups)))
    roadmap = _core.Roadmap.build(arm, vertices=50)
    check(roadmap.statistics, records.RoadmapStatistics, "figures")
    q = 0.5 * (arm.sample_lower + arm.sample_upper)
    problem = mg.ManipulationProblem(
        arm, mg.World(), mg.LinkShape(mg.Box([0.02, 0.02, 0.02])), arm.fk(q), arm.fk(q), [np.eye(4)]
    )
    result = mg.plan_manipulation(problem, time_limit=0.2, vertices=50, max_vertices=0)
    check(result.stats.stages, dict[str, records.StageRow], "stages")


def struct_fields(header: str, struct: str) -> dict[str, str]:
    """The fields of a struct of a public header, with their types, as they are written there."""
    text = (ROOT / "cpp/include/mmgrasp" / header).read_text()
    body = re.search(rf"struct MMGRASP_EXPORT {struct} \{{\n(.*?)\n\}};", text, re.DOTALL)
    assert body, f"{header} has no {struct}"
    fields: dict[str, str] = {}
    for statement in re.sub(r"//.*", "", body[1]).split(";"):
        if kind := re.match(r"\s*(std::vector<\w+>|std::size_t|double|int)\s+(.*)", statement, re.DOTALL):
            fields |= {name.split("=")[0].strip(): kind[1] for name in kind[2].split(",")}
        else:
            assert not statement.strip(), statement
    return fields


@pytest.mark.parametrize(("header", "struct"), [("manipulation", "ManipulationStats"), ("motion", "MotionStats")])
def test_statistics_are_the_structs(header: str, struct: str) -> None:
    """A field that is added to the struct is there in Python too."""
    fields = struct_fields(f"plan/{header}.hpp", struct)
    bound = getattr(mg.planning, struct)
    assert {name for name in dir(bound) if name[0] != "_"} - {"to_dict"} == fields.keys()


def test_statistics_as_a_dict_hold_every_field(robot: mg.Robot) -> None:
    arm = robot.group(next(iter(robot.groups)))
    q = 0.5 * (arm.sample_lower + arm.sample_upper)
    box = mg.LinkShape(mg.Box([0.02, 0.02, 0.02]))
    problem = mg.ManipulationProblem(arm, mg.World(), box, arm.fk(q), arm.fk(q), [np.eye(4)])
    stats = mg.plan_manipulation(problem, time_limit=0.2, vertices=50, max_vertices=0).stats
    assert stats.to_dict().keys() == struct_fields("plan/manipulation.hpp", "ManipulationStats").keys()
    assert all(getattr(stats, name) == value for name, value in stats.to_dict().items())
    assert stats.search_seconds >= 0


def test_platform_locations(robot: mg.Robot) -> None:
    arm = robot.group(next(iter(robot.groups)), with_base=True)
    checker = mg.CollisionChecker(robot, mg.World(), arm)
    far = mg.pose((100, 0, 100))
    found = _core.plan_platform_locations(checker, far, far, samples=1, max_draws=2)
    check(found.pick, records.SearchCounts, "pick")


def test_drive_by(robot: mg.Robot) -> None:
    arm = robot.group(next(iter(robot.groups)), with_base=True)
    q = np.concatenate([[0, 0, 0], 0.5 * (arm.sample_lower + arm.sample_upper)[3:]])
    task = mg.DriveByTask(arm.fk(q))
    result = mg.plan_drive_by(
        robot, arm, mg.World(), start=q, tasks=[task], goal=q, seeds=1, iterations=30, collisions=False
    )
    assert result.events and result.violations
    check(result.events, list[records.DriveByEventRow], "events")
    check(result.violations, dict[str, records.ViolationRow], "violations")
