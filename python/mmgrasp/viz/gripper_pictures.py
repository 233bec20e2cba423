"""Pictures of designed grippers: each part's segments, and each operation's grasp in place."""

from __future__ import annotations

import re
import tempfile
import xml.etree.ElementTree as ET
from collections.abc import Callable
from pathlib import Path

import numpy as np

from .. import _core
from .._core import Gripper
from ..grippers.planning import GripperPlan
from .png import write_png
from .segment_pictures import segment_picture
from .style import OBSTACLE, PART, ROBOT_ARM
from .two_sides import FROM_ABOVE_AND_ASIDE, Body, Points, two_sides

SIDE = 520
PALM = 0.012  # so much of it is drawn, along the approach [m]
LONGEST = 60  # letters of a name in a file's


def picture_name(kind: str, index: int, name: str) -> str:
    """The file of a picture: its number tells it from all others, ASCII letters and digits of the name say what it shows."""
    readable = re.sub("[^A-Za-z0-9]+", "_", name)[:LONGEST].strip("_")
    return f"{kind}_{index + 1}{'_' if readable else ''}{readable}.png"


def write_gripper_pictures(plan: GripperPlan, out: Path, report: Callable[[str, float], None]) -> list[Path]:
    """segments_<number>_<part>.png, and operation_<number>_<name>.png of each operation that a gripper does."""
    names = list(plan.segmentations)
    steps = plan.assembly.steps if plan.result is not None and plan.result.grippers else []
    paths = []
    for i, name in enumerate(names):
        report("pictures", i / (len(names) + len(steps)))
        mesh, labels = plan.assembly.parts[name].mesh, np.asarray(plan.segmentations[name].labels)
        image = segment_picture(
            np.asarray(mesh.vertices), np.asarray(mesh.triangles), labels, plan.segment_names[name], SIDE
        )
        paths.append(write_png(out / picture_name("segments", i, name), image))
    for i in range(len(steps)):
        report("pictures", (len(names) + i) / (len(names) + len(steps)))
        paths.append(
            write_png(
                out / picture_name("operation", i, steps[i].name),
                two_sides(operation_bodies(plan, i), FROM_ABOVE_AND_ASIDE, SIDE),
            )
        )
    return paths


def operation_bodies(plan: GripperPlan, index: int) -> list[Body]:
    """The parts in their places at the end of an operation, and the gripper that still holds the active ones."""
    assert plan.result is not None
    step, parts = plan.assembly.steps[index], plan.assembly.parts
    grasp = plan.grasps[plan.result.requirement_of_part[index]]
    gripper = plan.result.grippers[plan.result.gripper_of_part[index]]
    bodies: list[Body] = []
    for name in step.passive + step.active:
        mesh, pose = parts[name].mesh, parts[name].pose
        colour = PART if name in step.active else OBSTACLE
        bodies.append((_moved(pose, np.asarray(mesh.vertices)), np.asarray(mesh.triangles), colour))
    return bodies + gripper_bodies(gripper, grasp.opening, np.asarray(grasp.T_active_tool))


def gripper_bodies(gripper: Gripper, opening: float, T_tips: Points) -> list[Body]:
    """Palm and fingers, tips in the plane z = 0 of T_tips."""
    finger = gripper.finger_mesh()
    bodies: list[Body] = []
    for i in range(gripper.fingers):
        turn = _core.pose([0, 0, -gripper.finger_length], rpy=[0, 0, 2 * np.pi * i / gripper.fingers])
        T = T_tips @ turn @ _core.pose([opening / 2, 0, 0])
        bodies.append((_moved(T, np.asarray(finger.vertices)), np.asarray(finger.triangles), ROBOT_ARM))
    sides, reach = 32, _palm_radius(gripper)
    angles = 2 * np.pi * np.arange(sides) / sides
    ring = np.stack([reach * np.cos(angles), reach * np.sin(angles), np.zeros(sides)], axis=1)
    low, high = ring - [0, 0, gripper.finger_length + PALM], ring - [0, 0, gripper.finger_length]
    k = np.arange(sides)
    n = (k + 1) % sides
    walls = np.concatenate([np.stack([k, n, n + sides], axis=1), np.stack([k, n + sides, k + sides], axis=1)])
    caps = np.concatenate([np.stack([0 * k, n, k], axis=1), np.stack([0 * k, k, n], axis=1) + sides])
    bodies.append((_moved(T_tips, np.concatenate([low, high])), np.concatenate([walls, caps]), ROBOT_ARM))
    return bodies


def _palm_radius(gripper: Gripper) -> float:
    """As the gripper's own files have it [m]."""
    with tempfile.TemporaryDirectory() as folder:
        gripper.to_urdf(folder)
        palm = ET.parse(Path(folder, "gripper.urdf")).find("link[@name='base']/collision/geometry/cylinder")
    assert palm is not None
    return float(palm.get("radius", ""))


def _moved(T: Points, points: Points) -> Points:
    return points @ T[:3, :3].T + T[:3, 3]
