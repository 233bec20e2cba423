"""Bad scenarios: one clear message that names file, line, key, value and rule, and the right exit code. Never a traceback."""

from __future__ import annotations

import copy
import json
import math
import re
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
import yaml

import mmgrasp as mg
from conftest import ASSETS, REMOVE, edited
from mmgrasp.cli import main
from mmgrasp.part_supply import plan_schema

BAD = [
    # path, value, pieces of the message
    ("format", "mmgrasp-plan", ["format", "mmgrasp-scenario"]),
    ("format", REMOVE, ["format"]),
    ("version", 1, ["version", "1", "reads version 3"]),
    ("carry", {}, ["unknown key; it is called place_region now"]),
    ("robot.tcp", "gripper_tcp", ["robot.tcp", "unknown key; it is called tool_link now"]),
    ("place_region.drop_gap", 0.03, ["place_region.drop_gap", "unknown key; it is called drop_height now"]),
    ("traays", [], ["traays", "did you mean trays?"]),
    ("start", REMOVE, ["start is missing"]),
    ("start", [0, 0], ["start", "3 numbers"]),
    ("start", [0, 0, math.nan], ["start[2]", "nan", "finite"]),
    ("start", "here", ["start", "'here'", "list"]),
    ("positioning_uncertainty", -0.1, ["positioning_uncertainty", "-0.1", ">= 0"]),
    ("positioning_uncertainty", math.inf, ["positioning_uncertainty", "inf", "finite"]),
    ("positioning_uncertainty", True, ["positioning_uncertainty", "True", "number"]),
    ("robot.urdf", "asset:robots/nothing.urdf", ["robot.urdf", "no such file"]),
    ("robot.srdf", "missing.srdf", ["robot.srdf", "missing.srdf", "no such file"]),
    ("robot.base", "wheels", ["robot.base", "wheels", "diff_drive"]),
    ("robot.base", "fixed", ["robot", "diff_drive"]),
    ("robot.group", "arm_with_torsoo", ["robot.group", "did you mean arm_with_torso?"]),
    ("robot.group", {"base_link": "nowhere"}, ["robot.group.base_link", "nowhere", "no such link"]),
    ("robot.tool_link", "gripper_tpc", ["robot.tool_link", "did you mean gripper_tcp?"]),
    ("robot.home.elbow", 1.0, ["robot.home.elbow", "elbow_flex_joint"]),
    ("robot.home.elbow_flex_joint", REMOVE, ["robot.home", "elbow_flex_joint"]),
    ("robot.home.shoulder_lift_joint", 9.0, ["shoulder_lift_joint", "9.0", "must be in"]),
    ("robot.joints.head", 0.0, ["robot.joints.head", "head_"]),
    ("robot.mesh_tolerance", -0.01, ["robot.mesh_tolerance", ">= 0"]),
    ("robot.base_limits.speed", 1.0, ["robot.base_limits.speed", "unknown key"]),
    ("robot.base_limits.linear_velocity", 0, ["linear_velocity", "0.001"]),
    ("robot.mount", [{"urdf": "none.urdf", "parent_link": "x"}], ["robot.mount[0].urdf", "no such file"]),
    ("robot.frames", [{"name": "tip2", "parent": "nope"}], ["robot.frames[0].parent", "nope"]),
    ("gripper", {"from_robot": "thumb"}, ["gripper", "thumb"]),
    ("gripper", {"from_robot": 3}, ["gripper.from_robot", "SRDF"]),
    ("gripper", {"from_robot": True, "max_opening": 0.1}, ["gripper.max_opening", "unknown key"]),
    ("gripper", {"from_robot": True, "closing": [0, 0, 2]}, ["gripper.closing", "unit"]),
    ("gripper.approach", [1, 1, 0], ["gripper.approach", "unit"]),
    ("gripper.closing", [1, 0, 0], ["gripper.closing", "orthogonal"]),
    ("gripper.max_opening", 0, ["gripper.max_opening", "> 0"]),
    ("gripper.clearance", 0.051, ["gripper.clearance = 0.051", "at most 0.05 m", "half of what the gripper opens by"]),
    ("gripper", {"from_robot": True, "clearance": 0.3}, ["gripper.clearance = 0.3", "at most 0.05 m"]),
    ("gripper.joints.0.name", "finger", ["gripper.joints[0]", "finger"]),
    ("gripper.joints.0.open", 5.0, ["gripper.joints[0].open", "5.0"]),
    ("gripper.finger_links", ["thumb"], ["gripper.finger_links[0]", "thumb"]),
    ("place_region.size", [0.3, 0, 0.1], ["place_region.size[1]", "0", "> 0"]),
    ("place_region.parent", "gripper_link", ["place_region", "gripper_link"]),
    ("place_region.pose", {"xyz": [-0.1, 0, 0.6], "rpy": [0.3, 0, 0]}, ["place_region.pose", "level"]),
    ("obstacles.0.box", [0, 1, 1], ["obstacles[0].box[0]", "0", "> 0"]),
    ("obstacles.0.boxx", [1, 1, 1], ["obstacles[0].boxx", "did you mean box?"]),
    ("obstacles.0.pose", {"xyz": [1, 2]}, ["obstacles[0].pose.xyz", "3 numbers"]),
    ("obstacles.0.pose", {"xyz": [1, 2, 3], "quat_xyzw": [0, 0, 0, 2]}, ["quat_xyzw", "norm"]),
    ("obstacles.0.name", "wall north", ["wall north", "twice"]),
    ("obstacles.0", {"name": "rack", "mesh": "rack.stl"}, ["obstacles[0].mesh", "rack.stl", "no such file"]),
    ("obstacles.0", {"name": "rack", "mesh": "../bad.stl"}, ["obstacles[0].mesh", "bad.stl"]),
    ("obstacles.0", {"name": "rack"}, ["obstacles[0]", "exactly one of", "box"]),
    ("part_types.bracket.box", [0.03, 0.05, 0], ["part_types.bracket.box[2]", "> 0"]),
    ("part_types.bracket.cylinder", {"radius": 1, "length": 1}, ["part_types.bracket", "exactly one of"]),
    ("part_types.bracket.box", [0.14, 0.14, 0.14], ["bracket", "wall"]),
    ("part_types.bracket.grasp_options", {"approachs": 4}, ["approachs", "did you mean approaches?"]),
    ("part_types.bracket.grasp_options", {"friction": -1}, ["grasp_options", "friction"]),
    (
        "part_types.bracket.grasps",
        [{"pose": {"xyz": [0, 0, 0.1]}, "opening": 0.03}, {"pose": {"xyz": [0, 0, 0]}, "opening": 0.03}],
        ["part_types.bracket.grasps", "1 of 2 grasps hold nothing of part type bracket", "(0, 0, 0.1)"],
    ),
    (
        "part_types.bracket.grasps",
        [{"pose": {"xyz": [0, 0, 0]}, "opening": 0.05}, {"pose": {"xyz": [0, 0, 0]}, "opening": 0.03}],
        ["part_types.bracket.grasps[1].opening", "0.03", "meet the part at 0.05"],
    ),
    ("trays.0.parts.type", "braket", ["trays[0].parts.type", "did you mean bracket?"]),
    ("trays.0.parts.grid", [3, 0], ["trays[0].parts.grid[1]", ">= 1"]),
    ("trays.0.parts.grid", [3, 40], ["trays[0].parts", "wall"]),
    ("trays.0.parts.spacing", [0.08], ["trays[0].parts.spacing", "2 numbers"]),
    ("trays.0.size", [0.3, 0.4, -1], ["trays[0].size[2]", "> 0"]),
    ("trays.0.targets", [99], ["trays[0].targets[0]", "99"]),
    ("trays.0.targets", ["bracket_99"], ["trays[0].targets[0]", "bracket_99"]),
    ("trays.0.targets", [], ["trays", "at least one"]),
    ("trays.0.pose", {"xyz": [2.78, -1.3, 0.706], "rpy": [0.9, 0, 0]}, ["trays[0].pose", "45 degrees"]),
    ("trays.0.size", "R-KLT 4351", ["trays[0].size", "did you mean R-KLT 4315?"]),
    ("trays.0.wall", 0.15, ["trays[0].size", "room between walls of 0.15"]),
    ("trays.0.wall", [0.01, 0.01], ["trays[0].wall", "3 numbers"]),
    ("trays.0.walls", {"front": 0.2}, ["trays[0].walls.front", "higher than the tray"]),
    ("trays.0.walls", {"frnt": 0.0}, ["trays[0].walls.frnt", "did you mean front?"]),
    ("trays.0.roof", 0.05, ["trays[0].roof", "highest wall"]),
    ("trays.0.body", {"mesh": "bin.stl"}, ["trays[0].body.mesh", "bin.stl", "no such file"]),
    ("trays.0.body", {"box": [0.3, 0.4, 0.1]}, ["trays[0].parts", "overlaps tray A"]),
    ("trays", [], ["trays", "at least one"]),
    ("options.grid_resolutoin", 0.05, ["did you mean grid_resolution?"]),
    ("options.grid_resolution", 0, ["options", "resolution", "0"]),
    ("options.grid_resolution", "fine", ["options.grid_resolution", "number"]),
    ("options.seed", 1.5, ["options.seed", "1.5", "whole number"]),
    ("reach.samples", 0, ["reach", "samples", "0"]),
    ("reach.samples", 100, ["reach.samples = 100: must be at least 10000"]),
    ("reach.sample", 10, ["reach.sample", "did you mean samples?"]),
    ("options.lift_height", 0.001, ["options.lift_height", "0.001", "[0.01, 10] m"]),
    ("options.route_resolution", 1e-4, ["options.route_resolution", "[0.001, 100] m"]),
    ("options.robustness_samples", 2_000_000_000, ["options.robustness_samples", "base poses"]),
    ("options.threads", 1_000_000_000, ["options.threads", "1024"]),
    ("options.motion_time_limit", 1e6, ["options.motion_time_limit", "86400 s"]),
    ("part_types.bracket.grasp_options", {"approaches": 1_000_000_000}, ["approaches", "360"]),
    ("part_types.bracket.grasp_options", {"positions": 1_000_000_000}, ["positions", "100"]),
    ("part_types.bracket.grasp_options", {"mesh_samples": 1_000_000_000}, ["mesh_samples", "100000"]),
    ("robot.urdf", "~nosuchuser/x.urdf", ["robot.urdf", "no such file"]),
    ("robot.urdf", "x" * 5000, ["robot.urdf", "no such file"]),
    ("robot.xacro_args", {"a": 1}, ["robot.xacro_args", "only a .xacro file"]),
    ("robot.base_limits.linear_velocity", 1e-300, ["linear_velocity", ">= 0.001"]),
    ("robot.base_limits.angular_acceleration", 1e-6, ["angular_acceleration", ">= 0.001"]),
    ("robot.base_limits.workspace", 0.5, ["start", "base_limits.workspace"]),
    ("robot.frames", [{"name": "base_link", "parent": "base_link"}], ["robot.frames[0].name", "already"]),
    ("robot.frames", [{"name": "place_bin", "parent": "base_link"}], ["robot.frames[0].name", "already"]),
    ("robot.joints.elbow_flex_joint", 0.0, ["elbow_flex_joint", "a joint of the arm"]),
    ("gripper.joints.0.name", "elbow_flex_joint", ["gripper.joints[0].name", "a joint of the arm"]),
    ("gripper.finger_links", [], ["gripper.finger_links", "at least two"]),
    ("gripper.finger_links", ["left_gripper_finger_link"], ["gripper.finger_links", "at least two"]),
    ("gripper.finger_links", ["left_gripper_finger_link"] * 2, ["gripper.finger_links", "each once"]),
    (
        "gripper.finger_links",
        ["left_gripper_finger_link", "base_link"],
        ["gripper.finger_links[1]", "no part of the hand"],
    ),
    ("gripper.closing_speed", 0, ["gripper.closing_speed", ">= 0.0001"]),
    ("gripper.closing_speed", 11, ["gripper.closing_speed", "10"]),
    ("place_region.size", [0.3, 1e-300, 0.1], ["place_region.size[1]", "at least 1e-06"]),
    ("name", "\x1b[31mred", ["name", "control characters"]),
    ("trays.0.name", "x" * 5000, ["trays[0].name", "at most 200 characters"]),
    ("trays.0.size", [300, 400, 100], ["trays[0].size", "at most 100 m", "lengths are in metres"]),
    (
        "trays.0.pose.xyz",
        [2780, -1300, 706],
        ["trays[0].pose", "2780 m off", "workspace, 100 m", "lengths are in metres"],
    ),
    ("trays.0.parts.spacing", [0.02, 0.08], ["trays[0].parts", "overlaps part"]),
    ("trays.0.pose.xyz", [2.93, -1.3, 0.706], ["trays[0].parts", "A/", "overlaps wall east"]),
    (
        "gripper.joints.0.closed",
        0.02,
        ["gripper.joints", "left_gripper_finger_link moves 0.03 m", "half of max_opening, 0.05 m"],
    ),
    ("gripper.max_opening", 0.08, ["gripper.joints", "moves 0.05 m", "half of max_opening, 0.04 m"]),
    ("start", [2.8, -0.7, 0], ["start", "in collision", "touches"]),
    ("goal", [2.8, -0.7, 0], ["goal", "in collision", "touches"]),
]


