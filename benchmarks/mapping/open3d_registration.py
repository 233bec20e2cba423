"""Open3D's ICP of depth frames against the points of a map; run by the python of the baselines' environment.

    python benchmarks/mapping/open3d_registration.py IN.npz OUT.npz

IN: points and normals of the map, frames as points in their camera, the poses that are given. OUT: by way, poses and seconds for each frame.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import open3d as o3d

registration = o3d.pipelines.registration
FARTHEST = 0.05  # the same as ours [m]
LEAF = 0.004  # of the frames' points [m]


def point_to_plane(kernel: object) -> Callable[..., np.ndarray]:
    """From coarse to fine, each with correspondences half as far."""
    estimation = registration.TransformationEstimationPointToPlane(kernel)

    def run(source: o3d.geometry.PointCloud, target: o3d.geometry.PointCloud, given: np.ndarray) -> np.ndarray:
        T = given
        for farthest in (FARTHEST, FARTHEST / 2, FARTHEST / 4, FARTHEST / 8):
            criteria = registration.ICPConvergenceCriteria(max_iteration=50)
            T = registration.registration_icp(source, target, farthest, T, estimation, criteria).transformation
        return np.asarray(T)

    return run


def generalized(source: o3d.geometry.PointCloud, target: o3d.geometry.PointCloud, given: np.ndarray) -> np.ndarray:
    """Plane to plane."""
    T = given
    for farthest in (FARTHEST, FARTHEST / 4):
        T = registration.registration_generalized_icp(
            source, target, farthest, T, registration.TransformationEstimationForGeneralizedICP()
        ).transformation
    return np.asarray(T)


WAYS: dict[str, Callable[..., np.ndarray]] = {
    "point to plane": point_to_plane(registration.L2Loss()),
    "point to plane, Tukey": point_to_plane(registration.TukeyLoss(k=0.005)),
    "generalized": generalized,
}


def cloud(points: np.ndarray) -> o3d.geometry.PointCloud:
    return o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points.astype(np.float64)))


def main(source: Path, out: Path) -> None:
    with np.load(source) as content:
        target = cloud(content["points"])
        target.normals = o3d.utility.Vector3dVector(content["normals"].astype(np.float64))
        given = content["given"]
        frames = [content[f"frame_{k}"] for k in range(len(given))]
    found: dict[str, np.ndarray] = {"version": np.array(o3d.__version__)}
    for way, run in WAYS.items():
        poses, seconds = [], []
        for points, T in zip(frames, given, strict=True):
            begin = time.perf_counter()
            thinned = cloud(points).voxel_down_sample(LEAF)
            if way == "generalized":
                thinned.estimate_normals()
            poses.append(run(thinned, target, T))
            seconds.append(time.perf_counter() - begin)
        found[f"{way}/poses"], found[f"{way}/seconds"] = np.stack(poses), np.array(seconds)
    np.savez(out, **found)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
