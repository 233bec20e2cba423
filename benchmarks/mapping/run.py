"""The probabilistic map beside Open3D's VoxelBlockGrid, on the same frames in one run.

    python benchmarks/mapping/run.py [--frames FOLDER] [--count N] [--voxel 0.002] [--truncation 0.01] [--baselines FOLDER]

Real frames: FOLDER of 16-bit depth images in millimetres with poses (default: tsdf_fusion of the shared data). Rendered
frames: a box, a sphere and a can on a table, of which the truth is known. Open3D lives in an environment of its own below
build/, or the one named by --baselines. Prints frames/s, rays/s, points/s, memory and the error of the meshes.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent), str(HERE.parents[1] / "tests" / "python")]
from frames import Frames
from programs import baselines_environment
from tables import ROOT

import mmgrasp as mg
from camera_poses import look_at

TABLE_SCENE = [
    mg.LinkShape(mg.Box([1.0, 1.0, 0.02]), mg.pose([0, 0, -0.01])),
    mg.LinkShape(mg.Box([0.12, 0.08, 0.10]), mg.pose([0.12, 0.05, 0.05])),
    mg.LinkShape(mg.Sphere(0.06), mg.pose([-0.12, 0.08, 0.06])),
    mg.LinkShape(mg.Cylinder(0.04, 0.14), mg.pose([0.0, -0.12, 0.07])),
]


def rendered(count: int) -> Frames:
    """A circle around the table, with the noise of a millimetre at one metre."""
    camera = mg.mapping.PinholeCamera(farthest=3.0)
    poses, depth = [], []
    for k in range(count):
        angle = 2 * np.pi * k / count
        eye = np.array([0.55 * np.cos(angle), 0.55 * np.sin(angle), 0.45 + 0.1 * (k % 3)])
        poses.append(look_at(eye, np.array([0, 0, 0.04])))
        depth.append(mg.mapping.render_depth(TABLE_SCENE, camera, poses[-1], noise=0.001, seed=k + 1).depth)
    return Frames(np.stack(depth), np.stack(poses), np.array([525.0, 525.0, 319.5, 239.5]), np.array([0.1, 3.0]))


def distance_to_scene(points: np.ndarray) -> np.ndarray:
    """Unsigned distance of the rendered scene's surfaces, in closed form."""

    def box(centre: list[float], size: list[float]) -> np.ndarray:
        q = np.abs(points - centre) - np.array(size) / 2
        return np.asarray(np.linalg.norm(np.maximum(q, 0), axis=1) + np.minimum(q.max(axis=1), 0))

    table = box([0, 0, -0.01], [1, 1, 0.02])
    part = box([0.12, 0.05, 0.05], [0.12, 0.08, 0.10])
    ball = np.linalg.norm(points - [-0.12, 0.08, 0.06], axis=1) - 0.06
    can = np.stack([np.hypot(points[:, 0], points[:, 1] + 0.12) - 0.04, np.abs(points[:, 2] - 0.07) - 0.07], axis=1)
    can_distance = np.linalg.norm(np.maximum(can, 0), axis=1) + np.minimum(can.max(axis=1), 0)
    return np.asarray(np.abs(np.min([table, part, ball, can_distance], axis=0)))


def fused(frames: Frames, voxel: float, truncation: float) -> tuple[mg.ProbabilisticSdf, float]:
    """The map, and frames per second of the better of two runs."""
    fx, fy, cx, cy = frames.intrinsics
    height, width = frames.depth.shape[1:]
    pinhole = mg.mapping.PinholeCamera(width, height, fx, fy, cx, cy, *frames.reach)
    noise = mg.mapping.DepthNoise(constant=5e-4, quadratic=5e-4)
    camera = mg.mapping.DepthCamera(pinhole, noise)
    images = [mg.mapping.DepthImage(d, pinhole, T) for d, T in zip(frames.depth, frames.poses, strict=True)]
    best = np.inf
    for _ in range(2):
        sdf = mg.ProbabilisticSdf(voxel=voxel, truncation=truncation, max_memory=8e9)
        begin = time.perf_counter()
        for image in images:
            sdf.integrate(image, camera)
        best = min(best, time.perf_counter() - begin)
    return sdf, len(images) / best


