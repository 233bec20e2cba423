"""What `mmgrasp pipe` writes beside pictures and report: result.json, CSV tables and the joint trajectory, all on one clock."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .. import _core
from .._core import Grasp, ObjectPathResult, PipeProvenance
from .._files import write_file
from .planning import PipePlan

PIPE_FILES = (
    *("result.json", "report.html", "files.json", "sag.csv", "grasps.csv", "pipe_path.csv"),
    *("trajectory.csv", "joint_trajectory.json", "sag.png", "trade_off.png", "deformed.png", "motion.png"),
)


def write_tables(plan: PipePlan, folder: Path) -> None:
    """Every file but pictures and report."""
    write_file(folder / "result.json", json.dumps(result_to_dict(plan), indent=1, allow_nan=False) + "\n")
    write_file(folder / "grasps.csv", _grasps(plan))
    if plan.trajectory is None:
        return
    write_file(folder / "sag.csv", _sags(plan))
    write_file(folder / "pipe_path.csv", _pipe_path(plan))
    write_file(folder / "trajectory.csv", plan.trajectory.to_csv())
    message = json.dumps(plan.trajectory.to_joint_trajectory(), indent=1, allow_nan=False)
    write_file(folder / "joint_trajectory.json", message + "\n")


def grasp_to_dict(grasp: Grasp) -> dict[str, Any]:
    """P2's four variables."""
    place = grasp.provenance
    assert isinstance(place, PipeProvenance)
    return {"section": place.section, "length": place.length, "angle": place.angle, "flipped": place.flipped}


def result_to_dict(plan: PipePlan) -> dict[str, Any]:
    """The answer in plain values: SI units, radians."""
    optimum, problem = plan.optimum, plan.problem
    out: dict[str, Any] = {
        "format": "mmgrasp-pipe-result",
        "mmgrasp": _core.__version__,
        "problem": {"name": problem.name, "source": problem.source, "poses": len(problem.T_world_pipe)},
        "outcome": plan.outcome.name,
        "proof": plan.proof,
        "evaluations": optimum.evaluations,
        "feasible": len(optimum.feasible),
        "lower_bound": optimum.lower_bound if np.isfinite(optimum.lower_bound) else None,
        "gap": plan.gap,
        "preferences": {
            "source": problem.preferences.source,
            "consistency_ratio": problem.preferences.consistency_ratio,
            **problem.preferences.options,
        },
        "limits": {"sag": problem.limits.sag or None, "stress": problem.limits.stress or None},
        "obstruction": plan.obstruction,
        "unreachable": list(optimum.unreachable),
        "colliding": list(optimum.colliding),
        "overloaded": list(optimum.overloaded),
        "jumping_after": list(optimum.jumping_after),
        "colliding_after": list(optimum.colliding_after),
        "compared": [
            grasp_to_dict(grasp) | _costs(found) for grasp, found in zip(problem.compare, plan.compared, strict=True)
        ],
    }
    if plan.grasp is None or plan.path is None or plan.trajectory is None:
        return out
    return out | {
        "grasp": grasp_to_dict(plan.grasp) | {"T_object_hand": plan.grasp.T_object_hand.tolist()},
        **_costs(plan.path),
        "duration": plan.trajectory.duration,
        "path_error": {"position": plan.path_error[0], "rotation": plan.path_error[1]},
        "largest_sag": max(row.sag for row in plan.sags),
        "largest_stress": max((row.stress for row in plan.sags if row.stress is not None), default=None),
    }


def _costs(found: ObjectPathResult) -> dict[str, Any]:
    if found.path is None:
        return {
            "outcome": found.outcome.name,
            "violations": list(found.violations),
            "overloaded": list(found.overloaded),
            "gaps": list(found.gaps),
        }
    return {
        "outcome": found.outcome.name,
        "cost": found.cost,
        "joint_motion": found.joint_motion,
        "deflection": found.deflection,
        "force_manipulability": found.force_manipulability,
    }


def _table(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows([f"{v:.9g}" if isinstance(v, float) else v for v in row] for row in rows)
    return text.getvalue()


def _sags(plan: PipePlan) -> str:
    head = ["pose", "time", "sag", "section", "distance", "stress", "stress_over_limit"]
    return _table(
        head,
        (
            [i, r.time, r.sag, r.section, r.distance, *("" if v is None else v for v in (r.stress, r.over_limit))]
            for i, r in enumerate(plan.sags)
        ),
    )


def _grasps(plan: PipePlan) -> str:
    head = ["section", "length", "angle", "flipped", "cost", "joint_motion", "deflection", "force_manipulability"]
    front = set(plan.optimum.front)
    rows = []
    for i, found in enumerate(plan.optimum.feasible):
        values = (found.grasp.cost, found.joint_motion, found.deflection, found.force_manipulability)
        place = list(grasp_to_dict(found.grasp).values())
        rows.append([*place[:3], int(place[3]), *values, int(i in front)])
    return _table([*head, "on_front"], rows)


def _pipe_path(plan: PipePlan) -> str:
    """Where the pipe is at every row of trajectory.csv."""
    assert plan.trajectory is not None and plan.grasp is not None
    T_hand_pipe = np.linalg.inv(plan.grasp.T_object_hand)
    rows = []
    for time, T in zip(plan.trajectory.times, plan.problem.arm.fk_batch(plan.trajectory.positions), strict=True):
        xyz, quat = _core.pose_to_xyz_quat(T @ T_hand_pipe)
        rows.append([float(time), *map(float, xyz), *map(float, quat)])
    return _table(["time", "x", "y", "z", "qx", "qy", "qz", "qw"], rows)
