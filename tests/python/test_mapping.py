"""Depth images, cuboids and graspability through the Python door."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from conftest import REPOSITORY
from mmgrasp.problems import random_trays

CLOUDS = REPOSITORY.parent / "shared" / "data" / "clouds"
TRAY = [0.3, 0.4, 0.1]
PART = [mg.LinkShape(mg.Box([0.07, 0.035, 0.03]))]


def gripper() -> mg.Hand:
    return mg.Hand("tcp", approach=[1, 0, 0], closing=[0, 1, 0], max_opening=0.1, finger_depth=0.04, finger_width=0.022)


def small_camera() -> mg.mapping.PinholeCamera:
    return mg.mapping.PinholeCamera(width=40, height=30, fx=30.0, fy=30.0, cx=19.5, cy=14.5)


def test_rendered_plane_has_its_points_on_it() -> None:
    image = mg.mapping.render_depth(
        [mg.LinkShape(mg.collision.Plane([0, 0, 1], 0.2))], small_camera(), mg.mapping.look_down([0.1, 0.2, 1.0])
    )
    assert image.depth.shape == (30, 40)
    assert np.allclose(image.depth, 0.8, atol=1e-6)
    points = image.points()
    assert points.shape == (1200, 3)
    assert np.allclose(points[:, 2], 0.2, atol=1e-6)
    again = mg.mapping.DepthImage(image.depth, image.camera, image.T_world_camera)
    assert np.array_equal(again.points(), points)


@pytest.mark.parametrize(
    "depth", ["x", [["a"]], np.zeros((2, 3)), np.zeros(1200), np.zeros((30, 40), complex), [[1, 2], [3]], None]
)
def test_bad_images_are_refused_by_name(depth: Any) -> None:
    with pytest.raises(mg.InvalidInput, match="depth"):
        mg.mapping.DepthImage(depth, small_camera())


@pytest.mark.parametrize("points", ["x", [1.0, 2, 3], np.zeros((4, 2)), np.zeros((4, 3), complex), [["a"] * 3]])
def test_bad_points_are_refused_by_name(points: Any) -> None:
    with pytest.raises(mg.InvalidInput, match="points"):
        mg.mapping.fit_cuboids(points)


def test_unknown_keyword_names_the_near_miss() -> None:
    with pytest.raises(mg.InvalidInput, match="cluster_tolerance"):
        mg.mapping.fit_cuboids(np.zeros((4, 3)), cluster_tolerence=0.1)  # type: ignore[call-arg]


def test_not_measured_is_no_error() -> None:
    image = mg.mapping.DepthImage(np.full((30, 40), np.nan), small_camera())
    assert len(image.points()) == 0
    assert not mg.mapping.fit_cuboids(np.full((10, 3), np.nan)).cuboids


def test_scans_of_random_trays() -> None:
    scans = [random_trays.scan_random_tray(PART, TRAY, gripper(), count=8, fill=fill, seed=3) for fill in (1.0, 0.5)]
    assert [len(scan.placement.parts) + scan.placement.not_placed for scan in scans] == [8, 4]
    assert all(scan.grasps for scan in scans)
    union = random_trays.union_of_grasps(scans)
    assert len(union) == sum(len(scan.grasps) for scan in scans)
    scores = [grasp.quality for grasp in union]
    assert scores == sorted(scores, reverse=True)
    again = random_trays.scan_random_tray(PART, TRAY, gripper(), count=8, fill=0.5, seed=3)
    assert [g.T_object_hand.tolist() for g in again.grasps] == [g.T_object_hand.tolist() for g in scans[1].grasps]

    T_world_tray = mg.pose([1, 2, 0.7], rpy=[0, 0, 0.3])
    parts = random_trays.parts_of_grasps("tray", union, gripper(), T_world_tray)
    assert len({part.name for part in parts}) == len(union)
    for part, grasp in zip(parts, union, strict=True):
        T_world_hand = part.T_world_part @ part.grasps[0].T_object_hand
        assert np.allclose(T_world_hand, T_world_tray @ grasp.T_object_hand)
        other = part.T_world_part @ part.grasps[1].T_object_hand
        assert np.allclose(other[:3, 0], T_world_hand[:3, 0])  # the same approach,
        assert np.allclose(other[:3, 1], -T_world_hand[:3, 1])  # the fingers change places
        bead = np.linalg.inv(T_world_tray) @ part.T_world_part @ part.shapes[0].pose
        assert np.allclose(bead[:3, 3], [0, 0, -0.0025])  # inside the tray's floor


def test_cuboids_of_a_random_tray_are_its_parts() -> None:
    scan = random_trays.scan_random_tray(PART, TRAY, gripper(), count=4, seed=2, noise=0.0, stack=False)
    fit = mg.mapping.fit_cuboids(
        scan.image.points(), T_world_tray=np.eye(4), tray_size=TRAY, eye=scan.image.T_world_camera[:3, 3]
    )
    assert 1 <= len(fit.cuboids) <= 4
    true = np.array([part.T_tray_part[:3, 3] for part in scan.placement.parts])
    whole = [c for c in fit.cuboids if np.allclose(sorted(c.size), [0.03, 0.035, 0.07], atol=0.004)]
    assert whole
    for cuboid in whole:
        assert np.min(np.linalg.norm(true - cuboid.T_world_box[:3, 3], axis=1)) < 0.004


def test_real_depth_frames_give_points_where_their_poses_say() -> None:
    """Two frames of one sequence: their clouds meet once each is put at its camera's pose."""
    if not CLOUDS.exists():
        pytest.skip("no reference data")
    image_module = pytest.importorskip("PIL.Image")
    lines = (CLOUDS / "open3d" / "RGBD" / "trajectory.log").read_text().split("\n")
    poses = [np.array([[float(x) for x in lines[5 * k + 1 + i].split()] for i in range(4)]) for k in range(2)]
    clouds = []
    for k, T in enumerate(poses):
        depth = np.asarray(image_module.open(CLOUDS / "open3d" / "RGBD" / "depth" / f"{k:05d}.png"), np.float32) / 1000
        T[:3, :3] = np.linalg.svd(T[:3, :3])[0] @ np.linalg.svd(T[:3, :3])[2]
        clouds.append(mg.mapping.DepthImage(depth, mg.mapping.PinholeCamera(), T).points())
    assert min(map(len, clouds)) > 100_000
    cells = {tuple(cell) for cell in np.floor(clouds[0] / 0.03).astype(int)}
    grown = {(x + i, y + j, z + k) for x, y, z in cells for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1)}
    some = np.floor(clouds[1][::50] / 0.03).astype(int)
    assert np.mean([tuple(cell) in grown for cell in some]) > 0.9


