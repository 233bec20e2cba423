"""Maps of drawn cameras, noises and options: what is written is read back, and no answer is certain, far off or not a number."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import mmgrasp as mg
from camera_poses import look_at

SCENE = [
    mg.LinkShape(mg.collision.Plane([0, 0, 1], 0.0)),
    mg.LinkShape(mg.Box([0.12, 0.08, 0.06]), mg.pose([0.06, 0, 0.03], rpy=[0, 0, 0.4])),
    mg.LinkShape(mg.Sphere(0.05), mg.pose([-0.1, 0, 0.05])),
]


def drawn_camera(rng: np.random.Generator, truncation: float) -> mg.mapping.DepthCamera:
    """From wide to narrow, exact to as noisy as the truncation allows, a third of them with a systematic error."""
    width, height, focal = int(rng.integers(40, 200)), int(rng.integers(40, 160)), rng.uniform(30, 300)
    middle = np.array([width, height]) / 2 + rng.uniform(-20, 20, 2)
    pinhole = mg.mapping.PinholeCamera(
        width, height, focal, focal * rng.uniform(0.8, 1.2), middle[0], middle[1], 0.05, 4.0
    )
    constant = [10 ** rng.uniform(-6.9, -2.5), truncation / 3.01, 0.001][rng.integers(3)]
    noise = mg.mapping.DepthNoise(constant=min(constant, truncation / 3.01), quadratic=rng.choice([0.0, 0.003]))
    return mg.mapping.DepthCamera(pinhole, noise, systematic=rng.choice([0.0, 0.0, 1e-3]))


def drawn_map(rng: np.random.Generator) -> mg.ProbabilisticSdf:
    """Up to eight frames from around the scene, each with or without a covariance of its pose."""
    voxel = 10 ** rng.uniform(-2.5, -1.5)
    truncation = voxel * rng.uniform(3, 12)
    sdf = mg.ProbabilisticSdf(
        voxel=voxel,
        truncation=truncation,
        distance="to_plane" if rng.random() < 0.5 else "along_ray",
        outlier_gate=float(rng.choice([0, 0, 3, 50])),
        persistence=int(rng.choice([1, 2, 254])),
    )
    camera = drawn_camera(rng, truncation)
    for k in range(rng.integers(1, 9)):
        angle, far = rng.uniform(0, 2 * np.pi), rng.uniform(0.2, 1.5)
        eye = far * np.array([np.cos(angle), np.sin(angle), rng.uniform(0.1, 1.5)])
        noise = float(rng.choice([0, 0.001, 0.01]))
        image = mg.mapping.render_depth(
            SCENE, camera.intrinsics, look_at(eye, rng.normal(0, 0.05, 3)), noise=noise, seed=k + 1
        )
        covariance = np.diag(rng.uniform(0, 1e-4, 6)) if rng.random() < 0.5 else np.zeros((6, 6))
        try:
            sdf.integrate(image, camera, pose_covariance=covariance)
        except mg.InvalidInput as error:  # nearly all pixels are noisier than this truncation allows
            assert "at least three standard deviations of the depth" in str(error)
    return sdf


@pytest.mark.parametrize("seed", range(16))
def test_answers_are_uncertain_near_and_the_same_after_a_save(seed: int, tmp_path: Path) -> None:
    rng = np.random.default_rng(seed)
    sdf = drawn_map(rng)
    points = rng.uniform(-0.3, 0.3, (20_000, 3))
    mean, sigma, known = sdf.query(points)
    assert (sigma[known] > 1e-8).all() and np.isfinite(sigma[known]).all()
    assert (np.abs(mean[known]) <= sdf.truncation * (1 + 1e-5)).all()
    assert np.isnan(mean[~known]).all() and np.isnan(sigma[~known]).all()

    origins = rng.uniform(-1, 1, (30_000, 3))
    hits = sdf.cast_rays(origins, rng.normal(0, 0.1, (30_000, 3)) - origins)
    assert (hits.sigma[hits.hit] > 1e-8).all() and np.isfinite(hits.sigma[hits.hit]).all()
    assert np.allclose(np.linalg.norm(hits.normal[hits.hit], axis=1), 1)
    assert (sdf.points()[2] > 1e-8).all()

    sdf.save(tmp_path / "map.sdf")
    again = mg.ProbabilisticSdf.load(tmp_path / "map.sdf")
    for one, other in zip(sdf.query(points), again.query(points), strict=True):
        assert np.array_equal(one, other, equal_nan=True)