@pytest.mark.parametrize(("path", "value", "pieces"), BAD, ids=[f"{i:02d}-{entry[0]}" for i, entry in enumerate(BAD)])
def test_bad_scenario_gets_one_message(
    small: dict[str, Any],
    write: Callable[..., Path],
    capfd: pytest.CaptureFixture[str],
    tmp_path: Path,
    path: Any,
    value: Any,
    pieces: list[str],
) -> None:
    file = write(edited(small, path, value))
    (file.parent.parent / "bad.stl").write_text("solid nothing\n")
    assert main(["plan", str(file), "-o", str(tmp_path / "out")]) == 2
    message = capfd.readouterr().err
    error = [line for line in message.splitlines() if line.startswith("mmgrasp: ")]
    assert len(error) == 1, message
    assert "Traceback" not in message
    assert re.search(rf"{file.name}:\d+: ", error[0])
    for piece in pieces:
        assert piece in error[0]
    assert not (tmp_path / "out").exists()


def test_joints_that_crawl_are_refused(small: dict[str, Any], write: Callable[..., Path], tmp_path: Path) -> None:
    """Motions of days have more samples than memory: joint and value are named, at the scenario's line."""
    source = (ASSETS / "robots" / "fetchlike" / "fetchlike.urdf").read_text()
    for velocity in ("0.0001", "1e-300"):
        text, count = re.subn(
            r'(<joint name="elbow_flex_joint".*?velocity=")[^"]*', rf"\g<1>{velocity}", source, flags=re.S
        )
        assert count == 1
        (tmp_path / "slow.urdf").write_text(text)
        scenario = edited(small, "robot.urdf", str(tmp_path / "slow.urdf"))
        with pytest.raises(
            mg.InvalidInput, match=rf"scenario\.yaml:\d+: robot\.group.*elbow_flex_joint .* {velocity} "
        ):
            mg.load_scenario(write(scenario))


