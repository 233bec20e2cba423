"""The probabilistic map through the Python door."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import numpy as np
import pytest

import mmgrasp as mg
from camera_poses import look_at

INTRINSICS = mg.mapping.PinholeCamera(width=160, height=120, fx=200.0, fy=200.0, cx=79.5, cy=59.5)
CAMERA = mg.mapping.DepthCamera(INTRINSICS, mg.mapping.DepthNoise(constant=0.001))
SCENE = [
    mg.LinkShape(mg.collision.Plane([0, 0, 1], 0.0)),
    mg.LinkShape(mg.Box([0.06, 0.05, 0.04]), mg.pose([0, 0, 0.02])),
]


def frame(eye: list[float]) -> mg.mapping.DepthImage:
    return mg.mapping.render_depth(SCENE, INTRINSICS, mg.mapping.look_down(eye))


def test_from_frames_to_answers(tmp_path: Path) -> None:
    sdf = mg.ProbabilisticSdf(voxel=0.002)
    report = sdf.integrate(frame([0, 0, 0.35]), CAMERA)
    assert report.used > 0.9 * report.measured and report.new_blocks == sdf.blocks and report.warning == ""
    sdf.integrate(frame([0.02, 0.01, 0.35]), CAMERA, pose_covariance=np.diag([1e-6] * 3 + [1e-8] * 3))
    mean, sigma, known = sdf.query([[0.0, 0.0, 0.04], [0.06, 0.0, 0.001], [0, 0, -0.2]])
    assert known.tolist() == [True, True, False]
    assert np.allclose(mean[:2], [0, 0.001], atol=1e-4)
    assert np.all(sigma[:2] < 0.001) and np.isnan(mean[2])
    hits = sdf.cast_rays([[0.005, 0.004, 0.3], [0, 0, 0.3]], [[0, 0, -1], [0, 0, 1]])
    assert hits.hit.tolist() == [True, False]
    assert np.allclose(hits.point[0], [0.005, 0.004, 0.04], atol=2e-4) and np.allclose(
        hits.normal[0], [0, 0, 1], atol=0.01
    )
    assert hits.distance[0] == pytest.approx(0.26, abs=2e-4) and hits.sigma[0] > 0
    mesh, sigmas = sdf.mesh()
    points, normals, sigma = sdf.points()
    assert len(mesh.vertices) == len(sigmas) == len(points) and np.array_equal(sigmas, sigma)
    assert np.allclose(np.linalg.norm(normals, axis=1), 1)
    on_floor = np.abs(points[:, 2]) < 1e-3
    assert np.mean(on_floor) > 0.5 and np.median(normals[on_floor, 2]) == pytest.approx(1, abs=1e-3)
    sdf.save(tmp_path / "map.sdf")
    again = mg.ProbabilisticSdf.load(tmp_path / "map.sdf")
    assert (again.frames, again.blocks, again.voxel) == (2, sdf.blocks, 0.002)
    assert np.array_equal(again.points()[0], points)


@pytest.mark.parametrize("distance", ["to_plane", "along_ray"])
def test_maps_of_wide_and_noisy_cameras_are_read_back(
    tmp_path: Path, distance: Literal["to_plane", "along_ray"]
) -> None:
    """Pixels at the rim look 1.8 times as far as their depth; none moves a voxel by more than the truncation."""
    wide = mg.mapping.PinholeCamera(160, 120, 67, 67, 79.5, 59.5, 0.1, 3.0)
    ball = [mg.LinkShape(mg.Sphere(0.5))]
    camera = mg.mapping.DepthCamera(wide, mg.mapping.DepthNoise(constant=0.003))
    sdf = mg.ProbabilisticSdf(voxel=0.003, truncation=0.010, distance=distance)
    for angle in (0.5, 0.7, 0.9):  # the ball stands at the rim of the image
        T = mg.mapping.look_down([0, 0, 1.0]) @ mg.pose([0, 0, 0], rpy=[0, angle, 0])
        sdf.integrate(mg.mapping.render_depth(ball, wide, T, noise=0.003, seed=round(10 * angle)), camera)
    mean, _, known = sdf.query(np.random.default_rng(1).uniform(-0.52, 0.52, (400_000, 3)))
    assert known.sum() > 1000 and np.abs(mean[known]).max() <= 0.010 * (1 + 1e-6)
    assert mean[known].max() > 0.009 and mean[known].min() < -0.009  # voxels out to there are moved
    sdf.save(tmp_path / "map.sdf")
    assert mg.ProbabilisticSdf.load(tmp_path / "map.sdf").blocks == sdf.blocks


def test_distances_have_a_margin_and_a_rule_for_the_unknown() -> None:
    sdf = mg.ProbabilisticSdf()
    sdf.integrate(frame([0, 0, 0.35]), CAMERA)
    point = [[0.0, 0.0, 0.042]]
    mean, sigma, _ = sdf.query(point)
    assert sdf.distances(point, sigmas=3)[0] == pytest.approx(mean[0] - 3 * sigma[0])
    far = [[1.0, 1.0, 1.0]]
    assert np.isnan(sdf.distances(far)[0])
    assert sdf.distances(far, unknown="free")[0] == pytest.approx(sdf.truncation)
    assert sdf.distances(far, unknown="occupied")[0] == pytest.approx(-sdf.truncation)
    with pytest.raises(mg.InvalidInput, match="unknown = maybe: must be one of unknown, free, occupied"):
        sdf.distances(far, unknown="maybe")  # type: ignore[arg-type]


def test_what_is_refused_leaves_the_map_alone(tmp_path: Path) -> None:
    sdf = mg.ProbabilisticSdf()
    good = frame([0, 0, 0.35])
    millimetres = mg.mapping.DepthImage(1000 * good.depth, INTRINSICS, good.T_world_camera)
    with pytest.raises(mg.InvalidInput, match="divided by 1000"):
        sdf.integrate(millimetres, CAMERA)
    empty = mg.mapping.DepthImage(np.full((120, 160), np.nan), INTRINSICS)
    with pytest.raises(mg.InvalidInput, match="no pixel measured"):
        sdf.integrate(empty, CAMERA)
    other = mg.mapping.DepthCamera(mg.mapping.PinholeCamera())
    with pytest.raises(mg.InvalidInput, match="must have the size of camera 'camera', 640 x 480"):
        sdf.integrate(good, other)
    with pytest.raises(mg.InvalidInput, match="sigma"):
        sdf.integrate(good, CAMERA, sigma=np.ones((5, 160)))
    with pytest.raises(mg.InvalidInput, match="pose_covariance"):
        sdf.integrate(good, CAMERA, pose_covariance=np.eye(5))
    with pytest.raises(mg.InvalidInput, match="max_memory = 1 MB"):
        mg.ProbabilisticSdf(max_memory=1e6).integrate(good, CAMERA)
    with pytest.raises(mg.InvalidInput, match="must be one of to_plane, along_ray"):
        mg.ProbabilisticSdf(distance="sideways")  # type: ignore[arg-type]
    with pytest.raises(mg.InvalidInput, match="voxel"):
        mg.ProbabilisticSdf(voxel_size=0.002)  # type: ignore[call-arg]
    assert (sdf.frames, sdf.blocks) == (0, 0)
    (tmp_path / "map.sdf").write_text("no map at all")
    with pytest.raises(mg.IoError, match="is no map of mmgrasp"):
        mg.ProbabilisticSdf.load(tmp_path / "map.sdf")


def test_published_noise() -> None:
    noise = mg.mapping.DepthNoise
    assert noise.structured_light().sigma(1.0) == pytest.approx(0.0012 + 0.0019 * 0.36)
    assert noise.stereo(500, 0.1, 0.1).sigma(2.0) == pytest.approx(0.008)
    assert noise.time_of_flight().sigma(2.0) == pytest.approx(0.0017)
    with pytest.raises(mg.InvalidInput, match="noise"):
        mg.mapping.DepthCamera(INTRINSICS, noise(constant=-0.001))


def test_rays_meet_a_table_at_any_height_of_the_grid() -> None:
    """A surface on the border of what a ray's walk takes in one stride (8 blocks of 8 voxels; z = 0 is one) and beside it; the
    tower makes rays begin well above.
    """
    rng = np.random.default_rng(3)
    wide = mg.mapping.PinholeCamera(width=160, height=120, fx=100.0, fy=100.0, cx=79.5, cy=59.5)
    for height in (0.0, 0.128, 0.016, 0.003):
        sdf = mg.ProbabilisticSdf(voxel=0.002)
        tower = mg.LinkShape(mg.Box([0.04, 0.04, 0.1]), mg.pose([-0.17, 0, height + 0.05]))
        table = [mg.LinkShape(mg.collision.Plane([0, 0, 1], height)), tower]
        sdf.integrate(
            mg.mapping.render_depth(table, wide, mg.mapping.look_down([0, 0, height + 0.3])),
            mg.mapping.DepthCamera(wide, mg.mapping.DepthNoise(constant=0.0005)),
        )
        origins = np.column_stack([rng.uniform(-0.08, 0.08, (4000, 2)), height + rng.uniform(0.1, 0.4, 4000)])
        directions = np.column_stack([rng.uniform(-0.1, 0.1, (4000, 2)), np.full(4000, -1.0)])
        directions[::2] *= 1e-4, 1e-4, 1.0
        hits = sdf.cast_rays(origins, directions)
        assert hits.hit.mean() == 1.0, height
        np.testing.assert_allclose(hits.point[:, 2], height, atol=2e-4)


def test_an_empty_map_has_arrays_of_the_usual_columns() -> None:
    mesh, sigmas = mg.ProbabilisticSdf().mesh()
    assert (mesh.vertices.shape, mesh.triangles.shape, sigmas.shape) == ((0, 3), (0, 3), (0,))


def test_a_frame_is_moved_onto_the_map() -> None:
    sdf = mg.ProbabilisticSdf(outlier_gate=5.0, persistence=20)
    eyes = [[0.0, 0.0, 0.35], [0.04, 0.02, 0.35], [-0.03, 0.03, 0.33]]
    for eye in eyes:
        report = sdf.integrate(frame(eye), CAMERA)
        assert report.outliers < 30 and report.contradicted == 0
    seen = frame([0.02, -0.02, 0.34])
    truth = np.array(seen.T_world_camera)
    off = truth @ mg.pose([0.002, -0.003, 0.006], rpy=[0.01, -0.008, 0.0])
    image = mg.mapping.DepthImage(seen.depth, INTRINSICS, off)
    covariance = np.diag([0.01**2] * 3 + [0.02**2] * 3)
    found = mg.mapping.register_frame(sdf, image, CAMERA, pose_covariance=covariance)
    assert found.registered and found.reason == "" and found.matched > 1000 and found.rms < found.rms_before
    # From straight above only tops are seen: they fix height and tilt, and the rest stays as given.
    assert found.observed == 3 and abs(found.T_world_camera[2, 3] - truth[2, 3]) < 0.0005
    assert found.T_world_camera[2, 2] == pytest.approx(-1, abs=1e-6)
    assert np.abs(found.T_world_camera[:2, 3] - off[:2, 3]).max() < 0.0005
    assert (np.linalg.eigvalsh(covariance - found.covariance) > -1e-12).all()
    sdf.integrate(
        mg.mapping.DepthImage(seen.depth, INTRINSICS, found.T_world_camera), CAMERA, pose_covariance=found.covariance
    )
    away = mg.mapping.DepthImage(seen.depth, INTRINSICS, mg.pose([3, 0, 0]) @ off)
    refused = mg.mapping.register_frame(sdf, away, CAMERA, pose_covariance=covariance)
    assert not refused.registered and "meet the map's surface" in refused.reason
    assert np.array_equal(refused.T_world_camera, away.T_world_camera)
    with pytest.raises(mg.InvalidInput, match="pose_covariance"):
        mg.mapping.register_frame(sdf, image, CAMERA, pose_covariance=np.zeros((6, 6)))
    with pytest.raises(mg.InvalidInput, match="min_overlap"):
        mg.mapping.register_frame(sdf, image, CAMERA, pose_covariance=covariance, min_overlap=0.0)


def test_views_of_opposite_sides_are_not_taken_for_inverted_poses() -> None:
    """A lone box turned before the camera: what one view sees is hidden from the next, and contradicts nothing."""
    box = [mg.LinkShape(mg.Box([0.16, 0.06, 0.21]))]
    images = []
    for k in range(24):
        z, angle = 1 - (2 * k + 1) / 24, 2.39996 * k
        way = np.array([np.sqrt(1 - z * z) * np.cos(angle), np.sqrt(1 - z * z) * np.sin(angle), z])
        images.append(mg.mapping.render_depth(box, INTRINSICS, look_at(0.35 * way, np.zeros(3))))
    warnings = 0
    for first in images[::3]:
        for second in images:
            sdf = mg.ProbabilisticSdf(voxel=0.006, truncation=0.02)
            sdf.integrate(first, CAMERA)
            report = sdf.integrate(second, CAMERA)  # refuses inverted poses
            assert np.isnan(report.agreement) or report.agreement > 0.5
            warnings += report.warning != ""
    assert warnings < 0.1 * 8 * 24
