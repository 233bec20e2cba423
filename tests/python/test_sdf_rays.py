"""Rays into a probabilistic map against a fine walk along each of them."""

from __future__ import annotations

import threading
import time
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from camera_poses import look_at
from mmgrasp import mapping

VOXEL = 0.004


@pytest.fixture(scope="module")
def sdf() -> mg.ProbabilisticSdf:
    """A ball and a box on a table, seen from four sides with noise: rims, holes and surfaces a few voxels thin."""
    pinhole = mapping.PinholeCamera(160, 120, 140, 140, 79.5, 59.5, 0.1, 3.0)
    camera = mapping.DepthCamera(pinhole, mapping.DepthNoise(constant=0.001))
    scene = [
        mg.LinkShape(mg.Box([0.6, 0.6, 0.02]), mg.pose([0, 0, -0.01])),
        mg.LinkShape(mg.Sphere(0.06), mg.pose([0.08, 0, 0.06])),
        mg.LinkShape(mg.Box([0.05, 0.08, 0.1]), mg.pose([-0.08, 0.02, 0.05])),
    ]
    found = mg.ProbabilisticSdf(voxel=VOXEL, truncation=4 * VOXEL)
    for k in range(4):
        angle = np.pi / 2 * k
        pose = look_at(np.array([0.5 * np.cos(angle), 0.5 * np.sin(angle), 0.4]), np.zeros(3))
        found.integrate(mapping.render_depth(scene, pinhole, pose, noise=0.001, seed=k + 1), camera)
    return found


def walked(sdf: mg.ProbabilisticSdf, origin: np.ndarray, direction: np.ndarray, reach: float) -> float:
    """Distance of the first step from known and in front to known and not in front; NaN without one."""
    t = np.arange(0.0, reach, VOXEL / 40)
    mean, _, known = sdf.query(origin + t[:, None] * direction)
    with np.errstate(invalid="ignore"):
        crossed = np.flatnonzero(known[:-1] & (mean[:-1] > 0) & known[1:] & (mean[1:] <= 0))
    return float(t[crossed[0] + 1]) if len(crossed) else np.nan


def test_rays_find_what_a_fine_walk_finds(sdf: mg.ProbabilisticSdf) -> None:
    rng = np.random.default_rng(5)
    points = sdf.points()[0]
    origins = rng.normal(size=(400, 3))
    origins = 0.5 * origins / np.linalg.norm(origins, axis=1)[:, None]
    targets = points[rng.integers(len(points), size=len(origins))] + rng.normal(0, 0.3 * VOXEL, (len(origins), 3))
    directions = targets - origins
    reach = 1.5 * np.linalg.norm(directions, axis=1)
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    hits = sdf.cast_rays(origins, directions)
    expected = np.array([walked(sdf, o, d, r) for o, d, r in zip(origins, directions, reach, strict=True)])
    found = np.where(hits.hit & (hits.distance < reach), hits.distance, np.nan)
    same = (np.isnan(found) & np.isnan(expected)) | (np.abs(found - expected) <= VOXEL / 20)
    # A walk does not see the last crossing before the unknown; a ray that hardly touches may be judged differently.
    beyond = sdf.query(origins + (np.nan_to_num(found) + VOXEL / 4)[:, None] * directions)[2]
    rim = ~np.isnan(found) & np.isnan(expected) & ~beyond
    assert rim.mean() < 0.03
    assert (same | rim).mean() >= 0.99, np.flatnonzero(~(same | rim))
    assert np.isfinite(expected).mean() > 0.3 and np.isnan(expected).mean() > 0.05
    mean = sdf.query(hits.point[hits.hit])[0]
    assert np.nanmax(np.abs(mean)) < 0.05 * VOXEL


def test_a_map_that_grows_gives_rays_what_it_holds(sdf: mg.ProbabilisticSdf) -> None:
    pinhole = mapping.PinholeCamera(160, 120, 140, 140, 79.5, 59.5, 0.1, 3.0)
    camera = mapping.DepthCamera(pinhole, mapping.DepthNoise(constant=0.001))
    grown = mg.ProbabilisticSdf(voxel=VOXEL, truncation=4 * VOXEL)
    down, from_above = [[0.0, 0.0, -1.0]], [[0.011, 0.007, 0.5]]
    for height in (0.0, 0.05):
        plate = [mg.LinkShape(mg.Box([0.3, 0.3, 0.02]), mg.pose([0, 0, height - 0.01]))]
        for angle in (0.0, 2.0):
            pose = look_at(np.array([0.3 * np.cos(angle), 0.3 * np.sin(angle), 0.5]), np.zeros(3))
            for _ in range(6):  # often enough that the old plate is looked through
                grown.integrate(mapping.render_depth(plate, pinhole, pose), camera)
        assert grown.cast_rays(from_above, down).distance[0] == pytest.approx(0.5 - height, abs=VOXEL)


