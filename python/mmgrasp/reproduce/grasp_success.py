"""P3 figure 4.6, the worked example of success under an uncertain place, and figures 4.20 and 4.21: samples of the synthesis."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from .drawing import PAPER_STYLE, figure
from .entry import Context, Entry, Result

if TYPE_CHECKING:
    from matplotlib.figure import Figure

WIDTH, MAX_OPENING = 0.2, 0.4
PAPER = {0.3: 0.13, 0.03: 0.76}
PROBABILITY = "P(S) at the optimum"


# --- figure 4.6 -------------------------------------------------------------------------------------------------------
def probability(opening: float, position: float, sigma: float) -> float:
    return _core.LineGrasp(WIDTH, MAX_OPENING).probability(opening, position, 0.0, sigma)


def by_quadrature(opening: float, position: float, sigma: float) -> float:
    """(4.1) with (4.3) and (4.4), summed over the object's place."""
    x = np.linspace(-8 * sigma, 8 * sigma, 400_001)
    off = np.abs(position - x)
    success = np.where(off < (opening - WIDTH) / 2, 1 - off / ((MAX_OPENING - WIDTH) / 2), 0.0)
    density = np.exp(-0.5 * (x / sigma) ** 2) / (sigma * np.sqrt(2 * np.pi))
    return float(np.sum(success * density) * (x[1] - x[0]))


def run_line(context: Context) -> Result:
    openings = np.linspace(0.2, MAX_OPENING, 21 if context.quick else 81)
    positions = np.linspace(-0.2, 0.2, 21 if context.quick else 81)
    result = Result(
        setup={"object's width [m]": WIDTH, "gripper opens [m]": MAX_OPENING, "grid": [len(openings), len(positions)]}
    )
    contours = {}
    for sigma, paper in PAPER.items():
        values = np.array([[probability(u, p, sigma) for u in openings] for p in positions])
        row, column = np.unravel_index(np.argmax(values), values.shape)
        best = {
            "opening": float(openings[column]),
            "position": float(positions[row]),
            "value": float(values[row, column]),
        }
        out = result.row({"sigma [m]": sigma})
        out[PROBABILITY] = (paper, best["value"])
        out["by quadrature"] = (None, by_quadrature(best["opening"], best["position"], sigma))
        out["opening there [m]"] = (None, best["opening"])
        out["position there [m]"] = (None, best["position"])
        contours[str(sigma)] = {"values": np.round(values, 4).tolist(), **best}
        result.exact(f"sigma {sigma} m: P(S) = {paper} to the digits printed", round(best["value"], 2) == paper)
        result.exact(
            f"sigma {sigma} m: the optimum is wide open in the middle",
            abs(best["opening"] - MAX_OPENING) < 1e-9 and abs(best["position"]) < 1e-9,
        )
    result.notes.append(
        "The figure refers to 'Equ. 5.15'; the integral is (4.1). N(0, 0.3) and N(0, 0.03) are read as standard deviations: as "
        "variances the probabilities would be 0.07 and 0.22."
    )
    result.drawing = {"openings": openings.tolist(), "positions": positions.tolist(), "contours": contours}
    return result


def draw_line(result: dict[str, Any]) -> Figure:
    drawing = result["drawing"]
    fig, axes = figure(9.0, 3.6, columns=2)
    for axis, (sigma, found) in zip(axes, drawing["contours"].items(), strict=True):
        filled = axis.contourf(drawing["openings"], drawing["positions"], found["values"], levels=12, cmap="viridis")
        axis.plot(found["opening"], found["position"], "o", color="#b8405e", clip_on=False)
        axis.set(
            xlabel="opening u1 [m]",
            ylabel="position u2 [m]",
            title=f"sigma {sigma} m: P(S) = {found['value']:.3f} at the optimum",
        )
        fig.colorbar(filled, ax=axis)
    return fig


# --- figures 4.20 and 4.21 --------------------------------------------------------------------------------------------
OBJECTS: dict[str, list[tuple[Any, list[float]]]] = {
    "box": [(_core.Box([0.04, 0.07, 0.06]), [0.0, 0.0, 0.03])],
    "cylinder": [(_core.Cylinder(0.03, 0.09), [0.0, 0.0, 0.045])],
    "mallet": [
        (_core.Box([0.14, 0.025, 0.025]), [0.0, 0.0, 0.0125]),
        (_core.Box([0.03, 0.06, 0.05]), [0.06, 0.0, 0.025]),
    ],
}


