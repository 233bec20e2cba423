"""The probabilistic map beside Open3D's VoxelBlockGrid, on the same frames in one run, and what its cost grows with.

    python benchmarks/mapping/run.py [--frames FOLDER] [--count N] [--voxel 0.002] [--truncation 0.01]
                                     [--baselines FOLDER] [--write]

Real frames: FOLDER of 16-bit depth images in millimetres with poses (default: tsdf_fusion of the shared data), and the
five of Open3D's own tests there. Rendered frames: a box, a sphere and a can on a table, of which the truth is known.
Open3D lives in an environment of its own below build/, or the one named by --baselines; where it cannot be installed
its columns stay empty. Then balls: one, and eight of them in volumes of three sizes. --write puts the tables into
benchmarks/README.md.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent), str(HERE.parents[1] / "tests" / "python")]
from frames import Frames, resident_memory
from programs import baselines_environment
from tables import ROOT, markdown, show

import mmgrasp as mg
from camera_poses import look_at
from mmgrasp.frames import open_frames

THREADS = 2
ROUNDS = 5
TABLE_SCENE = [
    mg.LinkShape(mg.Box([1.0, 1.0, 0.02]), mg.pose([0, 0, -0.01])),
    mg.LinkShape(mg.Box([0.12, 0.08, 0.10]), mg.pose([0.12, 0.05, 0.05])),
    mg.LinkShape(mg.Sphere(0.06), mg.pose([-0.12, 0.08, 0.06])),
    mg.LinkShape(mg.Cylinder(0.04, 0.14), mg.pose([0.0, -0.12, 0.07])),
]


# --- frames -----------------------------------------------------------------------------------------------------------
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


def recorded(path: Path, count: int) -> Frames:
    folder = open_frames(path)
    loaded = [folder.read(frame) for frame in folder.frames[:count]]
    pinhole = loaded[0].camera.intrinsics
    depth = np.stack([np.asarray(frame.image.depth, dtype=np.float32) for frame in loaded])
    depth[depth > 60] = 0
    poses = np.stack([frame.image.T_world_camera for frame in loaded])
    return Frames(depth, poses, np.array([pinhole.fx, pinhole.fy, pinhole.cx, pinhole.cy]), np.array([0.2, 5.0]))


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


# --- measurements -----------------------------------------------------------------------------------------------------
def fused(frames: Frames, voxel: float, truncation: float) -> tuple[mg.ProbabilisticSdf, float, int]:
    """The map, frames per second of the best of three runs, and by how many bytes the process grew in the first."""
    fx, fy, cx, cy = frames.intrinsics
    height, width = frames.depth.shape[1:]
    pinhole = mg.mapping.PinholeCamera(width, height, fx, fy, cx, cy, *frames.reach)
    noise = mg.mapping.DepthNoise(constant=5e-4, quadratic=5e-4)
    camera = mg.mapping.DepthCamera(pinhole, noise)
    images = [mg.mapping.DepthImage(d, pinhole, T) for d, T in zip(frames.depth, frames.poses, strict=True)]
    best, grown = np.inf, 0
    for k in range(3):
        before = resident_memory()
        sdf = mg.ProbabilisticSdf(voxel=voxel, truncation=truncation, max_memory=8e9)
        begin = time.perf_counter()
        for image in images:
            sdf.integrate(image, camera)
        best = min(best, time.perf_counter() - begin)
        if k == 0:  # later ones find memory that this one gave back
            grown = resident_memory() - before
    return sdf, len(images) / best, grown


def rates(call: Callable[[], object], count: int) -> tuple[float, float]:
    """Per second on the clock, and per second of a core, the best of five each."""
    wall, processor = [], []
    for _ in range(ROUNDS):
        begin, used = time.perf_counter(), time.process_time()
        call()
        wall.append(time.perf_counter() - begin)
        processor.append(time.process_time() - used)
    return count / min(wall), count / min(processor)


def shown(found: tuple[float, float], hit: float | None = None) -> str:
    text = f"{found[0] / 1e6:.2f}; {found[1] / 1e6:.2f}"
    return text if hit is None else f"{text} ({hit:.0%} hit)"


def image_rays(frames: Frames, k: int) -> tuple[np.ndarray, np.ndarray]:
    """Origins and directions through the pixels of frame k, row by row."""
    fx, fy, cx, cy = frames.intrinsics
    height, width = frames.depth.shape[1:]
    v, u = np.mgrid[:height, :width]
    local = np.column_stack([((u - cx) / fx).ravel(), ((v - cy) / fy).ravel(), np.ones(height * width)])
    return np.tile(frames.poses[k, :3, 3], (len(local), 1)), local @ frames.poses[k, :3, :3].T


def cast(sdf: mg.ProbabilisticSdf, origins: np.ndarray, directions: np.ndarray) -> str:
    hit = float(sdf.cast_rays(origins, directions).hit.mean())
    return shown(rates(lambda: sdf.cast_rays(origins, directions, threads=THREADS), len(origins)), hit)


def asked(sdf: mg.ProbabilisticSdf, points: np.ndarray) -> str:
    return shown(rates(lambda: sdf.query(points, threads=THREADS), len(points)))


def near_surface(points: np.ndarray, count: int, rng: np.random.Generator) -> np.ndarray:
    return np.asarray(points[rng.integers(len(points), size=count)] + rng.uniform(-0.003, 0.003, (count, 3)))


def open3d(python: Path | None, frames: Frames, arguments: argparse.Namespace, folder: Path) -> dict[str, Any] | None:
    if python is None:
        return None
    path, mesh_path = folder / "frames.npz", folder / "mesh.npz"
    frames.save(path)
    command = [python, HERE / "open3d_baseline.py", path, arguments.voxel, arguments.truncation, mesh_path]
    done = subprocess.run([str(part) for part in command], check=True, capture_output=True, text=True)
    return {**json.loads(done.stdout.splitlines()[-1]), "vertices": np.load(mesh_path)["vertices"]}


def mesh_error(points: np.ndarray) -> str:
    error = distance_to_scene(points)
    return f"{1e3 * np.sqrt(np.mean(error**2)):.2f}; {1e3 * np.quantile(error, 0.95):.2f}"


def compared(name: str, frames: Frames, arguments: argparse.Namespace, python: Path | None) -> list[list[str]]:
    """Rows of one kind of frames: what, ours, Open3D's."""
    sdf, ours, grown = fused(frames, arguments.voxel, arguments.truncation)
    with tempfile.TemporaryDirectory() as folder:
        theirs = open3d(python, frames, arguments, Path(folder))
    rng = np.random.default_rng(1)
    points = sdf.points()[0]
    origins, directions = image_rays(frames, 0)
    order = rng.permutation(len(origins))
    eyes = frames.poses[rng.integers(len(frames.poses), size=200_000), :3, 3]
    towards = points[rng.integers(len(points), size=len(eyes))] - eyes
    near = near_surface(points, 1_000_000, rng)

    def rays_of(found: dict[str, Any]) -> str:
        return shown(found["rays"][:2], found["rays"][2])

    def other(text: Callable[[dict[str, Any]], str]) -> str:
        return text(theirs) if theirs else "-"

    rows = [
        ["frames/s", f"{ours:.1f}", other(lambda o: f"{o['frames_per_second']:.1f}")],
        ["blocks of 512 voxels", f"{sdf.blocks}", other(lambda o: f"{o['blocks']}")],
        ["voxels and index (Open3D: voxels) [MB]", f"{sdf.memory / 1e6:.0f}", other(lambda o: f"{o['memory_mb']:.0f}")],
        ["by which the process grew [MB]", f"{grown / 1e6:.0f}", other(lambda o: f"{o['grown_mb']:.0f}")],
        ["million rays/s, an image in its order", cast(sdf, origins, directions), other(rays_of)],
        ["million rays/s, the same shuffled", cast(sdf, origins[order], directions[order]), "-"],
        [f"million rays/s, {len(frames.poses)} places to random points seen", cast(sdf, eyes, towards), "-"],
        ["million points/s within 3 mm of the surface, random order", asked(sdf, near), "-"],
    ]  # fmt: skip
    if name == "rendered":
        error = ["error of the mesh, rms; 95 % [mm]", mesh_error(points), other(lambda o: mesh_error(o["vertices"]))]
        rows.insert(4, error)
    return [[f"{name}: {row[0]}", *row[1:]] for row in rows]


