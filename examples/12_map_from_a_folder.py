"""A folder of depth frames, as a robot may record them, becomes a map: what `mmgrasp scan` does, as calls."""

from pathlib import Path

import numpy as np

import mmgrasp as mg
from mmgrasp.frames import open_frames, write_npz_frame
from mmgrasp.scan import Scan, choose_options, integrate_frames, objects_on_plane

scene = [
    mg.LinkShape(mg.collision.Plane([0, 0, 1], 0.0)),
    mg.LinkShape(mg.Box([0.08, 0.05, 0.06]), mg.pose([0.07, 0, 0.03], rpy=[0, 0, 0.5])),
    mg.LinkShape(mg.Cylinder(0.03, 0.08), mg.pose([-0.07, 0.02, 0.04])),
]
pinhole = mg.mapping.PinholeCamera(width=320, height=240, fx=300.0, fy=300.0, cx=159.5, cy=119.5)
intrinsics = np.array([pinhole.fx, pinhole.fy, pinhole.cx, pinhole.cy])

folder = Path("frames")
folder.mkdir(exist_ok=True)
for k in range(8):
    T_world_camera = mg.pose([0.15 * np.cos(k), 0.15 * np.sin(k), 0.45], rpy=[np.pi, 0, 0])
    image = mg.mapping.render_depth(scene, pinhole, T_world_camera, noise=0.002, seed=k + 1)
    millimetres = np.round(1000 * image.depth).astype(np.uint16)
    write_npz_frame(folder / f"{k:03d}.npz", millimetres, T_world_camera, intrinsics, sensor="wrist")
(folder / "sensors.yaml").write_text(
    "version: 1\nsensors:\n  wrist:\n    noise: {model: polynomial, constant: 0.0005, quadratic: 0.002}\n    systematic: 0.0003\n"
)

frames = open_frames(folder)
print(frames)
scan = Scan.begin(choose_options(frames, voxel=None, truncation=None, max_memory=None))
print(f"{integrate_frames(frames, scan)} frames in {scan.sdf}, {len(scan.skipped)} skipped")
points, normals, sigmas = scan.sdf.points()
found = objects_on_plane(points, normals, up=[0, 0, 1], eye=np.array([0, 0, 0.45]), voxel=scan.options.voxel)
print(f"plane at z = {1e3 * found.plane_offset:.1f} mm; sigma of the surface {1e3 * np.median(sigmas):.2f} mm (median)")
for thing in found.objects:
    print(f"object at {np.round(thing.T_world_box[:3, 3], 3)}, {np.round(1e3 * thing.size)} mm")
