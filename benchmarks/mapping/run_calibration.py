"""Promised against found error of the probabilistic map: scanned objects with known truth, two sensors of different noise.

    python benchmarks/mapping/run_calibration.py [--objects YcbMustardBottle ...] [--frames 1 2 5 20 50] [--picture FILE.png]

Two depth cameras (1 mm, and a stereo pair of 2 mm at 0.32 m) take turns around an object of the shared data, with exact
poses and with poses off by 1 mm and 3 mrad along and about each axis. The map is asked at points of the true surface, where
its distance should be zero: how many lie within 1.96 of its standard deviations (95 % if these are right), and how large the
error is where it promises so much.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from statistics import NormalDist
from typing import NamedTuple

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE.parents[1] / "tests/python")]
from tables import ROOT

import mmgrasp as mg
from camera_poses import look_at

DATA = ROOT.parent / "shared/data/meshes/ycb"
TRANSLATION, ROTATION = 0.001, 0.003  # standard deviation of a pose's error along and about each axis [m, rad]
VIEWS, POINTS = 50, 3000
PINHOLE = mg.mapping.PinholeCamera(width=160, height=120, fx=200.0, fy=200.0, cx=79.5, cy=59.5)


class Errors(NamedTuple):
    """The map's errors, and what it promises, at the points of the true surface that it knows, over all trials [m]."""

    error: np.ndarray
    sigma: np.ndarray

    def within(self, sigmas: float) -> float:
        return float(np.mean(np.abs(self.error) <= sigmas * self.sigma))

    def rms(self) -> float:
        return float(np.sqrt(np.mean(self.error**2)))


def cameras() -> list[mg.mapping.DepthCamera]:
    noise = mg.mapping.DepthNoise
    stereo = 0.002 / 0.32**2  # [1 / m]
    return [
        mg.mapping.DepthCamera(PINHOLE, noise(constant=0.001), name="fine"),
        mg.mapping.DepthCamera(PINHOLE, noise(constant=0.0, quadratic=stereo), name="coarse"),
    ]


def spiral(k: int, count: int) -> np.ndarray:
    """Directions spread evenly over the sphere."""
    z, angle = 1 - (2 * k + 1) / count, 2.399963229728653 * k
    return np.array([np.sqrt(1 - z * z) * np.cos(angle), np.sqrt(1 - z * z) * np.sin(angle), z])


def centred(path: Path) -> mg.Mesh:
    mesh = mg.Mesh.load(path)
    vertices = np.asarray(mesh.vertices)
    return mg.Mesh.from_arrays(vertices - (vertices.min(axis=0) + vertices.max(axis=0)) / 2, mesh.triangles)


def surface_points(mesh: mg.Mesh, rng: np.random.Generator) -> np.ndarray:
    """Spread evenly over the surface."""
    corners = np.asarray(mesh.vertices)[np.asarray(mesh.triangles)]
    a, b, c = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = np.linalg.norm(np.cross(b, c), axis=1)
    which = rng.choice(len(corners), size=POINTS, p=area / area.sum())
    u, v = rng.uniform(size=(2, POINTS, 1))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    return np.asarray(a[which] + u * b[which] + v * c[which])


def turned(vector: np.ndarray) -> np.ndarray:
    """The rotation matrix of a small rotation vector."""
    angle = np.linalg.norm(vector)
    if angle == 0:
        return np.eye(3)
    x, y, z = vector / angle
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.asarray(np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K)