def test_answers_do_not_depend_on_threads(sdf: mg.ProbabilisticSdf) -> None:
    rng = np.random.default_rng(6)
    origins, directions = rng.uniform(-0.5, 0.5, (3000, 3)), rng.normal(size=(3000, 3))
    fresh = [mg.ProbabilisticSdf.load(save) for save in _saved(sdf, 2)]
    one, more = fresh[0].cast_rays(origins, directions, threads=1), fresh[1].cast_rays(origins, directions, threads=4)
    for name in ("hit", "distance", "point", "normal", "sigma"):
        np.testing.assert_array_equal(getattr(one, name), getattr(more, name))


def test_a_ray_has_the_same_answer_alone_and_among_others(sdf: mg.ProbabilisticSdf) -> None:
    """Rays are sorted by what they meet; where they stand in a batch must not show."""
    rng = np.random.default_rng(8)
    origins, points = rng.uniform(-0.5, 0.5, (500, 3)), sdf.points()[0]
    directions = points[rng.integers(len(points), size=500)] - origins
    many = sdf.cast_rays(origins, directions)
    assert 100 < many.hit.sum() < 500
    shuffled = rng.permutation(500)
    others = sdf.cast_rays(origins[shuffled], directions[shuffled])
    for name in ("hit", "distance", "point", "normal", "sigma"):
        np.testing.assert_array_equal(getattr(others, name), getattr(many, name)[shuffled])
        alone = [getattr(sdf.cast_rays(origins[i : i + 1], directions[i : i + 1]), name) for i in range(40)]
        np.testing.assert_array_equal(np.concatenate(alone), getattr(many, name)[:40])


def test_large_batches_are_put_in_order_and_answered_in_theirs(sdf: mg.ProbabilisticSdf) -> None:
    """Rays from within the map, beside it and past it, many along an axis; in pieces and all at once."""
    rng = np.random.default_rng(11)
    origins, points = rng.uniform(-0.6, 0.6, (50_000, 3)), sdf.points()[0]
    directions = points[rng.integers(len(points), size=len(origins))] - origins
    directions[::3] = rng.normal(size=directions[::3].shape)
    directions[::7] = [0.0, 0.0, -1.0]
    many = sdf.cast_rays(origins, directions, threads=2)
    assert 10_000 < many.hit.sum() < 45_000
    pieces = [sdf.cast_rays(origins[i : i + 5000], directions[i : i + 5000]) for i in range(0, len(origins), 5000)]
    for name in ("hit", "distance", "point", "normal", "sigma"):
        np.testing.assert_array_equal(np.concatenate([getattr(piece, name) for piece in pieces]), getattr(many, name))


def test_normals_are_central_differences_of_the_mean(sdf: mg.ProbabilisticSdf) -> None:
    rng = np.random.default_rng(9)
    origins = np.column_stack([rng.uniform(-0.2, 0.2, (2000, 2)), np.full(2000, 0.4)])
    hits = sdf.cast_rays(origins, np.tile([0.05, -0.03, -1.0], (2000, 1)))
    steps = VOXEL * np.stack([np.eye(3), -np.eye(3)])
    mean, _, known = sdf.query((hits.point[hits.hit][:, None, None] + steps).reshape(-1, 3))
    inside = known.reshape(-1, 6).all(axis=1)
    ahead, behind = mean.reshape(-1, 2, 3)[inside].transpose(1, 0, 2)
    expected = (ahead - behind) / np.linalg.norm(ahead - behind, axis=1)[:, None]
    assert inside.sum() > 1000
    np.testing.assert_allclose(hits.normal[hits.hit][inside], expected, atol=2e-4)


@pytest.mark.parametrize("length", [1e-300, 1e-120, 3.0, 1e5])
def test_the_length_of_a_direction_is_the_unit_of_the_distance(sdf: mg.ProbabilisticSdf, length: float) -> None:
    origin, unit = np.array([[0.01, 0.02, 0.5]]), np.array([[0.0, 0.28, -0.96]])
    usual, scaled = sdf.cast_rays(origin, unit), sdf.cast_rays(origin, length * unit)
    assert usual.hit[0] and scaled.hit[0]
    np.testing.assert_allclose(scaled.point, usual.point, atol=1e-9)
    np.testing.assert_allclose(scaled.distance, usual.distance / length, rtol=1e-9)


