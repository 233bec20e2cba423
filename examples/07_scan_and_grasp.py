"""A tray of parts at random, seen by a depth camera: where the gripper may take one (P1 3.7.2).

Fills a tray, renders its depth image, evaluates graspability and prints the best grasps; then fits cuboids to the same
view (P1 3.7.1). With a file name as argument it draws what it found.
"""

import sys

import numpy as np

import mmgrasp as mg
from mmgrasp.problems import random_trays

TRAY = [0.3, 0.4, 0.1]
part = [mg.LinkShape(mg.Box([0.07, 0.035, 0.03]))]
gripper = mg.Hand("tool", approach=[1, 0, 0], closing=[0, 1, 0], max_opening=0.1, finger_depth=0.04, finger_width=0.022)

# Grasps of four random fillings together stand for all places a part may lie in.
scans = [random_trays.scan_random_tray(part, TRAY, gripper, count=12, fill=0.5, seed=seed) for seed in (1, 2, 3, 4)]
for i, scan in enumerate(scans):
    print(f"scan {i + 1}: {len(scan.placement.parts)} parts, {len(scan.grasps)} grasps, counts {scan.found.counts}")
union = random_trays.union_of_grasps(scans)
print(f"union: {len(union)} grasps; the best: {union[0]}")

# For base regions every grasp is a part of its own, to be placed in a mg.base.Tray.
parts = random_trays.parts_of_grasps("tray", union, gripper, mg.pose([0.8, 0, 0.7]))
print(f"a tray of {len(parts)} wanted grasps, the first at {parts[0].T_world_part[:3, 3].round(3)}")

scan = scans[0]
eye = scan.image.T_world_camera[:3, 3]
fit = mg.mapping.fit_cuboids(scan.image.points(), T_world_tray=np.eye(4), tray_size=TRAY, eye=eye)
for cuboid in fit.cuboids:
    print(f"cuboid of {np.round(cuboid.size, 3)} m at {cuboid.T_world_box[:3, 3].round(3)}")

if len(sys.argv) > 1:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 4, figsize=(16, 5))
    for axis, one in zip(axes, scans, strict=True):
        ny, nx = one.height_map.height.shape
        half = np.array([nx, ny]) * one.height_map.resolution / 2
        extent = (-half[0], half[0], -half[1], half[1])
        axis.imshow(one.height_map.height, origin="lower", extent=extent, cmap="Greens")
        for grasp in one.grasps:
            middle, along = grasp.T_object_hand[:2, 3], grasp.T_object_hand[:2, 1]
            half = along * gripper.pregrasp_opening(grasp.opening) / 2
            ends = np.array([middle - half, middle + half])
            axis.plot(*ends.T, "r-", lw=0.5 + 2 * grasp.quality)
        axis.set_title(f"{len(one.grasps)} grasps")
    figure.savefig(sys.argv[1], dpi=80, bbox_inches="tight")
