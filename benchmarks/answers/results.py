"""The parts of results that several calls have in common."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np

from .lookup import Answer, get


def rejections(of: Any) -> list[int]:
    return [
        get(of, "grasp_filter"),
        get(of, "unreachable", "reach"),
        get(of, "limits"),
        get(of, "self_collision"),
        get(of, "scene"),
    ]


def timed(trajectory: Any) -> list[np.ndarray]:
    return [get(trajectory, name) for name in ("times", "positions", "velocities", "accelerations")]


def motion(found: Any) -> Answer:
    parts = {"outcome": found.outcome, "path": found.path, "cost": found.cost, "goal": found.goal_index}
    parts["rejections"] = rejections(found.rejections)
    shown = {
        "outcome": found.outcome.name,
        "cost": found.cost,
        "waypoints": 0 if found.path is None else len(found.path),
    }
    return parts, shown | {"queries": get(found.stats, "collision_queries")}


def line(found: Any) -> Answer:
    parts = {"outcome": found.outcome, "path": found.path, "fraction": found.fraction, "cause": found.cause}
    shown = {"outcome": found.outcome.name, "waypoints": 0 if found.path is None else len(found.path)}
    return parts, shown | {"fraction": found.fraction}


def manipulation(found: Any) -> Answer:
    ends = ("start_solutions", "goal_solutions", "searched")
    parts = {
        "outcome": found.outcome,
        "path": found.path,
        "cost": [found.cost, found.lower_bound],
        "grasp": found.grasp_index,
        "rejections": rejections(found.rejections),
        "grasps": [[get(g, end) for end in ends] + rejections(g.start) + rejections(g.goal) for g in found.grasps],
        "improvements": [[better.cost, better.grasp, better.path] for better in found.improvements],
    }
    shown = {"outcome": found.outcome.name, "cost": found.cost, "grasp": found.grasp_index}
    return parts, shown | {"waypoints": 0 if found.path is None else len(found.path), "of grasps": len(found.grasps)}


def stop(of: Any) -> list[Any]:
    return [of.pose, of.radius, list(of.trays)]


def stops(found: Any) -> Answer:
    parts = {"outcome": found.outcome, "stops": [stop(s) for s in found.stops], "bound": found.lower_bound}
    return parts, {"outcome": found.outcome.name, "stops": len(found.stops), "bound": found.lower_bound}


def shared_cells(found: Any) -> list[Any]:
    return [
        [s.trays, s.heading, s.centre, s.radius, s.cells]
        for s in itertools.chain(get(found, "robust"), get(found, "too_small", "lost"))
    ]