def test_reading_tells_of_which_part_it_seeks_grasps(small_path: Path, small: dict[str, Any]) -> None:
    heard: list[tuple[str, float]] = []
    mg.load_scenario(small_path, progress=lambda *now: heard.append(now))
    types = list(small["part_types"])
    assert len(types) > 1
    of_parts = [now for now in heard if now[0].startswith("grasps of ")]
    assert list(dict.fromkeys(of_parts)) == [(f"grasps of {name}", i / len(types)) for i, name in enumerate(types)]


def test_part_larger_than_the_gripper(small: dict[str, Any], write: Callable[..., Path]) -> None:
    scenario = edited(small, "part_types.bracket.box", [0.12, 0.12, 0.12])
    scenario["trays"][0]["parts"] = [{"type": "bracket", "xyz": [0, 0]}]
    scenario["trays"][0]["targets"] = "all"
    with pytest.raises(mg.InvalidInput, match=r"part_types\.bracket.*larger than the gripper.*0\.1 m"):
        mg.load_scenario(write(scenario))


def test_messages_name_the_line(small: dict[str, Any], write: Callable[..., Path]) -> None:
    text = yaml.safe_dump(small, sort_keys=False)
    number = next(i for i, line in enumerate(text.splitlines(), 1) if line.startswith("positioning_uncertainty"))
    file = write(text.replace("positioning_uncertainty: 0.1", "positioning_uncertainty: -1"))
    with pytest.raises(mg.InvalidInput, match=re.escape(f"{file}:{number}: positioning_uncertainty = -1")):
        mg.load_scenario(file)


