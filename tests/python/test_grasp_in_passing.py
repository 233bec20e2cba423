"""A grasp that is free where a part is taken and where it is let go, but not between, gives way to the next best one.

What is free is found here by separating axes of boxes, which shares nothing with the library's checks.
"""

from __future__ import annotations

import itertools
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from numpy.typing import NDArray

from mmgrasp.gripper_design import AssemblyGrasp, Gripper
from mmgrasp.grippers import load_assembly, plan_grippers
from mmgrasp.grippers.planning import GripperPlan

Box = tuple[NDArray[np.float64], NDArray[np.float64]]  # pose (4, 4) of its middle, half sides

POSTS = [(-10.6, 10.6), (10.6, -10.6)]
"""Middles of posts that fingers on the key's long faces pass by where it comes from and where it stays, but not in mid-turn [mm]."""


def moved(x: float = 0, y: float = 0, z: float = 0, turn: float = 0) -> NDArray[np.float64]:
    """A pose of a turn [degrees] about z and a place [m]."""
    c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    return np.array([[c, -s, 0, x], [s, c, 0, y], [0, 0, 1, z], [0, 0, 0, 1]])


def assembly_of_key(file: Path, posts: list[tuple[float, float]]) -> Path:
    """A key of 18 x 12 x 40 mm turns by 90 degrees at a height of 60 mm, and comes down on a plate."""
    stand = [{"name": f"post {i}", "box": [3, 3, 70], "pose": {"xyz": [x, y, 90]}} for i, (x, y) in enumerate(posts)]
    content: dict[str, Any] = {
        "format": "mmgrasp-assembly",
        "version": 1,
        "name": "a key that turns",
        "unit": "mm",
        "parts": [
            {"name": "plate", "box": [200, 200, 10], "pose": {"xyz": [0, 0, -5]}},
            {"name": "key", "box": [18, 12, 40], "pose": {"xyz": [0, 0, 20]}},
            *stand,
        ],
        "order": [
            {
                "part": "key",
                "onto": ["plate", *(post["name"] for post in stand)],
                "path": [{"xyz": [0, 0, 60], "rpy": [0, 0, float(np.pi / 2)]}, {"xyz": [0, 0, 60]}],
            }
        ],
        "actuators": [{"name": "jaws", "fingers": 2, "stroke": 40}],
    }
    file.write_text(yaml.safe_dump(content))
    return file


def boxes_meet(a: Box, b: Box) -> bool:
    """Whether no axis separates two boxes."""
    between = b[0][:3, 3] - a[0][:3, 3]
    axes = [*a[0][:3, :3].T, *b[0][:3, :3].T]
    axes += [np.cross(u, v) for u, v in itertools.product(axes[:3], axes[3:])]
    for axis in axes:
        if np.linalg.norm(axis) < 1e-9:
            continue
        reach = sum(float(half @ np.abs(pose[:3, :3].T @ axis)) for pose, half in (a, b))
        if abs(float(between @ axis)) >= reach:
            return False
    return True


def gripper_boxes(grasp: AssemblyGrasp, gripper: Gripper) -> list[Box]:
    """Both fingers of jaws that hold, and a box around the palm, in the frame of the key in its place."""
    length, thick = gripper.finger_length, gripper.finger_thickness
    out = []
    for side in (1, -1):
        shift = np.eye(4)
        shift[:3, 3] = [side * (grasp.opening + thick) / 2, 0, -length / 2]
        out.append((grasp.T_active_tool @ shift, np.array([thick, gripper.finger_width, length]) / 2))
    palm = np.eye(4)
    palm[2, 3] = -length - gripper.palm_height / 2
    return [*out, (grasp.T_active_tool @ palm, np.array([gripper.palm_radius] * 2 + [gripper.palm_height / 2]))]


WAY = [moved(z=0.06, turn=90 - t) for t in np.linspace(0, 90, 361)] + [moved(z=z) for z in np.linspace(0.06, 0, 241)]
PASSIVE: list[Box] = [(moved(z=-0.005), np.array([0.1, 0.1, 0.005]))] + [
    (moved(1e-3 * x, 1e-3 * y, 0.09), np.array([0.0015, 0.0015, 0.035])) for x, y in POSTS
]


def looks_that_meet(grasp: AssemblyGrasp, gripper: Gripper) -> list[int]:
    """Numbers of the looks along the way at which the gripper stands in something that stays."""
    own = gripper_boxes(grasp, gripper)
    return [
        i
        for i, motion in enumerate(WAY)
        if any(boxes_meet((motion @ pose, half), other) for (pose, half), other in itertools.product(own, PASSIVE))
    ]


def taken(plan: GripperPlan) -> tuple[AssemblyGrasp, Gripper]:
    assert plan.solved and plan.result is not None
    return plan.grasps[plan.result.requirement_of_part[0]], plan.result.grippers[0]


def test_what_is_free_only_at_both_ends_gives_way(tmp_path: Path) -> None:
    preferred, _ = taken(plan_grippers(load_assembly(assembly_of_key(tmp_path / "free.yaml", []))))
    assert preferred.opening == pytest.approx(0.012)
    plan = plan_grippers(load_assembly(assembly_of_key(tmp_path / "posts.yaml", POSTS)))
    grasp, gripper = taken(plan)
    assert grasp.opening == pytest.approx(0.018)
    assert looks_that_meet(grasp, gripper) == []
    assert plan.faults == []
    in_passing = looks_that_meet(preferred, gripper)  # with fingers as long
    assert in_passing and 0 < min(in_passing) and max(in_passing) < 360  # between the ends of the turn, and only there
