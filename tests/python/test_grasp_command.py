"""`mmgrasp grasp` on a map that `mmgrasp scan` made of rendered frames: two boxes of known place and size on a table."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from conftest import ASSETS
from frame_folders import run, write_frames, write_sensors
from mmgrasp.cli import main
from mmgrasp.scenario import read_arm_of

GRIPPER = "asset:scenarios/storeroom.yaml"
SIDES = {"large": (np.array([0.10, 0.02]), 0.4, (0.12, 0.08)), "small": (np.array([-0.12, -0.05]), 0.0, (0.06, 0.06))}


@pytest.fixture(scope="module")
def scanned(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("grasp")
    (folder / "frames").mkdir()
    write_frames(folder / "frames", "npz", 18)
    write_sensors(folder / "frames")
    assert run(folder / "frames", folder / "map", "--voxel", "0.003") == 0
    return folder / "map"


def grasps(folder: Path, capsys: pytest.CaptureFixture[str], *more: str) -> dict[str, Any]:
    capsys.readouterr()
    assert main(["grasp", str(folder), "--gripper", GRIPPER, "--json", *more]) == 0
    content: dict[str, Any] = json.loads(capsys.readouterr().out)
    return content


def test_grasps_close_on_opposite_faces(scanned: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rows = grasps(scanned, capsys)["objects"]
    assert len(rows) == 2
    for row in rows:
        assert len(row["grasps"]) >= 3
        probabilities = [grasp["probability"] for grasp in row["grasps"]]
        assert probabilities == sorted(probabilities, reverse=True) and 0.5 < probabilities[0] <= 1
        for grasp in row["grasps"]:
            T = mg.pose(grasp["T_world_hand"]["xyz"], quat_xyzw=grasp["T_world_hand"]["quat_xyzw"])
            _, yaw, sides = min(SIDES.values(), key=lambda side: float(np.linalg.norm(side[0] - T[:2, 3])))
            closing = T[:3, 1]
            across = [abs(closing @ [np.cos(yaw + k * np.pi / 2), np.sin(yaw + k * np.pi / 2), 0]) for k in (0, 1)]
            axis = int(np.argmax(across))
            assert across[axis] > np.cos(0.35), (row["name"], closing)
            # Pads askew to the faces touch them with their edges first.
            askew = 0.025 * np.tan(np.arccos(min(1.0, across[axis])))
            assert sides[axis] - 0.004 < grasp["opening"] < sides[axis] / across[axis] + askew + 0.004
            assert grasp["opening"] < grasp["pretouch_opening"] <= 0.1
            weights = {"angle": 0.6, "placement": 0.1, "centring": 0.2, "certainty": 0.1}
            assert grasp["probability"] == pytest.approx(sum(weights[k] * v for k, v in grasp["criteria"].items()))


def test_the_table_one_object_and_the_file(scanned: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "grasps.json"
    assert main(["grasp", str(scanned), "--gripper", GRIPPER, "--object", "object_1", "-o", str(out)]) == 0
    printed = capsys.readouterr().out
    assert "object_1" in printed and "object_2" not in printed and "prob." in printed
    counts = json.loads(out.read_text())["objects"][0]["counts"]
    assert f"of {counts['drawn']} surface points drawn, {counts['evaluated']} grasps evaluated" in " ".join(
        printed.split()
    )
    causes = {
        "no_opposite": "no opposite",
        "collision": "collision",
        "near_better": "near a better one or not among the best",
    }
    for cause, told in causes.items():
        assert counts[cause] > 0 and f"{told} {counts[cause]}" in " ".join(printed.split())
    assert [row["name"] for row in json.loads(out.read_text())["objects"]] == ["object_1"]
    # The same seed gives the same grasps.
    again = grasps(scanned, capsys, "--object", "object_1")
    assert again == json.loads(out.read_text())


def test_patches_lie_on_the_faces_and_are_drawn(
    scanned: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    png = tmp_path / "grasps.png"
    rows = grasps(scanned, capsys, "--png", str(png))["objects"]
    assert png.read_bytes().startswith(b"\x89PNG") and png.stat().st_size > 20_000
    for row in rows:
        for grasp in row["grasps"]:
            assert grasp["approach"][2] < 0 and np.linalg.norm(grasp["approach"]) == pytest.approx(1)
            assert len(grasp["patches"]) == 2
            T = mg.pose(grasp["T_world_hand"]["xyz"], quat_xyzw=grasp["T_world_hand"]["quat_xyzw"])
            middle, yaw, sides = min(SIDES.values(), key=lambda side: float(np.linalg.norm(side[0] - T[:2, 3])))
            for patch in grasp["patches"]:
                # On one of the box's four upright faces, in its own frame, and facing away from its middle.
                turn = np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])
                point, normal = turn @ (np.array(patch["point"][:2]) - middle), turn @ np.array(patch["normal"][:2])
                axis = int(np.argmax(np.abs(normal)))
                assert abs(abs(point[axis]) - sides[axis] / 2) < 0.004 and point[axis] * normal[axis] > 0
                assert 0 < patch["sigma"] < 0.005
    assert main(["grasp", str(scanned), "--gripper", GRIPPER, "--png", str(tmp_path)]) == 2
    assert str(tmp_path) in capsys.readouterr().err.replace("\n", "")


def test_the_arm_gets_to_every_grasp(scanned: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The robot's own kinematics at its place say so, and it is free of the true table and the other box, which the command has never seen."""
    standing = [-0.8, 0.0, -0.7, 0.1]
    capsys.readouterr()
    base = "--base=" + ",".join(map(str, standing))
    assert main(["grasp", str(scanned), "--robot", GRIPPER, base, "--grasps", "6", "--json"]) == 0
    content = json.loads(capsys.readouterr().out)
    assert content["robot"] == GRIPPER and content["base"] == standing
    setup = read_arm_of(GRIPPER)
    arm = setup.arm.at(mg.pose(standing[:3], rpy=[0, 0, standing[3]]))
    for row in content["objects"]:
        assert row["grasps"]
        middle = np.mean([grasp["T_world_hand"]["xyz"] for grasp in row["grasps"]], axis=0)
        world = mg.World()
        world.add_box("table", [0.9, 0.9, 0.02], mg.pose([0, 0, -0.0105]))
        for name, (place, yaw, sides) in SIDES.items():
            height = {"large": 0.06, "small": 0.10}[name]
            if np.linalg.norm(place - middle[:2]) > 0.05:
                world.add_box(name, [*sides, height], mg.pose([*place, height / 2], rpy=[0, 0, yaw]))
        assert len(world.objects) == 2
        checker = mg.CollisionChecker(setup.robot, world, group=arm)
        for grasp in row["grasps"]:
            q = np.array([grasp["q"][name] for name in arm.names])
            T = mg.pose(grasp["T_world_hand"]["xyz"], quat_xyzw=grasp["T_world_hand"]["quat_xyzw"])
            assert np.allclose(arm.fk(q), T, atol=2e-4)
            assert checker.is_free(q)