def _saved(sdf: mg.ProbabilisticSdf, count: int) -> list[Any]:
    import tempfile
    from pathlib import Path

    folder = Path(tempfile.mkdtemp())
    paths = [folder / f"map_{i}.sdf" for i in range(count)]
    for path in paths:
        sdf.save(path)
    return paths


def test_long_casts_hear_ctrl_c(sdf: mg.ProbabilisticSdf) -> None:
    import _thread

    rng = np.random.default_rng(7)
    origins, directions = rng.uniform(-0.5, 0.5, (2_000_000, 3)), rng.normal(size=(2_000_000, 3))
    timer = threading.Timer(0.3, _thread.interrupt_main)
    begun = time.perf_counter()
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        sdf.cast_rays(origins, directions)
        whole = time.perf_counter() - begun
        pytest.skip(f"this machine cast all rays in {whole:.2f} s")
    timer.cancel()


def test_rays_that_are_none_are_named(sdf: mg.ProbabilisticSdf) -> None:
    with pytest.raises(mg.InvalidInput, match="direction 2: must not be zero"):
        sdf.cast_rays(np.zeros((3, 3)), [[1, 0, 0], [0, 1, 0], [0, 0, 0]])
    with pytest.raises(mg.InvalidInput, match="must be as many as origins"):
        sdf.cast_rays(np.zeros((3, 3)), np.ones((2, 3)))


def test_nothing_is_certain_where_frames_disagree() -> None:
    """Poses off by 6 mm and 8 mrad: later frames look through what earlier ones saw, and cells do not fit together."""
    rng = np.random.default_rng(7)
    pinhole = mapping.PinholeCamera(320, 240, 300, 300, 159.5, 119.5, 0.1, 3.0)
    camera = mapping.DepthCamera(pinhole, mapping.DepthNoise(constant=0.001))
    covariance = np.diag([0.006**2] * 3 + [0.008**2] * 3)
    scene = [
        mg.LinkShape(mg.collision.Plane([0, 0, 1], 0.0)),
        mg.LinkShape(mg.Box([0.12, 0.08, 0.06]), mg.pose([0.06, 0.0, 0.03], rpy=[0, 0, 0.4])),
        mg.LinkShape(mg.Box([0.06, 0.06, 0.10]), mg.pose([-0.08, -0.02, 0.05])),
    ]
    sdf = mg.ProbabilisticSdf(voxel=0.003, truncation=0.02)
    for k in range(16):
        angle = np.pi / 8 * k
        eye = np.array([0.4 * np.cos(angle), 0.4 * np.sin(angle), 0.45 if k % 2 == 0 else 0.27])
        image = mapping.render_depth(scene, pinhole, look_at(eye, np.array([0, 0, 0.04])), noise=0.001, seed=k + 1)
        error = mg.pose(0.006 * rng.standard_normal(3), rpy=0.008 * rng.standard_normal(3))
        sdf.integrate(
            mapping.DepthImage(image.depth, pinhole, image.T_world_camera @ error), camera, pose_covariance=covariance
        )
    mean, sigma, known = sdf.query(rng.uniform([-0.2, -0.2, -0.03], [0.2, 0.2, 0.15], (400_000, 3)))
    carved = known & (mean >= 0.02 - 1e-6)
    assert carved.sum() > 10 and sigma[known].min() > 1e-4
    assert (sigma[carved] > 0.02 / 6).all() and (sigma[carved] <= 0.02 / 3 * (1 + 1e-3)).all()

    angles = rng.uniform(0, 2 * np.pi, 40_000)
    origins = np.stack([0.5 * np.cos(angles), 0.5 * np.sin(angles), rng.uniform(0.15, 0.6, len(angles))], axis=1)
    hits = sdf.cast_rays(origins, rng.uniform([-0.15, -0.15, 0], [0.15, 0.15, 0.12], origins.shape) - origins)
    assert hits.sigma[hits.hit].min() > 1e-4
    # Between cells that do not fit together sigma is no less than how far the map is from zero just behind.
    hit = np.flatnonzero(hits.hit)
    apart = hit[np.abs(sdf.query(hits.point[hit])[0]) > 0.001]
    assert len(apart) > 5
    ahead = (hits.point - origins)[apart]
    behind = sdf.query(hits.point[apart] + 0.00015 * ahead / np.linalg.norm(ahead, axis=1)[:, None])[0]
    assert (hits.sigma[apart] >= 0.999 * np.abs(np.minimum(behind, 0))).all()