def rate(call: Callable[[], object], count: int) -> float:
    """Per second, the best of three."""
    times = []
    for _ in range(3):
        begin = time.perf_counter()
        call()
        times.append(time.perf_counter() - begin)
    return count / min(times)


def measure(name: str, frames: Frames, arguments: argparse.Namespace, python: Path, folder: Path) -> None:
    path, mesh_path = folder / f"{name}.npz", folder / f"{name}_mesh.npz"
    frames.save(path)
    sdf, ours = fused(frames, arguments.voxel, arguments.truncation)
    command = [python, HERE / "open3d_baseline.py", "fuse", path, arguments.voxel, arguments.truncation, mesh_path]
    done = subprocess.run([str(part) for part in command], check=True, capture_output=True, text=True)
    theirs = json.loads(done.stdout.splitlines()[-1])
    print(f"{name}: {len(frames.depth)} frames of {frames.depth.shape[2]} x {frames.depth.shape[1]}")
    print(f"  mmgrasp {ours:.1f} frames/s, {sdf.blocks} blocks, {sdf.memory / 1e6:.0f} MB")
    print(
        f"  Open3D {theirs['frames_per_second']:.1f} frames/s, {theirs['blocks']} blocks, {theirs['memory_mb']:.0f} MB"
    )
    points = sdf.points()[0]
    if name == "rendered":
        for who, vertices in (("mmgrasp", points), ("Open3D", np.load(mesh_path)["vertices"])):
            error = distance_to_scene(vertices)
            print(
                f"  {who}: mesh error rms {1e3 * np.sqrt(np.mean(error**2)):.3f} mm, 95 % {1e3 * np.quantile(error, 0.95):.3f} mm"
            )
    rng = np.random.default_rng(1)
    near = points[rng.integers(len(points), size=1_000_000)] + rng.uniform(-0.003, 0.003, (1_000_000, 3))
    print(
        f"  points/s: {rate(lambda: sdf.query(near), len(near)) / 1e6:.1f} million (near the surface, in random order)"
    )
    eyes = frames.poses[rng.integers(len(frames.poses), size=200_000), :3, 3]
    towards = points[rng.integers(len(points), size=len(eyes))] - eyes
    hits = sdf.cast_rays(eyes, towards).hit.mean()
    print(f"  rays/s: {rate(lambda: sdf.cast_rays(eyes, towards), len(eyes)) / 1e6:.2f} million ({hits:.0%} hit)")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    shared = ROOT.parent / "shared/data/clouds/tsdf_fusion/rgbd-frames"
    parser.add_argument("--frames", type=Path, default=shared)
    parser.add_argument("--count", type=int, default=50)
    parser.add_argument("--voxel", type=float, default=0.002)
    parser.add_argument("--truncation", type=float, default=0.010)
    parser.add_argument("--baselines", type=Path, default=ROOT / "build/baselines-mapping")
    arguments = parser.parse_args()
    python = baselines_environment(arguments.baselines.absolute(), HERE / "baselines.txt")
    with tempfile.TemporaryDirectory() as folder:
        measure("rendered", rendered(arguments.count), arguments, python, Path(folder))
        if arguments.frames.exists():
            path = Path(folder) / "real.npz"
            command = [python, HERE / "open3d_baseline.py", "read", arguments.frames, path]
            subprocess.run([str(part) for part in command], check=True)
            real = Frames.load(path)
            cut = Frames(real.depth[: arguments.count], real.poses[: arguments.count], real.intrinsics, real.reach)
            measure("real", cut, arguments, python, Path(folder))


if __name__ == "__main__":
    main()