# --- what the cost grows with -----------------------------------------------------------------------------------------
RADIUS, VIEWS = 0.05, 6


def balls(side: int, spacing: float, arguments: argparse.Namespace) -> list[str]:
    """Row of side^3 balls, `spacing` apart, each seen from six sides by frames that see no other."""
    pinhole = mg.mapping.PinholeCamera(320, 240, 300.0, 300.0, 159.5, 119.5, 0.1, 0.5)
    camera = mg.mapping.DepthCamera(pinhole, mg.mapping.DepthNoise(constant=0.001))
    sdf = mg.ProbabilisticSdf(voxel=arguments.voxel, truncation=arguments.truncation, max_memory=8e9)
    middles = spacing * np.array(
        [[x, y, z] for x in range(side) for y in range(side) for z in range(side)], dtype=float
    )
    seconds, eyes, towards = 0.0, [], []
    for k, middle in enumerate(middles):
        shape = [mg.LinkShape(mg.Sphere(RADIUS), mg.pose(middle))]
        for j in range(VIEWS):
            way = np.zeros(3)
            way[j % 3] = 1 if j < 3 else -1
            way += [0.01, 0.02, 0.03]
            eye = middle + 0.3 * way
            image = mg.mapping.render_depth(shape, pinhole, look_at(eye, middle), noise=0.001, seed=VIEWS * k + j + 1)
            begin = time.process_time()
            sdf.integrate(image, camera)
            seconds += time.process_time() - begin
            eyes.append(eye)
            towards.append(middle - eye)
    points = sdf.points()[0]
    rng = np.random.default_rng(1)
    which = rng.integers(len(eyes), size=200_000)
    aside = np.array(towards)[which] + rng.uniform(-0.02, 0.02, (len(which), 3))
    near = near_surface(points, 500_000, rng)
    extent = np.ptp(points, axis=0)
    surface = len(middles) * 4 * np.pi * RADIUS**2
    return [
        f"{len(middles)}", f"{surface:.3f}", f"{np.prod(extent):.3g}", f"{sdf.blocks}", f"{sdf.memory / 1e6:.1f}",
        f"{1e3 * seconds / (VIEWS * len(middles)):.1f}",
        f"{rates(lambda: sdf.cast_rays(np.array(eyes)[which], aside, threads=1), len(which))[1] / 1e6:.2f}",
        f"{rates(lambda: sdf.query(near, threads=1), len(near))[1] / 1e6:.1f}",
    ]  # fmt: skip


