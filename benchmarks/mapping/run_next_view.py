"""Chosen views beside fixed ones: how probable is the best grasp of a part after as many frames?

    python benchmarks/mapping/run_next_view.py [--seeds 1 2 3] [--chosen 5] [--threads 1] [--write]

Five parts on a table, a camera with noise of 0.8 mm + 6 mm z^2, its poses off by 1 mm and 3 mrad along and about each
axis. The first view is the same; then the camera goes on round a fixed list (from above and the side, all around), twice
as long, or where `next_view` sends it. Where the part may be is told as a box of 24 x 24 x 20 cm. Each map is asked for its best grasp with 600 samples. Prints the mean over parts
and seeds after every frame, the chosen beside the fixed after twice as many, and that difference part by part with its
95 % interval; last what the best of the poses that were compared for the second view would have given, which nobody
knows before. --write puts the table into benchmarks/README.md.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

BENCHMARKS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(BENCHMARKS), str(BENCHMARKS.parent / "tests" / "python")]

from tables import markdown, show

import mmgrasp as mg
from camera_poses import look_at

SHIFT, TURN = 0.001, 0.003
COVARIANCE = np.diag([SHIFT**2] * 3 + [TURN**2] * 3)
PINHOLE = mg.mapping.PinholeCamera(width=160, height=120, fx=200.0, fy=200.0, cx=79.5, cy=59.5)
CAMERA = mg.mapping.DepthCamera(PINHOLE, mg.mapping.DepthNoise(constant=0.0008, quadratic=0.006))
HAND = mg.Hand(
    "tool", approach=[0, 0, 1], closing=[0, 1, 0], max_opening=0.09, finger_depth=0.02, finger_width=0.018, clearance=0.008,
    body=mg.grasping.HandBody(finger_thickness=0.01, finger_length=0.07, palm_length=0.12, palm_width=0.06),
)  # fmt: skip
MIDDLE = np.array([0, 0, 0.03])
AROUND = np.array(
    [[-0.12, -0.12, 0.0], [0.12, 0.12, 0.2]]
)  # where the part may be, as `mmgrasp scan` tells of an object


def at(shape: mg.Box | mg.Cylinder, x: float, y: float, z: float, yaw: float = 0.0) -> mg.LinkShape:
    return mg.LinkShape(shape, mg.pose([x, y, z], rpy=[0, 0, yaw]))


PARTS = {
    "box": [at(mg.Box([0.045, 0.07, 0.06]), 0, 0, 0.03, 0.4)],
    "can": [at(mg.Cylinder(0.03, 0.09), 0, 0, 0.045)],
    "mallet": [at(mg.Box([0.14, 0.025, 0.03]), 0, 0, 0.015, 1.0), at(mg.Box([0.03, 0.06, 0.05]), 0.03, 0.05, 0.025, 1.0)],
    "L": [at(mg.Box([0.10, 0.03, 0.05]), 0, 0, 0.025), at(mg.Box([0.03, 0.09, 0.05]), -0.035, 0.06, 0.025)],
    "bottle": [at(mg.Cylinder(0.028, 0.10), 0, 0, 0.05), at(mg.Cylinder(0.013, 0.04), 0, 0, 0.12)],
}  # fmt: skip


def fixed_view(k: int) -> np.ndarray:
    turn, up = 2.4 * k, np.radians((65, 30, 48)[k % 3])
    return look_at(MIDDLE + 0.35 * np.array([np.cos(up) * np.cos(turn), np.cos(up) * np.sin(turn), np.sin(up)]), MIDDLE)


def look(sdf: mg.ProbabilisticSdf, scene: list[mg.LinkShape], T: np.ndarray, rng: np.random.Generator) -> None:
    """A frame from T, told to be from where the camera believes it is."""
    depth = np.array(mg.mapping.render_depth(scene, PINHOLE, T).depth, dtype=float)
    seen = depth > 0
    depth[seen] += (0.0008 + 0.006 * depth[seen] ** 2) * rng.standard_normal(int(seen.sum()))
    error = mg.pose(SHIFT * rng.standard_normal(3), rpy=TURN * rng.standard_normal(3))
    sdf.integrate(mg.mapping.DepthImage(np.maximum(depth, 0), PINHOLE, T @ error), CAMERA, pose_covariance=COVARIANCE)


def best(sdf: mg.ProbabilisticSdf, seed: int, threads: int) -> float:
    found = mg.synthesize_grasps(sdf, HAND, table=0.0, object=AROUND, samples=600, seed=seed, threads=threads)
    return found.grasps[0].quality if found.grasps else 0.0


def new_map(threads: int) -> mg.ProbabilisticSdf:
    return mg.ProbabilisticSdf(voxel=0.0025, truncation=0.0125, threads=threads)


def measure(name: str, seed: int, chosen: int, threads: int) -> tuple[list[float], list[float], float]:
    """Probability of the best grasp after each of 2 * `chosen` fixed frames, after each of `chosen` chosen ones, and
    after the first and the best second one.
    """
    scene = [mg.LinkShape(mg.collision.Plane([0, 0, 1], 0.0)), *PARTS[name]]
    maps = [new_map(threads) for _ in range(2)]
    rngs = [np.random.default_rng([seed, list(PARTS).index(name)]) for _ in range(2)]
    fixed, own, second = [], [], 0.0
    for k in range(2 * chosen):
        look(maps[0], scene, fixed_view(k + 7 * seed), rngs[0])
        fixed.append(best(maps[0], seed, threads))
    for k in range(chosen):
        T = fixed_view(7 * seed)
        if k > 0:
            view = mg.grasping.next_view(
                maps[1], HAND, CAMERA, table=0.0, object=AROUND, pose_covariance=COVARIANCE, seed=seed, threads=threads
            )
            T = view.candidates[0].T_world_camera
            if k == 1:
                second = max(after_two(scene, name, seed, c.T_world_camera, threads) for c in view.candidates)
        look(maps[1], scene, T, rngs[1])
        own.append(best(maps[1], seed, threads))
    return fixed, own, second


def after_two(scene: list[mg.LinkShape], name: str, seed: int, T: np.ndarray, threads: int) -> float:
    """Probability of the best grasp after the first view and one from T."""
    sdf, rng = new_map(threads), np.random.default_rng([seed, list(PARTS).index(name)])
    look(sdf, scene, fixed_view(7 * seed), rng)
    look(sdf, scene, T, rng)
    return best(sdf, seed, threads)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3])
    parser.add_argument("--chosen", type=int, default=5)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--write", action="store_true", help="into benchmarks/README.md")
    arguments = parser.parse_args()
    fixed, chosen, second = [], [], []
    for name in PARTS:
        for seed in arguments.seeds:
            own = measure(name, seed, arguments.chosen, arguments.threads)
            fixed.append(own[0])
            chosen.append(own[1])
            second.append(own[2])
            texts = [" ".join(f"{p:.2f}" for p in row) for row in own[:2]]
            print(f"{name}, seed {seed}: fixed {texts[0]} | chosen {texts[1]} | best second {own[2]:.2f}", flush=True)
    a, b = np.array(fixed), np.array(chosen)
    rows = []
    for n in range(1, arguments.chosen + 1):
        apart = b[:, n - 1] - a[:, 2 * n - 1]
        margin = 1.96 * apart.std(ddof=1) / np.sqrt(len(apart))
        means = [a[:, n - 1].mean(), a[:, 2 * n - 1].mean(), b[:, n - 1].mean()]
        afterwards = f"{np.mean(second):.2f}" if n == 2 else ""
        rows.append([f"{n}", *(f"{m:.2f}" for m in means), f"{apart.mean():+.2f} +- {margin:.2f}", afterwards])
    head = ["frames n", "fixed, n", "fixed, 2 n", "chosen, n", f"chosen n less fixed 2 n (95 %, {len(fixed)} runs)"]
    show("next view", markdown([*head, "best pose of those compared"], rows), arguments.write)


if __name__ == "__main__":
    main()