def test_real_cloud_files() -> None:
    if not CLOUDS.exists():
        pytest.skip("no reference data")
    cloud = mg.mapping.read_pcd(CLOUDS / "haf" / "pcd4.pcd")
    assert len(cloud.points) == 208
    assert "200" in cloud.warning
    with pytest.raises(mg.IoError, match=r"README\.txt"):
        mg.mapping.read_pcd(CLOUDS / "haf" / "README.txt")


@pytest.mark.slow
def test_graspability_on_a_real_depth_frame_keeps_the_hand_clear() -> None:
    """What stands on the largest level surface of a room: no measured point in a finger, some between the fingers."""
    if not CLOUDS.exists():
        pytest.skip("no reference data")
    image_module = pytest.importorskip("PIL.Image")
    depth = np.asarray(image_module.open(CLOUDS / "open3d" / "RGBD" / "depth" / "00000.png"), np.float32) / 1000
    image = mg.mapping.DepthImage(depth, mg.mapping.PinholeCamera(), np.eye(4))
    points = image.points()
    fit = mg.mapping.fit_cuboids(
        points, up=[0, 0, 0], plane_tolerance=0.02, leaf=0.01, cluster_tolerance=0.03, min_points=300
    )
    up = fit.plane_normal  # the floor's
    x = np.array([1.0, 0, 0]) - up[0] * up
    T_world_map = np.eye(4)
    T_world_map[:3, :3] = np.column_stack([x, np.cross(up, x), up]) / np.linalg.norm(x)
    T_world_map[:3, 2] = up
    middle = np.mean([cuboid.T_world_box[:3, 3] for cuboid in fit.cuboids], axis=0)
    T_world_map[:3, 3] = middle - (up @ middle - fit.plane_offset) * up
    heights = mg.mapping.make_height_map(image, T_world_map, [1.6, 1.6], resolution=0.005, jump=0.03)
    found = mg.grasping.evaluate_graspability(
        heights, gripper(), image=image, lowest=0.02, layer_step=0.02, insertion=0.015
    )
    assert len(found.grasps) >= 3
    for grasp in found.grasps:
        q = (points - grasp.T_object_hand[:3, 3]) @ grasp.T_object_hand[:3, :3]  # approach x, closing y
        side, opened = np.abs(q[:, 1]), gripper().pregrasp_opening(grasp.opening)
        reached = (q[:, 0] < 0.02) & (q[:, 0] > 0.02 - 0.12) & (np.abs(q[:, 2]) < 0.011)
        assert np.sum(reached & (side < opened / 2)) > 20
        assert not np.any(reached & (side > opened / 2) & (side < opened / 2 + 0.012))


def test_a_part_with_grasps_is_no_body() -> None:
    part: Any = mg.base.Part("part", PART, np.eye(4), [])
    with pytest.raises(mg.InvalidInput, match="list of LinkShape"):
        random_trays.scan_random_tray(part, TRAY, gripper())


def test_parts_at_given_poses_are_grasped_where_they_lie() -> None:
    poses = [mg.pose([x, 0.1, 0.015], rpy=[0, 0, np.pi / 2]) for x in (-0.06, 0.06)]
    scan = random_trays.scan_tray(PART, poses, TRAY, gripper(), noise=0.0)
    assert not isinstance(scan, random_trays.RandomTrayScan)
    for pose in poses:
        near = [g for g in scan.grasps if np.linalg.norm(g.T_object_hand[:2, 3] - pose[:2, 3]) < 0.02]
        assert near
        assert max(near, key=lambda g: g.quality).opening == pytest.approx(0.035, abs=0.006)
    assert all(min(np.linalg.norm(g.T_object_hand[:2, 3] - p[:2, 3]) for p in poses) < 0.06 for g in scan.grasps)


def test_the_old_name_of_an_option_is_refused_with_the_new_one() -> None:
    body, tray = [mg.LinkShape(mg.Box([0.02, 0.02, 0.02]))], [0.3, 0.2, 0.1]
    with pytest.raises(mg.InvalidInput, match=r"gap.*it is called clearance now"):
        mg.mapping.random_placement(body, tray, gap=0.001)  # type: ignore[call-arg]
    with pytest.raises(mg.InvalidInput, match=r"attempts.*it is called draws now"):
        mg.mapping.random_placement(body, tray, attempts=10)  # type: ignore[call-arg]
