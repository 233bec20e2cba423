"""Grasps, cameras, meshes."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from .lookup import Answer, ask, call, find, get
from .setups import asset, body, hand, shape


@call
def grasps() -> Answer:
    mesh = find("Mesh").load(asset("objects/angle.stl"))
    parts = {}
    for name, part in (
        ("box", body(0.04, 0.06, 0.08)),
        ("cylinder", [shape("Cylinder", 0.02, 0.1)]),
        ("mesh", [find("LinkShape")(mesh)]),
    ):
        found = find("sample_grasps")(part, hand(), seed=1)
        parts[name] = [
            [
                get(g, "T_object_tcp", "T_object_tool", "T_object_hand"),
                get(g, "width", "opening"),
                get(g, "quality", "score"),
            ]
            for g in found
        ]
    return parts, {name: len(found) for name, found in parts.items()}


@call
def pipe_grasps() -> Answer:
    parts = {}
    for number, pipe in enumerate(find("pipe_structures")(), 1):
        found = ask(pipe.sample_grasps, 100, gripper=find("pipe_robot")("tm14like")[2], seed=1)
        parts[str(number)] = [[get(g, "T_object_tool", "T_object_tcp"), g.opening, g.cost] for g in found]
    return parts, {"grasps": sum(map(len, parts.values()))}


@cache
def scan() -> Any:
    return find("scan_random_tray")(body(0.07, 0.035, 0.03), [0.3, 0.4, 0.1], hand(), count=12, fill=0.5, seed=1)


@call
def random_placement() -> Answer:
    resting = find("resting_poses")(body(0.07, 0.035, 0.03))
    found = find("random_placement")(body(0.07, 0.035, 0.03), [0.3, 0.4, 0.1], count=20, seed=2)
    parts = {
        "placed": [[p.T_tray_part, p.on_floor, p.resting_pose] for p in found.parts],
        "resting": [[p.T_floor_part, p.probability] for p in resting],
    }
    return parts, {"placed": len(found.parts), "not placed": found.not_placed}


@call
def depth_and_height_map() -> Answer:
    parts = {"depth": scan().image.depth, "points": scan().image.points()}
    parts["height"] = [scan().height_map.height, get(scan().height_map, "upper")]
    return parts, {
        "measured": int(np.isfinite(scan().image.depth).sum()),
        "highest": float(np.nanmax(scan().height_map.height)),
    }


@call
def graspability() -> Answer:
    found = scan().found
    fields = [["T_world_tcp", "T_world_tool", "T_object_tool"], ["score"], ["opening"]]
    parts = {"grasps": [[get(g, *names) for names in fields] for g in found.grasps], "counts": found.counts}
    return parts, {"grasps": len(found.grasps)}


@call
def cuboids() -> Answer:
    eye = scan().image.T_world_camera[:3, 3]
    fit = find("fit_cuboids")(scan().image.points(), T_world_tray=np.eye(4), tray_size=[0.3, 0.4, 0.1], eye=eye)
    parts = {"cuboids": [[c.T_world_box, c.size, c.fill, c.points] for c in fit.cuboids], "labels": fit.labels}
    return parts, {"cuboids": len(fit.cuboids)}


@call
def simplified_mesh() -> Answer:
    mesh, answers = find("Mesh").load(asset("objects/angle.stl")), []
    for tolerance in (0.0, 0.005, 0.05):
        found = find("simplify_mesh")(mesh, tolerance)
        surface = found["shape"].surface()
        answers.append(
            [found["deviation"], found["triangles_saved"], found["shape"].pose, surface.vertices, surface.triangles]
        )
    return {"solids": answers}, {"triangles": [len(answer[-1]) for answer in answers]}


@call
def push_grasp() -> Answer:
    answers = [
        find("push_grasp")(tool_speed=v, object_width=0.05, opening=0.1, planned_depth=0.06, max_push=0.3)
        for v in (0.1, 0.3, 0.5)
    ]
    fields = ("closing_time", "earliest", "latest", "window", "feasible", "max_tool_speed")
    ends = [[[getattr(end, key) for key in ("start", "pushed", "holds")] for end in (a.plain, a.push)] for a in answers]
    parts = {"figures": [[get(a, key) for key in fields] for a in answers], "ends": ends}
    limit = find("push_speed_limit")(length=0.03, friction=0.3, restitution=0.4)
    return parts | {"speed limit": limit}, {"window": answers[-1].window, "speed limit": limit}