def scan(name: str) -> _core.ProbabilisticSdf:
    """Ten frames from around, each pixel with noise of 1 mm."""
    intrinsics = _core.PinholeCamera(width=160, height=120, fx=200.0, fy=200.0, cx=79.5, cy=59.5)
    camera = _core.DepthCamera(intrinsics, _core.DepthNoise(constant=0.001))
    scene = [_core.LinkShape(_core.Plane([0, 0, 1], 0.0))]
    scene += [_core.LinkShape(shape, _core.pose(place)) for shape, place in OBJECTS[name]]
    rng = np.random.default_rng(1)
    sdf = _core.ProbabilisticSdf(threads=1)
    for k in range(10):
        angle, up = 2.4 * k, np.radians(25 + 20 * (k % 3))
        eye = 0.35 * np.array([np.cos(up) * np.cos(angle), np.cos(up) * np.sin(angle), np.sin(up)])
        image = _core.render_depth(scene, intrinsics, looking_at(eye, np.array([0, 0, 0.03])))
        depth = np.array(image.depth)
        depth[depth > 0] += 0.001 * rng.standard_normal(int((depth > 0).sum()))
        sdf.integrate(_core.DepthImage(depth, intrinsics, image.T_world_camera), camera)
    return sdf


def looking_at(eye: np.ndarray, target: np.ndarray) -> np.ndarray:
    z = (target - eye) / np.linalg.norm(target - eye)
    x = np.cross(z, [0, 0, 1]) / np.linalg.norm(np.cross(z, [0, 0, 1]))
    T = np.eye(4)
    T[:3, :3] = np.column_stack([x, np.cross(z, x), z])
    T[:3, 3] = eye
    return T


def gripper() -> _core.Hand:
    return _core.Hand(
        "tool", approach=[0, 0, 1], closing=[0, 1, 0], max_opening=0.09, finger_depth=0.02, finger_width=0.018,
        clearance=0.008, body=_core.HandBody(finger_thickness=0.01, finger_length=0.07, palm_length=0.12, palm_width=0.06),
    )  # fmt: skip


def measure(name: str, samples: int, runs: int) -> dict[str, Any]:
    sdf, hand = scan(name), gripper()
    best, seconds = [], []
    for seed in range(1, runs + 1):
        begin = time.process_time()
        found = _core.synthesize_grasps(sdf, hand, table=0.0, samples=samples, seed=seed, threads=1)
        seconds.append(time.process_time() - begin)
        best.append(found.grasps[0].quality if found.grasps else 0.0)
    return {"best": float(np.mean(best)), "spread": float(np.std(best)), "seconds": float(np.mean(seconds))}


def run_samples(context: Context) -> Result:
    counts = [50, 200] if context.quick else [25, 50, 100, 200, 400, 800]
    names, runs = (["box"], 3) if context.quick else (list(OBJECTS), 10)
    items = [{"name": name, "samples": n, "runs": runs} for name in names for n in counts]
    found = context.sweep(measure, items, "p3-figure-4.21")
    result = Result(
        setup={
            "objects": names,
            "runs": runs,
            "frames": 10,
            "noise [m]": 0.001,
            "voxel [m]": 0.002,
            "gripper opens [m]": 0.09,
        }
    )
    for item, ours in zip(items, found, strict=True):
        row = result.row({"object": item["name"], "samples": item["samples"]})
        row["maximum success probability"] = (None, ours["best"])
        row["standard deviation over the runs"] = (None, ours["spread"])
        row["processor time [s]"] = (None, ours["seconds"])
    for name in names:
        of = {i["samples"]: o for i, o in zip(items, found, strict=True) if i["name"] == name}
        result.trend(
            f"{name}: 200 samples reach 95 % of what {counts[-1]} reach",
            of[200]["best"] >= 0.95 * of[counts[-1]]["best"],
        )
        per_sample = (of[counts[-1]]["seconds"] - of[counts[0]]["seconds"]) / (counts[-1] - counts[0])
        line = of[counts[0]]["seconds"] + per_sample * (200 - counts[0])
        result.trend(
            f"{name}: the time at 200 samples is within 40 % of the line through the ends",
            abs(of[200]["seconds"] - line) <= 0.4 * line,
            clock=True,
        )
        result.trend(f"{name}: 200 samples in a tenth of the paper's 2 s", of[200]["seconds"] <= 0.2, clock=True)
    result.notes.append(
        "P3 prints curves, no numbers: about 2 s and a plateau at about 200 samples. Processor time of one thread, the "
        "extraction of the map's surface included."
    )
    return result


def draw_samples(result: dict[str, Any]) -> Figure:
    fig, axes = figure(9.0, 3.6, columns=2)
    for axis, column in zip(axes, ("processor time [s]", "maximum success probability"), strict=True):
        for name in result["setup"]["objects"]:
            rows = [row for row in result["rows"] if row["key"]["object"] == name]
            axis.plot(
                [row["key"]["samples"] for row in rows],
                [row["values"][column]["ours"] for row in rows],
                marker="o",
                label=name,
            )
        axis.set(xlabel="samples", ylabel=column, ylim=(0, None))
        axis.legend(frameon=False)
    axes[1].axvline(200, color=PAPER_STYLE["color"], linestyle="--", linewidth=1)
    return fig


ENTRIES = [
    Entry("p3-figure-4.6", "Success of a grasp under an uncertain place, the worked example", run_line, draw_line),
    Entry("p3-figure-4.21", "Grasp synthesis: success and time over the number of samples", run_samples, draw_samples),
]
