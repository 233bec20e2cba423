"""The probabilistic map as an obstacle: nothing seen is called free, what the margin costs, how quick checks are.

    python benchmarks/mapping/run_obstacle.py [--count 100000] [--sigmas 2] [--voxel 0.004] [--frames 8] [--seeds 1 2 3]

A Panda stands before a table with scanned objects (YCB, of the shared data). Two depth cameras with noise of 1.5 mm and of a
stereo pair take turns. Random configurations are checked in four worlds: the true scene; the true surface at the pixels that
the map uses (free there at no angle above its `max_incidence`), as cells of half a millimetre; the map at some sigmas; the
map's surface points as a cloud with cells of the voxel's size.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]
from run import look_at
from tables import ROOT

import mmgrasp as mg

DATA = ROOT.parent / "shared/data"
TABLE_TOP = 0.2  # [m] above the robot's foot
OBJECTS = {
    "YcbMustardBottle": (0.50, 0.15),
    "YcbCrackerBox": (0.55, -0.20),
    "YcbTomatoSoupCan": (0.40, -0.05),
    "YcbBanana": (0.42, 0.30),
    "YcbChipsCan": (0.65, 0.05),
}


def panda() -> tuple[mg.Robot, mg.robot.JointGroup]:
    folder = DATA / "robots/panda_vamp/panda"
    robot = mg.Robot.load(folder / "panda.urdf", folder / "panda.srdf")
    return robot, robot.group(next(name for name in sorted(robot.groups) if "arm" in name))


def true_scene() -> list[mg.LinkShape]:
    """The table and the objects upon it."""
    shapes = [mg.LinkShape(mg.Box([0.7, 1.0, 0.04]), mg.pose([0.6, 0, TABLE_TOP - 0.02]))]
    for name, (x, y) in OBJECTS.items():
        files = [
            DATA / "meshes/ycb" / name / f"{file}.obj" for file in ("textured_simple_reoriented", "collision_vhacd")
        ]
        shape = mg.LinkShape.mesh(next(path for path in files if path.exists()))
        lowest = shape.bounds[0][2]
        shapes.append(mg.LinkShape(shape.shape, mg.pose([x, y, TABLE_TOP - lowest])))
    return shapes


def cameras() -> list[mg.mapping.DepthCamera]:
    pinhole = mg.mapping.PinholeCamera(width=320, height=240, fx=262.5, fy=262.5, cx=159.5, cy=119.5, farthest=3.0)
    noise = mg.mapping.DepthNoise
    return [
        mg.mapping.DepthCamera(pinhole, noise(constant=0.0015), "fixed noise"),
        mg.mapping.DepthCamera(pinhole, noise.stereo(focal=262.5, baseline=0.12, disparity_sigma=0.12), "stereo"),
    ]


def poses(count: int) -> list[np.ndarray]:
    """Eyes on a half circle around the table."""
    out = []
    for k in range(count):
        angle = np.pi * (k + 0.5) / count - np.pi / 2
        eye = np.array([0.55 + 0.75 * np.cos(angle), 0.75 * np.sin(angle), TABLE_TOP + 0.45 + 0.1 * (k % 3)])
        out.append(look_at(eye, np.array([0.52, 0.0, TABLE_TOP + 0.05])))
    return out


def seen_points(image: mg.mapping.DepthImage, most_slanted: float) -> np.ndarray:
    """The pixels' points where the surface is seen at a lesser incidence; the normal from the neighbours' points."""
    camera, T = image.camera, image.T_world_camera
    v, u = np.mgrid[0 : camera.height, 0 : camera.width]
    rays = np.stack([(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, np.ones_like(u, float)], axis=-1)
    points = rays * image.depth[..., None]
    normal = np.cross(points[1:-1, 2:] - points[1:-1, :-2], points[2:, 1:-1] - points[:-2, 1:-1])
    normal /= np.maximum(np.linalg.norm(normal, axis=-1, keepdims=True), 1e-12)
    ray = rays[1:-1, 1:-1] / np.linalg.norm(rays[1:-1, 1:-1], axis=-1, keepdims=True)
    used = (np.abs(np.sum(normal * ray, axis=-1)) > np.cos(most_slanted)) & (image.depth[1:-1, 1:-1] > 0)
    return np.asarray(points[1:-1, 1:-1][used] @ T[:3, :3].T + T[:3, 3])


def integrate(
    sdf: mg.ProbabilisticSdf, scene: list[mg.LinkShape], count: int, seed: int
) -> tuple[np.ndarray, list[mg.mapping.DepthImage]]:
    """Frames of both cameras from every pose; the true points that they saw, and the frames."""
    rng = np.random.default_rng(seed)
    seen, frames = [], []
    for camera in cameras():
        for T in poses(count):
            exact = mg.mapping.render_depth(scene, camera.intrinsics, T)
            seen.append(seen_points(exact, 1.0))
            sigma = camera.noise.constant + exact.depth**2 * camera.noise.quadratic
            noisy = np.where(exact.depth > 0, exact.depth + sigma * rng.standard_normal(exact.depth.shape), 0)
            frames.append(mg.mapping.DepthImage(noisy, camera.intrinsics, T))
            sdf.integrate(frames[-1], camera)
    return np.concatenate(seen), frames


def world_of(shapes: list[mg.LinkShape]) -> mg.World:
    world = mg.World()
    world.add("scene", shapes)
    return world


def microseconds(checker: mg.CollisionChecker, Q: np.ndarray) -> float:
    """Time of one check by one thread, the least of five rounds."""
    rounds = []
    for _ in range(5):
        begin = time.perf_counter()
        checker.are_free(Q, threads=1)
        rounds.append(time.perf_counter() - begin)
    return 1e6 * min(rounds) / len(Q)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=100_000)
    parser.add_argument("--sigmas", type=float, default=2.0)
    parser.add_argument("--voxel", type=float, default=0.004)
    parser.add_argument("--frames", type=int, default=8, help="of each camera")
    parser.add_argument("--seeds", type=int, nargs="+", default=[1])
    arguments = parser.parse_args()

    robot, arm = panda()
    scene = true_scene()
    rng = np.random.default_rng(7)
    Q = rng.uniform(arm.lower, arm.upper, (arguments.count, arm.size))
    Q = Q[mg.CollisionChecker(robot, mg.World(), group=arm).are_free(Q)]  # neither limits nor the arm itself
    free_truly = mg.CollisionChecker(robot, world_of(scene), group=arm).are_free(Q)
    print(f"{len(Q)} configurations free of the arm itself, {free_truly.mean():.1%} of them free in the true scene")
    for seed in arguments.seeds:
        sdf = mg.ProbabilisticSdf(voxel=arguments.voxel, truncation=5 * arguments.voxel)
        seen, frames = integrate(sdf, scene, arguments.frames, seed)
        world = mg.World()
        world.add_points("seen", seen, 0.0005)
        touches_seen = ~mg.CollisionChecker(robot, world, group=arm).are_free(Q)
        for sigmas in sorted({0.0, 1.0, arguments.sigmas, 3.0}):
            world = mg.World()
            begin = time.perf_counter()
            world.add_sdf("map", sdf, sigmas=sigmas)
            convert = time.perf_counter() - begin
            free = mg.CollisionChecker(robot, world, group=arm).are_free(Q)
            print(
                f"seed {seed}, {sigmas:g} sigma: {np.sum(free & touches_seen)} of {touches_seen.sum()} that touch what was seen "
                f"called free; {np.mean(~free[free_truly]):.2%} of the free ones lost ({convert:.2f} s to convert, "
                f"{sum(len(v.centres) for v in sdf.obstacle_cells(sigmas))} cells)"
            )
        if seed != arguments.seeds[0]:
            continue
        points = sdf.points()[0]
        cloud = mg.World()
        cloud.add_points("cloud", points, arguments.voxel)
        world = mg.World()
        world.add_sdf("map", sdf, sigmas=arguments.sigmas)
        octree = mg.mapping.OccupancyMap(resolution=2 * arguments.voxel)
        for k, image in enumerate(frames):
            octree.integrate(image, cameras()[k // arguments.frames])
        coarse = mg.World()
        coarse.add_occupancy("octree", octree)
        some = Q[:20_000]
        times = {}
        for name, each in {"cloud": cloud, "map": world, "octree": coarse}.items():
            begin = time.perf_counter()
            checker = mg.CollisionChecker(robot, each, group=arm)
            made = time.perf_counter() - begin
            times[name] = microseconds(checker, some)
            free = checker.are_free(Q)
            print(
                f"{name}: {times[name]:.2f} us a check, checker made in {made:.2f} s, {np.sum(free & touches_seen)} that touch "
                f"what was seen called free, {np.mean(~free[free_truly]):.2%} of the free ones lost"
            )
        print(f"map / cloud: {times['map'] / times['cloud']:.2f} times")


if __name__ == "__main__":
    main()