@pytest.mark.parametrize(
    ("text", "piece"),
    [
        ("", "format"),
        ("just a word", "format"),
        ("- a\n- list\n", "format"),
        ("a: [1, 2\nb: 3\n", "is no valid YAML"),
        ("format: mmgrasp-scenario\nformat: mmgrasp-scenario\n", ":2: format: is given twice"),
        ("1: 2\n", "a key must be a name"),
        ("a: !!python/object:os.system x\n", "is no valid YAML"),
        ("a: " + "[" * 80 + "]" * 80, "deep"),
    ],
)
def test_what_is_no_scenario(write: Callable[..., Path], text: Any, piece: str) -> None:
    with pytest.raises(mg.InvalidInput, match=re.escape(piece)):
        mg.load_scenario(write(text))


def test_unreadable_files(tmp_path: Path) -> None:
    with pytest.raises(mg.IoError, match=r"none\.yaml"):
        mg.load_scenario(tmp_path / "none.yaml")
    (tmp_path / "binary.yaml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(mg.IoError, match="UTF-8"):
        mg.load_scenario(tmp_path / "binary.yaml")
    with pytest.raises(mg.IoError):
        mg.load_scenario(tmp_path)


def test_no_plan_is_explained(
    small: dict[str, Any], write: Callable[..., Path], capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    file = write(edited(small, "positioning_uncertainty", 0.9))
    assert main(["plan", str(file), "-o", str(tmp_path), "--no-pictures"]) == 4
    assert "uncertainty" in capfd.readouterr().out
    plan = json.loads((tmp_path / "plan.json").read_text())
    assert plan["outcome"] != "solved"
    assert plan["obstructions"]
    jsonschema.validate(plan, plan_schema())
    assert main(["verify", str(tmp_path / "plan.json")]) == 1


@pytest.mark.slow
def test_tray_out_of_reach_is_explained(
    small: dict[str, Any], write: Callable[..., Path], capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    scenario = edited(small, "trays.0.pose.xyz", [2.78, -1.3, 3.5])  # grasps are sampled: farther than any hand
    assert main(["plan", str(write(scenario)), "-o", str(tmp_path), "--no-pictures"]) == 3
    assert "A" in capfd.readouterr().out
    plan = json.loads((tmp_path / "plan.json").read_text())
    assert plan["outcome"] == "infeasible"  # proven: the arm is too short, wherever the base stands
    assert any(o["tray"] == "A" for o in plan["obstructions"])
    low = edited(small, "trays.0.pose.xyz", [2.78, -1.3, 1.35])  # out of reach too, but not for links stretched out
    assert main(["plan", str(write(low)), "-o", str(tmp_path), "--no-pictures"]) == 4


def test_parts_lie_where_the_grid_says(small_path: Path) -> None:
    scenario = mg.load_scenario(small_path)
    tray = scenario.trays[0].tray
    assert [p.name for p in tray.parts[:2]] == ["A/bracket_00", "A/bracket_01"]
    first = np.linalg.inv(tray.T_world_tray) @ tray.parts[0].T_world_part
    np.testing.assert_allclose(first[:3, 3], [-0.08, -0.12, 0.036], atol=1e-12)
    assert [p.name for p in tray.parts if p.target] == ["A/bracket_00", "A/bracket_03"]
    walls = scenario.world.shapes_of("tray A")
    low = np.min([w.bounds[0] for w in walls], axis=0)
    high = np.max([w.bounds[1] for w in walls], axis=0)
    np.testing.assert_allclose(high - low, [0.30, 0.40, 0.10], atol=1e-12)


def test_listed_parts_and_own_grasps(small: dict[str, Any], write: Callable[..., Path]) -> None:
    scenario = copy.deepcopy(small)
    pose = {"xyz": [0, 0, 0.01], "rpy": [0, math.pi / 2, 0]}
    scenario["part_types"]["bracket"]["grasps"] = [{"pose": pose, "opening": 0.05}, {"pose": pose, "opening": 0.2}]
    scenario["trays"][0]["parts"] = [
        {"type": "bracket", "xyz": [0.05, 0.0], "rpy": [0, 0, 0.3], "name": "left"},
        {"type": "bracket", "xyz": [-0.05, 0.0, 0.1]},
    ]
    scenario["trays"][0]["targets"] = ["left"]
    parts = mg.load_scenario(write(scenario)).trays[0].tray.parts
    assert [p.name for p in parts] == ["A/left", "A/bracket_01"]
    assert [p.target for p in parts] == [True, False]
    assert [g.opening for g in parts[0].grasps] == [0.05]


def test_a_hand_may_be_read_from_the_robot(small: dict[str, Any], write: Callable[..., Path]) -> None:
    by_hand = mg.load_scenario(write(small)).setup.gripper
    read = {**small, "gripper": {"from_robot": True, "clearance": 0.007}}
    schema = json.loads((ASSETS.parent / "schemas" / "scenario.schema.json").read_text())
    jsonschema.validate(read, schema)
    hand = mg.load_scenario(write(read)).setup.gripper
    assert hand.tool_link == by_hand.tool_link
    assert hand.clearance == 0.007
    np.testing.assert_array_equal(hand.approach, by_hand.approach)
    np.testing.assert_array_equal(hand.closing, by_hand.closing)
    assert sorted(hand.finger_links) == sorted(by_hand.finger_links)
    assert hand.max_opening == pytest.approx(by_hand.max_opening, abs=0.005)
    assert {j.name for j in hand.joints} == {j.name for j in by_hand.joints}


def test_a_profile_by_its_path_is_sought_beside_the_scenario(
    small: dict[str, Any], write: Callable[..., Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    profile = {"format": "mmgrasp-robot", "version": 3}
    profile |= {key: small[key] for key in ("robot", "gripper", "place_region")}
    raw = {key: value for key, value in small.items() if key not in ("gripper", "place_region")}
    path = write(edited({**raw, "robot": {}}, "robot.name", "robots/mine.yaml"))
    with pytest.raises(mg.InvalidInput, match=rf"scenario\.yaml:\d+: robot\.name = .*: no such file .{path.parent}"):
        mg.load_scenario(path)
    (path.parent / "robots").mkdir()
    (path.parent / "robots" / "mine.yaml").write_text(yaml.safe_dump(profile))
    own = mg.load_scenario(path).setup
    assert own.gripper.finger_links == mg.load_scenario(write(small)).setup.gripper.finger_links


@pytest.mark.parametrize("name", sorted(p.name for p in (ASSETS / "scenarios").glob("*.yaml")))
def test_shipped_scenarios_keep_the_schema(name: str) -> None:
    schema = json.loads((ASSETS.parent / "schemas" / "scenario.schema.json").read_text())
    jsonschema.validate(yaml.safe_load((ASSETS / "scenarios" / name).read_text()), schema)


def test_a_file_of_an_older_version_says_what_its_keys_are_called_now(
    small: dict[str, Any], write: Callable[..., Path]
) -> None:
    inner = copy.deepcopy(small) | {"version": 2}
    inner["robot"]["tcp"] = inner["robot"].pop("tool_link")
    inner["place_region"]["drop_gap"] = 0.03
    with pytest.raises(mg.InvalidInput, match="reads version 3: tcp is tool_link, drop_gap is drop_height now"):
        mg.load_scenario(write(inner))
    old = {**small, "version": 1}
    old["carry"] = old.pop("place_region")
    with pytest.raises(mg.InvalidInput, match="reads version 3: carry is place_region now"):
        mg.load_scenario(write(old))


def write_stl(path: Path, mesh: mg.Mesh, triangles: Iterable[Any]) -> None:
    rows = ""
    for triangle in triangles:
        corners = "".join("vertex {} {} {}\n".format(*mesh.vertices[i]) for i in triangle)
        rows += f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n"
    path.write_text(f"solid body\n{rows}endsolid body\n")


def test_a_surface_that_is_no_solid_is_told_at_its_line(
    small: dict[str, Any], tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    box = mg.LinkShape(mg.Box([0.3, 0.3, 0.3])).surface()
    raw = copy.deepcopy(small)
    for name, triangles in (("closed", box.triangles), ("open", box.triangles[:-1])):
        write_stl(tmp_path / f"{name}.stl", box, triangles)
        raw["obstacles"].append({"name": name, "mesh": f"{name}.stl", "pose": {"xyz": [-3.0, 0.0, 0.15]}})
    path = tmp_path / "scenario.yaml"
    path.write_text(yaml.safe_dump(raw, sort_keys=False))
    mg.load_scenario(path)
    line = next(i for i, text in enumerate(path.read_text().splitlines(), 1) if "open.stl" in text)
    place = f"{path}:{line}: obstacles[{len(raw['obstacles']) - 1}].mesh: "
    assert caplog.messages == [
        place + "its surface is not closed: it is no solid, and a body wholly behind it does not touch it"
    ]


def test_meshes_may_be_simpler_within_a_tolerance(
    small: dict[str, Any], write: Callable[..., Path], tmp_path: Path
) -> None:
    """A column of 96 triangles on the robot: planned for as a cylinder that holds it, and verified by its mesh."""
    column = mg.LinkShape(mg.Cylinder(0.05, 0.3)).surface(segments=48)
    write_stl(tmp_path / "column.stl", column, column.triangles)
    mesh = "<collision><geometry><mesh filename='column.stl'/></geometry></collision>"
    (tmp_path / "column.urdf").write_text(f"<robot name='column'><link name='column'>{mesh}</link></robot>")
    mount: dict[str, Any] = {"urdf": str(tmp_path / "column.urdf"), "parent_link": "base_link", "prefix": "c_"}
    mount["pose"] = {"xyz": [-0.2, 0.2, 0.6]}
    raw = copy.deepcopy(small)
    kinds = {}
    for tolerance in (0.0, 0.001):
        raw["robot"]["mount"] = [mount | {"mesh_tolerance": tolerance}]
        path = write(raw, f"column_{tolerance}.yaml")
        plan = mg.plan_part_supply(path)
        (shape,) = plan.scenario.setup.robot.collisions("c_column")
        kinds[tolerance] = shape.kind
        assert plan.outcome == mg.Outcome.solved
        assert mg.verify_plan(plan.to_dict(), scenario=path, samples=100).faults == []
    assert kinds == {0.0: "mesh", 0.001: "cylinder"}


def test_parts_larger_than_the_bin_are_told(
    small: dict[str, Any], write: Callable[..., Path], caplog: pytest.LogCaptureFixture
) -> None:
    mg.load_scenario(write(small))
    assert "larger than" not in caplog.text
    long, wide = (1e-3 * round(1e3 * side) for side in (0.05, 0.03))  # the bracket lies on its smallest side
    for size, told in (([wide, long, 0.1], False), ([long, wide - 0.002, 0.1], True), ([0.2, wide - 0.002, 0.1], True)):
        caplog.clear()
        mg.load_scenario(write(edited(small, "place_region.size", size)))
        assert ("is 30 x 50 mm, larger than place_region.size" in caplog.text) == told, (size, caplog.text)


def test_a_clearance_that_no_grasp_of_a_part_gets_is_told(
    small: dict[str, Any], write: Callable[..., Path], caplog: pytest.LogCaptureFixture
) -> None:
    """The narrowest grasps of the bracket are 30 mm wide: of an opening of 100 mm 35 mm are left on either side."""
    for clearance, told in ((0.035, False), (0.036, True)):
        caplog.clear()
        path = write(edited(small, "gripper.clearance", clearance))
        mg.load_scenario(path)
        line = next(i for i, text in enumerate(path.read_text().splitlines(), 1) if "clearance" in text)
        said = [text for text in caplog.messages if text.startswith(f"{path}:{line}: gripper.clearance: ")]
        assert bool(said) == told, caplog.messages
        assert all(f"{clearance} m is more than bracket gets" in text and "with 0.035 m" in text for text in said)


def test_only_listed_grasps_are_all_that_there_are(small: dict[str, Any], write: Callable[..., Path]) -> None:
    """What is proven of listed grasps is proven of the part; of sampled ones others may exist."""
    down = {"pose": {"xyz": [0, 0, 0.01], "rpy": [0, 1.570796, 0]}, "opening": 0.05}
    for type_, sampled in (({"box": [0.03, 0.05, 0.07]}, True), ({"box": [0.03, 0.05, 0.07], "grasps": [down]}, False)):
        parts = mg.load_scenario(write(edited(small, "part_types.bracket", type_))).trays[0].tray.parts
        assert {part.grasps_sampled for part in parts} == {sampled}