class Bench:
    """Exact images of one object from all views, which every trial disturbs anew."""

    def __init__(self, name: str, mesh: mg.Mesh) -> None:
        self.seed = list(name.encode())  # other errors for every object
        self.points = surface_points(mesh, np.random.default_rng(11))
        self.cameras = cameras()
        self.images = []
        shape = [mg.LinkShape(mesh)]
        for k in range(VIEWS):
            T = look_at((0.30 + 0.05 * (k % 3)) * spiral(k, VIEWS), np.zeros(3))
            self.images.append(mg.mapping.render_depth(shape, PINHOLE, T))

    def measure(self, frames: int, trials: int, translation: float, rotation: float) -> Errors:
        errors, sigmas = [], []
        covariance = np.diag([translation**2] * 3 + [rotation**2] * 3)
        for trial in range(trials):
            rng = np.random.default_rng([*self.seed, frames, trial])
            sdf = mg.ProbabilisticSdf(threads=1)
            for k in range(frames):
                view = (trial + k * VIEWS // frames) % VIEWS  # spread over all, others in every trial
                camera, exact = self.cameras[view % 2], self.images[view]
                depth = np.asarray(exact.depth, dtype=float)
                sigma = camera.noise.constant + camera.noise.quadratic * depth**2
                noisy = np.where(depth > 0, depth + sigma * rng.normal(size=depth.shape), 0)
                T = np.array(exact.T_world_camera)
                T[:3, :3] = turned(rotation * rng.normal(size=3)) @ T[:3, :3]
                T[:3, 3] += translation * rng.normal(size=3)
                sdf.integrate(mg.mapping.DepthImage(noisy, PINHOLE, T), camera, pose_covariance=covariance)
            mean, sigma, known = sdf.query(self.points)
            errors.append(mean[known])
            sigmas.append(sigma[known])
        return Errors(np.concatenate(errors), np.concatenate(sigmas))


def draw(found: dict[tuple[str, int], Errors], path: Path) -> None:
    import matplotlib

    matplotlib.use("agg")
    from matplotlib import pyplot
    from matplotlib.ticker import FixedLocator, NullLocator, ScalarFormatter

    figure, axes = pyplot.subplots(2, 2, figsize=(9, 8), layout="constrained")
    shares = np.linspace(0.02, 0.995, 60)
    sigmas = [NormalDist().inv_cdf(0.5 + share / 2) for share in shares]
    colours = pyplot.get_cmap("viridis")(np.linspace(0, 0.9, len({frames for _, frames in found})))
    for row, poses in zip(axes, ("exact poses", "pose errors"), strict=True):
        of_poses = [(frames, errors) for (which, frames), errors in found.items() if which == poses]
        for colour, (frames, errors) in zip(colours, of_poses, strict=True):
            label = f"{frames} frame" + "s" * (frames > 1)
            edges = np.quantile(errors.sigma, np.linspace(0, 1, 13))
            bins = np.clip(np.searchsorted(edges, errors.sigma) - 1, 0, 11)
            promised = [1e3 * np.sqrt(np.mean(errors.sigma[bins == k] ** 2)) for k in range(12)]
            rms = [1e3 * np.sqrt(np.mean(errors.error[bins == k] ** 2)) for k in range(12)]
            row[0].plot(promised, rms, "o-", ms=3, color=colour, label=label)
            row[1].plot(
                shares, [errors.within(s) - share for s, share in zip(sigmas, shares, strict=True)], color=colour
            )
        row[0].axline((0, 0), slope=1, color="#888888", lw=1, ls="--")
        row[0].set(
            xscale="log", yscale="log", xlabel="promised sigma [mm]", ylabel="found error, rms [mm]", title=poses
        )
        for axis in (row[0].xaxis, row[0].yaxis):
            axis.set_major_locator(FixedLocator([0.1, 0.2, 0.5, 1, 2, 5]))
            axis.set_minor_locator(NullLocator())
            axis.set_major_formatter(ScalarFormatter())
        row[0].legend(fontsize=8)
        row[1].axhspan(-0.02, 0.02, color="#DDDDDD")
        row[1].axvline(0.95, color="#888888", lw=1, ls="--")
        row[1].set(
            xlabel="promised share of the surface", ylabel="found share - promised", ylim=(-0.12, 0.12), title=poses
        )
    figure.savefig(path, dpi=110)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--objects", nargs="+", default=sorted(path.name for path in DATA.glob("Ycb*")))
    parser.add_argument("--frames", type=int, nargs="+", default=[1, 2, 5, 20, 50])
    parser.add_argument("--integrations", type=int, default=300, help="frames in all trials of one row together")
    parser.add_argument("--picture", type=Path)
    arguments = parser.parse_args()
    found: dict[tuple[str, int], list[Errors]] = {}
    print(
        "| object | poses | " + " | ".join(f"{frames} frames" for frames in arguments.frames) + " | rms at the last |"
    )
    print("| --- " * (len(arguments.frames) + 3) + "|")
    for name in arguments.objects:
        files = [DATA / name / f"{file}.obj" for file in ("textured_simple_reoriented", "collision_vhacd")]
        bench = Bench(name, centred(next(path for path in files if path.exists())))
        for poses, size in (("exact poses", 0.0), ("pose errors", 1.0)):
            cells, errors = [], None
            for frames in arguments.frames:
                trials = min(120, max(24, arguments.integrations // frames))
                errors = bench.measure(frames, trials, size * TRANSLATION, size * ROTATION)
                found.setdefault((poses, frames), []).append(errors)
                cells.append(f"{errors.within(1.96):.3f}")
            print(f"| {name} | {poses} | " + " | ".join(cells) + f" | {1e3 * errors.rms():.2f} mm |", flush=True)
    together = {key: Errors(*map(np.concatenate, zip(*parts, strict=True))) for key, parts in found.items()}
    for poses in ("exact poses", "pose errors"):
        cells = [f"{np.mean([part.within(1.96) for part in found[poses, frames]]):.3f}" for frames in arguments.frames]
        print(f"| **mean of the objects** | {poses} | " + " | ".join(cells) + " | |")
    if arguments.picture:
        draw(together, arguments.picture)


if __name__ == "__main__":
    main()
