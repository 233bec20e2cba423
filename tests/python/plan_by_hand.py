"""A small plan written by hand, as in plan.json: for tests of whatever reads plans."""

from __future__ import annotations

import copy
from typing import Any

URDF = """<robot name="post">
  <link name="base"><collision><origin xyz="0 0 0.15"/><geometry><cylinder radius="0.2" length="0.3"/></geometry></collision></link>
  <joint name="lift" type="prismatic"><parent link="base"/><child link="column"/><origin xyz="0 0 0.3"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="0.5" velocity="0.2" effort="10"/></joint>
  <link name="column"><collision><origin xyz="0 0 0.2"/><geometry><box size="0.1 0.1 0.4"/></geometry></collision></link>
  <joint name="turn" type="revolute"><parent link="column"/><child link="arm"/><origin xyz="0 0 0.4"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="1" effort="10"/></joint>
  <link name="arm"><collision><origin xyz="0.3 0 0"/><geometry><box size="0.6 0.06 0.06"/></geometry></collision></link>
  <joint name="tool" type="fixed"><parent link="arm"/><child link="tcp"/><origin xyz="0.7 0 0"/></joint>
  <link name="tcp"/>
</robot>"""

LEVEL = [0.0, 0.0, 0.0, 1.0]


def pose(x: float, y: float, z: float = 0.0) -> dict[str, list[float]]:
    """A level pose."""
    return {"xyz": [x, y, z], "quat_xyzw": list(LEVEL)}


def box(x: float, y: float, z: float) -> list[dict[str, Any]]:
    """One box as a body's shapes."""
    return [{"type": "box", "size": [x, y, z], "pose": pose(0, 0, 0)}]


def motion(kind: str, start: list[float], end: list[float], holding: bool, seconds: float) -> dict[str, Any]:
    """A straight motion from rest to rest with two samples."""
    zero = [0.0, 0.0]
    return {"kind": kind, "opening": 0.05, "attached": holding, "times": [0.0, seconds], "positions": [start, end],
            "velocities": [zero, zero], "accelerations": [zero, zero]}  # fmt: skip


def region(tray: str, iy: range, start: int, end: int) -> dict[str, Any]:
    """A rectangular region of layer 0 with one explanation."""
    causes = {"unreachable": 40, "limits": 3, "self_collision": 2, "scene": 15, "grasp_filter": 7}
    explanation = {
        "part": f"{tray}/brick_0",
        "grasps": 6,
        "base_poses_tried": 60,
        "base_poses_feasible": 24,
        "rejections": causes,
    }
    return {
        "tray": tray,
        "cells": {"0": [[y, start, end] for y in iy]},
        "explanations": [explanation],
    }


def plan_by_hand() -> dict[str, Any]:
    """Two trays served from one stop at (1, 1), one part each; the first in 2 m, heading along x."""
    grid = {"origin": [0.0, 0.0], "resolution": 0.1, "nx": 30, "ny": 30, "headings": [0.0]}
    grasp = {"pose": pose(0, 0, 0), "opening": 0.04, "quality": 1.0}
    parts = [
        {"name": f"{tray}/brick_0", "tray": tray, "target": True, "pose": pose(1.7, y, 0.9), "shapes": box(0.04, 0.04, 0.04), "grasps": [grasp]}
        for tray, y in (("A", 1.0), ("B & C", 1.4))
    ]  # fmt: skip
    home, high, low = [0.0, 0.0], [0.4, 0.5], [0.2, 0.5]
    motions = [motion("transit", home, high, False, 2.0), motion("approach", high, low, False, 1.0),
               motion("lift", low, high, True, 1.0), motion("transfer", high, [0.4, -1.0], True, 2.0),
               motion("retreat", [0.4, -1.0], home, False, 1.5)]  # fmt: skip
    picks = [
        {"stop": 0, "tray": p["tray"], "part": p["name"], "grasp": 0, "motions": copy.deepcopy(motions)} for p in parts
    ]
    return {
        "format": "mmgrasp-plan", "version": 4, "mmgrasp": "0.0.0", "outcome": "solved",
        "scenario": {
            "name": "by hand", "source": "scenario.yaml",
            "robot": {"urdf": URDF, "srdf": "", "base": "diff_drive", "base_limits": {}, "meshes": [], "links": [],
                      "urdfs": [{"urdf": URDF, "origin": "", "prefix": "", "parent_link": "", "pose": pose(0, 0, 0), "mesh_files": {}}]},
            "arm": {"joints": ["lift", "turn"], "tip_link": "tcp", "velocity_limits": [0.2, 1.0], "acceleration_limits": [1, 4]},
            "gripper": {"tool_link": "tcp", "approach": [1, 0, 0], "closing": [0, 1, 0], "max_opening": 0.1, "finger_depth": 0.03,
                        "finger_width": 0.02, "clearance": 0.005, "closing_speed": 0.1, "joints": [], "finger_links": []},
            "other_joints": {}, "home": home, "start": [0.3, 0.3, 0.0], "goal": [2.5, 0.3, 0.0],
            "positioning_uncertainty": 0.1,
            "place_region": {"pose": pose(0, 0, 0.3), "size": [0.2, 0.2], "drop_height": 0.03},
            "floor": 0.0,
            "obstacles": [{"name": "table", "pose": pose(1.7, 1.2, 0.4), "shapes": box(0.4, 1.0, 0.8)},
                          {"name": "tray A", "pose": pose(1.7, 1.0, 0.85), "shapes": box(0.3, 0.3, 0.1)}],
            "trays": [{"name": "A", "pose": pose(1.7, 1.0, 0.8), "size": [0.3, 0.3, 0.1], "headings": [0.0], "shares_headings": True},
                      {"name": "B & C", "pose": pose(1.7, 1.4, 0.8), "size": [0.3, 0.3, 0.1], "headings": [0.0], "shares_headings": True}],
            "parts": parts, "options": {}, "reach": {},
        },
        "grid": grid,
        "regions": [region("A", range(6, 14), 5, 15), region("B & C", range(8, 16), 6, 14)],
        "intersections": [{"trays": ["A"], "heading": 0, "centre": [1.0, 1.0], "radius": 0.4, "cells": 80},
                          {"trays": ["A", "B & C"], "heading": 0, "centre": [1.0, 1.1], "radius": 0.3, "cells": 48}],
        "too_small_intersections": [],
        "stops": [{"pose": [1.0, 1.0, 0.0], "radius": 0.2, "trays": ["A", "B & C"], "intersection": 1}],
        "lower_bound": 1, "proven_minimal": True,
        "route": [{"poses": [[0.3, 0.3, 0.0], [0.3, 0.3, 0.7854], [1.0, 1.0, 0.7854], [1.0, 1.0, 0.0]], "length": 0.99,
                   "turning": 1.571, "duration": 4.0},
                  {"poses": [[1.0, 1.0, 0.0], [1.0, 1.0, -0.4373], [2.5, 0.3, -0.4373], [2.5, 0.3, 0.0]], "length": 1.655,
                   "turning": 0.875, "duration": 5.0}],
        "picks": picks, "robustness_rate": 1.0, "obstructions": [],
        "premises": {"headings": {"A": [0.0], "B & C": [0.0]}, "shared_headings": True, "positioning_uncertainty": 0.1, "cell": 0.1, "max_distance": 0.0,
                     "grasps": 2, "ik_seeds": 0, "database": {}, "search_finished": True},
    }  # fmt: skip
