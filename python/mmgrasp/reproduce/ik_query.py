"""P1 3.2.2 and figure 3.3: the configurations that the database holds for one pose."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from .._progress import Progress
from .drawing import figure
from .entry import Context, Entry, Result
from .setup import Row, database, robot_setup

if TYPE_CHECKING:
    from matplotlib.figure import Figure

POSE = (0.6, 0.0, 0.8, 0.0, 0.5, 0.5)  # x, y, z [m], roll, pitch, yaw [rad]
PAPER_POSES, PAPER_VOXELS, PAPER_FOUND = 92_000_000, 2_000_000, 151
CHAIN = ("shoulder_pan_link", "shoulder_lift_link", "upperarm_roll_link", "elbow_flex_link", "forearm_roll_link")
WRIST = ("wrist_flex_link", "wrist_roll_link", "gripper_link", "gripper_tcp")
TORSO = 0.0  # the pose lies 0.8 m above the floor, in front of a shoulder that stands low [m]
KEPT = 100_000  # in a voxel: as in the paper all
SAME = 0.1  # configurations nearer than this in every joint are one [rad]


def measure(samples: int, seed: int, cells: dict[str, float]) -> dict[str, Any]:
    """What the voxel of the pose holds, and what of it becomes an exact solution."""
    reach = _database(samples, seed, None, cells)
    arm = robot_setup(TORSO).arm
    T = _core.pose(list(POSE[:3]), rpy=list(POSE[3:]))
    found = reach.query(T)
    exact: list[np.ndarray] = []
    for q in found:
        solved = arm.ik(T, seed=q, restarts=0, time_limit=10.0)
        if solved.outcome == _core.Outcome.solved:
            exact.append(solved.q)
    errors = [_error(arm.fk(q), T) for q in found]
    lines = []
    for q in _spread(exact, 12):
        poses = arm.link_poses(q)
        lines.append([[round(float(v), 4) for v in poses[name][:3, 3]] for name in (*CHAIN, *WRIST)])
    return {
        "poses": len(reach),
        "voxels": reach.cell_count,
        "found": len(found),
        "exact": len(exact),
        "different": len(_spread(exact, len(exact))),
        "position error": float(np.mean([e[0] for e in errors])) if errors else None,
        "rotation error": float(np.mean([e[1] for e in errors])) if errors else None,
        "arms": lines,
    }


def _database(samples: int, seed: int, progress: Progress, cells: dict[str, float]) -> _core.ReachDatabase:
    return database(Row(torso=TORSO), samples, seed=seed, progress=progress, max_per_cell=KEPT, **cells)


def _error(a: np.ndarray, b: np.ndarray) -> tuple[float, float]:
    cosine = (np.trace(a[:3, :3].T @ b[:3, :3]) - 1) / 2
    return float(np.linalg.norm(a[:3, 3] - b[:3, 3])), float(np.arccos(np.clip(cosine, -1, 1)))


def _spread(configurations: list[np.ndarray], count: int) -> list[np.ndarray]:
    """The first one, then always the one farthest from those taken, while it is a different one."""
    taken: list[np.ndarray] = []
    left = list(configurations)
    while left and len(taken) < count:
        distance = [min((np.abs(q - t).max() for t in taken), default=np.inf) for q in left]
        best = int(np.argmax(distance))
        if distance[best] <= SAME:
            break
        taken.append(left.pop(best))
    return taken


def run(context: Context) -> Result:
    amounts = [200_000, 500_000] if context.quick else [2_000_000, 8_000_000]
    # The paper prints no voxel's size, only their number. A small database fills larger ones.
    cells = (
        {"position_cell": 0.2, "rotation_cell": 0.9} if context.quick else {"position_cell": 0.1, "rotation_cell": 0.55}
    )
    for samples in amounts:
        _database(samples, 1, context.progress, cells)
    found = context.sweep(measure, [{"samples": n, "seed": 1, "cells": cells} for n in amounts], "p1-figure-3.3")
    result = Result(
        setup={
            "robot": "fetchlike, seven-joint arm",
            "pose [m, rad]": POSE,
            "torso lift [m]": TORSO,
            "cells [m, rad]": list(cells.values()),
        }
    )
    for samples, ours in zip(amounts, found, strict=True):
        mean = ours["poses"] / ours["voxels"]
        values = result.row({"configurations drawn": samples})
        values["poses in the database"] = (PAPER_POSES, ours["poses"])
        values["voxels"] = (PAPER_VOXELS, ours["voxels"])
        values["poses in the voxel"] = (PAPER_FOUND, ours["found"])
        values["mean of a voxel"] = (PAPER_POSES / PAPER_VOXELS, mean)
        values["voxel against the mean"] = (PAPER_FOUND * PAPER_VOXELS / PAPER_POSES, ours["found"] / mean)
        values["refined to exact solutions"] = (None, ours["exact"])
        values["different solutions"] = (None, ours["different"])
        values["mean error before refining [m]"] = (None, ours["position error"])
        values["mean error before refining [rad]"] = (None, ours["rotation error"])
    result.trend("the pose's voxel is not empty", all(ours["found"] > 0 for ours in found))
    result.trend(
        "more samples give at least as many configurations and solutions",
        all(a["found"] <= b["found"] and a["different"] <= b["different"] for a, b in itertools.pairwise(found)),
    )
    result.notes.append(
        "The paper's voxels are smaller or its database denser, by as much as the mean of a voxel tells; the ratio to the mean compares. "
        "Every solution counted as exact is within the solver's tolerance of the pose."
    )
    result.drawing = {"arms": found[-1]["arms"], "target": POSE}
    return result


def draw(result: dict[str, Any]) -> Figure:
    fig, axes = figure(9.0, 4.0, columns=2)
    for axis, (a, b), names in zip(axes, ((0, 2), (0, 1)), (("x", "z"), ("x", "y")), strict=True):
        for line in result["drawing"]["arms"]:
            points = np.array(line)
            axis.plot(points[:, a], points[:, b], "-o", markersize=3, linewidth=1.2, alpha=0.75)
        target = result["drawing"]["target"]
        axis.plot(target[a], target[b], "*", color="#C1121F", markersize=13, zorder=5)
        axis.set(xlabel=f"{names[0]} [m]", ylabel=f"{names[1]} [m]", aspect="equal")
    axes[0].set_title("from the side")
    axes[1].set_title("from above")
    return fig


ENTRIES = [Entry("p1-figure-3.3", "Configurations found for one pose", run, draw)]
