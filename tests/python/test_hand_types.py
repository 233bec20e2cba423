"""`mmgrasp grasp` with a hand of three fingers and seven joints: its profile, its types of grasp, and where its fingertips end up."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import mmgrasp as mg
from conftest import ASSETS
from frame_folders import run, write_frames, write_sensors
from mmgrasp.cli import main
from mmgrasp.scenario import read_hand_types

PROFILE = ASSETS / "grippers" / "sdhlike" / "sdhlike.yaml"
BOXES = [
    (mg.pose([0.10, 0.02, 0.03], rpy=[0, 0, 0.4]), np.array([0.12, 0.08, 0.06])),
    (mg.pose([-0.12, -0.05, 0.05]), np.array([0.06, 0.06, 0.10])),
]
TIPS = {"pinch": ("finger_1_tip", "finger_2_tip")}
ALL_TIPS = ("thumb_tip", "finger_1_tip", "finger_2_tip")
HALF = np.array([0.012, 0.012, 0.03425])  # of a fingertip's box, whose middle lies 34.25 mm along its z [m]


@pytest.fixture(scope="module")
def scanned(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("hands")
    write_frames(folder / "frames", "npz", 18)
    write_sensors(folder / "frames")
    assert run(folder / "frames", folder / "map", "--voxel", "0.003") == 0
    return folder / "map"


def grasps(folder: Path, capsys: pytest.CaptureFixture[str], *more: str) -> dict[str, Any]:
    capsys.readouterr()
    assert main(["grasp", str(folder), "--json", *more]) == 0
    content: dict[str, Any] = json.loads(capsys.readouterr().out)
    return content


def tip_corners(robot: mg.Robot, joints: dict[str, float], T_world_hand: np.ndarray, tip: str) -> np.ndarray:
    poses = robot.link_poses(joints)
    T = T_world_hand @ np.linalg.inv(poses["tcp"]) @ poses[tip]
    steps = np.stack(np.meshgrid(*[np.linspace(-1, 1, 7)] * 3), axis=-1).reshape(-1, 3)
    return np.asarray((steps * HALF + [0, 0, HALF[2]]) @ T[:3, :3].T + T[:3, 3])


def lowest(robot: mg.Robot, joints: dict[str, float], T_world_hand: np.ndarray) -> float:
    """Height of the hand's lowest corner above the table [m]."""
    poses, least = robot.link_poses(joints), np.inf
    for link in robot.links:
        for shape in robot.collisions(link):
            assert isinstance(shape.shape, mg.Box)
            T = T_world_hand @ np.linalg.inv(poses["tcp"]) @ poses[link] @ shape.pose
            least = min(least, float(T[2, 3] - np.abs(T[2, :3]) @ np.asarray(shape.shape.size) / 2))
    return least


def outside(points: np.ndarray, T_box: np.ndarray, size: np.ndarray) -> np.ndarray:
    """Signed distance of points from a box [m]."""
    away = np.abs((points - T_box[:3, 3]) @ T_box[:3, :3]) - size / 2
    return np.asarray(np.linalg.norm(np.maximum(away, 0), axis=1) + np.minimum(away.max(axis=1), 0))


