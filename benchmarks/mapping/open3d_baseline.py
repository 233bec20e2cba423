"""Open3D's VoxelBlockGrid on the same frames; run by the python of the baselines' environment.

    python benchmarks/mapping/open3d_baseline.py read FOLDER FRAMES.npz
    python benchmarks/mapping/open3d_baseline.py fuse FRAMES.npz VOXEL TRUNCATION [MESH.npz]

The first form reads the 16-bit images and poses of FOLDER; the second prints JSON lines.
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path

import numpy as np
import open3d as o3d
from frames import Frames

core = o3d.core


def read(folder: Path, to: Path) -> None:
    images = sorted(folder.glob("*.depth.png"))
    depth = np.stack([np.asarray(o3d.io.read_image(str(path))) for path in images]).astype(np.float32) / 1000
    depth[depth > 60] = 0  # 65535: nothing measured
    poses = np.stack([np.loadtxt(str(path).replace(".depth.png", ".pose.txt")) for path in images])
    for pose in poses:  # written with rotations off by 1e-4
        left, _, right = np.linalg.svd(pose[:3, :3])
        pose[:3, :3] = left @ right
    Frames(depth, poses, np.array([585.0, 585.0, 320.0, 240.0]), np.array([0.2, 5.0])).save(to)


def fuse(path: Path, voxel: float, truncation: float, mesh_path: Path | None) -> None:
    frames = Frames.load(path)
    fx, fy, cx, cy = frames.intrinsics
    intrinsics = core.Tensor([[fx, 0, cx], [0, fy, cy], [0, 0, 1]], core.float64)
    farthest = float(frames.reach[1])
    images = [o3d.t.geometry.Image(core.Tensor(depth)) for depth in frames.depth]
    extrinsics = [core.Tensor(np.linalg.inv(pose)) for pose in frames.poses]

    def grid() -> o3d.t.geometry.VoxelBlockGrid:
        types = (core.float32, core.float32)
        return o3d.t.geometry.VoxelBlockGrid(
            ("tsdf", "weight"), types, ((1), (1)), voxel, 8, 50000, core.Device("CPU:0")
        )

    best = float("inf")
    for _ in range(2):
        volume = grid()
        begin = time.perf_counter()
        for image, extrinsic in zip(images, extrinsics, strict=True):
            blocks = volume.compute_unique_block_coordinates(
                image, intrinsics, extrinsic, 1.0, farthest, truncation / voxel
            )
            volume.integrate(blocks, image, intrinsics, extrinsic, 1.0, farthest, truncation / voxel)
        best = min(best, time.perf_counter() - begin)
    blocks = volume.hashmap().size()
    print(json.dumps({"frames_per_second": len(images) / best, "blocks": blocks, "memory_mb": blocks * 512 * 8 / 1e6}))
    if mesh_path is not None:
        mesh = volume.extract_triangle_mesh(weight_threshold=0.5)
        np.savez(mesh_path, vertices=mesh.vertex.positions.numpy())


if __name__ == "__main__":
    if sys.argv[1] == "read":
        read(Path(sys.argv[2]), Path(sys.argv[3]))
    else:
        fuse(Path(sys.argv[2]), float(sys.argv[3]), float(sys.argv[4]), Path(sys.argv[5]) if sys.argv[5:] else None)
