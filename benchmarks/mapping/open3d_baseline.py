"""Open3D's VoxelBlockGrid on the same frames; run by the python of the baselines' environment.

    python benchmarks/mapping/open3d_baseline.py FRAMES.npz VOXEL TRUNCATION MESH.npz

Prints a JSON line.
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path

import numpy as np
import open3d as o3d
from frames import Frames, resident_memory

core = o3d.core
ROUNDS = 3


def fuse(path: Path, voxel: float, truncation: float, mesh_path: Path) -> None:
    frames = Frames.load(path)
    fx, fy, cx, cy = frames.intrinsics
    # Integers are the middles of our pixels. Open3D cuts off what follows the point: they are its pixels' corners.
    intrinsics = core.Tensor([[fx, 0, cx + 0.5], [0, fy, cy + 0.5], [0, 0, 1]], core.float64)
    farthest = float(frames.reach[1])
    images = [o3d.t.geometry.Image(core.Tensor(depth)) for depth in frames.depth]
    extrinsics = [core.Tensor(np.linalg.inv(pose)) for pose in frames.poses]

    def grid() -> o3d.t.geometry.VoxelBlockGrid:
        types = (core.float32, core.float32)
        return o3d.t.geometry.VoxelBlockGrid(
            ("tsdf", "weight"), types, ((1), (1)), voxel, 8, 10000, core.Device("CPU:0")
        )

    best, grown = float("inf"), 0
    for k in range(ROUNDS):
        before = resident_memory()
        volume = grid()
        begin = time.perf_counter()
        for image, extrinsic in zip(images, extrinsics, strict=True):
            blocks = volume.compute_unique_block_coordinates(
                image, intrinsics, extrinsic, 1.0, farthest, truncation / voxel
            )
            volume.integrate(blocks, image, intrinsics, extrinsic, 1.0, farthest, truncation / voxel)
        best = min(best, time.perf_counter() - begin)
        if k == 0:  # later ones find memory that this one gave back
            grown = resident_memory() - before
    height, width = frames.depth.shape[1:]
    seen = volume.compute_unique_block_coordinates(
        images[0], intrinsics, extrinsics[0], 1.0, farthest, truncation / voxel
    )
    wall, processor, hit = float("inf"), float("inf"), 0.0
    for _ in range(ROUNDS):
        begin, used = time.perf_counter(), time.process_time()
        cast = volume.ray_cast(
            seen, intrinsics, extrinsics[0], width, height, ["depth", "vertex", "normal"], 1.0, 0.1, farthest, 0.5,
            truncation / voxel,
        )  # fmt: skip
        wall = min(wall, time.perf_counter() - begin)
        processor = min(processor, time.process_time() - used)
        hit = float(np.mean(cast["depth"].numpy() > 0))
    count = volume.hashmap().size()
    line = {
        "version": o3d.__version__,
        "frames_per_second": len(images) / best,
        "blocks": count,
        "memory_mb": count * 512 * 8 / 1e6,
        "grown_mb": grown / 1e6,
        "rays": [width * height / wall, width * height / processor, hit],
    }
    print(json.dumps(line))
    mesh = volume.extract_triangle_mesh(weight_threshold=0.5)
    np.savez(mesh_path, vertices=mesh.vertex.positions.numpy())


if __name__ == "__main__":
    fuse(Path(sys.argv[1]), float(sys.argv[2]), float(sys.argv[3]), Path(sys.argv[4]))
