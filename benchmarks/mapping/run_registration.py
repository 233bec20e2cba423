"""Frames registered to a map: `register_frame` beside Open3D's ICP, on the same frames in one run.

    python benchmarks/mapping/run_registration.py [--frames 40] [--baselines FOLDER] [--write]

The rendered table of run.py, 1 mm of noise at 1 m. A map of twelve frames at their exact poses; then other frames, whose poses are off by 1 cm and
1 degree (standard deviations along and about each axis). Open3D gets the points and normals of our map, and all points of a frame. --write puts the
table into benchmarks/README.md.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np
from run import HERE, ROOT, TABLE_SCENE, environment, look_at, markdown, show

import mmgrasp as mg

CAMERA = mg.mapping.PinholeCamera(width=320, height=240, fx=262.5, fy=262.5, cx=159.5, cy=119.5, farthest=3.0)
NOISE = 0.001  # of a depth at 1 m [m]
MAPPED = 12
OFF = 0.01, np.radians(1.0)  # of the given poses [m, rad]
ALL_POINTS = 40_000
ALMOST = 0.005, np.radians(0.5)  # a pose that is nearer is right [m, rad]


def frame(angle: float, up: float, seed: int) -> mg.mapping.DepthImage:
    """The table from somewhere around it."""
    eye = np.array([0.55 * np.cos(angle), 0.55 * np.sin(angle), up])
    T = look_at(eye, np.array([0, 0, 0.04]))
    return mg.mapping.render_depth(TABLE_SCENE, CAMERA, T, noise=NOISE, seed=seed)


def scanned(camera: mg.mapping.DepthCamera) -> mg.ProbabilisticSdf:
    """Twelve frames at their exact poses."""
    sdf = mg.ProbabilisticSdf(voxel=0.003, truncation=0.015)
    for k in range(MAPPED):
        sdf.integrate(frame(2 * np.pi * k / MAPPED, 0.45 + 0.1 * (k % 3), k + 1), camera)
    return sdf


def displaced(T: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """A pose off by draws of OFF."""
    out = T.copy()
    out[:3, 3] += OFF[0] * rng.normal(size=3)
    out[:3, :3] = mg.pose([0, 0, 0], rpy=OFF[1] * rng.normal(size=3))[:3, :3] @ T[:3, :3]
    return out


def errors(found: np.ndarray, true: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distance [m] and angle [rad] of poses (n, 4, 4) from the true ones."""
    trace = np.einsum("kij,kij->k", found[:, :3, :3], true[:, :3, :3])
    turned = np.arccos(np.clip((trace - 1) / 2, -1, 1))
    return np.linalg.norm(found[:, :3, 3] - true[:, :3, 3], axis=1), turned


def row(name: str, found: np.ndarray, true: np.ndarray, seconds: np.ndarray | None) -> list[str]:
    off, turned = errors(found, true)
    right = int(np.sum((off < ALMOST[0]) & (turned < ALMOST[1])))
    times = "-" if seconds is None else f"{1e3 * np.median(seconds):.1f}"
    return [
        name, f"{right} of {len(off)}", f"{1e3 * np.median(off):.2f}", f"{1e3 * np.quantile(off, 0.95):.2f}",
        f"{np.degrees(np.median(turned)):.3f}", f"{np.degrees(np.quantile(turned, 0.95)):.3f}", times,
    ]  # fmt: skip


def ours(
    sdf: mg.ProbabilisticSdf,
    camera: mg.mapping.DepthCamera,
    images: list[mg.mapping.DepthImage],
    given: np.ndarray,
    **options: int,
) -> tuple[np.ndarray, np.ndarray, str]:
    """Poses (the given one where the frame is refused), seconds, and what is said of frames."""
    covariance = np.diag([OFF[0] ** 2] * 3 + [OFF[1] ** 2] * 3)
    poses, seconds, refused, loose = [], [], 0, 0
    for image, T in zip(images, given, strict=True):
        moved = mg.mapping.DepthImage(image.depth, CAMERA, T)
        begin = time.perf_counter()
        found = mg.mapping.register_frame(sdf, moved, camera, pose_covariance=covariance, **options)
        seconds.append(time.perf_counter() - begin)
        refused += not found.registered
        loose += found.registered and found.observed < 6
        poses.append(found.T_world_camera if found.registered else T)
    told = f"refused {refused} of {len(images)} frames, which keep the given pose, and told of {loose} that not all six directions are fixed"
    return np.stack(poses), np.array(seconds), told


def theirs(
    python: Path, sdf: mg.ProbabilisticSdf, images: list[mg.mapping.DepthImage], given: np.ndarray
) -> dict[str, np.ndarray]:
    """Poses and seconds of each of Open3D's ways."""
    points, normals, _ = sdf.points()
    clouds = {}
    for k, image in enumerate(images):
        seen = image.points()
        T = image.T_world_camera
        clouds[f"frame_{k}"] = (seen - T[:3, 3]) @ T[:3, :3]
    with tempfile.TemporaryDirectory() as folder:
        source, out = Path(folder) / "in.npz", Path(folder) / "out.npz"
        np.savez(source, points=points, normals=normals, given=given, **clouds)
        subprocess.run([python, HERE / "open3d_registration.py", source, out], check=True)
        with np.load(out) as content:
            return dict(content)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--frames", type=int, default=40)
    parser.add_argument("--baselines", type=Path, default=ROOT / "build/baselines-mapping")
    parser.add_argument("--write", action="store_true", help="into benchmarks/README.md")
    arguments = parser.parse_args()
    python = environment(arguments.baselines)
    camera = mg.mapping.DepthCamera(CAMERA, mg.mapping.DepthNoise(constant=1e-4, quadratic=NOISE))
    sdf = scanned(camera)
    rng = np.random.default_rng(1)
    images = [frame(*rng.uniform([0, 0.40], [2 * np.pi, 0.70]), 100 + k) for k in range(arguments.frames)]
    true = np.stack([image.T_world_camera for image in images])
    given = np.stack([displaced(T, rng) for T in true])
    poses, seconds, told = ours(sdf, camera, images, given)
    more, more_seconds, _ = ours(sdf, camera, images, given, max_points=ALL_POINTS)
    rows = [
        row("as given", given, true, None),
        row("`register_frame`", poses, true, seconds),
        row(f"the same, max_points = {ALL_POINTS}", more, true, more_seconds),
    ]
    version = ""
    if python is not None:
        found = theirs(python, sdf, images, given)
        version = f"Open3D {found['version']}; "
        for way in dict.fromkeys(key.partition("/")[0] for key in found if "/" in key):
            rows.append(row(f"Open3D, {way}", found[f"{way}/poses"], true, found[f"{way}/seconds"]))
    head = [
        "",
        "within 5 mm and 0.5 degrees",
        "off, median [mm]",
        "95 %",
        "turned, median [deg]",
        "95 %",
        "median [ms]",
    ]
    text = f"{version}`register_frame` {told}; load {os.getloadavg()[0]:.1f}.\n\n"
    show("registration", text + markdown(head, rows), arguments.write)


if __name__ == "__main__":
    main()