def test_fingertips_close_on_the_boxes(scanned: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The robot's forward kinematics and the true boxes say so, neither of which the search has seen together."""
    robot = mg.Robot.load(ASSETS / "grippers" / "sdhlike" / "sdhlike.urdf")
    rows = grasps(scanned, capsys, "--gripper", "sdhlike", "--samples", "400")["objects"]
    assert all(row["grasps"] for row in rows), [row["summary"] for row in rows]
    kinds = {grasp["type"] for row in rows for grasp in row["grasps"]}
    assert len(kinds) >= 2 and kinds <= {"pinch", "cylindrical", "spherical"}
    for row in rows:
        found = [grasp["probability"] for grasp in row["grasps"]]
        assert found == sorted(found, reverse=True) and len(found) <= 20
        for grasp in row["grasps"]:
            T = mg.pose(grasp["T_world_hand"]["xyz"], quat_xyzw=grasp["T_world_hand"]["quat_xyzw"])
            box = min(BOXES, key=lambda each: float(np.linalg.norm(each[0][:2, 3] - T[:2, 3])))
            for tip in ALL_TIPS:
                open_ = outside(tip_corners(robot, grasp["pretouch_joints"], T, tip), *box)
                assert open_.min() > 0, (grasp["type"], tip)
                if tip in TIPS.get(grasp["type"], ALL_TIPS):
                    closed = outside(tip_corners(robot, grasp["joints"], T, tip), *box)
                    assert abs(closed.min()) < 0.004, (grasp["type"], tip, closed.min())
                    assert open_.min() > closed.min()
            for joints in (grasp["pretouch_joints"], grasp["joints"]):
                assert lowest(robot, joints, T) > 0, grasp["type"]
        counts = row["counts"]
        lost = sum(
            counts[k] for k in ("missed", "uneven", "slipping", "uncertain", "collision", "table", "arm", "near_better")
        )
        assert counts["evaluated"] == lost + len(row["grasps"])


def test_the_table_names_the_type(scanned: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["grasp", str(scanned), "--gripper", "sdhlike", "--object", "object_1"]) == 0
    printed = capsys.readouterr().out
    assert "type" in printed
    for kind in ("pinch: ", "cylindrical: ", "spherical: "):
        assert kind in printed


def test_names_are_no_markup(scanned: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    profile = yaml.safe_load(PROFILE.read_text())
    name = "[b]x[/y]"
    profile["gripper"]["types"] = {name: profile["gripper"]["types"]["pinch"]}
    path = tmp_path / "hand.yaml"
    path.write_text(yaml.safe_dump(profile))
    assert main(["grasp", str(scanned), "--gripper", str(path), "--object", "object_1"]) == 0
    assert capsys.readouterr().out.count(name) == 2  # in the table and before its summary


def test_an_arm_brings_the_hand_there(scanned: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The hand on the flange of an arm: its tool frame is where the arm's own kinematics put it, the fingers open."""
    hand = yaml.safe_load(
        re.sub(r"\b((thumb|finger_[12])_(proximal|distal)|spread: [\d\[]|spread\])", r"sdhlike_\1", PROFILE.read_text())
    )
    hand["gripper"]["groups"] = dict(
        zip(("thumb", "finger_1", "finger_2", "spread"), hand["gripper"]["groups"].values(), strict=True)
    )
    hand["robot"] = {
        "urdf": "asset:robots/tm14like/tm14like.urdf",
        "srdf": "asset:robots/tm14like/tm14like.srdf",
        "group": {"base_link": "base_link", "tip_link": "sdhlike_tcp"},
        "tool_link": "sdhlike_tcp",
        "mount": [
            {
                "urdf": "asset:grippers/sdhlike/sdhlike.urdf",
                "parent_link": "gripper_tcp",
                # The hand's z along the arm's way in, x, in front of the gripper that it has already.
                "pose": {"xyz": [0.02, 0.0, 0.0], "rpy": [0.0, float(np.pi / 2), 0.0]},
            }
        ],
    }
    profile = tmp_path / "arm.yaml"
    profile.write_text(yaml.safe_dump(hand))
    content = grasps(
        scanned, capsys, "--robot", str(profile), "--base=-0.75,0,0,0", "--object", "object_1", "--samples", "400"
    )
    types = read_hand_types(str(profile), arm=True)
    for grasp in content["objects"][0]["grasps"]:
        arm = types.arms[grasp["type"]].at(mg.pose([-0.75, 0, 0]))
        q = np.array([grasp["q"][name] for name in arm.names])
        T = mg.pose(grasp["T_world_hand"]["xyz"], quat_xyzw=grasp["T_world_hand"]["quat_xyzw"])
        assert np.allclose(arm.fk(q), T, atol=2e-4)
        assert types.robot is not None
        opened = types.robot.link_poses({j.name: j.open for j in types.hands[grasp["type"]].joints})
        for poses in (arm.link_poses(q), opened):
            tip = np.linalg.inv(poses["sdhlike_tcp"]) @ poses["sdhlike_finger_1_tip"]
            assert np.allclose(tip, np.linalg.inv(opened["sdhlike_tcp"]) @ opened["sdhlike_finger_1_tip"], atol=1e-9)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("groups", {}), "gripper.groups.*must name a group of joints"),
        (("groups", "thumb", []), "must name a joint"),
        (("groups", "thumb", ["thumb_proximal", "thumb_distl"]), "no movable joint thumb_distl.*did you mean thumb_distal"),
        (("groups", "thumb", ["thumb_proximal", "spread"]), "spread is a joint of the group spread, too"),
        (("types", {}), "must name a type of grasp"),
        (("types", "pinch", {"open": {}}), "closed"),
        (("types", "pinch", "open", {"spread": 1.0}), "each joint of the groups; .*_proximal is missing"),
        (("types", "pinch", "open", "spread", 4.0), "types.pinch.open.spread"),
        (("types", "pinch", "closed", {"sprad": 1.0}), "no group has the joint sprad.*did you mean spread"),
        (("types", "pinch", "closed", {}), "no group of joints closes"),
        (("approach", [0, 1, 0]), "close along it"),
        (("approach", [0, 0, 2]), "must be a unit axis"),
        (("fingers", 3), "fingers"),
    ],
)  # fmt: skip
def test_a_bad_profile_is_refused_at_its_line(
    change: tuple[Any, ...], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    profile = yaml.safe_load(PROFILE.read_text())
    at = profile["gripper"]
    for key in change[:-2]:
        at = at[key]
    at[change[-2]] = change[-1]
    path = tmp_path / "hand.yaml"
    path.write_text(yaml.safe_dump(profile))
    with pytest.raises(mg.InvalidInput, match=said) as caught:
        read_hand_types(str(path))
    assert "hand.yaml:" in str(caught.value)


def test_a_ball_is_held_from_all_around(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A ball of 10 cm: spherical grasps, their three tips on it once closed."""
    ball, radius = np.array([0.02, 0.01, 0.05]), 0.05
    monkeypatch.setattr(
        "frame_folders.SCENE",
        [mg.LinkShape(mg.collision.Plane([0, 0, 1], 0.0)), mg.LinkShape(mg.Sphere(radius), mg.pose(ball))],
    )
    write_frames(tmp_path / "frames", "npz", 18)
    write_sensors(tmp_path / "frames")
    assert run(tmp_path / "frames", tmp_path / "map", "--voxel", "0.003") == 0
    (row,) = grasps(tmp_path / "map", capsys, "--gripper", "sdhlike", "--samples", "400")["objects"]
    round_ones = [grasp for grasp in row["grasps"] if grasp["type"] == "spherical"]
    assert round_ones, row["summary"]
    robot = mg.Robot.load(ASSETS / "grippers" / "sdhlike" / "sdhlike.urdf")
    for grasp in round_ones:
        T = mg.pose(grasp["T_world_hand"]["xyz"], quat_xyzw=grasp["T_world_hand"]["quat_xyzw"])
        for tip in ALL_TIPS:
            closed, open_ = (
                np.linalg.norm(tip_corners(robot, grasp[key], T, tip) - ball, axis=1).min() - radius
                for key in ("joints", "pretouch_joints")
            )
            assert abs(closed) < 0.004 and open_ > 0.001, (tip, closed, open_)
