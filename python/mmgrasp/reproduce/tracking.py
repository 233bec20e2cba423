"""P1 figure 4.9: how well the base stays on a planned way, open loop and with the PID controller of (4.12) to (4.15)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np

from .. import _core
from .drawing import figure
from .entry import Context, Entry, Result
from .setup import robot_setup

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LENGTH, DETOUR, SECONDS = 10.0, 1.2, 20.13  # P1 4.2: from x = 0 to x = 10 m past an object at y = -2 m, in 20.13 s
PERIOD = 0.02
ACCELERATION = 0.5  # [m/s^2]


class Disturbance(TypedDict):
    """Keywords of track_base."""

    slip_left: float
    slip_right: float
    travel_noise: float
    position_noise: float
    heading_noise: float


DISTURBANCE: Disturbance = {
    "slip_left": 0.03,
    "slip_right": 0.01,
    "travel_noise": 0.01,
    "position_noise": 0.005,
    "heading_noise": 0.005,
}
VARIANTS: dict[str, dict[str, Any]] = {
    "open loop (a)": {"feedback": False},
    "PID, Kp 2.0 Ki 0.1 Kd 0.3 (b)": {},
    "the same without feed-forward, as (4.14) is printed": {"feed_forward": False},
}


def base_plan() -> _core.JointTrajectory:
    """A way from (0, 0) to (10, 0) that swings out to the side of the object, at rest at both ends."""
    x = np.linspace(0.0, LENGTH, 4001)
    y = -DETOUR / 2 * (1 - np.cos(2 * np.pi * x / LENGTH))
    slope = -DETOUR * np.pi / LENGTH * np.sin(2 * np.pi * x / LENGTH)
    along = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    times = np.arange(0.0, SECONDS, PERIOD)
    end, length = times[-1], along[-1]
    speed = ACCELERATION / 2 * (end - np.sqrt(end**2 - 4 * length / ACCELERATION))  # the trapezoid that takes this long
    near = np.minimum(np.minimum(times, end - times), speed / ACCELERATION)
    way = np.where(times < end / 2, 0.0, length) + np.where(times < end / 2, 1, -1) * (
        ACCELERATION * near**2 / 2 + speed * (np.minimum(times, end - times) - near)
    )
    rows = [np.interp(way, along, line) for line in (x, y, np.arctan(slope))]
    return _core.JointTrajectory(["x", "y", "theta"], times, np.stack(rows, axis=1))


def drive(variant: str, seed: int) -> dict[str, Any]:
    """One run with its errors, and where the base went (every fifth sample)."""
    run = _core.track_base(robot_setup(0.0).robot, base_plan(), seed=seed, **DISTURBANCE, **VARIANTS[variant])
    errors = run.position_errors
    third = len(errors) // 3
    return {
        "mean": run.mean_error,
        "largest": run.max_error,
        "final": run.final_error,
        "thirds": [float(errors[i * third : (i + 1) * third].mean()) for i in range(3)],
        "way": [[round(float(v), 4) for v in pose[:2]] for pose in run.actual[::5]],
        "planned": [[round(float(v), 4) for v in pose[:2]] for pose in run.desired[::5]],
    }


def run(context: Context) -> Result:
    seeds = [context.seed + i for i in range(5 if context.quick else 80)]
    items = [{"variant": v, "seed": s} for v in VARIANTS for s in seeds]
    found = context.sweep(drive, items, "p1-figure-4.9")
    by_variant = {v: found[i * len(seeds) : (i + 1) * len(seeds)] for i, v in enumerate(VARIANTS)}
    result = Result(
        setup={
            "way": f"{LENGTH:g} m in {SECONDS} s, swinging {DETOUR} m to the side",
            "runs": len(seeds),
            "offset point [m]": 0.2,
            "period [s]": PERIOD,
            **DISTURBANCE,
        }
    )
    for variant, runs in by_variant.items():
        values = result.row({"control": variant})
        for column, key in (("mean error [m]", "mean"), ("largest error [m]", "largest"), ("final error [m]", "final")):
            sample = np.array([r[key] for r in runs])
            values[column] = (None, float(sample.mean()))
            values[f"{column}, 95 %"] = (None, float(1.96 * sample.std(ddof=1) / np.sqrt(len(sample))))
    opened, closed, printed = by_variant.values()
    result.trend(
        "open loop the deviation accumulates: it grows from third to third of the way",
        all(r["thirds"][0] < r["thirds"][1] < r["thirds"][2] for r in opened),
    )
    result.trend(
        "the controller greatly reduces the error: in every run the mean is less than a fifth of open loop's",
        all(5 * c["mean"] < o["mean"] for o, c in zip(opened, closed, strict=True)),
    )
    result.trend(
        "feed-forward takes the lag away: the printed law trails by about v / Kp",
        all(c["mean"] < p["mean"] for c, p in zip(closed, printed, strict=True)),
    )
    result.notes.append(
        "The paper prints curves without numbers, and neither its disturbances nor the offset: slip and noise here are assumptions, the "
        "same for all three rows. Base only; in physics see figure 4.10."
    )
    result.drawing = {"planned": opened[0]["planned"], "ways": {v: runs[0]["way"] for v, runs in by_variant.items()}}
    return result


def draw(result: dict[str, Any]) -> Figure:
    """The planned way and one run of each kind, from above."""
    fig, axes = figure(9.0, 3.4, columns=2)
    planned = np.array(result["drawing"]["planned"])
    for axis, (variant, way), letter in zip(axes, result["drawing"]["ways"].items(), "ab", strict=False):
        driven = np.array(way)
        axis.plot(planned[:, 0], planned[:, 1], "--", color="#8a8f98", label="planned")
        axis.plot(driven[:, 0], driven[:, 1], color="#1f6fb4", label="driven")
        axis.set(xlabel="x [m]", ylabel="y [m]", title=f"({letter}) {variant.split(' (')[0]}")
        axis.legend(frameon=False)
    return fig


ENTRIES = [Entry("p1-figure-4.9", "The base on its planned way, open loop and tracked", run, draw)]