def test_a_gripper_too_narrow_for_everything_is_said(
    scanned: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    narrow = tmp_path / "narrow.yaml"
    scenario = (ASSETS / "scenarios" / "storeroom.yaml").read_text()
    narrow.write_text(scenario.replace("max_opening: 0.10", "max_opening: 0.02").replace("open: 0.05", "open: 0.01"))
    assert main(["grasp", str(scanned), "--gripper", str(narrow)]) == 4
    printed = " ".join(capsys.readouterr().out.split())
    for name, (_, _, sides) in zip(("object_1", "object_2"), (SIDES["large"], SIDES["small"]), strict=True):
        said = re.search(rf"{name}: .*?opposite walls are (\d+) mm or more apart, and the hand opens 20 mm", printed)
        assert said and min(sides) - 0.004 < int(said[1]) / 1000 < max(sides) + 0.004, printed


def test_less_room_around_uncertain_surfaces_is_offered(scanned: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """With 40 standard deviations kept free the hand fits nowhere; what is said helps."""
    assert main(["grasp", str(scanned), "--gripper", GRIPPER, "--object", "object_1", "--sigmas", "40"]) == 4
    printed = " ".join(capsys.readouterr().out.split())
    said = re.search(r"; (\d+) touch the map, with 40 standard deviations of it kept free \(--sigmas\)", printed)
    assert said and int(said[1]) > 20
    (row,) = grasps(scanned, capsys, "--object", "object_1", "--sigmas", "0")["objects"]
    assert row["grasps"]
    with pytest.raises(SystemExit):
        main(["grasp", str(scanned), "--gripper", GRIPPER, "--sigmas", "-1"])


def test_a_map_of_other_frames_is_refused(scanned: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The objects are those of another map than the one beside them."""
    folder = tmp_path / "map"
    shutil.copytree(scanned, folder)
    other = mg.ProbabilisticSdf.load(scanned / "map.sdf")
    assert main(["grasp", str(folder), "--gripper", GRIPPER]) == 0
    mg.ProbabilisticSdf(voxel=0.002, truncation=other.truncation).save(folder / "map.sdf")
    capsys.readouterr()
    assert main(["grasp", str(folder), "--gripper", GRIPPER]) == 2
    assert "map.sdf" in capsys.readouterr().err


def test_where_two_deviations_leave_nothing_less_is_kept_free(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Cameras off by 8 mm: sigma is some 5 mm. Each object gets the first of 2, 1 and 0 with a grasp, as if it had been asked for."""
    (tmp_path / "frames").mkdir()
    write_frames(tmp_path / "frames", "npz", 18)
    write_sensors(tmp_path / "frames", "pose_error: {translation: 0.008, rotation: 0.003}")
    assert run(tmp_path / "frames", tmp_path / "map", "--voxel", "0.003") == 0
    rows = {row["name"]: row for row in grasps(tmp_path / "map", capsys)["objects"]}
    assert {row["sigmas"] for row in rows.values()} == {0.0, 1.0}
    for name, row in rows.items():
        said = (
            f"; kept free: {row['sigmas']:g} standard deviations of the map; with {row['sigmas'] + 1:g} there is none"
        )
        assert row["summary"].endswith(said)
        asked = ("--object", name, "--sigmas")
        (same,) = grasps(tmp_path / "map", capsys, *asked, f"{row['sigmas']:g}")["objects"]
        assert same["grasps"] == row["grasps"] and said not in same["summary"]
        for more in range(int(row["sigmas"]) + 1, 3):
            assert main(["grasp", str(tmp_path / "map"), "--gripper", GRIPPER, *asked, str(more)]) == 4


def test_out_of_the_arms_reach_is_said(scanned: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["grasp", str(scanned), "--robot", GRIPPER, "--base=-6,0,-0.7,0"]) == 4
    printed = " ".join(capsys.readouterr().out.split())
    assert printed.count("that hold: unreachable") == 2

    other = tmp_path / "other.yaml"
    scenario = (ASSETS / "scenarios" / "storeroom.yaml").read_text()
    other.write_text(scenario.replace("tool_link: gripper_tcp", "tool_link: gripper_link"))
    for arguments, words in (
        ([], "--gripper: must be given"),
        (["--gripper", GRIPPER, "--base", "0,0,0,0"], "--base: goes with --robot"),
        (["--gripper", str(other), "--robot", GRIPPER], "gripper_link is not the tip of --robot's arm, gripper_tcp"),
    ):
        assert main(["grasp", str(scanned), *arguments]) == 2
        assert words in " ".join(capsys.readouterr().err.split())
    for base in ("1,2,3", "1,2,3,nan", "1,2,3,x", "1,2,3,1e9"):
        with pytest.raises(SystemExit):
            main(["grasp", str(scanned), "--robot", GRIPPER, "--base", base])
        assert "must be X,Y,Z,HEADING" in capsys.readouterr().err


def test_bad_input_is_refused_by_name(scanned: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def refused(*arguments: str) -> str:
        capsys.readouterr()
        assert main(["grasp", *arguments]) == 2
        return capsys.readouterr().err

    assert "did you mean tiago?" in refused(str(scanned), "--gripper", "tiag")
    assert "it has object_1, object_2" in refused(str(scanned), "--gripper", GRIPPER, "--object", "cup")
    assert "no objects.json" in refused(str(tmp_path), "--gripper", GRIPPER)
    bad = tmp_path / "objects.json"
    content = json.loads((scanned / "objects.json").read_text())
    corners = {"lower": [0, 0, 0], "upper": [0.1, 0.1, 0.1]}
    for change, words in (
        ("{", "is no valid JSON"),
        ("[]", "is no list of objects"),
        (json.dumps({**content, "format": "mmgrasp-plan"}), "is no list of objects"),
        (json.dumps({**content, "version": 9}), "version 1"),
        (json.dumps({**content, "objects": []}), "lists no objects"),
        (json.dumps({**content, "objects": [{"name": "cup"}]}), "objects[0]: bounds is missing"),
        (json.dumps({**content, "objects": [{"name": 3, "bounds": corners}]}), "objects[0].name = 3"),
        (
            json.dumps({**content, "objects": [{"name": "cup", "bounds": {**corners, "upper": [0, 0, "1"]}}]}),
            "upper[2] = '1'",
        ),
        (
            json.dumps({**content, "objects": [{"name": "cup", "bounds": {**corners, "upper": [0, 0, 0]}}]}),
            "below upper",
        ),
        (json.dumps({**content, "plane": {**content["plane"], "normal": [1.0, 0.0, 0.0]}}), "tilted by 90 degrees"),
        (json.dumps({**content, "plane": {**content["plane"], "normal": [0.0, 1.0]}}), "plane.normal"),
        (json.dumps({**content, "plane": {**content["plane"], "offset": "0"}}), "plane.offset = '0'"),
    ):
        bad.write_text(change)
        message = refused(str(tmp_path), "--gripper", GRIPPER)
        assert words in message and str(bad) in message, words
    bad.write_text(json.dumps(content))
    assert "map.sdf" in refused(str(tmp_path), "--gripper", GRIPPER)