def scaling(arguments: argparse.Namespace) -> str:
    head = ["balls", "surface [m^2]", "box around it [m^3]", "blocks", "memory [MB]", "a frame [ms of a core]"]
    head += ["million rays/s of a core", "million points/s of a core"]
    return markdown(head, [balls(1, 0.0, arguments), *(balls(2, apart, arguments) for apart in (0.6, 6.0, 60.0))])


# --- the whole --------------------------------------------------------------------------------------------------------
def environment(folder: Path) -> Path | None:
    """Python with Open3D; None, and said, where it cannot be had."""
    try:
        return baselines_environment(folder.absolute(), HERE / "baselines.txt")
    except (subprocess.CalledProcessError, OSError) as error:
        print(f"Open3D cannot be installed ({error}): its columns stay empty", file=sys.stderr)
        return None


def processor() -> str:
    lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    return next((line.partition(":")[2].strip() for line in lines if line.startswith("model name")), platform.machine())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    shared = ROOT.parent / "shared/data/clouds"
    parser.add_argument("--frames", type=Path, default=shared / "tsdf_fusion/rgbd-frames")
    parser.add_argument("--count", type=int, default=50)
    parser.add_argument("--voxel", type=float, default=0.002)
    parser.add_argument("--truncation", type=float, default=0.010)
    parser.add_argument("--baselines", type=Path, default=ROOT / "build/baselines-mapping")
    parser.add_argument("--write", action="store_true", help="into benchmarks/README.md")
    arguments = parser.parse_args()
    python = environment(arguments.baselines)
    rows = compared("rendered", rendered(arguments.count), arguments, python)
    if arguments.frames.exists():
        rows += compared("real", recorded(arguments.frames, arguments.count), arguments, python)
    if (shared / "open3d/RGBD").exists():
        rows += compared("Open3D's five", recorded(shared / "open3d/RGBD", arguments.count), arguments, python)
    load = os.getloadavg()[0]
    text = [
        f"{arguments.count} frames of a kind, at most; {processor()}, {len(os.sched_getaffinity(0))} cores, load {load:.1f}.",
        f"Rays and points: on {THREADS} threads by the clock; for each second of a core.",
        "",
        markdown(["", "mmgrasp", "Open3D `VoxelBlockGrid`"], rows),
        "",
        f"Balls of {RADIUS} m, each seen from {VIEWS} sides with 320 x 240 pixels:",
        "",
        scaling(arguments),
    ]
    show("mapping", "\n".join(text), arguments.write)


if __name__ == "__main__":
    main()
